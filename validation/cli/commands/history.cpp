#include <fmt/format.h>

#include <filesystem>

#include "msa/base/error.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/figures.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/compare/history.h"
#include "validation/figures/history_figure.h"
#include "validation/report/history_results.h"

namespace deflect::cli {
namespace {

struct HistoryArguments {
  std::string data, json, out, report, sigma_mm, sigma_rad;
  std::vector<std::string> devices;
  double threads = 0;
  FigureArguments figures;
};

/// "versions 1 and 3 are the same machine, …" of any two whose descriptions differ in name and remarks at most.
std::string same_subjects(const std::vector<subject::Subject>& devices) {
  std::vector<std::string> texts;
  for (const subject::Subject& s : devices) texts.push_back(s.file_text("", ""));
  std::string out;
  for (std::size_t i = 0; i < texts.size(); ++i)
    for (std::size_t k = i + 1; k < texts.size(); ++k)
      if (texts[i] == texts[k])
        out += fmt::format("versions {} ({}) and {} ({}) are the same {}: the error cannot fall between them\n", i + 1,
                           devices[i].name(), k + 1, devices[k].name(), devices[i].frame() ? "frame" : "machine");
  return out;
}

void run(const HistoryArguments& a) {
  require_pages(a.report);
  const figures::FigureStyle style = figure_style(a.figures, a.out);
  compare::ComparisonOptions o;
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  const int threads = parse_threads(a.threads);
  std::vector<subject::Subject> devices;
  for (const std::string& name : a.devices) devices.push_back(read_subject(name));
  const measurement::Measurements data = read_data(a.data, devices.front());
  const std::vector<compare::Comparison> all = timed_with_progress("compare with each", [&](const auto& told) {
    std::vector<compare::Comparison> out;
    const auto versions = static_cast<double>(devices.size());
    for (const subject::Subject& m : devices) {
      const auto before = static_cast<double>(out.size());
      const parallel::Work work =
          parallel::Work{threads, nullptr, told}.part(before / versions, (before + 1) / versions);
      out.push_back(timed("compare with " + m.name(), [&] { return compare::compare(m, data, o, work); }));
    }
    return out;
  });
  const compare::History h = timed("placebos", [&] { return compare::history(all); });
  const std::filesystem::path folder = a.out;
  if (!a.out.empty()) {
    draw({figures::history_figure(h, style)}, folder);
    write_table(folder / "history.csv", report::history_csv(h));
  }
  if (!a.json.empty()) write_result(a.json, report::history_json(h));
  fmt::print("{}{}", report::history_report(h), same_subjects(devices));
  if (!a.out.empty()) fmt::print("\nFigure and table: {}\n", std::filesystem::absolute(folder).string());
  if (!a.report.empty()) write_report(a.report, a.devices.front(), all, {{"history", report::history_json(h)}});
}

}  // namespace

Command history_command() {
  auto a = std::make_shared<HistoryArguments>();
  return {
      "history",
      "Show how the error falls from version to version of a device, on one set of measurements: all poses, held-out "
      "poses, tests that still fail, remaining patterns, strained tolerances",
      "deflect history measurements.csv haptic-6psu-ideal-joints softer.yaml --out history",
      with_figures(
          {{"data", "DATA", "measurements (CSV)", &a->data, true},
           {"devices", "DEVICE", "versions in order: built-in devices or frames, or files of them", &a->devices, true},
           {"--sigma", "MM", "standard deviation of a translation in mm, if the file has none", &a->sigma_mm},
           {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
           {"--threads", "N", "threads (default 0: all cores); they do not change the result", &a->threads},
           {"--json", "FILE", "write the result", &a->json},
           report_option(&a->report),
           {"--out", "DIR", "write the figure (SVG, PDF, PNG) with its caption, and the table", &a->out}},
          &a->figures),
      [a] { run(*a); }};
}

}  // namespace deflect::cli
