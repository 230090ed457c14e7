// Mistakes of recording in files of frames: channels that show another quantity or nothing, readings that contradict
// each other, loads that nobody knows, names in another case.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "validation/compare/comparison.h"
#include "validation/measurement/parse_plan.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace measurement;
using subject::Subject;

frame::FrameDescription built_in(const std::string& name) {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"));
}

/// Readings of the frame where `sensor` is another one.
Measurements read_with(const frame::FrameDescription& f, const std::string& sensor, const frame::FrameSensor& instead) {
  frame::FrameDescription other = f;
  for (auto& [name, value] : other.sensors)
    if (name == sensor) value = instead;
  return subject::simulate_frame(other, subject::frame_campaign("rich", f, 1), {});
}

/// Ids of the first mistake that is found, if it is certain.
std::vector<std::string> mistake_in(const frame::FrameDescription& f, const Measurements& data) {
  const compare::Comparison c = compare::compare(Subject(f), data);
  return compare::is_mistaken(c) ? c.mistakes.front().ids : std::vector<std::string>();
}

bool holds(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

struct Shown {
  const char *frame, *sensor;
  void (*turn)(frame::FrameSensor&);
  const char* id;
};

class ShowsAnother : public testing::TestWithParam<Shown> {};

TEST_P(ShowsAnother, IsSaidWithWhatItShows) {
  const Shown& p = GetParam();
  const frame::FrameDescription f = built_in(p.frame);
  frame::FrameSensor instead = *find(f.sensors, p.sensor);
  p.turn(instead);
  const std::vector<std::string> ids = mistake_in(f, read_with(f, p.sensor, instead));
  EXPECT_TRUE(holds(ids, p.id)) << (ids.empty() ? "none" : ids.front());
}

INSTANTIATE_TEST_SUITE_P(
    Channels, ShowsAnother,
    testing::Values(
        Shown{"portal-semi-rigid", "top_x", [](frame::FrameSensor& s) { s.of = "M", s.direction = "uz"; },
              "top_x_shows_uz of node M"},
        Shown{"portal-semi-rigid", "turn_C", [](frame::FrameSensor& s) { s.of = "M"; }, "turn_C_shows_ry of node M"},
        Shown{"portal-semi-rigid", "foot_z", [](frame::FrameSensor& s) { s.of = "A"; }, "foot_z_shows_fz of support A"},
        Shown{"beam-on-springs", "S_mid", [](frame::FrameSensor& s) { s.of = "rail7"; },
              "S_mid_shows_the strain of member rail7 at 1 of its length, y = 0 mm, z = -70 mm"},
        Shown{"truss-45", "F_C0a", [](frame::FrameSensor& s) { s.of = "C0b"; }, "F_C0a_shows_axial of member C0b"},
        Shown{"lattice-girder", "mid_l", [](frame::FrameSensor& s) { s.of = "l3"; }, "mid_l_shows_uz of node l3"}));

// In the deformed shape the load of every other node is tried by linear geometry first.
TEST(FrameRecording, ALoadAtAnotherNodeIsFoundInTheDeformedShape) {
  frame::FrameDescription f = built_in("portal-semi-rigid");
  f.geometry = Geometry::finite;
  frame::FrameDescription truth = f;
  for (auto& [name, load] : truth.loads)
    if (name == "above") load.nodes.front().first = "C";
  const Measurements data = subject::simulate_frame(truth, subject::frame_campaign("rich", f, 1), {});
  const std::vector<std::string> ids = mistake_in(f, data);
  EXPECT_TRUE(holds(ids, "load.above_at_C")) << (ids.empty() ? "none" : ids.front());
}

// The file has a column of zeros for the node where the jack stood: as many components are loaded either way.
TEST(FrameRecording, AJackIsFoundAtAnotherNodeThatTheFileNamesToo) {
  const frame::FrameDescription f = built_in("portal-semi-rigid");
  const test::Folder folder;
  std::ofstream(folder / "jack.csv") << "node.M.fz_N,node.C.fz_N\n2000,0\n4000,0\n-3000,0\n-6000,0\n5000,0\n-1000,0\n";
  const Measurements campaign = Subject(f).placed(read_campaign(folder / "jack.csv", Subject(f).instruments()));
  Measurements data = subject::simulate_frame(f, campaign, {});
  ASSERT_TRUE(mistake_in(f, data).empty());
  for (Reading& r : data.readings) std::swap(r.at_points[0], r.at_points[1]);
  const std::vector<std::string> ids = mistake_in(f, data);
  EXPECT_TRUE(holds(ids, "node.C_at_M")) << (ids.empty() ? "none" : ids.front());
}

// What is there in a healthy frame, or missing in one member, is no mistake of a channel.
TEST(FrameRecording, AChannelIsNotSaidToShowAnotherWhereItDoesNot) {
  frame::FrameDescription f = built_in("portal-semi-rigid");
  const Measurements healthy = subject::simulate_frame(f, subject::frame_campaign("rich", f, 1), {});
  EXPECT_TRUE(mistake_in(f, healthy).empty());
  frame::FrameDescription soft = f;
  for (auto& [name, member] : soft.members)
    if (name == "left") member.factor = 0.5;
  EXPECT_TRUE(mistake_in(f, subject::simulate_frame(soft, subject::frame_campaign("rich", f, 1), {})).empty());
  frame::FrameDescription gain = f;
  for (auto& [name, sensor] : gain.sensors)
    if (name == "S_left") sensor.gain = 1.3;
  EXPECT_TRUE(mistake_in(f, subject::simulate_frame(gain, subject::frame_campaign("rich", f, 1), {})).empty());
}

TEST(FrameRecording, AChannelOfZerosWasNotConnected) {
  const frame::FrameDescription f = built_in("beam-on-springs");
  Measurements data = subject::simulate_frame(f, subject::frame_campaign("rich", f, 1), {});
  for (Reading& r : data.readings) r.sensors[7] = 0;
  EXPECT_EQ(mistake_in(f, data), std::vector<std::string>{"zero_column_S_mid_um_per_m"});
}

/// Of readings in which one channel is so many times what it should be.
std::vector<std::string> mistake_where_scaled(const std::string& frame, const char* plan, const char* sensor,
                                              double factor) {
  const frame::FrameDescription f = built_in(frame);
  Measurements data = subject::simulate_frame(f, subject::frame_campaign(plan, f, 1), {});
  const auto at = std::find_if(f.sensors.begin(), f.sensors.end(), [&](const auto& s) { return s.first == sensor; });
  for (Reading& r : data.readings) *r.sensors[as_size(at - f.sensors.begin())] *= factor;
  return mistake_in(f, data);
}

// The errors of displacements say nothing of a force or a strain, and few readings little against a gain by channel.
TEST(FrameRecording, AForceWithTheOtherSignOrInAnotherUnitIsNoGain) {
  constexpr double lbf = 4.4482216152605;
  EXPECT_EQ(mistake_where_scaled("portal-semi-rigid", "paper", "foot_z", -1), std::vector<std::string>{"foot_z_sign"});
  EXPECT_EQ(mistake_where_scaled("portal-semi-rigid", "cycle", "foot_z", -1), std::vector<std::string>{"foot_z_sign"});
  EXPECT_EQ(mistake_where_scaled("portal-semi-rigid", "paper", "foot_z", 1 / lbf),
            std::vector<std::string>{"foot_z_in_lbf"});
  EXPECT_EQ(mistake_where_scaled("truss-45", "cycle", "S_C1d", -1), std::vector<std::string>{"S_C1d_sign"});
  EXPECT_EQ(mistake_where_scaled("truss-45", "paper", "F_C0c", 1 / lbf), std::vector<std::string>{"F_C0c_in_lbf"});
  EXPECT_TRUE(mistake_where_scaled("portal-semi-rigid", "cycle", "foot_z", 1.3).empty());
}

// From the tenth reading on the gauge reads what it read there; a load that comes back is no standstill.
TEST(FrameRecording, AChannelThatStandsStillIsSaid) {
  const frame::FrameDescription f = built_in("portal-semi-rigid");
  Measurements data = subject::simulate_frame(f, subject::frame_campaign("cycle", f, 1), {});
  EXPECT_TRUE(mistake_in(f, data).empty());
  for (std::size_t i = 10; i < data.readings.size(); ++i) data.readings[i].sensors[0] = data.readings[9].sensors[0];
  EXPECT_EQ(mistake_in(f, data), std::vector<std::string>{"stuck_top_x_mm"});
}

// Whatever the campaign is written for, it has a column for each sensor of the frame, with empty cells.
TEST(FrameRecording, ACampaignIsOfTheFramesSensors) {
  const frame::FrameDescription f = built_in("portal-semi-rigid");
  const Measurements plan = subject::frame_campaign("paper", f, 1);
  std::vector<std::string> names, wanted;
  for (const measurement::SensorChannel& s : plan.instruments.sensors) names.push_back(s.name);
  for (const auto& [name, sensor] : f.sensors) wanted.push_back(name);
  EXPECT_EQ(names, wanted);
  for (const measurement::Reading& r : plan.readings)
    EXPECT_EQ(r.sensors, std::vector<std::optional<double>>(wanted.size()));
}

// Row 3 and its repetition differ by 1 mm, 500 times the noise of the dial gauge.
TEST(FrameRecording, ReplicatesThatContradictEachOtherAreNamedByLine) {
  const frame::FrameDescription f = built_in("beam-on-springs");
  Measurements data = subject::simulate_frame(f, subject::frame_campaign("rich", f, 1), {});
  for (std::size_t i = 0; i < data.readings.size(); ++i) data.readings[i].line = i + 2;
  *data.readings[1].sensors[2] += 1e-3;
  const compare::Comparison c = compare::compare(Subject(f), data);
  const auto found = std::find_if(c.mistakes.begin(), c.mistakes.end(), [](const auto& m) {
    return m.ids.front() == "contradiction" && m.sentence.find("z4_mm differs by ") != std::string::npos;
  });
  ASSERT_NE(found, c.mistakes.end());
  EXPECT_FALSE(found->certain);
  EXPECT_NE(found->sentence.find("lines 3 and "), std::string::npos) << found->sentence;
  EXPECT_NE(found->sentence.find("at the same load"), std::string::npos) << found->sentence;
}

// More than a quarter of the readings, those under wind, is off by what another sensor reads: that is one effect and
// not so many outliers.
TEST(FrameRecording, WhatIsOffUnderOneLoadIsNotSetAside) {
  frame::FrameDescription f = built_in("lattice-girder");
  frame::FrameDescription with = f;
  for (auto& [name, sensor] : with.sensors)
    if (name == "slide_x") sensor.crosstalk = {{"wind_y", 0.3}};
  const compare::Comparison c =
      compare::compare(Subject(f), subject::simulate_frame(with, subject::frame_campaign("rich", f, 1), {}));
  EXPECT_LE(20 * c.set_aside.size(), c.readings);
}

Measurements read(const Subject& s, const std::string& csv) {
  return s.placed(parse_measurements(csv, "data.csv", s.instruments()));
}

TEST(FrameRecording, ALoadThatNobodyKnowsIsRefused) {
  const Subject s = built_in("portal-semi-rigid");
  const auto refusal = [&](const std::string& cell) -> std::string {
    try {
      read(s, fmt::format("top_x_mm,load.side,node.M.fz_N\n2,1,0\n2,{},1\n", cell));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  for (const char* cell : {"NaN", "#N/A", "n.a.", "#VALUE!"})
    EXPECT_NE(refusal(cell).find(fmt::format("data.csv:3: column 'load.side': '{}' is no load", cell)),
              std::string::npos)
        << refusal(cell);
  for (const char* none : {"", "-", "0"}) EXPECT_EQ(refusal(none), "");
}

TEST(FrameRecording, NamesMayBeWrittenInAnotherCase) {
  const Subject s = built_in("portal-semi-rigid");
  const Measurements data = read(s, "LOAD.SIDE,NODE.M.FZ_N,TOP_X_MM\n0.5,3,2\n");
  EXPECT_EQ(data.instruments.load_cases, std::vector<std::string>{"side"});
  EXPECT_EQ(data.readings.front().factors.front(), 0.5);
  EXPECT_EQ(data.readings.front().at_points.front()(2), 3);
  EXPECT_NEAR(*data.readings.front().sensors.front(), 2e-3, 1e-18);
}

// Where names differ by their case alone, each is what it says.
TEST(FrameRecording, NamesThatDifferByTheirCaseAreTwo) {
  frame::FrameDescription f = built_in("portal-semi-rigid");
  f.sensors.emplace_back("TOP_X", f.sensors.front().second);
  f.sensors.back().second.of = "C";
  f.loads.emplace_back("SIDE", f.loads.front().second);
  const Measurements data = read(Subject(f), "load.SIDE,TOP_X_mm,load.side,top_x_mm\n1,2,3,4\n");
  const Instruments& read_by = data.instruments;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(data.readings.front().factors[k], read_by.load_cases[k] == "SIDE" ? 1 : 3);
    EXPECT_NEAR(*data.readings.front().sensors[k], read_by.sensors[k].name == "TOP_X" ? 2e-3 : 4e-3, 1e-18);
  }
}

}  // namespace
}  // namespace deflect
