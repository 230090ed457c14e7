#include "msa/base/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "msa/base/error.h"
#include "msa/base/spatial.h"

namespace deflect {
namespace {

constexpr Dimension all[] = {Dimension::none,
                             Dimension::ratio,
                             Dimension::length,
                             Dimension::angle,
                             Dimension::area,
                             Dimension::second_moment,
                             Dimension::force,
                             Dimension::moment,
                             Dimension::stress,
                             Dimension::stiffness,
                             Dimension::rotational_stiffness,
                             Dimension::line_load,
                             Dimension::density,
                             Dimension::thermal_expansion,
                             Dimension::temperature,
                             Dimension::acceleration,
                             Dimension::mass,
                             Dimension::compliance,
                             Dimension::rotational_compliance};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

std::string refusal(std::string_view text, Dimension d) {
  try {
    parse_quantity(text, d);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Units, TextsGiveSI) {
  EXPECT_EQ(parse_quantity("125.5 mm", Dimension::length), 0.1255);
  EXPECT_EQ(parse_quantity("0.03 mm", Dimension::length), 0.03 / 1e3);
  EXPECT_EQ(parse_quantity("210 GPa", Dimension::stress), 210e9);
  EXPECT_EQ(parse_quantity("500 N/mm", Dimension::stiffness), 500e3);
  EXPECT_EQ(parse_quantity("1 %", Dimension::ratio), 0.01);
  EXPECT_EQ(parse_quantity("0.01", Dimension::ratio), 0.01);
  EXPECT_EQ(parse_quantity("180 deg", Dimension::angle), pi);
  EXPECT_EQ(parse_quantity("1 in", Dimension::length), 0.0254);
  EXPECT_EQ(parse_quantity("  +8mm ", Dimension::length), 0.008);
  EXPECT_EQ(parse_quantity("-1e-3 m", Dimension::length), -0.001);
  EXPECT_EQ(parse_quantity("010 mm", Dimension::length), 0.010);
}

// The micro sign and the Greek letter look alike.
TEST(Units, MicroIsReadInEachOfItsSigns) {
  for (const std::string micro : {"u", "\u00B5", "\u03BC"}) {
    EXPECT_EQ(parse_quantity("5 " + micro + "m", Dimension::length), 5e-6);
    EXPECT_EQ(parse_quantity("20 N/" + micro + "m", Dimension::stiffness), 20e6);
    EXPECT_EQ(parse_quantity("3" + micro + "m/m", Dimension::strain), 3e-6);
  }
  EXPECT_EQ(refusal("5 \u00B5N", Dimension::length).find("'5 \u00B5N' has the unknown unit '\u00B5N'"), 0u);
}

TEST(Units, EveryUnitOfADimensionMeasuresTheSame) {
  const std::pair<Dimension, std::vector<const char*>> same[] = {
      {Dimension::length, {"25.4 mm", "0.0254 m", "2.54 cm", "25400 um", "1 in", "0.083333333333333333 ft"}},
      {Dimension::angle, {"0.5 rad", "500 mrad", "5e5 urad", "28.64788975654116 deg"}},
      {Dimension::area, {"645.16 mm^2", "0.00064516 m^2", "1 in^2"}},
      {Dimension::second_moment, {"416231.4256 mm^4", "4.162314256e-7 m^4", "41.62314256 cm^4", "1 in^4"}},
      {Dimension::force, {"4448.2216152605 N", "4.4482216152605 kN", "1000 lbf", "1 kip"}},
      {Dimension::moment,
       {"112.98482902761670 Nmm", "0.11298482902761670 Nm", "1.1298482902761670e-4 kNm", "1 lbf*in", "1e-3 kip*in"}},
      {Dimension::stress,
       {"6.894757293168361e-6 GPa", "6.894757293168361e-3 MPa", "6894.757293168361 Pa", "6.894757293168361e-3 N/mm^2",
        "1 psi", "1e-3 ksi"}},
      {Dimension::stiffness,
       {"0.17512683524647636 N/mm", "175.12683524647636 N/m", "0.17512683524647636 kN/m", "1.7512683524647636e-4 kN/mm",
        "1.7512683524647636e-4 N/um", "1 lbf/in", "1e-3 kip/in"}},
      {Dimension::rotational_stiffness,
       {"112.98482902761670 Nmm/rad", "0.11298482902761670 Nm/rad", "1.1298482902761670e-4 kNm/rad", "1 lbf*in/rad",
        "1e-3 kip*in/rad"}},
      {Dimension::line_load,
       {"0.17512683524647636 N/mm", "175.12683524647636 N/m", "0.17512683524647636 kN/m", "1 lbf/in", "12 lbf/ft",
        "1e-3 kip/in", "12e-3 kip/ft"}},
      {Dimension::density, {"7850 kg/m^3", "7.85e-6 kg/mm^3", "7.85 g/cm^3"}},
      {Dimension::thermal_expansion, {"12e-6 1/K"}},
      {Dimension::temperature, {"20 K"}},
      {Dimension::acceleration, {"0.0254 m/s^2", "25.4 mm/s^2", "1 in/s^2"}},
  };
  for (const auto& [dimension, texts] : same) {
    EXPECT_EQ(texts.size(), units_of(dimension).size()) << describe(dimension) << ": a unit has no test";
    const double first = parse_quantity(texts.front(), dimension);
    for (const char* text : texts) EXPECT_NEAR(parse_quantity(text, dimension) / first, 1, 1e-15) << text;
  }
}

TEST(Units, PreferredUnitComesFirstAndIsWritten) {
  EXPECT_EQ(units_of(Dimension::length).front(), "mm");
  EXPECT_EQ(format_quantity(0.1255, Dimension::length), "125.5 mm");
  EXPECT_EQ(format_quantity(0.03 / 1e3, Dimension::length), "0.03 mm");
  EXPECT_EQ(format_quantity(210e9, Dimension::stress), "210 GPa");
  EXPECT_EQ(format_quantity(25 * pi / 180, Dimension::angle), "25 deg");
  EXPECT_EQ(format_quantity(0.01, Dimension::ratio), "0.01");
  EXPECT_EQ(format_quantity(1, Dimension::none), "1");
  EXPECT_EQ(format_quantity(0, Dimension::length), "0 mm");
}

TEST(Units, FormatAndParseAreInverseToTheLastBit) {
  std::mt19937_64 random(1);
  for (const Dimension d : all)
    for (int i = 0; i < 4000; ++i) {
      const double mantissa = 1 + static_cast<double>(random() >> 12) * 0x1p-52;
      const double value = std::ldexp(random() % 2 ? mantissa : -mantissa, static_cast<int>(random() % 160) - 80);
      const std::string text = format_quantity(value, d);
      if (d == Dimension::angle && std::abs(value) > largest_angle) {  // too few digits are left in it
        ASSERT_THROW((void)parse_quantity(text, d), InputError) << text;
        continue;
      }
      ASSERT_TRUE(same_bits(parse_quantity(text, d), value)) << text << " for " << value << ", " << describe(d);
    }
}

TEST(Units, FormatAndParseAreInverseAtTheEdgesOfDouble) {
  using limits = std::numeric_limits<double>;
  for (const Dimension d : all)
    for (const double value : {0.0, -0.0, 1.0, -1.0, limits::denorm_min(), limits::min(), limits::max(),
                               limits::lowest(), limits::epsilon(), 1e300, 1e-300}) {
      const std::string text = format_quantity(value, d);
      if (d == Dimension::angle && std::abs(value) > largest_angle) continue;
      EXPECT_TRUE(same_bits(parse_quantity(text, d), value)) << text << " for " << value << ", " << describe(d);
    }
}

TEST(Units, ShortDecimalsStayShort) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const std::string text = std::to_string(random() % 1000) + "." + std::to_string(1 + random() % 9);
    for (const auto& [d, unit] : {std::pair{Dimension::length, " mm"},
                                  {Dimension::angle, " deg"},
                                  {Dimension::stress, " GPa"},
                                  {Dimension::second_moment, " mm^4"}})
      ASSERT_EQ(format_quantity(parse_quantity(text + unit, d), d), text + unit);
  }
}

TEST(Units, WhatIsShortInAnotherUnitStaysInIt) {
  for (const auto& [text, d, written] : {std::tuple{"60 um", Dimension::length, "60 um"},
                                         {"3.3 um", Dimension::length, "3.3 um"},
                                         {"0.01 mrad", Dimension::angle, "10 urad"},
                                         {"0.1 rad", Dimension::angle, "0.1 rad"},
                                         {"100 lbf", Dimension::force, "100 lbf"}})
    EXPECT_EQ(format_quantity(parse_quantity(text, d), d), written);
  EXPECT_EQ(format_quantity(1.0 / 3, Dimension::length), "333.3333333333333 mm") << "no unit makes it short";
}

TEST(Units, WrongTextsAreRefusedWithTheUnitsThatFit) {
  const struct {
    const char* text;
    Dimension dimension;
    std::vector<const char*> says;
  } wrong[] = {
      {"8", Dimension::length, {"'8' has no unit", "'8 mm'"}},
      {"8 mn", Dimension::length, {"unknown unit 'mn'", "did you mean 'mm'"}},
      {"8 N", Dimension::length, {"a force", "a length is wanted", "mm, m, cm, um, in"}},
      {"8 mm mm", Dimension::length, {"unknown unit 'mm mm'"}},
      {"8 mm", Dimension::none, {"plain number"}},
      {"8 MM", Dimension::length, {"unknown unit 'MM'"}},
      {"", Dimension::length, {"not a length"}},
      {"mm", Dimension::length, {"not a length", "mm, m, cm, um, in"}},
      {".nan mm", Dimension::length, {"finite"}},
      {"nan mm", Dimension::length, {"finite"}},
      {"inf mm", Dimension::length, {"finite"}},
      {"1e400 mm", Dimension::length, {"finite"}},
      {"1e305 GPa", Dimension::stress, {"too large"}},
      {"+-8 mm", Dimension::length, {"finite"}},
      {"++8 mm", Dimension::length, {"finite"}},
      {"0x10 mm", Dimension::length, {"unknown unit 'x10 mm'"}},
      {"1,5 mm", Dimension::length, {"unknown unit ',5 mm'"}},
      {"8 N/m", Dimension::rotational_stiffness, {"moment per angle", "Nmm/rad"}},
  };
  for (const auto& [text, dimension, says] : wrong) {
    const std::string message = refusal(text, dimension);
    EXPECT_NE(message, "") << "'" << text << "' was read";
    for (const char* phrase : says) EXPECT_NE(message.find(phrase), message.npos) << message << "\n  lacks " << phrase;
  }
}

TEST(Units, SizesThatModelsTakeHaveLimits) {
  EXPECT_NO_THROW(require_usable_size(-1e6, Dimension::length, "-1000 km"));
  EXPECT_NO_THROW(require_usable_size(1e300, Dimension::stiffness, "1e300 N/m"));
  try {
    require_usable_size(-1e30, Dimension::length, "-1e30 m");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "'-1e30 m' is too large for a length: at most 1e+06 m");
  }
  EXPECT_THROW(require_usable_size(1e300, Dimension::force, "1e300 N"), InputError);
}

TEST(Units, NumbersSpanTheWholeText) {
  EXPECT_EQ(parse_number("-1.5e3"), -1500);
  EXPECT_EQ(parse_number(" 2 "), 2);
  for (const char* text : {"", "1 2", "1mm", "no", "0x10", "1e400", "inf", "--1"})
    EXPECT_THROW(parse_number(text), InputError) << text;
}

TEST(Units, NearestWordIsNearOrNone) {
  EXPECT_EQ(nearest("diametre", {"radius", "diameter", "length"}), "diameter");
  EXPECT_EQ(nearest("steal", {"steel", "aluminium"}), "steel");
  EXPECT_EQ(nearest("xyzzy", {"steel", "aluminium"}), "");
  EXPECT_EQ(nearest("steel", {}), "");
  EXPECT_EQ(nearest(std::string(200, 'a') + "b", {std::string(200, 'a')}), "");  // no name is as long
}

}  // namespace
}  // namespace deflect
