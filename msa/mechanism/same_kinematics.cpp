#include <algorithm>

#include "msa/mechanism/chain_kinematics.h"

namespace deflect {
namespace {

bool same(const Named<Part>&, const Named<Part>&);
bool same(const std::pair<std::string, Part>&, const std::pair<std::string, Part>&);

bool same(const Placement& a, const Placement& b) { return a.shift == b.shift && a.turn == b.turn; }

bool same(const std::optional<DhRow>& a, const std::optional<DhRow>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->theta == b->theta && a->d == b->d && a->a == b->a && a->alpha == b->alpha;
}

bool same(const Mount& a, const Mount& b) {
  return same(a.base, b.base) && same(a.platform, b.platform) && same(a.leg, b.leg);
}

bool same(const Joint& a, const Joint& b) {
  return a.type == b.type && a.freedoms == b.freedoms && a.axis == b.axis && same(a.dh, b.dh) &&
         same(a.modified_dh, b.modified_dh) && a.bar == b.bar && a.home == b.home && a.min == b.min && a.max == b.max;
}

bool same(const Member& a, const Member& b) {
  return a.along == b.along && a.from == b.from && a.from_point == b.from_point;
}

bool same(const Offset& a, const Offset& b) {
  return same(static_cast<const Placement&>(a), static_cast<const Placement&>(b));
}

template <class T>
bool all_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same(x, y); });
}

bool same(const Parallel& a, const Parallel& b) { return all_same(a.mounts, b.mounts) && same(a.leg, b.leg); }

bool same(const std::pair<std::string, Part>& a, const std::pair<std::string, Part>& b) {
  if (a.first != b.first || a.second.index() != b.second.index()) return false;
  const auto with = [&](const auto& part) { return same(part, std::get<std::decay_t<decltype(part)>>(b.second)); };
  return std::visit(with, a.second);
}

bool same(const Named<Part>& a, const Named<Part>& b) { return all_same(a, b); }

}  // namespace

bool same_kinematics(const std::vector<LegParts>& a, const std::vector<LegParts>& b) {
  const auto alike = [](const LegParts& x, const LegParts& y) {
    return same(x.mount, y.mount) && same(x.parts, y.parts);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), alike);
}

}  // namespace deflect
