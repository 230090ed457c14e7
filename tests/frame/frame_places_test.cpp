// Laws in frame files: reading and writing, edits of places that the file does not name, and refusals.
#include <gtest/gtest.h>

#include <sstream>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "tests/support/frames.h"
#include "tests/support/paths.h"

namespace deflect::frame {
namespace {

// The line numbers below count from "name" = 1.
const std::string good = R"(name: laws
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
nodes: {A: [0 mm, 0 mm, 0 mm], B: [500 mm, 0 mm, 0 mm], C: [1000 mm, 0 mm, 100 mm], D: [0 mm, 0 mm, 700 mm]}
members:
  beam: {from: A, to: B, section: rod, material: steel, factor: 90 %, misfit: -0.1 mm}
  bar: {from: B, to: C, section: rod, material: steel, release_to: [ry], end: {ry: {law: linear, stiffness: !ours 5 Nm/rad}, beside: {ry: {law: friction, moment: 1 Nm, stiffness: 50 Nm/rad}}}}
  post: {from: A, to: D, section: rod, material: steel, truss: true, start: {tx: [{law: clearance, gap: 0.1 mm}, {law: hertz_point, material: steel, radius: 5 mm}], rx: {law: linear, stiffness: 2 Nm/rad}}}
supports:
  A: !ours clamped
  B: {holds: [ux, uz], uz: {law: clearance, gap: 0.2 mm}, ry: {law: linear, stiffness: 5 Nm/rad}, beside: {ry: {law: friction, moment: 2 Nm, stiffness: 10 Nm/rad}}}
  D: pinned
  C: {ux: {law: one_sided, pull: 1e6 mm/N}}
springs:
  bed: {node: C, ux: 5 N/mm, uy: !ours 7 N/mm, uz: {law: linear, stiffness: 3 N/mm}, beside: {rz: {law: linear, stiffness: 1 Nm/rad}}}
  block: {node: D, to: B, stiffness: {units: N-m, rows: [[9e5, 1e4, 0, 0, 0, 0], [1e4, 9e5, 0, 0, 0, 0], [0, 0, 9e5, 0, 0, 0], [0, 0, 0, 90, 0, 0], [0, 0, 0, 0, 90, 9], [0, 0, 0, 0, 9, 90]]}}
  stop: {node: D, rx: [{law: clearance, gap: 1 mrad}, {law: power, deflection: 1 mrad, moment: 1 Nm, exponent: 0.7}]}
loads:
  wind: {factor: 1.1, nodes: {C: {fx: 10 N}}}
  sink: {displacements: {A: {uz: -1 mm}}}
)";

TEST(FramePlaces, AreRead) {
  const FrameDescription f = parse_frame(good, "f.yaml");
  EXPECT_EQ(f.members[0].second.factor, 0.9);
  EXPECT_EQ(f.members[0].second.misfit, -1e-4);
  EXPECT_EQ(f.members[1].second.end.at(4), (std::vector<Law>{LinearLaw{5}}));
  EXPECT_EQ(f.members[1].second.end.at(4, true).size(), 1u);
  EXPECT_EQ(f.members[2].second.start.at(0).size(), 2u);
  const FrameSupport& B = f.supports[1].second;
  EXPECT_TRUE(B.rigid(0) && !B.rigid(2) && !B.rigid(4));
  EXPECT_EQ(B.acting(), (Freedoms{true, false, true, false, true, false}));
  EXPECT_EQ(f.springs[0].second.stiffness[2], 3e3);
  EXPECT_TRUE(f.springs[0].second.acting()[5]);
  EXPECT_EQ((*f.springs[1].second.coupled)(1, 0), 1e4);
  EXPECT_EQ(f.springs[2].second.laws.at(3).size(), 2u);
  EXPECT_EQ(f.loads[0].second.factor, 1.1);
}

TEST(FramePlaces, WritingIsTheInverseOfReading) {
  const FrameDescription f = parse_frame(good, "f.yaml");
  const std::string text = write_frame(f);
  const FrameDescription again = parse_frame(text, "written");
  EXPECT_EQ(write_frame(again), text);
  for (const char* part : {"A: !ours [clamped]", "D: [ux, uy, uz]", "ux: 5 N/mm", "uy: !ours 7 N/mm", "uz: 3 N/mm",
                           "stiffness: !ours 5000 Nmm/rad", "factor: 0.9"})
    EXPECT_NE(text.find(part), text.npos) << part << "\n" << text;
  EXPECT_EQ(text.find("start: {}"), text.npos);
  EXPECT_EQ(again.ours, f.ours);
  for (std::size_t i = 0; i < f.members.size(); ++i) {
    EXPECT_EQ(again.members[i].second.start, f.members[i].second.start);
    EXPECT_EQ(again.members[i].second.end, f.members[i].second.end);
  }
  for (std::size_t i = 0; i < f.supports.size(); ++i) {
    EXPECT_EQ(again.supports[i].second.laws, f.supports[i].second.laws);
    EXPECT_EQ(static_cast<const Freedoms&>(again.supports[i].second), f.supports[i].second);
  }
  for (std::size_t i = 0; i < f.springs.size(); ++i) {
    EXPECT_EQ(again.springs[i].second.stiffness, f.springs[i].second.stiffness);
    EXPECT_EQ(again.springs[i].second.laws, f.springs[i].second.laws);
    EXPECT_EQ(again.springs[i].second.coupled, f.springs[i].second.coupled);
  }
}

TEST(FramePlaces, AreEditedWhetherTheFileNamesThemOrNot) {
  using enum Edit::Action;
  const FrameDescription f = parse_frame(good, "f.yaml");
  const Law gap = ClearanceLaw{1e-4}, spring = LinearLaw{3e3};
  const auto law = [](const FreedomLaws& laws, std::size_t i, bool beside = false) { return laws.at(i, beside); };

  FrameDescription e = edited(f, {{"supports.A.ry", "{law: linear, stiffness: 3 Nm/rad}", append},
                                  {"supports.D.uz", "{law: clearance, gap: 0.1 mm}", append}});
  EXPECT_EQ(law(e.supports[0].second.laws, 4), std::vector<Law>{LinearLaw{3}});
  EXPECT_TRUE(e.supports[0].second.rigid(0) && !e.supports[0].second.rigid(4));
  EXPECT_EQ(law(e.supports[2].second.laws, 2), std::vector<Law>{gap});
  e = edited(f, {{"supports.B.uz", "{law: linear, stiffness: 3 N/mm}", append}});
  EXPECT_EQ(law(e.supports[1].second.laws, 2), (std::vector<Law>{ClearanceLaw{2e-4}, spring}));
  e = edited(f, {{"supports.D.beside.rx", "{law: friction, moment: 1 Nm, stiffness: 9 Nm/rad}", append}});
  EXPECT_EQ(law(e.supports[2].second.laws, 3, true), (std::vector<Law>{FrictionLaw{1, 9}}));
  e = edited(f, {{"supports.B.ry.stiffness", "2", multiply}, {"supports.D", "rx", append}});
  EXPECT_EQ(law(e.supports[1].second.laws, 4), std::vector<Law>{LinearLaw{10}});
  EXPECT_TRUE(e.supports[2].second.rigid(3));

  e = edited(f, {{"members.beam.start.ry", "{law: linear, stiffness: 7 Nm/rad}", append},
                 {"members.bar.end.ry", "{law: linear, stiffness: 8 Nm/rad}", set},
                 {"members.post.end.beside.rx", "{law: linear, stiffness: 8 Nm/rad}", append}});
  EXPECT_EQ(law(e.members[0].second.start, 4), std::vector<Law>{LinearLaw{7}});
  EXPECT_EQ(law(e.members[1].second.end, 4), std::vector<Law>{LinearLaw{8}});
  EXPECT_EQ(law(e.members[2].second.end, 3, true), std::vector<Law>{LinearLaw{8}});
  e = edited(f, {{"members.*.factor", "0.5", multiply}, {"members.bar.misfit", "0.3 mm", set}});
  EXPECT_EQ(e.members[0].second.factor, 0.45);
  EXPECT_EQ(e.members[2].second.factor, 0.5);
  EXPECT_EQ(e.members[1].second.misfit, 3e-4);
  e = edited(f, {{"members.*.start.tx", "{law: linear, stiffness: 3 N/mm}", append}});
  EXPECT_EQ(law(e.members[1].second.start, 0), std::vector<Law>{spring});
  EXPECT_EQ(law(e.members[2].second.start, 0).size(), 3u);

  e = edited(f, {{"springs.bed.ux.stiffness", "2", multiply},
                 {"springs.bed.uy", "3", multiply},
                 {"springs.bed.uz", "4 N/mm", set},
                 {"springs.bed.rx", "5 Nm/rad", append}});
  EXPECT_EQ(e.springs[0].second.stiffness, (FreedomValues{10e3, 21e3, 4e3, 5.0, {}, {}}));
  e = edited(f, {{"springs.bed.ux", "{law: clearance, gap: 0.1 mm}", append}});
  EXPECT_EQ(law(e.springs[0].second.laws, 0), (std::vector<Law>{LinearLaw{5e3}, gap}));
  e = edited(f, {{"loads.wind.factor", "2", multiply}, {"loads.sink.factor", "1.5", multiply}});
  EXPECT_EQ(e.loads[0].second.factor, 2.2);
  EXPECT_EQ(e.loads[1].second.factor, 1.5);
}

struct Mistake {
  const char* old_text;
  const char* new_text;
  int line;
  std::vector<const char*> says;
};

const std::vector<Mistake> mistakes = {
    {"uz: {law: clearance, gap: 0.2 mm}",
     "uz: {law: clearence, gap: 0.2 mm}",
     11,
     {"supports.B.uz.0.law: unknown law 'clearence', did you mean 'clearance'?"}},
    {"uz: {law: clearance, gap: 0.2 mm}",
     "uz: {law: clearance, gap: 0.2 N}",
     11,
     {"supports.B.uz.0.gap: '0.2 N' is a force"}},
    {"holds: [ux, uz]", "hold: [ux, uz]", 11, {"supports.B.hold: unknown key, did you mean 'holds'?"}},
    {"holds: [ux, uz]", "holds: [ux, tz]", 11, {"supports.B.holds: unknown freedom 'tz'", "clamped, pinned"}},
    {"beside: {ry: {law: friction, moment: 2 Nm, stiffness: 10 Nm/rad}}",
     "beside: {ux: {law: friction, force: 2 N, stiffness: 10 N/m}}",
     11,
     {"supports.B.beside: ux is rigid here", "give ux a law first"}},
    {"beside: {ry: {law: friction, moment: 2 Nm, stiffness: 10 Nm/rad}}",
     "beside: {ry: {law: friction, moment: 2 Nm, stiffness: 10 Nm/rad, start: 0.5}}",
     11,
     {"supports.B.beside: ry has a friction with start or kept", "leave them away"}},
    {"C: {ux: {law: one_sided, pull: 1e6 mm/N}}", "C: {}", 13, {"supports.C: holds nothing", "'clamped'"}},
    {"C: {ux: {law: one_sided, pull: 1e6 mm/N}}",
     "C: {rx: {law: hertz_point, material: steel, radius: 1 mm}}",
     13,
     {"supports.C.rx.0.law: 'hertz_point' acts along a translation"}},
    {"C: {ux: {law: one_sided, pull: 1e6 mm/N}}",
     "C: {ux: {law: hertz_point, material: steal, radius: 1 mm}}",
     13,
     {"supports.C.ux.0.material: unknown material 'steal', did you mean 'steel'?"}},
    {"C: {ux: {law: one_sided, pull: 1e6 mm/N}}",
     "C: {ux: {law: cable, EA: 1 kN}}",
     13,
     {"supports.C.ux.0.length: is needed here"}},
    {"C: {ux: {law: one_sided, pull: 1e6 mm/N}}",
     "C: {ux: 5 N/mm}",
     13,
     {"supports.C.ux.0: a map of fields 'key: value' is wanted"}},
    {"uy: !ours 7 N/mm", "uy: 7 N", 15, {"springs.bed.uy.0.stiffness: '7 N' is a force"}},
    {"uy: !ours 7 N/mm", "uy:", 15, {"springs.bed.uy.0.stiffness: has no value"}},
    {"node: D, to: B, stiffness:",
     "node: D, to: B, ux: 1 N/mm, stiffness:",
     16,
     {"springs.block.stiffness: is that of all six freedoms", "away"}},
    {"[0, 0, 0, 0, 9, 90]", "[0, 0, 0, 0, 8, 90]", 16, {"springs.block.stiffness.rows: a stiffness is symmetric"}},
    {"[0, 0, 0, 0, 9, 90]",
     "[0, 0, 0, 0, 9, -90]",
     16,
     {"springs.block.stiffness.rows: a stiffness is positive definite", "give those freedoms"}},
    {"rx: [{law: clearance, gap: 1 mrad}, {law: power, deflection: 1 mrad, moment: 1 Nm, exponent: 0.7}]",
     "rx: []",
     17,
     {"springs.stop: has no stiffness"}},
    {"factor: 90 %", "factor: 0", 6, {"members.beam.factor: '0' must be above 0"}},
    {"misfit: -0.1 mm", "misfit: 500 mm", 6, {"members.beam.misfit: must be smaller than the member's length"}},
    {"misfit: -0.1 mm", "misfit: 0.1", 6, {"members.beam.misfit: '0.1' has no unit"}},
    {"end: {ry", "end: {uy", 7, {"members.bar.end.uy: unknown key"}},
    {"release_to: [ry], end: {ry: {law: linear, stiffness: !ours 5 Nm/rad}, beside",
     "end: {beside",
     7,
     {"members.bar.end.beside: ry is rigid here"}},
    {"factor: 1.1", "factor: 1.1 N", 19, {"loads.wind.factor"}},
    {"{A: {uz: -1 mm}}",
     "{B: {uz: -1 mm}}",
     20,
     {"loads.sink.displacements.B.uz: node 'B' is held in uz by a law, which yields"}},
};

class BadPlace : public ::testing::TestWithParam<std::size_t> {};

TEST_P(BadPlace, IsRefusedWithLinePathAndRemedy) {
  const Mistake& m = mistakes[GetParam()];
  std::string text = good;
  const std::size_t at = text.find(m.old_text);
  ASSERT_NE(at, text.npos) << m.old_text;
  text.replace(at, std::string(m.old_text).size(), m.new_text);
  try {
    parse_frame(text, "f.yaml");
    FAIL() << "was read: " << m.new_text;
  } catch (const InputError& e) {
    const std::string message = e.what();
    EXPECT_EQ(message.find("f.yaml:" + std::to_string(m.line) + ": "), 0u) << message << "\n  for " << m.new_text;
    for (const char* phrase : m.says)
      EXPECT_NE(message.find(phrase), message.npos) << message << "\n  lacks " << phrase;
  }
}

INSTANTIATE_TEST_SUITE_P(Mistakes, BadPlace, ::testing::Range<std::size_t>(0, mistakes.size()));

TEST(FramePlaces, AnEditThatDoesNotFitIsTold) {
  const FrameDescription f = parse_frame(good, "f.yaml");
  using enum Edit::Action;
  for (const auto& [edit, says] : std::vector<std::pair<Edit, const char*>>{
           {{"supports.B.vz", "{law: clearance, gap: 0.1 mm}", append}, "there is no 'vz', did you mean"},
           {{"springs.bed.rx.stiffness", "2", multiply}, "'springs.bed.rx' is empty"},
           {{"members.beam.start.ry", "5 Nm/rad", append}, "a map of fields"},
           {{"members.beam.begin.ry", "{law: linear, stiffness: 7 Nm/rad}", append}, "there is no 'begin'"}})
    try {
      edited(f, {edit});
      FAIL() << edit.path;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
    }
}

/// The example in frame_file.h has every key.
TEST(FramePlaces, TheExampleOfTheHeaderIsAFrame) {
  std::istringstream lines(read_text(std::filesystem::path(test::source_dir()) / "msa/frame/file/frame_file.h"));
  std::string text, line;
  while (std::getline(lines, line) && line != "#pragma once")
    if (line.starts_with("//   ")) text += line.substr(5) + "\n";
  EXPECT_EQ(parse_frame(text, "frame_file.h").loads.size(), 1u) << text;
}

}  // namespace
}  // namespace deflect::frame
