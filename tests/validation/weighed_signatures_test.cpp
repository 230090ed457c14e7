// Signatures weighed anew, for other readings set aside, are those of a diagnosis that sets these aside from the start.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects_everywhere.h"
#include "validation/diagnosis/at_places.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/statistics/columns.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::diagnosis {
namespace {

/// A device, or a frame of validation/frames, and its readings.
struct Measured {
  subject::Subject subject;
  measurement::Measurements data;
};

Measured measured(const std::string& name) {
  prediction::SimulationOptions o;
  o.seed = 5;
  const std::filesystem::path file = std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml");
  if (std::filesystem::exists(file)) {
    const frame::FrameDescription f = frame::read_frame(file);
    return {f, subject::simulate_frame(f, subject::frame_campaign("random", f, 5), o)};
  }
  const Mechanism m = test::device(name);
  return {m, prediction::simulate(m, prediction::campaign("paper", m, 50, 2), o)};
}

/// With every effect at every place.
struct Looked {
  explicit Looked(const std::string& name) : Looked(measured(name)) {}
  explicit Looked(Measured m)
      : data(std::move(m.data)), effects(test::effects_everywhere(m.subject)), o(m.subject, data, {}) {}

  std::vector<bool> none() const { return std::vector<bool>(data.readings.size(), false); }
  std::vector<bool> some(double share, std::uint64_t seed) const {
    measurement::Random random(seed);
    std::vector<bool> out;
    for (std::size_t i = 0; i < data.readings.size(); ++i) out.push_back(random.uniform(0, 1) < share);
    return out;
  }

