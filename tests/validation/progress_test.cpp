// The progress line with a clock of its own.
#include "validation/parallel/progress.h"

#include <gtest/gtest.h>

#include <sstream>
#include <thread>
#include <vector>

namespace deflect {
namespace {

using namespace parallel;

struct Line {
  std::ostringstream out;
  double now = 100;
  Progress::Clock clock = [this] { return now; };
};

TEST(Progress, KeepsSilentForASecond) {
  Line line;
  {
    Progress p(10, "poses", &line.out, line.clock);
    line.now += 0.9;
    p.update(9);
    p.update(10);
  }
  EXPECT_EQ(line.out.str(), "");
}

TEST(Progress, WritesLinesThatStayWhereTheyCannotBeDrawnOver) {
  Line line;
  {
    Progress p(200, "poses", {&line.out, true}, line.clock);
    for (const std::size_t done : {1u, 50u, 60u, 100u, 101u}) {
      line.now += 6;
      p.update(done);
    }
  }
  EXPECT_EQ(line.out.str(), " 25 %  50 of 200 poses, 36 s left\n 50 %  100 of 200 poses, 24 s left\n");
}

TEST(Progress, SaysHowFarAndHowLong) {
  Line line;
  {
    Progress p(200, "poses", &line.out, line.clock);
    line.now += 2;
    p.update(50);
    EXPECT_NE(line.out.str().find("[######..................]  25 %  50 of 200 poses, 6 s left"), std::string::npos)
        << line.out.str();
  }
  EXPECT_TRUE(line.out.str().ends_with("\r\x1b[K")) << "the line is wiped away";
}

TEST(Progress, PiecesWithoutANameAreNotCountedOut) {
  Line line;
  Progress p(100, "", &line.out, line.clock);
  line.now += 2;
  p.update(50);
  EXPECT_TRUE(line.out.str().ends_with("]  50 %  2 s left")) << line.out.str();
}

TEST(Progress, DrawsAtMostTenTimesASecondAndNeverBackwards) {
  Line line;
  Progress p(1000, "poses", &line.out, line.clock);
  line.now += 2;
  p.update(100);
  const std::string first = line.out.str();
  line.now += 0.05;
  p.update(120);
  EXPECT_EQ(line.out.str(), first);
  line.now += 0.06;
  p.update(90);
  EXPECT_EQ(line.out.str(), first);
  p.update(130);
  EXPECT_NE(line.out.str(), first);
}

TEST(Progress, WithoutAStreamShowsNothing) {
  Line line;
  Progress p(10, "poses", nullptr, line.clock);
  line.now += 5;
  p.update(5);
}

TEST(Progress, TakesUpdatesFromManyThreads) {
  Line line;
  Progress p(4000, "poses", &line.out, line.clock);
  line.now += 2;
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 4; ++t)
      threads.emplace_back([&p, t] {
        for (std::size_t i = 1; i <= 1000; ++i) p.update(4 * i - t);
      });
  }
  EXPECT_NE(line.out.str().find("100 %  4000 of 4000 poses, 0 s left"), std::string::npos);
}

TEST(Duration, InUnitsThatAPersonReads) {
  EXPECT_EQ(duration_text(0.2), "1 s");
  EXPECT_EQ(duration_text(59), "59 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(7500), "2 h 5 min");
}

}  // namespace
}  // namespace deflect
