// A part that lets go: play as wide as the motion, a spring that has run to nothing and a contact that yields without
// end say the same, and are found from there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/bar.h"
#include "tests/support/effects.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/diagnosis/interval.h"
#include "validation/diagnosis/signatures.h"
#include "validation/effects/place_effects.h"
#include "validation/report/diagnosis_results.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;
using measurement::Measurements;
using subject::Subject;

constexpr double length = 1, load = 400, EI = 210e9 * 0.02 * 0.02 * 0.02 * 0.02 / 12;
constexpr double way = 1e3 * load * length * length * length / (48 * EI);  // of the bar's middle without its pad, mm

const Subject& bar() {
  static const Subject s = test::bar_on_a_pad("modulus: 0.1 %, load: 0.1 %, spring.uz.stiffness: 1 %");
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

// Nothing is searched for where the part that is gone leaves more than `most`.
TEST(LetsGo, AsMuchAsIsAllowedMayBeLeft) {
  const Seen s = seen("factor@spring.pad.uz", 0.8);
  const Hypothesis h = {{&law("clearance@spring.pad.uz"), {}}};
  const double high = h.back().effect->parameters.front().high;
  const double gone =
      s.observations.whitened_residual(with_effect(bar(), {h.back(), test::values({high})})).squaredNorm();
  ASSERT_GT(gone, 100);
  EXPECT_TRUE(best_size_of_what_lets_go(s.observations, h, VectorX(0), 1.001 * gone));
  EXPECT_FALSE(best_size_of_what_lets_go(s.observations, h, VectorX(0), 0.999 * gone));
}

// Play of 0.7 of the way, which is closed under the largest loads only. A pad that has run to nothing explains more
// than half of what is seen, and no other fit does more: the play is found from there, as wide as it is.
TEST(LetsGo, WidePlayIsFoundFromThePartThatIsGone) {
  const Seen s = seen("clearance@spring.pad.uz", 0.7 * way);
  std::vector<Effect> at_the_pad;
  for (const Effect& e : laws())
    if (lets_go(e) && e.place->path == "springs.pad") at_the_pad.push_back(e);
  const std::vector<Signature> all = signatures(s.observations, at_the_pad, 1);
  const Fit null = fit_of_all(s.observations, {}, VectorX(0));
  const double gone =
      s.observations.whitened_residual(with_effect(bar(), {{&law("factor@spring.pad.uz"), {}}, test::values({1e-6})}))
          .squaredNorm();
  ASSERT_LT(gone, 0.5 * null.chi2);
  ASSERT_GT(gone, 0.1 * null.chi2);
  const std::vector<Candidate> found = Candidates(all, 1).beside(s.observations, {}, null, -1e6);
  const auto play = std::find_if(found.begin(), found.end(), [](const Candidate& c) {
    return c.added().effect->name == "clearance@spring.pad.uz";
  });
  ASSERT_TRUE(play != found.end() && play->fit.found);
  EXPECT_NEAR(play->fit.values(0), 0.7 * way, 0.01 * way);
  EXPECT_LT(play->fit.chi2, 1e-3 * null.chi2);
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

// A number stands in the JSON where there is no upper limit, the parameter's bound.
TEST(LetsGo, TheJsonSaysThatAnIntervalIsOpen) {
  Candidate play;
  play.hypothesis = {{&law("clearance@spring.pad.uz"), {}}};
  play.fit.found = true;
  play.fit.values = test::values({2 * way});
  play.fit.limits = {{way, INFINITY}};
  Diagnosis d;
  d.candidates = {play};
  const auto value = nlohmann::json::parse(report::diagnosis_json(d))["candidates"][0]["parameters"][0];
  EXPECT_EQ(value["high95"], law("clearance@spring.pad.uz").parameters.front().high);
  EXPECT_EQ(value["at_least"], true);
  d.candidates.front().fit.limits = {{way, 3 * way}};
  const auto closed = nlohmann::json::parse(report::diagnosis_json(d))["candidates"][0]["parameters"][0];
  EXPECT_EQ(closed["high95"], 3 * way);
  EXPECT_FALSE(closed.contains("at_least"));
}

}  // namespace
}  // namespace deflect
