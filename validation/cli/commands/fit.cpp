#include <fmt/format.h>

#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/new_description.h"
#include "validation/cli/talk.h"
#include "validation/fit/fit.h"
#include "validation/report/validity/fit_results.h"

namespace deflect::cli {
namespace {

struct FitArguments {
  std::string device, data, out, tables, json, sigma_mm, sigma_rad;
  std::vector<std::string> free, priors;
  bool as_recorded = false, force = false;
  double threads = 0;
};

void run(const FitArguments& a) {
  const std::string file = subject_file(a.device).string();
  const subject::Subject s = read_subject(a.device);
  const std::vector<fit::FreeParameter> free = fit::free_parameters(s, a.free, a.priors, read_text(file));
  const measurement::Measurements data = read_data(a.data, s);
  tell_size(data, 1200);
  compare::ComparisonOptions o;
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  o.as_recorded = a.as_recorded;
  const int threads = parse_threads(a.threads);
  const fit::FitResult r =
      timed_with_progress("fit: parameters with all tolerances free under their priors", [&](const auto& told) {
        return fit::fit(s, data, free, o, {threads, nullptr, told});
      });
  write_description(fit::with_values(s, free, fit::fitted_values(r)), s.name(), "fitted to " + data.origin + ":",
                    report::fitted_words(r), a.out);
  if (!a.json.empty()) write_result(a.json, report::fit_json(r));
  const std::string report = report::fit_report(r);
  if (!a.tables.empty()) {
    const std::filesystem::path folder = a.tables;
    write_table(folder / "fit.txt", report);
    write_table(folder / "parameters.csv", report::parameters_csv(r));
  }
  fmt::print("{}\n{}: written\n", report, a.out);
}

}  // namespace

Command fit_command() {
  auto a = std::make_shared<FitArguments>();
  return {
      "fit",
      "Fit parameters of your choice to measurements, with all tolerances free under their priors. The report gives "
      "values with 95 % intervals, their correlation, what the data do not determine, and the error before and after, "
      "also at held-out poses. The command also writes the description with the fitted values. A tolerance of a "
      "parameter's own number gives way to it. A number that cannot be negative is fitted on a logarithmic scale",
      "deflect fit arm measurements.csv --free leg.joint_2.rz.stiffness --free materials.aluminium.E --prior "
      "\"materials.aluminium.E=70 GPa ± 2 %\" -o fitted.yaml --json fit.json",
      {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
       {"data", "DATA", "measurements (CSV)", &a->data, true},
       {"--free", "PATH",
        "a number of the description, by its path: materials.steel.E, leg.joint_1.rz.stiffness, leg[4].guideway."
        "bending_factor; * for every entry, all times one factor. Repeat for several",
        &a->free, true},
       {"--prior", "PATH=MEAN ± SD",
        "what is known of a parameter before: mean and standard deviation with units, or the deviation in % (+- for ±)",
        &a->priors},
       {"-o,--output", "NEW_DEVICE", "file to write", &a->out, true},
       {"--force", "", "allow the output to overwrite an input", &a->force},
       {"--sigma", "MM", "standard deviation of a translation in mm, if the file has none", &a->sigma_mm},
       {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
       {"--as-recorded", "", "take the file as it is: skip the search for recording mistakes", &a->as_recorded},
       {"--threads", "N", "threads (default 0: all cores); they do not change the result", &a->threads},
       {"--json", "FILE", "write the result, for 'deflect predict --fit'", &a->json},
       {"--out", "DIR", "write report and table: fit.txt, parameters.csv", &a->tables}},
      [a] { run(*a); }};
}

}  // namespace deflect::cli
