#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/frame_analysis.h"
#include "msa/mechanism/stand.h"
#include "validation/cli/command.h"
#include "validation/cli/commands/effects.h"
#include "validation/cli/devices.h"
#include "validation/cli/figures.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/diagnosis/found_effects.h"
#include "validation/figures/plan_figures.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/parse_plan.h"
#include "validation/plan/foresight.h"
#include "validation/plan/next_readings.h"
#include "validation/prediction/campaign.h"
#include "validation/report/plan/foresight_results.h"
#include "validation/report/plan/plan_results.h"
#include "validation/scene/frame_scene.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::cli {
namespace {

constexpr double most_readings = 1e5;

struct PlanArguments {
  std::string device, diagnosis, before, output, json, out, poses = "workspace", aim = "effects", use;
  std::string report;
  std::string force, moment, sigma_mm, sigma_rad;
  std::vector<std::string> data, files, nodes;
  bool forces_only = false;
  double group = 1, readings = 30, probability = 0.95, most_poses = 0, cases = 0, seed = 1, threads = 0;
  FigureArguments figures;
};

std::optional<double> largest(const char* option, const std::string& text, const char* unit, double per_SI) {
  if (text.empty()) return std::nullopt;
  const double value = parse_list(option, text, {1}, unit)[0];
  if (!(value >= 0 && value < 1e12))
    throw InputError(fmt::format("{} {}: give {} of zero or more", option, text, unit));
  return value / per_SI;
}

plan::Limits limits_of(const PlanArguments& a, const subject::Subject& s) {
  plan::Limits out;
  out.force = largest("--max-force", a.force, "N", 1);
  out.moment = largest("--max-moment", a.moment, "Nmm", 1e3);
  out.forces_only = a.forces_only;
  out.cases = as_size(whole("--max-cases", a.cases, 0, most_readings));
  out.nodes = a.nodes;
  if (a.poses == "measured")
    out.where = plan::Where::as_measured;
  else if (a.poses != "workspace")
    out.poses = read_plan(a.poses, s);
  return out;
}

/// The files of a diagnosis' measurements: several sessions are named as "first.csv + second.csv".
std::vector<std::string> session_files(const std::string& named) {
  std::error_code error;
  if (std::filesystem::exists(named, error)) return {named};
  constexpr std::string_view between = " + ";
  std::vector<std::string> out;
  for (std::size_t from = 0; from <= named.size();) {
    const std::size_t to = std::min(named.find(between, from), named.size());
    out.push_back(named.substr(from, to - from));
    from = to + between.size();
  }
  return out;
}

/// Files of the measurements that were diagnosed: as given, else as the diagnosis names them, there or next to it.
std::vector<std::string> diagnosed_files(const PlanArguments& a, const diagnosis::FoundEffects& found) {
  if (!a.data.empty()) return a.data;
  if (found.data.empty())
    throw InputError(fmt::format("{}: names no measurements: give them too, as in deflect plan {} {} DATA", a.diagnosis,
                                 a.device, a.diagnosis));
  std::vector<std::string> files = session_files(found.data);
  for (std::string& file : files) {
    if (std::filesystem::exists(file)) continue;
    const std::filesystem::path beside =
        std::filesystem::path(a.diagnosis).parent_path() / std::filesystem::path(file).filename();
    if (!std::filesystem::exists(beside))
      throw InputError(fmt::format(
          "{}: the measurements it names, '{}', are not there: give them too, as in deflect plan {} {} DATA",
          a.diagnosis, file, a.device, a.diagnosis));
    file = beside.string();
  }
  return files;
}

const diagnosis::FoundTie& tie_of(const PlanArguments& a, const diagnosis::FoundEffects& found) {
  if (found.ties.empty())
    throw InputError(
        fmt::format("{}: no effects are tied in this diagnosis, or an older version wrote it without what it "
                    "fitted: diagnose again. To see what a campaign will tell before it is measured, use --before "
                    "CAMPAIGN",
                    a.diagnosis));
  const int group = whole("--group", a.group, 1, static_cast<double>(found.ties.size()));
  return found.ties[as_size(group - 1)];
}

std::uint64_t seed_of(const PlanArguments& a) { return static_cast<std::uint64_t>(whole("--seed", a.seed, 0, 1e9)); }
std::size_t most_poses_of(const PlanArguments& a) {
  return as_size(whole("--max-poses", a.most_poses, 0, most_readings));
}

/// The file, or a campaign of a built-in name under the largest force allowed (50 N where none is given).
measurement::Measurements campaign_before(const PlanArguments& a, const subject::Subject& s,
                                          const plan::Limits& limits) {
  for (const char* name : prediction::campaign_names) {
    if (a.before != name) continue;
    measurement::Measurements out =
        s.frame() ? subject::frame_campaign(name, *s.frame(), seed_of(a))
                  : prediction::campaign(name, *s.machine(), limits.force.value_or(50), seed_of(a));
    out.origin = fmt::format("the campaign {}", name);
    return out;
  }
  return s.placed(measurement::read_campaign(a.before, s.instruments()));
}

constexpr std::size_t most_drawn = 40;  // poses

/// Of a machine with commanded poses the 3D view where the readings are taken, under the largest of each component of
/// their loads; of a frame the frame.
void write_plan_report(const PlanArguments& a, const subject::Subject& s, const measurement::Measurements& plan,
                       page::PageResult result) {
  if (a.report.empty()) return;
  if (s.frame()) {
    write_report_of_file(a.report, subject_file(a.device), std::move(result),
                         scene::frame_scene_json(*s.frame(), frame::analyse(*s.frame())));
    return;
  }
  std::vector<scene::SceneStand> stands;
  const std::vector<Configuration> machines = measurement::configure_all(*s.machine(), plan);
  for (std::size_t i = 0; i < std::min(most_drawn, machines.size()); ++i)
    stands.push_back({plan.poses[i].label, mm_deg_from(machines[i].pose), machines[i]});
  Vector6 most = Vector6::Zero();
  for (const measurement::Reading& r : plan.readings) most = most.cwiseMax(r.load.cwiseAbs());
  std::vector<Vector6> loads;
  for (Eigen::Index i = 0; i < 6; ++i)
    if (most(i) > 0) loads.push_back((i < 3 ? 1 : 1e3) * most(i) * Vector6::Unit(i));
  if (stands.empty()) return write_report_of_results(a.report, {std::move(result)});
  write_report_of_stands(a.report, a.device, *s.machine(), stands, loads, std::move(result), s.machine()->geometry);
}

/// Before any reading: what a campaign will tell.
void run_before(const PlanArguments& a, const figures::FigureStyle& style) {
  if (!a.diagnosis.empty())
    throw InputError(fmt::format("--before {}: plans a campaign before it is measured: leave out {}, or --before",
                                 a.before, a.diagnosis));
  const PlanArguments usual;
  for (const auto& [option, given] : {std::pair{"--group", a.group != usual.group},
                                      {"--readings", a.readings != usual.readings},
                                      {"--probability", a.probability != usual.probability}})
    if (given)
      throw InputError(
          fmt::format("{} is of a plan after a diagnosis; the campaign of --before keeps its length: leave "
                      "out {}, or --before",
                      option, option));
  const subject::Subject s = read_subject(a.device);
  std::vector<effects::Effect> effects = known_effects(a.files, s);
  if (s.machine()) std::erase_if(effects, [](const effects::Effect& e) { return e.place.has_value(); });
  plan::ForesightOptions o;
  o.limits = limits_of(a, s);
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3).value_or(o.sigma_u);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  if (!a.use.empty()) o.use = read_plan(a.use, s);
  if (a.aim != "effects" && a.aim != "precision")
    throw InputError(fmt::format("--aim {}: give effects or precision", a.aim));
  o.toward = a.aim == "effects" ? plan::Toward::effects : plan::Toward::precision;
  o.most_poses = most_poses_of(a);
  o.seed = seed_of(a);
  const measurement::Measurements campaign = campaign_before(a, s, o.limits);
  const int threads = parse_threads(a.threads);
  const plan::Foresight f =
      timed_with_progress("plan: what the campaign tells, and a better one", [&](const auto& told) {
        return plan::foresight(s, campaign, effects, o, {threads, nullptr, told});
      });
  if (!a.json.empty()) write_result(a.json, report::foresight_json(f));
  if (!a.output.empty()) {
    say_new_folder(a.output);
    measurement::write_measurements(a.output, f.better.readings, f.read);
  }
  if (!a.out.empty()) {
    draw({figures::foresight_figure(f, style)}, a.out);
    write_table(std::filesystem::path(a.out) / "foresight.csv", report::foresight_csv(f));
  }
  fmt::print("{}", report::foresight_report(f));
  write_plan_report(a, s, f.better.readings, {"plan", report::foresight_json(f)});
  if (!a.output.empty())
    fmt::print("\n{}: the {}, to be filled in\n", a.output,
               !f.allowed ? "campaign within the limits"
               : f.found  ? "better campaign"
                          : "given campaign");
  if (!a.out.empty()) fmt::print("\nFigure and table: {}\n", std::filesystem::absolute(a.out).string());
}

