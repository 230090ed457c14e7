// The signature of an effect: the directions in which it changes the whitened residual.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/hypothesis.h"

namespace deflect::diagnosis {

struct Signature {
  effects::PlacedEffect effect;
  /// Unit columns. For an effect whose parameters are all amplitudes: orthonormal, spanning the changes that it can
  /// make. For a shaped effect (an amplitude and parameters that determine its shape): one column for each of a few
  /// shapes, of which only one applies.
  MatrixX basis;
  bool shaped = false;
  VectorX start;           ///< change of the whitened residual at the start values is basis · start
  double lambda = 0;       ///< its norm
  bool one_sided = false;  ///< physics fixes the amplitude's sign (where shaped, that of the columns)

  int amplitudes() const { return shaped ? 1 : static_cast<int>(basis.cols()); }
  /// Inner product of the change at the start values with a residual.
  double start_along(const VectorX& residual) const { return start.dot(basis.transpose() * residual); }
};

/// An effect that cannot be tested on these data, and why.
struct LeftOut {
  std::string effect, why;
};

/// One signature for each effect at each of its places in the subject, as long as it changes what was measured. Entries
/// without one are added to `left_out`. Equilibrium in the deformed shape is not tested as an effect: its size is
/// known, and the prediction contains it. The effects must outlive the result.
std::vector<Signature> signatures(const Observations&, const std::vector<effects::Effect>&, int threads,
                                  std::vector<LeftOut>* left_out = nullptr);

/// Prior weight of each signature: 1 for one of an entry of the catalogue; all laws at places together at most 15 % of
/// the entries, so that they do not outvote them. 1 for each where there are no entries.
std::vector<double> weights_of(const std::vector<Signature>&);

/// The value at which the effect best explains the residual, if its signature grows in proportion to the distance from
/// the value at which it vanishes (to the compliance, where it vanishes at infinity). Nullopt for effects with several
/// parameters, and where a stiffness would have the wrong sign.
std::optional<VectorX> guess(const Signature&, const VectorX& residual);

/// The largest reduction of χ² by the effect, linear in its amplitudes, in addition to what is fitted already.
/// `beside`: orthonormal columns of that (columns.h).
double most_gain(const Signature&, const VectorX& residual, const MatrixX& beside);

/// Share of the signature outside the span of what is fitted: the sine of its angle to that span, as root mean square
/// over all its directions.
double own_share(const Signature&, const MatrixX& beside);

/// Inner products of the columns of all bases, in the order of the signatures.
MatrixX inner_products(const std::vector<Signature>&);

/// Largest cosine between the spans of two signatures; cosines(): for every pair, from their inner_products() where
/// these are known.
double cosine(const Signature&, const Signature&);
MatrixX cosines(const std::vector<Signature>&);
MatrixX cosines(const std::vector<Signature>&, const MatrixX& inner_products);

/// p-value of a gain in χ² as if this were the only effect tested.
double single_p_value(const Signature&, double gain);

/// The gain with this p-value; 0 where every gain has a smaller p-value.
double gain_at_p_value(const Signature&, double p);

}  // namespace deflect::diagnosis
