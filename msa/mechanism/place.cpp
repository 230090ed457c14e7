#include "msa/mechanism/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/mechanism/table.h"

namespace deflect {
namespace {

template <class T>
const T& look_up(const Named<T>& list, const std::string& name, const char* what) {
  if (const T* found = find(list, name)) return *found;
  throw InputError(fmt::format("there is no {} '{}'", what, name));
}

/// The reference, or the other direction where the reference is too close to the axis to define a plane.
Vector3 across(const Vector3& axis, const Vector3& reference, const Vector3& otherwise) {
  return std::abs(axis.normalized().dot(reference.normalized())) < 0.999 ? reference : otherwise;
}

Law resolved(Law law, const Mechanism& m, double actuator) {
  std::visit(
      [&](auto& l) {
        bool of_material = false;
        if constexpr (requires { l.solid; }) of_material = true;
        if constexpr (requires { l.EA; }) of_material = !l.EA;
        if constexpr (requires { l.solid; })
          if (of_material) l.solid = look_up(m.materials, l.material, "material");
      },
      law);
  if (lacks_length(law)) *length_from_pose(law) = actuator;
  if (const auto* table = std::get_if<TableLaw>(&law)) law = identified(*table);
  return law;
}

}  // namespace

const JointType* find_joint_type(std::string_view name) {
  for (const JointType& t : joint_table)
    if (name == t.name) return &t;
  return nullptr;
}

std::vector<std::string> joint_type_names() {
  std::vector<std::string> names;
  for (const JointType& t : joint_table) names.emplace_back(t.name);
  return names;
}

std::array<Freedom, 6> freedoms_of(std::string_view letters) {
  std::array<Freedom, 6> f{};
  for (std::size_t i = 0; i < 6; ++i)
    f[i] = letters[i] == 'f' ? Freedom::free : letters[i] == 'a' ? Freedom::actuated : Freedom::rigid;
  return f;
}

std::array<Freedom, 6> freedoms_of(const Joint& joint) {
  const JointType* type = find_joint_type(joint.type);
  if (!type) throw InputError(fmt::format("there is no joint type '{}'", joint.type));
  return freedoms_of(joint.freedoms.empty() ? std::string_view(type->letters) : std::string_view(joint.freedoms));
}

PlacedJoint placed(const Joint& joint, const std::string& part, const JointPlace& place, const Mechanism& m) {
  PlacedJoint j;
  j.part = part;
  j.p_W = place.p_W;
  j.R_WJ = place.R_WJ;
  j.freedoms = freedoms_of(joint);
  for (std::size_t i = 0; i < 6; ++i)
    for (const Law& law : joint.laws[i]) j.laws[i].push_back(resolved(law, m, place.actuator));
  j.preload = joint.preload;
  j.stiffness = joint.stiffness;
  return j;
}

std::array<std::vector<Law>, 6> beside_of(const Joint& joint, const Mechanism& m, double actuator) {
  std::array<std::vector<Law>, 6> out;
  for (std::size_t i = 0; i < 6; ++i)
    for (const Law& law : joint.beside[i]) out[i].push_back(resolved(law, m, actuator));
  return out;
}

void put(PlacedJoint joint, const std::array<std::vector<Law>, 6>& beside, const std::string& leg,
         std::vector<PlacedPart>& out) {
  PlacedParallel group{joint.part, joint.p_W, joint.p_W, {}, true};
  for (std::size_t i = 0; i < 6; ++i)
    for (const Law& law : beside[i]) {
      if (joint.free(i)) {  // nothing else is there
        joint.laws[i] = {law};
        continue;
      }
      PlacedJoint one{joint.part + " beside", joint.p_W, joint.R_WJ, {}, {}, {}, {}};
      one.freedoms.fill(Freedom::free);
      one.laws[i] = {law};
      group.branches.push_back({fmt::format("{} {} beside", leg, joint.part), {std::move(one)}});
    }
  if (group.branches.empty()) return out.emplace_back(std::move(joint)), void();
  PlacedLeg main{fmt::format("{} {}", leg, joint.part), {}};
  main.parts.emplace_back(std::move(joint));
  group.branches.insert(group.branches.begin(), std::move(main));
  out.emplace_back(std::move(group));
}

void put(const Member& member, PlacedMember placed_member, const Mechanism& m, std::vector<PlacedPart>& out) {
  const auto end = [&](const Joint& fixture, const char* which, const Vector3& p) {
    const bool yields = std::any_of(fixture.laws.begin(), fixture.laws.end(), [](const auto& l) { return !l.empty(); });
    if (yields || fixture.stiffness)
      out.emplace_back(placed(fixture, fmt::format("{} {}", placed_member.part, which), {p, placed_member.R_WM}, m));
  };
  end(member.start, "start", placed_member.p_W_start);
  out.emplace_back(placed_member);
  end(member.end, "end", placed_member.p_W_end);
}

PlacedMember placed(const Member& member, const std::string& part, const Vector3& p_W_start, const Vector3& p_W_end,
                    const Vector3& reference, const Vector3& otherwise, const Mechanism& m) {
  const Material& material = look_up(m.materials, member.material, "material");
  PlacedMember out;
  out.part = part;
  place_between(out, p_W_start, p_W_end, reference, otherwise);
  out.section = properties(look_up(m.sections, member.section, "section"), material.poisson());
  out.section.Iy *= member.bending_factor;
  out.section.Iz *= member.bending_factor;
  out.E = material.E;
  out.G = material.shear_modulus();
  out.expansion = material.expansion;
  out.beam = member.beam;
  return out;
}

void place_between(PlacedMember& m, const Vector3& p_W_start, const Vector3& p_W_end, const Vector3& reference,
                   const Vector3& otherwise) {
  m.p_W_start = p_W_start;
  m.p_W_end = p_W_end;
  const Vector3 along = p_W_end - p_W_start;
  if (!(along.norm() > 1e-9))
    throw ModelError(fmt::format("{}: the member has no length", m.part), {"a member has no length"});
  m.R_WM = axes_along_x(along, across(along, reference, otherwise));
}

Matrix3 axes_along_z(const Vector3& z, const Vector3& reference, const Vector3& otherwise) {
  const Matrix3 R = axes_along_x(z, across(z, reference, otherwise));  // columns z, x, y of the axes wanted
  Matrix3 turned;
  turned << R.col(1), R.col(2), R.col(0);
  return turned;
}

}  // namespace deflect
