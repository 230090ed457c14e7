// The least-squares problem of a fit: the whitened residual over the coordinates of a hypothesis's parameters.
//
// The coordinate of a parameter on a logarithmic scale is its logarithm, of another its value over half its range, so
// that steps of size 1 are large. A parameter with a prior adds a row behind the measured numbers: its distance from
// the prior's mean in standard deviations, of the logarithm (deviation over mean) on a logarithmic scale.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/hypothesis.h"

namespace deflect::diagnosis {

double coordinate(const effects::EffectParameter&, double value);
/// The value there, within the parameter's bounds.
double value_at(const effects::EffectParameter&, double x);
/// What is known of the coordinate before, where the parameter has a prior; of a logarithm, with deviation over mean.
std::optional<effects::ParameterPrior> prior_of_coordinate(const effects::EffectParameter&);

/// Of all parameters.
VectorX coordinates_of(const Hypothesis&, const VectorX& values);
VectorX values_at(const Hypothesis&, const VectorX& coordinates);

class FitProblem {
 public:
  /// Both must outlive it.
  FitProblem(const Observations&, const Hypothesis&);

  VectorX values(const VectorX& x) const;
  VectorX coordinates(const VectorX& values) const;

  /// Measured numbers, and one more for each prior.
  Eigen::Index rows() const { return wall_.size(); }

  /// Nothing where the subject cannot have these values or cannot be predicted with them; `why` then says it.
  std::optional<VectorX> residual(const VectorX& x, std::string* why = nullptr) const;

  /// From now on the deformed shape contributes what it does there (Observations::shape_for), instead of what it does
  /// at each x, which takes far longer where play floats. Returns by how much that changes the residual, in norm.
  double stand_at(const VectorX& x);
  /// The same with what it does to the granted subject: for a first look at many sizes.
  void stand_as_granted();

  bool has_history(const VectorX& x) const;

  /// For a search: what cannot be predicted is far worse than anything that can.
  VectorX residual_or_wall(const VectorX& x) const;

  const std::vector<const effects::EffectParameter*>& parameters() const { return parameters_; }

 private:
  const Observations& observations_;
  std::vector<const effects::EffectParameter*> parameters_;
  effects::PreparedEffects prepared_;
  VectorX wall_;
  std::optional<VectorX> shape_;
};

/// The residual over some of the coordinates, the others held, as MINPACK's port in Eigen wants it.
struct FreeResidual {
  using Scalar = double;
  using InputType = VectorX;
  using ValueType = VectorX;
  using JacobianType = MatrixX;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const FitProblem* problem;
  VectorX held;                    ///< all coordinates
  std::vector<Eigen::Index> free;  ///< those that move

  VectorX all(const VectorX& x) const;
  int inputs() const { return static_cast<int>(free.size()); }
  int values() const { return static_cast<int>(problem->rows()); }
  int operator()(const VectorX& x, VectorX& r);
  int df(const VectorX& x, MatrixX& J);

  /// Where it was evaluated last: a search asks for the derivative there.
  struct Point {
    VectorX x, r;
  };
  Point last = {};
};

/// Levenberg–Marquardt with so many evaluations at most.
VectorX minimised(FreeResidual, VectorX x, int evaluations);

/// A value of the last effect's one parameter, and χ² with it.
struct SizedEffect {
  VectorX value;
  double chi2 = 0;
};

/// The size that explains most: from `small`, what the signature says (signatures.h), on to sizes up to 128 times as
/// far from the value at which the effect vanishes, within its bounds, as long as each explains more than the one
/// before. Of a factor that moves the readings in another direction where it is large (turns_as_it_grows()), of both
/// senses over the whole range, whatever its signature says. `from`: values of the effects before. Nullopt where none
/// of them can be predicted, or nothing says where to begin.
std::optional<SizedEffect> best_size(const Observations&, const Hypothesis&, const VectorX& from,
                                     const std::optional<VectorX>& small);

/// The same of an effect by which a part can let go (lets_go(), signatures.h), from the other side: from the end of its
/// range, where the part is gone, to the size at which it begins to carry, and down to a thousandth of that, past sizes
/// that explain less. χ² over the width of play has several valleys: within one the play is closed in every reading,
/// within another it is open in all but a few. Of sizes that explain the same, since the part carries nothing, the
/// one nearest to where the effect vanishes. Nullopt where the part that is gone leaves more than `most` of χ², or
/// nothing can be predicted without it.
std::optional<SizedEffect> best_size_of_what_lets_go(const Observations&, const Hypothesis&, const VectorX& from,
                                                     double most);

}  // namespace deflect::diagnosis
