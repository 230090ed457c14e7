#include <fmt/format.h>

#include "msa/base/error.h"
#include "validation/cli/command.h"
#include "validation/cli/commands/effects.h"
#include "validation/cli/devices.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/report/diagnosis_results.h"

namespace deflect::cli {
namespace {

struct DiagnoseArguments {
  std::string device, data, json, report;
  std::vector<std::string> files;
  std::string sigma_mm, sigma_rad;
  bool as_recorded = false;
  double bootstrap = 1999, threads = 0;
};

void run(const DiagnoseArguments& a, Ranks* ranks) {
  require_pages(a.report);
  const Mechanism m = read_device(a.device);
  const Measurements data = read_data(a.data);
  tell_size(data, 1200);
  const std::vector<Effect> effects = known_effects(a.files);
  DiagnosisOptions o;
  o.comparison.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.comparison.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  o.comparison.as_recorded = a.as_recorded;
  o.bootstrap_sets = whole("--bootstrap", a.bootstrap, 99, 1e9);
  o.ranks = ranks;
  o.threads = o.comparison.threads = parse_threads(a.threads, ranks);
  const Diagnosis d = timed_with_progress("diagnose: every effect fitted and weighed", [&](const auto& told) {
    DiagnosisOptions shown = o;
    shown.progress = told;
    return diagnose(m, data, effects, shown);
  });
  if (ranks && !ranks->first()) return;
  for (const PlacedEffect& found : d.missing) tell("found: {}", name_of(found));
  if (!a.json.empty()) write_file(a.json, diagnosis_json(d));
  fmt::print("{}", diagnosis_report(d, m.name, data.origin));
  if (!a.report.empty())
    write_report_of_diagnosis(a.report, a.device, m, data, effects, o.comparison, {{"diagnose", diagnosis_json(d)}});
}

}  // namespace

Command diagnose_command() {
  auto a = std::make_shared<DiagnoseArguments>();
  return {
      "diagnose",
      "Which physical effect is missing: first of all whether the file is what it says (units, signs, axes, columns, "
      "poses; such a mistake is named and no effect is looked for); then every effect of the catalogue at every place "
      "it has in the device, fitted "
      "with all tolerances free under their priors, weighed by the evidence; ties, unknown effects and what the "
      "campaign cannot see are said. Verdict first; exit code 0 whatever it is. Under mpirun the processes share the "
      "sets of --bootstrap, and the first one writes; the result is the same",
      "deflect diagnose haptic-6psu-ideal-joints measurements.csv --json diagnosis.json",
      {{"device", "DEVICE", "built-in device or device file", &a->device, true},
       {"data", "DATA", "measurements (CSV)", &a->data, true},
       {"--effects", "FILE", "effect files of your own, beside the catalogue", &a->files},
       {"--sigma", "MM", "standard deviation of one translation in mm, where the file has none", &a->sigma_mm},
       {"--sigma-rotation", "RAD", "the same of one rotation in rad", &a->sigma_rad},
       {"--as-recorded", "", "take the file as it is: do not look for mistakes of recording first", &a->as_recorded},
       {"--bootstrap", "N",
        "data sets with nothing missing that are drawn to find how often chance looks like an effect (default "
        "1999, at least 99); it is known to 1/(N+1)",
        &a->bootstrap},
       {"--threads", "N", "threads of a process (default 0: all cores); the result does not depend on it", &a->threads},
       {"--json", "FILE", "write the result", &a->json},
       report_option(&a->report)},
      [a](Ranks* ranks) { run(*a, ranks); }};
}

}  // namespace deflect::cli
