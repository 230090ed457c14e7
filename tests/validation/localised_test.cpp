// Where the unexplained rest acts, on signatures made by hand: each axis of the space of readings is one unit of noise.
#include "validation/diagnosis/at_places.h"
#include "validation/statistics/evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <memory>

namespace deflect {
namespace {

using namespace diagnosis;

constexpr Eigen::Index numbers = 40;

VectorX axis(Eigen::Index i) { return VectorX::Unit(numbers, i); }
MatrixX two(const VectorX& a, const VectorX& b) { return (MatrixX(numbers, 2) << a, b).finished(); }

class Places {
 public:
  /// A law at a place that changes the readings along these columns.
  Places& law(const std::string& part, const std::string& name, const MatrixX& columns, std::optional<int> leg = {}) {
    effects::Effect& e = effects_.emplace_back();
    e.name = e.title = name;
    e.place = subject::Place{};
    e.place->part = part;
    e.place->path = "leg." + part;
    Signature s;
    s.effect = {&e, leg};
    s.basis = columns;
    s.start = VectorX::Unit(columns.cols(), 0);
    s.lambda = 1;
    known_.laws.push_back(std::move(s));
    return *this;
  }

  /// At the place of the last law.
  Places& whatever(const MatrixX& columns) {
    known_.laws.back().whatever_the_law = [columns] { return columns; };
    return *this;
  }

  /// Another place, where no law is known.
  Places& without_law(const std::string& part, const MatrixX& columns, std::optional<int> leg = {}) {
    subject::Place place;
    place.part = part;
    place.path = "leg." + part;
    known_.without_law.push_back({place, leg, [columns] { return columns; }});
    return *this;
  }

  std::vector<Localised> of(const VectorX& residual, const MatrixX& fitted = MatrixX(numbers, 0)) const {
    Fit fit;
    fit.residual = residual;
    fit.signature = fitted;
    fit.chi2 = residual.squaredNorm();
    return localised(at_places(known_, {}, fit, 1), fit.chi2, static_cast<double>(numbers));
  }

  std::vector<AtPlace> at(const VectorX& residual) const {
    Fit fit;
    fit.residual = residual;
    return at_places(known_, {}, fit, 1);
  }

 private:
  std::deque<effects::Effect> effects_;
  Explanations known_;
};

// A law that nobody wrote, 3 : 4 between two of one place. Of the laws alone the largest gain is another place's: 0.9
// of the residual's direction is 81 % of χ², where the two laws have 36 and 64 %.
TEST(Localised, APlaceIsJudgedByAllItsLawsTogether) {
  const VectorX hidden = 20 * (0.6 * axis(0) + 0.8 * axis(1));
  const VectorX near = 0.9 * hidden.normalized() + std::sqrt(1 - 0.81) * axis(2);
  Places p;
  p.law("elbow", "spring", axis(0)).law("elbow", "play", axis(1)).law("wrist", "spring there", near);
  const std::vector<Localised> found = p.of(hidden);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].place.part, "elbow");
  EXPECT_EQ(found[0].what, "play");
  EXPECT_NEAR(found[0].share, 1, 1e-12);
  // 400 with two dimensions against 324 with one.
  const double odds = statistics::log_evidence(400, 2, false) - statistics::log_evidence(324, 1, false);
  EXPECT_NEAR(found[0].probability, 1 / (1 + std::exp(-odds)), 1e-12);
}

// What may happen at a place whether or not a law describes it counts with its laws.
TEST(Localised, APlaceCanDoMoreThanItsLaws) {
  const VectorX hidden = 20 * axis(0);
  Places p;
  p.law("load", "factor", axis(1)).whatever(axis(0)).law("wrist", "spring", (axis(0) + axis(2)).normalized());
  const std::vector<Localised> found = p.of(hidden);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].place.part, "load");
  EXPECT_NEAR(found[0].share, 1, 1e-12);
}

