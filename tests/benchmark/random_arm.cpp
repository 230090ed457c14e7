#include "tests/benchmark/random_arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "msa/base/outcome.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/stand.h"
#include "validation/measurement/random.h"
#include "validation/studies/workspace.h"

namespace deflect::benchmark {
namespace {

/// A joint with an elastic drive: Nm/rad of a reducer of this size, and of its bearings where they yield.
std::string joint(int number, const std::string& axis, double home_deg, double stiffness, bool bearings) {
  std::string out = fmt::format(
      "  joint_{0}:\n    joint: motor\n    axis: {1}\n    home: {{rz: {2:.0f} deg}}\n"
      "    rz: {{law: linear, stiffness: {3:.4g} Nm/rad}}\n",
      number, axis, home_deg, stiffness);
  if (bearings)
    for (const char* about : {"rx", "ry"})
      out += fmt::format("    {}: {{law: linear, stiffness: {:.4g} Nm/rad}}\n", about, 5 * stiffness);
  return out;
}

Mechanism drawn_arm(measurement::Random& random) {
  const auto between = [&](double low, double high) { return random.uniform(low, high); };
  const auto sign = [&] { return random.uniform(0, 1) < 0.5 ? -1 : 1; };
  const bool steel = random.uniform(0, 1) < 0.5;
  std::string sections, leg;
  double stiffness = std::pow(10, between(4, 5.3)), diameter = between(90, 200);
  int joints = 0, members = 0;
  const auto add_joint = [&](const char* axis, double home_deg) {
    leg += joint(++joints, axis, home_deg, stiffness, random.uniform(0, 3) < 1);
    stiffness *= between(0.4, 0.9);
  };
  const auto add_member = [&](double x, double y, double z) {
    sections += fmt::format("  tube_{}: {{shape: tube, outer_diameter: {:.1f} mm, inner_diameter: {:.1f} mm}}\n",
                            ++members, diameter, between(0.88, 0.94) * diameter);
    leg +=
        fmt::format("  link_{0}: {{member: tube_{0}, material: metal, along: [{1:.0f} mm, {2:.0f} mm, {3:.0f} mm]}}\n",
                    members, x, y, z);
    diameter *= between(0.75, 0.95);
  };
  // Leans forwards, bends at the elbow, and points down with the wrist bent: no two axes of the wrist are in line.
  const double lean = between(10, 40), elbow = between(50, 95);
  add_joint(sign() > 0 ? "[0, 0, 1]" : "[0, 0, -1]", 0);
  add_member(0, 0, between(120, 350));
  add_joint("[0, 1, 0]", lean);
  add_member(0, 0, between(200, 700));
  add_joint("[0, 1, 0]", elbow);
  add_member(0, sign() * between(0, 60), between(200, 600));
  add_joint(sign() > 0 ? "[0, 0, 1]" : "[0, 0, -1]", between(-30, 30));
  add_joint(sign() > 0 ? "[0, 1, 0]" : "[1, 0, 0]", sign() * between(40, 80));
  add_member(0, 0, between(60, 140));
  add_joint("[0, 0, 1]", between(-60, 60));
  leg += fmt::format("  flange: {{offset: [{:.0f} mm, 0 mm, {:.0f} mm]}}\n", between(0, 80), between(40, 120));
  return parse_mechanism(fmt::format("name: random-arm\nabout: serial arm by the dice\nkinematics: {{family: chains}}\n"
                                     "materials:\n  metal: {{E: {} GPa, nu: 0.3}}\nsections:\n{}leg:\n{}"
                                     "workspace:\n  cube_edge: 150 mm\ntolerances:\n  modulus: 1 %\n  load: 0.3 %\n"
                                     "  section.outer_diameter: 0.1 %\n  drive.stiffness: 1 %\n",
                                     steel ? 206 : 70, sections, leg),
                         "random arm");
}

bool reaches(const Mechanism& m, const Vector6& pose_mm_deg) {
  return bool(outcome_of<ModelError>([&] { return configure(m, pose_from(pose_mm_deg)); }));
}

}  // namespace

Mechanism random_arm(std::uint64_t seed) {
  measurement::Random random(seed);
  while (true) {
    Mechanism m = drawn_arm(random);
    const std::vector<studies::ValidationPoint> points = studies::workspace_points(m);
    if (std::all_of(points.begin(), points.end(), [&](const auto& p) { return reaches(m, p.pose_mm_deg); })) return m;
  }
}

}  // namespace deflect::benchmark
