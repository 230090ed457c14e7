// The first theory: the methodology of Ahmad, Andersson and Sellgren in closed form, errata corrected (or, by name, as
// printed). Chains in parallel (1), (46) between the compliance of the base and of the tool. It sees the configuration
// and nothing of the frame solver.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analytic/chain.h"

namespace deflect::analytic {

/// Equilibrium under one wrench [f; m] at T; base axes, SI.
struct AnalyticSolution {
  Vector6 displacement = Vector6::Zero();  ///< [δ; θ] of T
  Vector6 load = Vector6::Zero();
  std::vector<Vector6> leg_wrenches;  ///< what the platform exerts on each leg, at T
  bool converged = false;
  int iterations = 0;
  double misfit = 0;  ///< how far the legs' ends and the platform disagree, relative to the displacement
};

/// A mechanism at one pose.
class AnalyticModel {
 public:
  explicit AnalyticModel(const Configuration&, const AsPrinted& = {});

  const std::vector<Chain>& chains() const { return chains_; }

  /// No law's stiffness depends on its load.
  bool linear() const;

  /// Legs' forces and the platform's displacement in equilibrium, contacts at their load: Newton on the legs' forces.
  /// Throws ModelError naming the motion when the legs leave the platform free to move, whatever the
  /// load.
  AnalyticSolution solve(const Vector6& F_T_W) const;

  /// Tangent stiffness at T in the solution's state.
  Matrix6 stiffness(const AnalyticSolution&) const;
  Matrix6 leg_stiffness(std::size_t leg, const AnalyticSolution&) const;

  /// Strain energy by part, J, largest first.
  std::vector<std::pair<std::string, double>> energies(const AnalyticSolution&) const;

 private:
  AsPrinted as_printed_;
  std::vector<Chain> chains_;
  Chain through_;  ///< base and tool joints, which carry the whole load
};

}  // namespace deflect::analytic