// Nor need a law be known at a place.
TEST(Localised, APlaceWithoutALawIsTold) {
  Places p;
  p.law("load", "factor", axis(1)).law("wrist", "spring", (axis(0) + axis(2)).normalized());
  p.without_law("rod", two(axis(0), axis(3)), 2).without_law("rod", two(axis(4), axis(3)), 1);
  const std::vector<Localised> found = p.of(20 * axis(0));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].place.part, "rod");
  EXPECT_EQ(found[0].leg, 2);
  EXPECT_EQ(found[0].effect, nullptr);
  EXPECT_EQ(found[0].what, "leg 2 rod, by none of the laws");
  EXPECT_NEAR(found[0].share, 1, 1e-12);
}

TEST(Localised, WhatReadingsCannotTellApartIsToldTogether) {
  Places p;
  p.law("elbow", "spring", axis(0)).law("wrist", "spring", axis(0)).law("hip", "spring", axis(1));
  const std::vector<Localised> found = p.of(20 * axis(0));
  ASSERT_EQ(found.size(), 2u);
  for (const Localised& l : found) EXPECT_NEAR(l.probability, 0.5, 1e-12);
}

// Six legs share the prior of one place, so a place of its own that explains as much is six times as likely as one of
// them.
TEST(Localised, TheLegsOfAPlaceShareItsPrior) {
  Places p;
  for (int leg = 1; leg <= 6; ++leg) p.law("elbow", "worn", axis(leg == 3 ? 0 : leg + 1), leg);
  p.law("hip", "spring", axis(0));
  const std::vector<Localised> found = p.of(20 * axis(0));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].place.part, "hip");
  EXPECT_NEAR(found[0].probability, 6.0 / 7, 1e-9);
  EXPECT_EQ(found[1].leg, 3);
}

// What no place explains is noise of unknown size to all of them: χ² of 3600 over 39 numbers is left here.
TEST(Localised, WhatNoPlaceExplainsMakesThemHarderToTellApart) {
  Places p;
  p.law("elbow", "spring", axis(0)).law("wrist", "spring", axis(1));
  const VectorX both = 20 * axis(0) + 15 * axis(1);
  EXPECT_EQ(p.of(both).size(), 1u);
  const std::vector<Localised> found = p.of(both + 60 * axis(9));
  ASSERT_EQ(found.size(), 2u);
  const double scale = (225 + 3600) / 39.0,
               odds = statistics::log_evidence(400 / scale, 1, false) - statistics::log_evidence(225 / scale, 1, false);
  EXPECT_NEAR(found[0].probability, 1 / (1 + std::exp(-odds)), 1e-12);
}

TEST(Localised, NothingIsToldWithinChanceOrWithinTheFit) {
  Places p;
  p.law("elbow", "spring", axis(0));
  EXPECT_TRUE(p.of(5 * axis(0)).empty());            // 25, within chance
  EXPECT_TRUE(p.of(20 * axis(0), axis(0)).empty());  // fitted already
  EXPECT_TRUE(p.of(20 * axis(1)).empty());
  EXPECT_TRUE(Places().of(20 * axis(0)).empty());
}

// The mean of the places' evidences by their priors; the smallest chance, times the number of places.
TEST(AtPlaces, EvidenceAndChanceAreThoseOfAllPlaces) {
  Places p;
  p.law("elbow", "spring", axis(0)).law("elbow", "play", axis(1)).law("wrist", "spring", axis(2));
  const VectorX residual = 5 * axis(0) + 2 * axis(1) + 3 * axis(2);
  const double elbow = statistics::log_evidence(29, 2, false), wrist = statistics::log_evidence(9, 1, false);
  EXPECT_NEAR(log_evidence(p.at(residual)), std::log((std::exp(elbow) + std::exp(wrist)) / 2), 1e-12);
  // χ² with two degrees of freedom: exp(−g/2).
  EXPECT_NEAR(p_value(p.at(residual)), 2 * std::exp(-29.0 / 2), 1e-15);
  EXPECT_EQ(log_evidence(Places().at(residual)), -INFINITY);
  EXPECT_EQ(p_value(Places().at(residual)), 1);
}

}  // namespace
}  // namespace deflect
