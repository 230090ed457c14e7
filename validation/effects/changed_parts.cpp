#include "validation/effects/changed_parts.h"

#include <algorithm>
#include <map>

namespace deflect::effects {
namespace {

bool same(const PlacedJoint& a, const PlacedJoint& b) {
  if (a.freedoms != b.freedoms || a.preload != b.preload || a.stiffness.has_value() != b.stiffness.has_value())
    return false;
  if (a.stiffness && *a.stiffness != *b.stiffness) return false;
  for (std::size_t i = 0; i < a.laws.size(); ++i)
    if (a.laws[i] != b.laws[i]) return false;
  return true;
}

bool same(const PlacedMember& a, const PlacedMember& b) {
  const SectionProperties &s = a.section, &t = b.section;
  return a.E == b.E && a.G == b.G && a.expansion == b.expansion && a.beam == b.beam && s.A == t.A && s.Iy == t.Iy &&
         s.Iz == t.Iz && s.J == t.J && s.As_y == t.As_y && s.As_z == t.As_z;
}

bool same(const PlacedPart& a, const PlacedPart& b) {
  if (a.index() != b.index()) return false;
  if (const auto* joint = std::get_if<PlacedJoint>(&a)) return same(*joint, std::get<PlacedJoint>(b));
  if (const auto* member = std::get_if<PlacedMember>(&a)) return same(*member, std::get<PlacedMember>(b));
  return true;  // branches are compared as legs
}

/// The same joint with the same laws side by side.
bool same_joint(const PlacedPart& a, const PlacedPart& b) {
  const auto* group = std::get_if<PlacedParallel>(&a);
  const auto* other = std::get_if<PlacedParallel>(&b);
  if (!group || !other) return !group && !other && same(a, b);
  return std::equal(group->branches.begin(), group->branches.end(), other->branches.begin(), other->branches.end(),
                    [](const PlacedLeg& x, const PlacedLeg& y) { return same(x.parts.front(), y.parts.front()); });
}

const std::string& name_of(const PlacedPart& part) {
  return std::visit([](const auto& p) -> const std::string& { return p.part; }, part);
}

void compare_legs(const std::vector<PlacedLeg>& before, const std::vector<PlacedLeg>& after,
                  std::vector<ChangedPart>& out) {
  std::map<std::string, const PlacedLeg*> legs;
  for (const PlacedLeg& leg : before) legs[leg.name] = &leg;
  for (const PlacedLeg& leg : after) {
    const PlacedLeg* old = legs.contains(leg.name) ? legs[leg.name] : nullptr;
    std::map<std::string, const PlacedPart*> parts;
    if (old)
      for (const PlacedPart& part : old->parts) parts[name_of(part)] = &part;
    for (const PlacedPart& part : leg.parts) {
      const PlacedPart* drawn = parts.contains(name_of(part)) ? parts[name_of(part)] : nullptr;
      if (joint_of(part)) {
        if (!drawn || !joint_of(*drawn) || !same_joint(*drawn, part)) out.push_back({leg.name, name_of(part)});
      } else if (const auto* group = std::get_if<PlacedParallel>(&part)) {
        const auto* was = drawn ? std::get_if<PlacedParallel>(drawn) : nullptr;
        compare_legs(was ? was->branches : std::vector<PlacedLeg>{}, group->branches, out);
      } else if (!drawn || !same(*drawn, part)) {
        out.push_back({leg.name, name_of(part)});
      }
    }
    if (old && leg.misfit != old->misfit) out.push_back({leg.name, ""});
  }
}

}  // namespace

std::vector<ChangedPart> changed_parts(const Configuration& before, const Configuration& after) {
  std::vector<ChangedPart> out;
  compare_legs(before.legs, after.legs, out);
  if (!same(before.base, after.base)) out.push_back({"", "base"});
  if (!same(before.tool, after.tool)) out.push_back({"", "tool"});
  if (before.weight != after.weight) out.push_back({"", "platform"});
  return out;
}

}  // namespace deflect::effects
