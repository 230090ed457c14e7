#include "validation/subject/simulate_frame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/frame_tolerances.h"
#include "validation/measurement/number_limits.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/subject/frame_readings.h"
#include "validation/subject/subject.h"

namespace deflect::subject {
namespace {

/// Rows of factors on the load cases.
class Plan {
 public:
  Plan(const frame::FrameDescription& f, bool sequence) : sequence_(sequence) {
    const measurement::Instruments all = Subject(f).instruments();
    m_.origin = "campaign";
    m_.instruments.sensors = all.sensors;
    m_.instruments.load_cases = all.load_cases;
    m_.instruments.stationary = true;
    m_.poses.push_back({"all", Vector6::Zero(), {}, {}});
  }

  std::size_t cases() const { return m_.instruments.load_cases.size(); }

  void add(const std::vector<std::pair<std::size_t, double>>& loads) {
    measurement::Reading r;
    r.factors.assign(cases(), 0);
    r.sensors.assign(m_.instruments.sensors.size(), std::nullopt);
    for (const auto& [k, factor] : loads) r.factors[k] = std::round((r.factors[k] + factor) * 100) / 100 + 0.0;
    r.line = m_.readings.size() + 2;
    if (sequence_) r.sequence = static_cast<double>(m_.readings.size() + 1);
    m_.poses.front().readings.push_back(m_.readings.size());
    m_.readings.push_back(std::move(r));
  }

  measurement::Measurements done() && { return std::move(m_); }