void run(const PlanArguments& a) {
  require_pages(a.report);
  const figures::FigureStyle style = figure_style(a.figures, a.out);
  if (!a.before.empty()) return run_before(a, style);
  if (a.diagnosis.empty())
    throw InputError("give the result of deflect diagnose --json, or --before CAMPAIGN to plan before measuring");
  if (!a.use.empty()) throw InputError(fmt::format("--use {}: wants --before CAMPAIGN, which it is for", a.use));
  const subject::Subject s = read_subject(a.device);
  const std::vector<effects::Effect> effects = known_effects(a.files, s);
  const diagnosis::FoundEffects found = diagnosis::read_found_effects(a.diagnosis);
  remark_if_of_another(a.diagnosis, a.device, s);
  const diagnosis::FoundTie& tie = tie_of(a, found);
  const std::vector<std::string> files = diagnosed_files(a, found);
  remark_if_of_other_data(a.diagnosis, files);
  const measurement::Measurements data = read_sessions(files, s);
  plan::PlanOptions o;
  o.limits = limits_of(a, s);
  o.noise = {parse_sigma("--sigma", a.sigma_mm, "mm", 1e3), parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1)};
  o.readings = as_size(whole("--readings", a.readings, 1, most_readings));
  o.most_poses = most_poses_of(a);
  o.seed = seed_of(a);
  if (!(a.probability > 0 && a.probability <= 1))
    throw InputError(fmt::format("--probability {}: give a value above 0, up to 1", a.probability));
  o.probability = a.probability;
  const int threads = parse_threads(a.threads);
  const plan::Plan p = timed_with_progress("plan: choose readings", [&](const auto& told) {
    return plan::next_readings(s, data, plan::rivals_of(tie, effects), o, {threads, nullptr, told});
  });
  const bool any = !p.readings.readings.empty();
  if (!a.json.empty()) write_result(a.json, report::plan_json(p));
  if (!a.output.empty() && any) {
    say_new_folder(a.output);
    measurement::write_measurements(a.output, p.readings, p.read);
  }
  if (!a.out.empty()) {
    draw({figures::plan_figure(p, style)}, a.out);
    write_table(std::filesystem::path(a.out) / "plan.csv", report::plan_csv(p));
  }
  fmt::print("{}", report::plan_report(p));
  write_plan_report(a, s, p.readings, {"plan", report::plan_json(p)});
  if (!a.output.empty() && any)
    fmt::print("\n{0}: fill in the empty cells, then: deflect diagnose {1} {2} {0}\n", a.output, a.device,
               fmt::join(session_files(p.data), " "));
  if (!a.output.empty() && !any) fmt::print("nothing to fill in: {} is not written\n", a.output);
  if (!a.out.empty()) fmt::print("\nFigure and table: {}\n", std::filesystem::absolute(a.out).string());
}

}  // namespace

