#include "validation/theories/at_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "msa/base/error.h"

namespace deflect {
namespace {

constexpr double small_error = 1e-6;  // relative: is divided no further

void enforce(const std::string& failure, const char* theory, const std::string& where) {
  if (!failure.empty()) throw NumericalError(fmt::format("{}: the {} fails a check: {}", where, theory, failure));
}

double total(const std::vector<std::pair<std::string, double>>& energies) {
  double sum = 0;
  for (const auto& [part, energy] : energies) sum += energy;
  return sum;
}

/// In the deformed shape. Shapes are known to 1e-12, forces to that times the ratio of the stiffest to the softest
/// part.
Answer deformed_answer(Answer answer, const Vector6& F, const Vector3& reaction, const char* theory,
                       const std::string& where) {
  Matrix6 K = answer.stiffness;
  K.bottomRightCorner<3, 3>() += skew(F.tail<3>()) / 2;
  answer.checks = check_stiffness(K, {});
  enforce(answer.checks.failure, fmt::format("{} stiffness", theory).c_str(), where);
  Vector6 balance = -F;
  balance.head<3>() = reaction;
  enforce(response_failure({F, answer.displacement, balance, 0, false}, 1e-7),
          fmt::format("{} response", theory).c_str(), where);
  return answer;
}

std::string because(const std::string& reason) { return reason.empty() ? "" : ": " + reason; }

constexpr double checked_to = 1e-9;  // of each theory's answer by itself

bool from_rest(const Conditions& c) {
  return c.warmer == 0 && std::all_of(c.slips.begin(), c.slips.end(), [](double slip) { return slip == 0; });
}

/// Parts carry forces before any load.
bool strained_at_rest(const Configuration& c) {
  const auto preloaded = [](const PlacedJoint& joint) {
    return std::any_of(joint.preload.begin(), joint.preload.end(), [](double force) { return force != 0; });
  };
  bool found = preloaded(c.base) || preloaded(c.tool) ||
               std::any_of(c.legs.begin(), c.legs.end(), [](const PlacedLeg& l) { return !l.misfit.isZero(0); });
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.preload; }) found = found || preloaded(part);
  });
  return found;
}

bool has_friction(const Configuration& c) {
  bool found = false;
  for_each_law(c, [&](const Law& law) { found = found || std::holds_alternative<FrictionLaw>(law); });
  return found;
}

}  // namespace

double bound_with(double least, double rounding) {
  constexpr double roundings = 100;
  return std::max(least, roundings * rounding);
}

double rounding_of(const Answer& answer, double length) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon(), most = 1e-7;
  Vector6 inverse = Vector6::Ones();
  inverse.tail<3>().setConstant(1 / length);
  const Matrix6 weighed = inverse.asDiagonal() * answer.stiffness * inverse.asDiagonal();
  const Vector6 all = Eigen::SelfAdjointEigenSolver<Matrix6>(weighed, Eigen::EigenvaluesOnly).eigenvalues();
  const double lost = epsilon * all(5);  // in the rounding of the largest
  if (!(lost > 0)) return 0;
  Eigen::Index softest = answer.rigid;
  while (!answer.floating.loose.empty() && softest < 5 && all(softest) < lost) ++softest;
  return std::min(0.1 * lost / std::max(all(std::min<Eigen::Index>(softest, 5)), lost), most);
}

AnalyticAtPose::AnalyticAtPose(const Configuration& c, std::string where)
    : model_(c), where_(std::move(where)), length_(c.size), strained_(strained_at_rest(c)), slides_(has_friction(c)) {
  weight_ << c.weight, Vector3::Zero();
  const bool fits = std::all_of(c.legs.begin(), c.legs.end(), [](const PlacedLeg& l) { return l.misfit.isZero(0); });
  if (!fits) energy_at_rest_ = total(model_.energies(model_.assembled()));
}

Answer AnalyticAtPose::solve(const Vector6& F, const Conditions& conditions) const {
  const analytic::AnalyticSolution s = model_.solve(F, conditions);
  if (!s.converged && s.message.empty()) (void)model_.stiffness(s);  // throws where nothing yields
  if (!s.converged)
    throw NumericalError(s.message.empty()
                             ? fmt::format("{}: the analytic theory did not converge in {} steps (misfit {:.3g})",
                                           where_, s.iterations, s.misfit)
                             : fmt::format("{}: the analytic theory: {}", where_, s.message));
  Vector6 carried = Vector6::Zero();
  for (const Vector6& wrench : s.leg_wrenches) carried += wrench;
  if (s.deformed) {
    Answer answer;
    answer.displacement = s.displacement;
    answer.stiffness = model_.stiffness(s);
    answer.energies = model_.energies(s);
    answer.slips = s.slips;
    answer.discretisation = s.discretisation;
    return deformed_answer(std::move(answer), F + weight_, -carried.head<3>(), "analytic", where_);
  }
  std::vector<LegStiffness> legs;
  for (std::size_t i = 0; i < model_.chains().size(); ++i)
    legs.push_back({model_.chains()[i].name, model_.leg_stiffness(i, s), model_.chains()[i].J_q});
  const analytic::Resistance r = model_.resistance(s);
  if (r.rigid.cols() == 6) (void)model_.stiffness(s);  // throws: nothing yields at all
  Answer answer{s.displacement, r.K, model_.energies(s), check_stiffness(r.K, legs), s.slips};
  answer.floating = {s.loose, s.least, s.most};
  answer.rigid = static_cast<int>(r.rigid.cols());
  if (answer.rigid > 0) answer.rigid_motions = analytic::motions_resisted_by(r.rigid, length_);
  enforce(answer.checks.failure, "analytic stiffness", where_);
  const std::string failure =
      response_failure({F + weight_, s.displacement, -carried, total(answer.energies) - energy_at_rest_,
                        model_.linear(), from_rest(conditions), strained_, slides_, answer.rigid > 0},
                       bound_with(checked_to, rounding_of(answer, length_)));
  // Beside rigid motions what yields little may have no digits: the rigid ones are the cause to tell.
  if (!failure.empty() && answer.rigid > 0) (void)model_.stiffness(s);
  enforce(failure, "analytic response", where_);
  return answer;
}

