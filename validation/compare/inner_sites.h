// What places inside a frame would have to yield, each taken alone, for the residual to be its doing.
//
// A frame has more members than sensors, so that the residual does not tell what each of them does. Of one place alone
// it does: readings follow from the force f that passes there (InnerSite, subject.h) and the elongation e that the
// place has in excess of the model's, r = moves · e.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/elongation.h"

namespace deflect::compare {

struct InnerSiteFit {
  std::string site;
  bool rotation = false;                ///< in Nm and rad, else N and m
  bool determinate = false;             ///< statics alone says what passes
  double redundancy = 0;                ///< InnerSite::redundancy
  double most = 0;                      ///< the largest force of the readings
  double gain = 0;                      ///< what e ∝ f, e ∝ |f| and a step at f = 0 together take off χ²
  int freedoms = 0;                     ///< of these shapes
  double p_value = 1;                   ///< of the gain, as if no other place were looked at
  double share = 0;                     ///< of what the residual has beyond noise and tolerances
  double per_force = 0, deviation = 0;  ///< e/f of e ∝ f alone, m/N or rad/Nm; one standard deviation
};

struct InnerFits {
  std::vector<InnerSiteFit> all;        ///< the largest gain first; without those that no sensor sees
  std::vector<ElongationCurve> curves;  ///< of the first of them, each alone
};
InnerFits fits_of_inner_sites(const ResidualStudy&, const statistics::Uncertainty&, const VectorX& residual);

/// By inner site (rows) and reading the force that passes: N, Nm.
MatrixX inner_forces(const ResidualStudy&);

/// By inner site how much more force passes than predicted, N or Nm, at one reading: of all elongations that explain
/// the residual, the likeliest where each place's is of the size of its elastic one or less (as when its stiffness is
/// off), beside noise sigma and tolerances A (columns over the measured numbers). Where statics determines all forces
/// it is zero.
VectorX residual_forces(const ResidualStudy&, const std::vector<double>& sigma, const MatrixX& A,
                        const VectorX& residual, std::size_t reading);

}  // namespace deflect::compare
