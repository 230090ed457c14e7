// The walk of a frame along a chain: what a joint's coordinates do to it, and where the joints are placed.
#include "msa/mechanism/walk.h"

#include <gtest/gtest.h>

#include "msa/mechanism/configuration.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

/// Every type of the joint table, and custom joints that mix free, actuated and rigid freedoms.
std::vector<Joint> joints() {
  std::vector<Joint> all;
  for (const JointType& type : joint_table) {
    Joint j;
    j.type = type.name;
    if (j.type == "parallelogram") j.bar = {0.2, -0.1, 0.05};
    if (j.type != "custom") all.push_back(j);
  }
  for (const char* letters : {"rrfrrf", "fffrrr", "frfrff", "faffaf", "rrrfrf", "rrrffa", "rrraff", "rrrfaf", "aaaaaa",
                              "ffffff", "rrrrff", "rfrarf"}) {
    Joint j;
    j.type = "custom";
    j.freedoms = letters;
    all.push_back(j);
  }
  return all;
}

std::array<Freedom, 6> letters_of(const Joint& j) {
  return freedoms_of(std::string_view(j.freedoms.empty() ? find_joint_type(j.type)->letters : j.freedoms));
}

/// The joint between two rigid pieces, away from zero in all its coordinates, with an axis or a row of a table.
Mechanism chain_with(Joint joint, std::mt19937& random) {
  const std::array<Freedom, 6> freedoms = letters_of(joint);
  for (std::size_t i = 0; i < 6; ++i)
    if (movable(freedoms[i]))
      joint.home[i] = test::uniform(random, -1, 1) * (i < 3 ? 0.3 : is_ball(freedoms) ? 3 : 1.3);
  const unsigned form = static_cast<unsigned>(random()) % 4;
  const DhRow row{test::uniform(random, -2, 2), test::uniform(random, -1, 1), test::uniform(random, -1, 1),
                  test::uniform(random, -2, 2)};
  if (form == 0) joint.axis = test::random_vector(random, 1);
  if (form == 1) joint.dh = row;
  if (form == 2) joint.modified_dh = row;
  joint.axes = random() % 2 ? "before" : "after";
  Offset first, last;
  first.shift = test::random_vector(random, 0.5), last.shift = test::random_vector(random, 0.5);
  first.turn = test::random_vector(random, 1.5), last.turn = test::random_vector(random, 1.5);
  Mechanism m;
  m.name = joint.type + " " + joint.freedoms;
  m.kinematics = Chains();
  m.leg = {{"first", first}, {"joint", joint}, {"last", last}};
  return m;
}

struct Walked {
  explicit Walked(const Mechanism& m) : legs(legs_of(m)), states(home_states(legs)), trace(walk(legs, states)) {}
  Frame end_after(const Coordinate& c, double step) const {
    std::vector<JointState> moved = states;
    move(moved[c.joint], c, step);
    return walk(legs, moved).legs[0].end;
  }

  std::vector<LegParts> legs;
  std::vector<JointState> states;
  Trace trace;
};

// Central differences err by h²/6 of a third derivative of order one and by rounding over h: 1e-10 at h = 1e-5.
TEST(Walk, TwistsAreTheDerivativesOfTheWalkedFrame) {
  std::mt19937 random(1);
  const double h = 1e-5;
  for (int repeat = 0; repeat < 20; ++repeat)
    for (const Joint& joint : joints()) {
      const Mechanism m = chain_with(joint, random);
      const Walked w(m);
      for (const Coordinate& c : w.trace.coordinates) {
        const Frame here = w.trace.legs[0].end, up = w.end_after(c, h), down = w.end_after(c, -h);
        const Eigen::AngleAxisd turn(up.R * down.R.transpose());
        Vector6 measured, twist;
        measured << (up.p - down.p) / (2 * h), turn.axis() * turn.angle() / (2 * h);
        twist << c.twist.head<3>() + c.twist.tail<3>().cross(here.p), c.twist.tail<3>();
        EXPECT_LE((measured - twist).norm(), 1e-8) << m.name << " " << freedom_names[c.freedom];
      }
    }
}

/// An orthonormal basis of the columns, rotations in rad at 1 m.
Matrix6X basis(const Matrix6X& J) {
  if (J.cols() == 0) return J;
  Eigen::JacobiSVD<MatrixX> svd(J, Eigen::ComputeThinU);
  svd.setThreshold(1e-9);
  return svd.matrixU().leftCols(svd.rank());
}

