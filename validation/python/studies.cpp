#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "msa/frame/file/frame_analysis.h"
#include "validation/python/bindings.h"
#include "validation/python/interruptible.h"
#include "validation/python/mechanism.h"
#include "validation/report/frame_results.h"
#include "validation/report/map_results.h"
#include "validation/report/solve_results.h"
#include "validation/report/validation_results.h"
#include "validation/studies/errata_prices.h"
#include "validation/studies/map.h"
#include "validation/studies/solve.h"
#include "validation/studies/sweep.h"
#include "validation/studies/validate.h"

namespace deflect::python {

namespace py = pybind11;
using subject::Subject;

namespace {

using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

theories::Theories theories_of(const std::vector<std::string>& names) {
  return theories::theories_named(fmt::format("{}", fmt::join(names, ",")));
}

studies::SolveResult solve(const Subject& s, const Asked& at, const std::vector<double>& load,
                           const std::string& geometry, const std::vector<std::string>& theories, int elements) {
  const OneBlasThread one;
  const py::gil_scoped_release released;
  const Mechanism& m = machine_of(s);
  const Vector6 F = load_from(load);
  const Stand stand = stand_of(m, at);
  if (elements < 0) throw InputError(fmt::format("elements = {}: give a whole number of at least 1", elements));
  const frame::MemberDivision division =
      elements > 0 ? frame::equal_division(stand.configuration, elements) : frame::MemberDivision();
  studies::SolveResult r = studies::solve(m, stand, F, division, geometry_of(geometry), theories_of(theories));
  r.mesh = {}, r.fields = {};
  return r;
}

const studies::TheorySolution& by(const studies::SolveResult& r, const std::string& theory) {
  return theory.empty() ? r.reference() : r.solutions[theories::place_of(r.theories, theory)];
}

Eigen::Index rows_in(const char* what, const Rows& rows, bool or_one) {
  if (or_one && rows.ndim() == 1 && rows.shape(0) == 6) return 1;
  if (rows.ndim() != 2 || rows.shape(1) != 6)
    throw InputError(fmt::format("{}: an array of shape (n, 6) is wanted{}", what, or_one ? ", or (6,)" : ""));
  return rows.shape(0);
}

std::span<const double> span_of(const Rows& rows) { return {rows.data(), as_size(rows.size())}; }

/// By theory a pair of displacements (n, 6) and stiffnesses (n, 6, 6); None where not wanted.
py::list solve_many(const Subject& s, const Rows& poses, const Rows& loads, const std::vector<std::string>& names,
                    const std::pair<bool, bool>& wanted, bool keep_unreachable, int threads,
                    const py::object& progress) {
  const Mechanism& m = machine_of(s);
  const Eigen::Index n = rows_in("poses", poses, false);
  (void)rows_in("loads", loads, true);
  const theories::Theories theories = theories_of(names);
  const studies::ManyPoses in{span_of(poses), span_of(loads), keep_unreachable};
  std::vector<studies::ManyAnswers> answers;
  py::list out;
  for (std::size_t t = 0; t < theories.size(); ++t) {
    studies::ManyAnswers each;
    py::object displacement = py::none(), stiffness = py::none();
    const auto make = [&](py::object& here, std::vector<py::ssize_t> shape) {
      py::array_t<double> array(std::move(shape));
      here = array;
      return std::span<double>(array.mutable_data(), as_size(array.size()));
    };
    if (wanted.first) each.displacement_mm_rad = make(displacement, {n, 6});
    if (wanted.second) each.stiffness_mm = make(stiffness, {n, 6, 6});
    answers.push_back(each);
    out.append(py::make_tuple(displacement, stiffness));
  }
  constexpr Eigen::Index few = 200;  // of which a thread to look for Ctrl-C costs more than it helps
  if (n <= few && progress.is_none()) {
    const OneBlasThread one;
    const py::gil_scoped_release released;
    studies::solve_many(m, in, theories, answers, {n == 1 ? 1 : threads});
  } else {
    interruptible(progress, [&](const auto& told) {
      studies::solve_many(m, in, theories, answers, {threads, nullptr, told});
      return true;
    });
  }
  return out;
}

/// A JSON of the contract, and what a person reads.
using Told = std::pair<std::string, std::string>;

Told solve_frame(const Subject& s, const std::string& solver, const py::object& progress) {
  if (!s.frame()) throw InputError(s.name() + " is a machine, not a frame");
  const std::vector<std::string> names(std::begin(frame::equations_names), std::end(frame::equations_names));
  const auto found = std::find(names.begin(), names.end(), solver);
  if (found == names.end()) throw InputError(fmt::format("solver '{}': write {}", solver, fmt::join(names, ", ")));
  frame::FrameOptions options;
  options.equations.solver = static_cast<frame::Equations>(found - names.begin());
  if (options.equations.solver == frame::Equations::iterative && s.frame()->geometry != Geometry::linear)
    throw InputError("solver 'iterative' needs 'geometry: linear'");
  return interruptible(progress, [&](const auto& told) {
    options.equations.progress = told;
    const frame::FrameResult r = frame::analyse(*s.frame(), options);
    if (const std::string failure = frame::failed_check(r); !failure.empty())
      throw NumericalError(fmt::format("{}: {}", s.name(), failure));
    return Told(report::frame_json(*s.frame(), r), report::frame_report(*s.frame(), r));
  });
}

Told validate(const Subject& s, const std::vector<std::pair<std::string, std::vector<double>>>& points, double force_N,
              const std::vector<std::string>& names, const std::string& as_printed, bool errata, bool mesh_study,
              const py::object& progress) {
  const Mechanism& m = machine_of(s);
  if (!std::isfinite(force_N) || force_N == 0)
    throw InputError(fmt::format("force = {}: give a force in N other than zero", force_N));
  const std::set<Erratum> printed = parse_errata(as_printed);
  return interruptible(progress, [&](const auto&) {
    std::vector<studies::ValidationPoint> at;
    for (const auto& [label, pose] : points) at.push_back({label, six("points", pose)});
    if (at.empty()) at = studies::workspace_points(m);
    const studies::Validation v = studies::validate(m, at, force_N, printed, {}, theories_of(names));
    std::vector<studies::ErratumPrice> prices;
    if (errata) prices = studies::price_errata(m, at, force_N);
    std::vector<studies::MeshStudyRow> mesh;
    if (mesh_study) mesh = studies::mesh_study(m, at, force_N);
    std::string told = report::validation_table(v);
    if (errata) told += "\n" + report::errata_table(prices);
    if (mesh_study) told += "\n" + report::mesh_study_table(mesh);
    return Told(report::validation_json(v, prices, mesh), std::move(told));
  });
}

/// `ranges`: of x, y and z in mm, each empty (the workspace), one value, or from and to.
struct MapAsked {
  std::array<int, 3> counts;
  std::array<std::vector<double>, 3> ranges;
  std::vector<double> tilt_deg, load;
  double force_N, length_mm;
  std::vector<std::string> theories;
};

studies::MapOptions options_of(const Mechanism& m, const MapAsked& a) {
  studies::MapOptions o;
  const auto given = [](const std::vector<double>& range) { return !range.empty(); };
  o.grid.counts = a.counts;
  if (!std::all_of(a.ranges.begin(), a.ranges.end(), given)) o.grid = studies::workspace_grid(m, a.counts);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double>& range = a.ranges[axis];
    if (range.empty()) continue;
    if (range.size() > 2 || range.back() < range.front())
      throw InputError(fmt::format("{} = {}: give from and to in mm, the smaller first, or one value", "xyz"[axis],
                                   fmt::join(range, ", ")));
    o.grid.low_mm(as_index(axis)) = range.front();
    o.grid.high_mm(as_index(axis)) = range.back();
    o.grid.counts[axis] = range.front() == range.back() ? 1 : a.counts[axis];
  }
  if (std::none_of(a.ranges.begin(), a.ranges.end(), given)) o.region = studies::region_of(m);
  if (!a.tilt_deg.empty()) o.grid.tilt_deg = six("tilt", a.tilt_deg, {3}).head<3>();
  o.force_N = a.force_N;
  if (!a.load.empty()) o.load_N_Nmm = load_from(a.load);
  o.theories = theories_of(a.theories);
  o.length_mm = a.length_mm == 0 ? studies::weighing_length_mm(m) : a.length_mm;
  return o;
}

Told map(const Subject& s, const MapAsked& asked, int threads, const py::object& progress) {
  const Mechanism& m = machine_of(s);
  return interruptible(progress, [&](const auto& told) {
    const studies::StiffnessMap map = studies::map_stiffness(m, options_of(m, asked), {threads, nullptr, told});
    if (std::none_of(map.poses.begin(), map.poses.end(), [](const studies::MapPose& p) { return p.reached(); }))
      throw ModelError(fmt::format("the map is empty: the device reaches none of the {} poses. The first pose: {}",
                                   map.poses.size(), map.poses.front().out_of_reach));
    return Told(report::map_json(map), report::map_report(map));
  });
}

}  // namespace

