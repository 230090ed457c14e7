// A theory is a value: one that no file of the program names goes through solve, validate and map, their tables, files
// and figures. It is wrong on purpose: everything 1 % softer than the closed form.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "tests/support/devices.h"
#include "validation/figures/fig10.h"
#include "validation/figures/fig11.h"
#include "validation/report/map_results.h"
#include "validation/report/solve_results.h"
#include "validation/report/validation_results.h"
#include "validation/result_files/result_file.h"
#include "validation/studies/map.h"
#include "validation/studies/solve.h"
#include "validation/studies/validate.h"
#include "validation/theories/agreement.h"

namespace deflect {
namespace {

using namespace figures;
using namespace report;
using namespace result_files;
using namespace studies;
using namespace theories;

constexpr double softer_by = 1.01;

class SofterAt final : public TheoryAt {
 public:
  explicit SofterAt(std::unique_ptr<TheoryAt> of) : of_(std::move(of)) {}

  void move_to(const Configuration& c) override { of_->move_to(c); }
  Answer answer(const Vector6& F, const Conditions& conditions) override {
    Answer a = of_->answer(F, conditions);
    a.displacement *= softer_by;
    a.stiffness /= softer_by;
    return a;
  }
  Prediction predict(const Vector6& F, const Conditions& conditions) override {
    Prediction p = of_->predict(F, conditions);
    p.displacement *= softer_by;
    return p;
  }
  void expect_many(bool warm) override { of_->expect_many(warm); }
  bool affine() const override { return of_->affine(); }
  Assembled assembled() override { return of_->assembled(); }

 private:
  std::unique_ptr<TheoryAt> of_;
};

Theory softer(double known_to) {
  Theory t;
  t.name = t.title = "softer";
  t.spoken = "the softer theory";
  t.legend = "Softer";
  t.caption = "a theory that is 1 % too soft";
  t.known_to = known_to;
  t.at = [](const Configuration& c, const TheoryOptions& o) {
    return std::make_unique<SofterAt>(theory("analytic").at(c, o));
  };
  return t;
}

Theories with(const Theory& third) {
  Theories all = all_theories();
  all.push_back(&third);
  return all;
}

const Mechanism& haptic() {
  static const Mechanism m = test::device("haptic-6psu");
  return m;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(ThirdTheory, ThatMustAgreeIsRefusedWithItsName) {
  const Theory third = softer(0);
  try {
    validate(haptic(), workspace_points(haptic()), 50, {}, {}, with(third));
    FAIL() << "a theory that is 1 % softer was taken";
  } catch (const NumericalError& e) {
    EXPECT_TRUE(has(e.what(), "the softer theory disagree")) << e.what();
  }
}

TEST(ThirdTheory, IsAColumnOfValidate) {
  const Theory third = softer(0.02);
  const Validation v = validate(haptic(), workspace_points(haptic()), 50, {}, {}, with(third));
  EXPECT_NEAR(v.max_relative_difference, 0.01, 2e-4);
  for (const ValidationRow& row : v.rows)
    EXPECT_NEAR(row.displacements[2](row.axis) / row.displacements[0](row.axis), softer_by, 1e-12);
  EXPECT_TRUE(has(validation_csv(v), "softer_ux_mm,"));
  EXPECT_TRUE(has(validation_table(v), "softer z"));
  EXPECT_TRUE(has(validation_table(v), "analytic, MSA and softer against each other"));
  const Json json = read_result(validation_json(v, {}), "third").json;
  EXPECT_EQ(json["theories"].size(), 3u);
  EXPECT_EQ(json["points"][0]["softer"].size(), 6u);
  const Figure figure = fig10(v);
  EXPECT_TRUE(has(figure.caption, "by a theory that is 1 % too soft"));
  EXPECT_TRUE(has(figure.body, "Z-Softer"));
  EXPECT_TRUE(has(figure.body, "analytic − others"));
}

TEST(ThirdTheory, IsInSolveAndMap) {
  const Theory third = softer(std::numeric_limits<double>::infinity());  // a witness that is told and never required
  const Stand at = stand(haptic(), workspace_points(haptic()).front().pose_mm_deg);
  const SolveResult r = solve(haptic(), at, 50 * Vector6::Unit(0), {}, Geometry::linear, with(third));
  EXPECT_NEAR(r.relative_difference, 0.01, 2e-4);
  EXPECT_EQ(read_result(solve_json(r), "third").json["softer"]["stiffness"].size(), 6u);
  EXPECT_EQ(nlohmann::json::parse(solve_json(r))["reference"], "msa");
  EXPECT_TRUE(has(solve_report(r), "the softer stiffness differs by at most 9.9e-03"));

  MapOptions o;
  o.grid = workspace_grid(haptic(), {2, 2, 1});
  o.length_mm = weighing_length_mm(haptic());
  o.theories = with(third);
  const StiffnessMap map = map_stiffness(haptic(), o);
  EXPECT_TRUE(has(map_csv(map), "softer_kxx_N_per_mm"));
  EXPECT_TRUE(has(map_report(map), "softer"));
  EXPECT_TRUE(has(map_vtu(map), "softer_isotropy"));
  EXPECT_TRUE(read_result(map_json(map), "third").json["arrays"].contains("softer"));
  for (const MapPose& p : map.poses)
    if (p.reached()) {
      EXPECT_NEAR(p.values[0].K_ii(0) / p.values[2].K_ii(0), softer_by, 1e-12);
    }
}

TEST(ThirdTheory, FitsReadItLikeTheOthers) {
  const Theory third = softer(0);
  const Configuration c = stand(haptic(), workspace_points(haptic()).front().pose_mm_deg).configuration;
  const auto machine = third.at(c, {});
  const Vector6 F = Vector6::Unit(1);
  EXPECT_EQ(machine->predict(F, {}).displacement,
            softer_by * theory("analytic").at(c, {})->predict(F, {}).displacement);
}

TEST(Theories, OneAloneHasNoDifference) {
  const Validation v = validate(haptic(), workspace_points(haptic()), 50, {}, {}, theories_named("msa"));
  EXPECT_FALSE(has(validation_table(v), "difference"));
  EXPECT_FALSE(has(validation_csv(v), "analytic_"));
  EXPECT_FALSE(read_result(validation_json(v, {}), "one").json.contains("max_relative_difference"));
  EXPECT_FALSE(has(fig10(v).caption, "Below"));
}

TEST(Theories, AreNamedByAList) {
  EXPECT_EQ(theories_named("").size(), 2u);
  EXPECT_EQ(theories_named("msa,analytic"), all_theories());
  EXPECT_EQ(theories_named("msa"), Theories{&theory("msa")});
  EXPECT_THROW(theories_named("msa,ansys"), InputError);
  EXPECT_THROW(theories_named("msa,"), InputError);
}

}  // namespace
}  // namespace deflect