 private:
  bool sequence_;
  measurement::Measurements m_;
};

void add_rich(Plan& plan) {
  for (int twice = 0; twice < 2; ++twice)
    for (std::size_t k = 0; k < plan.cases(); ++k) {
      for (const double factor : {1.0, -1.0, 0.5, -0.5, 0.25, -0.25}) plan.add({{k, factor}});
      for (std::size_t other = 0; other < k; ++other)
        for (const double sense : {1.0, -1.0}) plan.add({{k, 1}, {other, sense}});
    }
}

void add_random(Plan& plan, std::uint64_t seed) {
  measurement::Random random(seed);
  const auto any = [&] {
    const double at = random.uniform(0, static_cast<double>(plan.cases()));
    return std::min(plan.cases() - 1, as_size(std::lround(std::floor(at))));
  };
  for (int i = 0; i < 200; ++i) {
    std::vector<std::pair<std::size_t, double>> loads;
    for (int k = 0; k < 2 + i % 2; ++k) {
      const std::size_t which = any();  // in this order
      loads.emplace_back(which, std::round(random.uniform(-1, 1) * 100) / 100);
    }
    plan.add(loads);
  }
}

/// To a digit that an instrument of this noise would show, in the unit of its column.
double rounded(double value, double sigma, double per_SI) {
  const double digits = std::pow(10, std::ceil(-std::log10(sigma * per_SI / 1e3)));
  return (std::round(value * per_SI * digits) / digits + 0.0) / per_SI;
}

/// A thousandth of the largest reading, rounded up to one digit.
double usual_noise(const std::vector<VectorX>& exact, Eigen::Index channel) {
  double most = 0;
  for (const VectorX& each : exact) most = std::max(most, std::abs(each(channel)));
  if (most == 0) return 0;
  const double decade = std::pow(10, std::floor(std::log10(most / 1e3)));
  return std::ceil(most / 1e3 / decade) * decade;
}

}  // namespace

measurement::Measurements frame_campaign(const std::string& name, const frame::FrameDescription& f,
                                         std::uint64_t seed) {
  Plan plan(f, name == "cycle");
  if (name == "paper") {
    for (std::size_t k = 0; k < plan.cases(); ++k) plan.add({{k, 1}});
  } else if (name == "cycle") {
    for (std::size_t k = 0; k < plan.cases(); ++k)
      for (const double factor :
           {0.0, 0.25, 0.5, 0.75, 1.0, 0.75, 0.5, 0.25, 0.0, -0.25, -0.5, -0.75, -1.0, -0.75, -0.5, -0.25, 0.0})
        plan.add({{k, factor}});
  } else if (name == "rich") {
    add_rich(plan);
  } else if (name == "random") {
    add_random(plan, seed);
  } else {
    throw InputError(fmt::format("campaign '{}': name one of {}, or a measurement file", name,
                                 fmt::join(prediction::campaign_names, ", ")));
  }
  return std::move(plan).done();
}

measurement::Measurements simulate_frame(const frame::FrameDescription& f, measurement::Measurements plan,
                                         const prediction::SimulationOptions& o) {
  if (f.sensors.empty())
    throw InputError(
        fmt::format("{}: the frame has no sensors to simulate: describe them, as in 'sensors: {{lvdt: {{node: B, "
                    "direction: uz}}}}'",
                    f.name));
  measurement::Random random(o.seed), of_frame(o.machine.value_or(o.seed));
  measurement::Random& building = o.machine ? of_frame : random;
  frame::FrameDescription built = f;
  for (const NumberMove& move : frame::number_moves(f))
    built = frame::moved(built, move, o.tolerances * building.normal());
  for (auto& [name, sensor] : built.sensors)
    if (sensor.gain_sigma > 0) sensor.gain += o.tolerances * sensor.gain_sigma * building.normal();

  plan.instruments.sensors = Subject(f).instruments().sensors;
  for (measurement::Reading& r : plan.readings) r.sensors.clear();  // a plan has empty cells
  std::vector<measurement::SensorChannel>& sensors = plan.instruments.sensors;
  measurement::Measurements loaded = plan;
  for (measurement::Reading& r : loaded.readings)
    measurement::scale_loads(r, [&] { return 1 + o.tolerances * f.tolerances.load * random.normal(); });
  const std::vector<VectorX> exact = predicted_readings(built, loaded, f.geometry);

  std::vector<double> sigma, zero;
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    using measurement::Quantity;
    const double usual = usual_noise(exact, as_index(6 + k));
    double otherwise = usual;
    if (sensors[k].quantity == Quantity::length) otherwise = o.sigma_u;
    if (sensors[k].quantity == Quantity::angle && o.sigma_th) otherwise = *o.sigma_th;
    sigma.push_back(sensors[k].sigma.value_or(otherwise));
    zero.push_back(f.sensors[k].second.free_zero ? 1e3 * usual * random.normal() : 0);
  }
  // Rounding to a step of the instrument adds its own part of σ.
  const auto scatter = [&](std::size_t k) {
    return f.sensors[k].second.resolution > 0 ? f.sensors[k].second.sigma : sigma[k];
  };
  for (std::size_t i = 0; i < plan.readings.size(); ++i) {
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      if (sensors[k].sigma || sigma[k] <= measurement::least_sigma) continue;  // a file cannot tell it
      if (sensors[k].quantity == measurement::Quantity::length) plan.readings[i].sigma_u = sigma[k];
      if (sensors[k].quantity == measurement::Quantity::angle) plan.readings[i].sigma_th = sigma[k];
    }
    const bool gross = o.outliers > 0 && random.uniform(0, 1) < o.outliers;
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      double value = exact[i](as_index(6 + k)) + zero[k] + scatter(k) * o.noise(random);
      if (gross) value += (random.uniform(0, 1) < 0.5 ? -1 : 1) * random.uniform(10, 30) * sigma[k];
      const double step = f.sensors[k].second.resolution, per_SI = measurement::row_of(sensors[k].quantity).per_SI;
      if (step > 0)
        value = step * std::round(value / step);
      else if (sigma[k] > 0)
        value = rounded(value, sigma[k], per_SI);
      plan.readings[i].sensors.push_back(value);
    }
  }
  return plan;
}

}  // namespace deflect::subject
