// Forces at places by statics against predictions with a small law there.
#include <gtest/gtest.h>

#include <regex>

#include "msa/base/index.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/diagnosis/changes.h"
#include "validation/effects/law_of_effect.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace effects;
using namespace measurement;
using namespace parallel;
using namespace prediction;
using namespace subject;

VectorX joined(const std::vector<VectorX>& readings) {
  VectorX out(6 * std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) out.segment<6>(6 * as_index(i)) = readings[i].head<6>();
  return out;
}

class StaticsAtPlaces : public testing::TestWithParam<const char*> {};

// A spring of compliance ε at a place moves the point by ε g gᵀF to first order in ε, in determinate and in
// over-constrained machines: what is left is of the second order, here below a hundredth.
TEST_P(StaticsAtPlaces, AgreesWithThePredictionOfASmallSpring) {
  const Mechanism m = test::device(GetParam());
  const Measurements all = campaign("random", m, 50, 3);
  const Measurements data = one_pose(all, 0);
  const Subject subject = m;
  const auto standing = subject.stand(data);
  const auto transmissions = standing->transmissions();
  ASSERT_TRUE(transmissions);
  const std::vector<VectorX> drawn = standing->predict(data, {}, alone);
  int looked_at = 0;
  for (const Effect& e : place_effects(subject, test::all_effects())) {
    if (!e.name.starts_with("linear@")) continue;
    VectorX stiff = start_values(e);
    stiff *= 1e3;  // far from what bends the structure's own forces
    const auto law = law_in_series(e, stiff);
    ASSERT_TRUE(law) << e.name;
    const std::optional<int> leg = e.scope == Scope::one_leg ? std::optional(2) : std::nullopt;
    const auto told = transmissions->change(*e.place, leg, *law, data);
    ASSERT_TRUE(told) << e.name;
    const std::vector<VectorX> with = Subject(with_effect(m, e, stiff, leg)).stand(data)->predict(data, {}, alone);
    double off = 0, size = 0, rounding = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
      off += (with[i] - drawn[i] - VectorX(told->readings[i])).squaredNorm();
      size += told->readings[i].squaredNorm();
      rounding += drawn[i].squaredNorm();
    }
    EXPECT_LE(std::sqrt(off), 1e-2 * std::sqrt(size) + 1e-9 * std::sqrt(rounding)) << e.name;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 10);
}

/// Jenkins's element of unit stiffness, which slips after r.
Transmissions::Curve slipping_after(double r) {
  return [r, slip = 0.0](double x) mutable {
    slip = std::min(std::max(slip, x - r), x + r);
    return x - slip;
  };
}

/// How far a change is from a multiple of another, as a share of it.
double apart(const VectorX& change, const VectorX& shape) {
  return (change - change.dot(shape) / shape.squaredNorm() * shape).norm() / change.norm();
}

// Friction beside a joint moves the point by its force times the motion of the joint under a unit load (Maxwell), to
// first order in its stiffness. The haptic device's contacts bend its motions, which are not told.
TEST_P(StaticsAtPlaces, AgreesWithThePredictionOfALittleFriction) {
  const Mechanism m = test::device(GetParam());
  const Measurements data = one_pose(campaign("cycle", m, 50, 3), 0);
  const Subject subject = m;
  const auto standing = subject.stand(data);
  const auto transmissions = standing->transmissions();
  ASSERT_TRUE(transmissions);
  PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const auto predicted = [&](const Subject& s) { return joined(s.stand(data)->predict(data, linear, alone)); };
  const VectorX drawn = predicted(subject);
  int looked_at = 0;
  for (const Effect& e : place_effects(subject, test::all_effects())) {
    if (!e.name.starts_with("friction@") || !e.place->others.empty()) continue;
    const std::optional<int> leg = e.scope == Scope::one_leg ? std::optional(2) : std::nullopt;
    const auto told = [&](const std::function<Transmissions::Curve()>& at_rest) {
      const auto out = transmissions->change_beside(*e.place, leg, at_rest, data);
      return out ? joined({out->begin(), out->end()}) : VectorX(0);
    };
    double most = 0;
    told([&] {
      return [&most](double x) {
        most = std::max(most, std::abs(x));
        return x;
      };
    });
    if (e.place->hold != Hold::free || most < 1e-12) continue;
    VectorX values = start_values(e);
    values(1) *= 1e-4;
    const double per = e.place->rotation() ? 1e-3 : 1e3;  // Nm/rad of Nmm/rad, N/m of N/mm
    const double unit = e.place->rotation() ? 1e-3 : 1;   // Nm of Nmm
    values(0) = 0.3 * most * values(1) * per / unit;
    const VectorX change = predicted(Subject(with_effect(m, e, values, leg))) - drawn,
                  shape = told([&] { return slipping_after(0.3 * most); });
    if (change.norm() <= 1e-9 * drawn.norm()) continue;
    EXPECT_LE(apart(change, shape), 1e-2) << e.name;
    EXPECT_NEAR(change.dot(shape) / shape.squaredNorm(), -values(1) * per, 2e-2 * values(1) * per) << e.name;
    ++looked_at;
  }
  const std::string device = GetParam();
  EXPECT_EQ(looked_at > 0, device != "haptic-6psu" && device != "arm" && device != "scara");  // no free joint
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, StaticsAtPlaces,
                         testing::Values("haptic-6psu-ideal-joints", "haptic-6psu", "tripteron", "delta",
                                         "stewart-6ups", "hybrid", "arm", "scara", "gantry", "3-rrr", "3-upu"),
                         [](const auto& at) {
                           return std::regex_replace(std::string(at.param), std::regex("-"), "_");
                         });

