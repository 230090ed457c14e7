// What a growing set of readings says, updated reading by reading.
//
// Readings z, whitened by their own noise, depend on nuisances η ~ N(0, Π) (tolerances common to all poses, errors of
// each pose, and what is fitted, to first order), z = X η + ε, ε ~ N(0, 1). A target is a vector t of changes of the
// readings, as between the predictions of two rivals. What no nuisance can absorb of it is
//   λ² = tᵀ (1 + X Π Xᵀ)⁻¹ t = min over η of |t − X η|² + ηᵀ Π⁻¹ η,
// by which χ² is expected to fall when the change that is there is described. For one more block of readings,
//   e = t − X α,  S = 1 + X P Xᵀ,  λ² += eᵀ S⁻¹ e,  α += P Xᵀ S⁻¹ e,  P −= P Xᵀ S⁻¹ X P,
// with P the covariance of η and α the η that best absorbs t, given the readings before (Kalman, 1960): the gain of a
// block is its innovation. For two targets, Q = Tᵀ (1 + X Π Xᵀ)⁻¹ T. A block is taken off again by the same formulae
// with all signs of S⁻¹ turned and S = 1 − X P Xᵀ, which is the S⁻¹ of its being taken last.
#pragma once

#include <vector>

#include "msa/base/spatial.h"

namespace deflect::plan {

/// λ² of all possible readings together, up to which no reading tells two things apart.
inline constexpr double nothing_tells = 1;

/// A block of readings over targets and nuisances, whitened by noise.
struct WhiteRows {
  MatrixX targets, shared;  ///< numbers × targets; × nuisances that all readings share
  MatrixX own;              ///< × errors of its pose, variance 1
  std::size_t pose = 0;
};

class Design {
 public:
  /// Before any reading of these poses: `P` covariance of the shared nuisances, `alpha` and `Q` as above of the
  /// readings that were taken elsewhere. Without Q (0 × 0) innovations() alone tells of the targets.
  Design(MatrixX P, MatrixX alpha, MatrixX Q);

  /// What Q becomes with a block, without taking it, and without one that was taken.
  MatrixX with(const WhiteRows&) const;
  MatrixX without(const WhiteRows&) const;
  void take(const WhiteRows&);
  /// A block that was taken.
  void drop(const WhiteRows&);
  /// e of a block by targets, whitened by S: with() is Q + wᵀ w, without() of a block that was `taken` Q − wᵀ w.
  MatrixX innovations(const WhiteRows&, bool taken) const;

  const MatrixX& Q() const { return Q_; }
  /// α: the shared nuisances that best absorb each target.
  MatrixX absorbed() const { return alpha_.topRows(shared_); }
  /// Covariance of the shared nuisances.
  MatrixX covariance() const { return P_.topLeftCorner(shared_, shared_); }
  /// ln |S| of a block: by how much it raises ln of the determinant of the nuisances' information.
  double log_determinant(const WhiteRows&) const;
  /// By how much a block lowers the trace of V P Vᵀ, V columns over the shared nuisances, and by how much it grows
  /// without a block that was taken.
  double trace_decrease(const WhiteRows&, const MatrixX& V) const;
  double trace_increase(const WhiteRows&, const MatrixX& V) const;

 private:
  struct Innovation {
    MatrixX e, S, PX;  // PX: all nuisances × numbers
  };
  Innovation innovation(const WhiteRows&, bool all, bool taken = false) const;
  void update(const Innovation&, double sense);
  double trace_change(const WhiteRows&, const MatrixX& V, bool taken) const;
  Eigen::Index position_of(std::size_t pose) const;  // of its own errors, or −1

  Eigen::Index shared_;
  MatrixX P_, alpha_, Q_;
  std::vector<std::pair<std::size_t, Eigen::Index>> poses_;  // with their positions
};

}  // namespace deflect::plan
