#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "msa/base/error.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/figures.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/figures/errata_figure.h"
#include "validation/figures/fig10.h"
#include "validation/report/validation_results.h"
#include "validation/studies/errata_prices.h"
#include "validation/studies/mesh_study.h"
#include "validation/studies/points_file.h"
#include "validation/studies/validate.h"
#include "validation/studies/workspace.h"

namespace deflect::cli {
namespace {

struct ValidateArguments {
  std::string device, points, as_printed, theories, json, out, report, element_size;
  double load_N = 50;
  bool errata = false, mesh_study = false;
  FigureArguments figures;
};

void run(const ValidateArguments& a) {
  require_pages(a.report);
  const figures::FigureStyle style = figure_style(a.figures, a.out);
  const Mechanism m = read_device(a.device);
  const std::set<Erratum> as_printed = parse_errata(a.as_printed);
  if (!std::isfinite(a.load_N) || a.load_N == 0)
    throw InputError(fmt::format("--force {}: give a force in N other than zero", a.load_N));
  const theories::Theories theories = parse_theories(a.theories);
  if (!as_printed.empty() &&
      std::find(theories.begin(), theories.end(), &theories::theory("analytic")) == theories.end())
    throw InputError(
        fmt::format("--as-printed {}: the errata are the closed form's: put analytic among --theories", a.as_printed));
  const std::vector<studies::ValidationPoint> points =
      a.points.empty() ? studies::workspace_points(m) : studies::read_points(a.points);
  const studies::Validation v =
      timed(fmt::format("{} at {} points", theories::titles_of(theories), points.size()),
            [&] { return studies::validate(m, points, a.load_N, as_printed, divide(m, a.element_size), theories); });
  std::vector<studies::ErratumPrice> prices;
  if (a.errata) prices = timed("price of the errata", [&] { return studies::price_errata(m, points, a.load_N); });
  std::vector<studies::MeshStudyRow> mesh;
  if (a.mesh_study) mesh = timed("mesh study", [&] { return studies::mesh_study(m, points, a.load_N); });
  const std::filesystem::path folder = a.out;
  if (!a.out.empty()) {
    std::vector<figures::Figure> figures = {figures::fig10(v, style)};
    if (a.errata) figures.push_back(figures::errata_figure(prices, v, style));
    draw(figures, folder);
    write_table(folder / "validation.csv", report::validation_csv(v));
    if (a.errata) write_table(folder / "errata.csv", report::errata_csv(prices));
  }
  if (!a.json.empty()) write_result(a.json, report::validation_json(v, prices, mesh));
  fmt::print("{}", report::validation_table(v));
  if (a.errata) fmt::print("\n{}", report::errata_table(prices));
  if (a.mesh_study) fmt::print("\n{}", report::mesh_study_table(mesh));
  if (!a.out.empty()) fmt::print("\nFigures and tables: {}\n", std::filesystem::absolute(folder).string());
  if (!a.report.empty()) {
    std::vector<scene::SceneStand> stands;
    for (const studies::ValidationPoint& p : points)
      stands.push_back({p.label, p.pose_mm_deg, stand(m, p.pose_mm_deg).configuration});
    std::vector<Vector6> loads;
    for (int axis = 0; axis < 3; ++axis) loads.push_back(a.load_N * Vector6::Unit(axis));
    write_report_of_stands(a.report, a.device, m, stands, loads,
                           {"validate", report::validation_json(v, prices, mesh)});
  }
}

}  // namespace

Command validate_command() {
  auto a = std::make_shared<ValidateArguments>();
  std::string errata_help = "errata of the paper to use as printed, separated by commas, or all:";
  for (const ErratumInfo& e : errata()) errata_help += fmt::format("\n{} {}: {}", e.name, e.equations, e.as_printed);
  return {
      "validate",
      "Compare the theories at points of the device's workspace, under a force along x, y and z: "
      "table of errors, Fig. 10. The points of a cube are its centre and corners; --points gives others",
      "deflect validate haptic-6psu --out figures --as-printed passive-joints,ujoint-parallel",
      with_figures(
          {{"device", "DEVICE", "built-in device or device file", &a->device, true},
           {"--points", "FILE", "CSV of poses: x_mm,y_mm,z_mm and optionally pose,roll_deg,pitch_deg,yaw_deg",
            &a->points},
           {"--force", "N", "force along each axis in N (default 50)", &a->load_N},
           theories_option(&a->theories),
           {"--as-printed", "ERRATA", errata_help, &a->as_printed},
           {"--errata", "", "show how much each erratum alone changes the result", &a->errata},
           {"--mesh-study", "", "show the difference of the theories as the mesh is refined", &a->mesh_study},
           {"--element-size", "LENGTH",
            "size of the MSA's elements, with unit (default: one per member, exact at its ends)", &a->element_size},
           {"--json", "FILE", "write the result", &a->json},
           report_option(&a->report),
           {"--out", "DIR",
            "write Fig. 10 and, with --errata, a figure of the errata (SVG, PDF, PNG with captions), and tables (CSV)",
            &a->out}},
          &a->figures),
      [a] { run(*a); }};
}

}  // namespace deflect::cli
