// A solved frame as lines with fields.
#pragma once

#include "meshes/line_mesh.h"
#include "msa/frame/file/frame_analysis.h"

namespace deflect {

/// Elements of members as cells, one group per section, and rigid arms in the group "rigid".
LineMesh lines_of(const frame::FrameModel&);

/// Displacements (mm), rotations (rad) of nodes; of elements, in member axes: the mean axial force (N), torque, and the
/// moments about y and z at the end where they are larger (Nmm).
FieldData fields_of(const frame::FrameModel&, const frame::CaseResult&);

}  // namespace deflect
