// The closed form for one device at many poses and loads. What does not depend on the pose is computed once, what does
// not depend on the load once per pose, and nothing is allocated after that. The equations are those of a Group of
// Chains (chain.h), restricted to what sweeps need:
//
//   A_i = N_iᵀ C_i N_i,   K = Σ N_i A_i⁻¹ N_iᵀ                       (45), (46), passive joints released
//
// with N_i the wrenches at T that the passive joints of leg i carry, and C_i the compliance of its members and laws.
// Where laws depend on their force the legs must be statically determinate: Σ N_i λ_i = F gives λ, and N_iᵀ t =
// e_i(λ_i), the legs' own deflections, gives the displacement t.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <string>
#include <vector>

#include "analytic/deflection.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

class PoseSweep {
 public:
  /// For configurations of this device: all must have the same parts, freedoms and laws.
  explicit PoseSweep(const Configuration&);

  /// False where the device needs AnalyticModel: parts in parallel within a leg, laws that jump, joints of given 6×6
  /// stiffness, joints beside the legs, misfits, a base or tool that moves or yields.
  bool applies() const { return applies_; }

  /// Moves to another pose, for any number of solve(). The configuration need not outlive the call.
  void at(const Configuration&);

  /// Response at this pose to the wrench F at T, the weight and `warmer` K above 20 °C, base axes, SI: displacement [δ;
  /// θ] of T from the assembled state, and tangent stiffness. A law without stiffness at its force makes its freedom a
  /// passive one where there is no load at all. Returns false, without a result, where a pose or load needs
  /// AnalyticModel: a leg is rigid along a wrench that it carries, a law has no stiffness under load, the legs do not
  /// hold T, or, with legs that are not statically determinate, there is a temperature change or a law depends on its
  /// force.
  bool solve(const Vector6& F_T_W, double warmer = 0);

  const Vector6& displacement() const { return displacement_; }
  const Matrix6& stiffness() const { return stiffness_; }

  bool linear() const { return linear_; }  ///< no law's stiffness depends on its force
  /// Of the last solve(): wrench of the platform on a leg, at T; stiffness of a leg; strain energy of the mechanism, J.
  Vector6 leg_wrench(std::size_t leg) const { return legs_[leg].N * legs_[leg].lambda; }
  Matrix6 leg_stiffness(std::size_t leg) const;
  double energy() const;
  /// Twists at T of a leg's passive joints (columns).
  void find_passive_twists(std::size_t leg, Matrix6X& out) const { out = legs_[leg].twists; }

  struct Part {
    std::size_t leg;  ///< from 0
    std::string name;
  };
  /// The flexible parts, leg by leg from base to platform: members, and joints with laws.
  const std::vector<Part>& parts() const { return parts_; }

  /// ∂K/∂ln s for each part, with s a factor on the part's stiffness at its force: N A⁻¹ NᵀC_part N A⁻¹ Nᵀ, symmetric
  /// and positive semidefinite; they add up to K. For linear laws this is the derivative of K at constant load. Of the
  /// last solve().
  const std::vector<Matrix6>& derivatives();

 private:
  static constexpr std::size_t most_passive = 12;  // joints of a leg
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  using Numbers = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
  struct Freedom {
    std::size_t part, index;  // of the leg; tx … rz
    std::size_t shared;       // in parts_
    Spring spring;
    bool given_by_pose;  // a cable whose length is the actuator's extension
    std::array<double, 6> twist{};
    double force = 0, yields = 0;
  };
  struct Flexible {
    std::size_t part, shared;
    Small A;  // NᵀC N
  };
  struct Leg {
    std::vector<Flexible> members;
    std::vector<Freedom> springs;
    std::vector<std::pair<std::size_t, std::size_t>> passive;
    Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, most_passive> twists;  // of the passive joints, at T
    Vector3 expansion = Vector3::Zero();                                  // per kelvin, of the end against the start
    Columns N;
    Small members_A, A, inverse;  // of the members; of all
    Numbers lambda;
  };

  static void carry(Leg&, const PlacedLeg&, const Vector3& p_WT, double length);
  bool determine();
  bool assemble(bool loaded = true);
  static bool invert(Leg&);
  static void release(Leg&, Freedom&);
  static void tell_forces(Leg&);
  Vector6 moved_by_deflections(double warmer) const;

  bool applies_ = true, linear_ = true, determinate_ = false, held_ = false;
  std::vector<Leg> legs_;
  std::vector<Part> parts_;
  std::vector<Matrix6> derivatives_;
  Vector3 weight_ = Vector3::Zero();
  double size_ = 0;
  Eigen::PartialPivLU<Matrix6> statics_;  // of determinate legs
  // Of the stiffness, for other legs; rotations weighed by size_. One that has factorised nothing must not be copied:
  // Eigen leaves its info() uninitialised.
  Eigen::LDLT<Matrix6> factor_{Matrix6::Identity()};
  Vector6 displacement_ = Vector6::Zero();
  Matrix6 stiffness_ = Matrix6::Zero();
};

}  // namespace deflect::analytic
