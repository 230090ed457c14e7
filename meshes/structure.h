// Between structures and meshes: how members are divided, and a solved structure as lines with fields.
#pragma once

#include "meshes/line_mesh.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/configuration.h"

namespace deflect {

/// Divides every member with Gmsh at about `element_size` (m) where the configuration stands; legs share the
/// division of the longest member of a part, so that the topology is one for all poses.
frame::MemberDivision divide_members(const Configuration&, double element_size);

/// Beams and the rigid arms of bodies as cells, one group per part ("guideway", "link", …, "rigid").
LineMesh lines_of(const frame::MechanismModel&);

/// The same of any structure: beams, and the arms between welded nodes.
LineMesh lines_of(const frame::Model&);

/// A free motion as displacements (mm) and rotations (rad), scaled so that the largest displacement is a tenth of the
/// structure.
FieldData fields_of_motion(const frame::Model&, const VectorX& u);

/// Displacements (mm), rotations (rad) of nodes; axial force (N), largest bending moment and torque (Nmm) of
/// elements.
FieldData fields_of(const frame::MechanismModel&, const VectorX& u, const frame::GeometricState* deformed = nullptr);

}  // namespace deflect
