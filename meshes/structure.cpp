#include "meshes/structure.h"

#include <algorithm>
#include <cmath>

#include "meshes/gmsh.h"
#include "msa/base/index.h"

namespace deflect {

frame::MemberDivision divide_members(const Configuration& c, double element_size) {
  std::vector<std::string> parts;
  std::vector<double> lengths;
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.length(); }) {
      const auto at = std::find(parts.begin(), parts.end(), part.part) - parts.begin();
      if (as_size(at) == parts.size()) {
        parts.push_back(part.part);
        lengths.push_back(0);
      }
      double& longest = nth(lengths, at);
      longest = std::max(longest, part.length());
    }
  });
  const std::vector<std::vector<double>> fractions = gmsh::subdivide(lengths, element_size);
  frame::MemberDivision out;
  for (std::size_t i = 0; i < parts.size(); ++i) out[parts[i]] = fractions[i];
  return out;
}

namespace {

LineMesh lines_of(const frame::Model& m, const std::vector<std::pair<int, int>>& arms) {
  LineMesh mesh;
  for (const frame::Node& node : m.nodes) mesh.points.push_back(node.position);
  const auto group = [&mesh](const std::string& name) {
    const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), name);
    if (found != mesh.groups.end()) return static_cast<int>(found - mesh.groups.begin());
    mesh.groups.push_back(name);
    return static_cast<int>(mesh.groups.size()) - 1;
  };
  for (const frame::Beam& beam : m.beams) mesh.cells.push_back({beam.a, beam.b, group(beam.part)});
  for (const auto& [a, b] : arms) mesh.cells.push_back({a, b, group("rigid")});
  return mesh;
}

/// Points of the nodes' displacements times `scale`, and of their rotations.
std::vector<PointField> motion_of(const frame::Model& m, const VectorX& u, double scale) {
  std::vector<PointField> fields = {{"displacement_mm", {}}, {"rotation_rad", {}}};
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    const auto at = as_index(6 * i);
    fields[0].values.push_back(1e3 * scale * u.segment<3>(at));
    fields[1].values.push_back(scale * u.segment<3>(at + 3));
  }
  return fields;
}

}  // namespace

LineMesh lines_of(const frame::MechanismModel& m) { return lines_of(m.model, m.arms); }

LineMesh lines_of(const frame::Model& m) { return lines_of(m, m.welds); }

FieldData fields_of_motion(const frame::Model& m, const VectorX& u) {
  double largest = 0;
  for (std::size_t i = 0; i < m.nodes.size(); ++i) largest = std::max(largest, u.segment<3>(as_index(6 * i)).norm());
  return {motion_of(m, u, largest > 0 ? 0.1 * characteristic_length(m) / largest : 1), {}};
}

FieldData fields_of(const frame::MechanismModel& m, const VectorX& u, const frame::GeometricState* deformed) {
  FieldData out;
  out.points = motion_of(m.model, u, 1);
  out.cells = {{"axial_force_N", {}}, {"bending_moment_Nmm", {}}, {"torque_Nmm", {}}};
  for (std::size_t e = 0; e < m.model.beams.size(); ++e) {
    const frame::Beam& beam = m.model.beams[e];
    frame::Vector12 f;
    if (deformed) {  // in the axes of the sections at the ends
      const frame::BeamState& state = deformed->beams[e];
      f << rotate_twist(state.A.transpose()) * state.forces.head<6>(),
          rotate_twist(state.B.transpose()) * state.forces.tail<6>();
    } else {
      f = end_forces(beam, end_displacements(beam, u));
    }
    out.cells[0].values.push_back(f(6));  // pull of the far end along x: tension positive
    out.cells[1].values.push_back(1e3 * std::max(std::hypot(f(4), f(5)), std::hypot(f(10), f(11))));
    out.cells[2].values.push_back(1e3 * f(9));
  }
  for (CellField& field : out.cells) field.values.resize(m.model.beams.size() + m.arms.size(), 0);
  return out;
}

}  // namespace deflect
