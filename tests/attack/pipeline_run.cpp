#include "tests/attack/pipeline_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "msa/base/files.h"
#include "msa/base/outcome.h"
#include "msa/fields/file_kind.h"
#include "msa/fields/yaml_tree.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "tests/attack/pipeline_checks.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "tests/support/sanitizers.h"
#include "validation/measurement/column_names.h"
#include "validation/measurement/replicates.h"
#include "validation/result_files/result_file.h"

namespace deflect::attack {
namespace {

namespace fs = std::filesystem;

/// Of a step: of the processor, so that a machine with other work to do fails none; and in all.
constexpr int most_seconds = 100 * test::times_slower, most_waiting = 1500 * test::times_slower;
constexpr int out_of_time = 124, out_of_processor = 128 + 24;  // exit codes: of timeout; SIGXCPU

/// One step of the program. An end that no user should see is a contradiction.
test::Run step(const std::string& name, const std::string& arguments, const fs::path& folder, PipelineJudgement& j) {
  test::Run run = test::command(fmt::format("cd '{}' && ulimit -t {} && timeout {} '{}' {} {}", folder.string(),
                                            most_seconds, most_waiting, test::program(), name, arguments));
  const auto tell = [&](const char* what) { j.wrong.push_back({name + " " + what, run.out}); };
  if (run.code == out_of_time || run.code == out_of_processor)
    tell("does not end");
  else if (run.code != 0 && run.code != 2 && run.code != 3 && run.code != 4)
    tell("crashes");
  else if (run.code != 0 && run.out.find("deflect: ") == run.out.npos)
    tell("refuses without a word");
  else if (run.code != 0 && j.refused.empty())
    j.refused = name + ": " + run.out.substr(run.out.rfind("deflect: "));
  return run;
}

Json result(const fs::path& file, PipelineJudgement& j) {
  const auto read = outcome_of([&] { return result_files::read_result(read_text(file), file.filename().string()); });
  if (!read) j.wrong.push_back({"a result that cannot be read", read.why});
  return read ? read->json : Json();
}

subject::Subject read_subject(const fs::path& file) {
  const std::string text = read_text(file);
  if (kind_of(parse_yaml(text, file.string())) == FileKind::frame) return frame::parse_frame(text, file.string());
  return parse_mechanism(text, file.string());
}

/// Without readings; a frame's is factors on its load cases.
std::string plan_text(const measurement::Measurements& plan) {
  if (!plan.instruments.stationary) return measurement::measurements_text(plan);
  std::string out = plan.readings.front().sequence ? "sequence" : "note";
  for (const std::string& name : plan.instruments.load_cases) out += ",load." + name;
  for (const measurement::Reading& r : plan.readings) {
    out += r.sequence ? fmt::format("\n{}", *r.sequence) : "\n";
    for (const double factor : r.factors) out += fmt::format(",{}", factor);
  }
  return out + "\n";
}

/// Measured numbers of data.csv.
double numbers_in(const fs::path& folder) {
  const measurement::Measurements data =
      measurement::read_measurements(folder / "data.csv", read_subject(folder / "subject.yaml").instruments());
  return static_cast<double>(measurement::measured_values(data).size());
}

/// Whether the data or the subject tell the noise of every channel; where none does, each comparison takes it from what
/// it leaves.
bool tells_noise(const fs::path& folder) {
  const std::string data = read_text(folder / "data.csv"), header = "," + data.substr(0, data.find('\n')) + ",";
  const auto has = [&](const std::string& column) { return header.find("," + column + ",") != header.npos; };
  bool length = has("ux_mm") || has("uy_mm") || has("uz_mm"),
       angle = has("thx_rad") || has("thy_rad") || has("thz_rad");
  for (const measurement::SensorChannel& s : read_subject(folder / "subject.yaml").instruments().sensors) {
    if (s.sigma || !has(measurement::sensor_column(s))) continue;
    if (s.quantity != measurement::Quantity::length && s.quantity != measurement::Quantity::angle) return false;
    (s.quantity == measurement::Quantity::length ? length : angle) = true;
  }
  return (!length || has("sigma_u_mm")) && (!angle || has("sigma_th_rad"));
}

/// With what was found in it; nothing where nothing was.
void add_and_follow(const fs::path& folder, const Json& diagnosis, PipelineJudgement& j) {
  if (diagnosis["missing"].empty()) return;
  if (step("add", "subject.yaml --from diagnosis.json -o after.yaml", folder, j).code != 0) {
    j.wrong.push_back({"what was found cannot be added", j.refused});
    return;
  }
  if (step("history", "data.csv subject.yaml after.yaml --threads 1 --json history.json", folder, j).code != 0) {
    j.wrong.push_back({"what was found cannot be followed", j.refused});
    return;
  }
  const Json history = result(folder / "history.json", j);
  if (!history.is_null()) check_history(history, diagnosis, numbers_in(folder), tells_noise(folder), j.wrong);
}

}  // namespace

std::string placed_name(const std::string& effect, int leg) {
  return leg > 0 ? fmt::format("{} (leg {})", effect, leg) : effect;
}

bool simulate(const Pipeline& p, const fs::path& folder, PipelineJudgement& j) {
  write_text(folder / "subject.yaml", p.subject.file_text("subject", ""));
  write_text(folder / "plan.csv", plan_text(p.plan));
  std::string words = fmt::format("subject.yaml --campaign plan.csv --noise {:.6g} --seed {} -o data.csv --threads 1",
                                  std::min(p.noise_mm, 999.0), p.seed);
  if (p.noise_rad > 0) words += fmt::format(" --noise-rotation {:.6g}", std::min(p.noise_rad, 1.0));
  if (p.outliers > 0) words += fmt::format(" --outliers {}", p.outliers);
  for (const HiddenEffect& h : p.hidden) words += fmt::format(" --with '{}'", h.words);
  if (step("simulate", words, folder, j).code != 0) return false;
  const auto data =
      outcome_of([&] { return measurement::read_measurements(folder / "data.csv", p.subject.instruments()); });
  if (!data) {
    j.wrong.push_back({"simulated data that cannot be read", data.why});
    return false;
  }
  write_text(folder / "data.csv", measurement::measurements_text(spoilt(*data, p.spoilt, p.seed)));
  return true;
}

void run_from_data(const fs::path& folder, bool page, PipelineJudgement& j) {
  if (step("compare", "subject.yaml data.csv --threads 1 --json compare.json", folder, j).code != 0) return;
  const Json comparison = result(folder / "compare.json", j);
  if (!comparison.is_null()) check_comparison(comparison, j.wrong);
  if (step("diagnose", "subject.yaml data.csv --bootstrap 199 --threads 1 --json diagnosis.json", folder, j).code !=
      0) {
    j.wrong.push_back({"what can be compared cannot be diagnosed", j.refused});
    return;
  }
  const Json diagnosis = result(folder / "diagnosis.json", j);
  if (diagnosis.is_null()) return;
  j.verdict = diagnosis["verdict"];
  j.mistaken = diagnosis["candidates"].empty();
  check_diagnosis(diagnosis, read_subject(folder / "subject.yaml"), numbers_in(folder), j.wrong);
  for (const Json& found : diagnosis["found"]) j.missing.push_back(placed_name(found["effect"], found.value("leg", 0)));
  j.reported = j.missing;
  for (const Json& tie : diagnosis["ties"])
    for (const Json& rival : tie["rivals"]) {
      const Json& added = rival["effects"].back();
      j.reported.push_back(placed_name(added["effect"], added.value("leg", 0)));
    }
  if (!j.mistaken) j.probability = diagnosis["candidates"][0]["probability"];
  add_and_follow(folder, diagnosis, j);
  if (page)
    step("report", "diagnosis.json compare.json --device subject.yaml --data data.csv --threads 1 -o page.html", folder,
         j);
}

double gain_of(const HiddenEffect& h, const fs::path& folder) {
  if (!fs::exists(folder / "diagnosis.json")) return 0;
  const Json d = Json::parse(read_text(folder / "diagnosis.json"));
  for (const Json& c : d["candidates"]) {
    if (c["effect"] != h.name || c.value("leg", 0) != h.leg.value_or(0)) continue;
    return numbers_in(folder) * (d["baseline"]["chi2_per_dof"].get<double>() - c["chi2_per_dof"].get<double>());
  }
  return 0;
}

PipelineJudgement judge(const Pipeline& p) {
  PipelineJudgement j;
  const test::Folder folder;
  const fs::path at = folder / ".";
  if (!simulate(p, at, j)) return j;
  run_from_data(at, p.seed % 5 == 0, j);
  if (p.hidden.size() == 1) j.gain = gain_of(p.hidden.front(), at);
  return j;
}

}  // namespace deflect::attack
