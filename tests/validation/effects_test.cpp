// The catalogue: every entry is as its contract says, can be put into the devices, and is absent where it vanishes.
#include <gtest/gtest.h>

#include <map>

#include "msa/base/outcome.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/numbers.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "tests/support/same_mechanism.h"
#include "validation/effects/edit_paths.h"
#include "validation/effects/place_effects.h"

namespace deflect {
namespace {

using namespace effects;

using test::all_effects;
using test::device;
using test::effect;
using test::some_leg;
using test::values;

const char* devices[] = {"haptic-6psu", "haptic-6psu-ideal-joints"};

TEST(Catalogue, HoldsTheNamesAndParametersThatOthersRelyOn) {
  const std::map<std::string, std::vector<std::string>> contract = {
      {"actuator_compliance", {"stiffness_N_per_mm"}},
      {"cable_compliance", {"EA_N"}},
      {"guide_root_compliance", {"stiffness_Nmm_per_rad"}},
      {"carriage_compliance", {"stiffness_N_per_mm"}},
      {"joint_compliance", {"stiffness_N_per_mm"}},
      {"leg_joint_compliance", {"stiffness_N_per_mm"}},
      {"hertz_contact", {"coefficient_mm_per_N23"}},
      {"joint_clearance", {"gap_mm"}},
      {"joint_friction", {"force_N", "stiffness_N_per_mm"}},
      {"platform_flexibility", {"stiffness_N_per_mm"}},
      {"base_tilt", {"stiffness_Nmm_per_rad"}},
      {"tool_compliance", {"lateral_N_per_mm", "axial_N_per_mm"}},
      {"leg_defect", {"factor"}},
      {"modulus", {"factor"}},
      {"guide_diameter", {"factor"}},
      {"self_weight", {"mass_kg"}},
      {"thermal_expansion", {"alpha_per_K"}},
      {"load_gain", {"factor"}},
      {"load_misalignment", {"rx_rad", "ry_rad", "rz_rad"}},
      {"sensor_misalignment", {"rx_rad", "ry_rad", "rz_rad"}},
      {"sensor_drift", {"x_mm", "y_mm", "z_mm"}},
      {"one_sided_actuation", {"pull_mm_per_N"}},
      {"geometric_nonlinearity", {}},
  };
  for (const auto& [name, parameters] : contract) {
    std::vector<std::string> there;
    for (const EffectParameter& p : effect(name).parameters)
      if (!p.optional) there.push_back(p.name);
    EXPECT_EQ(there, parameters) << name;
    const bool one_leg = name == "leg_joint_compliance" || name == "leg_defect";
    EXPECT_EQ(effect(name).scope == Scope::one_leg, one_leg) << name;
  }
}

TEST(Catalogue, EveryContractedEffectHasAPlaceInBothDevices) {
  for (const char* name : devices)
    for (const Effect& e : all_effects()) {
      const bool needs_contact = e.name == "joint_preload" && name == std::string(devices[1]);
      const bool expected = !needs_contact && e.name != "motor_compliance";
      EXPECT_EQ(!why_not(e, device(name)), expected)
          << e.name << " in " << name << ": " << why_not(e, device(name)).value_or("");
    }
}

TEST(Catalogue, EveryPageIsWrittenAndFileNamesAreNames) {
  for (const Effect& e : all_effects()) {
    for (const std::string* page : {&e.pages.machine, &e.pages.data, &e.pages.bench, &e.pages.cure})
      EXPECT_GT(page->size(), 40u) << e.name;
    EXPECT_TRUE(e.origin.ends_with("/" + e.name + ".yaml")) << e.origin;
    bool vanishes = e.parameters.empty();
    for (const EffectParameter& p : e.parameters) vanishes = vanishes || p.vanishes;
    EXPECT_TRUE(vanishes) << e.name;
  }
}

TEST(Catalogue, TheDeviceWithAnEffectIsAnotherThatReadsBackAndStands) {
  for (const char* name : devices)
    for (const Effect& e : all_effects()) {
      const Mechanism m = device(name);
      if (why_not(e, m)) continue;
      const Mechanism with = with_effect(m, e, start_values(e), some_leg(e));
      EXPECT_FALSE(with == m) << e.name;
      EXPECT_EQ(parse_mechanism(write_mechanism(with), "again"), with) << e.name;
      EXPECT_EQ(configure(with, test::home(with)).legs.size() % 6, 0u) << e.name;
    }
}

TEST(Catalogue, AtTheValueWhereItVanishesTheDeviceIsTheOldOne) {
  for (const char* name : devices)
    for (const Effect& e : all_effects()) {
      const Mechanism m = device(name);
      if (why_not(e, m) || e.parameters.empty()) continue;
      VectorX x = start_values(e);
      for (std::size_t i = 0; i < e.parameters.size(); ++i)
        if (e.parameters[i].vanishes) x(static_cast<Eigen::Index>(i)) = *e.parameters[i].vanishes;
      EXPECT_EQ(with_effect(m, e, x, some_leg(e)), m) << e.name;
    }
}

TEST(Catalogue, PlacesAreOneOrOnePerLeg) {
  const Mechanism m = device("haptic-6psu");
  EXPECT_EQ(places_of(effect("modulus"), m).size(), 1u);
  const std::vector<PlacedEffect> legs = places_of(effect("leg_defect"), m);
  ASSERT_EQ(legs.size(), 6u);
  EXPECT_EQ(site_of(legs[3]), "leg 4");
  EXPECT_EQ(site_of(places_of(effect("carriage_compliance"), m)[0]), "all legs");
  EXPECT_EQ(site_of(places_of(effect("load_gain"), m)[0]), "rig");
  EXPECT_TRUE(places_of(effect("leg_defect"), device("tripteron")).empty());
}

TEST(WithEffect, ActsOnTheLegThatIsAskedForOnly) {
  const Mechanism m = with_effect(device("haptic-6psu"), effect("leg_defect"), values({0.5}), 4);
  const auto factor = [&](int leg) { return std::get<Member>(*find(leg_parts(m, leg), "guideway")).bending_factor; };
  for (int leg = 1; leg <= 6; ++leg) EXPECT_EQ(factor(leg), leg == 4 ? 0.5 : 1) << leg;
}

TEST(WithEffect, TwoEffectsOnOneFreedomAreInSeries) {
  Mechanism m = with_effect(device("haptic-6psu"), effect("joint_compliance"), values({2000}));
  m = with_effect(m, effect("leg_joint_compliance"), values({3000}), 2);
  const auto laws = [&](int leg) { return std::get<Joint>(*find(leg_parts(m, leg), "ball_joint")).laws[2]; };
  EXPECT_EQ(laws(1).size(), 2u);
  ASSERT_EQ(laws(2).size(), 3u);
  EXPECT_EQ(std::get<LinearLaw>(laws(2)[2]).stiffness, 3e6);
}

TEST(WithEffect, AnEffectOfAllLegsReachesALegThatDiffers) {
  const Mechanism m = device("haptic-6psu");
  const Effect &one = effect("leg_joint_compliance"), &all = effect("joint_compliance");
  const auto last_two = [](const Mechanism& in) {
    const auto laws = std::get<Joint>(*find(leg_parts(in, 2), "ball_joint")).laws[2];
    EXPECT_EQ(laws.size(), 3u);
    return std::pair(std::get<LinearLaw>(laws.at(1)).stiffness, std::get<LinearLaw>(laws.at(2)).stiffness);
  };
  const Mechanism before = with_effect(with_effect(m, all, values({2000})), one, values({3000}), 2),
                  after = with_effect(with_effect(m, one, values({3000}), 2), all, values({2000}));
  EXPECT_EQ(last_two(before), std::pair(2e6, 3e6));
  EXPECT_EQ(last_two(after), std::pair(3e6, 2e6));
  EXPECT_EQ(std::get<Joint>(*find(leg_parts(after, 1), "ball_joint")).laws[2].size(), 2u);

  Effect thinner = effect("leg_defect");
  thinner.scope = Scope::all_legs;
  const Mechanism both = with_effect(with_effect(m, effect("leg_defect"), values({0.5}), 4), thinner, values({0.9}));
  const auto factor = [&](int leg) { return std::get<Member>(*find(leg_parts(both, leg), "guideway")).bending_factor; };
  EXPECT_EQ(factor(1), 0.9);
  EXPECT_EQ(factor(4), 0.45);
}

TEST(WithEffect, ALaterEditReachesIntoAnEarlierOne) {
  Effect e = effect("joint_compliance");
  e.edits[0].value = "{law: linear, stiffness: 100 N/mm}";
  e.edits.push_back({EffectEdit::Action::set, {"leg.ball_joint.tz.0.stiffness"}, "$stiffness_N_per_mm", 0});
  const Mechanism m = with_effect(device("haptic-6psu-ideal-joints"), e, values({2000}));
  EXPECT_EQ(std::get<LinearLaw>(std::get<Joint>(*find(m.leg, "ball_joint")).laws[2].at(0)).stiffness, 2e6);
}

TEST(WithEffect, EveryDriveOfEveryMakeIsFound) {
  const auto driven = [](const Mechanism& m, const char* e) {
    const Mechanism with = with_effect(m, effect(e), start_values(effect(e)));
    return numbers_of(with).size() - numbers_of(m).size();
  };
  EXPECT_EQ(driven(device("fanuc-r2000ic"), "motor_compliance"), 6u);  // one stiffness for each motor
  EXPECT_EQ(driven(device("delta"), "motor_compliance"), 1u);          // every leg has it
  EXPECT_EQ(driven(device("stewart-6ups"), "actuator_compliance"), 1u);
  EXPECT_TRUE(
      why_not(effect("actuator_compliance"), device("fanuc-r2000ic"))->ends_with("nothing is driven along a slide"));
}

TEST(WithEffect, DrivesOfMountsWithTheirOwnPartsAreFound) {
  const Mechanism m = parse_mechanism(R"(name: two
kinematics: {family: chains}
mounts:
  - leg: {slide: {joint: prismatic, home: {tz: 1 m}}, ball: {joint: ball}}
  - base: {shift: [1 m, 0 m, 0 m]}
    platform: {shift: [1 m, 0 m, 0 m]}
    leg: {ram: {joint: prismatic, home: {tz: 1 m}}, pin: {joint: ball}}
)",
                                      "two.yaml");
  const Effect& e = effect("actuator_compliance");
  const auto stiffness = [](const Mechanism& in, std::size_t mount) {
    const auto& laws = std::get<Joint>(in.mounts[mount].leg[0].second).laws[2];
    return laws.empty() ? 0 : std::get<LinearLaw>(laws[0]).stiffness;
  };
  const Mechanism with = with_effect(m, e, values({2000}));
  EXPECT_EQ(stiffness(with, 0), 2e6);
  EXPECT_EQ(stiffness(with, 1), 2e6);

