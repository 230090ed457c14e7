// What is written reads back as the same; what is damaged is read or refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <random>

#include "msa/base/files.h"
#include "tests/support/devices.h"
#include "tests/support/measurements.h"
#include "validation/measurement/measurement_columns.h"

namespace deflect {
namespace {

using namespace measurement;

using test::uniform;

bool chance(std::mt19937& random) { return random() % 2 == 0; }

/// Any magnitude that measurements have, with `digits` digits.
std::string random_number(std::mt19937& random, int digits) {
  return fmt::format("{:.{}g}", uniform(random, -1, 1) * std::pow(10, uniform(random, -7, 4)), digits);
}

/// Columns in any order and subset, any cell that may be empty is so now and then.
std::string random_file(std::mt19937& random, int rows) {
  struct Column {
    std::string name;
    bool of_pose = false, may_be_empty = false, positive = false, whole = false, text = false;
  };
  std::vector<Column> columns;
  if (chance(random))
    for (std::size_t i = 0; i < 1 + random() % 8; ++i) columns.push_back({joint_column(i, chance(random)), true});
  else
    for (const std::string& name : pose_columns) columns.push_back({name, true});
  for (std::size_t i = 0; i < 6; ++i)
    if (i < 3 || chance(random)) columns.push_back({load_columns[i]});
  const std::size_t always = random() % 6;
  for (std::size_t i = 0; i < 6; ++i)
    if (i == always || chance(random)) columns.push_back({displacement_columns[i], false, true});
  for (const char* name : {"sigma_u_mm", "sigma_th_rad", "temperature_C"})
    if (chance(random)) columns.push_back({name, false, true, true});
  if (chance(random)) columns.push_back({"sequence", false, false, false, true});
  if (chance(random)) columns.push_back({"note; \"quoted\"", false, true, false, false, true});
  columns.push_back({"pose"});
  std::shuffle(columns.begin(), columns.end(), random);

  const int digits = 1 + static_cast<int>(random() % 17);
  const std::size_t poses = 1 + random() % 4;
  std::vector<std::vector<std::string>> commands(poses, std::vector<std::string>(columns.size()));
  for (auto& command : commands)
    for (std::string& cell : command) cell = random_number(random, digits);
  const auto quoted = [](std::string s) {
    for (std::size_t i = 0; (i = s.find('"', i)) != s.npos; i += 2) s.insert(i, 1, '"');
    return '"' + s + '"';
  };
  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + quoted(column.name);
  for (int row = 0; row < rows; ++row) {
    text += '\n';
    const std::size_t pose = random() % poses;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Column& column = columns[i];
      if (i > 0) text += ',';
      if (column.may_be_empty && random() % 4 == 0) continue;
      if (column.name == "pose")
        text += quoted(fmt::format(" pose; {}\n", pose));
      else if (column.of_pose)
        text += commands[pose][i];
      else if (column.text)
        text += quoted(" \"mild\", ä\r\n");
      else if (column.whole)
        text += std::to_string(1000 - row);
      else if (const std::string number = random_number(random, digits); column.positive && number.front() == '-')
        text += number.substr(1);
      else
        text += number;
    }
  }
  return text;
}

void expect_same(const Measurements& a, const Measurements& b) {
  EXPECT_EQ(a.joint_rotates, b.joint_rotates);
  EXPECT_EQ(a.note_columns, b.note_columns);
  EXPECT_EQ(a.temperature_recorded, b.temperature_recorded);
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_EQ(a.poses[i].label, b.poses[i].label);
    EXPECT_EQ(a.poses[i].pose_mm_deg, b.poses[i].pose_mm_deg);
    EXPECT_EQ(a.poses[i].joints, b.poses[i].joints);
    EXPECT_EQ(a.poses[i].readings, b.poses[i].readings);
  }
  ASSERT_EQ(a.readings.size(), b.readings.size());
  for (std::size_t i = 0; i < a.readings.size(); ++i) {
    const Reading &r = a.readings[i], &s = b.readings[i];
    EXPECT_EQ(r.pose, s.pose);
    EXPECT_EQ(r.load, s.load);
    EXPECT_EQ(r.displacement, s.displacement);
    EXPECT_EQ(r.sigma_u, s.sigma_u);
    EXPECT_EQ(r.sigma_th, s.sigma_th);
    EXPECT_EQ(r.sequence, s.sequence);
    EXPECT_EQ(r.temperature_C, s.temperature_C);
    EXPECT_EQ(r.notes, s.notes);
  }
}

