// Where a member of a chain begins, and how its section is turned about it.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"

namespace deflect {
namespace {

const std::string head = R"(
name: test
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {flat: {shape: rectangle, width_y: 10 mm, height_z: 30 mm}}
workspace: {cube_edge: 10 mm}
leg:
)";

Mechanism with(const std::string& leg) { return parse_mechanism(head + leg, "test.yaml"); }

PlacedMember member(const Mechanism& m, const std::string& name) {
  const Configuration c = configure(m, home_pose(m));
  PlacedMember out;
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.R_WM; })
      if (part.part == name) out = part;
  });
  return out;
}

template <class F>
std::string refusal(F f) {
  try {
    f();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

const char* chain = R"(
  foot: {offset: [0 mm, 0 mm, 100 mm]}
  slide: {joint: custom, freedoms: rrarrr, home: {tz: 50 mm}}
  column: {member: flat, material: steel, along: [0 mm, 0 mm, 300 mm]}
  fork:
    mounts: [{}]
    leg: {inner: {offset: [0 mm, 40 mm, 0 mm]}}
  strut: {member: flat, material: steel, from: column}
  head: {offset: [200 mm, 0 mm, 0 mm]}
  arm: {member: flat, material: steel, from: PART}
)";

std::string from(const std::string& part) {
  std::string text = chain;
  return text.replace(text.find("PART"), 4, part);
}

// Along z: foot to 100, the slide there (moved to 150), column to 450; fork to y = 40; head to x = 200.
TEST(MemberPlaces, AMemberBeginsAtTheEndOfAPartOrWhereAJointStands) {
  const std::pair<const char*, Vector3> places[] = {{"foot", {0, 0, 100}},
                                                    {"slide", {0, 0, 100}},
                                                    {"column", {0, 0, 450}},
                                                    {"fork", {0, 40, 450}},
                                                    {"strut", {0, 40, 450}},
                                                    {"{part: foot, at: start}", {0, 0, 0}},
                                                    {"{part: foot, at: end}", {0, 0, 100}},
                                                    {"{part: slide, at: start}", {0, 0, 100}},
                                                    {"{part: slide, at: end}", {0, 0, 150}},
                                                    {"{part: column, at: start}", {0, 0, 150}},
                                                    {"{part: column, at: end}", {0, 0, 450}},
                                                    {"{part: fork, at: start}", {0, 0, 450}},
                                                    {"{part: strut, at: start}", {0, 0, 450}}};
  for (const auto& [part, mm] : places) {
    const PlacedMember arm = member(with(from(part)), "arm");
    EXPECT_LT((1e3 * arm.p_W_start - mm).norm(), 1e-9) << part << ": " << 1e3 * arm.p_W_start.transpose();
    EXPECT_LT((1e3 * arm.p_W_end - Vector3(200, 40, 450)).norm(), 1e-9) << part;
  }
}

TEST(MemberPlaces, WhatIsWrittenReadsBackTheSame) {
  for (const char* part : {"column", "{part: column, at: start}"}) {
    const Mechanism m = with(from(part));
    const std::string once = write_mechanism(m);
    EXPECT_NE(once.find(std::string("from: ") + part), once.npos) << once;
    EXPECT_EQ(write_mechanism(parse_mechanism(once, "written")), once);
  }
}

TEST(MemberPlaces, OtherPointsAreRefused) {
  for (const auto& [part, says] :
       {std::pair("{part: column, at: middle}", "arm.from.at: unknown point of a part 'middle'"),
        {"{part: colum, at: end}", "arm.from.part: unknown earlier part of the leg 'colum', did you mean 'column'?"},
        {"{part: column}", "arm.from: 'at' is missing"},
        {"[column, end]", "arm.from: a single value is wanted"}}) {
    const std::string said = refusal([&, p = part] { with(from(p)); });
    EXPECT_NE(said.find(says), said.npos) << said;
  }
}

/// Local y of the member `rod` along that vector.
Vector3 local_y(const std::string& along, const std::string& more = "", const std::string& before = "") {
  return member(with(before + "  rod: {member: flat, material: steel, along: " + along + more + "}\n"), "rod")
      .R_WM.col(1);
}

TEST(MemberPlaces, LocalYIsTheChainsYUnlessTheMemberRunsAlongIt) {
  EXPECT_LT((local_y("[1 m, 0 m, 0 m]") - Vector3::UnitY()).norm(), 1e-12);
  EXPECT_LT((local_y("[0 m, 0 m, 1 m]") - Vector3::UnitY()).norm(), 1e-12);
  EXPECT_LT((local_y("[0 m, 1 m, 0 m]") - Vector3::UnitZ()).norm(), 1e-12);
}

TEST(MemberPlaces, YAxisTurnsTheSectionInTheAxesOfTheChain) {
  const double h = std::sqrt(0.5);
  EXPECT_LT((local_y("[1 m, 0 m, 0 m]", ", y_axis: [0, 0, 1]") - Vector3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((local_y("[1 m, 0 m, 0 m]", ", y_axis: [5, -1, 1]") - Vector3(0, -h, h)).norm(), 1e-12);
  // The chain turned by 90 deg about z: its x is the base's y.
  EXPECT_LT((local_y("[0 m, 0 m, 1 m]", ", y_axis: [1, 0, 0]",
                     "  turned: {offset: [0 m, 0 m, 0 m], turn: [0 deg, "
                     "0 deg, 90 deg]}\n") -
             Vector3::UnitY())
                .norm(),
            1e-12);
  const Mechanism m = with("  rod: {member: flat, material: steel, along: [1 m, 0 m, 0 m], y_axis: [0, 0, 1]}\n");
  const std::string once = write_mechanism(m);
  EXPECT_NE(once.find("y_axis: [0, 0, 1]"), once.npos) << once;
}

TEST(MemberPlaces, AYAxisAlongTheMemberIsRefused) {
  const std::string read = refusal([] { local_y("[1 m, 0 m, 0 m]", ", y_axis: [-2, 0, 0]"); });
  EXPECT_NE(read.find("leg.rod.y_axis: is parallel to the member"), read.npos) << read;
  const Mechanism spans = with(
      "  slide: {joint: prismatic, home: {tz: 200 mm}}\n"
      "  rod: {member: flat, material: steel, from: slide, y_axis: [0, 0, 1]}\n");
  const std::string placed = refusal([&] { member(spans, "rod"); });
  EXPECT_NE(placed.find("rod: y_axis is parallel to the member here"), placed.npos) << placed;
}

TEST(MemberPlaces, ShapesOfSectionsAreReadAndImpossibleOnesRefused) {
  const auto read = [](const std::string& shape) {
    std::string text = head + "  rod: {member: flat, material: steel, along: [1 m, 0 m, 0 m]}\n";
    const std::string old = "{shape: rectangle, width_y: 10 mm, height_z: 30 mm}";
    return parse_mechanism(text.replace(text.find(old), old.size(), shape), "test.yaml");
  };
  for (const char* shape : {"{shape: box, width_y: 40 mm, height_z: 60 mm, wall: 3 mm}",
                            "{shape: I, width_y: 100 mm, height_z: 200 mm, web: 5.6 mm, flange: 8.5 mm}",
                            "{shape: channel, width_y: 80 mm, height_z: 200 mm, web: 6 mm, flange: 11 mm}",
                            "{shape: angle, long_leg: 100 mm, short_leg: 50 mm, wall: 6 mm}"}) {
    const std::string once = write_mechanism(read(shape));
    EXPECT_NE(once.find(shape), once.npos) << once;
  }
  for (const auto& [shape, says] :
       {std::pair("{shape: box, width_y: 40 mm, height_z: 60 mm, wall: 20 mm}", "sections.flat.wall: two walls fill"),
        {"{shape: I, width_y: 5 mm, height_z: 200 mm, web: 5.6 mm, flange: 8.5 mm}", "flat.web: must be below"},
        {"{shape: channel, width_y: 80 mm, height_z: 20 mm, web: 6 mm, flange: 11 mm}", "flat.flange: two flanges"},
        {"{shape: angle, long_leg: 40 mm, short_leg: 50 mm, wall: 6 mm}", "short_leg: must not be above long_leg"},
        {"{shape: angle, long_leg: 60 mm, short_leg: 50 mm, wall: 50 mm}", "wall: must be below short_leg"},
        {"{shape: i, width_y: 1 mm}", "did you mean 'I'?"}}) {
    const std::string said = refusal([&, s = shape] { read(s); });
    EXPECT_NE(said.find(says), said.npos) << said;
  }
}

}  // namespace
}  // namespace deflect
