// Second order and finite displacement: arms, joints, springs and supports against closed forms, and the laws that
// states and tangents must keep.
#include "msa/frame/deformed/geometric_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "tests/support/columns.h"
#include "tests/support/elastica.h"
#include "tests/support/finite_motion.h"

namespace deflect::frame {
namespace {

using test::buckling_factor;
using test::column;
using test::load_at;
using test::rigid_in_shear;
using test::solve;

constexpr BeamRigidity slender = {1e6, 1, 1, 1, rigid_in_shear, rigid_in_shear};

/// A rigid arm of the length a along x, on a hinge about z with the stiffness k.
Model lever(double a, double k) {
  Model m;
  const int ground = m.add_node("ground", Vector3::Zero()), hub = m.add_node("hub", Vector3::Zero());
  const int tip = m.add_node("tip", {a, 0, 0});
  m.fix(ground, "ground");
  m.join(hub, tip, "arm");
  std::array<ConnectionFreedom, 6> hinge;
  hinge[5] = {false, {LinearSpring{k}}};
  m.connect(ground, hub, Vector3::Zero(), Matrix3::Identity(), hinge, "hinge", "hinge");
  return m;
}

// kθ = P a cos θ; a further moment turns it with 1/(k + P a sin θ).
TEST(GeometricSolver, LeverOnASpringHingeTurnsByAnyAngle) {
  const double a = 0.4, k = 3;
  const Model m = lever(a, k);
  for (const double P : {0.1, 5.0, 200.0}) {
    GeometricSolver solver(m);
    GeometricOptions options;
    options.load_steps = 4;
    const GeometricState s = solver.solve({load_at(m, 2, {0, P, 0}), {}, {}}, options);
    ASSERT_TRUE(s.converged && s.stable) << s.message;
    const double angle = s.u(17);
    EXPECT_NEAR(k * angle, P * a * std::cos(angle), 1e-11 * (k + P * a));
    EXPECT_NEAR(s.u(12), a * (std::cos(angle) - 1), 1e-13);
    EXPECT_NEAR(s.u(13), a * std::sin(angle), 1e-13);
    EXPECT_NEAR(s.spring_forces(0), k * angle, 1e-12 * (k + P * a));
    const MatrixX turned = solver.response(s, load_at(m, 2, Vector3::Zero(), {0, 0, 1}));
    EXPECT_NEAR(turned(17), 1 / (k + P * a * std::sin(angle)), 1e-11 / k);
    EXPECT_NEAR(s.energy, k * angle * angle / 2, 1e-12 * (k + P * a));
  }
}

// Pulled along itself by T the lever turns with k + T a; pressed it falls over at T = −k/a.
TEST(GeometricSolver, ForcesInArmsHaveGeometricStiffness) {
  const double a = 0.4, k = 3;
  const Model m = lever(a, k);
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    GeometricSolver solver(m);
    GeometricOptions options;
    options.geometry = geometry;
    for (const double T : {-7.0, 5.0}) {
      const GeometricState s = solver.solve({load_at(m, 2, {T, 0, 0}), {}, {}}, options);
      EXPECT_TRUE(s.converged && s.stable) << s.message;
      EXPECT_NEAR(solver.response(s, load_at(m, 2, {0, 1, 0}))(13), a * a / (k + T * a), 1e-13);
    }
  }
  EXPECT_NEAR(buckling_factor(m, load_at(m, 2, {-1, 0, 0}), 20), k / a, 1e-11);
  const GeometricState fallen = solve(m, load_at(m, 2, {-8, 0, 0}), Geometry::finite);
  EXPECT_FALSE(fallen.converged);
  EXPECT_NEAR(fallen.load_factor, k / a / 8, 2.0 / 4096);  // halved twelve times
  EXPECT_NE(fallen.message.find("no equilibrium was found beyond 0.937"), std::string::npos) << fallen.message;
}

/// Two bars between fixed supports at x = ∓b and an apex at height h, on ball joints; the apex moves in y alone.
Model two_bars(double b, double h, double EA) {
  Model m;
  const int left = m.add_node("left", {-b, 0, 0}), right = m.add_node("right", {b, 0, 0}),
            apex = m.add_node("apex", {0, h, 0});
  std::vector<int> ends;
  for (const int foot : {left, right})
    for (const int node : {foot, apex})
      ends.push_back(m.add_node("end", m.nodes[static_cast<std::size_t>(node)].position));
  const BeamRigidity bar{EA, 1e-2 * EA, 1e-2 * EA, 1e-2 * EA, rigid_in_shear, rigid_in_shear};
  std::array<ConnectionFreedom, 6> ball;
  for (const std::size_t i : {3u, 4u, 5u}) ball[i] = {false, {}};
  for (int i = 0; i < 2; ++i) {
    const int foot = ends[static_cast<std::size_t>(2 * i)], top = ends[static_cast<std::size_t>(2 * i) + 1];
    const Vector3 start = m.nodes[static_cast<std::size_t>(foot)].position,
                  end = m.nodes[static_cast<std::size_t>(top)].position;
    m.add_beam(foot, top, axes_along_x(end - start, Vector3::UnitZ()), bar, i ? "right bar" : "left bar", "bar");
    m.connect(i ? right : left, foot, start, Matrix3::Identity(), ball, "ball", "ball");
    m.connect(apex, top, end, Matrix3::Identity(), ball, "ball", "ball");
  }
  m.fix(left, "left");
  m.fix(right, "right");
  for (const int i : {0, 2, 3, 4, 5}) m.constraints.push_back({{{6 * apex + i, 1}}, 0, "guide"});
  return m;
}

// R. von Mises, 1923: with l² = b² + (h − w)² and l = L at w = 0, P = 2 EA (L − l)/L · (h − w)/l.
TEST(GeometricSolver, TwoBarTrussFollowsTheClosedFormBeforeItsLimitLoad) {
  const double b = 1, h = 0.2, EA = 1e4, L = std::hypot(b, h);
  const Model m = two_bars(b, h, EA);
  const auto P = [&](double w) {
    const double l = std::hypot(b, h - w);
    return 2 * EA * (L - l) / L * (h - w) / l;
  };
  double limit = 0;
  for (double w = 0; w < h; w += 1e-4) limit = std::max(limit, P(w));
  EXPECT_EQ(GeometricSolver(m).notes().size(), 2u);  // both bars spin idly
  for (const double part : {0.3, 0.8, 0.99}) {
    const GeometricState s = solve(m, load_at(m, 2, {0, -part * limit, 0}), Geometry::finite);
    ASSERT_TRUE(s.converged && s.stable) << s.message;
    EXPECT_NEAR(P(-s.u(13)), part * limit, 1e-9 * limit);
    EXPECT_LT(-s.u(13), h * (1 - 1 / std::sqrt(3.0)) * 1.01);  // shallow arches: the limit is near there
  }
}

// Up to the limit load the state is the one on the way there, whatever other there is; beyond, at every factor, the one
// behind the jump, and it says so with the factor of the limit.
TEST(GeometricSolver, AShallowTrussSnapsThroughAtItsLimitLoadWhateverTheLoad) {
  for (const double h : {0.02, 0.2}) {
    const double b = 1, EA = 1e4, L = std::hypot(b, h);
    const Model m = two_bars(b, h, EA);
    const auto P = [&](double w) {
      const double l = std::hypot(b, h - w);
      return 2 * EA * (L - l) / L * (h - w) / l;
    };
    double limit = 0;
    for (double w = 0; w < h; w += 1e-5 * h) limit = std::max(limit, P(w));
    for (const double part : {0.8, 0.99, 0.9999, 1.0001, 1.01, 1.5, 3.0, 10.0, 40.0}) {
      const GeometricState s = solve(m, load_at(m, 2, {0, -part * limit, 0}), Geometry::finite);
      ASSERT_TRUE(s.converged && s.stable) << part << ": " << s.message;
      EXPECT_EQ(s.load_factor, 1);
      EXPECT_NEAR(P(-s.u(13)), part * limit, 1e-9 * part * limit) << part;
      EXPECT_EQ(-s.u(13) > h, part > 1) << part;
      EXPECT_EQ(s.message.find("snaps through at") != std::string::npos, part > 1) << s.message;
      EXPECT_NEAR(s.snaps_at * part, part > 1 ? 1 : 0, 1e-4) << part;  // of the step that is given up: 2e-5 of the load
    }
  }
}

// A column that the load would bend to neither side buckles and does not snap; a side load of a thousandth takes it
// along the elastica, however far beyond.
TEST(GeometricSolver, ABuckledColumnIsRefusedUnlessALoadSaysToWhichSide) {
  const Model m = column(8, 1, {1e6, 2, 1, 1, rigid_in_shear, rigid_in_shear});
  for (const double part : {1.1, 1.5}) {
    const double P = part * pi * pi / 4;
    const GeometricState straight = solve(m, load_at(m, 8, {-P, 0, 0}), Geometry::finite);
    EXPECT_FALSE(straight.converged);
    EXPECT_NEAR(straight.load_factor * part, 1, 1e-4) << straight.message;
    const GeometricState bent = solve(m, load_at(m, 8, {-P, 1e-3 * P, 0}), Geometry::finite);
    ASSERT_TRUE(bent.converged && bent.stable) << bent.message;
    EXPECT_EQ(bent.message, "");
    const test::Elastica exact = test::elastica(P * std::hypot(1, 1e-3), std::atan(1e-3));
    EXPECT_NEAR(bent.u(49), exact.y, 2e-4);  // eight elements
  }
}

// Newton's method came out on the other side at 13 of 96 loads: both sides have the same energy but for the small load.
TEST(GeometricSolver, ABuckledColumnBendsToTheSideOfItsLoad) {
  const Model m = column(8, 1, {1e6, 2, 1, 1, rigid_in_shear, rigid_in_shear});
  for (double part = 1.02; part < 3.8; part += 0.24)
    for (const double side : {-1e-3, 1e-5, 1e-4}) {
      const double P = part * pi * pi / 4;
      const GeometricState bent = solve(m, load_at(m, 8, {-P, side * P, 0}), Geometry::finite);
      ASSERT_TRUE(bent.converged && bent.stable) << bent.message;
      EXPECT_GT(bent.u(49) * side, 0) << part << " " << side;
    }
}

// A string of two halves, each b long, pulled taut by cooling: 2N/b across, beside a soft spring that makes it stand
// for the linear theory too.
TEST(GeometricSolver, PrestressedStringResistsWithItsForceOverItsLength) {
  const double b = 0.5, EA = 1e5, strain = -1e-3, N = -EA * strain, k = 2 * N / b + 10;
  Model m = two_bars(b, 0, EA);
  m.springs.push_back({{{13, 1}}, LinearSpring{10}, "soft", "soft"});
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    GeometricSolver solver(m);
    GeometricOptions options;
    options.geometry = geometry;
    const GeometricState s = solver.solve({load_at(m, 2, {0, 1e-3, 0}), {}, {strain, strain}}, options);
    ASSERT_TRUE(s.converged && s.stable) << s.message;
    EXPECT_NEAR(s.u(13), 1e-3 / k, 1e-6 * s.u(13));
    EXPECT_NEAR(solver.stiffness(s, 2).K(1, 1), k, 1e-5 * k);  // turned by 5e-6: EA/N times its square is less
  }
}