  Effect one = e;
  one.scope = Scope::one_leg;
  const Mechanism second = with_effect(m, one, values({2000}), 2);
  EXPECT_EQ(stiffness(second, 0), 0);
  EXPECT_EQ(stiffness(second, 1), 2e6);
}

TEST(WithEffect, TheFirstPathThatTheDeviceHasIsTaken) {
  Effect e = effect("joint_compliance");
  e.edits[0].paths = {"leg.no_such_joint.tz", "leg.universal_joint.tz", "leg.ball_joint.tz"};
  const Mechanism m = with_effect(device("haptic-6psu-ideal-joints"), e, values({2000}));
  EXPECT_EQ(std::get<Joint>(*find(m.leg, "universal_joint")).laws[2].size(), 1u);
  EXPECT_TRUE(std::get<Joint>(*find(m.leg, "ball_joint")).laws[2].empty());
  e.edits[0].paths = {"leg.no_such_joint.tz", "leg.nor_this.tz"};
  EXPECT_TRUE(why_not(e, m)->starts_with("leg.no_such_joint: there is no 'no_such_joint'")) << *why_not(e, m);
}

TEST(WithEffect, ArgumentsThatDoNotFitAreRefused) {
  const Mechanism m = device("haptic-6psu");
  EXPECT_THROW(with_effect(m, effect("modulus"), values({})), InputError);
  EXPECT_THROW(with_effect(m, effect("modulus"), values({0.9}), 4), InputError);
  EXPECT_THROW(with_effect(m, effect("leg_defect"), values({0.9})), InputError);
  EXPECT_THROW(with_effect(m, effect("leg_defect"), values({0.9}), 7), InputError);
  EXPECT_THROW(with_effect(m, effect("joint_compliance"), values({-1})), InputError);
}

/// Numbers inserted with 17 digits come back; a product or a unit may round once.
void expect_equal(const Mechanism& a, const Mechanism& b, const std::string& what) {
  const std::vector<double> x = numbers_of(a), y = numbers_of(b);
  ASSERT_EQ(x.size(), y.size()) << what;
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 4e-16 * std::abs(y[i])) << what << " " << i;
}

