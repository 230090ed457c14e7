// Which effects stay named beside something unknown.
#include "validation/diagnosis/left_over.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/springs_apart.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/evidence.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;

/// A machine that turns on its base.
Mechanism on_a_turntable(const Mechanism& m) {
  return test::with(m, "base.rz", "{law: linear, stiffness: 1e6 Nmm/rad}", Edit::Action::append);
}

// Springs in the cables explain part of what a base that turns does. Beside something unknown they stay named, as long
// as nobody knows of a place where it may sit; a law at the base, which takes all that they take, leaves them none.
TEST(NamedBesideUnknown, NotWhatALawAtAnotherPlaceExplains) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const measurement::Measurements data =
      prediction::simulate(on_a_turntable(m), prediction::campaign("paper", m, 50, 15), {});
  const Observations o(m, data, {});
  const Hypothesis cables = {{&test::effect("cable_compliance"), {}}};
  const Fit fitted = fit_of_all(o, cables, start_values(*cables[0].effect));
  ASSERT_TRUE(fitted.found);
  const std::vector<Effect> entry = {*cables[0].effect}, places = place_effects(subject::Subject(m), {});
  std::vector<Effect> both = entry;
  for (const Effect& e : places)
    if (e.name.starts_with("linear@")) both.push_back(e);
  const auto named = [&](const std::vector<Effect>& known) {
    const Explanations all{signatures(o, known, 1)};
    const Candidates candidates(all.laws, 1);
    return named_beside_unknown(o.whitened_patterns(), all, candidates, {o, {all.laws[0].effect}, fitted, {}, {}})
        .effects.size();
  };
  EXPECT_EQ(named(entry), 1u);
  EXPECT_EQ(named(both), 0u);
}

// White noise that is 1.5 times as large as the file tells has no pattern, and its size is said. What tolerances can
// take of it is not counted as noise. Noise that is told right leaves nothing to say.
TEST(PatternLeft, NoiseLargerThanToldIsSaid) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  measurement::Measurements data = prediction::simulate(m, prediction::campaign("random", m, 50, 15), {});
  const std::string none = "no pattern that was looked for";
  EXPECT_EQ(pattern_left({Observations(m, data, {}), {}, {}, {}, {}}, {}, false), none);
  for (measurement::Reading& r : data.readings)
    for (std::optional<double>* sigma : {&r.sigma_u, &r.sigma_th})
      if (*sigma) **sigma /= 1.5;
  const std::string left = pattern_left({Observations(m, data, {}), {}, {}, {}, {}}, {}, false);
  ASSERT_TRUE(left.starts_with(none + "; noise ")) << left;
  EXPECT_NEAR(std::stod(left.substr(left.find("noise ") + 6)), 1.5, 0.15) << left;
}

// A contact in a joint lets it yield by |f|^(2/3), which no sum of a spring and play does. Where these two alone are
// known, any curve at the joint explains the readings to their noise, and the two laws leave χ² far outside its spread
// √(2n). No place is likelier; the start of the forearm, along the same direction, is as likely.
TEST(AtPlaces, AnyCurveIsMoreThanTheLawsOfAPlace) {
  const Mechanism m = test::device("arm");
  std::vector<Effect> known;
  std::optional<Effect> contact;
  for (const Effect& e : place_effects(subject::Subject(m), test::all_effects())) {
    if (e.name == "contact@joint_4.tx") contact = e;
    if (e.name.starts_with("linear@") || e.name.starts_with("clearance@")) known.push_back(e);
  }
  ASSERT_TRUE(contact);
  const measurement::Measurements data = prediction::simulate(
      with_effect(m, *contact, 1000 * start_values(*contact), {}), prediction::campaign("random", m, 50, 15), {});
  const Observations o(m, data, {});
  const Explanations all{signatures(o, known, 1)};
  const Fit null = fit_of_all(o, {}, VectorX(0));
  std::vector<MatrixX> laws;
  for (const Signature& s : all.laws)
    if (s.effect.effect->name.ends_with("@joint_4.tx")) laws.push_back(s.basis);
  ASSERT_EQ(laws.size(), 2u);
  const MatrixX span = statistics::orthonormal(statistics::side_by_side(laws, null.residual.size()));
  const std::vector<AtPlace> places = at_places(all, {}, null, 1);
  const auto likelier = [](const AtPlace& a, const AtPlace& b) { return a.log_odds() < b.log_odds(); };
  const double most = std::max_element(places.begin(), places.end(), likelier)->log_odds();
  const auto joint = std::find_if(places.begin(), places.end(),
                                  [](const AtPlace& p) { return subject::id_of(p.place()) == "joint_4.tx"; });
  const auto numbers = static_cast<double>(o.numbers());
  ASSERT_NE(joint, places.end());
  EXPECT_NEAR(joint->log_odds(), most, 1e-6);
  EXPECT_LT(null.chi2 - joint->most().gain, numbers + 3 * std::sqrt(2 * numbers));
  EXPECT_GT(null.chi2 - (span.transpose() * null.residual).squaredNorm(), numbers + 10 * std::sqrt(2 * numbers));
}

