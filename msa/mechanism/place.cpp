#include "msa/mechanism/place.h"

#include <fmt/format.h>

#include <cmath>

#include "msa/base/error.h"

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
  return law;
}

}  // namespace

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
