// Sound models with extreme numbers for which the program once refused, took minutes, lost digits or kept silent.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/stand.h"
#include "tests/attack/device_oracle.h"
#include "tests/support/apart.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "tests/support/sanitizers.h"
#include "tests/support/stiffnesses.h"

namespace deflect::attack {
namespace {

using nlohmann::json;
using test::Folder;

test::Run timely(const std::string& arguments, int seconds = 20) {
  return test::command("timeout " + std::to_string(seconds * test::times_slower) + " '" + test::program() + "' " +
                       arguments);
}

/// A built-in device with every match of a pattern in its file replaced; there is at least one.
std::string with(const std::string& device, const std::string& pattern, const std::string& text) {
  const std::string file = test::contents(test::source_dir() + "/validation/devices/" + device + ".yaml");
  EXPECT_TRUE(std::regex_search(file, std::regex(pattern))) << device << " has no " << pattern;
  return std::regex_replace(file, std::regex(pattern), text);
}

Vector6 numbers(const json& list) {
  Vector6 v;
  for (std::size_t i = 0; i < 6; ++i) v(static_cast<Eigen::Index>(i)) = list[i].get<double>();
  return v;
}

std::string text_of(const Vector6& v) {
  std::string text;
  for (const double x : v) text += fmt::format("{}{:.17g}", text.empty() ? "" : ",", x);
  return text;
}

/// Both theories as the force method has it, under six loads: N and Nmm.
void expect_right(const std::string& yaml, const Vector6& pose, double tolerance = 1e-8) {
  const Folder folder;
  const std::string file = (folder / "device.yaml").string(), result = (folder / "result.json").string();
  std::ofstream(file) << yaml;
  const Mechanism m = read_mechanism(file);
  const DeviceTruth truth = solve_by_forces(stand(m, pose).configuration);
  ASSERT_TRUE(truth.held && truth.clear);
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const Vector6 load = Vector6::Unit(axis) * (axis < 3 ? 50 : 1000);
    const test::Run run = timely("solve '" + file + "' --pose=" + text_of(pose) + " --load=" + text_of(load) +
                                 " --json '" + result + "'");
    ASSERT_EQ(run.code, 0) << run.out;
    const json r = json::parse(test::contents(result));
    const Vector6 right = twist_in_mm(truth.flexibility * wrench_from_mm(load));
    for (const char* theory : {"analytic", "msa"})
      EXPECT_LE(test::apart(numbers(r[theory]["displacement"]), right, 1e3), tolerance) << theory << ", load " << axis;
  }
}

/// uz of a node in the case "down", mm.
double sinking(const std::string& result, const std::string& node) {
  const json r = json::parse(test::contents(result));
  for (const json& d : r["cases"]["down"]["displacements"])
    if (d["node"] == node) return d["uz_mm"].get<double>();
  return std::nan("");
}

Vector6 at(double x, double y, double z, double yaw = 0) { return (Vector6() << x, y, z, 0, 0, yaw).finished(); }

TEST(ExtremeCases, AHexapodWithDrivesAMillionTimesSofter) {
  expect_right(with("stewart-6ups", "1e5 N/mm", "0.1 N/mm"), at(0, 0, 2000));
}

TEST(ExtremeCases, AHexapodWithDrivesATrillionTimesStiffer) {
  expect_right(with("stewart-6ups", "1e5 N/mm", "1e17 N/mm"), at(0, 0, 2000));
}

TEST(ExtremeCases, ATripteronWithDrivesAMillionTimesSofter) {
  expect_right(with("tripteron", "stiffness: 1000 N/mm", "stiffness: 1e-3 N/mm"), at(500, 500, 500));
}

TEST(ExtremeCases, AHybridWithDrivesAMillionTimesSofter) {
  expect_right(with("hybrid", "(2|1.5)e5 N/mm", "$1e-1 N/mm"), at(0, 0, -1440));
}

TEST(ExtremeCases, ADeltaOfMembersAThousandTimesStiffer) {
  expect_right(with("delta", "100 GPa", "100000 GPa"), at(0, 0, -1000));
}

// At 90 deg the six struts hold the platform's turn no longer.
TEST(ExtremeCases, AHexapodATenthOfADegreeFromItsSingularPose) {
  expect_right(with("stewart-6ups", "", ""), at(0, 0, 2000, 89.9));
}

TEST(ExtremeCases, ADeviceAThousandTimesLargerIsSolvedInSeconds) {
  const auto start = std::chrono::steady_clock::now();
  expect_right(with("stewart-6ups", " mm", " m"), at(0, 0, 2e6));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 6 * 3);  // six loads
}

