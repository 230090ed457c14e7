// The fields of places that have laws: supports, springs, ends of members.
#include <fmt/format.h>

#include <algorithm>

#include "msa/base/index.h"
#include "msa/frame/file/frame_fields.h"

namespace deflect::frame {
namespace {

constexpr Freedoms nothing_rigid{};

/// The laws of one kind at all six freedoms.
void describe_lists(FieldVisitor& v, FreedomLaws& laws, const FreedomNames& keys, bool beside, const char* about) {
  for (std::size_t i = 0; i < 6; ++i) {
    v.surroundings.rotation = i >= 3;
    std::vector<Law> list = laws.at(i, beside);
    ListElements<Law> elements(list);
    v.one_or_list(keys[i], elements, about);
    laws.set(i, std::move(list), beside);
  }
  v.surroundings.rotation = false;
}

/// The history of a friction in a frame is that of its load cases.
void refuse_earlier_loads(FieldVisitor& v, const FreedomLaws& laws, const FreedomNames& keys) {
  for (std::size_t i = 0; i < 6; ++i)
    for (const bool beside : {false, true})
      for (const Law& law : laws.at(i, beside)) {
        const auto* friction = std::get_if<FrictionLaw>(&law);
        if (friction && (friction->start != 0 || friction->kept != 1))
          v.require(false, beside ? "beside" : keys[i],
                    fmt::format("{} has a friction with start or kept, which belong to the poses of a machine: leave "
                                "them away, a frame's friction begins relaxed or with the load case before",
                                keys[i]));
      }
}

/// `rigid`: the freedoms that are rigid where they have no law.
void describe_laws(FieldVisitor& v, FreedomLaws& laws, const Freedoms& rigid, const FreedomNames& keys) {
  v.surroundings.on_actuator = false;
  describe_lists(v, laws, keys, false, "laws in series on this freedom");
  const auto beside = [&] {
    describe_lists(v, laws, keys, true, "laws, each side by side with all that is on this freedom");
  };
  v.object("beside", Need::optional, false, beside, "laws side by side with those of a freedom");
  v.surroundings.on_actuator = true;
  for (std::size_t i = 0; i < 6; ++i)
    if (rigid[i] && laws.has(i, true) && !laws.has(i))
      v.require(false, "beside",
                fmt::format("{0} is rigid here, so that nothing side by side with it is loaded: give {0} a law first",
                            keys[i]));
  refuse_earlier_loads(v, laws, keys);
}

}  // namespace

void describe(FieldVisitor& v, const std::string& node, FrameSupport& s, const FrameNames& names) {
  require_known(v, "", "node", node, names.nodes, names.frame.nodes);
  describe_held(v, "holds", s);
  describe_laws(v, s.laws, s, node_freedoms);
  const auto settled = [&] {
    for (std::size_t i = 0; i < 6; ++i) {
      double& way = s.settled(as_index(i));
      v.quantity(node_freedoms[i], way, {i < 3 ? Dimension::length : Dimension::angle, {}, 0},
                 "how far the support has moved since the assembly");
      v.require(way == 0 || s.rigid(i), node_freedoms[i],
                "settles only where the support holds rigidly: a law or a free direction takes no settlement");
    }
  };
  v.object("settled", Need::optional, false, settled, "movement of the support since the assembly");
  v.require(s.acting() != Freedoms{}, "", "holds nothing: write for example 'clamped', or 'holds: [ux, uz]', or a law");
}

void describe_end(FieldVisitor& v, const char* key, FreedomLaws& laws, const Freedoms& released,
                  const FrameNames& names, const char* about) {
  if (laws.empty() && !names.absent_ends) return;
  Freedoms rigid{};
  std::transform(released.begin(), released.end(), rigid.begin(), [](bool free) { return !free; });
  const auto fields = [&] { describe_laws(v, laws, rigid, member_freedoms); };
  v.object(key, Need::optional, false, fields, about);
}

void describe(FieldVisitor& v, FrameSpring& s, const FrameNames& names) {
  v.text("node", s.node, Need::required, "node where the spring is");
  v.text("to", s.to, Need::optional, "the other node, the ground where absent");
  require_known(v, "node", "node", s.node, names.nodes, names.frame.nodes);
  if (!s.to.empty()) require_known(v, "to", "node", s.to, names.nodes, names.frame.nodes);
  v.require(s.node != s.to, "to", "must be another node than 'node'");
  for (std::size_t i = 0; i < 6; ++i)
    if (s.stiffness[i]) s.laws.set(i, {LinearLaw{*s.stiffness[i]}});
  s.stiffness = {};
  describe_laws(v, s.laws, nothing_rigid, node_freedoms);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::vector<Law> laws = s.laws.at(i);
    const auto* linear = laws.size() == 1 ? std::get_if<LinearLaw>(&laws.front()) : nullptr;
    if (!linear) continue;
    s.stiffness[i] = linear->stiffness;
    s.laws.set(i, {});
  }
  describe_stiffness(v, s.coupled, "give those freedoms that resist a stiffness of their own");
  FrameSpring alone = s;
  alone.coupled.reset();
  v.require(!s.coupled || alone.acting() == Freedoms{}, "stiffness",
            "is that of all six freedoms: leave those of single freedoms, and beside, away");
  v.require(s.acting() != Freedoms{}, "", "has no stiffness: write for example 'ux: 500 N/mm'");
}

}  // namespace deflect::frame