/// One member with a section of its own, a box of less than half the height.
Mechanism with_flat_fore_link(const Mechanism& m) {
  Mechanism out = m;
  out.sections.emplace_back("flat", *find(test::with(m, "sections.link.height_z", "30 mm").sections, "link"));
  return test::with(out, "leg.fore_link.member", "flat");
}

// The fore link of a scara is a box of less than half the height. It bends otherwise about its two axes and twists, for
// which there is no single law. Three effects explain the readings to their noise, of which two are at the screw and
// the elbow; an unknown law at the link does so too, as soon as tolerances are those of a machine with that link.
TEST(AtOnePlace, ASectionThatIsNotAsDescribedIsAtItsMember) {
  const Mechanism m = test::device("scara");
  prediction::SimulationOptions noise;
  noise.sigma_u = 1e-6;
  noise.seed = 3;
  const measurement::Measurements data =
      prediction::simulate(with_flat_fore_link(m), prediction::campaign("random", m, 50, 3), noise);
  std::vector<Effect> known = test::all_effects();
  for (Effect& e : place_effects(subject::Subject(m), test::all_effects())) known.push_back(std::move(e));
  const Diagnosis d = diagnose(subject::Subject(m), data, known);
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  ASSERT_FALSE(d.localised.empty());
  EXPECT_EQ(d.localised.front().place.part, "fore_link");
  EXPECT_GT(d.localised.front().probability, 0.95);
  for (const PlacedEffect& e : d.missing) EXPECT_EQ(e.effect->name, "factor@fore_link");
}

std::vector<Effect> all_but(const std::string& left_out, const Mechanism& m) {
  std::vector<Effect> known = test::all_effects();
  for (Effect& e : place_effects(subject::Subject(m), test::all_effects()))
    if (left_out.empty() || !e.name.starts_with(left_out)) known.push_back(std::move(e));
  return known;
}

measurement::Measurements measured_on(const Mechanism& m, const std::string& campaign) {
  prediction::SimulationOptions noise;
  noise.sigma_u = 1e-6;
  noise.seed = 3;
  return prediction::simulate(m, prediction::campaign(campaign, m, 50, 3), noise);
}

Mechanism with_knees_at_the_elbow(const Mechanism& m) {
  return test::with(m, "leg.elbow.rz",
                    "{law: table, points: [[0 Nm, 0 mrad], [2 Nm, 0.05 mrad], [3 Nm, 0.3 mrad], [6 Nm, 0.5 mrad], "
                    "[20 Nm, 1 mrad]]}");
}

