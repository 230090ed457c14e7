// What the points of a table say (TableLaw): parameters that both theories read. Each computes the mechanics from them
// on its own.
//
// Without a branch for unloading the curve is elastic, the force a function of the deflection. With it, l(f) on loading
// from rest and u(f) on unloading from the last point F, 0 ≤ f ≤ F,
//   δ = c f + p⁺ − p⁻,   A(f) ≤ p⁺ ≤ B(f),   A(−f) ≤ p⁻ ≤ B(−f)
//   A(f) = l(f) − c f,   B(f) = u(f) − c f.
// p⁺ and p⁻ are what pull and push have left. They start at 0 and change only where a bound takes them along:
// p⁺ ← max(A(f), min(B(f), p⁺)), a generalised play (A. Visintin, Differential Models of Hysteresis, 1994, ch. III).
// Between the bounds the law is elastic with c, the compliance of the stiffest piece of
// both branches, so that neither bound falls as the force rises. Both branches come out as they were measured, smaller
// loops close on themselves and leave no trace once a larger load has passed (return-point memory), and a loop costs
// ∫(A⁻¹ − B⁻¹) dp ≥ 0. B ≥ A, unloading above loading, is all that this needs. A spring beside a friction is
// reproduced exactly.
//
// (Masing's rule, by which every loop has the shape of the first loading, would fit fewer branches: it demands that the
// loop is widest at F/3, where m(f) + 2 m((F − f)/2) is stationary for every m. Friction that grows with the load it
// stands beside, that of gears, has no such loop.)
//
// Not measured, and chosen: under push the law does what it does under pull. What is left at no force goes back under
// the opposite force with the slope that B has there, and has gone at −F at the latest. Beyond F nothing is lost.
#pragma once

#include <optional>
#include <string>

#include "msa/base/units.h"
#include "msa/mechanism/law.h"

namespace deflect {

struct TableCurves {
  TablePoints elastic;  ///< δ; goes on with its first and its last slope
  /// A and B, where the law remembers: zero before their first points. Both end at [F, P] and go on with `beyond`.
  TablePoints loading, unloading;
  double beyond = 0;
};

/// What is wrong with the points, in the units of the place: the key and the sentence with its remedy.
struct TableMistake {
  const char* key;
  std::string what;
};
std::optional<TableMistake> mistake_in(const TableLaw&, Dimension force = Dimension::force,
                                       Dimension motion = Dimension::length);

/// The same with its curves. Throws InputError for points with a mistake.
TableLaw identified(TableLaw);

/// The curves of an identified table.
const TableCurves& curves_of(const TableLaw&);

}  // namespace deflect
