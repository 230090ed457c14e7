// Cross-sections and their geometry.
#pragma once

#include <iterator>
#include <optional>
#include <variant>

namespace deflect {

struct RoundSection {
  double diameter = 0;
};
struct TubeSection {
  double outer_diameter = 0, inner_diameter = 0;
};
/// Sides along the member's local y and z.
struct RectangleSection {
  double width_y = 0, height_z = 0;
};
/// Properties given directly; shear areas (A times the shear coefficient) are needed for Timoshenko members only.
struct GivenSection {
  double A = 0, Iy = 0, Iz = 0, J = 0;
  std::optional<double> As_y, As_z;
};

using Shape = std::variant<RoundSection, TubeSection, RectangleSection, GivenSection>;
inline constexpr const char* shape_names[] = {"round", "tube", "rectangle", "given"};
static_assert(std::size(shape_names) == std::variant_size_v<Shape>);

struct Section {
  Shape shape;
};

/// A in m²; Iy, Iz (second moments about local y and z) and the torsion constant J in m⁴; shear areas in m².
/// Shear coefficients: round 9/10, rectangle 5/6, tube after Cowper (1966) for the given ν; J of a rectangle by
/// Saint-Venant's series (Timoshenko and Goodier, Theory of Elasticity, §109). As_y, As_z are 0 where not given.
struct SectionProperties {
  double A, Iy, Iz, J, As_y, As_z;
};

SectionProperties properties(const Section&, double nu);

}  // namespace deflect
