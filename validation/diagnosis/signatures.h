// The signature of an effect: the directions in which it changes the whitened residual.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/hypothesis.h"
#include "validation/diagnosis/whatever_the_law.h"

namespace deflect::diagnosis {

struct Signature {
  effects::PlacedEffect effect;
  /// Unit columns. For an effect whose parameters are all amplitudes: orthonormal, spanning the changes that it can
  /// make. For a shaped effect (an amplitude and parameters that determine its shape): one column for each of a few
  /// shapes, of which only one applies.
  MatrixX basis;
  bool shaped = false;
  VectorX start;                       ///< change of the whitened residual at the start values is basis · start
  double lambda = 0;                   ///< its norm
  bool one_sided = false;              ///< physics fixes the amplitude's sign (where shaped, that of the columns)
  Columns whatever_the_law = nullptr;  ///< at its place, as any_curve (WhateverTheLaw)
  AnyCurve any_curve = nullptr;
  Columns any_friction = nullptr;

  int amplitudes() const { return shaped ? 1 : static_cast<int>(basis.cols()); }
  /// Inner product of the change at the start values with a residual.
  double start_along(const VectorX& residual) const { return start.dot(basis.transpose() * residual); }
};

/// A place, of every leg or of one, at which none of the effects changes what was measured, and what may happen there.
struct PlaceWithoutLaw {
  subject::Place place;
  std::optional<int> leg;
  Columns whatever_the_law = nullptr, any_friction = nullptr;  ///< null where there is none

  bool shows() const {
    return (whatever_the_law && whatever_the_law().cols() > 0) || (any_friction && any_friction().cols() > 0);
  }
};

/// What may explain a residual.
struct Explanations {
  std::vector<Signature> laws;
  std::vector<PlaceWithoutLaw> without_law = {};
};

/// An effect that cannot be tested on these data, and why.
struct LeftOut {
  std::string effect, why;
};

/// One signature for each effect at each of its places in the subject, as long as it changes what was measured.
/// Equilibrium in the deformed shape is not tested as an effect: its size is known, and the prediction contains it. The
/// effects must outlive the result.
class SignaturesAtPlaces {
 public:
  /// Throws ModelError where effects have places and the subject stands with none of them.
  SignaturesAtPlaces(const Observations&, const std::vector<effects::Effect>&, int threads);

  /// Weighs the same changes as these observations do. They must be those of before but for the readings that are set
  /// aside and what counts as right (Observations::granted()), so that nothing is predicted anew.
  void weigh_for(const Observations&, int threads);

  /// Whether these observations weigh as those of the last weighing do.
  bool are_weighed_for(const Observations&) const;
  /// Law k of known(), and a place without one, as other observations weigh them, which must be as in weigh_for().
  Signature law_seen_by(const std::shared_ptr<const Observations>&, std::size_t k) const;
  PlaceWithoutLaw seen_by(const std::shared_ptr<const Observations>&, const PlaceWithoutLaw&) const;

  const std::vector<Signature>& all() const& { return known_.laws; }
  std::vector<Signature> all() && { return std::move(known_.laws); }
  /// The signatures and the subject's other places.
  const Explanations& known() const& { return known_; }
  /// Entries without a signature.
  const std::vector<LeftOut>& left_out() const { return left_out_; }

 private:
  /// The change itself is W⁻¹ basis · coordinates at the numbers that count, and `aside` at those that are set aside.
  struct Place {
    effects::PlacedEffect effect;
    MatrixX coordinates = {}, aside = {};
    bool summed = false;
    std::string why = {};  ///< where there is no change
  };
  template <class ChangeOf>
  void weigh(const Observations&, int threads, const ChangeOf&);
  /// `before`, `aside`: of the weighing that gave this basis.
  static std::optional<Change> change_again(const Place&, const MatrixX& basis, const statistics::Whitening& before,
                                            const std::vector<Eigen::Index>& aside);

  std::vector<Place> places_;
  std::optional<WhateverTheLaw> whatever_;
  Explanations known_;  ///< laws in the order of the places
  std::vector<std::size_t> place_of_law_;
  std::vector<LeftOut> left_out_;
  std::size_t nowhere_ = 0;  ///< how many of left_out_ have no place in the subject
  std::shared_ptr<const statistics::Whitening> whitening_;
  std::vector<Eigen::Index> aside_;  ///< numbers
};

/// The signatures alone, for one weighing. Entries without one are added to `left_out`.
std::vector<Signature> signatures(const Observations&, const std::vector<effects::Effect>&, int threads,
                                  std::vector<LeftOut>* left_out = nullptr);

/// Prior weight of each signature: 1 for one of an entry of the catalogue; all laws at places together at most half of
/// the entries, so that hundreds of them do not outvote these. 1 for each where there are no entries. A law in one leg
/// weighs as much, in all legs together, as one in all legs alike. A choice: of three things that are missing one is
/// not in the catalogue.
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
MatrixX inner_products(const std::vector<Signature>&, int threads = 1);

/// Largest cosine between the spans of two signatures; cosines(): for every pair, from their inner_products().
double cosine(const Signature&, const Signature&);
MatrixX cosines(const std::vector<Signature>&, const MatrixX& inner_products);

/// Per signature the first one that does all but the same (a cosine above 0.999).
std::vector<std::size_t> classes_of(const std::vector<Signature>&, const MatrixX& inner_products);

/// Whether the part at the effect's place can let go by it, so that it carries nothing.
///
/// Let a be the displacement that a reading's loads and the weight cause at the place where the part is gone, C > 0 the
/// compliance of all the rest there, the part's own spring among it. The part carries the force f with a − C f = δ(f):
///   a spring in series, δ = f/k      f = a/(C + 1/k), 0 as k falls to 0; a factor on the part's own stiffness alike
///   play of ±g                       f = 0 wherever |a| ≤ g, else (a ∓ g)/C
///   yielding in one sense, δ = y f   f = a/(C + y) in that sense and a/C in the other: 0 as y grows where no reading
///                                    has an a of the other sign
/// Readings depend on the law through f alone. So play that is at least as wide as the largest |a| of a campaign, and
/// a part that is gone, are the same to it, exactly and for every such width. A Hertz contact is not among these: what
/// touches is pressed together.
bool lets_go(const effects::Effect&);
std::vector<char> those_that_let_go(const std::vector<Signature>&);

/// By signature: the sum over its class.
std::vector<double> summed(const std::vector<double>&, const std::vector<std::size_t>& classes);

/// Priors of `all_together` in sum. The places of an entry share its own, and effects of one class have one together.
std::vector<double> shared_priors(const std::vector<Signature>&, const std::vector<std::size_t>& classes,
                                  double all_together);

}  // namespace deflect::diagnosis
