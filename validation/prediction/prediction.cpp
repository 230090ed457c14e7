#include "validation/prediction/prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "analytic/model.h"
#include "analytic/pose_sweep.h"
#include "msa/base/error.h"
#include "msa/frame/mechanism/msa.h"
#include "validation/parallel/cases.h"

namespace deflect {
namespace {

/// One theory of one machine.
class Predictor {
 public:
  struct Response {
    Vector6 displacement;
    bool converged;
    std::vector<double> slips;
    std::string reason = "";  ///< where not converged, if it is known
  };

  /// The configuration must outlive it.
  Predictor(const Configuration& c, const PredictionOptions& o) : configuration_(&c) {
    if (o.theory != Theory::analytic)
      msa_.emplace(c, o.division);
    else if (analytic::PoseSweep sweep(c); sweep.applies())
      sweep_.emplace(std::move(sweep)).at(c);
  }

  /// Where answers are affine in load and, if it is asked for, temperature a few of them give all.
  void expect_many(bool warmer_or_colder) {
    if (msa_ || (sweep_ ? !sweep_->linear() : !model().linear() || model().jumps())) return;
    Affine affine;
    const auto at = [&](const Vector6& F, double warmer) {
      Conditions conditions;
      conditions.warmer = warmer;
      const Response r = solve(F, conditions);
      affine.converged = affine.converged && r.converged;
      return r.displacement;
    };
    affine.rest = at(Vector6::Zero(), 0);
    for (Eigen::Index i = 0; i < 6; ++i) affine.C.col(i) = at(Vector6::Unit(i), 0) - affine.rest;
    if (warmer_or_colder) affine.per_kelvin = at(Vector6::Zero(), 1) - affine.rest;
    affine_ = affine;
  }

  bool affine() const { return affine_.has_value(); }

  Response solve(const Vector6& F, const Conditions& conditions) {
    if (affine_ && conditions.geometry == Geometry::linear)
      return {affine_->rest + affine_->C * F + conditions.warmer * affine_->per_kelvin, affine_->converged, {}};
    if (sweep_ && conditions.geometry == Geometry::linear && sweep_->solve(F, conditions.warmer))
      return {sweep_->displacement(), true, {}};
    if (msa_) {
      const frame::MsaSolution s = msa_->solve(F, conditions);
      return {s.displacement, s.state.converged, s.slips, s.state.message};
    }
    const analytic::AnalyticSolution s = model().solve(F, conditions);
    return {s.displacement, s.converged, s.slips, s.message};
  }

 private:
  const analytic::AnalyticModel& model() {
    if (!analytic_) analytic_.emplace(*configuration_);
    return *analytic_;
  }

  const Configuration* configuration_;
  std::optional<analytic::PoseSweep> sweep_;
  std::optional<analytic::AnalyticModel> analytic_;  // where the sweep does not reach
  struct Affine {
    Vector6 rest, per_kelvin = Vector6::Zero();
    Matrix6 C;
    bool converged = true;
  };

  std::optional<frame::MsaModel> msa_;
  std::optional<Affine> affine_;
};

/// 0 … N − 1 by reading, in the order in which they were taken.
std::vector<double> ranks(const Measurements& m, const std::string& purpose) {
  std::vector<double> rank(m.readings.size());
  const std::vector<std::size_t> order = in_sequence(m, purpose);
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<double>(i);
  return rank;
}

/// The readings of a pose in the order in which they were taken.
std::vector<std::size_t> ordered(const PoseGroup& group, const Measurements& m) {
  std::vector<std::size_t> order = group.readings;
  if (m.readings[order.front()].sequence)
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return *m.readings[a].sequence < *m.readings[b].sequence; });
  return order;
}

/// The poses in the order of their first readings in time. Where a pose is come back to, its readings are one approach.
std::vector<std::size_t> poses_in_sequence(const Measurements& m) {
  std::vector<std::size_t> order(m.poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto begun = [&](std::size_t p) { return *m.readings[ordered(m.poses[p], m).front()].sequence; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return begun(a) < begun(b); });
  return order;
}

/// Frictions beside the legs, and what they carry from pose to pose. A friction lengthens by e = sᵀd, s the wrench at T
/// of a unit force in it, and carries k (e − slip).
class Carried {
 public:
  /// At another pose: the forces stay, and the machine without the frictions, which they load, says where that leaves
  /// their slips.
  void enter(const Configuration& c, const PredictionOptions& o) {
    s_.clear();
    laws_.clear();
    for (const PlacedLeg& leg : c.legs)
      if (leg.beside)
        for (const PlacedPart& part : leg.parts)
          if (const auto* joint = std::get_if<PlacedJoint>(&part)) add(*joint, c.pose.p_WT);
    slips_.clear();
    if (forces_.size() != laws_.size()) forces_.assign(laws_.size(), 0);
    if (std::all_of(forces_.begin(), forces_.end(), [](double f) { return f == 0; })) return;
    Configuration bare = c;
    std::erase_if(bare.legs, [](const PlacedLeg& leg) { return leg.beside; });
    Vector6 F = Vector6::Zero();
    for (std::size_t i = 0; i < s_.size(); ++i) F -= forces_[i] * s_[i];
    const Vector6 d = Predictor(bare, o).solve(F, {}).displacement;
    for (std::size_t i = 0; i < s_.size(); ++i) slips_.push_back(s_[i].dot(d) - forces_[i] / laws_[i].stiffness);
  }