TEST(PreparedEffects, GiveTheSameNumbersAsEdits) {
  for (const char* name : devices)
    for (const Effect& e : all_effects()) {
      const Mechanism m = device(name);
      if (why_not(e, m)) continue;
      const PreparedEffects prepared(m, {{&e, some_leg(e)}});
      VectorX x = start_values(e);
      expect_equal(prepared.machine(x), resolved(with_effect(m, e, x, some_leg(e))), e.name);
      for (std::size_t i = 0; i < e.parameters.size(); ++i)
        x(static_cast<Eigen::Index>(i)) += 0.3 * (e.parameters[i].high - e.parameters[i].start);
      expect_equal(prepared.machine(x), resolved(with_effect(m, e, x, some_leg(e))), e.name);
      for (std::size_t i = 0; i < e.parameters.size(); ++i)
        if (e.parameters[i].vanishes) x(static_cast<Eigen::Index>(i)) = *e.parameters[i].vanishes;
      if (!e.parameters.empty()) expect_equal(prepared.machine(x), resolved(m), e.name);
    }
}

TEST(PreparedEffects, HoldSeveralEffectsAtOnce) {
  const Mechanism m = device("haptic-6psu");
  const std::vector<PlacedEffect> all = {{&effect("modulus"), {}},
                                         {&effect("leg_defect"), 2},
                                         {&effect("leg_joint_compliance"), 2},
                                         {&effect("self_weight"), {}},
                                         {&effect("self_weight"), {}}};
  const PreparedEffects prepared(m, all);
  EXPECT_EQ(prepared.parameter_count(), 5);
  const VectorX x = values({0.93, 0.4, 700, 0.3, 0.2});
  Mechanism slow = m;
  for (std::size_t i = 0; i < all.size(); ++i)
    slow = with_effect(slow, *all[i].effect, x.segment(static_cast<Eigen::Index>(i), 1), all[i].leg);
  EXPECT_NEAR(slow.payload, 0.5, 1e-15);
  expect_equal(prepared.machine(x), resolved(slow), "five");
}

