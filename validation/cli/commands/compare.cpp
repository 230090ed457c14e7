#include <fmt/format.h>

#include <filesystem>

#include "msa/base/error.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/figures.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/compare/comparison.h"
#include "validation/figures/compare_figures.h"
#include "validation/report/compare_results.h"

namespace deflect::cli {
namespace {

struct CompareArguments {
  std::string device, data, json, out, report, sigma_mm, sigma_rad;
  double threads = 0;
  FigureArguments figures;
};

void run(const CompareArguments& a) {
  require_pages(a.report);
  const figures::FigureStyle style = figure_style(a.figures, a.out);
  const subject::Subject m = read_subject(a.device);
  const measurement::Measurements data = read_data(a.data, m);
  tell_size(data, 450);
  compare::ComparisonOptions o;
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  const int threads = parse_threads(a.threads);
  const compare::Comparison c =
      timed_with_progress("compare: closed form at every reading, tolerances, patterns", [&](const auto& told) {
        return compare::compare(m, data, o, {threads, nullptr, told});
      });
  const std::filesystem::path folder = a.out;
  if (!a.out.empty()) {
    draw(figures::compare_figures(c, style), folder);
    write_table(folder / "residuals.csv", report::residuals_csv(c));
    write_table(folder / "errors.csv", report::errors_csv(c));
    write_table(folder / "tests.csv", report::tests_csv(c));
  }
  if (!a.json.empty()) write_result(a.json, report::compare_json(c));
  fmt::print("{}", report::compare_report(c));
  if (!a.out.empty()) fmt::print("\nFigures and tables: {}\n", std::filesystem::absolute(folder).string());
  if (!a.report.empty()) write_report(a.report, a.device, {c}, {{"compare", report::compare_json(c)}});
}

}  // namespace

Command compare_command() {
  auto a = std::make_shared<CompareArguments>();
  return {
      "compare",
      "Compare measurements with the closed form, without fitting it. The report says in sentences with numbers where "
      "the model fails. It gives tests that need no hypothesis, patterns of the residual, and errors by pose, "
      "direction and magnitude",
      "deflect compare haptic-6psu-ideal-joints measurements.csv --out comparison --json comparison.json",
      with_figures({{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
                    {"data", "DATA", "measurements (CSV)", &a->data, true},
                    {"--sigma", "MM", "standard deviation of a translation in mm, if the file has none", &a->sigma_mm},
                    {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
                    {"--threads", "N", "threads (default 0: all cores); they do not change the result", &a->threads},
                    {"--json", "FILE", "write the result", &a->json},
                    report_option(&a->report),
                    {"--out", "DIR", "write figures (SVG, PDF, PNG, each with its caption) and tables", &a->out}},
                   &a->figures),
      [a] { run(*a); }};
}

}  // namespace deflect::cli
