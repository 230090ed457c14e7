// The laws of joints and drives as the methodology uses them: deflection for a given force, because all parts of a
// chain carry the same force. Equation numbers are those of Ahmad, Andersson, Sellgren.
#pragma once

#include <vector>

#include "analytic/erratum.h"
#include "msa/base/set_valued_laws.h"
#include "msa/mechanism/law.h"

namespace deflect::analytic {

/// Which equations are taken as printed.
using AsPrinted = std::set<Erratum>;

/// E' of (23) for two bodies of one material: 2/E' = 2 (1 − ν²)/E; as printed, 1/E' = 2 (1 − ν²)/E. Pa.
double effective_modulus(const Material&, const AsPrinted& = {});

/// Point contact, from (26): δ = (F / (E' √(8R'/9)))^{2/3} and its derivative, the inverse of (27). SI, F of any sign.
double point_contact_deflection(double R, double E_effective, double force);
double point_contact_compliance(double R, double E_effective, double force);
/// Contact radius r of (22). m.
double point_contact_radius(double R, double E_effective, double force);

/// Line contact: k = π l E'/4 (30), half width b = 2 √(2 F R'/(π l E')) (28). SI.
double line_contact_stiffness(double length, double E_effective);
double line_contact_half_width(double R, double length, double E_effective, double force);

/// Line contact with the compression of the bulk of both cylinders, radii R1 and R2: with p = F/l and κ = (1 − ν²)/(π
/// E), δ = 2 p κ (ln(2 (R1 + R2)/(p κ)) − 1), which is Johnson's δ = p κ Σ (2 ln(4 R_i/a) − 1) at a² = 8 p κ R1 R2/(R1
/// + R2).
double bulk_line_deflection(const HertzLineBulkLaw&, double force);
double bulk_line_compliance(const HertzLineBulkLaw&, double force);

/// Pin, simply supported, loaded in the middle: k = 48 E I/L³ (32).
double pin_bending_stiffness(const Material&, double diameter, double length);

/// Along the slide: motor shaft J G/L (4) through the pulley, k/r² (5); cable EA/L (7), cable pair (8), belt (10). N/m;
/// for a belt that turns a pulley, k r² in Nm/rad.
double motor_shaft_stiffness(const MotorShaftLaw&);
double cable_stiffness(const Material&, double area, double length);
double belt_stiffness(const BeltLaw&);

/// δ ∝ |f|ⁿ, its derivative infinite at f = 0 for n < 1.
double power_deflection(const PowerLaw&, double force);
double power_compliance(const PowerLaw&, double force);

/// The real root of x + x³ = q, x = δ/reference, q = f/(stiffness · reference): x = 2/√3 sinh(asinh(3√3/2 q)/3).
double hardening_deflection(const HardeningLaw&, double force);
double hardening_compliance(const HardeningLaw&, double force);

/// Deflection of one law under a force (N; Nm on a rotation), its derivative (infinite for an unloaded point contact)
/// and the stored energy f δ − ∫δ df. Laws that jump (steps.h) are not allowed here.
double deflection(const Law&, double force, const AsPrinted& = {});
double compliance(const Law&, double force, const AsPrinted& = {});
double stored_energy(const Law&, double force, const AsPrinted& = {});

/// The force at which a law that is neither linear nor a table has a deflection.
double force_of(const Law&, double deflection);

/// Laws of one freedom in series. Where (33) is taken as printed, contact and bending of a universal joint's pin are
/// combined as if in parallel.
double deflection(const std::vector<Law>&, double force, const AsPrinted& = {});
double compliance(const std::vector<Law>&, double force, const AsPrinted& = {});
double stored_energy(const std::vector<Law>&, double force, const AsPrinted& = {});

/// The elastic part of one freedom: laws in series with the preload P (N, Nm), the force that they carry while the
/// joint transmits none. With δ, c, U of the laws, a transmitted force f deflects it by δ(f + P) − δ(P), with the
/// compliance c(f + P), and stores U(f + P) − U(P) − P (δ(f + P) − δ(P)), the work of f from the preloaded state.
struct Spring {
  std::vector<Law> laws;
  double preload = 0;
};
double deflection(const Spring&, double force, const AsPrinted& = {});
/// At a force of magnitude max(|f + P|, `least`) and of its sign in the laws: `least` > 0 keeps contacts without load
/// finite.
double compliance(const Spring&, double force, double least = 0, const AsPrinted& = {});
double stored_energy(const Spring&, double force, const AsPrinted& = {});

/// In the sense of the force f.
double compliance(const OneSidedLaw&, double f);

/// δ of a preloaded law before any load.
double at_rest(const Law&, double P);

/// The law as f by δ, both from the state preloaded by P; with laws that jump (set_valued_laws.h). A friction's slip
/// counts from there too; `limit`: its own. It may refer to the law, which must outlive it.
ScalarLaw scalar_law(const Law&, double P, double slip, double limit);

}  // namespace deflect::analytic
