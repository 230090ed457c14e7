// Loads that act, and displacements that are read, beside the tool point that the file says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/devices.h"
#include "tests/support/effects_everywhere.h"
#include "validation/compare/comparison.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/prediction.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace measurement;
using namespace prediction;

constexpr const char* beside_T = "[12 mm, -7 mm, 25 mm]";
const std::string tilted = "a,10,5,190,4,-3,6", command = "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg";

/// A handle and three probes beside T, as bodies of the device.
Mechanism machine() {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  m = test::with(m, "loads", fmt::format("{{handle: {{body: tool, point: {}}}}}", beside_T));
  std::string sensors;
  for (const char axis : {'x', 'y', 'z'})
    sensors += fmt::format("{}p{}: {{body: tool, point: {}, direction: u{}}}", sensors.empty() ? "" : ", ", axis,
                           beside_T, axis);
  return test::with(m, "sensors", "{" + sensors + "}");
}

VectorX read(const Mechanism& m, const std::string& columns, const std::string& row, Geometry g, const char* by) {
  const Measurements data = place_loads(
      parse_measurements(command + "," + columns + "\n" + tilted + "," + row + "\n", "data.csv", instruments_of(m)), m);
  PredictionOptions o;
  o.theory = &theories::theory(by);
  o.geometry = g;
  return predict(m, configure_all(m, data), data, o).front();
}

void expect_same(const VectorX& a, const VectorX& b, double within) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_LE((a - b).norm(), within * b.norm()) << a.transpose() << "\n" << b.transpose();
}

// A load that is recorded at T and acts at a point of the tool is a load at a handle there, in every shape. At first
// order the moment about T is (R p) × f.
TEST(RigPoints, LoadActsWhereAHandleIs) {
  const Mechanism m = machine(), moved = test::with(m, "rig", fmt::format("{{load_cell: {{point: {}}}}}", beside_T));
  const std::string at_T = "fx_N,fy_N,fz_N,mx_Nmm,px_mm",
                    at_handle = "handle.fx_N,handle.fy_N,handle.fz_N,handle.mx_Nmm,px_mm";
  for (const char* theory : {"analytic", "msa"})
    for (const Geometry g : {Geometry::linear, Geometry::finite})
      expect_same(read(moved, at_T, "20,-30,10,400,0", g, theory), read(m, at_handle, "20,-30,10,400,0", g, theory),
                  1e-12);
  // A load at the handle itself stays there.
  const std::string both = at_T + ",handle.fy_N";
  const VectorX together = read(moved, both, "20,-30,10,400,0,15", Geometry::linear, "analytic"),
                handle = read(moved, both, "0,0,0,0,0,15", Geometry::linear, "analytic"),
                alone = read(moved, both, "20,-30,10,400,0,0", Geometry::linear, "analytic");
  expect_same(together, handle + alone, 1e-9);
  expect_same(handle, read(m, both, "0,0,0,0,0,15", Geometry::linear, "analytic"), 1e-12);
}

// What is read beside T is what probes of that point read; rotations stay.
TEST(RigPoints, SensorReadsWhatProbesThereRead) {
  const Mechanism m = machine(), moved = test::with(m, "rig", fmt::format("{{sensor: {{point: {}}}}}", beside_T));
  const std::string columns = "fx_N,fy_N,fz_N,mx_Nmm,px_mm,py_mm,pz_mm", row = "20,-30,10,9000,0,0,0";
  for (const char* theory : {"analytic", "msa"})
    for (const Geometry g : {Geometry::linear, Geometry::finite}) {
      const VectorX there = read(moved, columns, row, g, theory), at_T = read(m, columns, row, g, theory);
      expect_same(there.head<3>(), at_T.tail<3>(), 1e-12);
      EXPECT_EQ(there.segment<3>(3), at_T.segment<3>(3));
      EXPECT_GT((there.head<3>() - at_T.head<3>()).norm(), 0.01 * at_T.head<3>().norm()) << "the tilt shows";
    }
}

