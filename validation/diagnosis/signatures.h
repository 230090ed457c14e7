// What each effect would do to the data, small: directions of the whitened residual.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/hypothesis.h"

namespace deflect::diagnosis {

struct Signature {
  effects::PlacedEffect effect;
  /// Unit columns. Of an effect whose parameters are amplitudes: orthonormal, as many as it has. Of one with an
  /// amplitude and parameters that shape it: the direction at each of a few shapes, of which it takes one.
  MatrixX basis;
  bool shaped = false;
  VectorX at_start;        ///< change of the whitened residual at the start values: its length is λ there
  bool one_sided = false;  ///< physics fixes the amplitude's sign: that of the columns of `basis`, where shaped

  int amplitudes() const { return shaped ? 1 : static_cast<int>(basis.cols()); }
};

/// An effect that is no hypothesis for these data, and why.
struct LeftOut {
  std::string effect, why;
};

/// Those of the places that effects have in the device and that change what was measured; the others are told in
/// `left_out`. Equilibrium in the deformed shape is no hypothesis: it is known in size, and in the prediction. The
/// effects must outlive the result.
std::vector<Signature> signatures(const Observations&, const std::vector<effects::Effect>&, int threads,
                                  std::vector<LeftOut>* left_out = nullptr);

/// How much each counts where many are looked at: an entry of the catalogue 1, all laws at places together a share of
/// all entries, so that they do not outvote them; 1 where there are no entries.
std::vector<double> weights_of(const std::vector<Signature>&);

/// What the effect's value would be, were its signature in proportion to its distance from where it vanishes: from the
/// residual it is to explain. Nothing for effects of several parameters, or of the wrong sign.
std::optional<VectorX> guess(const Signature&, const VectorX& residual);

/// The most that the effect can take off χ² as far as it is linear in its amplitudes, beside what is fitted already:
/// orthonormal columns (columns.h).
double most_gain(const Signature&, const VectorX& residual, const MatrixX& beside);

/// How much of the signature is its own beside what is fitted: the sine of its angle to their span, over
/// all its directions in the root mean square.
double own_share(const Signature&, const MatrixX& beside);

/// Inner products of all columns of all bases, signature after signature.
MatrixX inner_products(const std::vector<Signature>&);

/// Largest cosine between the spaces of two signatures, by pair.
double cosine(const Signature&, const Signature&);
MatrixX cosines(const std::vector<Signature>&);

/// p-value of a gain in χ² by the effect alone, as if it were the only one looked at.
double single_p_value(const Signature&, double gain);

/// The gain that has this p-value; 0 where every gain has a smaller one.
double gain_at_p_value(const Signature&, double p);

}  // namespace deflect::diagnosis