TEST(MeasurementWriter, WhatIsWrittenReadsBackAsTheSame) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const std::string text = random_file(random, 1 + static_cast<int>(random() % 12));
    SCOPED_TRACE(text);
    const Measurements m = parse_measurements(text, "data.csv");
    expect_same(m, parse_measurements(measurements_text(m), "data.csv"));
    if (HasFailure()) return;
  }
}

TEST(MeasurementWriter, WritesShortNumbersAndNoIdleColumns) {
  const std::string text = test::usual_file("a,0,0,173.898547,0,0,0,-50,0,0,-0.110991,,1e-07\n");
  EXPECT_EQ(
      measurements_text(parse_measurements(
          "sigma_th_rad,thx_rad,mx_Nmm,ux_mm,uz_mm,fx_N,fy_N,fz_N,z_mm,y_mm,x_mm,yaw_deg,pitch_deg,roll_deg,pose\n"
          ",,0,-0.110991000,1e-7,-50.0,0,0,173.898547,0,0,0,0,0,a\n",
          "data.csv")),
      text);
}

TEST(MeasurementWriter, ComputedValuesReadBackToTheLastPlace) {
  std::mt19937 random(6);
  Measurements m = parse_measurements(test::usual_file("a,0,0,174,0,0,0,50,0,0,1,1,1\n"), "data.csv");
  for (int trial = 0; trial < 1000; ++trial) {
    const double u = uniform(random, -1e-3, 1e-3);
    m.readings[0].displacement[0] = u;
    const double back = *parse_measurements(measurements_text(m), "data.csv").readings[0].displacement[0];
    EXPECT_LE(std::abs(back - u), std::abs(std::nextafter(u, 1) - u));
  }
}

TEST(MeasurementWriter, WritesFiles) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("measurements{}.csv", ::getpid());
  const Measurements m = parse_measurements(test::usual_file("a,0,0,174,0,0,0,50,0,0,1,1,1\n"), "data.csv");
  write_measurements(path, m);
  const Measurements back = read_measurements(path);
  std::filesystem::remove(path);
  EXPECT_EQ(back.origin, path.string());
  expect_same(m, back);
  EXPECT_THROW(write_measurements("/dev/null/no folder/data.csv", m), InputError);
}

TEST(Measurements, DamagedFilesAreReadOrRefused) {
  std::mt19937 random(7);
  const std::string alphabet = ",;\t\"\r\n #.-+eE0123456789_abmqxNnif\xEF\xBB\xBF\xC3\xA4\xFF";
  int read = 0, refused = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int trial = 0; trial < 4000; ++trial) {
    std::string text = random_file(random, 3);
    for (std::size_t damage = 0; damage <= random() % 3; ++damage) {
      const std::size_t at = random() % text.size();
      const char c = random() % 20 == 0 ? static_cast<char>(random() % 256) : alphabet[random() % alphabet.size()];
      switch (random() % 4) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        case 2:
          text.erase(at, 1 + random() % 3);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 30));
      }
    }
    SCOPED_TRACE(text);
    try {
      const Measurements m = parse_measurements(text, "data.csv");
      expect_same(m, parse_measurements(measurements_text(m), "data.csv"));
      ++read;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("data.csv:")) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      ++refused;
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(read, 400);
  EXPECT_GT(refused, 400);
  // A third of a second; ten times that without optimisation and with sanitizers.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

}  // namespace
}  // namespace deflect
