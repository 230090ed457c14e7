// Named sensors on the platform or the tool, and loads at points beside T.
#include "validation/prediction/instruments.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/compare/comparison.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/place_effects.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/replicates.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace measurement;
using namespace prediction;

const std::string device_name = "haptic-6psu-ideal-joints";

/// Three probes and a tilt meter on the platform, and a handle 60 mm above T and aside.
Mechanism instrumented() {
  Mechanism m = test::device(device_name);
  m = test::with(
      m, "sensors",
      "{left: {point: [40 mm, 0 mm, 0 mm], direction: uz}, right: {point: [-40 mm, 10 mm, 5 mm], direction: "
      "[0, 0.6, 0.8]}, far: {body: tool, point: [0 mm, 0 mm, 80 mm], direction: ux}, tilt: {direction: ry}}");
  return test::with(m, "loads", "{handle: {point: [20 mm, -10 mm, 60 mm]}}");
}

Measurements file(const Mechanism& m, const std::string& header, const std::string& rows) {
  return place_loads(parse_measurements(header + "\n" + rows, "data.csv", instruments_of(m)), m);
}

constexpr const char* pose = "a,10,5,190,4,-3,6";
const std::string command = "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg";

std::vector<VectorX> predicted(const Mechanism& m, const Measurements& data, Geometry g, const char* by = "analytic") {
  PredictionOptions o;
  o.theory = &theories::theory(by);
  o.geometry = g;
  return predict(m, configure_all(m, data), data, o);
}

TEST(Instruments, RigidBodyMovesUnderSensors) {
  const Mechanism m = instrumented();
  const Measurements data = file(m, command + ",fx_N,fy_N,fz_N,mx_Nmm,left_mm,right_um,far_mm,tilt_mrad",
                                 std::string(pose) + ",20,-30,10,400,0,0,0,0\n");
  ASSERT_EQ(data.instruments.sensors.size(), 4u);
  const Configuration c = configure_all(m, data).front();
  for (const char* theory : {"analytic", "msa"}) {
    const VectorX d = predicted(m, data, Geometry::linear, theory).front();
    ASSERT_EQ(d.size(), 10);
    const Vector3 delta = d.head<3>(), theta = d.segment<3>(3);
    const auto moved = [&](const Vector3& point) { return Vector3(delta + theta.cross(c.pose.R_WT * point)); };
    const double size = delta.norm();
    EXPECT_NEAR(d(6), moved({0.04, 0, 0}).z(), 1e-12 * size);
    EXPECT_NEAR(d(7), moved({-0.04, 0.01, 0.005}).dot(Vector3(0, 0.6, 0.8)), 1e-12 * size);
    EXPECT_NEAR(d(8), moved({0, 0, 0.08}).x(), 1e-12 * size);
    EXPECT_NEAR(d(9), theta.y(), 1e-12 * theta.norm());
  }
  // A body that turns by θ carries its points along circles: R(θ) r − r.
  const VectorX d = predicted(m, data, Geometry::finite).front();
  const Vector3 arm = c.pose.R_WT * Vector3(0, 0, 0.08), theta = d.segment<3>(3);
  EXPECT_NEAR(d(8), d(0) + (rotation_from_vector(theta) * arm - arm).x(), 1e-15);
  EXPECT_GT(std::abs(d(8) - d(0) - theta.cross(arm).x()), 1e-12) << "the second order is there";
}

// Where nothing but the tool joint yields, the platform stands still and the tool moves by its joint alone.
TEST(Instruments, PlatformOfAMachineThatYieldsInItsToolAloneStandsStill) {
  const Mechanism m = parse_mechanism(R"(name: probe
kinematics: {family: chains}
leg:
  drive: {joint: motor}
  lever: {offset: [0 mm, 0 mm, 100 mm]}
tool: {tz: {law: linear, stiffness: 500 N/mm}}
sensors:
  still: {direction: uz}
  tip: {body: tool, direction: uz}
)",
                                      "probe.yaml");
  const Measurements data = file(m, "pose,q1_rad,fx_N,fy_N,fz_N,still_mm,tip_mm", "a,0,0,0,20,0,0\na,0,0,0,-10,0,0\n");
  for (const char* theory : {"analytic", "msa"})
    for (const Geometry g : {Geometry::linear, Geometry::finite}) {
      const std::vector<VectorX> d = predicted(m, data, g, theory);
      EXPECT_EQ(d[0](6), 0);
      EXPECT_NEAR(d[0](7), 20 / 5e5, 1e-12);
      EXPECT_NEAR(d[1](7), -10 / 5e5, 1e-12);
    }
}

TEST(Instruments, ASensorThatTheDeviceLacksIsToldWithThoseItHas) {
  const Mechanism m = instrumented();
  const Measurements data = file(m, command + ",fx_N,fy_N,fz_N,left_mm", std::string(pose) + ",1,0,0,0\n");
  try {
    prediction::Instruments(test::with(m, "sensors", "{other: {direction: uz}}"), data);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), ("data.csv: " + m.name + " has no sensor 'left'; there is other").c_str());
  }
}

