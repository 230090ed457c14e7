#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "analytic/model.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/tolerances.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/as_built.h"
#include "validation/prediction/instruments.h"
#include "validation/subject/machine_groups.h"
#include "validation/subject/machine_places.h"
#include "validation/subject/machine_sites.h"
#include "validation/subject/machine_transmissions.h"
#include "validation/subject/subject.h"

namespace deflect::subject {
namespace {

/// One tolerance, moved by its step: in every pose, or in one.
struct Move {
  Tolerance tolerance;
  prediction::AsBuilt built = {};
  std::size_t actuator = 0;        ///< of a pose
  Vector6 zero = Vector6::Zero();  ///< of the sensor
  struct OfSensor {                ///< a named one
    std::string name = {};
    double gain = 0, zero = 0;
  };
  OfSensor sensor = {};
  NumberMove number = {};  ///< of the resolved description, by a standard deviation
  double start = 0;        ///< of the frictions of a pose whose start nobody knows
};

bool starts_anyhow(const Law& law) {
  const auto* friction = std::get_if<FrictionLaw>(&law);
  return friction && friction->word == FrictionStart::unknown;
}

/// What frictions hold at the first reading of a pose, where nobody knows: a load that came and went, uniform from −1
/// to 1 times the largest of the pose.
std::vector<Move> unknown_starts(const std::vector<Configuration>& drawn, const measurement::Measurements& data) {
  std::vector<Move> out;
  for (std::size_t p = 0; p < drawn.size(); ++p) {
    bool any = false;
    for_each_law(drawn[p], [&](const Law& law) { any = any || starts_anyhow(law); });
    if (!any) continue;
    Move move{{fmt::format("pose {} start of friction", data.poses[p].label), 1 / std::sqrt(3), p}};
    move.start = move.tolerance.sigma;
    out.push_back(std::move(move));
  }
  return out;
}

std::vector<Move> shared_moves(const Mechanism& m) {
  const Tolerances t = named_tolerances(m);
  const auto legs = as_size(leg_count(m));
  std::vector<Move> moves;
  const auto add = [&](const std::string& name, double sigma, double step,
                       const std::function<double&(prediction::AsBuilt&)>& number) {
    if (!(sigma > 0)) return;
    Move move{{name, sigma}};
    move.tolerance.step = step;
    move.built.legs.resize(legs);
    number(move.built) = step * sigma;
    moves.push_back(std::move(move));
  };
  using prediction::AsBuilt;
  add("modulus", t.modulus, step_of(t.modulus), [](AsBuilt& b) -> double& { return b.modulus; });
  const bool seats = std::holds_alternative<SixPsu>(m.kinematics) || !m.mounts.empty();
  for (std::size_t i = 0; i < legs; ++i) {
    const std::string leg = fmt::format("leg {} ", i + 1);
    add(leg + "guide diameter", t.guide_diameter, step_of(t.guide_diameter),
        [i](AsBuilt& b) -> double& { return b.legs[i].guide_diameter; });
    if (!seats) continue;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      add(leg + "base joint " + "xyz"[axis], t.joint_position, 1,
          [&](AsBuilt& b) -> double& { return b.legs[i].base_joint(axis); });
      add(leg + "platform joint " + "xyz"[axis], t.joint_position, 1,
          [&](AsBuilt& b) -> double& { return b.legs[i].platform_joint(axis); });
    }
    if (std::holds_alternative<SixPsu>(m.kinematics))
      add(leg + "link length", t.link_length, 1, [i](AsBuilt& b) -> double& { return b.legs[i].link_length; });
  }
  return moves;
}

/// A zero that nobody knows, of each component that is measured: wide beside all that was read.
std::vector<Move> free_zeros(const measurement::Measurements& data) {
  static const char* names[] = {"ux", "uy", "uz", "thx", "thy", "thz"};
  std::vector<Move> out;
  for (std::size_t i = 0; i < 6; ++i) {
    double largest = 0;
    for (const measurement::Reading& r : data.readings)
      largest = std::max(largest, std::abs(r.displacement[i].value_or(0)));
    if (largest == 0) continue;
    Move move{{fmt::format("zero of {}", names[i]), 10 * largest, {}, true}};
    move.zero(as_index(i)) = move.tolerance.sigma;
    out.push_back(std::move(move));
  }
  return out;
}

/// Gains and zeros of the named sensors.
std::vector<Move> sensor_moves(const Mechanism& m, const measurement::Measurements& data) {
  std::vector<Move> out;
  for (std::size_t k = 0; k < data.instruments.sensors.size(); ++k)
    for (const auto& [name, sensor] : m.sensors) {
      if (name != data.instruments.sensors[k].name) continue;
      if (sensor.gain_sigma > 0) {
        Move move{{fmt::format("gain of {}", name), sensor.gain_sigma}};
        move.sensor = {name, sensor.gain_sigma, 0};
        out.push_back(std::move(move));
      }
      double largest = 0;
      for (const measurement::Reading& r : data.readings)
        largest = std::max(largest, std::abs(r.sensors[k].value_or(0)));
      if (!sensor.free_zero || largest == 0) continue;
      Move move{{fmt::format("zero of {}", name), 10 * largest, {}, true}};
      move.sensor = {name, 0, move.tolerance.sigma};
      out.push_back(std::move(move));
    }
  return out;
}

std::vector<Move> moves_of(const Mechanism& m, const std::vector<Configuration>& drawn,
                           const measurement::Measurements& data) {
  std::vector<Move> moves = shared_moves(m);
  if (!m.tolerances.numbers.empty())
    for (NumberMove& number : number_moves(resolved(m))) {
      Move move{{number.name, number.sigma}};
      move.tolerance.step = step_of(number.relative);
      move.number = std::move(number);
      moves.push_back(std::move(move));
    }
  if (m.sensor.free_zero)
    for (Move& zero : free_zeros(data)) moves.push_back(std::move(zero));
  for (Move& move : sensor_moves(m, data)) moves.push_back(std::move(move));
  for (Move& move : unknown_starts(drawn, data)) moves.push_back(std::move(move));
  const double sigma = m.tolerances.actuator_repeatability;
  if (!(sigma > 0)) return moves;
  for (std::size_t p = 0; p < drawn.size(); ++p)
    for (std::size_t q = 0; q < drawn[p].actuators.size(); ++q) {
      if (drawn[p].actuators[q].rotation) continue;
      moves.push_back({{fmt::format("pose {} {}", data.poses[p].label, drawn[p].actuators[q].name), sigma, p}, {}, q});
    }
  return moves;
}

std::shared_ptr<const Mechanism> without_drift(const Mechanism& m) {
  Mechanism out = m;
  out.geometry = Geometry::linear;
  out.sensor.drift.setZero();
  return std::make_shared<const Mechanism>(std::move(out));
}

class MachineStanding final : public Standing {
 public:
  MachineStanding(std::shared_ptr<const Mechanism> m, std::vector<Configuration> machines)
      : mechanism_(std::move(m)), machines_(std::move(machines)) {}