  const measurement::Measurements data;
  const std::vector<effects::Effect> effects;
  const Observations o;
};

/// What it does at the start values.
VectorX at_start(const Signature& s) { return s.basis * s.start; }

void expect_same(const SignaturesAtPlaces& again, const SignaturesAtPlaces& fresh) {
  ASSERT_EQ(again.all().size(), fresh.all().size());
  for (std::size_t i = 0; i < fresh.all().size(); ++i) {
    const Signature &a = again.all()[i], &b = fresh.all()[i];
    const std::string& name = b.effect.effect->name;
    ASSERT_EQ(a.effect.effect, b.effect.effect) << name;
    ASSERT_EQ(a.effect.leg, b.effect.leg) << name;
    EXPECT_EQ(a.shaped, b.shaped) << name;
    EXPECT_EQ(a.one_sided, b.one_sided) << name;
    EXPECT_NEAR(a.lambda, b.lambda, 1e-9 * b.lambda + 1e-9) << name;
    EXPECT_LT((at_start(a) - at_start(b)).norm(), 1e-9 * b.lambda + 1e-9) << name;
    ASSERT_EQ(a.basis.cols(), b.basis.cols()) << name;
    const MatrixX along = b.shaped ? MatrixX(a.basis) : MatrixX(a.basis * (a.basis.transpose() * b.basis));
    EXPECT_LT((along - b.basis).colwise().norm().maxCoeff(), 1e-6) << name;  // of the shortest column that is seen
    EXPECT_EQ(a.whatever_the_law == nullptr, b.whatever_the_law == nullptr) << name;
    EXPECT_EQ(a.any_curve == nullptr, b.any_curve == nullptr) << name;
  }
  ASSERT_EQ(again.left_out().size(), fresh.left_out().size());
  for (std::size_t i = 0; i < fresh.left_out().size(); ++i) {
    EXPECT_EQ(again.left_out()[i].effect, fresh.left_out()[i].effect);
    EXPECT_EQ(again.left_out()[i].why, fresh.left_out()[i].why);
  }
}

class WeighedSignatures : public ::testing::TestWithParam<const char*> {};

TEST_P(WeighedSignatures, AreThoseOfAFreshLook) {
  const Looked l(GetParam());
  SignaturesAtPlaces again(l.o.keeping(l.none()), l.effects, 2);
  ASSERT_GT(again.all().size(), 30u);
  for (const std::vector<bool>& aside : {l.some(0.1, 1), l.some(0.3, 2)}) {
    const Observations now = l.o.keeping(aside);
    again.weigh_for(now, 2);
    expect_same(again, SignaturesAtPlaces(now, l.effects, 2));
  }
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, WeighedSignatures,
                         testing::Values("haptic-6psu-ideal-joints", "tripteron", "arm", "truss-45",
                                         "portal-semi-rigid"),
                         [](const auto& at) {
                           std::string out = at.param;
                           std::replace(out.begin(), out.end(), '-', '_');
                           return out;
                         });

// Only a force along its line loads a drive of a tripteron. A law of that drive has no signature where all readings
// under such a force are set aside, and gets one where they count.
TEST(WeighedSignaturesOfATripteron, KnowWhatOnlyReadingsSetAsideShow) {
  const Looked l("tripteron");
  std::vector<bool> along_x;
  for (const measurement::Reading& r : l.data.readings) along_x.push_back(r.load(0) != 0);
  const Observations without = l.o.keeping(along_x), with = l.o.keeping(l.none());
  SignaturesAtPlaces all(without, l.effects, 1);
  const std::size_t before = all.all().size();
  all.weigh_for(with, 1);
  EXPECT_GT(all.all().size(), before);
  expect_same(all, SignaturesAtPlaces(with, l.effects, 1));
  all.weigh_for(without, 1);
  expect_same(all, SignaturesAtPlaces(without, l.effects, 1));
}

// What was found moves the tolerances, and other readings are gross outliers then. Seen by such observations, laws and
// what else may happen at their places are as after a weighing for these.
TEST(Weighed, AreThoseOfObservationsWithWhatWasFound) {
  const Looked l("scara");
  const SignaturesAtPlaces all(l.o.keeping(l.some(0.1, 1)), l.effects, 2);
  const auto softer = std::find_if(l.effects.begin(), l.effects.end(),
                                   [](const effects::Effect& e) { return e.name == "factor@fore_link"; });
  ASSERT_NE(softer, l.effects.end());
  const Observations granted =
      l.o.keeping(l.some(0.3, 2)).granted(subject_with(l.o, {{&*softer, {}}}, VectorX::Constant(1, 0.1)));
  ASSERT_FALSE(all.are_weighed_for(granted));
  SignaturesAtPlaces again = all;
  again.weigh_for(granted, 2);
  EXPECT_TRUE(again.are_weighed_for(granted));
  const Weighed seen(all, granted);
  const auto expect_same_columns = [](const MatrixX& a, const MatrixX& b, const std::string& name) {
    ASSERT_EQ(a.cols(), b.cols()) << name;
    ASSERT_EQ(a.rows(), b.rows()) << name;
    if (a.cols() > 0) {
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9) << name;
    }
  };
  std::size_t moved = 0, compared = 0, whatever = 0, curves = 0;
  for (const Signature& s : all.all()) {
    const std::string name = name_of(s.effect);
    const auto same_law = [&](const Signature& other) { return same(other.effect, s.effect); };
    const auto fresh = std::find_if(again.all().begin(), again.all().end(), same_law);
    const Signature law = seen.law(s);
    ASSERT_EQ(fresh == again.all().end(), law.basis.cols() == 0) << name;
    if (law.basis.cols() == 0) continue;
    expect_same_columns(law.basis, fresh->basis, name);
    EXPECT_LT((law.start - fresh->start).norm(), 1e-9 * fresh->lambda) << name;
    ASSERT_EQ(law.whatever_the_law == nullptr, fresh->whatever_the_law == nullptr) << name;
    if (law.whatever_the_law) expect_same_columns(law.whatever_the_law(), fresh->whatever_the_law(), name);
    ASSERT_EQ(law.any_curve == nullptr, fresh->any_curve == nullptr) << name;
    for (const Curves c : all_curves)
      if (law.any_curve) expect_same_columns(law.any_curve(c), fresh->any_curve(c), name);
    ++compared;
    moved += std::abs(law.lambda - s.lambda) > 0.1 * s.lambda;
    whatever += law.whatever_the_law != nullptr;
    curves += law.any_curve != nullptr;
  }
  EXPECT_GE(compared, 200u);
  EXPECT_GE(moved, 20u);
  EXPECT_GE(whatever, 5u);
  EXPECT_GE(curves, 50u);
}