// A measured curve with two knees at the elbow of a scara. What the quill's screw and its wrist yield sideways moves
// the tool as the elbow's turn does, since the fore link between them has one length: the three places cannot be told
// apart, and nothing else explains as much. A sum of powers of the force leaves a tenth of it, a line with six bends in
// each sense a hundredth, one with bends where the readings ask for them no more than noise.
TEST(AtOnePlace, ACurveWithKneesIsWhereItActsOrDoesTheSame) {
  const Mechanism m = test::device("scara");
  const measurement::Measurements data = measured_on(with_knees_at_the_elbow(m), "random");
  const Observations o(m, data, {});
  const std::vector<Effect> known = all_but("", m);
  const SignaturesAtPlaces all(o, known, 2);
  const Fit null = fit_of_all(o, {}, VectorX(0));
  const std::vector<Localised> found =
      localised(at_places(all.known(), {}, null, 2), null.chi2, static_cast<double>(o.numbers()));
  ASSERT_EQ(found.size(), 3u);
  std::set<std::string> places;
  for (const Localised& l : found) {
    places.insert(subject::id_of(l.place));
    EXPECT_NEAR(l.probability, 1.0 / 3, 0.02) << l.what;
    EXPECT_GT(l.share, 0.999) << l.what;
  }
  EXPECT_EQ(places, (std::set<std::string>{"elbow.rz", "screw.ty", "wrist.ty"}));
  EXPECT_TRUE(
      pattern_left({o, {}, null, {}, {}}, found, false).starts_with("an unknown law at one place takes 100 % of it: "));
}

// A curve with three knees in every motor of a Delta. A line that bends at six sizes of the torque leaves four times
// the noise, so that a load cell of half the gain beside a spring that stiffens seems to explain as much; a line that
// bends where the readings ask for it leaves none. What the motors turn, the arms' ends move sideways by one length.
TEST(AtOnePlace, WhatIsElsewhereIsNotNamedBesideACurveWithKneesInEveryLeg) {
  const Mechanism m = test::device("delta");
  const Mechanism real = test::with(m, "leg.motor.rz",
                                    "{law: table, points: [[0 Nm, 0 mrad], [1 Nm, 0.02 mrad], [1.5 Nm, 0.2 mrad], "
                                    "[4 Nm, 0.4 mrad], [20 Nm, 1 mrad]]}");
  const measurement::Measurements data = measured_on(real, "random");
  const Observations o(m, data, {});
  const std::vector<Effect> known = all_but("", m);
  const SignaturesAtPlaces signatures(o, known, 2);
  const Candidates candidates(signatures.all(), 2);
  const Hypothesis two = {{&find_effect(known, "hardening@motor.rz"), {}}, {&find_effect(known, "load_gain"), {}}};
  const Selection found{o, two, fit_of_all(o, two, test::values({3.6e6, 2.7e-4, 0.5})), {}, {}};
  ASSERT_TRUE(found.fit.found);
  const ByPlaces laws = by_places(signatures.known(), found, 2);
  // Beside several fits at once they are what they are beside each.
  EXPECT_EQ(log_evidence(laws.alone), log_evidence(at_places(signatures.known(), {}, laws.null, 2)));
  EXPECT_EQ(log_evidence(laws.beside), log_evidence(at_places(signatures.known(), two, found.fit, 2)));
  EXPECT_TRUE(is_all_at_one_place(laws, candidates, found));
  const std::optional<AllAtOnePlace> at = at_one_place(laws, candidates, found, clearly_one_place);
  ASSERT_TRUE(at);
  ASSERT_EQ(at->there.effects.size(), 1u);
  EXPECT_EQ(at->there.effects.front().effect->name, "hardening@motor.rz");
  std::set<std::string> places;
  for (const Localised& l : at->instead.instead) {
    places.insert(subject::id_of(l.place));
    EXPECT_NEAR(l.probability, 0.5, 0.1) << l.what;
  }
  EXPECT_EQ(places, (std::set<std::string>{"arm.end.tz", "motor.rz"}));
}

// In 27 readings two laws of the elbow explain nearly as much as the curve. They are not all there is, and the
// probability of something unknown is that of the curve against the two.
TEST(AtOnePlace, ACurveInFewReadingsIsNotSurelyTwoLaws) {
  const Mechanism m = test::device("scara");
  const std::vector<Effect> known = all_but("", m);
  const Diagnosis d = diagnose(m, measured_on(with_knees_at_the_elbow(m), "paper"), known);
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  EXPECT_GT(d.probability_unknown, 0.9);
  for (const PlacedEffect& e : d.missing) EXPECT_EQ(subject::id_of(*e.effect->place), "elbow.rz") << e.effect->name;
}