  std::size_t poses() const override { return machines_.size(); }
  bool has_tool_point() const override { return true; }
  double size() const override { return machines_.front().size; }
  BodyFrame tool(std::size_t pose) const override { return {machines_[pose].pose.p_WT, machines_[pose].pose.R_WT}; }
  BodyFrame base(std::size_t pose) const override { return {machines_[pose].base.p_W, machines_[pose].base.R_WJ}; }
  std::vector<Site> sites(std::size_t pose) const override { return sites_of(machines_[pose]); }

  Matrix6 compliance(std::size_t pose) const override {
    const analytic::AnalyticModel model(machines_[pose]);
    const auto under = [&](double force, double moment) {
      Vector6 F;
      F << Vector3::Constant(force), Vector3::Constant(moment);
      return outcome_of<ModelError>([&] { return model.compliance(model.solve(F)); });
    };
    if (model.linear()) return model.compliance(model.solve(Vector6::Zero()));
    const auto pushed = under(1, 0);
    return pushed ? *pushed : under(1, size()).value.value_or(Matrix6::Zero());
  }

  bool has_history() const override { return any_history(machines_.front()); }

  prediction::Predicted predicted(const measurement::Measurements& data, const prediction::PredictionOptions& o,
                                  const parallel::Work& work) const override {
    return prediction::predicted(*mechanism_, machines_, data, o, work);
  }

  measurement::SensorForm sensor_forms(const measurement::Measurements& data) const override {
    return [this, instruments = prediction::Instruments(*mechanism_, data)](std::size_t pose, std::size_t sensor) {
      return instruments.form(machines_[pose], sensor);
    };
  }

  std::unique_ptr<const Transmissions> transmissions() const override {
    return transmissions_of(*mechanism_, machines_);
  }

  std::unique_ptr<const Deviations> deviations(const measurement::Measurements&) const override;

  const std::vector<Configuration>& machines() const { return machines_; }

 private:
  std::shared_ptr<const Mechanism> mechanism_;
  std::vector<Configuration> machines_;  // by pose, as drawn
};

class MachineDeviations final : public Deviations {
 public:
  MachineDeviations(const Mechanism& m, const std::vector<Configuration>& machines,
                    const measurement::Measurements& data)
      : mechanism_(without_drift(m)),
        same_geometry_(prediction::with_geometry(*mechanism_, {})),
        resolved_(resolved(same_geometry_)),
        drawn_(mechanism_, machines),
        moves_(moves_of(m, machines, data)) {
    for (const Move& move : moves_) tolerances_.push_back(move.tolerance);
  }

