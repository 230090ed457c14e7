// Frame files: what is read, that writing is its inverse, and that every mistake is told with its line and the way out.
#include "msa/frame/file/frame_file.h"

#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/frame/file/frame_analysis.h"

namespace deflect::frame {
namespace {

// The line numbers below count from "name" = 1.
const std::string good = R"(name: everything
about: one of each
materials:
  steel: {E: 210 GPa, nu: !ours 0.3, density: 7850 kg/m^3, expansion: 12e-6 1/K}
  wood: {E: 10 GPa, G: 0.6 GPa}
sections:
  rod: {shape: round, diameter: 20 mm}
  bar: {shape: given, A: 100 mm^2, Iy: 1000 mm^4, Iz: 2000 mm^4, J: 500 mm^4}
nodes:
  1: [0 mm, 0 mm, 0 mm]
  2: [500 mm, 0 mm, 0 mm]
  3: [500 mm, 400 mm, 0 mm]
  top left: [0 mm, 0 mm, 300 mm]
  N5: [0 mm, 100 mm, 300 mm]
  N6: [500 mm, 0 mm, 300 mm]
members:
  beam: {from: 1, to: 2, section: rod, material: steel, beam: timoshenko}
  side: {from: 2, to: 3, section: rod, material: steel, release_to: [ry, rz], bending_factor: 0.9}
  post: {from: 1, to: top left, section: bar, material: steel, y_axis: [1, 1, 0]}
  tie: {from: 2, to: N6, section: bar, material: steel, release_from: rz}
supports:
  1: clamped
  3: pinned
  N6: [rx, ry, rz]
springs:
  soft: {node: N6, ux: 500 N/mm, uy: 500 N/mm, uz: 500 N/mm}
  hinge: {node: 3, rx: 10 Nm/rad, ry: 10 Nm/rad, rz: 10 Nm/rad}
  between: {node: N6, to: top left, ux: 40 N/mm}
rigid_links:
  plate: {master: top left, nodes: N5}
constraints:
  equal: {terms: [{node: 2, freedom: uy}, {node: N6, freedom: uy, factor: -1}]}
  lever: {terms: [{node: N6, freedom: ux}, {node: 2, freedom: rz, factor: 2, arm: 10 mm}]}
loads:
  case 1:
    nodes: {2: {fz: -100 N, my: 3 Nm}, N5: {fx: 10 N}}
    members:
      beam: {qz: -2 N/mm}
      side: {qy: 0.5 kN/m, axes: member}
    temperature: {beam: 40 K, side: -20 K}
    gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
    displacements: {1: {uz: -1 mm, rx: 0.1 deg}}
  case-2: {nodes: {2: {fx: 1 kN}}}
)";

TEST(FrameFile, ReadsEveryField) {
  const FrameDescription f = parse_frame(good, "f.yaml");
  EXPECT_EQ(f.name, "everything");
  EXPECT_EQ(f.materials[0].second.density, 7850);
  EXPECT_EQ(f.materials[0].second.expansion, 12e-6);
  EXPECT_EQ(f.materials[1].second.elastic.G, 0.6e9);
  EXPECT_EQ(f.ours, std::set<std::string>{"materials.steel.nu"});
  ASSERT_EQ(f.nodes.size(), 6u);
  EXPECT_EQ(f.nodes[3].first, "top left");
  EXPECT_EQ(f.nodes[2].second, Vector3(0.5, 0.4, 0));
  EXPECT_EQ(f.members[0].second.beam, BeamTheory::timoshenko);
  EXPECT_EQ(f.members[1].second.release_to, (Freedoms{false, false, false, false, true, true}));
  EXPECT_EQ(f.members[1].second.bending_factor, 0.9);
  EXPECT_EQ(f.members[2].second.y_axis, Vector3(1, 1, 0));
  EXPECT_EQ(f.supports[0].second, (Freedoms{true, true, true, true, true, true}));
  EXPECT_EQ(f.supports[1].second, (Freedoms{true, true, true, false, false, false}));
  EXPECT_EQ(f.springs[0].second.stiffness[2], 500e3);
  EXPECT_FALSE(f.springs[0].second.stiffness[3]);
  EXPECT_EQ(f.springs[2].second.to, "top left");
  EXPECT_EQ(f.rigid_links[0].second.nodes, std::vector<std::string>{"N5"});
  EXPECT_EQ(f.constraints[1].second.terms[1].freedom, 5);
  EXPECT_EQ(f.constraints[1].second.terms[1].arm, 0.01);
  const LoadCase& c = f.loads[0].second;
  EXPECT_EQ(c.nodes[0].second, (Vector6() << 0, 0, -100, 0, 3, 0).finished());
  EXPECT_EQ(c.members[0].second.q, Vector3(0, 0, -2000));
  EXPECT_TRUE(c.members[1].second.member_axes);
  EXPECT_EQ(c.temperature[1].second, -20);
  EXPECT_EQ(c.gravity, Vector3(0, 0, -9.81));
  EXPECT_EQ(c.displacements[0].second[2], -0.001);
  EXPECT_EQ(c.displacements[0].second[3], 0.1 * pi / 180);
  EXPECT_EQ(f.loads[1].first, "case-2");
}

TEST(FrameFile, WritingIsTheInverseOfReading) {
  const FrameDescription f = parse_frame(good, "f.yaml");
  const std::string text = write_frame(f);
  const FrameDescription again = parse_frame(text, "written");
  EXPECT_EQ(write_frame(again), text);
  EXPECT_NE(text.find("nu: !ours 0.3"), text.npos) << text;
  const FrameResult a = analyse(f), b = analyse(again);
  ASSERT_EQ(a.cases.size(), b.cases.size());
  for (std::size_t c = 0; c < a.cases.size(); ++c) EXPECT_EQ(a.cases[c].u, b.cases[c].u);
}

struct Mistake {
  const char* old_text;
  const char* new_text;
  int line;
  std::vector<const char*> says;
};

const std::vector<Mistake> mistakes = {
    // Keys and units
    {"supports:", "suports:", 21, {"suports: unknown key, did you mean 'supports'?"}},
    {"section: bar, material: steel, y_axis",
     "sektion: bar, material: steel, y_axis",
     19,
     {"members.post.sektion: unknown key, did you mean 'section'?"}},
    {"  2: [500 mm, 0 mm, 0 mm]", "  2: [500, 0 mm, 0 mm]", 11, {"nodes.2.0: '500' has no unit", "'500 mm'"}},
    {"  2: [500 mm, 0 mm, 0 mm]",
     "  2: [500 mm, 0 mm]",
     11,
     {"nodes.2: a list of three values is wanted", "'[10 mm, 10 mm, 10 mm]'"}},
    {"  2: [500 mm, 0 mm, 0 mm]",
     "  2: [500 N, 0 mm, 0 mm]",
     11,
     {"nodes.2.0: '500 N' is a force, where a length is wanted"}},
    {"{qz: -2 N/mm}", "{qz: -2 N}", 38, {"loads.case 1.members.beam.qz: '-2 N' is a force, where a line load"}},
    {"beam: 40 K", "beam: 40", 40, {"loads.case 1.temperature.beam: '40' has no unit", "'40 K'"}},
    {"ux: 40 N/mm", "ux: 40 Nm/rad", 28, {"springs.between.ux", "a rotational stiffness"}},
    {"[0 m/s^2, 0 m/s^2, -9.81 m/s^2]", "-9.81 m/s^2", 41, {"loads.case 1.gravity: a list of three values"}},
    {"density: 7850 kg/m^3", "density: 0 kg/m^3", 4, {"materials.steel.density", "must be above 0"}},
    {"nu: !ours 0.3", "nu: 0.3, G: 80 GPa", 4, {"materials.steel.G: nu and G are both given"}},
    {"nu: !ours 0.3, ", "", 4, {"materials.steel.nu: is missing: give nu or G"}},
    // Names
    {"to: 2, section: rod",
     "to: 7, section: rod",
     17,
     {"members.beam.to: unknown node '7'", "known: 1, 2, 3, top left, N5, N6"}},
    {"to: top left, section",
     "to: top lift, section",
     19,
     {"members.post.to: unknown node 'top lift', did you mean 'top left'?"}},
    {"section: rod, material: steel, beam",
     "section: rad, material: steel, beam",
     17,
     {"members.beam.section: unknown section 'rad', did you mean 'rod'? (known: rod, bar)"}},
    {"material: steel, beam",
     "material: steal, beam",
     17,
     {"members.beam.material: unknown material 'steal', did you mean 'steel'?"}},
    {"  3: pinned", "  4: pinned", 23, {"supports.4: unknown node '4'"}},
    {"  3: pinned", "  3: pined", 23, {"supports.3.holds: unknown freedom 'pined', did you mean 'pinned'?"}},
    {"master: top left", "master: middle", 30, {"rigid_links.plate.master: unknown node 'middle'"}},
    {"nodes: N5}", "nodes: [N5, N7]}", 30, {"rigid_links.plate.nodes: unknown node 'N7', did you mean 'N5'?"}},
    {"{node: 2, freedom: uy}",
     "{node: 2, freedom: vy}",
     32,
     {"constraints.equal.terms.0.freedom: unknown freedom 'vy'"}},
    {"node: 3, rx", "node: 33, rx", 27, {"springs.hinge.node: unknown node '33', did you mean '3'?"}},
    {"N5: {fx: 10 N}", "N9: {fx: 10 N}", 36, {"loads.case 1.nodes.N9: unknown node 'N9', did you mean 'N5'?"}},
    {"N5: {fx: 10 N}", "N5: {fw: 10 N}", 36, {"loads.case 1.nodes.N5.fw: unknown key, did you mean 'fx'?"}},
    {"      side: {qy",
     "      sides: {qy",
     39,
     {"loads.case 1.members.sides: unknown member 'sides', did you mean 'side'?"}},
    {"side: -20 K", "sida: -20 K", 40, {"loads.case 1.temperature.sida: unknown member 'sida', did you mean 'side'?"}},
    {"axes: member",
     "axes: local",
     39,
     {"loads.case 1.members.side.axes: unknown axes 'local'", "known: base, member"}},
    {"  1: [0 mm", "  -1: [0 mm", 10, {"nodes.-1: a name begins with a letter or a digit"}},
    {"  case-2:", "  case/2:", 43, {"loads.case/2: a name begins with"}},
    // Geometry
    {"to: 2, section: rod", "to: 1, section: rod", 17, {"members.beam.to: must be another node than 'from'"}},
    {"  2: [500 mm,", "  2: [0 mm,", 17, {"members.beam.to: '1' and '2' are at one place", "rigid_links or springs"}},
    {"y_axis: [1, 1, 0]", "y_axis: [0, 0, 2]", 19, {"members.post.y_axis: is parallel to the member"}},
    // What is held, and how
    {"  3: pinned", "  1: pinned", 23, {"supports.1: given twice, first on line 22"}},
    {"[rx, ry, rz]\nsprings", "[rx, ry, rx]\nsprings", 24, {"supports.N6.holds: 'rx' is named twice"}},
    {"[rx, ry, rz]\nsprings", "[rx, clamped]\nsprings", 24, {"supports.N6.holds: 'clamped' stands alone"}},
    {"[rx, ry, rz]\nsprings", "[]\nsprings", 24, {"supports.N6.holds: is empty"}},
    {"release_to: [ry, rz]",
     "release_to: [uy]",
     18,
     {"members.side.release_to: unknown freedom 'uy'", "known: tx, ty, tz, rx, ry, rz"}},
    {", ux: 40 N/mm}", "}", 28, {"springs.between: has no stiffness"}},
    {"to: top left, ux", "to: N6, ux", 28, {"springs.between.to: must be another node"}},
    {"master: top left", "master: N5", 30, {"rigid_links.plate.nodes: the master cannot follow itself"}},
    {", factor: 2, arm: 10 mm}", "}", 33, {"constraints.lever.terms: adds lengths and angles", "arm: 10 mm"}},
    {"freedom: uy, factor: -1}", "freedom: uy, factor: 0}", 32, {"constraints.equal.terms.1.factor: must not be zero"}},
    {"freedom: uy, factor: -1}",
     "freedom: uy, arm: 1 mm}",
     32,
     {"constraints.equal.terms.1.arm: goes with a rotation"}},
    {"uz: -1 mm, rx: 0.1 deg", "", 42, {"loads.case 1.displacements.1: has no displacement"}},
    {"displacements: {1: {uz: -1 mm",
     "displacements: {3: {uz: -1 mm",
     42,
     {"loads.case 1.displacements.3.rx: node '3' is not supported in rx", "add rx to supports.3"}},
    {"displacements: {1:", "displacements: {2:", 42, {"displacements.2.uz: node '2' is not supported in uz"}},
    // Loads that need more of the material or the section
    {"material: steel, y_axis",
     "material: wood, y_axis",
     41,
     {"loads.case 1.gravity: material 'wood' of member 'post' has no density", "materials.wood"}},
    {", expansion: 12e-6 1/K", "", 40, {"loads.case 1.temperature.beam: material 'steel' has no thermal expansion"}},
    {"section: bar, material: steel, y_axis",
     "section: bar, beam: timoshenko, material: steel, y_axis",
     19,
     {"members.post.beam: timoshenko needs As_y and As_z in section 'bar'"}},
    {"{nodes: {2: {fx: 1 kN}}}", "{}", 43, {"loads.case-2: has no load"}},
    {"  case-2: {nodes: {2: {fx: 1 kN}}}",
     "  case 1: {nodes: {2: {fx: 1 kN}}}",
     43,
     {"loads.case 1: given twice, first on line 35"}},
};

class BadFrame : public ::testing::TestWithParam<std::size_t> {};

TEST_P(BadFrame, IsRefusedWithLinePathAndRemedy) {
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

INSTANTIATE_TEST_SUITE_P(Mistakes, BadFrame, ::testing::Range<std::size_t>(0, mistakes.size()));

TEST(FrameFile, ManyKnownNamesAreCountedNotListed) {
  std::string text =
      "name: long\nsections:\n  r: {shape: round, diameter: 1 mm}\nmaterials:\n  s: {E: 1 GPa, nu: 0.3}\nnodes:\n";
  for (int i = 0; i < 40; ++i) text += "  n" + std::to_string(i) + ": [" + std::to_string(i) + " mm, 0 mm, 0 mm]\n";
  text += "members:\n  m: {from: n1, to: m2, section: r, material: s}\nloads:\n  l: {nodes: {n1: {fx: 1 N}}}\n";
  try {
    parse_frame(text, "f");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("unknown node 'm2', did you mean 'n2'? (40 are known)"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace deflect::frame
