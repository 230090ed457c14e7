#include "validation/cli/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/stand.h"
#include "validation/cli/devices.h"
#include "validation/cli/talk.h"
#include "validation/compare/history.h"
#include "validation/diagnosis/found_effects.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/column_names.h"
#include "validation/measurement/configure_all.h"
#include "validation/report/compare_results.h"
#include "validation/report/history_results.h"
#include "validation/result_files/result_file.h"
#include "validation/scene/frame_scene.h"

namespace deflect::cli {
namespace {

constexpr std::size_t most_stands = 40;

/// What was typed, one space between words, words with others than plain letters in quotes.
std::string command_line() {
  std::string out;
  const std::string raw = outcome_of<InputError>([] { return read_text("/proc/self/cmdline"); }).value.value_or("");
  if (raw.empty()) return "";
  for (std::size_t from = 0; from < raw.size();) {
    const std::size_t to = std::min(raw.find('\0', from), raw.size());
    std::string word = raw.substr(from, to - from);
    if (from == 0) word = std::filesystem::path(word).filename().string();
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
      return std::isalnum(c) || c > 127 ||
             std::string_view("-_./,=:+@%").find(static_cast<char>(c)) != std::string_view::npos;
    });
    out += (out.empty() ? "" : " ") + (plain ? word : "'" + word + "'");
    from = to + 1;
  }
  return out;
}

page::PageSource source_of(const std::string& path) {
  return {std::filesystem::path(path).filename().string(), read_text(path)};
}

/// The file of the measurements; of several sessions all readings as one.
page::PageSource source_of(const measurement::Measurements& data) {
  std::error_code error;
  if (std::filesystem::exists(data.origin, error)) return source_of(data.origin);
  return {data.origin, measurement::measurements_text(data)};
}

page::PageContents contents(const std::string& device) {
  page::PageContents page;
  page.version = DEFLECT_VERSION;
  page.command = command_line();
  if (!device.empty()) page.device = source_of(subject_file(device).string());
  return page;
}

void write_page(const std::string& file, const page::PageContents& page) {
  write_file(file, page::page_html(page));
  fmt::print("Report: {}\n", std::filesystem::absolute(file).string());
}

/// Poses of the measurements, of many those where the residual is largest, in their order.
std::vector<scene::SceneStand> stands_of(const compare::Comparison& c, const std::vector<Configuration>& machines) {
  std::vector<std::size_t> shown(c.by_pose.size());
  std::iota(shown.begin(), shown.end(), std::size_t{0});
  std::stable_sort(shown.begin(), shown.end(),
                   [&](std::size_t a, std::size_t b) { return c.by_pose[a].rmse > c.by_pose[b].rmse; });
  shown.resize(std::min(shown.size(), most_stands));
  std::sort(shown.begin(), shown.end());
  std::vector<scene::SceneStand> out;
  for (const std::size_t p : shown) {
    const Configuration& machine = machines[p];
    out.push_back({c.study.data->poses[p].label, mm_deg_from(machine.pose), machine});
  }
  return out;
}

/// For each component that the readings load, its largest size alone.
std::vector<Vector6> largest_loads(const measurement::Measurements& data) {
  Vector6 largest = Vector6::Zero();
  for (const measurement::Reading& r : data.readings) largest = largest.cwiseMax(r.load.cwiseAbs());
  std::vector<Vector6> out;
  for (int i = 0; i < 6; ++i)
    if (largest(i) > 0) out.push_back(largest(i) * Vector6::Unit(i));
  return out;
}

/// What a diagnosis names as missing, with the values found.
std::vector<effects::EffectInstance> found_in(const page::PageResult& result,
                                              const std::vector<effects::Effect>& effects) {
  if (result_files::read_result(result.json, result.origin).kind != "diagnosis") return {};
  std::vector<effects::EffectInstance> out;
  for (const diagnosis::FoundEffect& found : diagnosis::parse_found_effects(result.json, result.origin).missing)
    out.push_back(diagnosis::instance(effects::find_effect(effects, found.effect), found));
  return out;
}

/// The frame under each of its load cases; marked are the parts in which the last version differs from the first.
Json scene_of_frames(const compare::Comparison& first, const compare::Comparison& last) {
  const frame::FrameDescription &f = *first.study.subject->frame(), &latest = *last.study.subject->frame();
  return scene::frame_scene_json(f, frame::analyse(f), scene::changed_parts(f, latest));
}

}  // namespace

