// What the figures of a map say alike.
#pragma once

#include <string>

#include "validation/figures/sheet.h"
#include "validation/studies/map.h"

namespace deflect::figures {

/// Device and title, load, theory, orientation and a note; y below them, mm.
double map_heading(Sheet&, const studies::StiffnessMap&, const std::string& title, const std::string& note, double x);

/// `what` is drawn, then units, load, axes, sign, poses and theory.
std::string map_caption(const studies::StiffnessMap&, const std::string& what);

}  // namespace deflect::figures