// A joint that moves one freedom after the other is placed as joints whose free and actuated freedoms together do what
// its coordinates do.
TEST(Walk, PlacedFreedomsSpanTheMotionsOfTheCoordinates) {
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 20; ++repeat)
    for (const Joint& joint : joints()) {
      const Mechanism m = chain_with(joint, random);
      const Walked w(m);
      const Configuration c = configure(m, home_pose(m));
      for (const Freedom kind : {Freedom::free, Freedom::actuated}) {
        Matrix6X walked(6, 0), placed(6, 0);
        const auto add = [](Matrix6X& J, const Vector6& column) {
          J.conservativeResize(6, J.cols() + 1);
          J.rightCols<1>() = column;
        };
        // The actuated freedoms are held: compared are the free ones, then both.
        for (const Coordinate& k : w.trace.coordinates)
          if (kind == Freedom::actuated || !k.actuated) add(walked, k.twist);
        for_each_part(c.legs, [&](const auto& part) {
          if constexpr (requires { part.freedoms; })
            for (std::size_t i = 0; i < 6; ++i) {
              if (part.freedoms[i] == Freedom::rigid || (kind == Freedom::free && !part.free(i))) continue;
              const Vector3 axis = part.R_WJ.col(static_cast<Eigen::Index>(i % 3));
              Vector6 twist = Vector6::Zero();
              if (i < 3)
                twist.head<3>() = axis;
              else
                twist << part.p_W.cross(axis), axis;
              add(placed, twist);
            }
        });
        const Matrix6X a = basis(walked), b = basis(placed);
        ASSERT_EQ(a.cols(), b.cols()) << m.name;
        if (a.cols() > 0) {
          EXPECT_LE((a - b * (b.transpose() * a)).norm(), 1e-9) << m.name;
        }
      }
    }
}

// A law acts along the axes of the chain before or after the joint has moved, whatever the joint is.
TEST(Walk, LawsOfRigidFreedomsStandInTheAxesAskedFor) {
  std::mt19937 random(3);
  for (const char* axes : {"before", "after"})
    for (Joint joint : joints()) {
      const std::array<Freedom, 6> freedoms = letters_of(joint);
      std::vector<std::size_t> rigid;
      for (std::size_t i = 0; i < 6; ++i)
        if (!movable(freedoms[i])) rigid.push_back(i);
      if (joint.type == "parallelogram") continue;  // its x follows the path
      for (const std::size_t i : rigid) joint.laws[i] = {LinearLaw{1e6}};
      Mechanism m = chain_with(joint, random);
      Joint& placed = std::get<Joint>(m.leg[1].second);
      placed.axes = axes;
      placed.axis = Vector3::UnitZ();
      placed.dh.reset(), placed.modified_dh.reset();
      const Walked w(m);
      const Frame& frame =
          std::string(axes) == "before" ? w.trace.legs[0].steps[1].before : w.trace.legs[0].steps[1].after;
      std::size_t seen = 0;
      const Configuration c = configure(m, home_pose(m));
      for_each_part(c.legs, [&](const auto& part) {
        if constexpr (requires { part.laws; })
          for (const std::size_t i : rigid)
            if (part.elastic(i)) {
              ++seen;
              const auto axis = static_cast<Eigen::Index>(i % 3);
              EXPECT_LE((part.R_WJ.col(axis) - frame.R.col(axis)).norm(), 1e-12) << m.name << " " << axes;
            }
      });
      EXPECT_EQ(seen, rigid.size()) << m.name;
    }
}

TEST(Walk, StandardAndModifiedRowsAreTheTransformsOfTheBooks) {
  std::mt19937 random(4);
  const auto homogeneous = [](const Frame& f) {
    Eigen::Matrix4d H = Eigen::Matrix4d::Identity();
    H.topLeftCorner<3, 3>() = f.R;
    H.topRightCorner<3, 1>() = f.p;
    return H;
  };
  for (int repeat = 0; repeat < 50; ++repeat) {
    const DhRow r{test::uniform(random, -3, 3), test::uniform(random, -1, 1), test::uniform(random, -1, 1),
                  test::uniform(random, -3, 3)};
    const double q = test::uniform(random, -3, 3), c = std::cos(q + r.theta), s = std::sin(q + r.theta),
                 ca = std::cos(r.alpha), sa = std::sin(r.alpha);
    Eigen::Matrix4d standard, modified;
    // Paul's convention; Craig's (3.6)
    standard << c, -s * ca, s * sa, r.a * c, s, c * ca, -c * sa, r.a * s, 0, sa, ca, r.d, 0, 0, 0, 1;
    modified << c, -s, 0, r.a, s * ca, c * ca, -sa, -sa * r.d, s * sa, c * sa, ca, ca * r.d, 0, 0, 0, 1;
    Joint j;
    j.type = "motor";
    j.home[5] = q;
    Mechanism m;
    m.kinematics = Chains();
    j.dh = r;
    m.leg = {{"joint", j}};
    EXPECT_LE((homogeneous(Walked(m).trace.legs[0].end) - standard).norm(), 1e-14);
    j.dh.reset(), j.modified_dh = r;
    m.leg = {{"joint", j}};
    EXPECT_LE((homogeneous(Walked(m).trace.legs[0].end) - modified).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace deflect