// Shafts along z and along z turned by β about x: tan ψ = cos β tan φ (e.g. H. H. Mabie, C. F. Reinholtz, Mechanisms
// and Dynamics of Machinery, 4th ed., ch. 11). Three translations are redundant at every angle.
TEST(GeometricSolver, HookeJointTurnsTheOtherShaftAsAUniversalJointDoes) {
  const double beta = 0.6;
  for (const double phi : {0.3, 1.2, 1.5}) {
    Model m;
    const int ground = m.add_node("ground", Vector3::Zero()), in = m.add_node("in", Vector3::Zero()),
              out = m.add_node("out", Vector3::Zero());
    const Matrix3 R = rotation_from_rpy(beta, 0, 0);
    std::array<ConnectionFreedom, 6> hinge, hooke;
    hinge[5] = {false, {}};
    hooke[3] = hooke[4] = {false, {}};
    m.fix(ground, "ground");
    m.fix(in, "in");
    m.constraints.back().value = phi;
    m.connect(ground, out, Vector3::Zero(), R, hinge, "bearing", "bearing");
    m.connect(in, out, Vector3::Zero(), R, hooke, "hooke", "hooke");
    GeometricOptions options;
    options.load_steps = 2;
    const GeometricState s = GeometricSolver(m).solve({VectorX::Zero(m.dofs()), {}, {}}, options);
    ASSERT_TRUE(s.converged) << s.message;
    const double psi = std::atan(std::cos(beta) * std::tan(phi));
    EXPECT_LE((s.u.segment<3>(6 * in + 3) - Vector3(0, 0, phi)).norm(), 1e-12);
    EXPECT_LE((s.u.segment<3>(6 * out + 3) - psi * R.col(2)).norm(), 1e-12) << phi;
  }
}

