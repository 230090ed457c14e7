#include "meshes/frame_lines.h"
#include "msa/base/index.h"

#include <cmath>
#include <unordered_map>

namespace deflect {

LineMesh lines_of(const frame::FrameModel& m) {
  LineMesh mesh;
  for (const frame::Node& node : m.model.nodes) mesh.points.push_back(node.position);
  std::unordered_map<std::string, int> groups;
  const auto group = [&](const std::string& name) {
    const auto [found, fresh] = groups.emplace(name, static_cast<int>(mesh.groups.size()));
    if (fresh) mesh.groups.push_back(name);
    return found->second;
  };
  for (const frame::Beam& beam : m.model.beams) mesh.cells.push_back({beam.a, beam.b, group(beam.part)});
  for (const auto& [a, b] : m.arms) mesh.cells.push_back({a, b, group("rigid")});
  return mesh;
}

FieldData fields_of(const frame::FrameModel& m, const frame::CaseResult& r) {
  FieldData out;
  out.points = {{"displacement_mm", {}}, {"rotation_rad", {}}};
  for (std::size_t i = 0; i < m.model.nodes.size(); ++i) {
    const auto at = as_index(6 * i);
    out.points[0].values.push_back(1e3 * r.u.segment<3>(at));
    out.points[1].values.push_back(r.u.segment<3>(at + 3));
  }
  out.cells = {{"axial_force_N", {}}, {"torque_Nmm", {}}, {"moment_y_Nmm", {}}, {"moment_z_Nmm", {}}};
  const auto larger = [](double a, double b) { return std::abs(b) > std::abs(a) ? b : a; };
  for (std::size_t e = 0; e < m.model.beams.size(); ++e) {
    const Vector6 start = -r.end_forces[e].head<6>(), end = r.end_forces[e].tail<6>();
    out.cells[0].values.push_back((start(0) + end(0)) / 2);
    for (std::size_t i = 1; i < 4; ++i) {
      const auto moment = as_index(i + 2);
      out.cells[i].values.push_back(1e3 * larger(start(moment), end(moment)));
    }
  }
  for (CellField& field : out.cells) field.values.resize(m.model.beams.size() + m.arms.size(), 0);
  return out;
}

}  // namespace deflect
