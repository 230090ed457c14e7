// benchmark_plans [--truths N] [--threads N] [--pair SUBJECT,FIRST,SECOND[,LAMBDA[,MOMENT[,nodes]]]]…
//   [--precision DEVICE [--moment NM]]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "msa/base/memory.h"
#include "tests/benchmark/plans/loop.h"
#include "tests/benchmark/plans/precision.h"

namespace {

using deflect::benchmark::Tied;

/// Alike under the paper's plan: play against friction and against what else steps or bends its line; what yields along
/// the legs against what yields at the platform; roots that turn against roots that shift.
const std::vector<Tied> usual = {
    {"haptic-6psu-ideal-joints", "joint_clearance", "joint_friction"},
    {"haptic-6psu-ideal-joints", "joint_clearance", "actuator_backlash", 6},
    {"haptic-6psu-ideal-joints", "joint_friction", "load_misalignment", 4},
    {"haptic-6psu-ideal-joints", "actuator_compliance", "platform_flexibility", 8, 5},
    {"haptic-6psu-ideal-joints", "guide_root_compliance", "carriage_compliance", 4},
    {"stewart-6ups", "joint_clearance", "actuator_hardening"},
    {"stewart-6ups", "actuator_compliance", "tool_compliance"},
    {"stewart-6ups", "base_tilt", "base_compliance", 4},
    {"portal-semi-rigid", "clearance@support.D.uz", "settled@support.D.uz"},
    {"portal-semi-rigid", "friction@beam_2.end.ry", "factor@beam_2.end.ry"},
    {"portal-semi-rigid", "push@support.D.ry", "push@support.D.ux", 4},
};

Tied pair_of(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  parts.resize(std::max<std::size_t>(parts.size(), 3));
  Tied out{parts[0], parts[1], parts[2]};
  if (parts.size() > 3) out.lambda = std::atof(parts[3].c_str());
  if (parts.size() > 4) out.moment = std::atof(parts[4].c_str());
  if (parts.size() > 5) out.nodes = parts[5] == "nodes";
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  deflect::keep_freed_memory();
  std::size_t truths = 10;
  int threads = 1;
  std::vector<Tied> pairs;
  std::string precision;
  std::optional<double> moment;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--truths") truths = static_cast<std::size_t>(std::atoi(value.c_str()));
    if (option == "--threads") threads = std::atoi(value.c_str());
    if (option == "--pair") pairs.push_back(pair_of(value));
    if (option == "--precision") precision = value;
    if (option == "--moment") moment = std::atof(value.c_str());
  }
  if (!precision.empty()) {
    fmt::print("{}", deflect::benchmark::precision_table(precision, 50, moment, threads));
    return 0;
  }
  if (pairs.empty()) pairs = usual;
  std::vector<std::pair<Tied, std::vector<deflect::benchmark::LoopResult>>> all;
  for (const Tied& t : pairs) all.emplace_back(t, deflect::benchmark::run_loops(t, truths, 1, threads));
  fmt::print("{}", deflect::benchmark::loop_table(all));
}
