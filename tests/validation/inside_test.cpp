// Sensors inside legs: forces of drives, motions of bodies; by hand, by virtual work, by both theories.
#include "msa/mechanism/inside.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/place.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/place_effects.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/prediction.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace measurement;
using prediction::PredictionOptions;

// A slide with 100 N/mm along z, a motor with 1 Nm/mrad about z, a pad of 50 N/mm; T is 200 mm beside them along x.
constexpr const char* two_springs = R"(
name: two-springs
kinematics: {family: chains}
leg:
  slide: {joint: prismatic, tz: {law: linear, stiffness: 100 N/mm}}
  motor: {joint: motor, rz: {law: linear, stiffness: 1e6 Nmm/rad}}
  pad: {joint: slider, tz: {law: linear, stiffness: 50 N/mm}}
  arm: {offset: [200 mm, 0 mm, 0 mm]}
sensors:
  F: {drive: leg.slide, force: true, sigma: 0.1 N, gain: 2}
  M: {drive: leg.1.motor, force: true, sigma: 1 Nmm, offset: 7 Nmm}
  z1: {body: leg.slide, point: [50 mm, 0 mm, 0 mm], direction: uz}
  y1: {body: leg.motor, point: [50 mm, 0 mm, 0 mm], direction: uy}
  turn: {body: leg.motor, direction: rz}
  probe: {point: [0 mm, 0 mm, 0 mm], direction: uz}
)";

Mechanism springs() { return parse_mechanism(two_springs, "two.yaml"); }

std::vector<VectorX> predicted(const Mechanism& m, const Measurements& data, const std::string& theory,
                               Geometry geometry = Geometry::linear) {
  PredictionOptions o;
  o.theory = &theories::theory(theory);
  o.geometry = geometry;
  return prediction::predict(m, configure_all(m, data), data, o);
}

// F_z passes the slide and the pad, F_y at 200 mm turns the motor: by hand.
TEST(InsideLegs, ByHand) {
  const Mechanism m = springs();
  const Measurements data = parse_measurements(
      "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,F_N,M_Nmm,z1_mm,y1_mm,turn_rad,probe_mm\n"
      "A,200,0,0,0,0,0,0,5,10,0,0,0,0,0,0\n",
      "data.csv", instruments_of(m));
  ASSERT_EQ(data.instruments.sensors.size(), 6U);
  EXPECT_EQ(data.instruments.sensors[0].quantity, measurement::Quantity::force);
  EXPECT_EQ(data.instruments.sensors[1].quantity, measurement::Quantity::moment);
  for (const char* theory : {"analytic", "msa"}) {
    const VectorX read = predicted(m, data, theory).front();
    EXPECT_NEAR(read(6), 2 * 10, 1e-9) << theory;           // pulled: positive; the gain is 2
    EXPECT_NEAR(read(7), 5 * 0.2 + 0.007, 1e-9) << theory;  // Nm, with the offset
    EXPECT_NEAR(read(8), 10 / 100e3, 1e-13) << theory;      // behind the slide, before the pad
    EXPECT_NEAR(read(9), 1e-3 * 0.05, 1e-13) << theory;     // 50 mm beside the axis
    EXPECT_NEAR(read(10), 1e-3, 1e-12) << theory;
    EXPECT_NEAR(read(11), 10 / 100e3 + 10 / 50e3, 1e-12) << theory;
  }
}

// In the deformed shape the arm turns by θ with k θ = 0.2 m · (F_y cos θ − F_x sin θ), and that is the motor's moment.
TEST(InsideLegs, TurnWithTheMachine) {
  const Mechanism m = springs();
  const Measurements data = parse_measurements(
      "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,M_Nmm,y1_mm\nA,200,0,0,0,0,0,-400,900,0,0,0\n",
      "data.csv", instruments_of(m));
  double theta = 0.1;
  for (int i = 0; i < 200; ++i) theta = 0.2 * (900 * std::cos(theta) + 400 * std::sin(theta)) / 1000;
  for (const char* theory : {"analytic", "msa"}) {
    const VectorX read = predicted(m, data, theory, Geometry::finite).front();
    EXPECT_NEAR(read(6), 1000 * theta + 0.007, 1e-6) << theory;
    EXPECT_NEAR(read(7), 0.05 * std::sin(theta), 1e-9) << theory;
  }
}