// A ball joint of leg 5 rubs, and friction there is not among the candidates. That of other joints explains a part of
// it, but none is named: what holds the motion of one joint loads no other one alike.
TEST(AtOnePlace, FrictionThatNoLawDescribesIsAtItsJoint) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const Mechanism real = test::with(m, "leg[5].ball_joint.ry",
                                    "{law: friction, moment: 50 Nmm, stiffness: 1e6 Nmm/rad}", Edit::Action::append);
  const std::vector<Effect> known = all_but("friction@leg.ball_joint.ry", m);
  const Diagnosis d = diagnose(m, measured_on(real, "cycle"), known);
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  EXPECT_TRUE(d.missing.empty());
  ASSERT_FALSE(d.localised.empty());
  EXPECT_EQ(d.localised.front().what, "leg 5 ball_joint ry, where something rubs");
  EXPECT_GT(d.localised.front().probability, 0.9);
}

std::string cycloid_folder() { return test::source_dir() + "/validation/measurements/cycloid/"; }

/// Loads as in a record of a cycloidal actuator, readings of one whose drive has play.
measurement::Measurements of_an_actuator_with_play(const Mechanism& m) {
  const std::vector<Effect> every = all_but("", m);
  const subject::Subject hidden =
      with_effect(subject::Subject(m), {{&find_effect(every, "clearance@drive.rz"), {}}, test::values({5e-4})});
  prediction::SimulationOptions noise;
  noise.sigma_th = 6e-5;
  return prediction::simulate(*hidden.machine(),
                              measurement::read_measurements(cycloid_folder() + "baseline_play_initial.csv"), noise);
}

// An entry of the catalogue names no place; it is where all that it edits is.
TEST(AtOnePlace, AnEntryIsWhereItEdits) {
  const Mechanism m = read_mechanism(cycloid_folder() + "actuator.yaml");
  const measurement::Measurements data = of_an_actuator_with_play(m);
  const Observations o(m, data, {});
  const std::vector<Effect> known = all_but("clearance@", m);
  const SignaturesAtPlaces signatures(o, known, 2);
  const Candidates candidates(signatures.all(), 2);
  const Hypothesis two = {{&find_effect(known, "motor_compliance"), {}}, {&find_effect(known, "load_gain"), {}}};
  const Selection found{o, two, fit_of_all(o, two, test::values({1e6, 1.1})), {}, {}};
  const std::optional<AllAtOnePlace> at = at_one_place(by_places(signatures.known(), found, 2), candidates, found, 0);
  ASSERT_TRUE(at);
  ASSERT_EQ(at->there.effects.size(), 1u);
  EXPECT_EQ(at->there.effects.front().effect->name, "motor_compliance");
}

// Play of a gear that is not among the candidates. A spring that stiffens and friction that grows with the load add up
// to nearly the same; they are not named without saying that one unknown law there explains more.
TEST(AtOnePlace, LawsOfThePlaceThatImitateAnotherAreNotAllThereIs) {
  const Mechanism m = read_mechanism(cycloid_folder() + "actuator.yaml");
  const measurement::Measurements data = of_an_actuator_with_play(m);
  const std::vector<Effect> known = all_but("clearance@", m);
  const Diagnosis d = diagnose(subject::Subject(m), data, known);
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  EXPECT_EQ(d.pattern, "an unknown law at one place explains more than these do: drive rz");
  std::set<std::string> named;
  for (const PlacedEffect& e : d.missing) named.insert(e.effect->name);
  EXPECT_EQ(named, (std::set<std::string>{"hardening@drive.rz", "load_friction@drive.rz"}));
}

