// Shear area of a thin-walled section by the energy of its shear flow.
//
// Under the shear force V the flow in a wall is q = kᵀS, k = M⁻¹ V, with S = ∫ r t ds the first moment of the midline,
// integrated from the free end, and M = ∫ r rᵀ t ds the second moment; r from the centroid in axes y, z (Jourawski; q =
// V S/I along a principal axis). Its energy, ∫ q²/(2 G t) ds, is V²/(2 G A_s):
//   1/A_s = (M⁻¹ ∫ S Sᵀ/t ds M⁻¹)_ii
// (S. Timoshenko, Strength of Materials, Part I, §77; W. D. Pilkey, Analysis and Design of Elastic Beams, 2002, ch. 6,
// for thin walls). This gives A_s = 5/6 A for a narrow rectangle. V acts through the shear centre. The coupling of
// shear along y and z in sections without an axis of symmetry (the entry yz) is neglected.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace deflect {

/// A straight piece of the midline in axes y, z; m. The flow of the walls `before` continues into it. A wall without
/// any starts where the flow is zero: at a free end, or by symmetry.
struct Wall {
  Eigen::Vector2d from, to;
  double thickness = 0;
  std::vector<std::size_t> before;  ///< indices of earlier walls
};

/// Shear area along axis 0 (y) or 1 (z), m².
double shear_area(const std::vector<Wall>&, Eigen::Index axis);

}  // namespace deflect
