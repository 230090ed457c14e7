// A member of several elements as a substructure with its inner nodes condensed, k_ee − k_ei k_ii⁻¹ k_ie for the ends e
// and the inner nodes i. The result is reused while length and rigidity do not change.
#pragma once

#include <vector>

#include "msa/frame/elements/beam.h"

namespace deflect::frame {

class CondensedMember {
 public:
  /// `at`: fractions of the length at which nodes are, from 0 to 1.
  explicit CondensedMember(std::vector<double> at) : at_(std::move(at)) {}

  /// Returns false, without a stiffness, where nothing holds an inner node.
  bool set(const BeamRigidity&, double length);

  const Matrix12& stiffness() const { return k_; }  ///< of the two ends, as local_stiffness()
  double stiffest() const { return stiffest_; }     ///< of the elements along or across, N/m

 private:
  bool append(const Matrix12& element);

  std::vector<double> at_;
  BeamRigidity rigidity_{};
  double length_ = 0, stiffest_ = 0;
  Matrix12 k_ = Matrix12::Zero();
};

}  // namespace deflect::frame