// Nothing but the tool yields: the platform stands still, and the drive carries all that acts beyond it.
TEST(InsideLegs, OfARigidMachineWithASoftToolCarryTheLoad) {
  const Mechanism m = parse_mechanism(R"(
name: rigid
kinematics: {family: chains}
leg:
  slide: {joint: prismatic}
  arm: {offset: [200 mm, 0 mm, 0 mm]}
tool: {tz: {law: linear, stiffness: 50 N/mm}}
sensors:
  F: {drive: leg.slide, force: true}
  still: {body: platform, direction: uz}
  tip: {body: tool, direction: uz}
)",
                                      "rigid.yaml");
  const Measurements data = parse_measurements(
      "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,F_N,still_mm,tip_mm\n"
      "A,200,0,0,0,0,0,3,5,10,0,0,0\n",
      "data.csv", instruments_of(m));
  for (const char* theory : {"analytic", "msa"}) {
    const VectorX read = predicted(m, data, theory).front();
    EXPECT_NEAR(read(6), 10, 1e-9) << theory;
    EXPECT_NEAR(read(7), 0, 1e-15) << theory;
    EXPECT_NEAR(read(8), 10 / 50e3, 1e-13) << theory;
  }
}

void driven_in(const Named<Part>& parts, const std::string& path, std::vector<std::string>& out) {
  for (const auto& [name, part] : parts) {
    const std::string here = path + "." + name;
    if (const auto* joint = std::get_if<Joint>(&part)) {
      const std::array<Freedom, 6> freedoms = freedoms_of(*joint);
      for (std::size_t i = 0; i < 6; ++i)
        if (freedoms[i] == Freedom::actuated) out.push_back(fmt::format("{}.{}", here, freedom_names[i]));
    } else if (const auto* group = std::get_if<Parallel>(&part)) {
      for (std::size_t b = 0; b < std::max<std::size_t>(1, group->mounts.size()); ++b)
        driven_in(b < group->mounts.size() && !group->mounts[b].leg.empty() ? group->mounts[b].leg : group->leg,
                  fmt::format("{}.{}", here, b + 1), out);
    }
  }
}

/// In the order of Configuration::actuators.
std::vector<std::string> drives_of(const Mechanism& m) {
  std::vector<std::string> out;
  for (int leg = 1; leg <= leg_count(m); ++leg) driven_in(leg_parts(m, leg), fmt::format("leg.{}", leg), out);
  return out;
}

Mechanism with_drive_sensors(Mechanism m) {
  int number = 0;
  for (const std::string& path : drives_of(m)) {
    PointSensor s;
    s.drive = path;
    s.sigma = 0.1;
    complete_sensor(m, s);
    m.sensors.emplace_back(fmt::format("drive{}", ++number), s);
  }
  return m;
}

const std::vector<std::string> machines = {
    "haptic-6psu", "haptic-6psu-ideal-joints", "tripteron", "delta", "stewart-6ups", "arm", "gantry", "hybrid",
    "scara"};

/// One reading at each of some poses, under a load of all six components, that reads all sensors.
Measurements loads_on(const Mechanism& m, double size) {
  Measurements data = prediction::campaign("random", m, size, 5);
  data.instruments.sensors = instruments_of(m).sensors;
  for (Reading& r : data.readings) {
    r.load << 0.7, -0.4, 0.5, 0.02, -0.05, 0.03;
    r.load *= size;
    r.sensors.assign(data.instruments.sensors.size(), 0.0);
  }
  return data;
}

