// The same measurements in other words: the verdict changes as it must, and in no other way.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "msa/mechanism/configuration.h"
#include "msa/mechanism/stand.h"
#include "tests/attack/frame_forms.h"
#include "tests/attack/random_device.h"
#include "tests/attack/random_frame.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/interval.h"
#include "validation/effects/place_effects.h"
#include "validation/measurement/random.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::attack {
namespace {

using measurement::Measurements;
using measurement::Reading;

/// What a diagnosis says, in names and numbers.
struct Said {
  diagnosis::Verdict verdict = diagnosis::Verdict::nothing_missing;
  std::vector<std::string> missing;            ///< "factor@leg.slide.tz (leg 2)"
  std::vector<std::vector<std::string>> ties;  ///< each sorted
  std::vector<double> values, halves;          ///< of what is missing: values, half of their intervals
  double nothing = 0, before = 0, after = 0;   ///< probability; χ² per degree of freedom
};

std::vector<effects::Effect> known(const subject::Subject& s) {
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  return all;
}

Said said_of(const subject::Subject& s, const Measurements& data) {
  const std::vector<effects::Effect> all = known(s);
  diagnosis::DiagnosisOptions o;
  o.bootstrap_sets = 199;
  const diagnosis::Diagnosis d = diagnosis::diagnose(s, s.placed(data), all, o);
  Said out{d.verdict,           {}, d.indistinguishable, {}, {}, d.probability_nothing, d.baseline.chi2_per_dof,
           d.final.chi2_per_dof};
  for (const effects::PlacedEffect& e : d.missing) out.missing.push_back(diagnosis::name_of(e));
  for (auto& tie : out.ties) std::sort(tie.begin(), tie.end());
  for (std::size_t i = 0; i < diagnosis::parameters_of(d.missing).size(); ++i) {
    const auto [low, high] = diagnosis::interval95(d.missing, d.fit, i);
    out.values.push_back(d.fit.values(static_cast<Eigen::Index>(i)));
    out.halves.push_back((high - low) / 2);
  }
  return out;
}

/// What is missing, each with all that these data cannot tell from it: which of them comes first is decided by
/// rounding.
std::vector<std::vector<std::string>> classes_of(const Said& said) {
  std::vector<std::vector<std::string>> out;
  for (const std::string& name : said.missing) {
    out.push_back({name});
    for (const auto& tie : said.ties)
      if (std::find(tie.begin(), tie.end(), name) != tie.end()) out.back() = tie;
  }
  return out;
}

/// `room`: relative, of what is fitted.
void expect_same(const Said& a, const Said& b, double room) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(classes_of(a), classes_of(b));
  EXPECT_EQ(a.ties, b.ties);
  EXPECT_NEAR(a.nothing, b.nothing, room);
  EXPECT_NEAR(a.before, b.before, room * a.before);
  EXPECT_NEAR(a.after, b.after, room * a.after);
  if (a.missing != b.missing) return;  // another of the same class: the values are its own
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    EXPECT_NEAR(a.values[i], b.values[i], room * std::abs(a.values[i])) << i;
    EXPECT_NEAR(a.halves[i], b.halves[i], room * (std::abs(a.values[i]) + a.halves[i])) << i;
  }
}

constexpr double rounded = 1e-5;  // fits end where χ² is flat to 1e-10 of it, which is half as many digits of a value

// A Stewart platform whose second drive is softer than drawn, read at four poses.
class MachineInOtherWords : public ::testing::Test {
 protected:
  static constexpr double sigma = 2e-6, sigma_th = 2e-6;

  static Mechanism machine() {
    Mechanism m = test::device("stewart-6ups");
    m.tolerances.modulus = 0.01, m.tolerances.load = 0.002;
    return m;
  }

  static Mechanism lacking(const Mechanism& m) {
    const std::vector<effects::Effect> all = known(m);
    return effects::with_effect(m, effects::find_effect(all, "factor@leg.slide.tz"), test::values({0.6}), 2);
  }

