#include "validation/studies/mesh_study.h"

#include "meshes/structure.h"

namespace deflect::studies {

std::vector<MeshStudyRow> mesh_study(const Mechanism& m, const std::vector<ValidationPoint>& points, double load_N) {
  std::vector<MeshStudyRow> out;
  for (const double size_mm : {200.0, 100.0, 50.0, 25.0, 10.0, 5.0, 2.0}) {
    const frame::MemberDivision division = divide_members(configure(m, home_pose(m)), size_mm / 1e3);
    std::size_t elements = 0;
    for (const auto& [part, at] : division) elements += at.size() - 1;
    out.push_back({size_mm, elements, validate(m, points, load_N, {}, division).max_relative_difference});
  }
  return out;
}

}  // namespace deflect::studies
