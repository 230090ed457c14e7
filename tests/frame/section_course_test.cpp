// Section forces inside members in second-order and finite geometry, against closed forms of beam-columns and
// equilibrium.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "msa/frame/file/frame_sensors.h"
#include "tests/support/frames.h"

namespace deflect::frame {
namespace {

using test::Solved;

constexpr double L = 1, EI = 160;                                                 // m, Nm² about both axes
constexpr double euler = std::numbers::pi * std::numbers::pi * EI / (4 * L * L);  // of a column with a free top, N

/// N, Vy, Vz, T, My, Mz
double read(const Solved& s, const std::string& member, std::size_t component, double at) {
  FrameSensor sensor;
  sensor.reads = FrameSensor::Reads::force;
  sensor.of = member;
  sensor.component = component;
  sensor.at = at;
  return true_reading(sensor, s.frame, s.result.structure, s.result.cases.front());
}
constexpr std::size_t My = 4;

/// From A, along z, to B.
Solved column(const std::string& geometry, int elements, const std::string& supports, const std::string& load) {
  return Solved(parse_frame(fmt::format(R"(name: column
geometry: {}
materials: {{steel: {{E: 200 GPa, G: 80 GPa}}}}
sections: {{a: {{shape: given, A: 100 mm^2, Iy: 800 mm^4, Iz: 800 mm^4, J: 500 mm^4}}}}
nodes: {{A: [0 mm, 0 mm, 0 mm], B: [0 mm, 0 mm, 1000 mm]}}
members: {{m: {{from: A, to: B, section: a, material: steel, y_axis: [0, 1, 0], elements: {}}}}}
supports: {}
loads: {{p: {}}}
)",
                                        geometry, elements, supports, load),
                            "t"));
}

const char* const deformed[] = {"second-order", "finite"};

// H sideways and P on the free top of a clamped column: |M| = H sin k(L − x) / (k cos kL), k² = P/EI. Between ends the
// cubic of M leaves (kh)⁴/384, elements of length h raise the load that buckles by (kh)⁴/720, which at half that load
// counts twice: together less than (kh)⁴/150. Finite: the column is P/EA = 1e-5 shorter, which tan kL follows 2.8
// times.
TEST(SectionCourse, OfAColumnUnderHalfItsBucklingLoadIsThatOfStabilityFunctions) {
  const double P = euler / 2, k = std::sqrt(P / EI);
  for (const char* geometry : deformed)
    for (const int elements : {2, 4, 16}) {
      const Solved s =
          column(geometry, elements, "{A: clamped}", fmt::format("{{nodes: {{B: {{fz: {} N, fx: 0.1 N}}}}}}", -P));
      const double H = 0.1, shorter = geometry == std::string("finite") ? 3e-5 : 0;
      const double largest = H * std::tan(k * L) / k, off = std::pow(k * L / elements, 4) / 150 + shorter;
      for (const double at : {0.0, 0.1, 0.31, 0.5, 0.77, 0.99}) {
        const double exact = H * std::sin(k * L * (1 - at)) / (k * std::cos(k * L));
        EXPECT_NEAR(std::abs(read(s, "m", My, at)), exact, off * largest) << geometry << elements << " at " << at;
      }
      EXPECT_NEAR(read(s, "m", My, 1), 0, 1e-9 * largest) << "a free end";
    }
}

// M = q/k² (sec(kL/2) − 1) in the middle between hinges.
TEST(SectionCourse, OfABeamColumnUnderALineLoadIsLargestInTheMiddle) {
  const double P = 2 * euler, k = std::sqrt(P / EI), q = 10;  // N, N/m: half the load that buckles it
  for (const char* geometry : deformed)
    for (const int elements : {2, 4, 8}) {
      const Solved s = column(geometry, elements, "{A: {holds: [ux, uy, uz, rz]}, B: {holds: [ux, uy]}}",
                              fmt::format("{{nodes: {{B: {{fz: {} N}}}}, members: {{m: {{qx: {} N/m}}}}}}", -P, q));
      const double exact = q / (k * k) * (1 / std::cos(k * L / 2) - 1);
      EXPECT_NEAR(std::abs(read(s, "m", My, 0.5)), exact, (std::pow(k * L / elements, 4) / 150 + 2e-4) * exact)
          << geometry << elements;
      const LargestMoment& most = s.member("m").My;
      EXPECT_NEAR(std::abs(most.value), std::abs(read(s, "m", My, 0.5)), 1e-9 * exact) << geometry << elements;
      EXPECT_NEAR(most.at, L / 2, 1e-3 * L) << geometry << elements;
    }
}

// q L²/8 in the middle, whatever the elements; its largest is found inside an element too.
TEST(SectionCourse, OfALineLoadAloneIsTheParabola) {
  for (const char* geometry : {"linear", "second-order", "finite"})
    for (const int elements : {1, 3}) {
      const Solved s = column(geometry, elements, "{A: {holds: [ux, uy, uz, rz]}, B: {holds: [ux, uy]}}",
                              "{members: {m: {qx: 0.01 N/m}}}");
      EXPECT_NEAR(std::abs(s.member("m").My.value), 0.01 / 8, 1e-9) << geometry << elements;
      EXPECT_NEAR(s.member("m").My.at, L / 2, 1e-3) << geometry << elements;
      EXPECT_NEAR(std::abs(read(s, "m", My, 0.25)), 0.01 * 3 / 32, 1e-9) << geometry << elements;
    }
}

Solved in_space(const std::string& geometry, double factor) {
  return Solved(parse_frame(fmt::format(R"(name: space
geometry: {}
materials: {{steel: {{E: 200 GPa, G: 80 GPa}}}}
sections: {{a: {{shape: rectangle, width_y: 20 mm, height_z: 12 mm}}}}
nodes: {{A: [0 mm, 0 mm, 0 mm], B: [100 mm, 50 mm, 700 mm], C: [800 mm, 300 mm, 650 mm], D: [900 mm, -200 mm, 0 mm]}}
members:
  ab: {{from: A, to: B, section: a, material: steel, beam: timoshenko, elements: 3}}
  bc: {{from: B, to: C, section: a, material: steel, beam: timoshenko, elements: 2, y_axis: [0.2, 1, 0.1]}}
  cd: {{from: C, to: D, section: a, material: steel, elements: 4}}
supports: {{A: clamped, D: clamped}}
loads:
  p:
    factor: {}
    nodes: {{B: {{fx: 120 N, fz: -900 N, my: 20 Nm}}, C: {{fy: 150 N, fz: -700 N, mz: -30 Nm}}}}
    members: {{bc: {{qz: -200 N/m, qy: 50 N/m}}}}
)",
                                        geometry, factor),
                            "t"));
}

