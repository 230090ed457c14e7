#include <fmt/format.h>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/cli/commands/effects.h"
#include "validation/cli/devices.h"
#include "validation/cli/report.h"
#include "validation/result_files/result_file.h"
#include "validation/result_files/result_kinds.h"

namespace deflect::cli {
namespace {

struct ReportArguments {
  std::vector<std::string> results, effects;
  std::string device, data, output, sigma_mm, sigma_rad;
  double threads = 0;
};

void run(const ReportArguments& a) {
  require_pages(a.output);
  if (a.device.empty() != a.data.empty())
    throw InputError("give --device and --data together, or neither: residuals need both");
  std::vector<page::PageResult> results;
  for (const std::string& file : a.results) {
    results.push_back({file, read_text(file)});
    result_files::read_result(results.back().json, file);  // before any work
  }
  if (a.device.empty()) {
    write_report_of_results(a.output, std::move(results));
    return;
  }
  compare::ComparisonOptions o;
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  const subject::Subject m = read_subject(a.device);
  for (const page::PageResult& result : results) require_diagnosis_of(m.name(), result);
  write_report_of_diagnosis(a.output, a.device, m, read_data(a.data, m), known_effects(a.effects, m), o,
                            parse_threads(a.threads), std::move(results));
}

}  // namespace

Command report_command() {
  auto a = std::make_shared<ReportArguments>();
  return {
      "report",
      fmt::format("Write one self-contained page from several results (--json of {}): pictures with their numbers. "
                  "With --device and --data the page draws the machine with its residuals and adds the effects that "
                  "a diagnosis among the results found",
                  result_files::commands_with_pages),
      "deflect report diagnosis.json solve.json --device haptic-6psu-ideal-joints --data measurements.csv "
      "-o report.html",
      {{"results", "RESULT.json", "results written by --json", &a->results, true},
       {"--device", "DEVICE", "built-in device or frame, or a file of one", &a->device},
       {"--data", "DATA", "measurements (CSV)", &a->data},
       {"--effects", "FILE", "your own effect files, in addition to the catalogue", &a->effects},
       {"--sigma", "MM", "standard deviation of a translation in mm, if the file has none", &a->sigma_mm},
       {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
       {"--threads", "N", "threads (default 0: all cores); they do not change the result", &a->threads},
       {"-o,--output", "FILE.html", "file to write", &a->output, true}},
      [a] { run(*a); }};
}

}  // namespace deflect::cli
