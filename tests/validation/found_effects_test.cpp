// What a diagnosis found, read from its JSON.
#include "validation/diagnosis/found_effects.h"

#include <gtest/gtest.h>

#include "msa/base/error.h"

namespace deflect::diagnosis {
namespace {

/// With `found` and what stands beside it.
std::string result(const std::string& found, const std::string& beside = "") {
  return R"({"candidates": [{"effect": "a", "parameters": [{"name": "x", "value": 1}]}, {"effect": "b", "parameters": [{"name": "y", "value": 2}]}],
    "missing": ["a", "b"], "found": [)" +
         found + "]" + beside + "}";
}

TEST(FoundEffects, AreReadWithTheirLegsAndValues) {
  const FoundEffects f = parse_found_effects(
      result(
          R"({"effect": "a", "leg": 4, "parameters": [{"name": "x", "value": 3}]}, {"effect": "b", "site": "leg 2", "parameters": [{"name": "y", "value": 5}]})",
          R"(, "data": "readings.csv")"),
      "d.json");
  ASSERT_EQ(f.missing.size(), 2u);
  EXPECT_EQ(f.missing[0].effect, "a");
  EXPECT_EQ(f.missing[0].leg, 4);
  ASSERT_EQ(f.missing[0].parameters.size(), 1u);
  EXPECT_EQ(f.missing[0].parameters[0].second, 3);
  EXPECT_EQ(f.missing[1].leg, 2);
  EXPECT_EQ(f.missing[1].parameters[0].second, 5);
  EXPECT_EQ(f.data, "readings.csv");
  EXPECT_EQ(f.candidates.size(), 2u);
  EXPECT_TRUE(f.ties.empty());
}

TEST(FoundEffects, OfAllLegsHaveNoneAndAnOlderResultHasNoData) {
  const FoundEffects f = parse_found_effects(
      result(
          R"({"effect": "a", "site": "all legs", "parameters": [{"name": "x", "value": 3}]}, {"effect": "b", "parameters": [{"name": "y", "value": 5}]})"),
      "d.json");
  EXPECT_FALSE(f.missing[0].leg);
  EXPECT_FALSE(f.missing[1].leg);
  EXPECT_EQ(f.data, "");
}

TEST(FoundEffects, EachThatIsMissingHasItsEntry) {
  for (
      const char* found :
      {R"({"effect": "a", "parameters": [{"name": "x", "value": 3}]})",
       R"({"effect": "b", "parameters": [{"name": "x", "value": 3}]}, {"effect": "a", "parameters": [{"name": "y", "value": 5}]})",
       R"({"effect": "a", "leg": 0, "parameters": [{"name": "x", "value": 3}]}, {"effect": "b", "parameters": []})"})
    EXPECT_THROW(parse_found_effects(result(found), "d.json"), InputError) << found;
}

}  // namespace
}  // namespace deflect::diagnosis