TEST(GeometricSolver, ASupportThatTurnsCarriesTheStructureAlongWithoutStrain) {
  Model m = column(3, 1, slender);
  m.constraints[5].value = 2.0;  // about z
  GeometricOptions options;
  options.load_steps = 3;
  const GeometricState s = GeometricSolver(m).solve({VectorX::Zero(m.dofs()), {}, {}}, options);
  ASSERT_TRUE(s.converged && s.stable) << s.message;
  EXPECT_LT(s.energy, 1e-20);
  EXPECT_LE((s.u.tail<6>() - (Vector6() << std::cos(2.0) - 1, std::sin(2.0), 0, 0, 0, 2).finished()).norm(), 1e-12);
}

TEST(GeometricSolver, FreeExpansionMakesNoForce) {
  const Model m = column(3, 1, slender);
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    GeometricOptions options;
    options.geometry = geometry;
    const GeometricState s = GeometricSolver(m).solve({VectorX::Zero(m.dofs()), {}, {0.01, 0.01, 0.01}}, options);
    ASSERT_TRUE(s.converged) << s.message;
    EXPECT_NEAR(s.u(18), 0.01, 1e-14);
    EXPECT_LT(s.energy, 1e-20);
  }
}

// A strut that cannot get longer, of EA ε = 4π² EI/L² at its buckling strain; heat comes in steps as the load does.
TEST(GeometricSolver, HeatBucklesAClampedStrutAtEulersStrain) {
  Model m = column(8, 1, {1e4, 1, 1, 1, rigid_in_shear, rigid_in_shear});
  m.fix(8, "other clamp");
  const double critical = 4 * pi * pi / 1e4;
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    GeometricOptions options;
    options.geometry = geometry;
    GeometricSolver solver(m);
    const auto heated = [&](double part) {
      return solver.solve({VectorX::Zero(m.dofs()), {}, std::vector<double>(8, part * critical)}, options);
    };
    EXPECT_TRUE(heated(0.99).stable);
    const GeometricState beyond = heated(1.25);
    EXPECT_FALSE(beyond.stable && beyond.converged);
    if (geometry == Geometry::finite) {
      EXPECT_NEAR(beyond.load_factor, 0.8, 1e-3);  // the mesh: 5e-4 above, Euler's column of eight elements
    }
  }
}

