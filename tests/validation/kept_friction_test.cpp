// Friction that still holds at the next pose what it held at the last one: from the readings alone, by the compliance
// of the machine without friction and the geometry of its legs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "analytic/model.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/prediction.h"

namespace deflect {
namespace {

/// The machine without the frictions beside its legs.
analytic::AnalyticModel without_friction(Configuration c) {
  std::erase_if(c.legs, [](const PlacedLeg& leg) { return leg.beside; });
  return analytic::AnalyticModel(c);
}

/// The wrench at T, by leg, of one newton of friction along it.
Matrix6 along_the_legs(const Configuration& c) {
  Matrix6 out;
  Eigen::Index next = 0;
  for (const PlacedLeg& leg : c.legs)
    if (leg.beside)
      for (const PlacedPart& part : leg.parts)
        if (const auto* joint = std::get_if<PlacedJoint>(&part)) {
          const Vector3 axis = joint->R_WJ.col(2);
          out.col(next++) << axis, (joint->p_W - c.pose.p_WT).cross(axis);
        }
  EXPECT_EQ(next, 6);
  return out;
}

TEST(KeptFriction, HoldsAtTheNextPoseItsShareOfWhatItHeld) {
  for (const double kept : {1.0, 0.4, 0.0}) {
    const Mechanism m = effects::with_effect(test::device("haptic-6psu-ideal-joints"),
                                             {{&test::effect("joint_friction"), {}}, test::values({0.3, 1e4, kept})});
    const measurement::Measurements data = measurement::parse_measurements(
        "pose,sequence,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,ux_mm,uy_mm,uz_mm\n"
        "a,0,10,5,190,4,-3,6,2,-1,5,0,0,0\n"
        "a,1,10,5,190,4,-3,6,0,0,0,0,0,0\n"
        "b,2,-15,20,200,-2,5,1,0,0,0,0,0,0\n",
        "data.csv");
    const std::vector<Configuration> c = measurement::configure_all(m, data);
    for (const char* theory : {"analytic", "msa"}) {
      prediction::PredictionOptions o;
      o.theory = &theories::theory(theory);
      o.geometry = Geometry::linear;
      const std::vector<VectorX> read = prediction::predict(m, c, data, o);
      const analytic::AnalyticModel first = without_friction(c.front()), second = without_friction(c.back());
      const Matrix6 C = first.compliance(first.solve(Vector6::Zero()));
      const Vector6 held =
          -along_the_legs(c.front()).fullPivLu().solve(C.fullPivLu().solve(Vector6(read[1].head<6>())));
      const Eigen::Array<double, 6, 1> size = held.cwiseAbs().array();
      EXPECT_TRUE((size > 0.299).any() && ((size > 0.05) && (size < 0.29)).any()) << "slips here, sticks there";
      const Vector6 expected = second.solve(-kept * along_the_legs(c.back()) * held).displacement;
      EXPECT_LE((read[2].head<6>() - expected).norm(), 1e-8 * read[1].norm()) << theory << ", kept " << kept;
    }
  }
}

/// A slide's spring of 100 N/mm beside friction, in series with play and a spring. 60 N came and went: they left 0.2
/// mm, from which readings count, and the play in its middle, wherever along its axis the slide stands. Under 100 N
/// friction slides, (100 − 20)/100 mm; at 50 N it has just turned.
TEST(StartedFriction, LeavesPlayBehindItInTheMiddle) {
  const Mechanism m = parse_mechanism(R"(
name: slide
kinematics: {family: chains}
leg:
  slide: {joint: prismatic, tz: {law: linear, stiffness: 100 N/mm}, beside: {tz: {law: friction, force: 20 N, stiffness: 400 N/mm, start: 0.6}}}
  play: {joint: fixed, tz: [{law: clearance, gap: 0.05 mm}, {law: linear, stiffness: 300 N/mm}], tx: {law: linear, stiffness: 1 kN/mm}, ty: {law: linear, stiffness: 1 kN/mm}, rx: {law: linear, stiffness: 1 kNm/rad}, ry: {law: linear, stiffness: 1 kNm/rad}, rz: {law: linear, stiffness: 1 kNm/rad}}
)",
                                      "slide.yaml");
  for (const char* at : {"0", "1", "3", "5", "10", "50"}) {
    const measurement::Measurements data = measurement::parse_measurements(
        fmt::format(
            "pose,sequence,q1_mm,fx_N,fy_N,fz_N,ux_mm,uy_mm,uz_mm\nb,1,{0},0,0,100,0,0,0\nb,2,{0},0,0,50,0,0,0\n", at),
        "data.csv");
    const std::vector<Configuration> c = measurement::configure_all(m, data);
    for (const char* theory : {"analytic", "msa"}) {
      prediction::PredictionOptions o;
      o.theory = &theories::theory(theory);
      const std::vector<VectorX> read = prediction::predict(m, c, data, o);
      EXPECT_NEAR(1e3 * read[0](2), 0.8 + 0.05 + 100 / 300.0 - 0.2, 1e-9) << theory << " at " << at;
      EXPECT_NEAR(1e3 * read[1](2), 0.7 + 0.05 + 50 / 300.0 - 0.2, 1e-9) << theory << " at " << at;
    }
  }
}

}  // namespace
}  // namespace deflect