// P L³/(3 E I) at the tip, however the cantilever is divided: six digits, or a note that they are gone.
TEST(ExtremeCases, ACantileverOfManyElementsKeepsItsDigitsOrSaysSo) {
  const double E = 210e3, I = pi * std::pow(10, 4) / 64, right = -std::pow(1000, 3) / (3 * E * I);  // N, mm
  for (const int elements : {1, 30, 300, 3000}) {
    const Folder folder;
    const std::string file = (folder / "frame.yaml").string(), result = (folder / "result.json").string();
    std::ofstream(file) << "name: cantilever\nmaterials: {steel: {E: 210 GPa, nu: 0.3}}\n"
                           "sections: {rod: {shape: round, diameter: 10 mm}}\n"
                           "nodes: {A: [0 mm, 0 mm, 0 mm], B: [1000 mm, 0 mm, 0 mm]}\n"
                           "members: {m: {from: A, to: B, section: rod, material: steel, elements: "
                        << elements << "}}\nsupports: {A: clamped}\nloads: {down: {nodes: {B: {fz: -1 N}}}}\n";
    const test::Run run = timely("frame '" + file + "' --json '" + result + "'");
    ASSERT_EQ(run.code, 0) << run.out;
    const bool warned = run.out.find("digit") != std::string::npos || run.out.find("condition") != std::string::npos;
    const double off = std::abs(sinking(result, "B") / right - 1);
    EXPECT_TRUE(off < 1e-6 || warned) << elements << " elements: " << off << "\n" << run.out;
  }
}

/// The largest force or moment at the end of the member "inner" of a rigid body that hangs on jelly: 100 N turn it.
double force_within_a_rigid_body(const std::string& inner, const std::string& nodes) {
  const std::string yaml =
      "name: body\nmaterials: {steel: {E: 210 GPa, nu: 0.3}, jelly: {E: 0.21 Pa, nu: 0.3}}\n"
      "sections: {rod: {shape: round, diameter: 200 mm}}\n"
      "nodes: {A: [0 mm, 0 mm, 0 mm], B: [1000.1 mm, -400.37 mm, 300.13 mm], C: [0 mm, 2000 mm, 1000 mm],\n"
      "        D: [-177.7 mm, 234.1 mm, 777.77 mm]}\n"
      "members:\n  inner: {section: rod, material: steel, " +
      inner +
      "}\n  outer: {from: A, to: C, section: rod, material: jelly}\n"
      "supports: {C: pinned}\nsprings: {s: {node: B, ux: 500 N/mm, rx: 1e13 Nmm/rad, rz: 1e13 Nmm/rad}}\n"
      "rigid_links: {body: {master: A, nodes: " +
      nodes + "}}\nloads: {turn: {nodes: {B: {fx: 100 N, mx: 500 Nm, my: -200 Nm}}}}\n";
  const frame::FrameResult result = frame::analyse(frame::parse_frame(yaml, "body"));
  EXPECT_EQ(frame::failed_check(result), "");
  return result.cases.at(0).members.at(0).end.cwiseAbs().maxCoeff();
}

// The body turns by 1e8, and the member, which is held to the ground against idly spinning, as far within it: about an
// axis with a rounding error of 1e-16 that made 0.28 N, where it carries nothing.
TEST(ExtremeCases, AMemberThatSpinsIdlyInARigidBodyCarriesNothing) {
  EXPECT_LT(force_within_a_rigid_body("from: A, to: B, release_from: rx, release_to: rx", "[B, D]"), 1e-9);
}

// The arms A to B, A to D and D to B do not add up in doubles: 4 N of 0.
TEST(ExtremeCases, AMemberBetweenNodesOfARigidBodyCarriesNothing) {
  EXPECT_LT(force_within_a_rigid_body("from: D, to: B", "[B, D]"), 1e-9);
}

