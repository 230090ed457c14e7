// benchmark_plans [--truths N] [--threads N] [--pair SUBJECT,FIRST,SECOND]… [--precision DEVICE]
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/benchmark/plans/loop.h"
#include "tests/benchmark/plans/precision.h"

namespace {

using deflect::benchmark::Tied;

const std::vector<Tied> usual = {
    {"haptic-6psu-ideal-joints", "joint_clearance", "joint_friction"},
    {"haptic-6psu-ideal-joints", "actuator_compliance", "platform_flexibility"},
    {"haptic-6psu-ideal-joints", "guide_root_compliance", "carriage_compliance"},
    {"stewart-6ups", "joint_clearance", "one_sided_actuation"},
    {"stewart-6ups", "actuator_compliance", "base_tilt"},
    {"stewart-6ups", "actuator_compliance", "hertz_contact"},
    {"portal-semi-rigid", "clearance@support.A.ux", "linear@support.A.ux"},
    {"portal-semi-rigid", "linear@support.A.ux", "linear@support.A.ry"},
    {"portal-semi-rigid", "factor@beam_1.start.ry", "linear@beam_1.end.ry"},
};

Tied pair_of(const std::string& text) {
  const std::size_t a = text.find(','), b = text.find(',', a + 1);
  return {text.substr(0, a), text.substr(a + 1, b - a - 1), text.substr(b + 1)};
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t truths = 10;
  int threads = 1;
  std::vector<Tied> pairs;
  std::string precision;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--truths") truths = static_cast<std::size_t>(std::atoi(value.c_str()));
    if (option == "--threads") threads = std::atoi(value.c_str());
    if (option == "--pair") pairs.push_back(pair_of(value));
    if (option == "--precision") precision = value;
  }
  if (!precision.empty()) {
    fmt::print("{}", deflect::benchmark::precision_table(precision, 50, threads));
    return 0;
  }
  if (pairs.empty()) pairs = usual;
  std::vector<std::pair<Tied, std::vector<deflect::benchmark::LoopResult>>> all;
  for (const Tied& t : pairs) all.emplace_back(t, deflect::benchmark::run_loops(t, truths, 1, threads));
  fmt::print("{}", deflect::benchmark::loop_table(all));
}