// A law of every leg at a joint, and beside it one of a leg alone at this joint and others: each number has its own
// parameter.
TEST(PreparedEffects, OfPlacesGiveTheSameNumbersAsEditsTwoByTwo) {
  for (const char* name : {"tripteron", "haptic-6psu", "delta", "arm"}) {
    const Mechanism m = device(name);
    std::vector<Effect> all = all_effects();
    for (Effect& e : place_effects(subject::Subject(m), all)) all.push_back(std::move(e));
    std::erase_if(all, [&](const Effect& e) { return why_not(e, m) || e.parameters.empty(); });
    const auto some = [&](std::size_t k) {
      const Effect& e = all[k % all.size()];
      return PlacedEffect{&e, e.scope == Scope::one_leg ? std::optional(1) : std::nullopt};
    };
    const auto beside_start = [](const Effect& e) {
      VectorX x = start_values(e);
      for (std::size_t i = 0; i < e.parameters.size(); ++i)
        x(static_cast<Eigen::Index>(i)) += 0.1 * (e.parameters[i].high - e.parameters[i].start);
      return x;
    };
    int compared = 0;
    for (std::size_t k = 0; k < 80; ++k) {
      const PlacedEffect first = some(37 * k), second = some(101 * k + 11);
      const VectorX a = beside_start(*first.effect), b = beside_start(*second.effect);
      const auto edited = outcome_of(
          [&] { return with_effect(with_effect(m, *first.effect, a, first.leg), *second.effect, b, second.leg); });
      if (!edited) continue;  // they do not go together
      VectorX both(a.size() + b.size());
      both << a, b;
      expect_equal(PreparedEffects(m, {first, second}).machine(both), resolved(*edited),
                   first.effect->name + " and " + second.effect->name);
      ++compared;
    }
    EXPECT_GT(compared, 20) << name;
  }
}

