// The schema of device files is what the reader reads.
#include "msa/fields/schema.h"
#include "msa/mechanism/device_schema.h"

#include "msa/mechanism/device_file.h"
#include "msa/mechanism/law.h"
#include "tests/support/schema_routes.h"

namespace deflect {
namespace {

const SchemaField* field(const Schema& s, const std::string& path, const std::string& key) {
  for (const SchemaLevel& level : s.levels)
    for (const SchemaCase& c : level.cases)
      for (const SchemaField& f : c.fields)
        if (level.path == path && f.key == key) return &f;
  return nullptr;
}

class DeviceSchema : public ::testing::TestWithParam<const char*> {};

TEST_P(DeviceSchema, KnowsTheKeysThatTheReaderKnowsAndNoOthers) {
  const std::string family = GetParam();
  const std::string circles =
      ", base_radius: 2 mm, platform_radius: 1 mm, link_length: 3 mm, base_angle: 20 deg, platform_angle: 20 deg, "
      "slider_min: 1 mm, slider_max: 2 mm";
  std::map<std::string, std::string> prefix = {
      {"kinematics", "{family: " + family + (family == "6-psu" ? circles : "") + "}"},
      {"materials", "{NAME: {E: 1 GPa, nu: 0.3}}"},
      {"sections", "{NAME: {shape: round, diameter: 1 mm}}"}};
  if (family == "chains") prefix["leg"] = "{NAME: {offset: [1 mm, 1 mm, 1 mm]}}";
  test::SchemaRoutes routes(device_schema(family), prefix,
                            [](const std::string& document) { parse_mechanism(document, "file"); },
                            {{"disc", "{radius: 1 mm}"},
                             {"cylinder", "{radius: 1 mm, height: 1 mm}"},
                             {"polygon", "{corners: [{x: 0 mm, y: 0 mm}, {x: 1 mm, y: 0 mm}, {x: 0 mm, y: 1 mm}]}"},
                             {"corners", "[{x: 0 mm, y: 0 mm}, {x: 1 mm, y: 0 mm}, {x: 0 mm, y: 1 mm}]"}});
  EXPECT_GT(routes.compared(), family == "chains" ? 70 : 60);
}

INSTANTIATE_TEST_SUITE_P(Families, DeviceSchema, ::testing::ValuesIn(family_names),
                         [](const auto& p) { return std::string(p.param) == "chains" ? "Chains" : "SixPsu"; });

TEST(DeviceSchema, SaysTypeUnitDefaultAndOneLine) {
  const Schema s = device_schema("chains");
  const SchemaField* payload = field(s, "", "payload");
  ASSERT_TRUE(payload);
  EXPECT_EQ(payload->dimension, Dimension::mass);
  EXPECT_EQ(payload->otherwise, "0 kg");
  EXPECT_FALSE(payload->required);
  EXPECT_EQ(payload->about, "mass at the tool point");
  const SchemaField* geometry = field(s, "", "geometry");
  ASSERT_TRUE(geometry);
  EXPECT_EQ(geometry->words, (std::vector<std::string>{"linear", "second-order", "finite"}));
  for (const SchemaLevel& level : s.levels)
    for (const SchemaCase& c : level.cases)
      for (const SchemaField& f : c.fields) EXPECT_FALSE(f.about.empty()) << level.path << "." << f.key;
  // Names of materials are the file's, not the schema's.
  for (const SchemaLevel& level : s.levels)
    for (const SchemaCase& c : level.cases)
      for (const SchemaField& f : c.fields)
        EXPECT_EQ(std::find(f.words.begin(), f.words.end(), schema_name), f.words.end()) << f.key;
}

TEST(LawSchema, HasACaseForEachLawAndOnlyThoseThatTurnAboutAnAxis) {
  const auto laws = [](bool rotation) {
    std::set<std::string> out;
    const Schema schema = law_schema(rotation);
    for (const SchemaCase& c : schema.levels.front().cases)
      out.insert(c.choices.at("law").begin(), c.choices.at("law").end());
    return out;
  };
  EXPECT_EQ(laws(false), std::set<std::string>(std::begin(law_names), std::end(law_names)));
  std::set<std::string> about;
  for (const LawRow& law : law_rows)
    if (law.about) about.insert(law.name);
  EXPECT_EQ(laws(true), about);
}

TEST(DeviceSchema, TheDeviationOfASensorIsALengthOrAnAngle) {
  const Schema s = device_schema("chains");
  const SchemaField* sigma = field(s, "sensors.NAME", "sigma");
  ASSERT_TRUE(sigma);
  EXPECT_EQ(sigma->dimension, Dimension::length);
  EXPECT_EQ(sigma->or_dimension, Dimension::angle);
}

TEST(DeviceSchema, TheStartOfAFrictionIsANumberOrAWord) {
  bool any = false;
  for (const SchemaLevel& level : law_schema(true).levels)
    for (const SchemaCase& c : level.cases)
      for (const SchemaField& f : c.fields)
        if (f.key == "start") {
          any = true;
          EXPECT_EQ(f.kind, FieldKind::quantity);
          EXPECT_EQ(f.words, (std::vector<std::string>{"relaxed", "kept", "unknown"}));
        }
  EXPECT_TRUE(any);
}

}  // namespace
}  // namespace deflect