// Where elements meet, the section forces of one at its end are those of the next at its start; at the ends of a member
// they are the forces printed for it.
TEST(SectionCourse, InSpaceAgreesWithTheForcesOnTheEndsOfElements) {
  for (const char* geometry : deformed) {
    const Solved s = in_space(geometry, 1);
    const CaseResult& r = s.result.cases.front();
    ASSERT_EQ(r.courses.size(), r.end_forces.size());
    double size = 0;
    for (const Vector12& f : r.end_forces) size = std::max(size, f.cwiseAbs().maxCoeff());
    for (std::size_t e = 0; e < r.courses.size(); ++e) {
      const SectionCourse& c = r.courses[e];
      EXPECT_LT((section_forces(c, 0) + r.end_forces[e].head<6>()).norm(), 1e-10 * size) << geometry << e;
      EXPECT_LT((section_forces(c, c.length) - r.end_forces[e].tail<6>()).norm(), 1e-10 * size) << geometry << e;
      const bool inside = e != 2 && e != 4 && e + 1 < r.courses.size();  // no border of members
      if (inside) {
        EXPECT_LT((section_forces(c, c.length) - section_forces(r.courses[e + 1], 0)).norm(), 1e-6 * size)
            << geometry << e;
      }
    }
  }
}

// What the deformed shape adds is of the order of N/N_cr, here 2e-7.
TEST(SectionCourse, OfSmallLoadsIsThatOfTheLinearTheory) {
  const Solved linear = in_space("linear", 1e-6);
  for (const char* geometry : deformed) {
    const Solved s = in_space(geometry, 1e-6);
    for (const char* member : {"ab", "bc", "cd"})
      for (std::size_t component = 0; component < 6; ++component)
        for (const double at : {0.0, 0.2, 0.5, 0.83, 1.0})
          EXPECT_NEAR(read(s, member, component, at), read(linear, member, component, at), 1e-6 * 1e-3)
              << geometry << " " << member << " " << component << " at " << at;
  }
}

}  // namespace
}  // namespace deflect::frame
