// Results read back: what is none, or lacks what a page shows, is refused with the place.
#include "validation/result_files/result_file.h"

#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "validation/report/diagnosis_results.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace report;
using namespace result_files;

std::string refused(const std::string& text) {
  try {
    read_result(text, "file.json");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

Json good_diagnosis() {
  Diagnosis d;
  d.device = "arm";
  Json json = Json::parse(diagnosis_json(d));
  Json parameter, candidate;
  parameter["name"] = "factor";
  parameter["value"] = 0.9;
  parameter["low95"] = 0.8;
  parameter["high95"] = nullptr;
  candidate["effect"] = "modulus";
  candidate["site"] = "machine";
  for (const char* number : {"probability", "rmse_mm", "held_out_rmse_mm", "chi2_per_dof"}) candidate[number] = 0.5;
  candidate["parameters"] = Json::array();
  candidate["parameters"].push_back(parameter);
  json["candidates"].push_back(candidate);
  return json;
}

std::string changed(const std::string& pointer, const Json& value) {
  Json json = good_diagnosis();
  json[Json::json_pointer(pointer)] = value;
  return json.dump();
}

TEST(ResultFile, AResultIsKnownByItsMembers) {
  EXPECT_EQ(read_result(good_diagnosis().dump(), "file.json").kind, "diagnosis");
}

TEST(ResultFile, WhatIsNoResultIsRefusedWithThePlace) {
  const std::string good = good_diagnosis().dump(1);
  const struct {
    std::string text, says;
  } cases[] = {
      {"", "file.json:1: the file is empty"},
      {" \n\n", "file.json:1: the file is empty"},
      {good.substr(0, good.size() / 2), "not valid JSON"},
      {"{\n\"verdict\": \"effect\",\n\"candidates\": [1,,2]}", "file.json:3: not valid JSON"},
      {"{\"verdict\": NaN}", "file.json:1: not valid JSON"},
      {std::string("\x00\x01\xFF\xFE", 4), "file.json:1: not valid JSON"},
      {"\x89PNG\r\n\x1A\n", "file.json:1: not valid JSON"},
      {"[]", "not a result"},
      {"null", "not a result"},
      {"3", "not a result"},
      {"\"text\"", "not a result"},
      {"{}", "not a result"},
      {"{\"a\": 1e999}", "beyond what a double holds"},
      {std::string(200000, '['), "file.json:1: nested more than 32 deep"},
      {"{\"verdict\": \"effect\", \"candidates\": []}", "there is no member 'missing'"},
      {changed("/candidates/0/probability", "high"), "member 'candidates[0].probability' is \"high\", where a number"},
      {changed("/candidates/0/rmse_mm", nullptr), "member 'candidates[0].rmse_mm' is null, where a number"},
      {changed("/candidates/0/parameters", 3), "member 'candidates[0].parameters' is 3, where a list"},
      {changed("/candidates", Json::object()), "member 'candidates' is an object, where a list"},
      {changed("/missing", Json::array({1})), "member 'missing[0]' is 1, where a text"},
      {changed("/baseline", nullptr), "there is no member 'baseline.rmse_mm'"},
      {changed("/unexplained/significant", "no"), "member 'unexplained.significant' is \"no\", where true or false"},
      {changed("/found", Json::array({Json::object({{"effect", "modulus"}})})), "there is no member 'found[0].site'"},
  };
  for (const auto& c : cases) {
    const std::string said = refused(c.text);
    EXPECT_TRUE(said.starts_with("file.json:")) << c.text.substr(0, 200) << "\n" << said;
    EXPECT_NE(said.find(c.says), std::string::npos) << c.text.substr(0, 200) << "\n" << said;
  }
}

}  // namespace
}  // namespace deflect
