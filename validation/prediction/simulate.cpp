#include "validation/prediction/simulate.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/tolerances.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/random.h"
#include "validation/prediction/as_built.h"
#include "validation/prediction/prediction.h"

namespace deflect::prediction {
namespace {

AsBuilt draw(const Mechanism& m, double scale, measurement::Random& random) {
  const Tolerances t = named_tolerances(m);
  AsBuilt built;
  built.modulus = scale * t.modulus * random.normal();
  for (int leg = 0; leg < leg_count(m); ++leg) {
    LegAsBuilt l;
    l.base_joint = scale * t.joint_position * random.normal3();
    l.platform_joint = scale * t.joint_position * random.normal3();
    l.link_length = scale * t.link_length * random.normal();
    l.guide_diameter = scale * t.guide_diameter * random.normal();
    built.legs.push_back(l);
  }
  return built;
}

/// The description with the numbers off that have tolerances of their own.
Mechanism draw_numbers(const Mechanism& m, double scale, measurement::Random& random) {
  if (m.tolerances.numbers.empty()) return m;
  Mechanism out = resolved(m);
  const std::vector<NumberMove> all = number_moves(out);
  for (const NumberMove& move : all) out = moved(out, move, scale * random.normal());
  return out;
}

/// Repeatability is a length: of slides.
VectorX draw_errors(const std::vector<Actuator>& actuators, double sigma, measurement::Random& random) {
  VectorX errors = VectorX::Zero(std::ssize(actuators));
  for (std::size_t i = 0; i < actuators.size(); ++i)
    if (!actuators[i].rotation) errors(as_index(i)) = sigma * random.normal();
  return errors;
}

/// Each load off by its own factor.
measurement::Measurements with_true_loads(const Mechanism& m, measurement::Measurements plan, double tolerance,
                                          measurement::Random& random) {
  for (measurement::Reading& r : plan.readings)
    measurement::scale_loads(r, [&] { return 1 + tolerance * random.normal(); });
  return measurement::place_loads(std::move(plan), m);
}

/// To a digit that an instrument of this noise would show, as a decimal number in mm or rad.
double rounded(double value, double sigma, double per_SI) {
  const double digits = std::pow(10, std::ceil(-std::log10(sigma * per_SI / 1e3)));
  return (std::round(value * per_SI * digits) / digits + 0.0) / per_SI;
}

}  // namespace

measurement::Measurements simulate(const Mechanism& m, measurement::Measurements plan, const SimulationOptions& o,
                                   const parallel::Work& work) {
  measurement::Random random(o.seed), of_machine(o.machine.value_or(o.seed));
  measurement::Random& building = o.machine ? of_machine : random;
  const AsBuilt built = draw(m, o.tolerances, building);
  Mechanism geometry = o.tolerances > 0 ? with_geometry(draw_numbers(m, o.tolerances, building), built) : m;
  for (auto& [name, sensor] : geometry.sensors)
    if (sensor.gain_sigma > 0) sensor.gain += o.tolerances * sensor.gain_sigma * building.normal();
  std::vector<Configuration> machines = measurement::configure_all(m, plan);
  for (Configuration& machine : machines) {
    const VectorX errors = draw_errors(machine.actuators, o.tolerances * m.tolerances.actuator_repeatability, random);
    if (o.tolerances > 0) machine = configure_as_built(geometry, built, machine, errors);
  }

  plan.instruments.sensors = measurement::instruments_of(m).sensors;
  for (measurement::Reading& r : plan.readings) r.sensors.clear();  // a plan has empty cells
  const std::vector<measurement::SensorChannel>& sensors = plan.instruments.sensors;
  const auto n = static_cast<double>(plan.readings.size());
  if (o.swing != 0 || o.temperature != 20) {
    plan.temperature_recorded = true;
    for (std::size_t i = 0; i < plan.readings.size(); ++i)
      plan.readings[i].temperature_C =
          std::round(1e3 * (o.temperature + o.swing * std::sin(2 * pi * static_cast<double>(i) / n))) / 1e3;
  }
  const measurement::Measurements loaded = with_true_loads(m, plan, o.tolerances * m.tolerances.load, random);

  PredictionOptions p;
  p.theory = &theories::theory("msa");
  p.geometry = o.geometry;
  p.division = o.division;
  const std::vector<VectorX> exact = predict(geometry, machines, loaded, p, work);

  // Sensors whose noise the description gives need no σ in the file.
  const bool all_told = !sensors.empty() &&
                        std::all_of(sensors.begin(), sensors.end(), [](const auto& s) { return s.sigma.has_value(); });
  for (std::size_t i = 0; i < plan.readings.size(); ++i) {
    measurement::Reading& r = plan.readings[i];
    const bool gross = o.outliers > 0 && random.uniform(0, 1) < o.outliers;
    const auto read = [&](double value, double sigma, measurement::Quantity quantity) {
      value += sigma * o.noise(random);
      if (gross) value += (random.uniform(0, 1) < 0.5 ? -1 : 1) * random.uniform(10, 30) * sigma;
      return sigma > 0 ? rounded(value, sigma, measurement::row_of(quantity).per_SI) : value;
    };
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      const measurement::Quantity reads = sensors[k].quantity;
      const double otherwise = reads == measurement::Quantity::length  ? o.sigma_u
                               : reads == measurement::Quantity::angle ? o.sigma_th.value_or(0)
                                                                       : 0;
      r.sensors.push_back(read(exact[i](as_index(6 + k)), sensors[k].sigma.value_or(otherwise), reads));
    }
    for (Eigen::Index k = 0; k < 6 && sensors.empty(); ++k)
      if (k < 3 || o.sigma_th)
        nth(r.displacement, k) =
            read(exact[i](k), k < 3 ? o.sigma_u : *o.sigma_th, measurement::displacement_quantity(as_size(k)));
    if (o.sigma_u > 0 && !all_told) r.sigma_u = o.sigma_u;
    if (o.sigma_th && *o.sigma_th > 0 && !all_told) r.sigma_th = o.sigma_th;
  }
  return plan;
}

double share_carried(const Mechanism& m, const measurement::Measurements& plan, const SimulationOptions& o) {
  const std::vector<Configuration> machines = measurement::configure_all(m, plan);
  PredictionOptions p;
  p.theory = &theories::theory("msa");
  p.geometry = o.geometry;
  p.division = o.division;
  for (std::size_t pose = 0; pose < machines.size(); ++pose) {
    const auto carries = [&](double share) {
      measurement::Measurements some = measurement::one_pose(plan, pose);
      for (measurement::Reading& r : some.readings) scale_load(r, share);
      return bool(outcome_of<NumericalError>([&] { return predict(m, {machines[pose]}, some, p, parallel::alone); }));
    };
    if (carries(1)) continue;
    double low = 1e-6, high = 1;
    if (!carries(low)) return 0;
    while (high > 1.01 * low) {
      const double middle = std::sqrt(low * high);
      (carries(middle) ? low : high) = middle;
    }
    return low;
  }
  return 1;
}

}  // namespace deflect::prediction