TEST(Instruments, LoadAtPointIsWrenchAtT) {
  const Mechanism m = instrumented();
  const Measurements at_handle =
      file(m, command + ",handle.fx_N,handle.fz_N,handle.my_Nmm,ux_mm", std::string(pose) + ",12,-20,300,0\n");
  const Matrix3 R = configure_all(m, at_handle).front().pose.R_WT;
  const Vector3 arm = R * Vector3(0.02, -0.01, 0.06), f(12, 0, -20);
  Vector6 wrench;
  wrench << f, Vector3(0, 0.3, 0) + arm.cross(f);
  EXPECT_LT((at_handle.readings.front().load - wrench).norm(), 1e-12);
  Measurements at_T = at_handle;
  at_T.instruments.load_points.clear();
  for (const char* theory : {"analytic", "msa"}) {
    const VectorX by_point = predicted(m, at_handle, Geometry::linear, theory).front(),
                  by_wrench = predicted(m, at_T, Geometry::linear, theory).front();
    EXPECT_LT((by_point - by_wrench).norm(), 1e-12 * by_wrench.norm());
  }
  // In the deformed shape the point moves on with the platform: equilibrium under [f; m + R(θ) r × f].
  const VectorX d = predicted(m, at_handle, Geometry::finite).front();
  at_T.readings.front().load.tail<3>() = Vector3(0, 0.3, 0) + (rotation_from_vector(d.segment<3>(3)) * arm).cross(f);
  EXPECT_LT((predicted(m, at_T, Geometry::finite).front() - d).norm(), 1e-9 * d.norm());
}

// A tool on a spring of 50 Nm/rad about x: 1 Nm at T turns it by 20 mrad beside the platform.
TEST(Instruments, ToolJointTurnsTheToolAlone) {
  const Mechanism rigid = instrumented();
  const Mechanism soft = test::with(rigid, "tool", "{rx: {law: linear, stiffness: 50 Nm/rad}}");
  const std::string header = command + ",fx_N,fy_N,fz_N,mx_Nmm,handle.my_Nmm,left_mm,far_mm,tilt_rad";
  for (const char* theory : {"analytic", "msa"}) {
    const auto at = [&](const Mechanism& m, const std::string& load) {
      return predicted(m, file(m, header, "a,0,0,190,0,0,0," + load + ",0,0,0\n"), Geometry::linear, theory).front();
    };
    const VectorX stiff = at(rigid, "0,0,0,1000,0"), turned = at(soft, "0,0,0,1000,0");
    EXPECT_NEAR(turned(3) - stiff(3), 1.0 / 50, 1e-9);
    EXPECT_NEAR(turned(6), stiff(6), 1e-9 * std::abs(stiff(6))) << "a probe on the platform";
    const VectorX both = at(soft, "0,0,0,1000,700");
    EXPECT_NEAR(both(3) - at(rigid, "0,0,0,1000,700")(3), 1.0 / 50, 1e-9) << "the handle's load does not pass the tool";
  }
}

TEST(Instruments, ColumnsAreReadAndWritten) {
  const Mechanism m = instrumented();
  const Measurements data = file(m, command + ",fx_N,fy_N,fz_N,handle.fz_kgf,Left [um],tilt_deg",
                                 std::string(pose) + ",1,2,3,-2,12.5,\n" + std::string(pose) + ",0,0,0,0,-,0.5\n");
  ASSERT_EQ(data.instruments.sensors.size(), 2u);
  EXPECT_DOUBLE_EQ(*data.readings[0].sensors[0], 12.5e-6);
  EXPECT_FALSE(data.readings[0].sensors[1]);
  EXPECT_DOUBLE_EQ(*data.readings[1].sensors[1], 0.5 * pi / 180);
  EXPECT_NEAR(data.readings[0].at_points[0](2), -2 * 9.80665, 1e-12);
  const std::string text = measurements_text(data);
  const Measurements again = place_loads(parse_measurements(text, "again.csv", instruments_of(m)), m);
  EXPECT_EQ(measurements_text(again), text);
  EXPECT_EQ(again.readings[0].load, data.readings[0].load);
  EXPECT_EQ(again.readings[0].sensors, data.readings[0].sensors);

  const auto refusal = [&](const std::string& header) -> std::string {
    try {
      file(m, command + header, std::string(pose) + ",1,2,3,0\n");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal(",fx_N,fy_N,fz_N,rihgt_mm").find("did you mean 'right_mm'"), std::string::npos);
  EXPECT_NE(refusal(",fx_N,fy_N,fz_N,left_N").find("left_mm"), std::string::npos);
  EXPECT_NE(refusal(",fx_N,fy_N,left_mm,tilt_rad").find("columns missing: fz_N"), std::string::npos);
}

// "ux_mm" would be read as another thing than the contract says.
TEST(Instruments, ASensorIsNotCalledLikeAColumn) {
  for (const char* name : {"ux", "x", "q1", "sigma_u", "note_1"}) {
    measurement::Instruments known;
    known.sensors.push_back({name, measurement::Quantity::length, {}});
    try {
      parse_measurements(command + ",fx_N,fy_N,fz_N,uz_mm\n" + pose + ",1,2,3,0\n", "data.csv", known);
      ADD_FAILURE() << name;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("give the sensor another name"), std::string::npos) << e.what();
    }
  }
}

