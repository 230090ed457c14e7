// What is neither solved nor measured: drawings, files for other programs, matrices from elsewhere, pages.
#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>

#include "meshes/structure.h"
#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "validation/figures/drawing_results.h"
#include "validation/matrix/check_matrix.h"
#include "validation/page/page.h"
#include "validation/python/bindings.h"
#include "validation/python/interruptible.h"
#include "validation/python/mechanism.h"
#include "validation/report/check_results.h"
#include "validation/result_files/result_kinds.h"
#include "validation/studies/loaded_structure.h"

namespace deflect::python {

namespace py = pybind11;
using subject::Subject;

namespace {

using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A JSON of the contract, and what a person reads.
using Told = std::pair<std::string, std::string>;

Told drawing(const Subject& s, const Asked& at) {
  const py::gil_scoped_release released;
  const bool home = at.pose.empty() && at.joints.empty();
  if (s.frame() && !home) throw InputError("pose and joints apply to machines, not to frames");
  const figures::MachineDrawing d = s.frame() ? figures::drawing_of(*s.frame())
                                    : home
                                        ? figures::drawing_of(*s.machine())
                                        : figures::drawing_of(*s.machine(), stand_of(*s.machine(), at).configuration);
  return {figures::drawing_json(d), figures::drawing_report(d)};
}

/// Two files; returns the path of the second, the scale of its deflections, and the displacement of T (mm, rad).
std::tuple<std::string, double, Vector6> export_structure(const Subject& s, const std::string& path,
                                                          const std::string& format, const Asked& at,
                                                          const std::vector<double>& load, double element_mm,
                                                          const std::optional<double>& scale) {
  const py::gil_scoped_release released;
  const OneBlasThread one;
  const Mechanism& m = machine_of(s);
  const studies::StructureFormat kind = studies::structure_format(format, "format");
  if (!(element_mm > 0))
    throw InputError(fmt::format("element_size = {}: give a length above zero, in mm", element_mm));
  const frame::MemberDivision division = divide_members(configure(m, home_pose(m)), element_mm / 1e3);
  const studies::LoadedStructure loaded =
      studies::loaded_structure(m.name, stand_of(m, at).configuration, division, load_from(load), scale);
  studies::write_structure(loaded, kind, path);
  return {studies::deflected_path(path, kind).string(), loaded.scale, loaded.tool_mm_rad};
}

/// A matrix as numbers, which are exact, or the file of one.
using GivenMatrix = std::variant<std::string, Rows>;

matrix::PrintedMatrix printed(const char* what, const GivenMatrix& given, const matrix::MatrixConvention& convention,
                              const std::string& key) {
  if (const std::string* file = std::get_if<std::string>(&given)) return matrix::read_stiffness(*file, convention, key);
  const Rows& rows = std::get<Rows>(given);
  if (rows.ndim() != 2 || rows.shape(0) != 6 || rows.shape(1) != 6)
    throw InputError(fmt::format("{}: an array of shape (6, 6) is wanted", what));
  const Matrix6 K = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows.data());
  if (!K.allFinite()) throw InputError(fmt::format("{}: holds an entry that is no finite number", what));
  return {K, Matrix6::Zero()};
}

matrix::PrintedMatrix twists(const Rows& rows) {
  if (rows.ndim() != 2 || rows.shape(0) != 6 || rows.shape(1) < 1 || rows.shape(1) > 5)
    throw InputError("passive: an array of shape (6, m) is wanted, m from 1 to 5: twists as columns");
  const MatrixX J = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      rows.data(), rows.shape(0), rows.shape(1));
  if (!J.allFinite()) throw InputError("passive: holds an entry that is no finite number");
  return {J, MatrixX::Zero(J.rows(), J.cols())};
}

struct CheckAsked {
  double unit_m = 1e-3;
  std::optional<double> tolerance, size_mm;
  std::string key, matrix_name, reference_name;
};

Told check(const GivenMatrix& K, const std::optional<Rows>& passive, const std::optional<GivenMatrix>& reference,
           const CheckAsked& asked) {
  matrix::MatrixCheckOptions o;
  o.unit_m = asked.unit_m;
  const matrix::MatrixConvention convention{asked.unit_m, false};
  o.K = printed("K", K, convention, asked.key);
  if (passive) o.passive_twists = twists(*passive);
  if (reference) o.reference = printed("reference", *reference, convention, asked.key);
  if (asked.tolerance && !(*asked.tolerance > 0 && *asked.tolerance < 1))
    throw InputError(fmt::format("tolerance = {}: give a relative difference between 0 and 1", *asked.tolerance));
  o.tolerance = asked.tolerance;
  if (asked.size_mm) {
    if (!(*asked.size_mm > 0))
      throw InputError(fmt::format("size = {}: give a length above zero, in mm", *asked.size_mm));
    o.plausible = {*asked.size_mm / 1e4, *asked.size_mm / 1e2};
  }
  const matrix::MatrixCheck m = matrix::check_matrix(o);
  const report::CheckedFiles files{asked.matrix_name, asked.reference_name};
  return {report::check_json(m, files), report::check_report(m, files)};
}

void write_page(const std::string& path, const std::vector<NamedText>& results) {
  page::PageContents page;
  page.version = DEFLECT_VERSION;
  page.command = "deflect.report()";
  for (const auto& [json, origin] : results) page.results.push_back({origin, json});
  write_text(path, page::page_html(page));
}

/// What the readers of results want of each kind: paths of members with their types.
std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>> wanted_of_results() {
  constexpr const char* names[] = {"text",  "number", "number_or_null", "truth", "list", "object",
                                   "three", "six",    "six_by_six"};
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>> out;
  for (const result_files::ResultKind& kind : result_files::result_kinds()) {
    out.push_back({kind.name, {}});
    for (const result_files::WantedMember& m : kind.wanted) out.back().second.emplace_back(m.path, nth(names, m.type));
  }
  return out;
}

}  // namespace

void bind_structures(py::module_& m) {
  py::class_<CheckAsked>(m, "CheckAsked")
      .def(py::init([](double unit_m, std::optional<double> tolerance, std::optional<double> size_mm, std::string key,
                       std::string matrix_name, std::string reference_name) {
        return CheckAsked{
            unit_m, tolerance, size_mm, std::move(key), std::move(matrix_name), std::move(reference_name)};
      }));
  m.def("drawing", &drawing);
  m.def("export_structure", &export_structure);
  m.def("check", &check);
  m.def("write_page", &write_page);
  m.def("result_kinds", &wanted_of_results);
}

}  // namespace deflect::python