  const std::vector<Tolerance>& tolerances() const override { return tolerances_; }
  const Standing& drawn() const override { return drawn_; }

  std::unique_ptr<const Standing> with(std::size_t k) const override {
    const Move& move = moves_[k];
    if (!move.zero.isZero(0) || !move.sensor.name.empty()) {
      Mechanism shifted = *mechanism_;
      shifted.sensor.zero += move.zero;
      for (auto& [name, sensor] : shifted.sensors)
        if (name == move.sensor.name) sensor.gain += move.sensor.gain, sensor.zero += move.sensor.zero;
      return std::make_unique<MachineStanding>(std::make_shared<const Mechanism>(std::move(shifted)),
                                               drawn_.machines());
    }
    if (!move.number.shifts.empty()) {
      const auto built = std::make_shared<const Mechanism>(moved(resolved_, move.number, move.tolerance.step));
      std::vector<Configuration> machines;
      for (const Configuration& c : drawn_.machines())
        machines.push_back(prediction::configure_as_built(*built, {}, c));
      return std::make_unique<MachineStanding>(built, std::move(machines));
    }
    std::vector<Configuration> moved;
    if (move.start != 0) {
      moved.push_back(drawn_.machines()[*move.tolerance.pose]);
      for_each_law(moved.front(), [&](Law& law) {
        if (starts_anyhow(law)) std::get<FrictionLaw>(law).start = move.start;
      });
    } else if (const std::optional<std::size_t> pose = move.tolerance.pose) {
      const Configuration& drawn = drawn_.machines()[*pose];
      VectorX errors = VectorX::Zero(std::ssize(drawn.actuators));
      errors(as_index(move.actuator)) = move.tolerance.sigma;
      moved.push_back(prediction::configure_as_built(same_geometry_, {}, drawn, errors));
    } else {
      const Mechanism geometry = prediction::with_geometry(*mechanism_, move.built);
      for (const Configuration& c : drawn_.machines())
        moved.push_back(prediction::configure_as_built(geometry, move.built, c));
    }
    return std::make_unique<MachineStanding>(mechanism_, std::move(moved));
  }

 private:
  std::shared_ptr<const Mechanism> mechanism_;
  Mechanism same_geometry_;
  Mechanism resolved_;  // that with its legs worked out, one by one
  MachineStanding drawn_;
  std::vector<Move> moves_;
  std::vector<Tolerance> tolerances_;
};

std::unique_ptr<const Deviations> MachineStanding::deviations(const measurement::Measurements& data) const {
  return std::make_unique<MachineDeviations>(*mechanism_, machines_, data);
}

class MachineSubject final : public Subject::Kind {
 public:
  explicit MachineSubject(Mechanism m) : mechanism_(std::make_shared<const Mechanism>(std::move(m))) {}

  const std::string& name() const override { return mechanism_->name; }
  const std::string& about() const override { return mechanism_->about; }
  std::string file_text(const std::string& name, const std::string& about) const override {
    Mechanism m = *mechanism_;
    m.name = name, m.about = about;
    return write_mechanism(m);
  }
  Geometry geometry() const override { return mechanism_->geometry; }
  Geometry true_geometry() const override {
    return mechanism_->geometry == Geometry::linear ? Geometry::finite : mechanism_->geometry;
  }
  measurement::Instruments instruments() const override { return measurement::instruments_of(*mechanism_); }
  measurement::Measurements placed(measurement::Measurements m) const override {
    return measurement::place_loads(std::move(m), *mechanism_);
  }
  double load_tolerance() const override { return mechanism_->tolerances.load; }
  int legs() const override { return leg_count(*mechanism_); }
  std::vector<Place> places() const override {
    std::vector<Place> all = places_of(*mechanism_);
    const std::vector<Place> groups = groups_of(all);
    all.insert(all.end(), groups.begin(), groups.end());
    return all;
  }
  const Mechanism* machine() const override { return mechanism_.get(); }

  std::shared_ptr<const Standing> stand(const measurement::Measurements& data, const Standing* known) const override {
    const auto* machine = dynamic_cast<const MachineStanding*>(known);
    std::span<const Configuration> before;
    if (machine) before = machine->machines();
    return std::make_shared<MachineStanding>(mechanism_, measurement::configure_all(*mechanism_, data, before));
  }
  std::shared_ptr<const Kind> named(const std::string& name) const override {
    Mechanism m = *mechanism_;
    m.name = name;
    return machine_subject(std::move(m));
  }
  std::shared_ptr<const Kind> edited(const std::vector<Edit>& edits) const override {
    return machine_subject(edited_in_turn(*mechanism_, edits));
  }

 private:
  std::shared_ptr<const Mechanism> mechanism_;
};

}  // namespace

std::shared_ptr<const Subject::Kind> machine_subject(Mechanism m) {
  return std::make_shared<MachineSubject>(std::move(m));
}

}  // namespace deflect::subject