TEST(Instruments, NoiseIsEachSensorsOwn) {
  Mechanism m = test::with(instrumented(), "sensors.left.sigma", "3 um");
  std::string rows;
  for (const double off : {-1e-3, 1e-3, 2e-3, -2e-3})
    rows += fmt::format("{},1,2,3,0.5,{},{},0.01\n", pose, off, 1e-3 + 10 * off);
  const std::vector<MeasuredValue> values =
      measured_values(file(m, command + ",fx_N,fy_N,fz_N,left_mm,right_mm,far_mm,sigma_u_mm", rows));
  ASSERT_EQ(values.size(), 12u);
  EXPECT_DOUBLE_EQ(*values[0].sigma, 3e-6) << "the description's";
  EXPECT_NEAR(*values[1].sigma, std::sqrt(10.0 / 3) * 1e-6, 1e-12) << "of its replicates";
  EXPECT_NEAR(*values[2].sigma, std::sqrt(10.0 / 3) * 1e-5, 1e-11);
}

/// The rich campaign read by the three probes and the tilt meter.
Measurements simulated(const Mechanism& m, unsigned seed) {
  SimulationOptions o;
  o.seed = seed;
  o.geometry = Geometry::linear;
  return simulate(m, campaign("rich", m, 50, seed), o);
}

Mechanism with_noise(Mechanism m) {
  for (const char* probe : {"left", "right", "far"}) m = test::with(m, fmt::format("sensors.{}.sigma", probe), "2 um");
  return test::with(m, "sensors.tilt.sigma", "0.04 mrad");
}

TEST(Instruments, CompareAndDiagnoseReadThem) {
  const Mechanism m = with_noise(instrumented());
  const Measurements healthy = simulated(m, 3);
  EXPECT_TRUE(std::none_of(healthy.readings.begin(), healthy.readings.end(),
                           [](const Reading& r) { return r.displacement[0].has_value(); }));
  const compare::Comparison c = compare::compare(m, healthy);
  EXPECT_NEAR(c.chi2_per_dof, 1, 0.15);
  ASSERT_EQ(c.by_axis.size(), 4u) << "one group a sensor";
  EXPECT_EQ(c.by_axis.back().quantity, measurement::Quantity::angle);
  EXPECT_EQ(c.by_axis.front().group, "left");

  const Mechanism hidden = effects::with_effect(m, test::effect("guide_root_compliance"), test::values({5e6}));
  const diagnosis::Diagnosis found = diagnosis::diagnose(m, simulated(hidden, 4), test::all_effects());
  ASSERT_FALSE(found.missing.empty());
  EXPECT_EQ(found.missing.front().effect->name, "guide_root_compliance");
}

TEST(Instruments, GainOfOneProbeIsNamed) {
  const Mechanism m = with_noise(instrumented());
  const Mechanism off = test::with(m, "sensors.right.gain", "0.9");
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(m, all)) all.push_back(std::move(e));
  const diagnosis::Diagnosis found = diagnosis::diagnose(m, simulated(off, 5), all);
  ASSERT_EQ(found.missing.size(), 1u);
  EXPECT_EQ(found.missing.front().effect->name, "gain@right");
  EXPECT_NEAR(found.fit.values(0), 0.9, 0.01);
}

TEST(Instruments, KnownDoubtsAreTolerances) {
  Mechanism m = with_noise(instrumented());
  m = test::with(m, "sensors.right.gain", "\"1 ± 5 %\"");
  m = test::with(m, "sensors.left.zero", "free");
  const Mechanism off = test::with(m, "sensors.right.gain", "0.95");
  Measurements data = simulated(off, 6);
  for (Reading& r : data.readings) *r.sensors[0] += 0.4e-3;
  const compare::Comparison c = compare::compare(m, data);
  EXPECT_NEAR(c.chi2_per_dof, 1, 0.15);
}

TEST(Instruments, BadOnesAreRefused) {
  const Mechanism m = test::device(device_name);
  const auto refusal = [&](const std::string& sensor) -> std::string {
    try {
      test::with(m, "sensors", "{probe: " + sensor + "}");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{direction: up}").find("sensors.probe.direction"), std::string::npos);
  EXPECT_NE(refusal("{direction: [0, 0, 0]}").find("must be one of ux, uy, uz"), std::string::npos);
  EXPECT_NE(refusal("{direction: ux, body: leg}").find("platform"), std::string::npos);
  EXPECT_NE(refusal("{direction: ux, gain: -1}").find("1 ± 0.5 %"), std::string::npos);
  EXPECT_NE(refusal("{point: [1 mm, 0 mm, 0 mm]}").find("direction: uz"), std::string::npos);
}

}  // namespace
}  // namespace deflect
