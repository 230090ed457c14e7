#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/figures.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/figures/fig11.h"
#include "validation/figures/stiffness_length.h"
#include "validation/parallel/journal.h"
#include "validation/parallel/progress.h"
#include "validation/report/map_results.h"
#include "validation/studies/map.h"

namespace deflect::cli {
namespace {

struct MapArguments {
  std::string device, ranges[3], n, tilt, load, theory, theories, length, json, out, report, resume;
  double force_N = 50, threads = 0;
  FigureArguments figures;
};

/// The workspace, or a box where a range is given.
void set_grid(const Mechanism& m, const MapArguments& a, studies::MapOptions& o) {
  std::array<int, 3> counts = {11, 11, 11};
  if (!a.n.empty()) {
    const std::vector<double> n = parse_list("--n", a.n, {1, 3}, "nx,ny,nz or one number for all");
    for (std::size_t i = 0; i < 3; ++i) counts[i] = whole("--n", n[n.size() == 1 ? 0 : i], 1, 1e6);
  }
  const char* names[] = {"--x", "--y", "--z"};
  studies::MapGrid& grid = o.grid;
  grid.counts = counts;
  const bool all = !a.ranges[0].empty() && !a.ranges[1].empty() && !a.ranges[2].empty();
  if (!all) grid = studies::workspace_grid(m, counts);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string& range = a.ranges[axis];
    if (range.empty()) continue;
    const std::vector<double> ends = parse_list(names[axis], range, {1, 2}, "from,to in mm, or one value");
    if (ends.back() < ends.front())
      throw InputError(fmt::format("{} {}: the range is reversed; write the smaller value first", names[axis], range));
    grid.low_mm(axis) = ends.front();
    grid.high_mm(axis) = ends.back();
    const auto i = as_size(axis);
    grid.counts[i] = ends.front() == ends.back() ? 1 : counts[i];
  }
  if (a.ranges[0].empty() && a.ranges[1].empty() && a.ranges[2].empty()) o.region = studies::region_of(m);
  if (!a.tilt.empty()) {
    const std::vector<double> tilt = parse_list("--tilt", a.tilt, {3}, "roll,pitch,yaw in deg");
    grid.tilt_deg = Vector3(tilt[0], tilt[1], tilt[2]);
  }
}

/// The earlier form: one theory, or both.
theories::Theories parse_theory(const std::string& name) {
  if (name == "both") return theories::all_theories();
  std::vector<std::string> names;
  for (const theories::Theory* theory : theories::all_theories()) {
    if (theory->name == name) return {theory};
    names.push_back(theory->name);
  }
  throw InputError(fmt::format("--theory '{}': write {} or both", name, fmt::join(names, ", ")));
}

double length_mm(const Mechanism& m, const std::string& text) {
  if (text.empty()) return studies::weighing_length_mm(m);
  return 1e3 * parse_length("--length", text);
}

studies::MapOptions options_of(const Mechanism& m, const MapArguments& a) {
  studies::MapOptions o;
  set_grid(m, a, o);
  o.force_N = a.force_N;
  if (!std::isfinite(a.force_N) || a.force_N == 0)
    throw InputError(fmt::format("--force {}: give a force in N other than zero", a.force_N));
  if (!a.load.empty()) {
    o.load_N_Nmm = parse_load(a.load);
    if (o.load_N_Nmm->isZero(0))
      throw InputError(fmt::format("--load {}: without load a contact has no stiffness; give a load", a.load));
  }
  if (!a.theory.empty() && !a.theories.empty()) throw InputError("give --theories or --theory, not both");
  o.theories = a.theory.empty() ? parse_theories(a.theories) : parse_theory(a.theory);
  o.length_mm = length_mm(m, a.length);
  return o;
}

/// ModelError for a map without any reached pose.
void require_reached(const studies::StiffnessMap& map) {
  if (std::any_of(map.poses.begin(), map.poses.end(), [](const studies::MapPose& p) { return p.reached(); })) return;
  throw ModelError(fmt::format(
      "the map is empty: the device reaches none of the {} poses; give --x, --y, --z or --tilt. The first pose: {}",
      map.poses.size(), map.poses.front().out_of_reach));
}

void run(const MapArguments& a, parallel::Ranks* ranks) {
  require_pages(a.report);
  const figures::FigureStyle style = figure_style(a.figures, a.out);
  const Mechanism m = read_device(a.device);
  const studies::MapOptions o = options_of(m, a);
  const int threads = parse_threads(a.threads, ranks);
  std::optional<parallel::Journal> journal;
  if (!a.resume.empty()) journal.emplace(a.resume, identity_of_run(), ranks);
  studies::StiffnessMap map;
  {
    const std::size_t poses = o.grid.size();
    const Step step(fmt::format("map: {} poses, {}", poses, theories::titles_of(o.theories)));
    parallel::Progress progress(poses, "poses", progress_stream());
    const auto told = [&](double share) { progress.update(as_size(std::lround(share * static_cast<double>(poses)))); };
    map = studies::map_stiffness(m, o, {threads, ranks, told, journal ? &*journal : nullptr});
  }
  if (ranks && !ranks->first()) return;
  require_reached(map);
  const std::filesystem::path folder = a.out;
  std::string figures;
  if (!a.out.empty()) {
    write_table(folder / "map.csv", report::map_csv(map));
    write_table(folder / "map.vtu", report::map_vtu(map));
    std::vector<figures::Figure> drawn = figures::fig11(map, style);
    for (figures::Figure& figure : figures::stiffness_against_length(map, style)) drawn.push_back(std::move(figure));
    figures = draw(drawn, folder);
  }
  if (!a.json.empty()) write_result(a.json, report::map_json(map));
  fmt::print("{}", report::map_report(map));
  if (!a.out.empty())
    fmt::print("\nTables map.csv, map.vtu and figures {} in {}\n", figures.empty() ? "(none)" : figures,
               std::filesystem::absolute(folder).string());
  if (!a.report.empty()) {
    const Stand home = parse_stand(m, "", "", true);
    const Vector6 load = o.load_N_Nmm.value_or(o.force_N * Vector6::Unit(2));
    write_report_of_stands(a.report, a.device, m, {{"home", home.pose_mm_deg, home.configuration}}, {load},
                           {"map", report::map_json(map)});
  }
  if (journal) journal->remove();
}

}  // namespace