// The same by a law and by the function that it is.
TEST(StaticsOfACurve, IsThatOfTheLaw) {
  const Mechanism m = test::device("arm");
  const Measurements data = campaign("random", m, 50, 3);
  const auto transmissions = Subject(m).stand(data)->transmissions();
  ASSERT_TRUE(transmissions);
  const PowerLaw law{1e-5, 10, 0.5};  // m, N
  const auto curve = [&](double f) { return std::copysign(law.deflection * std::sqrt(std::abs(f) / law.force), f); };
  int looked_at = 0;
  for (const Effect& e : place_effects(Subject(m), test::all_effects())) {
    if (!e.name.starts_with("linear@")) continue;
    const auto by_law = transmissions->change(*e.place, {}, Law(law), data);
    const auto by_curve = transmissions->change(*e.place, {}, Transmissions::Curve(curve), data);
    ASSERT_TRUE(by_law && by_curve) << e.name;
    double largest = 0, apart = 0;
    for (std::size_t i = 0; i < by_curve->size(); ++i) {
      largest = std::max(largest, (*by_curve)[i].norm());
      apart = std::max(apart, ((*by_curve)[i] - by_law->readings[i]).norm());
    }
    // A force of rounding counts as none for the curve: 1e-9 of the largest, of which the root is 3e-5.
    EXPECT_LE(apart, 1e-4 * largest) << e.name;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 10);
}

// The contacts of the haptic device do not bend its forces, because it is determinate. Those of a machine that is held
// more than once do, and there statics alone tells nothing; nor does it where play floats.
TEST(StaticsWithBentLaws, AreToldWhereForcesDoNotHangOnBentLaws) {
  const auto told = [](const Mechanism& m) {
    return Subject(m).stand(one_pose(campaign("random", m, 50, 3), 0))->transmissions() != nullptr;
  };
  const auto with = [](const char* device, const char* at, const char* law) {
    return edited(test::device(device), {at, law, Edit::Action::append});
  };
  EXPECT_TRUE(told(with("stewart-6ups", "leg.slide.tz", "{law: hardening, stiffness: 2000 N/mm, reference: 1 mm}")));
  EXPECT_FALSE(told(with("3-rrr", "leg[2].motor.rx", "{law: hardening, stiffness: 1e6 Nm/rad, reference: 1 mrad}")));
  EXPECT_FALSE(told(with("stewart-6ups", "leg.slide.tz", "{law: clearance, gap: 0.01 mm}")));
}

/// Whether a spring at the place moves a reading of the first pose by more than a nanometre.
bool carries(const Mechanism& m, const PlacedEffect& e, const Measurements& first) {
  PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const std::vector<VectorX>
      before = Subject(m).stand(first)->predict(first, linear, alone),
      after = with_effect(Subject(m), {e, start_values(*e.effect)}).stand(first)->predict(first, linear, alone);
  double most = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    most = std::max(most, (after[i] - before[i]).head<3>().cwiseAbs().maxCoeff());
  return most > 1e-9;
}

// A diagnosis takes from statics what agrees with a prediction at the first pose, and by both the change of the
// residual is the same. A spring as it is at the start is a thousand times one of which the prediction is of the first
// order.
TEST(ChangesByStatics, TellsWhatASpringAtAPlaceChanges) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  SimulationOptions simulated;
  simulated.geometry = Geometry::linear;
  const Measurements data = simulate(m, campaign("paper", m, 50, 3), simulated), first = one_pose(data, 0);
  const diagnosis::Observations o(m, data, {});
  const std::vector<Effect> places = place_effects(Subject(m), test::all_effects());
  std::vector<PlacedEffect> springs;
  for (const Effect& e : places)
    if (e.name.starts_with("linear@"))
      springs.push_back({&e, e.scope == Scope::one_leg ? std::optional(2) : std::nullopt});
  const diagnosis::Changes changes(o, springs, 1);
  int looked_at = 0;
  for (const PlacedEffect& e : springs) {
    if (!carries(m, e, first)) continue;
    const auto told = changes.by_statics(e);
    ASSERT_TRUE(told) << e.effect->name;
    VectorX stiff = start_values(*e.effect);
    stiff *= 1e3;
    const VectorX predicted = 1e3 * (o.whitened_residual(with_effect(o.subject(), {e, stiff})) - o.null_residual());
    EXPECT_LE((o.uncertainty().whitened(*told) - predicted).norm(), 1e-2 * predicted.norm()) << e.effect->name;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 10);
}

// In a serial arm forces do not depend on what gives way, so play changes the readings by its gap where it is loaded,
// exactly. Loads that leave it open put it where the deformed shape does, as in a hypothesis.
TEST(ChangesByStatics, TellsWhatPlayInAnArmChangesLoadedOrNot) {
  const Mechanism m = test::device("arm");
  const Measurements data = simulate(m, campaign("paper", m, 50, 3), {});
  const diagnosis::Observations o(m, data, {});
  const std::vector<Effect> places = place_effects(Subject(m), test::all_effects());
  std::vector<PlacedEffect> play;
  for (const Effect& e : places)
    if (e.name.starts_with("clearance@")) play.push_back({&e, {}});
  const diagnosis::Changes changes(o, play, 1);
  int looked_at = 0;
  for (const PlacedEffect& e : play) {
    const auto told = changes.by_statics(e);
    if (!told) continue;
    const VectorX predicted =
        o.whitened_residual(with_effect(o.subject(), {e, start_values(*e.effect)})) - o.null_residual();
    EXPECT_LE((o.uncertainty().whitened(*told) - predicted).norm(), 1e-6 * predicted.norm() + 1e-9) << e.effect->name;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 10);
}

}  // namespace
}  // namespace deflect