TEST(GeometricSolver, ATurnedStructureTurnsItsAnswer) {
  const Eigen::Quaterniond Q = rotation_by({0.7, -1.1, 0.4});
  Model straight, turned;
  for (const bool turn : {false, true}) {
    Model& m = turn ? turned : straight;
    const auto place = [&](const Vector3& p) { return turn ? Vector3(Q * p) : p; };
    m.add_node("a", place({0, 0, 0}));
    m.add_node("b", place({1, 0, 0}));
    m.add_node("c", place({1, 0.5, 0}));
    m.add_node("d", place({1, 0.5, 0.3}));
    for (int i = 0; i < 2; ++i) {
      const Vector3 along =
          m.nodes[static_cast<std::size_t>(i) + 1].position - m.nodes[static_cast<std::size_t>(i)].position;
      m.add_beam(i, i + 1, axes_along_x(along, place({0, 0, 1})), {1e5, 1, 2, 1, 500, 300}, "m", "m");
    }
    std::array<ConnectionFreedom, 6> joint;
    joint[4] = {false, {LinearSpring{5}, PowerSpring{20, 1.5}}};
    m.fix(0, "clamp");
    m.connect(2, 3, place({1, 0.5, 0.1}), turn ? Matrix3(Q.toRotationMatrix()) : Matrix3(Matrix3::Identity()), joint,
              "j", "j");
  }
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    const double size = geometry == Geometry::finite ? 2 : 0.2;
    GeometricSolver one(straight), other(turned);
    GeometricOptions options;
    options.geometry = geometry;
    const GeometricState s = one.solve({load_at(straight, 3, size * Vector3(0.3, 0.5, -0.7)), {}, {}}, options);
    const GeometricState t = other.solve({load_at(turned, 3, size * (Q * Vector3(0.3, 0.5, -0.7))), {}, {}}, options);
    ASSERT_TRUE(s.converged && t.converged) << s.message << t.message;
    for (int i = 0; i < 24; i += 3) EXPECT_LE((Q * s.u.segment<3>(i) - t.u.segment<3>(i)).norm(), 1e-10);
    const Matrix6 X = rotate_twist(Q.toRotationMatrix()), K = one.stiffness(s, 3).K;
    EXPECT_LE((X * K * X.transpose() - other.stiffness(t, 3).K).norm(), 1e-8 * K.norm());
    EXPECT_LE((K - K.transpose()).norm(), 1e-11 * K.norm());
  }
}

