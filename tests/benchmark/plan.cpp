#include "tests/benchmark/plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "msa/base/error.h"
#include "msa/mechanism/configuration.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::benchmark {
namespace {

using namespace compare;
using namespace diagnosis;
using namespace effects;
using namespace measurement;
using namespace parallel;
using namespace prediction;
using namespace theories;

constexpr int elements = 2;  // per member

/// The first three loads of each pose of a random plan, halved moments about x, y, z added by turns; at 23 °C.
Measurements new_poses(const Mechanism& m, std::uint64_t seed) {
  const Measurements many = campaign("random", m, force, seed);
  Measurements out;
  out.origin = "new poses";
  out.temperature_recorded = true;
  for (const PoseGroup& group : many.poses) {
    out.poses.push_back(group);
    out.poses.back().readings.clear();
    for (std::size_t i = 0; i < 3; ++i) {
      Reading r = many.readings[group.readings[i]];
      r.pose = out.poses.size() - 1;
      r.sequence = static_cast<double>(out.readings.size());
      r.temperature_C = 23;
      out.poses.back().readings.push_back(out.readings.size());
      out.readings.push_back(r);
    }
  }
  return out;
}

VectorX translations(const std::vector<VectorX>& all) {
  VectorX out(3 * static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) out.segment<3>(3 * static_cast<Eigen::Index>(i)) = all[i].head<3>();
  return out;
}

VectorX predicted_elsewhere(const Plan& plan, const Mechanism& m, const Theory& theory, Geometry geometry) {
  PredictionOptions o;
  o.theory = &theory;
  o.geometry = geometry;
  o.division = plan.simulation.division;
  return translations(predict(m, configure_all(m, plan.elsewhere), plan.elsewhere, o, alone));
}

/// Sets of values at which the effect's parameters act one at a time; at the start together where one shapes others.
std::vector<VectorX> one_at_a_time(const Effect& e) {
  const VectorX start = start_values(e);
  for (const EffectParameter& p : e.parameters)
    if (!p.vanishes) return {start};
  if (e.parameters.empty()) return {start};
  std::vector<VectorX> out;
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    VectorX values = start;
    for (Eigen::Index k = 0; k < start.size(); ++k)
      if (k != i) values(k) = *e.parameters[static_cast<std::size_t>(k)].vanishes;
    out.push_back(values);
  }
  return out;
}

VectorX numbers_of(const Measurements& data) {
  const std::vector<MeasuredValue> values = measured_values(data);
  VectorX out(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) out(static_cast<Eigen::Index>(i)) = values[i].value;
  return out;
}

}  // namespace

Measurements simulated(const subject::Subject& s, const Measurements& plan, const SimulationOptions& o) {
  if (!s.machine()) return subject::simulate_frame(*s.frame(), plan, o);
  Measurements out = simulate(*s.machine(), plan, o, alone);
  const bool record = !measured_values(plan).empty();
  for (std::size_t i = 0; record && i < out.readings.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k)
      if (!plan.readings[i].displacement[k]) out.readings[i].displacement[k].reset();
  return out;
}

Plan::Plan(const subject::Subject& s, const std::vector<Effect>& effects, const std::string& name, std::uint64_t seed,
           const PlanOptions& o) {
  simulation.seed = seed;
  simulation.sigma_u = o.sigma;
  if (o.temperature) simulation.temperature = 22, simulation.swing = 2;
  const Mechanism* m = s.machine();
  if (m) simulation.division = frame::equal_division(configure(*m, home_pose(*m)), elements);
  if (o.record) {
    readings = *o.record;
    simulation.sigma_th = readings.readings.front().sigma_th;
  } else {
    readings = m ? campaign(name, *m, force, seed) : subject::frame_campaign(name, *s.frame(), seed);
  }
  healthy = simulated(s, readings, simulation);
  observations = std::make_unique<Observations>(s, healthy, ComparisonOptions(), alone);
  at_places = std::make_unique<const SignaturesAtPlaces>(*observations, effects, 1);
  signatures = at_places->all();
  const VectorX rest = observations->residual(s);
  nominal = numbers_of(healthy) - rest;
  if (!m || o.record) return;
  elsewhere = new_poses(*m, seed + 1);
  nominal_elsewhere = predict_elsewhere(*this, *m, theory("analytic"));
  if (!o.changes) return;
  const VectorX linear = predicted_elsewhere(*this, *m, theory("analytic"), Geometry::linear);
  for (const Signature& each : signatures) {
    const std::vector<VectorX> values = one_at_a_time(*each.effect.effect);
    const auto columns = static_cast<Eigen::Index>(values.size());
    Change c{each.effect, MatrixX(rest.size(), columns), MatrixX(linear.size(), columns)};
    for (Eigen::Index i = 0; i < columns; ++i) {
      const Mechanism with = with_effect(*m, *each.effect.effect, values[static_cast<std::size_t>(i)], each.effect.leg);
      c.measured.col(i) = rest - observations->residual(with);
      c.elsewhere.col(i) = predicted_elsewhere(*this, with, theory("analytic"), Geometry::linear) - linear;
    }
    changes.push_back(std::move(c));
  }
}

VectorX Plan::residual(const Measurements& data) const { return numbers_of(data) - nominal; }

VectorX Plan::whitened_change(const EffectInstance& e) const {
  return observations->null_residual() - observations->whitened_residual(with_effect(observations->subject(), e));
}

Plan::Told Plan::told(const EffectInstance& e) const {
  Told out{signatures, whitened_change(e)};
  const subject::Subject with = with_effect(observations->subject(), e);
  PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const prediction::Floating floating = with.stand(healthy)->predicted(healthy, linear).floating;
  std::vector<bool> open;
  for (std::size_t i = 0; i < healthy.readings.size(); ++i) open.push_back(floating.at(i));
  if (std::find(open.begin(), open.end(), true) == open.end()) return out;
  const Observations others = observations->keeping(open);
  SignaturesAtPlaces of_others = *at_places;
  of_others.weigh_for(others, 1);
  out.signatures = of_others.all();
  out.change = others.null_residual() - others.whitened_residual(with);
  return out;
}

VectorX predict_elsewhere(const Plan& plan, const Mechanism& m, const Theory& theory) {
  return predicted_elsewhere(plan, m, theory, Geometry::finite);
}

Plans::Plans(const Mechanism& m, const std::vector<Effect>& effects, std::uint64_t seed)
    : device_(m), effects_(effects), seed_(seed), slots_(std::size(campaign_names) * variants) {}

const Plan& Plans::at(const std::string& campaign, int variant) {
  std::size_t at = 0;
  while (campaign != campaign_names[at]) ++at;
  Slot& slot = slots_[at * variants + static_cast<std::size_t>(variant)];
  std::call_once(slot.once, [&] {
    slot.plan = std::make_unique<Plan>(device_, effects_, campaign, seed_ + 1000 * (at + 1) + 10 * variant,
                                       PlanOptions{sigma_u, nullptr, variant % 2 == 1, true});
  });
  return *slot.plan;
}

}  // namespace deflect::benchmark
