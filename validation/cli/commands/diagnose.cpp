#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "msa/base/error.h"
#include "validation/cli/command.h"
#include "validation/cli/commands/effects.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/parallel/journal.h"
#include "validation/report/diagnosis_results.h"

namespace deflect::cli {
namespace {

struct DiagnoseArguments {
  std::string device, json, out, report;
  std::vector<std::string> data, files;
  std::string sigma_mm, sigma_rad, resume;
  bool as_recorded = false;
  double bootstrap = 1999, threads = 0;
};

void run(const DiagnoseArguments& a, parallel::Ranks* ranks) {
  require_pages(a.report);
  const subject::Subject m = read_subject(a.device);
  const measurement::Measurements data = read_sessions(a.data, m);
  tell_size(data, 1200);
  const std::vector<effects::Effect> effects = known_effects(a.files, m);
  diagnosis::DiagnosisOptions o;
  o.comparison.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.comparison.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  o.comparison.as_recorded = a.as_recorded;
  o.bootstrap_sets = whole("--bootstrap", a.bootstrap, 99, 1e9);
  const int threads = parse_threads(a.threads, ranks);
  std::optional<parallel::Journal> journal;
  if (!a.resume.empty()) journal.emplace(a.resume, identity_of_run(), ranks);
  const diagnosis::Diagnosis d = timed_with_progress("diagnose: fit and weigh every effect", [&](const auto& told) {
    return diagnosis::diagnose(m, data, effects, o, {threads, ranks, told, journal ? &*journal : nullptr});
  });
  if (ranks && !ranks->first()) return;
  for (const effects::PlacedEffect& found : d.missing) tell("found: {}", diagnosis::name_of(found));
  if (!a.json.empty()) write_result(a.json, report::diagnosis_json(d));
  const std::string report = report::diagnosis_report(d, m.name(), data.origin);
  if (!a.out.empty()) {
    const std::filesystem::path folder = a.out;
    write_table(folder / "diagnosis.txt", report);
    write_table(folder / "candidates.csv", report::candidates_csv(d));
    write_table(folder / "detectable.csv", report::detectable_csv(d));
  }
  fmt::print("{}", report);
  if (!a.report.empty())
    write_report_of_diagnosis(a.report, a.device, m, data, effects, o.comparison, threads,
                              {{"diagnose", report::diagnosis_json(d)}});
  if (journal) journal->remove();
}

}  // namespace

Command diagnose_command() {
  auto a = std::make_shared<DiagnoseArguments>();
  return {
      "diagnose",
      "Find which physical effect the model lacks. The command first checks the file for recording mistakes "
      "(units, signs, axes, columns, poses). If one is certain, the report names it and the search ends. Otherwise "
      "the command fits every effect of the catalogue at every possible place in the device, and every law at every "
      "other place (as in clearance@elbow.rz), with all tolerances free under their priors, and weighs the fits by "
      "their evidence. The report starts with the verdict. It lists ties, unknown effects and effects that the "
      "campaign cannot detect. The exit code is 0 for every verdict. Under mpirun the processes share the "
      "sets of --bootstrap and the first one writes; the result is the same",
      "deflect diagnose haptic-6psu-ideal-joints measurements.csv --json diagnosis.json",
      {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
       {"data", "DATA", "measurements (CSV); several files are sessions of one campaign", &a->data, true},
       {"--effects", "FILE", "your own effect files, in addition to the catalogue", &a->files},
       {"--sigma", "MM", "standard deviation of a translation in mm, if the file has none", &a->sigma_mm},
       {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
       {"--as-recorded", "", "take the file as it is: skip the search for recording mistakes", &a->as_recorded},
       {"--bootstrap", "N",
        "random data sets with nothing missing; they give the chance of a false alarm to 1/(N+1) (default 1999, at "
        "least 99)",
        &a->bootstrap},
       {"--threads", "N", "threads per process (default 0: all cores); they do not change the result", &a->threads},
       {"--resume", "FILE",
        "keep finished sets of --bootstrap in FILE: the same command goes on there after Ctrl-C or a crash; removed at "
        "the end",
        &a->resume},
       {"--json", "FILE", "write the result", &a->json},
       {"--out", "DIR", "write report and tables: diagnosis.txt, candidates.csv, detectable.csv", &a->out},
       report_option(&a->report)},
      [a](parallel::Ranks* ranks) { run(*a, ranks); }};
}

}  // namespace deflect::cli