// A dead moment m: K − Kᵀ = −[m]× at its node, nothing elsewhere (tangent.h).
TEST(GeometricSolver, DeadMomentsMakeTheStiffnessUnsymmetricByTheirOwnCrossProduct) {
  const Model m = column(4, 1, slender);
  const Vector3 moment(0.2, -0.3, 0.5);
  GeometricSolver solver(m);
  const GeometricState s = solver.solve({load_at(m, 4, {0.1, 0.2, 0}, moment), {}, {}});
  ASSERT_TRUE(s.converged) << s.message;
  const Matrix6 K = solver.stiffness(s, 4).K;
  Matrix6 expected = Matrix6::Zero();
  expected.bottomRightCorner<3, 3>() = -skew(moment);
  EXPECT_LE((K - K.transpose() - expected).norm(), 1e-10 * K.norm());
}

// Of n elements each is n³ times as stiff as the column, and n of them are summed: the rounding is of the order of ε
// n⁴.
TEST(GeometricSolver, TheRoundingOfAStiffnessHoldsItsAsymmetry) {
  for (const int n : {1, 8, 64}) {
    const Model m = column(n, 1, slender);
    GeometricSolver solver(m);
    const GeometricState s = solver.solve({load_at(m, n, {0.3, 0.2, -0.1}), {}, {}});
    ASSERT_TRUE(s.converged) << s.message;
    const auto [K, rounding] = solver.stiffness(s, n);
    const Matrix6 open = (rounding + rounding.transpose()).array() + 1e-16 * K.norm();  // and of the sums themselves
    EXPECT_TRUE(((K - K.transpose()).cwiseAbs().array() <= open.array()).all()) << n;
    EXPECT_LE(rounding.norm(), 1e-14 * std::pow(n, 4) * K.norm()) << n;
  }
}

// Between linear and second order, and linear and finite, the difference of the answers is of the order of the load
// squared: a tenth of the load, a hundredth of it. 0.1 of the load itself shows in third order.
TEST(GeometricSolver, GeometriesMeetQuadraticallyAtSmallLoads) {
  const Model m = column(2, 1, slender);
  const VectorX load = load_at(m, 2, {0.3, 0.2, -0.1});
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    std::vector<double> differences;
    for (const double part : {1e-1, 1e-2, 1e-3})
      differences.push_back((solve(m, part * load, geometry).u - Solver(m).solve(part * load).u).norm());
    EXPECT_NEAR(differences[0] / differences[1], 100, 3);
    EXPECT_NEAR(differences[1] / differences[2], 100, 0.3);
  }
}

