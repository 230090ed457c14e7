// Numbers of a 3D view, with as many digits as the eye can use: a page is read over slow lines too.
#pragma once

#include "msa/base/spatial.h"
#include "msa/mechanism/sections/section.h"
#include "validation/figures/drawing.h"
#include "validation/json/json_text.h"

namespace deflect::scene {

/// m → mm, to 0.1 µm.
Json scene_position(const Vector3& p);
/// m → mm, seven digits.
Json scene_displacement(const Vector3& u);
/// The number with seven digits.
double scene_digits(double x);

/// "size_mm" and "round" into a body. Where the file gives no shape, those of an ellipse of the same A, Iy and Iz
/// (m², m⁴).
void put_outline(Json& body, const figures::SectionOutline&, const SectionProperties&);

/// Arrows of a wrench [f; m] in N and Nm at a point of the scene, base axes: one for the force, one for the moment.
void put_load_arrows(Json& arrows, int point, const Vector6& load);

}  // namespace deflect::scene