Command map_command() {
  auto a = std::make_shared<MapArguments>();
  return {
      "map",
      "Map the stiffness of the tool point by direction over the workspace: a grid of poses, both theories, Fig. 11.\n"
      "With --force (the default) every pose is loaded along x, y and z in turn. The compliance C = u/F is then "
      "secant, from no load to the force. The 6x6 stiffness K (its diagonal, smallest, largest, isotropy) is tangent "
      "at the force. With --load both are tangent under that wrench. Secant and tangent differ if contacts carry load. "
      "The MSA uses one element per member, which is exact at its nodes. Under mpirun the processes share the poses "
      "and the first one writes; the result is the same.",
      "deflect map haptic-6psu --n 21,21,21 --x -40,40 --y -40,40 --z 124,224 --out map --json map.json",
      with_figures(
          {{"device", "DEVICE", "built-in device or device file", &a->device, true},
           {"--x", "from,to",
            "range of the tool point in mm, or one value (default: the workspace; its box if any range is given)",
            &a->ranges[0]},
           {"--y", "from,to", "the same along y", &a->ranges[1]},
           {"--z", "from,to", "the same along z", &a->ranges[2]},
           {"--n", "nx,ny,nz", "poses along x, y, z, or one number for all (default 11)", &a->n},
           {"--tilt", "roll,pitch,yaw", "orientation at all poses in deg (default: that of the workspace's centre)",
            &a->tilt},
           {"--force", "N", "force along x, y, z in turn, in N (default 50)", &a->force_N},
           {"--load", "fx,fy,fz,mx,my,mz", "one wrench in N and Nmm instead of --force", &a->load},
           theories_option(&a->theories),
           {"--theory", "NAME", "one theory, or both: the earlier form of --theories", &a->theory},
           {"--length", "LENGTH",
            "characteristic length, with unit, that turns rotations into displacements in the isotropy (default: the "
            "platform's radius, or the machine's extent)",
            &a->length},
           {"--threads", "N", "threads per process (default 0: all cores); they do not change the result", &a->threads},
           {"--resume", "FILE",
            "keep finished poses in FILE: the same command goes on there after Ctrl-C or a crash; removed at the end",
            &a->resume},
           {"--json", "FILE", "write the summary and the arrays", &a->json},
           report_option(&a->report),
           {"--out", "DIR",
            "write fig11 and stiffness-vs-length as SVG, PDF, PNG with their captions, and map.csv, map.vtu", &a->out}},
          &a->figures),
      [a](parallel::Ranks* ranks) { run(*a, ranks); }};
}

}  // namespace deflect::cli