  static Measurements plan(const Mechanism& m) {
    Measurements out;
    out.origin = "plan";
    measurement::Random random(5);
    for (int p = 0; p < 4; ++p) {
      Vector6 at = mm_deg_from(home_pose(m));
      at.head<3>() += random.uniform3(-200, 200);
      out.poses.push_back({fmt::format("p{}", p), at, {}, {}});
      for (int i = 0; i < 8; ++i) {
        Reading r;
        r.pose = static_cast<std::size_t>(p);
        r.load << random.uniform3(-5000, 5000), random.uniform3(-1000, 1000);
        r.line = out.readings.size() + 2;
        out.poses.back().readings.push_back(out.readings.size());
        out.readings.push_back(r);
      }
    }
    return out;
  }

  static prediction::SimulationOptions options(std::uint64_t seed = 3) {
    prediction::SimulationOptions o;
    o.seed = seed, o.sigma_u = sigma, o.sigma_th = sigma_th, o.tolerances = 0;
    return o;
  }

  static Measurements data(std::uint64_t seed = 3) {
    return prediction::simulate(lacking(machine()), plan(machine()), options(seed));
  }

  static const Said& as_it_was() {
    static const Said said = said_of(machine(), data());
    return said;
  }

  static Measurements read(const std::string& text) { return measurement::parse_measurements(text, "data.csv"); }
};

TEST_F(MachineInOtherWords, IsDiagnosedAtAll) {
  EXPECT_NE(as_it_was().verdict, diagnosis::Verdict::nothing_missing);
  EXPECT_NE(as_it_was().verdict, diagnosis::Verdict::unknown_effect);
  ASSERT_EQ(as_it_was().missing.size(), 1u);
  EXPECT_NE(as_it_was().missing[0].find("(leg 2)"), std::string::npos);
}

/// Poses, loads and readings turned with the base; a quarter turn about z maps what acts along x, y and z onto itself.
Measurements turned(Measurements m, const Matrix3& R) {
  for (measurement::PoseGroup& p : m.poses) {
    const Pose pose = pose_from(p.pose_mm_deg);
    p.pose_mm_deg = mm_deg_from(Pose{R * pose.p_WT, R * pose.R_WT});
  }
  for (Reading& r : m.readings) {
    r.load << R * r.load.head<3>(), R * r.load.tail<3>();
    Vector3 u(*r.displacement[0], *r.displacement[1], *r.displacement[2]),
        th(*r.displacement[3], *r.displacement[4], *r.displacement[5]);
    u = R * u, th = R * th;
    for (std::size_t i = 0; i < 3; ++i)
      r.displacement[i] = u(static_cast<Eigen::Index>(i)), r.displacement[i + 3] = th(static_cast<Eigen::Index>(i));
  }
  return m;
}

TEST_F(MachineInOtherWords, ATurnedBaseChangesNothing) {
  Matrix3 R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  RandomDevice random;
  random.mechanism = machine();
  expect_same(as_it_was(), said_of(attack::turned(random, R).mechanism, turned(data(), R)), rounded);
}

TEST_F(MachineInOtherWords, PermutedLegsPermuteTheVerdict) {
  RandomDevice random;
  random.mechanism = machine();
  Said wanted = as_it_was();
  const auto renumber = [](std::string& name) {
    const std::size_t at = name.find("(leg ");
    if (at != name.npos) name[at + 5] = static_cast<char>('7' - (name[at + 5] - '0'));
  };
  for (std::string& name : wanted.missing) renumber(name);
  for (auto& tie : wanted.ties) {
    for (std::string& name : tie) renumber(name);
    std::sort(tie.begin(), tie.end());
  }
  expect_same(wanted, said_of(reordered(random).mechanism, data()), rounded);
}

TEST_F(MachineInOtherWords, RenamedPartsRenameTheVerdict) {
  std::string text = write_mechanism(machine());
  for (const auto& [from, to] : {std::pair{"slide", "ram"}, {"rod", "bar"}, {"cylinder", "pipe"}})
    text = std::regex_replace(text, std::regex(fmt::format("\\b{}\\b", from)), to);
  Said wanted = as_it_was();
  const auto rename = [](std::string& name) { name = std::regex_replace(name, std::regex("\\bslide\\b"), "ram"); };
  for (std::string& name : wanted.missing) rename(name);
  for (auto& tie : wanted.ties) {
    for (std::string& name : tie) {
      rename(name);
      name = std::regex_replace(std::regex_replace(name, std::regex("\\brod\\b"), "bar"), std::regex("\\bcylinder\\b"),
                                "pipe");
    }
    std::sort(tie.begin(), tie.end());
  }
  expect_same(wanted, said_of(parse_mechanism(text, "renamed"), data()), rounded);
}