Option report_option(std::string* file) {
  return {"--report", "FILE.html", "write an HTML page with the result in pictures and numbers", file};
}

void require_pages(const std::string& file) {
  if (file.empty() || page::pages_are_built()) return;
  throw InputError(
      fmt::format("--report {}: this deflect was built without pages: install esbuild, libjs-three and libjs-chart.js, "
                  "configure and build again",
                  file));
}

void require_diagnosis_of(const std::string& device, const page::PageResult& result) {
  const result_files::ReadResult read = result_files::read_result(result.json, result.origin);
  if (read.kind != "diagnosis") return;
  if (const std::string of = read.json.value("device", device); of != device)
    throw InputError(fmt::format("{}: this diagnosis is of '{}', but --device is '{}'", result.origin, of, device));
}

void write_report(const std::string& file, const std::string& device, const std::vector<compare::Comparison>& versions,
                  std::vector<page::PageResult> results) {
  const compare::Comparison &first = versions.front(), &last = versions.back();
  page::PageContents page = contents(device);
  page.data = source_of(*first.study.data);
  page.results = std::move(results);
  const std::string origin = page.results.empty() ? first.data : page.results.front().origin;
  if (versions.size() > 1 && origin != "history")
    page.results.push_back({origin, report::history_json(compare::history(versions))});
  for (const compare::Comparison& c : versions) page.versions.push_back(&c);
  if (first.study.subject->frame()) {
    page.scene = scene_of_frames(first, last);
    return write_page(file, page);
  }
  const Mechanism &m = *first.study.subject->machine(), &latest = *last.study.subject->machine();
  const std::vector<Configuration> machines = measurement::configure_all(m, *first.study.data);
  const Configuration changed = measurement::configure_all(latest, measurement::one_pose(*first.study.data, 0)).front();
  page.scene = scene::scene_json(m, stands_of(first, machines), largest_loads(*first.study.data),
                                 effects::changed_parts(machines.front(), changed), m.geometry);
  write_page(file, page);
}

void write_report_of_diagnosis(const std::string& file, const std::string& device, const subject::Subject& m,
                               const measurement::Measurements& data, const std::vector<effects::Effect>& effects,
                               const compare::ComparisonOptions& options, int threads,
                               std::vector<page::PageResult> results) {
  std::vector<subject::Subject> devices = {m};
  std::string name = m.name();
  for (const page::PageResult& result : results) {
    const auto added = outcome_of<InputError>([&] {
      for (const effects::EffectInstance& e : found_in(result, effects)) {
        name += fmt::format(" + {}{}", e.effect->name, e.leg ? " (" + effects::site_of(e) + ")" : "");
        devices.push_back(effects::with_effect(devices.back(), e).named(name));
      }
      return true;
    });
    if (added) continue;
    if (added.why.starts_with(result.origin)) throw InputError(added.why);
    throw InputError(fmt::format("{}: its effects do not fit {}: is it a diagnosis of another device? {}",
                                 result.origin, m.name(), added.why));
  }
  std::vector<compare::Comparison> versions;
  for (const subject::Subject& each : devices)
    versions.push_back(
        timed("compare with " + each.name(), [&] { return compare::compare(each, data, options, {threads}); }));
  write_report(file, device, versions, std::move(results));
}

void write_report_of_stands(const std::string& file, const std::string& device, const Mechanism& m,
                            const std::vector<scene::SceneStand>& stands, const std::vector<Vector6>& loads_N_Nmm,
                            page::PageResult result, Geometry geometry) {
  page::PageContents page = contents(device);
  page.results = {std::move(result)};
  std::vector<Vector6> loads;
  for (const Vector6& load : loads_N_Nmm) loads.push_back(wrench_from_mm(load));
  page.scene = scene::scene_json(m, stands, loads, {}, geometry);
  write_page(file, page);
}

void write_report_of_file(const std::string& file, const std::filesystem::path& source, page::PageResult result,
                          Json scene) {
  page::PageContents page = contents("");
  page.device = source_of(source.string());
  page.results = {std::move(result)};
  page.scene = std::move(scene);
  write_page(file, page);
}

void write_report_of_results(const std::string& file, std::vector<page::PageResult> results) {
  page::PageContents page = contents("");
  page.results = std::move(results);
  write_page(file, page);
}

}  // namespace deflect::cli