  const std::vector<double>& slips() const { return slips_; }

  void leave_with(const Vector6& d, const std::vector<double>& slips) {
    for (std::size_t i = 0; i < forces_.size(); ++i)
      forces_[i] = std::clamp(laws_[i].stiffness * (s_[i].dot(d) - slips[i]), -laws_[i].force, laws_[i].force);
  }

 private:
  void add(const PlacedJoint& joint, const Vector3& p_WT) {
    for (Eigen::Index i = 0; i < 3; ++i)
      for (const Law& law : joint.laws[static_cast<std::size_t>(i)])
        if (const auto* friction = std::get_if<FrictionLaw>(&law)) {
          const Vector3 axis = joint.R_WJ.col(i);
          Vector6 s;
          s << axis, (joint.p_W - p_WT).cross(axis);
          s_.push_back(s);
          laws_.push_back(*friction);
        }
  }

  std::vector<Vector6> s_;
  std::vector<FrictionLaw> laws_;
  std::vector<double> forces_, slips_;
};

/// How many frictions there are, and whether all of them stand beside legs.
std::pair<int, bool> frictions_of(Configuration c) {
  const int all = number_slips(c);
  std::erase_if(c.legs, [](const PlacedLeg& leg) { return leg.beside; });
  return {all, all > 0 && number_slips(c) == 0};
}

}  // namespace

Vector6 true_load(const LoadCell& cell, const Vector6& recorded) {
  return cell.gain * (rotate_twist(rotation_from_vector(cell.rotation)) * recorded);
}

Vector6 recorded_displacement(const Sensor& sensor, const Vector6& d) {
  return rotate_twist(rotation_from_vector(sensor.rotation)) * d;
}

std::vector<Vector6> predict(const Mechanism& m, const std::vector<Configuration>& machines, const Measurements& data,
                             const PredictionOptions& o) {
  std::vector<Vector6> out(data.readings.size(), Vector6::Zero());
  const auto [frictions, beside] = machines.empty() ? std::pair{0, false} : frictions_of(machines.front());
  if (frictions > 0) in_sequence(data, "friction");
  Carried carried;
  const Matrix6 cell = m.load_cell.gain * rotate_twist(rotation_from_vector(m.load_cell.rotation)),
                sensor = rotate_twist(rotation_from_vector(m.sensor.rotation));
  const auto at_pose = [&](std::size_t p) {
    Predictor predictor(machines[p], o);
    Conditions conditions(o.geometry.value_or(m.geometry));
    const bool linear = conditions.geometry == Geometry::linear;
    if (const std::vector<std::size_t>& all = data.poses[p].readings; linear && all.size() > 8)
      predictor.expect_many(
          std::any_of(all.begin(), all.end(), [&](std::size_t i) { return data.readings[i].temperature_C != 20; }));
    if (beside) {
      carried.enter(machines[p], o);
      conditions.slips = carried.slips();
    }
    // Without history the same load at the same temperature has the same answer.
    std::map<std::array<double, 7>, Predictor::Response> known;
    Predictor::Response last;
    const auto answer = [&](const Reading& reading) -> const Predictor::Response& {
      conditions.warmer = reading.temperature_C - 20;
      const Vector6 F = cell * reading.load;
      if (frictions > 0 || predictor.affine()) return last = predictor.solve(F, conditions);
      std::array<double, 7> key;
      std::copy(F.begin(), F.end(), key.begin());
      key[6] = conditions.warmer;
      const auto [found, is_new] = known.try_emplace(key);
      if (is_new) found->second = predictor.solve(F, conditions);
      return found->second;
    };
    for (const std::size_t i : ordered(data.poses[p], data)) {
      const Reading& reading = data.readings[i];
      const Predictor::Response& r = answer(reading);
      if (!r.converged)
        throw NumericalError(fmt::format("{}:{}: {} finds no equilibrium under this load{}{}", data.origin,
                                         reading.line, o.theory == Theory::analytic ? "the analytic theory" : "the MSA",
                                         r.reason.empty() ? "" : ": ", r.reason));
      if (beside) carried.leave_with(r.displacement, r.slips);
      conditions.slips = r.slips;
      out[i] = sensor * r.displacement;
    }
  };
  const auto all = static_cast<double>(machines.size());
  if (beside) {
    double done = 0;
    for (const std::size_t p : poses_in_sequence(data)) {
      at_pose(p);
      if (o.progress) o.progress(++done / all);
    }
  } else {
    const auto told = [&](std::size_t done) { o.progress(static_cast<double>(done) / all); };
    for_each_case(machines.size(), 1, o.threads, at_pose,
                  o.progress ? std::function<void(std::size_t)>(told) : nullptr);
  }
  if (!m.sensor.drift.isZero(0)) {
    const std::vector<double> rank = ranks(data, "drift");
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i].head<3>() += m.sensor.drift * (rank[i] / static_cast<double>(out.size()));
  }
  return out;
}

}  // namespace deflect