/// One column's header and cells, the numbers times a factor.
std::string in_unit(const std::string& text, const std::string& column, const std::string& name, double factor) {
  std::istringstream in(text);
  std::string out, line;
  std::size_t at = 0;
  for (bool header = true; std::getline(in, line); header = false) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (header) {
      at = static_cast<std::size_t>(std::find(cells.begin(), cells.end(), column) - cells.begin());
      cells[at] = name;
    } else {
      cells[at] = fmt::format("{}", std::stod(cells[at]) * factor);
    }
    out += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return out;
}

TEST_F(MachineInOtherWords, OtherUnitsChangeNothing) {
  std::string text = measurement::measurements_text(data());
  for (const auto& [column, name, factor] : {std::tuple{"ux_mm", "ux_um", 1e3},
                                             {"uy_mm", "uy_um", 1e3},
                                             {"uz_mm", "uz_um", 1e3},
                                             {"fx_N", "fx_kN", 1e-3},
                                             {"mx_Nmm", "mx_Nm", 1e-3}})
    text = in_unit(text, column, name, factor);
  expect_same(as_it_was(), said_of(machine(), read(text)), rounded);
}

TEST_F(MachineInOtherWords, ShuffledRowsAndASplitFileChangeNothing) {
  Measurements unordered = data();
  for (Reading& r : unordered.readings) r.sequence.reset();
  const Said wanted = said_of(machine(), unordered);
  std::istringstream text(measurement::measurements_text(unordered));
  std::string header, line, shuffled, second_first;
  std::getline(text, header);
  std::vector<std::string> rows;
  while (std::getline(text, line)) rows.push_back(line);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    shuffled += rows[(i * 13 + 5) % rows.size()] + "\n";  // 13 and 32 have no common factor
    second_first += rows[(i + rows.size() / 2) % rows.size()] + "\n";
  }
  expect_same(wanted, said_of(machine(), read(header + "\n" + shuffled)), rounded);
  expect_same(wanted, said_of(machine(), read(header + "\n" + second_first)), rounded);
}

/// Every reading twice: those of another seed beside them.
Measurements twice(Measurements a, const Measurements& b) {
  const auto shift = static_cast<double>(a.readings.size());
  for (Reading r : b.readings) {
    if (r.sequence) *r.sequence += shift;
    a.poses[r.pose].readings.push_back(a.readings.size());
    r.line = a.readings.size() + 2;
    a.readings.push_back(r);
  }
  return a;
}

// As much again is known: what was found stays, and its interval shrinks, to 1/√2 where noise alone decides it.
TEST_F(MachineInOtherWords, RepeatedRowsTellMoreOfTheSame) {
  const Said more = said_of(machine(), twice(data(), data(4)));
  ASSERT_EQ(more.missing.size(), 1u);
  EXPECT_NE(more.missing[0].find("(leg 2)"), std::string::npos);
  EXPECT_LE(more.nothing, as_it_was().nothing + 1e-9);
  if (more.missing == as_it_was().missing) {
    EXPECT_LT(more.halves[0], 0.95 * as_it_was().halves[0]);
  }
  const auto healthy = [&](std::uint64_t seed) {
    return prediction::simulate(machine(), plan(machine()), options(seed));
  };
  EXPECT_EQ(said_of(machine(), healthy(3)).verdict, diagnosis::Verdict::nothing_missing);
  EXPECT_EQ(said_of(machine(), twice(healthy(3), healthy(4))).verdict, diagnosis::Verdict::nothing_missing);
}

// A space truss with a thin diagonal.
class FrameInOtherWords : public ::testing::Test {
 protected:
  static frame::FrameDescription truss() {
    return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/truss-45.yaml");
  }

