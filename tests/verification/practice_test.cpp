// Measurement sets of foreign make with a hidden effect: with the effect and the parameters of their key the residual
// is noise and tolerances. Eight of them are in tests/practice; DEFLECT_PRACTICE names a folder with all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/support/devices.h"
#include "tests/support/paths.h"
#include "tests/support/practice.h"
#include "validation/compare/comparison.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"

namespace deflect {
namespace {

using namespace compare;
using namespace diagnosis;
using namespace effects;
using namespace measurement;
using namespace parallel;
using namespace statistics;
using namespace subject;

testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != text.npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in: " << text;
}

struct Hidden {
  std::string set;
  std::vector<std::string> effects;
  std::vector<double> values;  ///< of all effects; of p11, where the key says none, as diagnosed
  std::optional<int> leg = {};
};

void PrintTo(const Hidden& h, std::ostream* out) { *out << h.set; }

class Practice : public testing::TestWithParam<Hidden> {
 protected:
  void SetUp() override {
    const auto file = test::practice_set(GetParam().set);
    if (!file) GTEST_SKIP() << "only with DEFLECT_PRACTICE";
    file_ = *file;
  }
  std::filesystem::path file_;
};

Mechanism with_effects(const Hidden& h, const std::vector<double>& values) {
  static const std::vector<Effect> all = catalogue(test::source_dir() + "/validation/effects/catalogue");
  Mechanism m = test::with(test::device("haptic-6psu-ideal-joints"), "geometry", "finite");
  std::size_t next = 0;
  for (const std::string& name : h.effects) {
    const Effect& e = find_effect(all, name);
    VectorX v(static_cast<Eigen::Index>(e.parameters.size()));
    for (double& x : v) x = values.at(next++);
    m = with_effect(m, e, v, h.leg);
  }
  return m;
}

TEST_P(Practice, TheRightEffectLeavesNoiseAndTolerances) {
  const Hidden& h = GetParam();
  const Measurements data = read_measurements(file_);
  const Comparison c = compare::compare(with_effects(h, h.values), data);
  // χ² of n numbers scatters by √(2n); n is 800 to 2100 here.
  EXPECT_NEAR(c.chi2_per_dof, 1, 5 * std::sqrt(2 / static_cast<double>(c.numbers))) << testing::PrintToString(h.values);
  EXPECT_TRUE(c.findings.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Sets, Practice,
    testing::Values(Hidden{"p01", {"guide_root_compliance"}, {5e6}, {}}, Hidden{"p02", {"joint_clearance"}, {0.02}, {}},
                    Hidden{"p03", {"actuator_compliance"}, {500}, {}}, Hidden{"p04", {"base_tilt"}, {3e7}, {}},
                    Hidden{"p05", {"hertz_contact"}, {0.0025}, {}}, Hidden{"p06", {"leg_defect"}, {0.6}, 5},
                    Hidden{"p07", {"joint_friction"}, {2, 445, 0}, {}},
                    Hidden{"p11", {"platform_flexibility", "joint_compliance"}, {697, 1003}, {}},
                    Hidden{"p08", {}, {}, {}}, Hidden{"p09", {}, {}, {}}),
    [](const auto& sample) { return sample.param.set; });

// What compare says without having fitted anything.

struct Word {
  std::string set, pattern, words;
};
void PrintTo(const Word& w, std::ostream* out) { *out << w.set; }

class PracticeInWords : public testing::TestWithParam<Word> {};

TEST_P(PracticeInWords, CompareSaysWhatTheKeySays) {
  const auto& [set, pattern, words] = GetParam();
  const auto file = test::practice_set(set);
  if (!file) GTEST_SKIP() << "only with DEFLECT_PRACTICE";
  const Comparison c = compare::compare(test::device("haptic-6psu-ideal-joints"), read_measurements(*file));
  if (pattern.empty()) {
    EXPECT_TRUE(c.findings.empty());
    return;
  }
  ASSERT_FALSE(c.findings.empty());
  EXPECT_EQ(c.findings[0].pattern, pattern);
  EXPECT_TRUE(says(c.findings[0].sentence, words));
}

INSTANTIATE_TEST_SUITE_P(Sets, PracticeInWords,
                         testing::Values(Word{"p01", "elastic across slides", "to the 2.0"},
                                         Word{"p02", "step", "does not grow with the load"},
                                         Word{"p03", "elastic along slides", "an elastic compliance is missing"},
                                         Word{"p04", "base tilt", "the whole machine tilts"},
                                         Word{"p05", "power", "to the 0.67"},
                                         Word{"p06", "elastic at leg 5", "leg 5 alone"},
                                         Word{"p07", "hysteresis", "depends on the way"}, Word{"p08", "", ""},
                                         Word{"p09", "", ""}),
                         [](const auto& sample) { return sample.param.set; });

// What diagnose names: effects, "unknown" or nothing. Of p24 two entries are as likely, which is luck.

struct Answer {
  std::string set;
  std::vector<std::string> missing;
};
void PrintTo(const Answer& a, std::ostream* out) { *out << a.set; }

class PracticeDiagnosed : public testing::TestWithParam<Answer> {};

TEST_P(PracticeDiagnosed, TheKeyIsFound) {
  const auto& [set, missing] = GetParam();
  const auto file = test::practice_set(set);
  if (!file) GTEST_SKIP() << "only with DEFLECT_PRACTICE";
  const std::vector<Effect> all = catalogue(test::source_dir() + "/validation/effects/catalogue");
  const Diagnosis d = diagnose(test::device("haptic-6psu-ideal-joints"), read_measurements(*file), all);
  if (missing == std::vector<std::string>{"unknown"}) {
    EXPECT_EQ(d.verdict, Verdict::unknown_effect);
    return;
  }
  EXPECT_EQ(d.unexplained, false);
  EXPECT_EQ(d.verdict == Verdict::nothing_missing, missing.empty());
  std::vector<std::string> found;
  for (const PlacedEffect& e : d.missing) found.push_back(e.effect->name);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, missing);
}

INSTANTIATE_TEST_SUITE_P(
    Sets, PracticeDiagnosed,
    testing::Values(Answer{"p01", {"guide_root_compliance"}}, Answer{"p02", {"joint_clearance"}},
                    Answer{"p03", {"actuator_compliance"}}, Answer{"p04", {"base_tilt"}},
                    Answer{"p05", {"hertz_contact"}}, Answer{"p06", {"leg_defect"}}, Answer{"p07", {"joint_friction"}},
                    Answer{"p08", {}}, Answer{"p09", {}}, Answer{"p10", {"unknown"}},
                    Answer{"p11", {"joint_compliance", "platform_flexibility"}},
                    Answer{"p12", {"guide_root_compliance"}}, Answer{"p13", {"guide_root_compliance"}},
                    Answer{"p14", {"actuator_compliance"}}, Answer{"p15", {"actuator_compliance"}},
                    Answer{"p16", {"joint_clearance"}}, Answer{"p17", {"hertz_contact"}},
                    Answer{"p18", {"hertz_contact"}}, Answer{"p19", {"base_tilt"}}, Answer{"p20", {"leg_defect"}},
                    Answer{"p21", {"leg_defect"}}, Answer{"p22", {"sensor_misalignment"}},
                    Answer{"p23", {"platform_flexibility"}}, Answer{"p25", {"unknown"}}, Answer{"p26", {"unknown"}},
                    Answer{"p27", {}}, Answer{"p28", {}}, Answer{"p29", {}}, Answer{"p30", {}}, Answer{"p31", {}},
                    Answer{"p32", {}}),
    [](const auto& sample) { return sample.param.set; });

// The FANUC's six joint springs, by least squares over its 43 measured rows (validation/measurements): what the
// readings ask for beyond the published springs, joint by joint.
TEST(Fanuc, SixJointSpringsFitTheMeasurements) {
  const std::filesystem::path file = test::source_dir() + "/validation/measurements/fanuc-r2000ic.csv";
  const Mechanism m = test::device("fanuc-r2000ic");
  const Measurements data = read_measurements(file);
  const Comparison c = compare::compare(m, data);
  const ResidualStudy& s = c.study;
  const MatrixX G =
      rows_of(s.values,
              site_columns(s, [&](std::size_t i, std::size_t k) { return s.force[i](static_cast<Eigen::Index>(k)); }));
  const Uncertainty alike(PartedColumns(MatrixX(c.residual.size(), 0)), s.values,
                          std::vector<double>(s.values.size(), 1e-4), LoadErrors(0, s.predicted));
  const Regression more = regress(alike, c.residual, G);
  const double published[] = {9.3394e5, 4.1293e6, 1.9075e6, 2.3320e5, 4.0436e5, 7.9618e4};
  const double fitted[] = {8.609e5, 2.720e6, 1.960e6, 2.708e5, 4.247e5, 2.060e5};  // Nm/rad, four digits
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(1 / (1 / published[i] + more.amplitude(i)), fitted[i], 5e-4 * fitted[i]);
  const VectorX left = c.residual - G * more.amplitude;
  EXPECT_NEAR(left.norm() / std::sqrt(static_cast<double>(data.readings.size())), 0.372e-3, 0.5e-6);
}

/// Lost motion at zero torque of a loop 0 → + → − → 0, rad: between the branch that falls through zero and the ends of
/// the record, which lie on the rising one.
double lost_motion(const Measurements& data, const std::vector<double>& turn) {
  for (std::size_t i = 0; i + 1 < turn.size(); ++i) {
    const double M = data.readings[i].load(5), next = data.readings[i + 1].load(5);
    if (M > 0 && next <= 0)
      return turn[i] + M / (M - next) * (turn[i + 1] - turn[i]) - (turn.front() + turn.back()) / 2;
  }
  return 0;
}

class Cycloid : public testing::TestWithParam<const char*> {};

// No truth is known but the loops themselves: what is named sits at the drive, friction among it, and gives the lost
// motion that the loop shows to a tenth. Of the play tests; the README of the diagnosis has the stiffness tests, which
// take up to two minutes each.
TEST_P(Cycloid, WhatIsNamedSitsAtTheDriveAndGivesTheLostMotion) {
  const std::filesystem::path folder = test::source_dir() + "/validation/measurements/cycloid";
  const Mechanism m = read_mechanism(folder / "actuator.yaml");
  const Measurements data = read_measurements(folder / (std::string(GetParam()) + ".csv"));
  std::vector<Effect> effects = catalogue(test::source_dir() + "/validation/effects/catalogue");
  for (Effect& e : place_effects(m, effects)) effects.push_back(std::move(e));
  const Diagnosis d = diagnose(m, data, effects);
  bool rubs = false;
  for (const PlacedEffect& e : d.missing) {
    rubs = rubs || e.effect->name == "friction@drive.rz";
    EXPECT_TRUE(e.effect->name == "motor_compliance" || (e.effect->place && e.effect->place->kind == PlaceKind::drive))
        << e.effect->name;
  }
  EXPECT_TRUE(rubs);
  const Subject found = PreparedEffects(m, d.missing)(d.fit.values);
  std::vector<double> measured, predicted;
  for (const VectorX& r : found.stand(data)->predict(data, {}, alone)) predicted.push_back(r(5));
  for (const Reading& r : data.readings) measured.push_back(*r.displacement[5]);
  const double seen = lost_motion(data, measured);
  EXPECT_NEAR(lost_motion(data, predicted), seen, 0.1 * seen);
}

INSTANTIATE_TEST_SUITE_P(Loops, Cycloid,
                         testing::Values("baseline_play_initial", "baseline_play_after_run_in",
                                         "conic_disk_play_initial", "conic_disk_play_after_run_in",
                                         "conic_disk_play_preload_increase_1", "conic_disk_play_preload_increase_2",
                                         "conic_disk_play_preload_increase_3", "conic_disk_play_preload_increase_4"),
                         [](const auto& at) { return std::string(at.param); });

}  // namespace
}  // namespace deflect