Command plan_command() {
  auto a = std::make_shared<PlanArguments>();
  return {
      "plan",
      "Plan which readings to take. For effects that a diagnosis could not tell apart, the command chooses the "
      "readings that separate them most: pose, load case or node, load, sense, size, loading or unloading. It says how "
      "probable the right effect will be after them, writes the file that the laboratory fills in, names pairs that no "
      "reading separates, and the instruments that would help most beside those there are. With --before it says what "
      "a campaign will be able to tell before it is measured, and writes a better one of the same length",
      "deflect plan haptic-6psu-ideal-joints diagnosis.json -o next.csv",
      with_figures(
          {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
           {"diagnosis", "DIAGNOSIS.json", "result of deflect diagnose --json", &a->diagnosis},
           {"data", "DATA",
            "the measurements that were diagnosed, if they are not where the diagnosis names them; several are "
            "sessions",
            &a->data},
           {"--before", "paper|cycle|rich|random|FILE",
            "instead of a diagnosis: a campaign by its name, or a file, whose columns say what is read", &a->before},
           {"--aim", "effects|precision",
            "with --before: the better campaign is to tell effects apart (default), or to predict, tolerances fitted",
            &a->aim},
           {"--use", "FILE",
            "with --before: poses and loads where the machine will be used (default: twelve poses of its workspace)",
            &a->use},
           {"--group", "N", "which tie of the diagnosis (default 1)", &a->group},
           {"--readings", "N", "most readings (default 30)", &a->readings},
           {"--probability", "P", "the plan ends where the right effect is expected to be this probable (default 0.95)",
            &a->probability},
           {"--max-force", "N", "largest force along an axis, of a frame at a node (default: as in the data)",
            &a->force},
           {"--max-moment", "NMM",
            "largest moment about an axis (default: as in the data; where they have none, the force times 20 mm)",
            &a->moment},
           {"--forces-only", "", "the rig cannot apply moments", &a->forces_only},
           {"--max-cases", "N", "of a frame: load cases at once (default 0: any number of up to five, else two)",
            &a->cases},
           {"--nodes", "NODE|all",
            "of a frame: nodes where a jack or a weight can put a force along an axis (default: those that the data "
            "load)",
            &a->nodes},
           {"--poses", "workspace|measured|FILE",
            "where: poses of the data and others in the workspace (default), those of the data, or those of a "
            "measurement file",
            &a->poses},
           {"--max-poses", "N", "largest number of poses (default 0: any; with --before: as many as the campaign has)",
            &a->most_poses},
           {"--effects", "FILE", "your own effect files, in addition to the catalogue", &a->files},
           {"--sigma", "MM", "standard deviation of a translation, if the file has none (with --before: default 0.002)",
            &a->sigma_mm},
           {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
           {"--seed", "N", "seed of the poses and parameters drawn by lot (default 1)", &a->seed},
           {"--threads", "N", "threads (default 0: all cores); they do not change the result", &a->threads},
           {"-o,--output", "FILE", "write the plan: a measurement file to be filled in", &a->output},
           {"--json", "FILE", "write the result", &a->json},
           report_option(&a->report),
           {"--out", "DIR", "write the figure (SVG, PDF, PNG) with its caption, and its table", &a->out}},
          &a->figures),
      [a] { run(*a); }};
}

}  // namespace deflect::cli