  static Measurements data(std::uint64_t seed) {
    const frame::FrameDescription f = truss();
    const std::vector<effects::Effect> all = known(f);
    const subject::Subject s = effects::with_effect(
        subject::Subject(f), {{&effects::find_effect(all, "factor@C1b"), {}}, test::values({0.3})});
    prediction::SimulationOptions o;
    o.seed = seed, o.tolerances = 0;
    return subject::simulate_frame(*s.frame(), subject::frame_campaign("paper", f, 1), o);
  }

  static Measurements of(const frame::FrameDescription& f, const std::string& text) {
    return measurement::parse_measurements(text, "data.csv", subject::Subject(f).instruments());
  }

  static const Said& as_it_was() {
    static const Said said = said_of(truss(), of(truss(), text()));
    return said;
  }

  static std::string text() { return measurement::measurements_text(twice(data(7), data(8))); }
};

TEST_F(FrameInOtherWords, IsDiagnosedAtAll) {
  ASSERT_EQ(as_it_was().missing.size(), 1u);
  const std::vector<std::string> those = classes_of(as_it_was()).front();
  EXPECT_NE(std::find(those.begin(), those.end(), "factor@C1b"), those.end());
}

// Derivatives by the positions of nodes are differences over one standard deviation, to one side: half a millimetre in
// 0.8 m, and the other side where an axis has turned round.
TEST_F(FrameInOtherWords, ATurnedBaseChangesNothing) {
  Matrix3 R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  frame::FrameDescription f = *attack::turned(truss(), R);
  for (auto& [name, s] : f.sensors) {
    if (s.reads != frame::FrameSensor::Reads::displacement) continue;
    s.axis = R * s.axis;
    s.direction = fmt::format("[{:.0f}, {:.0f}, {:.0f}]", s.axis(0), s.axis(1), s.axis(2));
  }
  expect_same(as_it_was(), said_of(f, of(f, text())), 0.5e-3 / 0.8);
}

TEST_F(FrameInOtherWords, AnotherOrderChangesNothing) {
  Dice dice(11);
  const frame::FrameDescription f = shuffled(truss(), dice);
  expect_same(as_it_was(), said_of(f, of(f, text())), rounded);
}

TEST_F(FrameInOtherWords, RenamedMembersRenameTheVerdict) {
  const std::string file = std::regex_replace(frame::write_frame(truss()), std::regex("\\bC1b\\b"), "chord_7");
  const frame::FrameDescription f = frame::parse_frame(file, "renamed");
  Said wanted = as_it_was();
  const auto rename = [](std::string& name) { name = name == "factor@C1b" ? "factor@chord_7" : name; };
  for (std::string& name : wanted.missing) rename(name);
  for (auto& tie : wanted.ties) {
    for (std::string& name : tie) rename(name);
    std::sort(tie.begin(), tie.end());
  }
  expect_same(wanted, said_of(f, of(f, text())), rounded);
}

// A gauge at the foot, which cannot move: it tells nothing but its own noise.
TEST_F(FrameInOtherWords, AnIrrelevantSensorChangesNothing) {
  frame::FrameDescription f = truss();
  frame::FrameSensor foot;
  foot.of = "P0a", foot.direction = "uz", foot.axis = Vector3::UnitZ(), foot.sigma = 4e-6;
  f.sensors.emplace_back("foot", foot);
  std::istringstream in(text());
  std::string out, line;
  measurement::Random random(9);
  for (bool header = true; std::getline(in, line); header = false)
    out += line + (header ? ",foot_mm" : fmt::format(",{:.6f}", 0.004 * random.normal())) + "\n";
  const Said with = said_of(f, of(f, out));
  EXPECT_EQ(with.verdict, as_it_was().verdict);
  EXPECT_EQ(classes_of(with), classes_of(as_it_was()));
  ASSERT_EQ(with.values.size(), 1u);
  EXPECT_NEAR(with.values[0], as_it_was().values[0], 0.05 * as_it_was().halves[0]);  // members of one class at most
}

}  // namespace
}  // namespace deflect::attack
