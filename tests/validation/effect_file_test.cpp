// Effect files: what is read, and what is refused in which words.
#include "validation/effects/effect_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "msa/base/error.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/parameter_unit.h"

namespace deflect {
namespace {

using namespace effects;

using test::effect_text;

std::string refusal(const std::string& text) {
  try {
    parse_effect(text, "pad.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "read without complaint";
}

TEST(EffectFile, EveryFieldIsRead) {
  const Effect e = parse_effect(effect_text() + "see: the drawing\n", "pad.yaml");
  EXPECT_EQ(e.name, "soft_pad");
  EXPECT_EQ(e.title, "A pad under the tool");
  EXPECT_EQ(e.scope, Scope::machine);
  ASSERT_EQ(e.parameters.size(), 1u);
  const EffectParameter& p = e.parameters[0];
  EXPECT_EQ(p.name, "stiffness_N_per_mm");
  EXPECT_EQ(p.unit, "N/mm");
  EXPECT_EQ(p.start, 500);
  EXPECT_EQ(p.low, 10);
  EXPECT_EQ(p.high, 1e5);
  EXPECT_TRUE(p.log);
  EXPECT_EQ(p.vanishes, std::numeric_limits<double>::infinity());
  EXPECT_EQ(p.about, "of the pad");
  ASSERT_EQ(e.edits.size(), 1u);
  EXPECT_EQ(e.edits[0].action, EffectEdit::Action::append);
  EXPECT_EQ(e.edits[0].paths, std::vector<std::string>{"tool.tz"});
  EXPECT_EQ(e.edits[0].line, 7);
  EXPECT_EQ(e.pages.cure, "Remove the pad.");
  EXPECT_EQ(e.see, "the drawing");
}

// Quotation marks, line ends and what YAML would take for something else come back as they were.
TEST(EffectFile, WhatIsWrittenReadsBack) {
  Effect e = parse_effect(effect_text(), "pad.yaml");
  e.title = "A \"pad\", {soft}: 3 mm # of rubber";
  e.parameters[0].about = "of the pad, C:\\pads";
  e.pages.machine = "First line.\nSecond line.";
  e.pages.data = "1e3";
  e.see = "the drawing: no. 7";
  const Effect read = parse_effect(write_effect(e), "written.yaml");
  EXPECT_EQ(read.name, e.name);
  EXPECT_EQ(read.title, e.title);
  EXPECT_EQ(read.parameters[0].about, e.parameters[0].about);
  EXPECT_EQ(read.pages.machine, e.pages.machine);
  EXPECT_EQ(read.pages.data, e.pages.data);
  EXPECT_EQ(read.see, e.see);
  EXPECT_EQ(read.edits[0].paths, e.edits[0].paths);
  EXPECT_EQ(read.edits[0].value, e.edits[0].value);
}

TEST(EffectFile, UnitsFollowFromNames) {
  EXPECT_EQ(unit_of_parameter("stiffness_N_per_mm"), "N/mm");
  EXPECT_EQ(unit_of_parameter("stiffness_Nmm_per_rad"), "Nmm/rad");
  EXPECT_EQ(unit_of_parameter("lateral_N_per_mm"), "N/mm");
  EXPECT_EQ(unit_of_parameter("alpha_per_K"), "1/K");
  EXPECT_EQ(unit_of_parameter("pull_mm_per_N"), "mm/N");
  EXPECT_EQ(unit_of_parameter("EA_N"), "N");
  EXPECT_EQ(unit_of_parameter("rx_rad"), "rad");
  EXPECT_EQ(unit_of_parameter("factor"), "");
  EXPECT_EQ(unit_of_parameter("coefficient_mm_per_N23"), "");
  EXPECT_EQ(printed_unit("coefficient_mm_per_N23"), "mm/N^(2/3)");
  EXPECT_EQ(unit_of_parameter("stiffness_N_mm"), std::nullopt);
  EXPECT_EQ(unit_of_parameter("stiffness_N_per_K"), std::nullopt);
}

struct Refused {
  const char *from, *to, *message;
};

class BadEffect : public ::testing::TestWithParam<Refused> {};

TEST_P(BadEffect, IsRefusedWithLineAndRemedy) {
  const std::string told = refusal(effect_text(GetParam().from, GetParam().to));
  EXPECT_TRUE(told.starts_with("pad.yaml:")) << told;
  EXPECT_NE(told.find(GetParam().message), std::string::npos) << told;
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 0) << told;
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadEffect,
    ::testing::Values(
        Refused{"scope:", "scop:", "pad.yaml:3: scop: unknown key, did you mean 'scope'?"},
        Refused{"scope: machine", "scope: machines",
                "pad.yaml:3: scope: unknown scope 'machines', did you mean 'machine'?"},
        Refused{"name: soft_pad", "name: soft pad", "pad.yaml:1: name: consists of letters, digits"},
        Refused{"title: A pad under the tool\n", "", "'title' is missing"},
        Refused{"  cure: Remove the pad.\n", "", "'cure' is missing (what to do about it)"},
        Refused{"low: 10,", "low: 1e6,",
                "pad.yaml:5: parameters.stiffness_N_per_mm.high: 100000 must be above low, 1000000"},
        Refused{"start: 500,", "start: 5,",
                "pad.yaml:5: parameters.stiffness_N_per_mm.start: 5 must lie between low, 10, and"},
        Refused{"low: 10,", "low: 0,", "low: 0 must be above 0 on a logarithmic scale"},
        Refused{"scale: log", "scale: lgo", "unknown scale 'lgo', did you mean 'log'?"},
        Refused{"vanishes: infinity", "vanishes: never", "vanishes: 'never'"},
        Refused{"vanishes: infinity", "vanishes: 500",
                "pad.yaml:5: parameters.stiffness_N_per_mm.start: 500 is where the effect is absent"},
        Refused{"start: 500,", "start: 500 N/mm,", "parameters.stiffness_N_per_mm.start"},
        Refused{"edits:", "  stiffness_N_per_mm: {}\nedits:",
                "pad.yaml:6: parameters.stiffness_N_per_mm: given twice, first on line 5"},
        Refused{"stiffness: $stiffness_N_per_mm", "stiffness: $stifness_N_per_mm",
                "pad.yaml:7: edits.0.append.stiffness: unknown parameter '$stifness_N_per_mm', did you mean "
                "'$stiffness_N_per_mm'?"},
        Refused{"stiffness: $stiffness_N_per_mm", "stiffness: 500 N/mm", "pad.yaml:6: edits: none uses the parameter"},
        Refused{"stiffness: $stiffness_N_per_mm", "stiffness: 2*$stiffness_N_per_mm",
                "a parameter stands alone or before a unit"},
        Refused{"stiffness: $stiffness_N_per_mm", "stiffness: $stiffness_N_per_mm Nmm/rad",
                "pad.yaml:7: edits.0.append.stiffness: '500 Nmm/rad' is a rotational stiffness"},
        Refused{"law: linear", "law: liner",
                "pad.yaml:7: edits.0.append.law: unknown law 'liner', did you mean 'linear'?"},
        Refused{"at: tool.tz", "at: tool.rz",
                "pad.yaml:7: edits.0.append.stiffness: '500 N/mm' is a stiffness (force per length)"},
        Refused{"at: tool.tz, append:", "at: tool.tz, apend:",
                "pad.yaml:7: edits.0.apend: unknown key, did you mean 'append'?"},
        Refused{"scope: machine", "scope: one leg", "'tool.tz' is not in a leg"},
        Refused{"  - {at: tool.tz, append: {law: linear, stiffness: $stiffness_N_per_mm}}\n", "  []\n",
                "edits: needs at least one"},
        Refused{"start: 500", "start: !ours 500", "has no !ours"}));

TEST(EffectFile, AParameterWithoutUnitIsRefusedWhereAUnitIsWanted) {
  std::string text = effect_text();
  for (std::size_t at; (at = text.find("stiffness_N_per_mm")) != std::string::npos;) text.replace(at, 18, "softness");
  const std::string told = refusal(text);
  EXPECT_TRUE(told.starts_with("pad.yaml:7: edits.0.append.stiffness: '500' ")) << told;
  EXPECT_NE(told.find("N/mm"), std::string::npos) << told;
}

TEST(EffectFile, AUnitThatIsNotKnownIsRefused) {
  std::string text = effect_text();
  for (std::size_t at; (at = text.find("N_per_mm")) != std::string::npos;) text.replace(at, 8, "N_per_K");
  EXPECT_NE(refusal(text).find("pad.yaml:5: parameters.stiffness_N_per_K: ends like a unit that is not known"),
            std::string::npos)
      << refusal(text);
}

TEST(EffectFile, OneNameOneEffect) {
  std::vector<Effect> all = test::all_effects();
  Effect own = parse_effect(effect_text("soft_pad", "modulus"), "pad.yaml");
  try {
    add_effect(all, own);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_TRUE(std::string(e.what()).starts_with("pad.yaml:1: name: there is an effect 'modulus' already ("))
        << e.what();
  }
  own.name = "soft_pad";
  add_effect(all, own);
  EXPECT_EQ(&find_effect(all, "soft_pad"), &all.back());
}

TEST(EffectFile, AnUnknownEffectIsToldTheNearest) {
  try {
    test::effect("guide_root_complience");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'guide_root_compliance'?"), std::string::npos) << e.what();
  }
}

TEST(EffectFile, AFolderThatIsNotThereIsToldSo) { EXPECT_THROW(catalogue("/no/such/folder"), InputError); }

TEST(EffectFile, AWrongPathIsToldWithItsLineWhenItMeetsADevice) {
  const Effect e = parse_effect(effect_text("at: tool.tz", "at: tol.tz"), "pad.yaml");
  const Mechanism m = test::device("haptic-6psu");
  try {
    with_effect(m, e, test::values({500}));
    FAIL();
  } catch (const InputError& error) {
    const std::string told = error.what();
    EXPECT_TRUE(told.starts_with("pad.yaml:7: edits.0: ")) << told;
    EXPECT_NE(told.find("tol: there is no 'tol', did you mean 'tool'?"), std::string::npos) << told;
  }
  EXPECT_TRUE(why_not(e, m)->starts_with("tol: there is no 'tol', did you mean 'tool'?")) << *why_not(e, m);
}

// The limit of a friction grows with the load in what it stands beside, so there must be something beside it.
TEST(EffectFile, FrictionByLoadStandsBesideALaw) {
  const auto with = [](const char* at) {
    return effect_text("{at: tool.tz, append: {law: linear, stiffness: $stiffness_N_per_mm}}",
                       fmt::format("{{at: {}, append: {{law: friction, force: 0 N, share: 0.3, stiffness: "
                                   "$stiffness_N_per_mm}}}}",
                                   at));
  };
  EXPECT_NO_THROW(parse_effect(with("leg.actuator.beside.tz"), "rubs.yaml"));
  EXPECT_THROW(parse_effect(with("leg.actuator.tz"), "rubs.yaml"), InputError);
}

}  // namespace
}  // namespace deflect
