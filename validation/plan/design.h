// What a growing set of readings says, updated reading by reading.
//
// Readings z, whitened by their own noise, depend on nuisances η ~ N(0, Π) (tolerances common to all poses, errors of
// each pose, and what is fitted, to first order), z = X η + ε, ε ~ N(0, 1). A target is a vector t of changes of the
// readings, as between the predictions of two rivals. What no nuisance can absorb of it is
//   λ² = tᵀ (1 + X Π Xᵀ)⁻¹ t = min over η of |t − X η|² + ηᵀ Π⁻¹ η,
// by which χ² is expected to fall when the change that is there is described. For one more block of readings,
//   e = t − X α,  S = 1 + X P Xᵀ,  λ² += eᵀ S⁻¹ e,  α += P Xᵀ S⁻¹ e,  P −= P Xᵀ S⁻¹ X P,
// with P the covariance of η and α the η that best absorbs t, given the readings before (Kalman, 1960): the gain of a
// block is its innovation. For two targets, Q = Tᵀ (1 + X Π Xᵀ)⁻¹ T.
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
  /// readings that were taken elsewhere.
  Design(MatrixX P, MatrixX alpha, MatrixX Q);

  /// What Q becomes with a block, without taking it.
  MatrixX with(const WhiteRows&) const;
  void take(const WhiteRows&);

  const MatrixX& Q() const { return Q_; }
  /// Covariance of the shared nuisances.
  MatrixX covariance() const { return P_.topLeftCorner(shared_, shared_); }
  /// ln |S| of a block: by how much it raises ln of the determinant of the nuisances' information.
  double log_determinant(const WhiteRows&) const;
  /// By how much a block lowers the trace of V P Vᵀ, V columns over the shared nuisances.
  double trace_decrease(const WhiteRows&, const MatrixX& V) const;

 private:
  struct Innovation {
    MatrixX e, S, PX;  // PX: all nuisances × numbers
  };
  Innovation innovation(const WhiteRows&, bool all) const;
  Eigen::Index position_of(std::size_t pose) const;  // of its own errors, or −1

  Eigen::Index shared_;
  MatrixX P_, alpha_, Q_;
  std::vector<std::pair<std::size_t, Eigen::Index>> poses_;  // with their positions
};

}  // namespace deflect::plan
