// Loads that act, and displacements that are read, beside the tool point that the file says.
#include <gtest/gtest.h>

#include "support/devices.h"
#include "support/effects_everywhere.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/prediction.h"
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

}  // namespace
}  // namespace deflect
