#include "tests/benchmark/cases.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace deflect::benchmark {
namespace {

constexpr int healthy_sets = 40, tied_sets = 16, pairs = 30, law_kinds = 4, law_repeats = 3;

/// Friction shows where loads come and go in sequence.
std::string campaign_for(const std::string& effect, bool rich) {
  return effect == "joint_friction" ? "cycle" : rich ? "rich" : "random";
}

std::vector<Case> all_of(const std::string& group) {
  std::vector<Case> out;
  const auto add = [&](const std::string& campaign, const std::string& effect, double lambda) -> Case& {
    Case c;
    c.group = group;
    c.campaign = campaign;
    c.index = static_cast<int>(out.size());
    c.effect = effect;
    c.lambda = lambda;
    // Heat shows where temperatures are recorded, in plans of odd number.
    c.variant = effect == "thermal_expansion" ? 1 + c.index / 2 % 2 * 2 : c.index / 2 % 4;
    return out.emplace_back(c);
  };
  const auto by_turns = [&] { return out.size() % 2 == 0 ? "rich" : "random"; };
  if (group == "one")
    for (const std::string& effect : entries())
      for (const double lambda : {4, 8, 16})
        for (const bool rich : {true, false}) add(campaign_for(effect, rich), effect, lambda);
  if (group == "healthy" || group == "stress")
    for (int i = 0; i < healthy_sets; ++i) add(by_turns(), "", 0).stress = static_cast<Stress>(i / 2 % 3);
  if (group == "left-out")
    for (const std::string& effect : entries())
      for (const double lambda : {8, 16})
        add(campaign_for(effect, (out.size() / 2 + out.size()) % 2 == 0), effect, lambda);
  if (group == "law")
    for (std::size_t law = 0; law < law_kinds; ++law)
      for (const double lambda : {10, 20})
        for (int repeat = 0; repeat < law_repeats; ++repeat) add(by_turns(), "", lambda).law = law;
  if (group == "tie")
    for (int i = 0; i < tied_sets; ++i) add("paper", "", i % 2 ? 16 : 8);
  if (group == "pair")
    for (int i = 0; i < pairs; ++i) add(by_turns(), "", i / 2 % 2 ? 16 : 8);
  return out;
}

}  // namespace

const std::vector<std::string>& entries() {
  static const std::vector<std::string> all = {"actuator_compliance",
                                               "cable_compliance",
                                               "guide_root_compliance",
                                               "carriage_compliance",
                                               "joint_compliance",
                                               "leg_joint_compliance",
                                               "hertz_contact",
                                               "joint_clearance",
                                               "joint_friction",
                                               "platform_flexibility",
                                               "base_tilt",
                                               "tool_compliance",
                                               "leg_defect",
                                               "modulus",
                                               "guide_diameter",
                                               "self_weight",
                                               "thermal_expansion",
                                               "load_gain",
                                               "load_misalignment",
                                               "sensor_misalignment",
                                               "sensor_drift",
                                               "one_sided_actuation"};
  return all;
}

std::vector<Case> cases(std::uint64_t seed, const std::string& group, std::size_t most) {
  std::vector<std::vector<Case>> groups;
  std::size_t total = 0;
  for (std::size_t i = 0; i < std::size(group_names); ++i) {
    if (!group.empty() && group != group_names[i]) continue;
    groups.push_back(all_of(group_names[i]));
    for (Case& c : groups.back()) c.seed = seed + 100000 * (i + 1) + 10 * static_cast<std::uint64_t>(c.index);
    total += groups.back().size();
  }
  std::vector<Case> out;
  for (const std::vector<Case>& g : groups) {
    const double share = most > 0 && most < total ? static_cast<double>(most) / static_cast<double>(total) : 1;
    const auto keep =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(share * static_cast<double>(g.size()))));
    for (std::size_t i = 0; i < keep; ++i) out.push_back(g[(2 * i + 1) * g.size() / (2 * keep)]);
  }
  return out;
}

}  // namespace deflect::benchmark