// The principle of virtual work: as one drive moves by dq, all others held, T moves by J dq, and f dq = Fᵀ J dq. The
// motion is that of the kinematics, by differences.
TEST(DriveForces, DoTheWorkOfTheLoad) {
  for (const std::string& name : machines) {
    const Mechanism m = with_drive_sensors(test::device(name));
    const Measurements data = loads_on(m, 30);
    const std::vector<Configuration> placed = configure_all(m, data);
    const std::vector<VectorX> by_closed_form = predicted(m, data, "analytic"), by_msa = predicted(m, data, "msa");
    for (std::size_t p = 0; p < std::min<std::size_t>(3, placed.size()); ++p) {
      const Configuration& c = placed[p];
      const std::size_t i = data.poses[p].readings.front();
      VectorX q(std::ssize(c.actuators));
      for (std::size_t k = 0; k < c.actuators.size(); ++k) q(as_index(k)) = c.actuators[k].value;
      ASSERT_EQ(q.size(), std::ssize(m.sensors)) << name;
      VectorX wanted(q.size());
      for (Eigen::Index k = 0; k < q.size(); ++k) {
        const double h = 1e-5;
        const VectorX step = h * VectorX::Unit(q.size(), k);
        const Pose after = configure_joints(m, q + step, &c).pose, before = configure_joints(m, q - step, &c).pose;
        Vector6 twist;
        const Matrix3 turned = (after.R_WT - before.R_WT) * c.pose.R_WT.transpose() / (2 * h);
        twist << (after.p_WT - before.p_WT) / (2 * h), turned(2, 1), turned(0, 2), turned(1, 0);
        wanted(k) = twist.dot(data.readings[i].load);
      }
      const double scale = wanted.cwiseAbs().maxCoeff();
      EXPECT_LT((by_closed_form[i].tail(q.size()) - wanted).cwiseAbs().maxCoeff(), 1e-6 * scale) << name;
      EXPECT_LT((by_msa[i].tail(q.size()) - wanted).cwiseAbs().maxCoeff(), 1e-6 * scale) << name;
    }
  }
}

void parts_in(const Named<Part>& parts, const std::string& path, std::vector<std::string>& out) {
  for (const auto& [name, part] : parts) {
    if (std::holds_alternative<Offset>(part)) continue;
    const auto* group = std::get_if<Parallel>(&part);
    if (!group) out.push_back(path + "." + name);
    for (std::size_t b = 0; group && b < group->mounts.size(); ++b)
      parts_in(!group->mounts[b].leg.empty() ? group->mounts[b].leg : group->leg,
               fmt::format("{}.{}.{}", path, name, b + 1), out);
  }
}

// Forces of all drives and the motion of where every part ends, by both theories.
TEST(InsideLegs, TheoriesAgree) {
  for (const std::string& name : machines) {
    Mechanism m = with_drive_sensors(test::device(name));
    const auto drives = std::ssize(m.sensors);
    std::vector<std::string> parts;
    for (int leg = 1; leg <= leg_count(m); ++leg) parts_in(leg_parts(m, leg), fmt::format("leg.{}", leg), parts);
    for (const std::string& path : parts) {
      PointSensor s;
      s.body = path;
      s.axis = Vector3(0.36, -0.48, 0.8);
      m.sensors.emplace_back("at " + path, s);
    }
    const Measurements data = one_pose(loads_on(m, 30), 0);
    for (const Geometry geometry : {Geometry::linear, Geometry::finite}) {
      const VectorX a = predicted(m, data, "analytic", geometry).front(),
                    b = predicted(m, data, "msa", geometry).front();
      // Contacts are solved to equilibrium, and in the deformed shape members are divided by each theory on its own.
      const double bound = geometry == Geometry::finite ? 1e-4 : name == "haptic-6psu" ? 1e-7 : 1e-9;
      const VectorX fa = a.segment(6, drives), fb = b.segment(6, drives);
      EXPECT_LT((fa - fb).cwiseAbs().maxCoeff(), bound * fa.cwiseAbs().maxCoeff()) << name << " forces";
      const VectorX ma = a.tail(a.size() - 6 - drives), mb = b.tail(b.size() - 6 - drives);
      Eigen::Index worst = 0;
      const double off = (ma - mb).cwiseAbs().maxCoeff(&worst);
      EXPECT_LT(off, bound * std::max(ma.cwiseAbs().maxCoeff(), a.head<3>().norm()))
          << name << " " << parts[as_size(worst)] << (geometry == Geometry::finite ? " finite" : "");
    }
  }
}