// What a law that is none of these does, a + b, is within the laws of one place. Four effects elsewhere add up to it
// too. By the definition the place has ln B(1600, 2), and each of the four its prior odds and ln B(400, 1).
TEST(AtOnePlace, StandsForEffectsThatAddUpToIt) {
  const auto axis = [](Eigen::Index i) { return VectorX::Unit(6, i); };
  const double r = std::sqrt(0.5);
  std::vector<Effect> known = {test::springs_apart::along("a", r * (axis(0) + axis(1))),
                               test::springs_apart::along("b", r * (axis(2) + axis(3)))};
  for (Effect& e : known) e.place.emplace().path = "part";
  for (int i = 0; i < 4; ++i) known.push_back(test::springs_apart::along(fmt::format("e{}", i), axis(i)));
  // Others, so that each is as rare before any reading as one of a catalogue is.
  for (int i = 0; i < 6; ++i)
    for (int k = i + 1; k < 6; ++k)
      known.push_back(test::springs_apart::along(fmt::format("e{}{}", i, k), r * (axis(i) - axis(k))));
  const test::springs_apart::Seen s = test::springs_apart::seen(20 * (axis(0) + axis(1) + axis(2) + axis(3)));
  const Explanations all{signatures(s.observations, known, 1)};
  ASSERT_EQ(all.laws.size(), 21u);
  const Candidates candidates(all.laws, 1);
  const auto found = [&](const std::vector<std::size_t>& which, const VectorX& values) {
    Hypothesis h;
    for (const std::size_t i : which) h.push_back({&known[i], {}});
    return Selection{s.observations, h, fit_of_all(s.observations, h, values), {}, {}};
  };
  double more = statistics::log_evidence(1600, 2, false);
  for (std::size_t i = 2; i < 6; ++i) more -= candidates.class_log_odds_of(all.laws[i].effect, 400);
  ASSERT_GT(more, 2);
  const Selection four = found({2, 3, 4, 5}, VectorX::Constant(4, 20));
  ASSERT_LT(four.fit.chi2, 0.1);
  const ByPlaces of_four = by_places(all, four, 1);
  EXPECT_FALSE(at_one_place(of_four, candidates, four, more + 0.1));
  const std::optional<AllAtOnePlace> at = at_one_place(of_four, candidates, four, more - 0.1);
  ASSERT_TRUE(at);
  EXPECT_FALSE(at->all_there);
  EXPECT_TRUE(at->there.effects.empty());
  EXPECT_NEAR(at->there.fit.chi2, 1600, 1);
  // So clear that no further effect is looked for, unless the law leaves more than noise: here 20² of six numbers.
  ASSERT_GT(more, clearly_one_place);
  EXPECT_TRUE(is_all_at_one_place(of_four, candidates, four));
  const test::springs_apart::Seen beside =
      test::springs_apart::seen(20 * (axis(0) + axis(1) + axis(2) + axis(3)) + 20 * axis(4));
  const Selection not_all{
      beside.observations, four.effects, fit_of_all(beside.observations, four.effects, four.fit.values), {}, {}};
  EXPECT_FALSE(is_all_at_one_place(by_places(all, not_all, 1), candidates, not_all));
  // An effect at the place itself stays.
  const Selection both = found({0, 4}, test::values({28, 20}));
  const std::optional<AllAtOnePlace> named = at_one_place(by_places(all, both, 1), candidates, both, 0);
  ASSERT_TRUE(named);
  ASSERT_EQ(named->there.effects.size(), 1u);
  EXPECT_EQ(named->there.effects[0].effect->name, "a");
  EXPECT_NEAR(named->there.fit.values(0), 20 / r, 0.1);
  // So does a single one, and the law is said beside it. It takes 800 of what that leaves, 864 in six numbers.
  const test::springs_apart::Seen more_left =
      test::springs_apart::seen(20 * (axis(0) + axis(1) + axis(2) + axis(3)) + 8 * axis(4));
  const Selection alone{more_left.observations,
                        {{&known[0], {}}},
                        fit_of_all(more_left.observations, {{&known[0], {}}}, VectorX::Constant(1, 28)),
                        {},
                        {}};
  const std::optional<AllAtOnePlace> beside_it = at_one_place(by_places(all, alone, 1), candidates, alone, 0);
  ASSERT_TRUE(beside_it && beside_it->all_there);
  EXPECT_EQ(beside_it->there.effects.size(), 1u);
  ASSERT_EQ(beside_it->instead.instead.size(), 1u);
  EXPECT_NEAR(beside_it->instead.instead.front().share, 800.0 / 858, 0.01);
}

}  // namespace
}  // namespace deflect
