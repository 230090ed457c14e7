// Tables (msa/mechanism/table.h) as a chain uses them: the deflection for a given force, from what earlier loads have
// left (TableLaw::left), δ = δ_e(f) + p⁺ − p⁻. N and m, or Nm and rad.
#pragma once

#include "msa/base/set_valued_laws.h"
#include "msa/mechanism/law.h"

namespace deflect::analytic {

double table_deflection(const TableLaw&, double force);

/// Slope of the curve, at a corner (to 1e-9 of its force) that of the piece farther from no force.
double table_compliance(const TableLaw&, double force);

/// δ(P + f) − δ(P) of an elastic table, with its digits where f is small, and the energy f δ − ∫δ df from P on.
double table_change(const TableLaw&, double P, double f);
double table_change_energy(const TableLaw&, double P, double f);

/// What it gives back when the force is taken away: δ_e's energy, and Σ∫f dB up to the force at which B leaves p.
double table_stored_energy(const TableLaw&, double force);

/// p⁺ and p⁻ under the force.
std::array<double, 2> table_left(const TableLaw&, double force);

/// f by δ, counted from `rest` and from the preload P: straight between the corners of the curve.
ScalarLaw table_by_corners(const TableLaw&, double rest, double P);

}  // namespace deflect::analytic
