// Cross-sections and their geometry.
//
// A section lies in the member's local y–z plane; y and z are principal axes of every shape, and the centroid is on the
// member's line. Bending about local y (with Iy) moves the member along z. The member defines the direction of local y
// (y_axis, see description.h and frame_description.h).
//
// Forces act at the member's line. The shear centre of a channel or an angle is not at the centroid; the twist that
// this causes is neglected, as is warping.
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
/// Outer sides along local y and z, walls of equal thickness, sharp corners.
struct BoxSection {
  double width_y = 0, height_z = 0, wall = 0;
};
/// Web along local z, flanges along local y; outer sizes, thickness of web and flange; no fillets.
struct ISection {
  double width_y = 0, height_z = 0, web = 0, flange = 0;
};
/// The same with flanges on one side of the web, towards local +y.
struct ChannelSection {
  double width_y = 0, height_z = 0, web = 0, flange = 0;
};
/// Two legs at a right angle, outer lengths. Local y and z are the principal axes (u and v of section tables). y has
/// the larger second moment; it points from the heel to between the legs, at the tables' angle α from the short leg (45
/// deg for equal legs).
struct AngleSection {
  double long_leg = 0, short_leg = 0, wall = 0;
};

using Shape = std::variant<RoundSection, TubeSection, RectangleSection, GivenSection, BoxSection, ISection,
                           ChannelSection, AngleSection>;
inline constexpr const char* shape_names[] = {"round", "tube", "rectangle", "given", "box", "I", "channel", "angle"};
static_assert(std::size(shape_names) == std::variant_size_v<Shape>);

struct Section {
  Shape shape;
};

/// A in m²; Iy, Iz (second moments about local y and z) and the torsion constant J in m⁴; shear areas in m², 0 where
/// not given. A, Iy and Iz are exact for the shapes with sharp corners.
///
/// J: rectangle by Saint-Venant's series (Timoshenko and Goodier, Theory of Elasticity, §109); box after Bredt with the
/// torsion of the walls, J = 4 A_m² t/s_m + s_m t³/3, A_m and s_m the area within the midline and its length (EN
/// 10210-2, annex A); open shapes Σ b t³/3 of their plates, which the fillets of rolled profiles raise by up to a
/// third: give J directly for those.
///
/// Shear areas: round 9/10 A, rectangle 5/6 A, tube after Cowper (1966) for the given ν; the thin-walled shapes by the
/// energy of the shear flow (thin_walls.h).
struct SectionProperties {
  double A, Iy, Iz, J, As_y, As_z;
};

SectionProperties properties(const Section&, double nu);

}  // namespace deflect
