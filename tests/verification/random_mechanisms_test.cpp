// Properties of any mechanism, on mechanisms by the dice: nothing depends on where the base stands, on units, names or
// the order of the legs.
#include "tests/support/random_mechanisms.h"

#include <gtest/gtest.h>

#include <regex>

#include "msa/frame/mechanism/msa.h"

namespace deflect {
namespace {

using test::mechanisms;
using test::RandomMechanism;
using test::rounding;

Configuration at_home(const Mechanism& m) { return configure(m, home_pose(m)); }

Matrix6 by_msa(const Mechanism& m) { return test::compliance_by(frame::MsaModel(at_home(m))); }

TEST(RandomMechanisms, CloseAtHomeAndComeBackFromTheirCoordinates) {
  for (const Mechanism& m : mechanisms(25)) {
    const Configuration c = at_home(m);
    const Pose back = configure_joints(m, test::coordinates(c)).pose;
    EXPECT_LE(test::distance(back, home_pose(m)), 1e-10) << m.name;
  }
}

TEST(RandomMechanisms, TurnWithTheirBase) {
  std::mt19937 random(10);
  for (const Mechanism& m : mechanisms(10)) {
    const Frame X{test::random_vector(random, 2), test::random_rotation(random)};
    const auto moved = [&](const Placement& p) {
      const Frame f = X * frame_of(p);
      return Placement{f.p, rpy_from_rotation(f.R)};
    };
    Mechanism n = m;
    if (n.mounts.empty()) n.mounts.push_back({});
    for (Mount& mount : n.mounts) mount.base = moved(mount.base);
    Chains& k = std::get<Chains>(n.kinematics);
    if (k.home) k.home = moved(*k.home);
    const double size = at_home(m).size;
    const Matrix6 C = by_msa(m), turned = rotate_twist(X.R).transpose() * by_msa(n) * rotate_twist(X.R);
    EXPECT_LE(test::compliance_difference(turned, C, size), rounding(C, size)) << m.name;
  }
}

/// The file in metres instead of millimetres.
std::string in_metres(const std::string& text) {
  static const std::regex length("(-?[0-9.]+(e[+-]?[0-9]+)?) mm([,}\\]\\n])");
  std::string out;
  auto from = text.cbegin();
  for (std::sregex_iterator i(text.begin(), text.end(), length), end; i != end; ++i) {
    out.append(from, i->prefix().second);
    out += fmt::format("{} m{}", std::stod((*i)[1]) / 1e3, (*i)[3].str());
    from = (*i)[0].second;
  }
  return out.append(from, text.cend());
}

/// The file with other names for members, joints and the material.
std::string renamed(const std::string& text) {
  return std::regex_replace(text, std::regex("(member_|joint_|steel)"), "my_$1");
}

TEST(RandomMechanisms, DoNotKnowUnitsNamesOrTheOrderOfLegs) {
  for (const Mechanism& m : mechanisms(10)) {
    const std::string text = write_mechanism(m);
    Mechanism reversed = m;
    std::reverse(reversed.mounts.begin(), reversed.mounts.end());
    const Matrix6 C = by_msa(m);
    const double size = at_home(m).size;
    for (const Mechanism& n :
         {parse_mechanism(in_metres(text), "metres"), parse_mechanism(renamed(text), "renamed"), reversed})
      EXPECT_LE(test::compliance_difference(by_msa(n), C, size), rounding(C, size)) << m.name;
  }
}

// Three equal legs at 120°, the platform in the middle: the compliance is the same seen from each leg.
TEST(RandomMechanisms, ThreeEqualLegsAreTheSameFromEachOfThem) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    Mechanism m = RandomMechanism(seed).parallel(3);
    const Mount first = m.mounts[0];
    const Placement home = *std::get<Chains>(m.kinematics).home;
    const Frame T = Frame{{0, 0, home.shift.z()}, Matrix3::Identity()};
    std::get<Chains>(m.kinematics).home = Placement{T.p, Vector3::Zero()};
    const Frame seat = frame_of(home) * frame_of(first.platform);  // of the first leg in W
    for (int leg = 0; leg < 3; ++leg) {
      const Frame third{Vector3::Zero(), rotation_from_rpy(0, 0, leg * 2 * pi / 3)};
      const Frame base = third * frame_of(first.base), platform = T.inverse() * third * seat;
      Mount& mount = m.mounts[static_cast<std::size_t>(leg)];
      mount = first;
      mount.base = {base.p, rpy_from_rotation(base.R)};
      mount.platform = {platform.p, rpy_from_rotation(platform.R)};
    }
    const Configuration c = at_home(m);
    const Matrix6 C = by_msa(m), turn = rotate_twist(rotation_from_rpy(0, 0, 2 * pi / 3));
    EXPECT_LE(test::compliance_difference(turn * C * turn.transpose(), C, c.size), rounding(C, c.size)) << m.name;
  }
}

}  // namespace
}  // namespace deflect
