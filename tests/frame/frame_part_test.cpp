// Edits of single entries are made in a part of the frame; the result is that of the same edits in the whole frame.
#include "msa/frame/file/frame_part.h"

#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"

namespace deflect::frame {
namespace {

FrameDescription bench() {
  return parse_frame(R"(
name: bench
about: a bench
materials: {steel: {E: !ours 210 GPa, nu: 0.3, expansion: 12e-6 1/K}}
sections: {tube: {shape: tube, outer_diameter: 60 mm, inner_diameter: 52 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [0 m, 0 m, 3 m], C: [4 m, 0 m, 3 m], D: [4 m, 0 m, 0 m]}
members:
  left: {from: A, to: B, section: tube, material: steel, factor: !ours 0.9}
  beam: {from: B, to: C, section: tube, material: steel, bending_factor: !ours 0.9}
  right: {from: C, to: D, section: tube, material: steel, misfit: 1 mm}
supports: {A: clamped, D: {holds: [ux, uy, uz, rz], rx: {law: linear, stiffness: !ours 5 kNm/rad}}}
springs: {bed: {node: C, uz: 5 N/mm}}
loads:
  push: {nodes: {B: {fx: 1 kN}}}
  sink: {displacements: {A: {uz: -1 mm}}}
sensors:
  top: {node: C, direction: ux, sigma: 0.01 mm}
  low: {node: B, direction: ux, sigma: 0.01 mm}
  cell: {member: beam, force: axial, sigma: 2 N}
  pad: {support: D, reaction: fz, sigma: 2 N}
tolerances: {modulus: 1 %, member.misfit: 1 mm, support.rx.stiffness: 5 %}
)",
                     "bench");
}

using Action = Edit::Action;
const std::vector<Edit> of_entries = {
    {"members.beam.factor", "0.7", Action::multiply},
    {"members.left.factor", "0.7", Action::multiply},
    {"members.beam.misfit", "0.5 mm", Action::add},
    {"members.beam.start.ry", "{law: linear, stiffness: 200 kNm/rad}", Action::append},
    {"supports.D.uz", "{law: clearance, gap: 0.2 mm}", Action::append},
    {"supports.D.rx", "{law: clearance, gap: 2 mrad}", Action::append},
    {"supports.D.beside.ry", "{law: friction, moment: 5 Nm, stiffness: 100 kNm/rad}", Action::append},
    {"springs.bed.uz.stiffness", "0.5", Action::multiply},
    {"springs.bed.uz", "0.5", Action::multiply},
    {"sensors.top.crosstalk", "{low: 2 %}", Action::append},
    {"sensors.cell.offset", "5 N", Action::add},
};

/// The same after an edit that leaves everything as it is and needs the whole frame.
std::string edited_in_whole(const FrameDescription& f, std::vector<Edit> edits) {
  edits.insert(edits.begin(), {"about", "a bench"});
  return write_frame(edited(f, edits));
}

TEST(FramePart, EditsOfEntriesAreThoseOfTheWholeFrame) {
  const FrameDescription f = bench();
  for (const Edit& edit : of_entries) {
    EXPECT_EQ(write_frame(edited(f, {edit})), edited_in_whole(f, {edit})) << edit.path;
    EXPECT_EQ(edited_entries(f, {parsed(edit)}).value().size(), 1u) << edit.path;
  }
  EXPECT_EQ(write_frame(edited(f, of_entries)), edited_in_whole(f, of_entries));
}

TEST(FramePart, HasTheEntriesAndWhatTheyReferTo) {
  const DependentFrame part = part_of({bench()}, {{"members", "beam"}});
  EXPECT_EQ(part.frame.members.size(), 1u);
  EXPECT_TRUE(part.frame.supports.empty() && part.frame.sensors.empty() && part.frame.springs.empty());
  EXPECT_EQ(part.frame.ours, (std::set<std::string>{"members.beam.bending_factor"}));
}

TEST(FramePart, NumbersKeepWhatTheyDependOn) {
  const auto edit_of = [](const char* path, std::size_t parameter) {
    TreeEdit edit = parsed({path, "0.7", Action::multiply});
    edit.value.depends = Dependence{parameter, 0.7};
    return std::vector{edit};
  };
  const DependentFrame one = edited_in_turn({bench()}, edit_of("members.beam.factor", 0));
  ASSERT_TRUE(one.depends.contains("members.beam.factor"));
  const DependentFrame two = edited_in_turn(one, edit_of("members.left.factor", 1));
  EXPECT_EQ(two.depends.size(), 2u);
  EXPECT_NEAR(two.depends.at("members.left.factor").factor, 0.9, 1e-15);
  const DependentFrame again = edited_in_turn(two, edit_of("members.beam.factor", 1));
  EXPECT_FALSE(again.depends.at("members.beam.factor").alone);
}

// What other entries judge needs the whole frame: without it these would be accepted.
TEST(FramePart, WhatOtherEntriesForbidIsRefused) {
  const FrameDescription f = bench();
  EXPECT_THROW(edited(f, {{"supports.A.uz", "{law: linear, stiffness: 5 N/mm}", Action::append}}), InputError);
  EXPECT_THROW(edited(f, {{"supports.D.rx", "[]"}}), InputError);
  EXPECT_FALSE(edited_entries(f, {parsed({"materials.steel.E", "0.9", Action::multiply})}));
}

// A law stands in the list of one freedom, never beside such lists.
TEST(FramePart, AnAppendToWhatHoldsListsNamesThem) {
  const auto refusal = [](const std::string& path) {
    const Edit edit{path, "{law: linear, stiffness: 5 kNm/rad}", Action::append};
    return outcome_of<InputError>([&] { return edited(bench(), {edit}); }).why;
  };
  const std::string at_end = refusal("members.beam.start");
  EXPECT_NE(at_end.find("append to one of its fields tx, ty, tz, rx, ry, rz, as in 'members.beam.start.tx'"),
            at_end.npos)
      << at_end;
  EXPECT_NE(refusal("materials.steel.E").find("but a single value"), std::string::npos);
  EXPECT_EQ(refusal("members.beam").find("y_axis"), std::string::npos);  // holds numbers
}

// A tolerance of 5 % of nothing is none.
TEST(FramePart, AShareOfANumberThatVanishesIsRefused) {
  FrameDescription f = bench();
  f.tolerances.numbers = {{"members.right.misfit", "5 %"}};
  EXPECT_THROW(edited(f, {{"members.right.misfit", "0", Action::multiply}}), InputError);
  EXPECT_THROW(edited(f, {{"members.right.misfit", "-1 mm", Action::add}}), InputError);
  EXPECT_NO_THROW(edited(f, {{"members.right.misfit", "1 mm", Action::add}}));
}

TEST(FramePart, MessagesNameWhatTheWholeFrameHas) {
  try {
    edited(bench(), {{"members.beam.facto", "0.7", Action::multiply}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'factor'"), std::string::npos) << e.what();
  }
  EXPECT_THROW(edited(bench(), {{"members.beam.factor", "-1", Action::multiply}}), InputError);
}

}  // namespace
}  // namespace deflect::frame
