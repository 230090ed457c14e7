#include "validation/prediction/prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/measurement/in_order.h"
#include "validation/parallel/cases.h"
#include "validation/prediction/instruments.h"

namespace deflect::prediction {
namespace {

/// 0 … N − 1 by reading, in the order in which they were taken.
std::vector<double> ranks(const measurement::Measurements& m, const std::string& purpose) {
  std::vector<double> rank(m.readings.size());
  const std::vector<std::size_t> order = measurement::in_sequence(m, purpose);
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<double>(i);
  return rank;
}

/// The poses in the order of their first readings in time. Where a pose is come back to, its readings are one approach.
std::vector<std::size_t> poses_in_sequence(const measurement::Measurements& m) {
  std::vector<std::size_t> order(m.poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto begun = [&](std::size_t p) { return *m.readings[measurement::in_order(m.poses[p], m).front()].sequence; };
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
    for (std::size_t i = 0; i < forces_.size(); ++i) forces_[i] *= laws_[i].kept;
    if (std::all_of(forces_.begin(), forces_.end(), [](double f) { return f == 0; })) return;
    Configuration bare = c;
    std::erase_if(bare.legs, [](const PlacedLeg& leg) { return leg.beside; });
    Vector6 F = Vector6::Zero();
    for (std::size_t i = 0; i < s_.size(); ++i) F -= forces_[i] * s_[i];
    const Vector6 d = o.theory->at(bare, {"", o.division})->predict(F, {}).displacement;
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
      for (const Law& law : nth(joint.laws, i))
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

/// What needs the order of the readings: "" for nothing.
const char* remembering(const Configuration& c) {
  const char* what = "";
  for_each_law(c, [&](const Law& law) {
    if (remembers(law) && !*what) what = "a table with 'unloading'";
    if (row_of(law).has_history) what = "friction";
  });
  return what;
}

/// Whether all that has a history are frictions that stand beside legs.
bool only_beside_legs(Configuration c) {
  bool tables = false;
  for_each_law(c, [&](const Law& law) { tables = tables || remembers(law); });
  if (tables || number_slips(c) == 0) return false;
  std::erase_if(c.legs, [](const PlacedLeg& leg) { return leg.beside; });
  return number_slips(c) == 0;
}

/// The share of the largest load that a machine had carried before the first reading of a pose: what its frictions
/// say. 0: they are relaxed.
double carried_before(const Configuration& c) {
  double share = 0;
  for_each_law(c, [&](const Law& law) {
    if (const auto* friction = std::get_if<FrictionLaw>(&law); friction && friction->start != 0)
      share = friction->start;
  });
  return share;
}

/// The largest load of a pose (its six numbers in N and Nm together), as true load.
Vector6 largest_load(const measurement::PoseGroup& pose, const measurement::Measurements& data,
                     const TrueLoads& loads) {
  std::size_t largest = pose.readings.front();
  for (const std::size_t i : pose.readings)
    if (data.readings[i].load.norm() > data.readings[largest].load.norm()) largest = i;
  return loads.at_T(data.readings[largest]);
}

/// A load that came and went: the slips that it leaves, and what these alone leave of displacements and of what is read
/// inside.
Motion after(const Vector6& F, theories::TheoryAt& machine, Conditions& conditions) {
  const theories::Prediction relaxed = machine.predict(Vector6::Zero(), conditions);  // weight's
  conditions.slips = machine.predict(F, conditions).slips;
  theories::Prediction rest = machine.predict(Vector6::Zero(), conditions);
  conditions.slips = rest.slips;
  Motion out;
  out.tool = out.platform = rest.displacement - relaxed.displacement;
  for (std::size_t k = 0; k < rest.inside.size() && k < relaxed.inside.size(); ++k)
    out.inside.emplace_back(rest.inside[k] - relaxed.inside[k]);
  return out;
}

Motion without(const Motion& r, const Motion& unloaded) {
  Motion out{r.tool - unloaded.tool, r.platform - unloaded.platform};
  out.inside = r.inside;
  for (std::size_t k = 0; k < unloaded.inside.size(); ++k) out.inside[k] -= unloaded.inside[k];
  return out;
}

/// Tells the theory where it will be asked many times.
void expect(theories::TheoryAt& machine, const measurement::PoseGroup& pose, const measurement::Measurements& data) {
  if (pose.readings.size() <= 8) return;
  machine.expect_many(std::any_of(pose.readings.begin(), pose.readings.end(),
                                  [&](std::size_t i) { return data.readings[i].temperature_C != 20; }));
}

/// What the sensor's drift adds to readings in their sequence.
void add_drift(std::vector<VectorX>& readings, const Sensor& sensor, const measurement::Measurements& data) {
  const std::vector<double> rank = ranks(data, "drift");
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i].head<3>() += sensor.drift * (rank[i] / static_cast<double>(readings.size()));
}

/// One pose after the other in time, or all side by side.
void at_every_pose(const measurement::Measurements& data, bool in_time, const parallel::Work& work,
                   const std::function<void(std::size_t)>& at_pose) {
  const auto told = [&](std::size_t done) {
    work.progress(static_cast<double>(done) / static_cast<double>(data.poses.size()));
  };
  if (in_time) {
    std::size_t done = 0;
    for (const std::size_t p : poses_in_sequence(data)) {
      at_pose(p);
      if (work.progress) told(++done);
    }
    return;
  }
  parallel::for_each_case(data.poses.size(), 1, work.threads, at_pose,
                          work.progress ? std::function<void(std::size_t)>(told) : nullptr);
}

Floating somewhere(Floating open) {
  const bool nowhere = std::all_of(open.at_readings.begin(), open.at_readings.end(),
                                   [](const std::set<std::string>& laws) { return laws.empty(); });
  return nowhere ? Floating() : open;
}

void require_equilibrium(const Motion& r, const theories::Theory& theory, const measurement::Measurements& data,
                         const measurement::Reading& reading) {
  if (r.converged) return;
  throw NumericalError(fmt::format("{}:{}: {} finds no equilibrium under this load{}{}", data.origin, reading.line,
                                   theory.spoken, r.reason.empty() ? "" : ": ", r.reason));
}

}  // namespace

Predicted predicted(const Mechanism& m, const std::vector<Configuration>& machines,
                    const measurement::Measurements& data, const PredictionOptions& o, const parallel::Work& work) {
  std::vector<VectorX> out(data.readings.size(), VectorX::Zero(6 + std::ssize(data.instruments.sensors)));
  Floating open{std::vector<std::set<std::string>>(data.readings.size())};
  const Instruments instruments(m, data);
  const std::string history = machines.empty() ? "" : remembering(machines.front());
  const bool beside = !machines.empty() && only_beside_legs(machines.front());
  if (!history.empty()) measurement::in_sequence(data, history);
  const double before = machines.empty() ? 0 : carried_before(machines.front());
  Carried carried;
  const auto passed_over = [&](std::size_t i) { return history.empty() && !o.only.empty() && !o.only[i]; };
  const auto at_pose = [&](std::size_t p) {
    const std::vector<std::size_t>& here = data.poses[p].readings;
    if (std::all_of(here.begin(), here.end(), passed_over)) return;
    theories::TheoryOptions options{m.name, o.division};
    options.apart = o.apart;
    const TrueLoads loads(m.load_cell, machines[p].pose.R_WT, instruments.load_points());
    const RecordedMotion sensor(m.sensor, machines[p].pose.R_WT);
    LoadedMachine machine(*o.theory, options, machines[p], instruments, loads);
    Conditions conditions(o.geometry.value_or(m.geometry));
    if (conditions.geometry == Geometry::linear) expect(machine.theory(), data.poses[p], data);
    Motion unloaded;
    if (before != 0 && !beside)
      unloaded = after(before * largest_load(data.poses[p], data, loads), machine.theory(), conditions);
    if (beside) {
      carried.enter(machines[p], o);
      conditions.slips = carried.slips();
    }
    // Without history the same load at the same temperature has the same answer.
    const bool remember = history.empty() && !machine.theory().affine() && machine.by_load_at_T(conditions.geometry);
    std::map<std::array<double, 7>, Motion> known;
    Motion last;
    const auto answer = [&](const measurement::Reading& reading) -> const Motion& {
      conditions.warmer = reading.temperature_C - 20;
      if (!remember) return last = machine.move(reading, conditions);
      std::array<double, 7> key;
      std::copy(reading.load.begin(), reading.load.end(), key.begin());
      key[6] = conditions.warmer;
      const auto [found, is_new] = known.try_emplace(key);
      if (is_new) found->second = machine.move(reading, conditions);
      return found->second;
    };
    for (const std::size_t i : measurement::in_order(data.poses[p], data)) {
      if (passed_over(i)) continue;
      const measurement::Reading& reading = data.readings[i];
      const Motion& r = answer(reading);
      require_equilibrium(r, *o.theory, data, reading);
      if (beside) carried.leave_with(r.platform, r.slips);
      conditions.slips = r.slips;
      open.at_readings[i].insert(r.floating.begin(), r.floating.end());
      const Motion seen = without(r, unloaded);
      out[i] << m.sensor.zero + sensor.of(seen.tool, conditions.geometry),
          instruments.readings(machines[p], seen, conditions.geometry);
    }
  };
  at_every_pose(data, beside, work, at_pose);
  if (!m.sensor.drift.isZero(0)) add_drift(out, m.sensor, data);
  return {std::move(out), somewhere(std::move(open))};
}

std::vector<VectorX> predict(const Mechanism& m, const std::vector<Configuration>& machines,
                             const measurement::Measurements& data, const PredictionOptions& o,
                             const parallel::Work& work) {
  return predicted(m, machines, data, o, work).readings;
}

}  // namespace deflect::prediction
