// Mistakes of recording, planted into simulated measurements of the built-in machines: each is the first thing that is
// said; healthy machines, with effects hidden in them and without, are not accused of any.
//
// DEFLECT_ALL_MISTAKES=1 in the environment runs every kind on every machine and 200 healthy sets; otherwise a part of
// them is run.
#include <gtest/gtest.h>

#include <cstdlib>

#include "msa/base/files.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/practice.h"
#include "tests/support/recording.h"
#include "validation/compare/comparison.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace compare;
using namespace diagnosis;
using namespace effects;
using namespace measurement;
using namespace prediction;

bool all_wanted() { return std::getenv("DEFLECT_ALL_MISTAKES") != nullptr; }

const char* machine_names[] = {"haptic-6psu", "stewart-6ups", "hybrid", "delta", "tripteron"};

/// Such that displacements are far above the noise of 2 µm: some tenths of a millimetre.
double force_on(const std::string& machine) {
  return machine == "stewart-6ups" ? 10000 : machine == "hybrid" ? 1000 : machine == "tripteron" ? 500 : 50;
}

Measurements measured(const Mechanism& drawn, const Mechanism& truth, const std::string& plan, std::uint64_t seed,
                      bool rotations) {
  SimulationOptions o;
  o.seed = seed;
  o.geometry = Geometry::second_order;
  if (rotations) o.sigma_th = 2e-5;
  return simulate(truth, campaign(plan, drawn, force_on(drawn.name), seed), o);
}

std::string words(const Comparison& c) {
  std::string out;
  for (const RecordingMistake& m : c.mistakes) {
    out += (out.empty() ? "" : " | ") + std::string(m.certain ? "" : "(remark) ");
    for (const std::string& id : m.ids) out += id + " ";
    out += ": " + m.sentence;
  }
  return out.empty() ? "nothing" : out;
}

/// A shift of all poses, which a missing effect can look like, is a remark.
bool named_first(const Comparison& c, const std::string& id) {
  if (c.mistakes.empty() || (!is_mistaken(c) && !id.starts_with("pose_shifted"))) return false;
  const std::vector<std::string>& ids = c.mistakes.front().ids;
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

class Recording : public testing::TestWithParam<const char*> {};

TEST_P(Recording, APlantedMistakeIsTheFirstThingSaid) {
  const Mechanism m = test::device(GetParam());
  const Measurements healthy = measured(m, m, "rich", 1, true);
  const Comparison usual = compare::compare(m, healthy);
  ASSERT_FALSE(is_mistaken(usual)) << words(usual);
  ASSERT_GT(usual.all.measured, 10 * usual.sigma_u) << "the campaign must show something";
  const std::vector<test::Planted> all = test::planted_mistakes();
  std::size_t named = 0, number = 0;
  const std::size_t machine = static_cast<std::size_t>(
      std::find(std::begin(machine_names), std::end(machine_names), std::string_view(GetParam())) - machine_names);
  for (const test::Planted& kind : all) {
    if (!all_wanted() && number++ % 10 != 2 * machine) continue;
    Measurements data = healthy;
    kind.plant(data);
    if (measurements_text(data) == measurements_text(healthy)) continue;  // such a pose has no yaw
    Comparison c;
    try {
      c = compare::compare(m, data);
    } catch (const ModelError& e) {  // out of reach: then the message says it
      EXPECT_NE(std::string(e.what()).find("all poses could be reached"), std::string::npos)
          << kind.id << ": " << e.what();
      ++named;
      continue;
    }
    if (named_first(c, kind.id)) {
      ++named;
    } else {
      EXPECT_LT(c.chi2_per_dof, 1.3) << GetParam() << ", " << kind.id << ": " << words(c)
                                     << ": where the drawing explains the data nothing is mistaken";
    }
  }
  std::printf("%s: %zu named\n", GetParam(), named);
  if (all_wanted()) {
    EXPECT_GE(named, 25u);
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, Recording, testing::ValuesIn(machine_names), [](const auto& machine) {
  std::string name = machine.param;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
});

TEST(RecordingChecks, HealthyMachinesAreNotAccused) {
  const std::vector<Effect>& effects = test::all_effects();
  const std::size_t sets = all_wanted() ? 200 : 12;
  const char* plans[] = {"rich", "random", "paper", "cycle"};
  std::size_t made = 0;
  for (std::size_t i = 0; made < sets; ++i) {
    const Mechanism m = test::device(i % 3 == 2 ? machine_names[i / 3 % 5] : "haptic-6psu-ideal-joints");
    Mechanism truth = m;
    std::string hidden = "nothing";
    if (i % 4 != 0) {
      const Effect& e = effects[i * 7 % effects.size()];
      try {
        VectorX values = start_values(e);
        if (!e.parameters.empty() && e.parameters.front().log)
          values(0) = std::clamp(values(0) * std::pow(2, static_cast<double>(i % 5) - 2), e.parameters.front().low,
                                 e.parameters.front().high);
        truth = with_effect(m, e, values, test::some_leg(e));
        hidden = e.name;
      } catch (const std::runtime_error&) {
        continue;  // the machine has no place for it
      }
    }
    Measurements data;
    try {
      data = measured(m, truth, plans[i % 4], i + 1, i % 2 == 0);
    } catch (const std::runtime_error&) {
      continue;  // it does not stand with it
    }
    ++made;
    const Comparison c = compare::compare(m, data);
    EXPECT_FALSE(is_mistaken(c)) << m.name << " with " << hidden << ", " << plans[i % 4] << ", seed " << i + 1 << ": "
                                 << words(c);
  }
}

// Poses a thousandth as large lie near the origin, which this machine reaches.
TEST(RecordingChecks, PosesInAnotherUnitAreToldWhereTheyCanBeReached) {
  const Mechanism m = test::device("tripteron");
  Measurements data = measured(m, m, "paper", 1, false);
  for (PoseGroup& pose : data.poses) pose.pose_mm_deg.head<3>() /= 1e3;
  const Comparison c = compare::compare(m, data);
  EXPECT_TRUE(named_first(c, "pose_in_m")) << words(c);
}

TEST(RecordingChecks, PracticeSetsAreNotAccused) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const int step = all_wanted() ? 1 : 2;
  for (int i = 1; i <= 32; i += step) {
    const auto file = test::practice_set(fmt::format("p{:02}", i));
    if (!file) continue;
    const Measurements data = read_measurements(*file);
    const Comparison c = compare::compare(m, data);
    EXPECT_FALSE(is_mistaken(c)) << *file << ": " << words(c);
  }
}

TEST(RecordingChecks, ADiagnosisSaysItFirstAndNamesNoEffect) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  Measurements data = measured(m, m, "random", 3, false);
  test::displacements_times(0, 3, 1 / 25.4)(data);
  const Diagnosis d = diagnose(m, data, test::all_effects());
  ASSERT_TRUE(is_mistaken(d));
  EXPECT_EQ(d.mistakes.front().ids.front(), "displacement_in_inch");
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  EXPECT_TRUE(d.missing.empty());
  EXPECT_EQ(d.probability_unknown, 1);
  DiagnosisOptions anyway;
  anyway.comparison.as_recorded = true;
  anyway.bootstrap_sets = 99;
  EXPECT_FALSE(is_mistaken(diagnose(m, data, {test::effect("modulus")}, anyway)));
}

}  // namespace
}  // namespace deflect
