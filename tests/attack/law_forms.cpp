#include "tests/attack/law_forms.h"

#include <fmt/format.h>

#include <algorithm>

namespace deflect::attack {
namespace {

using frame::FrameDescription;
using frame::FrameMember;

/// Three equal rotational stiffnesses, so that axes do not matter: at the end of the written member, and between the
/// node and a new one to which the ideal member goes.
void soften_end(FrameDescription& ideal, FrameDescription& written, std::size_t member, bool start, double k) {
  FrameMember& from = ideal.members[member].second;
  FrameMember& to = written.members[member].second;
  frame::FreedomLaws& laws = start ? to.start : to.end;
  for (std::size_t i = 3; i < 6; ++i) laws.set(i, {LinearLaw{k}});
  frame::Freedoms& released = start ? from.release_from : from.release_to;
  released[3] = released[4] = released[5] = false;
  std::string& node = start ? from.from : from.to;
  const std::string outer = node, inner = fmt::format("x{}", ideal.nodes.size());
  const Vector3 place = *find(ideal.nodes, outer);
  ideal.nodes.emplace_back(inner, place);
  ideal.rigid_links.push_back({inner, {outer, {inner}, {true, true, true, false, false, false}}});
  frame::FrameSpring spring;
  spring.node = inner, spring.to = outer;
  spring.stiffness[3] = spring.stiffness[4] = spring.stiffness[5] = k;
  ideal.springs.emplace_back(inner, spring);
  node = inner;
}

/// A spring to the ground as laws of its node's support; on what the support holds it carries nothing.
void as_support(FrameDescription& written, const frame::FrameSpring& spring) {
  auto found = std::find_if(written.supports.begin(), written.supports.end(),
                            [&](const auto& s) { return s.first == spring.node; });
  if (found == written.supports.end()) {
    written.supports.emplace_back(spring.node, frame::FrameSupport());
    found = written.supports.end() - 1;
  }
  frame::FrameSupport& support = found->second;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!spring.stiffness[i] || support.rigid(i)) continue;
    const bool beside = support.laws.has(i);
    std::vector<Law> laws = support.laws.at(i, beside);
    laws.emplace_back(LinearLaw{*spring.stiffness[i]});
    support.laws.set(i, laws, beside);
  }
}

/// Springs of the ideal frame that were there before the ends were softened.
void springs_as_laws(FrameDescription& written, Dice& dice) {
  Named<frame::FrameSpring> kept;
  for (auto& [name, spring] : written.springs) {
    const bool all = std::all_of(spring.stiffness.begin(), spring.stiffness.end(), [](const auto& k) { return k; });
    if (spring.to.empty() && dice.chance(0.7)) {
      as_support(written, spring);
      continue;
    }
    if (all) {
      spring.coupled = Matrix6::Zero();
      for (Eigen::Index i = 0; i < 6; ++i) (*spring.coupled)(i, i) = *spring.stiffness[static_cast<std::size_t>(i)];
      spring.stiffness = {};
    }
    kept.emplace_back(name, spring);
  }
  written.springs = kept;
}

}  // namespace

RandomFrame random_law_frame(unsigned seed) {
  RandomFrame out = random_frame(seed);
  Dice dice(seed + 0x1A35ull);
  FrameDescription written = out.ideal;
  springs_as_laws(written, dice);
  const double d = std::get<RoundSection>(out.ideal.sections[0].second.shape).diameter;
  for (std::size_t m = 0; m < out.ideal.members.size(); ++m)
    for (const bool start : {true, false})
      if (dice.chance(0.3)) soften_end(out.ideal, written, m, start, 210e9 * d * d * d * d * dice.power_of_ten(-4, 2));
  out.written = std::move(written);
  return out;
}

}  // namespace deflect::attack