// A load that is turned is another force at its nodes, a bar of another stiffness one of another elongation: both are
// within what may happen there whatever the law, to the first order; but for C1d, whose own gauge reads what stretches
// the bar and not what gives way beside it. At groups and supports nothing of this kind is known.
TEST(WhateverTheLaw, HoldsTheLawsOfALoadAndOfAMember) {
  const Looked l("truss-45");
  std::size_t turned = 0, softer = 0;
  for (const Signature& s : SignaturesAtPlaces(l.o, l.effects, 2).all()) {
    const effects::Effect& e = *s.effect.effect;
    if (!e.place || e.place->kind == subject::PlaceKind::sensor) continue;
    const bool part = e.place->others.empty(), load = e.name.starts_with("turned@"),
               member =
                   e.place->path.starts_with("members.") && e.name.starts_with("factor@") && e.place->part != "C1d";
    if (!part) {
      EXPECT_FALSE(s.whatever_the_law) << e.name;
    }
    if (!part || !(load || member)) continue;
    ASSERT_TRUE(s.whatever_the_law) << e.name;
    const MatrixX span = statistics::orthonormal(s.whatever_the_law(), 1e-6);
    EXPECT_LT((s.basis - span * (span.transpose() * s.basis)).norm(), 0.01 * s.basis.norm()) << e.name;
    ++(load ? turned : softer);
  }
  const effects::PlacedEffect last{&l.effects.back(), {}};
  EXPECT_EQ(Changes(l.o, {last}, 1).by_any_curve(last, Curves::powers).cols(), 0)
      << "statics tells forces in machines alone";
  EXPECT_GE(turned, 3u);
  EXPECT_GE(softer, 30u);
}

// Any curve of deflection over force is close to a sum of powers of the force and of its size: what is one of them is
// in their span, and a contact, |f|^(2/3), is within a hundredth of it. Statics tells the forces, so that a law's
// change is to the first order.
TEST(WhateverTheLaw, HoldsTheLawsOfAPlaceInAMachine) {
  const Looked l("arm");
  std::size_t sums = 0, contacts = 0;
  for (const Signature& s : SignaturesAtPlaces(l.o, l.effects, 2).all()) {
    const effects::Effect& e = *s.effect.effect;
    EXPECT_TRUE(e.place || !s.any_curve) << e.name;
    const bool sum = e.name.starts_with("linear@") || e.name.starts_with("pull@") || e.name.starts_with("push@");
    if (!s.any_curve || !(sum || e.name.starts_with("contact@"))) continue;
    const MatrixX span = statistics::orthonormal(s.any_curve(Curves::powers), 1e-6);
    EXPECT_LT((s.basis - span * (span.transpose() * s.basis)).norm(), sum ? 1e-6 : 0.01) << e.name;
    ++(sum ? sums : contacts);
  }
  EXPECT_GE(sums, 30u);
  EXPECT_GE(contacts, 10u);
}

// A member of another stiffness stretches, twists and bends more about both axes, all along it: in a serial arm, in
// every leg, in one of three, in a group of branches. To the first order, as drawn.
TEST(WhateverTheLaw, HoldsTheLawsOfAMemberOfAMachine) {
  std::size_t members = 0;
  for (const char* device : {"scara", "hybrid", "haptic-6psu", "delta"}) {
    const Looked l(device);
    const Changes changes(l.o, {}, 1);
    for (const effects::Effect& e : l.effects) {
      if (!e.name.starts_with("factor@") || !e.place->path.starts_with("leg.") || !e.place->freedoms.empty() ||
          !e.place->others.empty())
        continue;
      const auto leg = e.scope == effects::Scope::one_leg ? std::optional(2) : std::nullopt;
      const MatrixX span = statistics::orthonormal(changes.by_whatever(*e.place, leg), 1e-6);
      const VectorX change = changes.by({&e, leg}).columns.col(0);
      if (change.norm() < 1e-12) continue;  // hinged at both ends
      EXPECT_LE(span.cols(), 4);
      EXPECT_LT((change - span * (span.transpose() * change)).norm(), 0.01 * change.norm()) << device << " " << e.name;
      ++members;
    }
  }
  EXPECT_EQ(members, 10u);
}

// A sensor that reads another point, or is turned, shows what its shapes do.
TEST(WhateverTheLaw, HoldsTheLawsOfTheSensorOfAMachine) {
  const Looked l("stewart-6ups");
  std::size_t found = 0;
  for (const Signature& s : SignaturesAtPlaces(l.o, l.effects, 2).all())
    if (s.effect.effect->name == "moved@sensor") {
      ASSERT_TRUE(s.whatever_the_law);
      const MatrixX span = statistics::orthonormal(s.whatever_the_law(), 1e-6);
      EXPECT_LT((s.basis - span * (span.transpose() * s.basis)).norm(), 1e-3 * s.basis.norm());
      ++found;
    }
  EXPECT_EQ(found, 1u);
}

