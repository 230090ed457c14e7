// A cantilever of 1 m along x in the plane xz, clamped at A, its tip B; E = 210 GPa, a square of 20 mm: A = 400 mm²,
// I = 20⁴/12 mm⁴. Load case 'tip': 10 N down at B, which moves it by P L³/(3 E I) = 1.19 mm.
#pragma once

#include <string>

namespace deflect::test::cantilever {

inline constexpr double E = 210e9, A = 4e-4, I = 0.02 * 0.02 * 0.02 * 0.02 / 12;  ///< Pa, m², m⁴
inline constexpr double tip = 10 / (3 * E * I);                                   ///< m, downwards

/// Its file with `more` lines: sensors, tolerances. `other_loads` stand beside 'tip', as in "pull: {nodes: {…}}".
inline std::string file(const std::string& more = "", const std::string& other_loads = "") {
  return R"(
name: cantilever
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 20 mm, height_z: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
members: {beam: {from: A, to: B, section: bar, material: steel, y_axis: [0, 1, 0]}}
supports: {A: clamped}
loads: {tip: {nodes: {B: {fz: -10 N}}})" +
         (other_loads.empty() ? "" : ", " + other_loads) + "}\n" + more;
}

}  // namespace deflect::test::cantilever
