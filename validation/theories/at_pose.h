// One theory at one pose, trusted: every answer has passed the checks, or there is none.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analytic/model.h"
#include "msa/base/geometry.h"
#include "msa/base/stiffness_checks.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/configuration.h"

namespace deflect {

/// Where nothing loads a play, the mechanism floats in it: the displacement is the middle (set_valued_laws.h), from
/// which T may move by between `least` and `most` along each axis (m, rad) without changing any force.
struct Floating {
  std::vector<std::string> loose;  ///< the parts with that play; empty: nothing floats
  Vector6 least = Vector6::Zero(), most = Vector6::Zero();
};

/// A theory's answer to one wrench at T; SI, base axes.
struct Answer {
  Vector6 displacement;
  Matrix6 stiffness;                                     ///< tangent, in the state under the load
  std::vector<std::pair<std::string, double>> energies;  ///< by part, J, largest first
  StiffnessChecks checks;                                ///< of the stiffness; all hold
  std::vector<double> slips;                             ///< of the frictions after the load, as in Conditions
  /// Finite: about what dividing members leaves of the displacement, m and rad.
  Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();
  Floating floating = {};
  /// Motions along which the stiffness is infinite; `stiffness` is that of the others.
  int rigid = 0;
  std::vector<std::string> rigid_motions = {};  ///< of the closed form, in words
};

/// The bound of a check that demands `least`, relative: more where the structure amplifies the rounding of its own
/// numbers by `rounding` (Solver::rounding()), some dozens of which meet in an answer.
double bound_with(double least, double rounding);

/// The share of a displacement that rounding of the stiffness may cost: a tenth of ε times the ratio of the largest to
/// the smallest stiffness, but for infinite ones and those of motions that float, rotations weighed by the length; at
/// most 1e-7, so that no check loses its meaning.
double rounding_of(const Answer&, double length);

/// Checked: K = Kᵀ, K ⪰ 0, K_c J_q = 0, sign, equilibrium, energy. Throws NumericalError naming theory, pose and check,
/// or where equilibrium is not found. `where` begins the messages. In the deformed shape (Geometry) legs carry forces
/// that resist their passive joints, and the stored energy is not ½Fᵀd: there K = Kᵀ of what is left without −½[m]× of
/// the applied moment m, K ⪰ 0, sign and the balance of forces are checked.
class AnalyticAtPose {
 public:
  AnalyticAtPose(const Configuration&, std::string where);
  Answer solve(const Vector6& F_T_W, const Conditions& = {}) const;
  const analytic::AnalyticModel& model() const { return model_; }

 private:
  analytic::AnalyticModel model_;
  std::string where_;
  double length_;
  Vector6 weight_;             // at T, acts with every load
  double energy_at_rest_ = 0;  // of the assembled mechanism, whose legs may be strained
  bool strained_, slides_;     // as in Response
};

/// In the finite shape elements are halved until what that changes, over 3 (errors fall with the square of the length
/// or faster), is 1e-6 of the displacement or an element is an eighth of what was given. More than 1e-4 is refused.
class MsaAtPose {
 public:
  MsaAtPose(const Configuration&, const frame::MemberDivision&, std::string where);
  Answer solve(const Vector6& F_T_W, const Conditions& = {});

  /// T beside its place in the drawing, as assembled without load and weight.
  Vector6 offset() { return model_->assembled().u.segment<6>(6 * mechanism().tool); }

  const frame::MechanismModel& mechanism() const { return model_->mechanism(); }
  /// MsaModel::rounding() of the answers so far.
  double rounding() const { return model_->rounding(); }
  const std::vector<std::string>& notes() const { return model_->notes(); }
  const frame::GeometricState* deformed() const {
    return last_.state.geometric.get();
  }                                                               ///< its state, where not linear
  const VectorX& displacements() const { return last_.state.u; }  ///< of the last solve, by freedom of the structure

 private:
  void halve();
  void refine(const Vector6& F, const Conditions&);

  std::vector<Matrix6X> passive_twists_;
  std::vector<std::string> legs_;
  Vector3 p_WB_, p_WT_;  // base origin, tool point
  Configuration configuration_;
  frame::MemberDivision division_;
  std::unique_ptr<frame::MsaModel> model_, before_;  // before_: as it was before the last of the halvings, if any
  int halvings_ = 0;
  Eigen::Vector2d discretisation_ = Eigen::Vector2d::Zero();  // of last_
  std::string where_;
  frame::MsaSolution last_;
  bool has_stiffness_ = false;
  VectorX tangents_;  // of stiffness_, which a linear structure needs once
  Matrix6 stiffness_ = Matrix6::Zero();
  int rigid_ = 0;
  StiffnessChecks checks_;
};

}  // namespace deflect
