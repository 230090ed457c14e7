// Frames off by their tolerances.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/frame_tolerances.h"
#include "msa/frame/file/member_axes.h"
#include "tests/support/paths.h"

namespace deflect {
namespace {

// A post of 1.5 m whose node is 5 mm off is out of plumb by more than the 1e-3 up to which the base x is implied for
// its y_axis; its gauge stays where it was glued.
TEST(MovedFrame, APostOutOfPlumbKeepsItsAxes) {
  const frame::FrameDescription drawn =
      frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/portal-semi-rigid.yaml");
  const auto axes = [](const frame::FrameDescription& f, const frame::FrameMember& m) {
    return frame::member_axes(*find(f.nodes, m.to) - *find(f.nodes, m.from), m.y_axis);
  };
  double farthest = 0;
  for (const NumberMove& move : frame::number_moves(drawn)) {
    const frame::FrameDescription built = frame::moved(drawn, move, 5);
    for (std::size_t i = 0; i < drawn.members.size(); ++i) {
      const Matrix3 turn = axes(drawn, drawn.members[i].second).transpose() * axes(built, built.members[i].second);
      farthest = std::max(farthest, Eigen::AngleAxisd(turn).angle());
    }
  }
  EXPECT_GT(farthest, 1e-3) << "no member leans far enough";
  EXPECT_LT(farthest, 0.1);
}

// A post that leans by hardly more than the 1e-3, and one that its tolerance makes vertical: its section turns with it
// by 5 mm/2 m at most, and not about it.
TEST(MovedFrame, APostThatLeansByItsToleranceKeepsItsAxes) {
  for (const double lean_mm : {0.0, 1.5, 2.5, 5.0, 10.0}) {
    const frame::FrameDescription drawn = frame::parse_frame(fmt::format(R"(name: post
materials: {{steel: {{E: 200 GPa, nu: 0.3}}}}
sections: {{flat: {{shape: rectangle, width_y: 60 mm, height_z: 20 mm}}}}
nodes: {{A: [0 mm, 0 mm, 0 mm], B: [0 mm, {} mm, 2000 mm]}}
members: {{post: {{from: A, to: B, section: flat, material: steel}}}}
supports: {{A: clamped}}
loads: {{push: {{nodes: {{B: {{fx: 100 N}}}}}}}}
tolerances: {{node.position: 5 mm}}
)",
                                                                         lean_mm),
                                                             "post.yaml");
    const auto axes = [](const frame::FrameDescription& f) {
      const frame::FrameMember& m = f.members.front().second;
      return frame::member_axes(*find(f.nodes, m.to) - *find(f.nodes, m.from), m.y_axis);
    };
    for (const NumberMove& move : frame::number_moves(drawn))
      for (const double times : {-1.0, 1.0}) {
        const Matrix3 turn = axes(drawn).transpose() * axes(frame::moved(drawn, move, times));
        EXPECT_LT(Eigen::AngleAxisd(turn).angle(), 1.01 * 5 / 2000) << move.name << " of " << lean_mm << " mm";
      }
  }
}

}  // namespace
}  // namespace deflect
