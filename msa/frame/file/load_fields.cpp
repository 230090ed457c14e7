// The fields of a load case.
#include <fmt/format.h>

#include <algorithm>

#include "msa/base/index.h"
#include "msa/frame/file/frame_fields.h"

namespace deflect::frame {
namespace {

Quantity or_zero(Dimension d) { return {d, {}, 0.0}; }

void describe_wrench(FieldVisitor& v, Vector6& wrench) {
  for (std::size_t i = 0; i < 6; ++i)
    v.quantity(wrench_names[i], wrench(as_index(i)), or_zero(i < 3 ? Dimension::force : Dimension::moment),
               i < 3 ? "force" : "moment");
}

void describe_line_load(FieldVisitor& v, LineLoad& load) {
  constexpr std::array<const char*, 3> keys = {"qx", "qy", "qz"};
  for (std::size_t i = 0; i < 3; ++i)
    v.quantity(keys[i], load.q(as_index(i)), or_zero(Dimension::line_load), "force per length of the member");
  std::string axes = load.member_axes ? "member" : "base";
  v.word("axes", axes, {"axes", {"base", "member"}, "base"}, "axes of qx, qy, qz");
  load.member_axes = axes == "member";
}

const FrameMaterial* material_of(const FrameNames& names, const FrameMember& member) {
  const int at = names.materials.find(member.material);
  return at < 0 ? nullptr : &nth(names.frame.materials, at).second;
}

void require_densities(FieldVisitor& v, const FrameNames& names) {
  for (const auto& [name, member] : names.frame.members) {
    const FrameMaterial* material = material_of(names, member);
    if (!material || material->density) continue;
    return v.require(false, "gravity",
                     fmt::format("material '{0}' of member '{1}' has no density: write for example "
                                 "'density: 7850 kg/m^3' in materials.{0}",
                                 member.material, name));
  }
}

void describe_temperature(FieldVisitor& v, const std::string& name, double& kelvin, const FrameNames& names) {
  const int at = require_known(v, "", "member", name, names.members, names.frame.members);
  v.quantity("", kelvin, {Dimension::temperature, {}, std::nullopt}, "temperature above the unstrained state");
  if (at < 0) return;
  const FrameMember& member = nth(names.frame.members, at).second;
  const FrameMaterial* material = material_of(names, member);
  if (material && !material->expansion)
    v.require(false, "",
              fmt::format("material '{0}' has no thermal expansion: write for example 'expansion: 12e-6 1/K' in "
                          "materials.{0}",
                          member.material));
}

void describe_displacement(FieldVisitor& v, const std::string& node, FreedomValues& values, const FrameNames& names) {
  require_known(v, "", "node", node, names.nodes, names.frame.nodes);
  describe_freedom_values(v, values, Dimension::length, Dimension::angle, {}, "displacement of the support");
  const int at = names.supports.find(node);
  const FrameSupport held = at < 0 ? FrameSupport() : nth(names.frame.supports, at).second;
  bool any = false;
  for (std::size_t i = 0; i < 6; ++i) {
    any = any || values[i];
    if (values[i] && held.laws.has(i))
      v.require(false, node_freedoms[i],
                fmt::format("node '{}' is held in {} by a law, which yields: a displacement is prescribed only where "
                            "a support is rigid; put the law into a spring to a node of its own, and hold that",
                            node, node_freedoms[i]));
    else if (values[i] && !held[i])
      v.require(false, node_freedoms[i],
                fmt::format("node '{0}' is not supported in {1}: a displacement is prescribed only where a support "
                            "holds; add {1} to supports.{0}",
                            node, node_freedoms[i]));
  }
  v.require(any, "", "has no displacement: write for example 'uz: -1 mm'");
}

}  // namespace

void describe(FieldVisitor& v, LoadCase& c, const FrameNames& names) {
  v.quantity("factor", c.factor, {Dimension::ratio, {}, 1}, "true load over that of this case, of all of it");
  v.vector3("turned", c.turned, Dimension::angle, "rotation vector from the loads in base axes to the true ones");
  const auto node = [&](FieldVisitor& w, const std::string& name, Vector6& wrench) {
    require_known(w, "", "node", name, names.nodes, names.frame.nodes);
    describe_wrench(w, wrench);
  };
  FrameEntries<Vector6> nodes(c.nodes, node);
  v.entries("nodes", nodes, Need::optional, "forces and moments by node, base axes");
  const auto line = [&](FieldVisitor& w, const std::string& name, LineLoad& load) {
    require_known(w, "", "member", name, names.members, names.frame.members);
    describe_line_load(w, load);
  };
  FrameEntries<LineLoad> members(c.members, line);
  v.entries("members", members, Need::optional, "line loads by member");
  const auto heat = [&](FieldVisitor& w, const std::string& name, double& kelvin) {
    describe_temperature(w, name, kelvin, names);
  };
  FrameEntries<double> temperature(c.temperature, heat, true);
  v.entries("temperature", temperature, Need::optional, "temperature change by member");
  v.vector3("gravity", c.gravity, Dimension::acceleration, "acceleration of gravity, acts on all members");
  if (!c.gravity.isZero(0)) require_densities(v, names);
  const auto settle = [&](FieldVisitor& w, const std::string& name, FreedomValues& values) {
    describe_displacement(w, name, values, names);
  };
  FrameEntries<FreedomValues> displacements(c.displacements, settle);
  v.entries("displacements", displacements, Need::optional, "displacements of supports by node");
  v.require(!c.nodes.empty() || !c.members.empty() || !c.temperature.empty() || !c.gravity.isZero(0) ||
                !c.displacements.empty(),
            "", "has no load: give nodes, members, temperature, gravity or displacements");
}

}  // namespace deflect::frame