TEST(InsideLegs, ReadBackFromTheirFile) {
  const Mechanism m = springs(), again = parse_mechanism(write_mechanism(m), "again");
  EXPECT_EQ(write_mechanism(again), write_mechanism(m));
  ASSERT_EQ(again.sensors.size(), m.sensors.size());
  EXPECT_EQ(again.sensors[1].second.drive, "leg.1.motor");
  EXPECT_TRUE(again.sensors[1].second.rotation);
  EXPECT_EQ(again.sensors[2].second.body, "leg.slide");
}

TEST(InsideLegs, AreRefusedWithLineAndRemedy) {
  const auto refusal = [](const std::string& from, const std::string& to) -> std::string {
    std::string text = two_springs;
    text.replace(text.find(from), from.size(), to);
    try {
      parse_mechanism(text, "two.yaml");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const auto has = [](const std::string& text, const std::string& part) { return text.find(part) != text.npos; };
  std::string said = refusal("drive: leg.slide", "drive: leg.slied");
  EXPECT_TRUE(has(said, "two.yaml:10: sensors.F.drive: ") && has(said, "did you mean 'slide'") && has(said, "motor"))
      << said;
  said = refusal("drive: leg.slide", "drive: leg.pad");
  EXPECT_TRUE(has(said, "two.yaml:10: ") && has(said, "is not driven")) << said;
  said = refusal("drive: leg.slide", "drive: leg.2.slide");
  EXPECT_TRUE(has(said, "two.yaml:10: ") && has(said, "from 1 to 1")) << said;
  said = refusal("drive: leg.slide, force: true", "drive: leg.slide");
  EXPECT_TRUE(has(said, "force") && has(said, "must be true")) << said;
  said = refusal("body: leg.slide", "body: plattform");
  EXPECT_TRUE(has(said, "two.yaml:12: ") && has(said, "did you mean 'platform'")) << said;
  said = refusal("body: leg.slide", "body: leg.arm");
  EXPECT_TRUE(has(said, "sensors.z1.body") && has(said, "known: slide, motor, pad")) << said;
}

// They are simulated, have gains and zeros as candidates, and tolerances as other sensors.
TEST(InsideLegs, AreMeasuredLikeOthers) {
  Mechanism m = with_drive_sensors(test::device("haptic-6psu-ideal-joints"));
  m.sensors.front().second.gain_text = "1 ± 2 %", m.sensors.front().second.gain_sigma = 0.02;
  m.sensors.back().second.free_zero = true;
  const Measurements data = prediction::simulate(m, prediction::campaign("random", m, 50, 3), {});
  EXPECT_NE(measurements_text(data).find("drive1_N"), std::string::npos);
  EXPECT_EQ(parse_measurements(measurements_text(data), "again.csv", instruments_of(m)).instruments.sensors.size(), 6U);
  std::set<std::string> ids;
  for (const effects::Effect& e : effects::place_effects(subject::Subject(m), test::all_effects())) ids.insert(e.name);
  EXPECT_TRUE(ids.contains("gain@drive1"));
  EXPECT_TRUE(ids.contains("zero@drive1"));
  EXPECT_FALSE(ids.contains("zero@drive6")) << "its zero is free";
  std::set<std::string> tolerances;
  const subject::Subject s(m);
  // Each is named: a range-based for keeps only the last of its temporaries.
  const auto stand = s.stand(data);
  const auto deviations = stand->deviations(data);
  for (const subject::Tolerance& t : deviations->tolerances()) tolerances.insert(t.name);
  EXPECT_TRUE(tolerances.contains("gain of drive1"));
  EXPECT_TRUE(tolerances.contains("zero of drive6"));
}

}  // namespace
}  // namespace deflect
