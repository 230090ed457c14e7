// The drawing of a machine or frame as text, JSON and figure.
#pragma once

#include <string>

#include "validation/figures/drawing.h"
#include "validation/figures/sheet.h"

namespace deflect::figures {

/// Where it stands, and a line for each part: what it is, from where to where, its length and axes; then what is wrong.
std::string drawing_report(const MachineDrawing&);

/// {"drawing": "device" | "frame", "name", "about", "pose_mm_deg", "driven": [{"name", "value", "unit"}],
///  "members": [{"leg", "part", "section", "material", "start_mm", "end_mm", "length_mm", "axes": [x, y, z], "size_mm":
///  [y, z], "round"}], "joints": [{"leg", "part", "at_mm", "axes", "freedoms": six letters, "elastic": ["rz", …],
///  "driven"}], "frames": [{"name", "at_mm", "axes", "held"}], "points_mm", "lines": [[a, b, member or −1], …],
///  "motions": [{"words", "displacement_mm"}], "trouble"}
std::string drawing_json(const MachineDrawing&);

/// From the front, from above and askew, with names, lengths, joints, axes and a scale; a motion that nothing resists
/// beside the place where it begins.
Figure drawing_figure(const MachineDrawing&, const FigureStyle&);

}  // namespace deflect::figures
