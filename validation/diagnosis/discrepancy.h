// A structured discrepancy, for what is left of a residual: r ~ N(0, 1 + τ² B Bᵀ). The columns of B are a family of
// patterns, each of length √n:
//   sites  all patterns of `compare`; those that act at sites, site by site;
//   poses  at each pose a displacement and a compliance of its own;
//   loads  displacements as functions of the load's components (kinks, steps, squares, products) and as powers of time
//          and temperature.
// It assumes no cause for the patterns. Those of poses are stored by pose. With W of whitening.h, their columns are
// W C, where each column of C is nonzero in one pose only. Then
//   r ~ N(0, 1 + τ² W C Cᵀ Wᵀ)   is equivalent to   y = W_S⁻¹ r ~ N(0, 1 + B Bᵀ + τ² C̃ C̃ᵀ)
// with C̃ = W_O W_N C, whose columns are still nonzero in one pose only, and with B of the errors that all poses share
// (scaled_groups.h).
#pragma once

#include <memory>

#include "validation/compare/comparison.h"
#include "validation/statistics/scaled_groups.h"

namespace deflect::diagnosis {

/// One matrix per family, its rows the measured numbers (m, rad per unit of the pattern); groups: poses.
using Families = std::vector<statistics::PartedColumns>;
Families discrepancy_families(const compare::ResidualStudy&);
/// The family of sites.
MatrixX site_patterns(const compare::ResidualStudy&);

/// The same whitened, each column scaled to length √n unless it is 0. A family consists either of columns over all
/// numbers or of columns by group.
struct WhitenedFamilies {
  WhitenedFamilies(Families, std::shared_ptr<const statistics::Whitening>, int threads = 1);

  struct Family {
    MatrixX columns, gram;                         // white; XᵀX
    std::vector<statistics::GroupColumns> groups;  // white within groups
  };
  std::vector<Family> families;
  std::shared_ptr<const statistics::Whitening> whitening;
};

class Discrepancy {
 public:
  /// The span of `fitted` (whitened) is projected out of the patterns, which are not rescaled afterwards.
  explicit Discrepancy(std::shared_ptr<const WhitenedFamilies>, const MatrixX& fitted = {});

  /// ln of the evidence against "nothing": the mean over the families and over τ, with a prior uniform in ln τ from
  /// 1e-3 to 10, so that even a small discrepancy counts.
  double log_evidence(const VectorX& r) const;
  /// Probability that chance puts as much of r into the patterns of some family.
  double p_value(const VectorX& r) const;

  /// The most likely family and size.
  struct Size {
    std::size_t family = 0;
    double tau = 0;
  };
  Size likeliest(const VectorX& r) const;
  /// rᵀ (1 + τ² B Bᵀ)⁻¹ r: χ² with the discrepancy as one more nuisance.
  double chi2(const VectorX& r, const Size&) const;

 private:
  /// B over all numbers: BBᵀ = Q diag(w) Qᵀ, Q = (1 − FFᵀ) X V.
  struct OfAll {
    MatrixX along_fitted;  // XᵀF
    MatrixX V;
    VectorX w;
  };
  struct OfGroups {
    std::optional<statistics::ScaledGroups> groups;
    std::vector<statistics::ScaledGroups::Scaled> scaled;  // at each τ
    statistics::ScaledGroups::Scaled none;
  };
  struct Family {
    OfAll all;
    OfGroups own;
  };
  struct Gain {
    double gain = 0;
    int freedoms = 0;
  };
  VectorX along(std::size_t family, const VectorX& r) const;  // Qᵀr
  statistics::ScaledGroups::Seen seen(std::size_t family, const VectorX& r) const;
  std::vector<double> log_likelihoods(std::size_t family, const VectorX& r) const;  // by τ
  Gain own_gain(std::size_t family, const VectorX& r) const;

  std::shared_ptr<const WhitenedFamilies> white_;
  MatrixX fitted_;  // orthonormal
  std::vector<Family> families_;
};

}  // namespace deflect::diagnosis
