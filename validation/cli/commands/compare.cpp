#include <fmt/format.h>

#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/figures.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/compare/comparison.h"
#include "validation/figures/compare_figures.h"
#include "validation/figures/validity_figure.h"
#include "validation/report/compare_results.h"
#include "validation/report/validity/validity_results.h"
#include "validation/validity/validation.h"

namespace deflect::cli {
namespace {

struct CompareArguments {
  std::string device, data, json, out, report, sigma_mm, sigma_rad;
  std::string calibration, use, fit;
  std::vector<std::string> free;
  bool validation = false;
  double threads = 0;
  FigureArguments figures;
};

/// The same file again, by its path or by what it holds.
void require_other_data(const CompareArguments& a) {
  std::error_code error;
  const bool same = std::filesystem::equivalent(a.data, a.calibration, error) && !error;
  if (same || read_text(a.data) == read_text(a.calibration))
    throw InputError(
        fmt::format("--calibration {}: this is the validation data: what a model was calibrated with cannot "
                    "validate it. Give measurements of their own for each",
                    a.calibration));
}

void require_validation(const CompareArguments& a) {
  if (a.validation) return;
  const std::pair<const char*, bool> given[] = {{"--calibration", !a.calibration.empty()},
                                                {"--use", !a.use.empty()},
                                                {"--fit", !a.fit.empty()},
                                                {"--free", !a.free.empty()}};
  for (const auto& [name, is_given] : given)
    if (is_given) throw InputError(fmt::format("{} goes with --validation", name));
}

/// The data that the fit was made with.
void require_data_beside_fit(const CompareArguments& a) {
  if (has_read(a.fit, a.data))
    throw InputError(
        fmt::format("--fit {}: it was fitted to {}: what a model was fitted to cannot validate it. Give measurements "
                    "of their own",
                    a.fit, a.data));
}

void validate(const CompareArguments& a, const subject::Subject& s, const measurement::Measurements& data,
              const compare::ComparisonOptions& o, const figures::FigureStyle& style, int threads) {
  validity::ValidationOptions options;
  options.comparison = o;
  std::optional<measurement::Measurements> calibration, use;
  if (!a.fit.empty()) require_data_beside_fit(a);
  if (!a.calibration.empty()) {
    require_other_data(a);
    calibration = read_data(a.calibration, s);
    options.calibration = &*calibration;
  }
  if (!a.use.empty()) {
    use = read_plan(a.use, s);
    options.use = &*use;
  }
  if (!a.fit.empty()) {
    options.fit = fit::read_fit(read_text(a.fit), a.fit, s);
    remark_if_of_another(a.fit, a.device, s);
  }
  if (!a.free.empty()) options.parameters = fit::free_parameters(s, a.free, {}, read_text(subject_file(a.device)));
  const validity::ValidationStudy study = timed_with_progress(
      "validation: both theories at every reading, tolerances, groups left out", [&](const auto& told) {
        return validity::validate(s, data, options, {threads, nullptr, told});
      });
  const std::string json = report::validity_json(study);
  const std::filesystem::path folder = a.out;
  if (!a.out.empty()) {
    draw({figures::validity_figure(study, style)}, folder);
    write_table(folder / "validation.csv", report::validity_csv(study));
  }
  if (!a.json.empty()) write_result(a.json, json);
  fmt::print("{}", report::validity_report(study));
  if (!a.out.empty()) fmt::print("\nFigure and table: {}\n", std::filesystem::absolute(folder).string());
  if (!a.report.empty()) write_report(a.report, a.device, {study.comparison}, {{"validation", json}});
}

void run(const CompareArguments& a) {
  require_pages(a.report);
  require_validation(a);
  const figures::FigureStyle style = figure_style(a.figures, a.out);
  const subject::Subject m = read_subject(a.device);
  const measurement::Measurements data = read_data(a.data, m);
  tell_size(data, 450);
  compare::ComparisonOptions o;
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  const int threads = parse_threads(a.threads);
  if (a.validation) return validate(a, m, data, o, style, threads);
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
      with_figures(
          {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
           {"data", "DATA", "measurements (CSV)", &a->data, true},
           {"--sigma", "MM", "standard deviation of a translation in mm, if the file has none", &a->sigma_mm},
           {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
           {"--validation", "",
            "say in the words of the validation standards how far to trust the model: errors and their "
            "uncertainty, domain, groups left out, maturity. The model should not be fitted to these data",
            &a->validation},
           {"--calibration", "DATA",
            "with --validation: the data that the model was calibrated with, which must not be the same readings",
            &a->calibration},
           {"--use", "FILE",
            "with --validation: poses and loads at which the model will be used; predicted there, with the "
            "distance to what was validated",
            &a->use},
           {"--fit", "FIT.json",
            "with --validation: the calibration ('deflect fit --json'), for the uncertainty of its parameters and "
            "whether they are the same everywhere",
            &a->fit},
           {"--free", "PATH",
            "with --validation: a parameter to test for being the same at every pose, load and session", &a->free},
           {"--threads", "N", "threads (default 0: all cores); they do not change the result", &a->threads},
           {"--json", "FILE", "write the result", &a->json},
           report_option(&a->report),
           {"--out", "DIR", "write figures (SVG, PDF, PNG, each with its caption) and tables", &a->out}},
          &a->figures),
      [a] { run(*a); }};
}

}  // namespace deflect::cli
