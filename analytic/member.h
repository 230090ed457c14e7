// Flexibility of a straight clamped-free member at its tip. Equation numbers are those of Ahmad, Andersson, Sellgren.
#pragma once

#include "analytic/erratum.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// Compliance of the tip relative to the clamped start, [δ; θ] for [f; m] at the tip, in member axes (x along it), SI.
/// It is the inverse of (35) and (41) in closed form,
///   δx = fx L/EA,                 θx = mx L/GJ,
///   δy = fy L³/3EIz + mz L²/2EIz, θz = fy L²/2EIz + mz L/EIz,
///   δz = fz L³/3EIy − my L²/2EIy, θy = −fz L²/2EIy + my L/EIy,
/// with fy L/GAs_y and fz L/GAs_z added for a Timoshenko member.
Matrix6 tip_compliance(const PlacedMember&);

/// The inverse of (35) as printed, for a guideway: entry (2,6) is −6EI/L³, which has the wrong unit and is taken as a
/// number in the paper's N and mm; entry (5,5) is 6EI/L.
Matrix6 tip_compliance_guideway_as_printed(const PlacedMember&);

/// The inverse of (41) as printed, for a link, in the axes of (40): E is missing in the axial entry, π r²/L, and in
/// entry (4,4), 4I/L. They do not have the unit of a stiffness; the numbers are taken in the paper's N and mm.
Matrix6 tip_compliance_link_as_printed(const PlacedMember&);

/// The axes of (40): z along the link, x horizontal. Throws ModelError where the link is vertical and they are
/// undefined.
Matrix3 link_axes_as_printed(const PlacedMember&);

/// A compliance at the member's tip in axes R_WM, transformed to the point T and to base axes (21).
Matrix6 moved_to(const Vector3& p_WT, const PlacedMember&, const Matrix3& R_WM, const Matrix6& C_tip_M);

}  // namespace deflect::analytic