/// Two hinged bars of half span b that rise by h: P(w) = 2 EA (L − l)/L · (h − w)/l, l² = b² + (h − w)² (R. von Mises,
/// 1923).
struct FlatArch {
  double b = 1000, h = 20, EA = 210e3 * 100;  // N, mm

  double force(double w) const {
    const double L = std::hypot(b, h), l = std::hypot(b, h - w);
    return 2 * EA * (L - l) / L * (h - w) / l;
  }
  double limit() const {
    double low = 0, high = h;
    for (int i = 0; i < 200; ++i) {
      const double third = (high - low) / 3;
      if (force(low + third) < force(high - third))
        low += third;
      else
        high -= third;
    }
    return force(low);
  }
  double snapped(double P) const {
    double low = 2 * h, high = 20 * h;
    for (int i = 0; i < 200; ++i) (force((low + high) / 2) < P ? low : high) = (low + high) / 2;
    return low;
  }
};

// Above the limit the arch jumps; whatever the program does there it does at 1.0001 times the limit as at 3 times.
TEST(ExtremeCases, AFlatArchBeyondItsLimitLoadIsTreatedAlikeAtEveryLoad) {
  const FlatArch arch;
  std::set<int> codes;
  for (const double factor : {1.0001, 1.01, 1.5, 3.0}) {
    const Folder folder;
    const std::string file = (folder / "frame.yaml").string(), result = (folder / "result.json").string();
    std::ofstream(file) << "name: arch\ngeometry: finite\nload_steps: 10\n"
                           "materials: {steel: {E: 210 GPa, nu: 0.3}}\n"
                           "sections: {bar: {shape: given, A: 100 mm^2, Iy: 1e6 mm^4, Iz: 1e6 mm^4, J: 1e6 mm^4}}\n"
                           "nodes: {a: [-1000 mm, 0 mm, 0 mm], top: [0 mm, 0 mm, 20 mm], b: [1000 mm, 0 mm, 0 mm]}\n"
                           "members:\n"
                           "  left: {from: a, to: top, section: bar, material: steel, release_to: [rz]}\n"
                           "  right: {from: top, to: b, section: bar, material: steel, release_from: [rz]}\n"
                           "supports: {a: [ux, uy, uz, rx, rz], b: [ux, uy, uz, rx, rz], top: [uy, rx, ry, rz]}\n"
                        << fmt::format("loads: {{down: {{nodes: {{top: {{fz: {:.17g} N}}}}}}}}\n",
                                       -factor * arch.limit());
    const test::Run run = timely("frame '" + file + "' --json '" + result + "'");
    codes.insert(run.code);
    EXPECT_NE(run.out.find("snap"), std::string::npos) << "at " << factor << "\n" << run.out;
    if (run.code != 0) continue;
    EXPECT_NEAR(sinking(result, "top"), -arch.snapped(factor * arch.limit()), 1e-4);
  }
  EXPECT_EQ(codes.size(), 1u);
}

class MistakenMatrix : public ::testing::Test {
 protected:
  /// What `check` prints of it.
  std::string checked(const Matrix6& K) {
    std::ofstream(folder_ / "K.csv") << test::printed(K, 6);
    return timely("check '" + (folder_ / "K.csv").string() + "'").out;
  }

 private:
  Folder folder_;
};

TEST_F(MistakenMatrix, SwappedRowsAreNamed) {
  std::mt19937 random(1);
  Matrix6 K = test::random_stiffness(random);
  K.row(0).swap(K.row(1));
  const std::string said = checked(K);
  EXPECT_TRUE(std::regex_search(said, std::regex("rows? .*(swapped|exchanged)|(swapped|exchanged).* rows?"))) << said;
}

TEST_F(MistakenMatrix, ReversedSignsOfMomentsAreNamed) {
  std::mt19937 random(1);
  Matrix6 K = test::random_stiffness(random);
  K.bottomRows<3>() *= -1;
  const std::string said = checked(K);
  EXPECT_TRUE(std::regex_search(said, std::regex("sign.* moments?|moments?.* sign"))) << said;
}

}  // namespace
}  // namespace deflect::attack
