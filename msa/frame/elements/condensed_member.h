// A member of several elements as a substructure: its inner nodes condensed, k_ee − k_ei k_ii⁻¹ k_ie over the ends e
// and the inner nodes i, and kept while length and rigidity stay what they were.
#pragma once

#include <vector>

#include "msa/frame/elements/beam.h"

namespace deflect::frame {

class CondensedMember {
 public:
  /// Nodes at these fractions of the length, from 0 to 1.
  explicit CondensedMember(std::vector<double> at) : at_(std::move(at)) {}

  /// False, and no stiffness, where nothing holds an inner node.
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
