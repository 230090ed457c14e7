#include "analytic/model.h"

#include <algorithm>

#include "analytic/deformed.h"
#include "analytic/rotation_vector.h"
#include "msa/base/error.h"
#include "msa/base/motion_text.h"

namespace deflect::analytic {
namespace {

/// What moves for nothing, of the mechanism in series: its joints of base and tool, its legs.
void refuse_motion(const Matrix6X& J, double length) {
  if (J.cols() == 0) return;
  Eigen::Index largest = 0;
  J.col(0).cwiseAbs().maxCoeff(&largest);
  throw ModelError("the platform cannot stand: the legs do not resist its " +
                   motion_text(J(largest, 0) < 0 ? Vector6(-J.col(0)) : Vector6(J.col(0)), length));
}

}  // namespace

AnalyticModel::AnalyticModel(const Configuration& c, const AsPrinted& as_printed)
    : configuration_(c),
      as_printed_(as_printed),
      legs_(legs_of(c, as_printed)),
      through_(chain_of({"base and tool", {c.base, c.tool}}, c.pose.p_WT, c.size)) {
  weight_ << c.weight, Vector3::Zero();
}

/// Displacements from the drawing.
AnalyticSolution AnalyticModel::equilibrium(const Vector6& F, Geometry geometry) const {
  refuse_motion(through_.J_q, through_.length);
  // Where an erratum takes away the moments' arms, the smallest displacement answers loads that drive no free motion.
  const bool driven =
      (legs_.J.transpose() * F).norm() > 1e-9 * (F.head<3>().norm() + F.tail<3>().norm() / legs_.length);
  if (driven || !as_printed_.count(Erratum::tcp_transfer)) refuse_motion(legs_.J, legs_.length);
  if (geometry == Geometry::linear || (F.isZero(0) && legs_.fits())) {
    const Group::State state = legs_.solve(F, as_printed_);
    return {state.t + through_.deflection(F, {}),
            F,
            state.wrenches,
            state.converged,
            state.iterations,
            state.misfit,
            "",
            {}};
  }
  const auto d = std::make_shared<const Deformed>(deform(configuration_, geometry, F));
  Vector6 displacement;
  displacement << d->translation, d->rotation_vector;
  return {displacement, F, d->leg_wrenches, d->converged, d->iterations, d->residual, d->message, d};
}

AnalyticSolution AnalyticModel::assembled(Geometry geometry) const {
  return equilibrium(Vector6::Zero(), as_printed_.empty() ? geometry : Geometry::linear);
}

AnalyticSolution AnalyticModel::solve(const Vector6& F, Geometry geometry) const {
  if (!as_printed_.empty()) geometry = Geometry::linear;
  AnalyticSolution s = equilibrium(F + weight_, geometry);
  s.load = F;
  if (legs_.fits()) return s;
  const AnalyticSolution reference = assembled(geometry);
  s.converged = s.converged && reference.converged;
  s.displacement -= reference.displacement;
  if (geometry == Geometry::finite)
    s.displacement.tail<3>() = rotation_vector(combined(s.deformed->turning, reference.deformed->turning.transpose()));
  return s;
}

Flexibility AnalyticModel::flexibility(const AnalyticSolution& s) const {
  Flexibility whole = legs_.flexibility(s.leg_wrenches, 0, as_printed_);
  const Flexibility through = through_.respond(s.load + weight_, 0, {}).tangent;
  whole.C += through.C;
  if (through.J.cols() > 0) {
    whole.J.conservativeResize(6, whole.J.cols() + through.J.cols());
    whole.J.rightCols(through.J.cols()) = through.J;
    whole.N = carried_wrenches(whole.J, legs_.length);
  }
  return whole;
}

Matrix6 AnalyticModel::leg_stiffness(std::size_t leg, const AnalyticSolution& s) const {
  if (s.deformed) return analytic::leg_stiffness(*s.deformed, leg);
  return legs_.branches[leg].stiffness(s.leg_wrenches[leg], as_printed_);
}

Matrix6 AnalyticModel::stiffness(const AnalyticSolution& s) const {
  if (s.deformed) return analytic::stiffness(*s.deformed);
  // Between a rigid base and a rigid tool the legs' stiffnesses add up without a digit lost.
  if (through_.members.empty() && through_.freedoms.empty()) return legs_.stiffness(s.leg_wrenches, as_printed_);
  return analytic::stiffness(flexibility(s), legs_.length, legs_.name);
}

Matrix6 AnalyticModel::compliance(const AnalyticSolution& s) const {
  if (s.deformed) return analytic::compliance(*s.deformed);
  const Flexibility whole = flexibility(s);
  refuse_motion(whole.J, legs_.length);
  return whole.C;
}

std::vector<std::pair<std::string, double>> AnalyticModel::energies(const AnalyticSolution& s) const {
  std::map<std::string, double> sums;
  if (s.deformed) s.deformed->whole.add_energies(s.deformed->circumstances, sums);
  for (std::size_t i = 0; !s.deformed && i < s.leg_wrenches.size(); ++i)
    legs_.branches[i].add_energies(s.leg_wrenches[i], as_printed_, sums);
  if (!s.deformed) through_.add_energies(s.load + weight_, {}, sums);
  std::vector<std::pair<std::string, double>> sorted(sums.begin(), sums.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

}  // namespace deflect::analytic