void bind_studies(py::module_& m) {
  py::class_<Asked>(m, "Asked").def(py::init([](std::vector<double> pose, std::vector<double> joints, bool si) {
    return Asked{std::move(pose), std::move(joints), si ? 1.0 : 1e3};
  }));
  py::class_<studies::SolveResult>(m, "SolveResult")
      .def("displacement",
           [](const studies::SolveResult& r, const std::string& t) { return by(r, t).displacement_mm_rad; })
      .def("stiffness",
           [](const studies::SolveResult& r, const std::string& t) {
             return Eigen::Matrix<double, 6, 6, Eigen::RowMajor>(by(r, t).stiffness_mm);
           })
      .def("json", [](const studies::SolveResult& r) { return report::solve_json(r); })
      .def("report", [](const studies::SolveResult& r) { return report::solve_report(r); });
  m.def("solve", &solve);
  m.def("solve_many", &solve_many);
  m.def("solve_frame", &solve_frame);
  m.def("validate", &validate);
  m.def("map", [](const Subject& s, std::array<int, 3> counts, std::array<std::vector<double>, 3> ranges,
                  std::vector<double> tilt, std::vector<double> load, double force, double length,
                  std::vector<std::string> theories, int threads, const py::object& progress) {
    return map(s, {counts, std::move(ranges), std::move(tilt), std::move(load), force, length, std::move(theories)},
               threads, progress);
  });
  std::vector<std::string> names;
  for (const theories::Theory* theory : theories::all_theories()) names.push_back(theory->name);
  m.attr("theories") = py::tuple(py::cast(names));
  m.attr("reference_theory") = theories::all_theories()[theories::reference_of(theories::all_theories())]->name;
}

}  // namespace deflect::python
