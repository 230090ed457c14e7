// Work shared by the ranks of a run: the same results and the same errors as by one process alone.
#include "validation/parallel/ranks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "msa/base/error.h"
#include "tests/support/devices.h"
#include "tests/support/thread_ranks.h"
#include "validation/diagnosis/bootstrap.h"
#include "validation/parallel/pack.h"
#include "validation/parallel/shared_cases.h"
#include "validation/report/map_results.h"
#include "validation/studies/map.h"

namespace deflect {
namespace {

using namespace parallel;
using namespace report;
using namespace studies;

TEST(Pack, KeepsEveryBit) {
  const double quiet = std::numeric_limits<double>::quiet_NaN(), tiny = std::numeric_limits<double>::denorm_min();
  const std::vector<std::optional<Vector3>> values = {Vector3(-0.0, tiny, 0.1), std::nullopt,
                                                      Vector3(INFINITY, quiet, 1e308)};
  const std::string bytes = pack(values);
  EXPECT_EQ(pack(unpack<std::vector<std::optional<Vector3>>>(bytes)), bytes);
  EXPECT_TRUE(std::signbit((*unpack<std::vector<std::optional<Vector3>>>(bytes)[0])(0)));
}

struct Squares {
  explicit Squares(std::size_t n) : values(n, -1) {
    cases.count = n;
    cases.work = [this](std::size_t i) { values[i] = static_cast<double>(i * i); };
    cases.result = [this](std::size_t i) { return pack(values[i]); };
    cases.take = [this](std::size_t i, const std::string& bytes) { values[i] = unpack<double>(bytes); };
  }
  std::vector<double> values;
  SharedCases cases;
};

TEST(Ranks, TheFirstHasAllResultsTheOthersTheirOwn) {
  for (const std::size_t n : {0u, 1u, 2u, 7u, 160u, 1001u})
    for (const int size : {1, 2, 3, 5})
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(testing::Message() << n << " cases, " << size << " ranks, " << threads << " threads");
        std::atomic<std::size_t> worked = 0, told = 0;
        for (const Ending& end : test::ThreadRanks(size).run([&](Ranks& ranks) {
               Squares squares(n);
               for_each_case(squares.cases, &ranks, threads, [&](std::size_t done) {
                 if (ranks.first() && done > told) told = done;
               });
               for (std::size_t i = 0; i < n; ++i) {
                 const bool own = i % static_cast<std::size_t>(ranks.size()) == static_cast<std::size_t>(ranks.rank());
                 worked += own;
                 if (own || ranks.first()) {
                   EXPECT_EQ(squares.values[i], static_cast<double>(i * i));
                 } else {
                   EXPECT_EQ(squares.values[i], -1);
                 }
               }
             }))
          EXPECT_EQ(end.code, 0) << end.message;
        EXPECT_EQ(worked, n);
        EXPECT_EQ(told, n);
      }
}

TEST(Ranks, TheFirstFailingCaseEndsTheRunForAllAlike) {
  for (const int size : {1, 2, 3, 4})
    for (const std::size_t first : {0u, 5u, 90u}) {
      SCOPED_TRACE(testing::Message() << size << " ranks, case " << first);
      const std::vector<Ending> ends = test::ThreadRanks(size).run([&](Ranks& ranks) {
        Squares squares(200);
        const auto work = squares.cases.work;
        squares.cases.work = [&](std::size_t i) {
          if (i == first) throw NumericalError("case " + std::to_string(i));
          if (i > first && i % 3 == 0) throw InputError("a later one");
          work(i);
        };
        for_each_case(squares.cases, &ranks, 2);
        ADD_FAILURE() << "went on";
      });
      for (const Ending& end : ends) {
        EXPECT_EQ(end.code, 4);
        EXPECT_EQ(end.message, "case " + std::to_string(first));
      }
    }
}

TEST(Ranks, NobodyWaitsForOneThatFailsElsewhere) {
  for (const int failing : {0, 2}) {
    const std::vector<Ending> ends = test::ThreadRanks(3).run([&](Ranks& ranks) {
      if (ranks.rank() == failing) throw InputError("no file here");
      Squares squares(500);
      for_each_case(squares.cases, &ranks, 1);
    });
    for (const Ending& end : ends) {
      EXPECT_EQ(end.code, 2);
      EXPECT_EQ(end.message, failing == 0 ? "no file here" : "rank 2: no file here");
    }
  }
}

TEST(Ranks, WhatAllRefuseIsSaidOnce) {
  for (const Ending& end : test::ThreadRanks(3).run([](Ranks&) { throw ModelError("cannot stand"); })) {
    EXPECT_EQ(end.code, 3);
    EXPECT_EQ(end.message, "cannot stand");
  }
}

TEST(Ranks, AFailureAfterTheWorkEndsTheRunForAllToo) {
  const std::vector<Ending> ends = test::ThreadRanks(2).run([&](Ranks& ranks) {
    Squares squares(10);
    for_each_case(squares.cases, &ranks, 1);
    if (ranks.first()) throw InputError("disk full");
  });
  for (const Ending& end : ends) EXPECT_EQ(end.message, "disk full");
}

TEST(Ranks, AMapIsTheSame) {
  const Mechanism m = test::device("haptic-6psu");
  MapOptions o;
  o.grid = workspace_grid(m, {7, 5, 9});
  o.grid.high_mm.z() += 150;  // some out of reach
  o.length_mm = weighing_length_mm(m);
  const StiffnessMap alone = map_stiffness(m, o);
  const std::string csv = map_csv(alone), json = map_json(alone);
  EXPECT_GT(std::ranges::count_if(alone.poses, [](const MapPose& p) { return !p.reached(); }), 0);
  for (const int size : {2, 3}) {
    const std::vector<Ending> ends = test::ThreadRanks(size).run([&](Ranks& ranks) {
      const StiffnessMap map = map_stiffness(m, o, {1, &ranks});
      if (!ranks.first()) return;
      EXPECT_EQ(map_csv(map), csv);
      EXPECT_EQ(map_json(map), json);
    });
    for (const Ending& end : ends) EXPECT_EQ(end.code, 0) << end.message;
  }
}

TEST(Launched, IsReadFromTheEnvironmentOfTheLauncher) {
  const auto with = [](std::vector<std::pair<const char*, const char*>> variables) {
    for (const auto& [name, value] : variables) ::setenv(name, value, 1);
    const Launched l = launched();
    for (const auto& [name, value] : variables) ::unsetenv(name);
    return std::pair(l.rank, l.size);
  };
  EXPECT_EQ(with({}), std::pair(0, 1));
  EXPECT_EQ(with({{"OMPI_COMM_WORLD_SIZE", "4"}, {"OMPI_COMM_WORLD_RANK", "3"}, {"PMIX_RANK", "3"}}), std::pair(3, 4));
  EXPECT_EQ(with({{"PMI_SIZE", "2"}, {"PMI_RANK", "1"}}), std::pair(1, 2));
  EXPECT_EQ(with({{"PMIX_RANK", "5"}}), std::pair(5, 0));
  EXPECT_EQ(with({{"PMI_SIZE", "2"}, {"PMI_RANK", "1"}, {"DEFLECT_ALONE", "1"}}), std::pair(0, 1));
}

}  // namespace
}  // namespace deflect
