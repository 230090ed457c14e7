// A structured discrepancy: what is left of a residual, r ~ N(0, 1 + τ² B Bᵀ), B a family of patterns, of length √n
// each:
//   sites  all patterns that `compare` knows, site by site where they lie in sites;
//   poses  at each pose a displacement and a compliance of its own;
//   loads  displacements by kinks, steps, squares and products of the load's components, by powers of time and
//          temperature.
// Nothing is said of how the patterns come about. Those of poses are kept by pose: of W C, C of a pose alone and W as
// in whitening.h, r ~ N(0, 1 + τ² W C Cᵀ Wᵀ) is y = W_S⁻¹ r ~ N(0, 1 + B Bᵀ + τ² C̃ C̃ᵀ), C̃ = W_O W_N C still of poses
// alone and B of the errors that all poses share (scaled_groups.h).
#pragma once

#include <memory>

#include "validation/compare/comparison.h"
#include "validation/statistics/scaled_groups.h"

namespace deflect::diagnosis {

/// One per family, over the measured numbers, m and rad per unit of each pattern; groups: poses.
using Families = std::vector<statistics::PartedColumns>;
Families discrepancy_families(const compare::ResidualStudy&);

/// The same white, each column √n long but where it is 0. A family is either of all numbers or of groups.
struct WhitenedFamilies {
  WhitenedFamilies(const Families&, std::shared_ptr<const statistics::Whitening>, int threads = 1);

  struct Family {
    MatrixX columns, gram;                         // white; XᵀX
    std::vector<statistics::GroupColumns> groups;  // white within groups
  };
  std::vector<Family> families;
  std::shared_ptr<const statistics::Whitening> whitening;
};

class Discrepancy {
 public:
  /// What `fitted` (whitened too) spans is taken out of the patterns, which keep their size.
  explicit Discrepancy(std::shared_ptr<const WhitenedFamilies>, const MatrixX& fitted = {});

  /// ln of the evidence against "nothing": mean over the families and over τ, spread evenly in ln τ from 1e-3 to 10:
  /// none is too small to be one.
  double log_evidence(const VectorX& r) const;
  /// Of as much of r in the patterns of some family by chance.
  double p_value(const VectorX& r) const;

  /// The family and size that r speaks for.
  struct Size {
    std::size_t family = 0;
    double tau = 0;
  };
  Size likeliest(const VectorX& r) const;
  /// rᵀ (1 + τ² B Bᵀ)⁻¹ r: χ² with the discrepancy as one more nuisance.
  double chi2(const VectorX& r, const Size&) const;

 private:
  /// B of all numbers, BBᵀ = Q diag(w) Qᵀ, Q = (1 − FFᵀ) X V.
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
