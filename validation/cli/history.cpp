#include <fmt/format.h>

#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/mechanism/device_file.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/report.h"
#include "validation/report/history_results.h"

namespace deflect::cli {
namespace {

struct Arguments {
  std::string data, json, out, report, sigma_mm, sigma_rad;
  std::vector<std::string> devices;
  double threads = 0;
};

void run(const Arguments& a) {
  require_pages(a.report);
  const Measurements data = read_measurements(a.data);
  ComparisonOptions o;
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  o.threads = whole("--threads", a.threads, 0, 1024);
  std::vector<Mechanism> devices;
  for (const std::string& name : a.devices) devices.push_back(read_mechanism(device_file(name)));
  std::vector<Comparison> all;
  for (const Mechanism& m : devices) all.push_back(compare(m, data, o));
  const std::filesystem::path folder = a.out;
  if (!a.out.empty()) {
    render(history_figure(all), folder);
    write_text(folder / "history.csv", history_csv(all));
  }
  if (!a.json.empty()) write_text(a.json, history_json(all));
  fmt::print("{}", history_report(all));
  if (!a.out.empty()) fmt::print("\nFigure and table: {}\n", std::filesystem::absolute(folder).string());
  if (!a.report.empty()) write_report(a.report, a.devices.front(), all, {{"history", history_json(all)}});
}

}  // namespace

Command history_command() {
  auto a = std::make_shared<Arguments>();
  return {"history",
          "The error falling from version to version of a device on one set of measurements: all poses, held-out "
          "poses, tests "
          "that still fail, patterns left, tolerances that would have to be strained",
          "deflect history measurements.csv haptic-6psu-ideal-joints softer.yaml --out history",
          {{"data", "DATA", "measurements (CSV)", &a->data, true},
           {"devices", "DEVICE", "devices in order, built-in or files", &a->devices, true},
           {"--sigma", "MM", "standard deviation of one translation in mm, where the file has none", &a->sigma_mm},
           {"--sigma-rotation", "RAD", "the same of one rotation in rad", &a->sigma_rad},
           {"--threads", "N", "threads (default 0: all cores); the result does not depend on it", &a->threads},
           {"--json", "FILE", "write the result", &a->json},
           report_option(&a->report),
           {"--out", "DIR", "write the figure and the table", &a->out}},
          [a] { run(*a); }};
}

}  // namespace deflect::cli