TEST(PreparedEffects, RefuseValuesThatTheDescriptionCannotHold) {
  const Mechanism m = device("tripteron");  // E and G are given: 1.2 E alone would make Poisson's ratio 0.65
  const Effect young = parse_effect(R"(
name: young_alone
title: E without G
scope: machine
parameters:
  factor: {start: 0.95, low: 0.3, high: 3, scale: log, vanishes: 1, about: true over stated}
edits:
  - {at: materials.*.E, multiply: $factor}
pages: {machine: a, data: b, bench: c, cure: d}
)",
                                    "young.yaml");
  const PreparedEffects prepared(m, {{&young, {}}});
  expect_equal(prepared.machine(values({0.9})), resolved(with_effect(m, young, values({0.9}))), "young");
  EXPECT_THROW(prepared(values({1.2})), InputError);
  EXPECT_THROW(prepared(values({-0.1})), InputError);
}

TEST(Catalogue, TheModulusIsBothModuliWhereBothAreGiven) {
  const Mechanism m = device("tripteron"), twice = with_effect(m, effect("modulus"), values({2}));
  for (std::size_t i = 0; i < m.materials.size(); ++i) {
    const Material &was = m.materials[i].second, &is = twice.materials[i].second;
    EXPECT_EQ(is.E, 2 * was.E);
    EXPECT_EQ(is.shear_modulus(), 2 * was.shear_modulus());
    EXPECT_EQ(is.poisson(), was.poisson());
  }
}

TEST(PreparedEffects, AreForModelsAndStandAtEveryPose) {
  const Mechanism m = device("haptic-6psu");
  const Mechanism with = PreparedEffects(m, {{&effect("leg_defect"), 4}}).machine(values({0.5}));
  const Configuration quick = configure(with, test::home(m)),
                      slow = configure(with_effect(m, effect("leg_defect"), values({0.5}), 4), test::home(m));
  for (std::size_t leg = 0; leg < 6; ++leg)
    EXPECT_EQ(std::get<PlacedMember>(quick.legs[leg].parts[1]).section.Iy,
              std::get<PlacedMember>(slow.legs[leg].parts[1]).section.Iy);
  EXPECT_THROW(write_mechanism(with), std::logic_error);
}

// An entry edits the actuator of all legs alike and, where one leg has an actuator of its own, that one by its number.
TEST(EditsOnly, APartInEveryLegThatHasIt) {
  const std::string file =
      test::contents(test::source_dir() + "/validation/devices/haptic-6psu-ideal-joints.yaml") +
      "\nvariations:\n  - {leg: 4, path: actuator, value: {joint: prismatic, at: A, axes: guide}}\n";
  const subject::Subject s(parse_mechanism(file, "varied.yaml"));
  const Effect e = find_effect(test::all_effects(), "actuator_compliance");
  const std::vector<std::string> paths = paths_of(e.edits.front(), s);
  ASSERT_NE(std::find(paths.begin(), paths.end(), "leg[4].actuator.tz"), paths.end());
  EXPECT_TRUE(edits_only(e, "leg.actuator", s));
  EXPECT_FALSE(edits_only(e, "leg.act", s));
  EXPECT_FALSE(edits_only(e, "leg.guideway", s));
}

/// A walk over the numbers of a description changes nothing else in it: not where a member begins.
TEST(NumberWalk, LeavesEverythingElse) {
  Mechanism m = parse_mechanism(R"(
name: arm
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 10 mm}}
leg:
  column: {member: rod, material: steel, along: [0 mm, 0 mm, 1 m], y_axis: [1, 0, 0]}
  head: {offset: [1 m, 0 mm, 0 mm]}
  strut: {member: rod, material: steel, from: {part: column, at: start}}
workspace: {cube_edge: 1 mm}
)",
                                "arm");
  const std::string before = write_mechanism(m);
  for_each_number(m, [](std::size_t, double&) {});
  EXPECT_EQ(write_mechanism(m), before);
}

}  // namespace
}  // namespace deflect