/// The share of a change outside what these columns span.
double outside(const VectorX& change, const MatrixX& columns) {
  const MatrixX span = statistics::orthonormal(columns, 1e-6);
  return (change - span * (span.transpose() * change)).norm() / change.norm();
}

// A load at another point or in another direction, a load cell with another gain: all are within what may happen to the
// load, of a machine that is loaded at T and of one that is loaded on a handle as well, where the handle's is not the
// one at T. To the first order.
TEST(WhateverTheLaw, HoldsTheLawsOfTheLoadsOfAMachine) {
  const Mechanism m = test::with(test::device("arm"), "loads", "{handle: {point: [40 mm, -30 mm, 90 mm]}}");
  prediction::SimulationOptions o;
  measurement::Measurements plan = prediction::campaign("paper", m, 50, 2);
  const Looked alone(Measured{m, prediction::simulate(m, plan, o)});
  plan.instruments.load_points = {"handle"};
  measurement::Random random(4);
  for (measurement::Reading& r : plan.readings) {
    r.at_tool = r.load;
    r.at_points = {Vector6::NullaryExpr([&](Eigen::Index i) { return i < 3 ? random.uniform(-20, 20) : 0; })};
  }
  const Looked both(Measured{m, prediction::simulate(m, plan, o)});
  for (const Looked* l : {&alone, &both}) {
    const Changes changes(l->o, {}, 1);
    std::map<std::string, MatrixX> columns;
    for (const subject::Place& p : l->o.subject().places())
      if (p.kind == subject::PlaceKind::load) columns[p.part] = changes.by_whatever(p, {});
    ASSERT_EQ(columns.size(), 2u);
    EXPECT_EQ(columns.at("loads.handle").cols() > 0, l == &both);
    const MatrixX all = statistics::side_by_side({columns.at("load"), columns.at("loads.handle")}, l->o.numbers());
    std::size_t found = 0;
    for (const effects::Effect& e : l->effects) {
      const bool at_load = e.name.starts_with("moved@") && e.place->kind == subject::PlaceKind::load;
      if (!at_load && e.name != "load_gain" && e.name != "load_misalignment") continue;
      const MatrixX made = changes.by({&e, {}}).columns;
      for (const VectorX change : made.colwise()) {
        if (change.isZero(0)) continue;  // a handle that nothing loads
        EXPECT_LT(outside(change, at_load ? columns.at(e.place->part) : all), 0.01) << e.name;
        ++found;
        if (!at_load || l == &alone) continue;
        EXPECT_GT(outside(change, columns.at(e.place->part == "load" ? "loads.handle" : "load")), 0.1) << e.name;
      }
    }
    EXPECT_EQ(found, l == &both ? 10u : 7u);
  }
}

// Places where no law acts are known too. With nothing but an entry of the catalogue these are the members, the load,
// the sensor, and what gives way in joints, where something may rub; where a law of theirs is known, none.
TEST(PlacesWithoutLaw, AreThoseOfTheMachineWhereNoLawActs) {
  const Looked l("scara");
  const auto without = [&](const auto& is_known) {
    std::vector<effects::Effect> known;
    for (const effects::Effect& e : l.effects)
      if (is_known(e)) known.push_back(e);
    const SignaturesAtPlaces all(l.o, known, 1);
    std::vector<std::string> out;
    for (const PlaceWithoutLaw& p : all.known().without_law) out.push_back(p.place.part);
    std::sort(out.begin(), out.end());
    return out;
  };
  const std::vector<std::string> all = without([](const effects::Effect& e) { return !e.place; });
  std::vector<std::string> expected = {"column", "fore_link", "load", "quill", "sensor", "upper_link"};
  for (const subject::Place& p : l.o.subject().places())
    if (p.freedoms.size() == 1 && p.others.empty() && p.hold != subject::Hold::rigid) expected.push_back(p.part);
  std::erase(expected, "wrist");  // which turns under no load of these readings
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(all, expected);
  EXPECT_EQ(without([](const effects::Effect& e) { return e.name != "factor@fore_link"; }),
            std::vector<std::string>{"fore_link"});
}

}  // namespace
}  // namespace deflect::diagnosis