// The readings were placed for the machine as drawn. With the handle elsewhere the same file reads as one of a machine
// that has it there.
TEST(RigPoints, AHandleThatMovedIsLoadedWhereItIs) {
  const Mechanism drawn = machine(), there = test::with(drawn, "loads.handle.point", "[40 mm, 10 mm, -20 mm]");
  const std::string columns = command + ",handle.fx_N,handle.fy_N,handle.fz_N,handle.mx_Nmm,fx_N,fy_N,fz_N,px_mm";
  const auto file = [&](const Mechanism& m) {
    return place_loads(
        parse_measurements(columns + "\n" + tilted + ",20,-30,10,400,0,3,7,0\n", "data.csv", instruments_of(m)), m);
  };
  const Measurements for_drawn = file(drawn), for_there = file(there);
  const auto predicted = [](const Mechanism& m, const Measurements& data, Geometry g) {
    PredictionOptions o;
    o.geometry = g;
    return predict(m, configure_all(m, data), data, o).front();
  };
  for (const Geometry g : {Geometry::linear, Geometry::finite})
    expect_same(predicted(there, for_drawn, g), predicted(there, for_there, g), 1e-12);
  EXPECT_GT((predicted(there, for_drawn, Geometry::linear) - predicted(drawn, for_drawn, Geometry::linear)).norm(),
            0.01 * predicted(drawn, for_drawn, Geometry::linear).norm());
}

// As effects: the point moves by what is given, from where the description has it.
TEST(RigPoints, EffectsMoveThePoints) {
  const subject::Subject s = test::with(machine(), "rig", "{load_cell: {point: [1 mm, 0 mm, 0 mm]}}");
  const std::vector<effects::Effect> all = test::effects_everywhere(s);
  const auto with = [&](const std::string& id) {
    return effects::with_effect(*s.machine(), effects::find_effect(all, id), test::values({2, 3, 4}));
  };
  EXPECT_TRUE(with("moved@load").load_cell.point.isApprox(Vector3(3e-3, 3e-3, 4e-3), 1e-12));
  EXPECT_TRUE(with("moved@sensor").sensor.point.isApprox(Vector3(2e-3, 3e-3, 4e-3), 1e-12));
  EXPECT_TRUE(with("moved@loads.handle").loads.front().second.point.isApprox(Vector3(14e-3, -4e-3, 29e-3), 1e-12));
}

/// What is simulated with forces at T + p, p in base axes, and recorded as if they acted at T.
Measurements with_forces_at(const Mechanism& m, const Vector3& p, std::uint64_t seed) {
  Measurements plan = campaign("random", m, 40, 1);
  std::vector<Vector6> recorded;
  for (Reading& r : plan.readings) {
    recorded.push_back(r.load);
    r.load.tail<3>() += p.cross(Vector3(r.load.head<3>()));
  }
  SimulationOptions o;
  o.seed = seed, o.tolerances = 1;
  Measurements out = simulate(m, plan, o);
  for (std::size_t i = 0; i < recorded.size(); ++i) out.readings[i].load = recorded[i];
  return out;
}

// Drives that deviate by 10 % leave more than a point of the forces does: without them in the fit it is 30 % off, or
// what it takes away too little to be looked at.
TEST(RigPoints, APointInBaseAxesIsWeighedByTolerances) {
  const Mechanism m = test::with(test::device("arm"), "tolerances", "{drive.stiffness: 10 %, load: 0.3 %}");
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Measurements data = with_forces_at(m, {0.006, -0.004, 0.009}, seed);
    const compare::Comparison c = compare::compare(m, data);
    ASSERT_TRUE(is_mistaken(c)) << seed;
    ASSERT_EQ(c.mistakes.front().ids, std::vector<std::string>{"force_elsewhere"});
    const std::string& said = c.mistakes.front().sentence;
    Vector3 p;
    ASSERT_EQ(std::sscanf(said.c_str() + said.find("T + ("), "T + (%lf, %lf, %lf)", &p(0), &p(1), &p(2)), 3) << said;
    EXPECT_LT((p - Vector3(6, -4, 9)).norm(), 3) << said;
  }
}

// A point that turns with the platform is an effect: it is named, and one in base axes only remarked on, though that
// follows it to the noise where the poses of a machine tilt little.
TEST(RigPoints, APointOfThePlatformIsNamed) {
  const Mechanism m = test::device("haptic-6psu");
  const subject::Subject s = m;
  const std::vector<effects::Effect> all = test::effects_everywhere(s);
  for (const std::string id : {"moved@load", "moved@sensor"}) {
    const VectorX truth = test::values({8, -5, 15});
    const Mechanism true_machine = effects::with_effect(m, effects::find_effect(all, id), truth);
    const Measurements data = simulate(true_machine, campaign("random", m, 40, 5), {});
    const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, all, {{}, 99});
    ASSERT_FALSE(diagnosis::is_mistaken(d)) << id;
    ASSERT_EQ(d.missing.size(), 1u) << id;
    EXPECT_EQ(d.missing[0].effect->name, id);
    for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(d.fit.values(i), truth(i), 1) << id << " " << i;
  }
}

}  // namespace
}  // namespace deflect
