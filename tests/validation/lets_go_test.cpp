// A part that lets go: play as wide as the motion, a spring that has run to nothing and a contact that yields without
// end say the same, and are found from there.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/diagnosis/interval.h"
#include "validation/diagnosis/signatures.h"
#include "validation/effects/place_effects.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;
using measurement::Measurements;
using subject::Subject;

constexpr double length = 1, load = 400, EI = 210e9 * 0.02 * 0.02 * 0.02 * 0.02 / 12;
constexpr double way = 1e3 * load * length * length * length / (48 * EI);  // of the bar's middle without its pad, mm

// A bar between two posts on an elastic pad at its middle.
const Subject& bar() {
  static const Subject s = frame::parse_frame(R"(
name: bar
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 20 mm, height_z: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [0.5 m, 0 m, 0 m], C: [1 m, 0 m, 0 m]}
members:
  left: {from: A, to: B, section: bar, material: steel, y_axis: [0, 1, 0]}
  right: {from: B, to: C, section: bar, material: steel, y_axis: [0, 1, 0]}
supports: {A: [ux, uz], C: [uz]}
springs: {pad: {node: B, uz: 200 N/mm}}
loads: {push: {nodes: {B: {fz: -400 N}}}}
sensors: {z: {node: B, direction: uz, sigma: 6 um}, turn: {node: A, direction: ry, sigma: 0.02 mrad}}
tolerances: {modulus: 0.1 %, load: 0.1 %, spring.uz.stiffness: 1 %}
)",
                                              "bar.yaml");
  return s;
}

const std::vector<Effect>& laws() {
  static const std::vector<Effect> all = place_effects(bar(), {});
  return all;
}

const Effect& law(const std::string& name) {
  for (const Effect& e : laws())
    if (e.name == name) return e;
  throw std::logic_error("no effect " + name);
}

/// Readings of the bar with that law, and all that is compared with them.
struct Seen {
  std::shared_ptr<const Measurements> data;  // to which the observations point
  Observations observations;
};

Seen seen(const char* name, double value) {
  const Subject truth = with_effect(bar(), {{&law(name), {}}, test::values({value})});
  const auto data = std::make_shared<const Measurements>(
      subject::simulate_frame(*truth.frame(), subject::frame_campaign("cycle", *bar().frame(), 1), {}));
  return {data, Observations(bar(), *data, {})};
}

TEST(LetsGo, LawsThatCanCarryNothing) {
  std::set<std::string> all;
  for (const Effect& e : laws())
    if (lets_go(e)) all.insert(e.name.substr(0, e.name.find('@')) + (e.place->path == "springs.pad" ? " pad" : ""));
  EXPECT_EQ(all, (std::set<std::string>{"linear", "clearance", "pull", "push", "factor pad", "clearance pad",
                                        "pull pad", "push pad"}));
  const auto placed = [](const char* name) { return PlacedEffect{&law(name), {}}; };
  EXPECT_TRUE(at_one_place(placed("clearance@spring.pad.uz"), placed("factor@spring.pad.uz")));
  EXPECT_FALSE(at_one_place(placed("clearance@spring.pad.uz"), placed("clearance@support.A.uz")));
}

// Where no reading moves the middle beyond the play, the pad carries nothing: the same as without a pad, for each
// width.
TEST(LetsGo, PlayAsWideAsTheMotionIsAPartThatIsGone) {
  const Seen s = seen("clearance@spring.pad.uz", 2 * way);
  const auto residual = [&](const char* name, double value) {
    return s.observations.whitened_residual(with_effect(bar(), {{&law(name), {}}, test::values({value})}));
  };
  const VectorX gone = residual("factor@spring.pad.uz", 1e-6);
  const double size = (gone - s.observations.null_residual()).norm();
  for (const double times : {1.001, 2.0, 10.0})
    EXPECT_LT((residual("clearance@spring.pad.uz", times * way) - gone).norm(), 1e-5 * size) << times;
  EXPECT_GT((residual("clearance@spring.pad.uz", 0.99 * way) - gone).norm(), 1e-3 * size);
}

// From a little play χ² does not lead there.
TEST(LetsGo, TheSizeFromWhichItCarriesNothingIsFound) {
  const Seen s = seen("factor@spring.pad.uz", 1e-5);
  const Hypothesis h = {{&law("clearance@spring.pad.uz"), {}}};
  const double null = s.observations.null_residual().squaredNorm();
  const auto best = best_size_of_what_lets_go(s.observations, h, VectorX(0), 0.5 * null);
  ASSERT_TRUE(best);
  EXPECT_NEAR(best->value(0), way, 0.12 * way);
  EXPECT_LT(best->chi2, 1e-3 * null);
  const Seen stiff = seen("factor@spring.pad.uz", 0.8);
  EXPECT_FALSE(best_size_of_what_lets_go(stiff.observations, h, VectorX(0),
                                         0.5 * stiff.observations.null_residual().squaredNorm()));
}

// The limit below is where the middle would begin to touch in the readings of the largest load; there is none above.
TEST(LetsGo, TheIntervalOfWidePlayIsOpen) {
  const Seen s = seen("factor@spring.pad.uz", 1e-5);
  const Hypothesis h = {{&law("clearance@spring.pad.uz"), {}}};
  Fit f = fit(s.observations, h, {}, test::values({2 * way}));
  ASSERT_TRUE(f.found);
  EXPECT_TRUE(says_nothing_of_last(f));
  f = with_intervals(s.observations, h, std::move(f), 1);
  EXPECT_EQ(f.limits.front().second, INFINITY);
  EXPECT_LT(f.limits.front().first, 1.001 * way);
  EXPECT_GT(f.limits.front().first, 0.97 * way);
}

}  // namespace
}  // namespace deflect