MsaAtPose::MsaAtPose(const Configuration& c, const frame::MemberDivision& division, std::string where)
    : p_WB_(c.base.p_W),
      p_WT_(c.pose.p_WT),
      configuration_(c),
      division_(division),
      model_(std::make_unique<frame::MsaModel>(c, division)),
      where_(std::move(where)) {
  for (std::size_t i = 0; i < c.legs.size(); ++i) {
    passive_twists_.push_back(model_->passive_twists(i));
    legs_.push_back(c.legs[i].name);
  }
}

void MsaAtPose::halve() {
  division_ = frame::halved(configuration_, division_);
  before_ = std::move(model_);
  model_ = std::make_unique<frame::MsaModel>(configuration_, division_);
  has_stiffness_ = false;
  ++halvings_;
}

/// last_ again by smaller elements where its own leave too much.
void MsaAtPose::refine(const Vector6& F, const Conditions& conditions) {
  constexpr int most = 3;
  const auto norms = [](const Vector6& d) { return Eigen::Vector2d(d.head<3>().norm(), d.tail<3>().norm()); };
  const Eigen::Array2d weights(1, configuration_.size);
  const auto relative = [&] {
    const double size = (weights * norms(last_.displacement).array()).maxCoeff();
    return size > 0 ? (weights * discretisation_.array()).maxCoeff() / size : 0;
  };
  const frame::LeftOut known = last_.state.geometric->left_out;
  discretisation_ = known.relative * norms(last_.displacement);
  discretisation_ += known.twist * Eigen::Vector2d(configuration_.size, 1);
  if (!last_.state.converged || relative() <= small_error) return;
  frame::MsaSolution coarse = before_ ? before_->solve(F, conditions) : last_;
  if (!before_) {
    halve();
    last_ = model_->solve(F, conditions);
  }
  for (;;) {
    if (!coarse.state.converged || !last_.state.converged) return;
    discretisation_ = norms(last_.displacement - coarse.displacement) / 3;
    const double left = relative();
    if (left <= small_error) return;
    if (halvings_ == most && left > 1e-4)
      throw NumericalError(
          fmt::format("{}: the MSA: members bend so far that its elements leave an error of {:.1e}", where_, left));
    if (halvings_ == most) return;
    coarse = std::move(last_);
    halve();
    last_ = model_->solve(F, conditions);
  }
}

Answer MsaAtPose::solve(const Vector6& F, const Conditions& conditions) {
  last_ = model_->solve(F, conditions);
  if (last_.state.geometric && conditions.geometry == Geometry::finite) refine(F, conditions);
  if (!last_.state.converged && last_.state.geometric)
    throw NumericalError(fmt::format("{}: the MSA: {}", where_, last_.state.geometric->message));
  if (!last_.state.converged)
    throw NumericalError(fmt::format("{}: the MSA did not converge in {} steps (residual {:.3g}){}", where_,
                                     last_.state.iterations, last_.state.residual, because(last_.state.message)));
  if (last_.state.geometric) {
    Answer answer;
    answer.displacement = last_.displacement;
    answer.stiffness = model_->stiffness(last_.state).K;
    answer.energies = last_.energies;
    answer.slips = last_.slips;
    answer.discretisation = discretisation_;
    const Vector3 reaction = model_->base_reaction(last_.load, last_.state).head<3>();
    return deformed_answer(std::move(answer), last_.load, reaction, "MSA", where_);
  }
  if (!has_stiffness_ || tangents_ != last_.state.spring_tangents) {
    const frame::MsaModel::Stiffness stiffness = model_->stiffness(last_.state);
    std::vector<LegStiffness> legs;
    for (std::size_t i = 0; i < legs_.size(); ++i) legs.push_back({legs_[i], stiffness.legs[i], passive_twists_[i]});
    checks_ = check_stiffness(stiffness.K, legs, bound_with(checked_to, model_->rounding()));
    enforce(checks_.failure, "MSA stiffness", where_);
    stiffness_ = stiffness.K;
    rigid_ = 6 - static_cast<int>(stiffness.motions.cols());
    tangents_ = last_.state.spring_tangents;
    has_stiffness_ = true;
  }
  // The reaction acts at the base origin; about T its moment changes by the arm.
  const Vector6 reaction = shift_twist(p_WB_ - p_WT_).transpose() * model_->base_reaction(last_.load, last_.state);
  enforce(response_failure(
              {last_.load, last_.displacement, reaction, total(last_.energies), model_->linear(), from_rest(conditions),
               strained_at_rest(configuration_), has_friction(configuration_), rigid_ > 0},
              bound_with(checked_to, model_->rounding())),
          "MSA response", where_);
  Answer answer{last_.displacement, stiffness_, last_.energies, checks_, last_.slips};
  answer.rigid = rigid_;
  answer.floating = {last_.state.loose, Vector6::Zero(), Vector6::Zero()};
  if (!last_.state.loose.empty()) answer.floating.least = last_.state.least, answer.floating.most = last_.state.most;
  return answer;
}

}  // namespace deflect