// Without relative coordinates digits are lost in proportion: 1e6 of 1e16. The answer is that of a rigid arm but for
// the deformation of the stiff member, 1e-6 of the whole.
TEST(GeometricSolver, AMemberAMillionTimesStifferIsARigidOneToSixDigits) {
  Model stiff, rigid;
  for (Model* m : {&stiff, &rigid}) {
    for (int i = 0; i < 4; ++i) m->add_node("n", {0.5 * i, 0, 0});
    for (const int i : {0, 2}) m->add_beam(i, i + 1, Matrix3::Identity(), slender, "soft", "soft");
    m->fix(0, "clamp");
  }
  stiff.add_beam(1, 2, Matrix3::Identity(), {1e12, 1e6, 1e6, 1e6, rigid_in_shear, rigid_in_shear}, "stiff", "stiff");
  rigid.join(1, 2, "arm");
  const VectorX load = load_at(stiff, 3, {-0.2, 0.8, 0.5});
  for (const Geometry geometry : {Geometry::second_order, Geometry::finite}) {
    // Second order takes stretch out of a member's K_G, an arm cannot stretch at all: that differs by rotations
    // squared.
    const double size = geometry == Geometry::finite ? 1 : 1e-3;
    const GeometricState a = solve(stiff, size * load, geometry), b = solve(rigid, size * load, geometry);
    ASSERT_TRUE(a.converged && b.converged && a.stable) << a.message << b.message;
    EXPECT_LE((a.u - b.u).norm(), 2e-6 * b.u.norm());
    EXPECT_GE((a.u - b.u).norm(), 1e-8 * b.u.norm());
  }
}

TEST(GeometricSolver, MechanismsAndDrivenSpinsAreRefusedAsInTheLinearTheory) {
  Model m = column(1, 1, slender);
  m.add_node("loose", {2, 0, 0});
  EXPECT_THROW(GeometricSolver{m}, ModelError);
  const Model bars = two_bars(1, 0.2, 1e4);
  GeometricSolver solver(bars);
  EXPECT_THROW(solver.solve({load_at(bars, 3, Vector3::Zero(), {1, 0.2, 0}), {}, {}}), ModelError);
}

// Two hinges on one line hold a plate: the second says nothing new, at any angle.
TEST(GeometricSolver, ConstraintsThatAreRedundantAtTheStartMustHoldAtTheEnd) {
  Model m;
  const int ground = m.add_node("ground", Vector3::Zero()), plate = m.add_node("plate", {0.5, 0.5, 0});
  m.fix(ground, "ground");
  std::array<ConnectionFreedom, 6> hinge;
  hinge[5] = {false, {LinearSpring{1}}};
  m.connect(ground, plate, {0, 0, 0}, Matrix3::Identity(), hinge, "lower", "lower");
  hinge[5].laws.clear();
  m.connect(ground, plate, {0, 0, 0.4}, Matrix3::Identity(), hinge, "upper", "upper");
  GeometricSolver solver(m);
  EXPECT_EQ(solver.notes().size(), 5u);
  const GeometricState s = solver.solve({load_at(m, plate, {0, 3, 0}), {}, {}});
  ASSERT_TRUE(s.converged && s.stable) << s.message;
  EXPECT_NEAR(s.u(11), 3 * (0.5 * std::cos(s.u(11)) - 0.5 * std::sin(s.u(11))), 1e-12);

  // A linear condition: u_x = −½ θ z is what the hinge implies at rest only.
  m.constraints.push_back({{{6 * plate, 1}, {6 * plate + 5, 0.5}}, 0, "tape"});
  const GeometricState torn = solve(m, load_at(m, plate, {0, 3, 0}), Geometry::finite);
  EXPECT_FALSE(torn.converged);
  EXPECT_NE(torn.message.find("'tape'"), std::string::npos) << torn.message;
}

}  // namespace
}  // namespace deflect::frame
