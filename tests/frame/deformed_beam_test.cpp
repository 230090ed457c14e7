// The co-rotational beam: forces and stiffness as derivatives, rigid motion, and the closed forms at small deformation.
#include "msa/frame/elements/deformed_beam.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "msa/frame/deformed/geometric_solver.h"
#include "tests/support/columns.h"
#include "tests/support/finite_motion.h"

namespace deflect::frame {
namespace {

using test::any_vector;
using test::carried;
using test::column;
using test::load_at;
using test::moved;
using test::rigid_in_shear;
using test::solve;

constexpr double none = std::numeric_limits<double>::infinity();

// Central differences with the step h: error h² · third derivative / 6, and rounding ε/h. With h = 1e-4 of functions of
// order one both are below 1e-8; third derivatives of log and tan at these angles stay below ten times the function.
constexpr double h = 1e-4, by_difference = 1e-7;

class EveryDeformedBeam : public ::testing::TestWithParam<BeamRigidity> {
 protected:
  // Unit-like lengths and rigidities of one order, so that no entry drowns.
  Beam beam() const { return {0, 1, axes_along_x({1, 2, 3}, {0, 0, 1}), 1.3, GetParam(), "", ""}; }

  struct State {
    BodyMotion a, b;
  };
  /// The ends turn by up to 0.6 rad against each other, the whole by any angle.
  State random_state(int seed) const {
    std::mt19937 random(static_cast<unsigned>(seed));
    const Beam e = beam();
    State s;
    s.a = {any_vector(random, 0.1), rotation_by(any_vector(random, 0.35))};
    s.b = {any_vector(random, 0.1), rotation_by(any_vector(random, 0.35))};
    const Eigen::Quaterniond Q = rotation_by(any_vector(random, 3));
    const Vector3 t = any_vector(random, 5);
    return {carried(s.a, Vector3::Zero(), Q, t), carried(s.b, e.length * e.R_WM.col(0), Q, t)};
  }
  static State displaced(const State& s, const Vector12& d) {
    return {moved(s.a, d.head<6>()), moved(s.b, d.tail<6>())};
  }
};

TEST_P(EveryDeformedBeam, ForcesAreTheDerivativeOfEnergyBySpins) {
  for (int seed = 1; seed <= 5; ++seed) {
    const State s = random_state(seed);
    const Vector12 forces = deformed(beam(), s.a, s.b, 0.01).forces;
    for (int i = 0; i < 12; ++i) {
      const State plus = displaced(s, h * Vector12::Unit(i)), minus = displaced(s, -h * Vector12::Unit(i));
      const double slope =
          (deformed(beam(), plus.a, plus.b, 0.01).energy - deformed(beam(), minus.a, minus.b, 0.01).energy) / (2 * h);
      EXPECT_NEAR(forces(i), slope, by_difference * forces.cwiseAbs().maxCoeff()) << seed << " " << i;
    }
  }
}

TEST_P(EveryDeformedBeam, StiffnessIsTheDerivativeOfForcesLessHalfTheNodalMoment) {
  for (int seed = 1; seed <= 5; ++seed) {
    const State s = random_state(seed);
    const DeformedBeam at = deformed(beam(), s.a, s.b, 0);
    Matrix12 K = at.K;
    K.block<3, 3>(3, 3) -= skew(at.forces.segment<3>(3)) / 2;
    K.block<3, 3>(9, 9) -= skew(at.forces.segment<3>(9)) / 2;
    EXPECT_LE((at.K - at.K.transpose()).cwiseAbs().maxCoeff(), 1e-15 * at.K.cwiseAbs().maxCoeff());
    for (int i = 0; i < 12; ++i) {
      const State plus = displaced(s, h * Vector12::Unit(i)), minus = displaced(s, -h * Vector12::Unit(i));
      const Vector12 slope =
          (deformed(beam(), plus.a, plus.b, 0).forces - deformed(beam(), minus.a, minus.b, 0).forces) / (2 * h);
      EXPECT_LE((K.col(i) - slope).cwiseAbs().maxCoeff(), by_difference * K.cwiseAbs().maxCoeff()) << seed << " " << i;
    }
  }
}

TEST_P(EveryDeformedBeam, RigidMotionCostsNothingAndTurnsTheForces) {
  const Beam e = beam();
  const Vector3 X_b = e.length * e.R_WM.col(0);
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Quaterniond Q = rotation_by(any_vector(random, 3.5));
    const Vector3 t = any_vector(random, 10);
    const DeformedBeam still = deformed(e, carried({}, Vector3::Zero(), Q, t), carried({}, X_b, Q, t), 0);
    EXPECT_LE(still.forces.cwiseAbs().maxCoeff(), 1e-13 * e.rigidity.EA);  // positions of 10 m: 1e-15 of them
    const State s = random_state(i);
    const DeformedBeam before = deformed(e, s.a, s.b, 0.02);
    const DeformedBeam after = deformed(e, carried(s.a, Vector3::Zero(), Q, t), carried(s.b, X_b, Q, t), 0.02);
    for (int k = 0; k < 12; k += 3)
      EXPECT_LE((after.forces.segment<3>(k) - Q * before.forces.segment<3>(k)).norm(), 1e-12 * before.forces.norm());
    EXPECT_NEAR(after.energy, before.energy, 1e-12 * before.energy);
  }
}

TEST_P(EveryDeformedBeam, EndsAreInEquilibriumAndMayBeExchanged) {
  const Beam e = beam();
  const Vector3 X_b = e.length * e.R_WM.col(0);
  Beam back = e;  // from b to a, y kept
  back.R_WM.col(0) *= -1, back.R_WM.col(2) *= -1;
  for (int seed = 1; seed <= 5; ++seed) {
    const State s = random_state(seed);
    const Vector12 f = deformed(e, s.a, s.b, 0).forces;
    EXPECT_LE((f.head<3>() + f.segment<3>(6)).norm(), 1e-14 * f.norm());
    const Vector3 line = X_b + s.b.u - s.a.u;
    EXPECT_LE((f.segment<3>(3) + f.segment<3>(9) + line.cross(f.segment<3>(6))).norm(), 1e-13 * f.norm());
    const Vector12 g = deformed(back, s.b, s.a, 0).forces;
    EXPECT_LE((f.head<6>() - g.tail<6>()).norm() + (f.tail<6>() - g.head<6>()).norm(), 1e-13 * f.norm());
  }
}

TEST_P(EveryDeformedBeam, AtRestItIsTheLinearBeam) {
  const Matrix12 K = stiffness(beam());
  EXPECT_LE((deformed(beam(), {}, {}, 0).K - K).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
  EXPECT_EQ(geometric_stiffness(beam(), Vector12::Zero()).norm(), 0);
  EXPECT_EQ(deformed(beam(), {}, {}, 0).forces.norm(), 0);
}

// Consistent geometric stiffness of N in one plane (Przemieniecki eq. (15.24)); for shear that of the exact shape, e.g.
// H. P. Gavin, Geometric Stiffness Effects in 2D and 3D Frames (Duke University, CEE 421), with Φ of each plane.
TEST_P(EveryDeformedBeam, AxialForceGivesTheConsistentGeometricStiffness) {
  const Beam e = beam();
  const double L = e.length, N = 0.37;
  Vector12 ends = Vector12::Zero();
  ends(0) = -N, ends(6) = N;
  const Matrix12 K_G = geometric_stiffness(e, ends);
  Matrix12 expected = Matrix12::Zero();
  const auto plane = [&](double phi, int v, int t, double sign) {
    const double q = (1 + phi) * (1 + phi), one = (1.2 + 2 * phi + phi * phi) / q / L, two = 0.1 / q,
                 three = L * (2.0 / 15 + phi / 6 + phi * phi / 12) / q,
                 four = -L * (1.0 / 30 + phi / 6 + phi * phi / 12) / q;
    const int dofs[] = {v, t, v + 6, t + 6};
    Eigen::Matrix4d k;
    k << one, sign * two, -one, sign * two, sign * two, three, -sign * two, four, -one, -sign * two, one, -sign * two,
        sign * two, four, -sign * two, three;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) expected(dofs[i], dofs[j]) += N * k(i, j);
  };
  plane(12 * e.rigidity.EIz / (e.rigidity.GAs_y * L * L), 1, 5, 1);
  plane(12 * e.rigidity.EIy / (e.rigidity.GAs_z * L * L), 2, 4, -1);
  Matrix12 turned;
  for (int i = 0; i < 12; i += 3)
    for (int j = 0; j < 12; j += 3) turned.block<3, 3>(i, j) = e.R_WM * expected.block<3, 3>(i, j) * e.R_WM.transpose();
  EXPECT_LE((K_G - turned).cwiseAbs().maxCoeff(), 1e-13 * stiffness(e).cwiseAbs().maxCoeff());
}

// A rigid rotation turns the end forces with it, θ × f, and the moments by half (the symmetric part, see the header);
// the axial pair V θ, which only stretches the member, is left out.
TEST_P(EveryDeformedBeam, GeometricStiffnessTurnsTheForcesOfARigidRotation) {
  const Beam e = beam();
  std::mt19937 random(9);
  Vector12 d = Vector12::Zero();
  for (int i = 0; i < 12; i += 3) d.segment<3>(i) = any_vector(random, 1);
  const Vector12 local = end_forces(e, d), f = pull(e, d);
  const Matrix12 K_G = geometric_stiffness(e, local);
  EXPECT_LE((K_G - K_G.transpose()).norm(), 1e-15 * K_G.norm());
  const Vector3 along = e.R_WM.col(0), X_b = e.length * along;
  for (int i = 0; i < 3; ++i) {
    const Vector3 theta = Vector3::Unit(i);
    Vector12 rigid, turned, shift;
    rigid << Vector3::Zero(), theta, theta.cross(X_b), theta;
    shift << theta, Vector3::Zero(), theta, Vector3::Zero();
    turned << theta.cross(f.head<3>()), theta.cross(f.segment<3>(3)) / 2, theta.cross(f.segment<3>(6)),
        theta.cross(f.tail<3>()) / 2;
    Vector12 rest = K_G * rigid - turned;
    const double pair = along.dot(rest.segment<3>(6) - rest.head<3>()) / 2;
    rest.head<3>() += pair * along, rest.segment<3>(6) -= pair * along;
    EXPECT_LE(rest.norm(), 1e-13 * f.norm());
    EXPECT_NEAR(pair, -along.dot(theta.cross(f.segment<3>(6))), 1e-13 * f.norm());
    EXPECT_LE((K_G * shift).norm(), 1e-14 * f.norm());
  }
}

TEST_P(EveryDeformedBeam, PureBendingByAnyAngleIsAnArc) {
  // An arc of the angle ψ and the length L: its chord is L sin(ψ/2)/(ψ/2). The strain of the centre line that is left
  // is the difference to 1 − ψ²/24, ψ⁴/1920.
  Beam e = beam();
  const double psi = 0.4, L = e.length;
  const Vector3 axis = e.R_WM.col(2);
  const double chord = L * std::sin(psi / 2) / (psi / 2);
  BodyMotion b;
  b.Q = rotation_by(psi * axis);
  b.u = rotation_by(psi / 2 * axis) * (chord * e.R_WM.col(0)) - L * e.R_WM.col(0);
  const DeformedBeam at = deformed(e, {}, b, 0);
  const double strain = std::sin(psi / 2) / (psi / 2) - 1 + psi * psi / 24;
  EXPECT_NEAR(strain, std::pow(psi, 4) / 1920, std::pow(psi, 6) / 322560);
  const Vector3 moment = at.forces.tail<3>();
  EXPECT_NEAR(moment.dot(axis), e.rigidity.EIz * psi / L, 1.1 * e.rigidity.EA * strain * L * psi / 12);
  EXPECT_LE((at.forces.segment<3>(6) - e.rigidity.EA * strain * (rotation_by(psi / 2 * axis) * e.R_WM.col(0))).norm(),
            1e-14 * e.rigidity.EA);
}

// By the definition: a pull along and a force across, of whose end moments the larger counts.
TEST_P(EveryDeformedBeam, LeavesOutByItsMomentsAndForces) {
  const Beam e = beam();
  const Vector3 along = e.R_WM.col(0), across = e.R_WM.col(1);
  const double L = e.length, N = 0.06, Q = 0.03, M = 0.05;
  Vector12 f = Vector12::Zero();
  f.head<3>() = -N * along - Q * across, f.segment<3>(6) = N * along + Q * across;
  f.segment<3>(3) = M * e.R_WM.col(2), f.tail<3>() = -0.4 * M * e.R_WM.col(2);
  std::array<double, 3> k = {e.rigidity.GJ, e.rigidity.EIy, e.rigidity.EIz};
  std::sort(k.begin(), k.end());
  const double root = std::sqrt(k[0] * k[1]);
  const double lambda = L * M / root + L * L * std::hypot(N, Q) / root, mu = L * L * Q / root;
  const LeftOut left = left_out(e, f, along);
  EXPECT_NEAR(left.relative, lambda * lambda / 12, 1e-14 * lambda * lambda);
  EXPECT_NEAR(left.twist, lambda * mu / 12, 1e-14 * lambda * mu);
}

INSTANTIATE_TEST_SUITE_P(Family, EveryDeformedBeam,
                         ::testing::Values(BeamRigidity{7, 2, 2, 1.5, none, none},
                                           BeamRigidity{7, 1, 3, 1.5, none, none}, BeamRigidity{7, 2, 2, 1.5, 9, 9},
                                           BeamRigidity{7, 1, 3, 1.5, 20, 6}));

TEST(RelativeRotation, SeriesAndClosedFormsMeet) {
  // Just below and above |ψ| = 1/2, where one takes over from the other; functions of order one with slopes below one.
  const Vector3 axis = Vector3(1, -2, 0.5).normalized();
  const RelativeRotation below((0.5 - 1e-9) * axis), above((0.5 + 1e-9) * axis);
  for (const auto& [x, y] : {std::pair{below.k, above.k},
                             {below.c, above.c},
                             {below.g, above.g},
                             {below.dk, above.dk},
                             {below.dg, above.dg}})
    EXPECT_NEAR(x, y, 1e-9 + 1e-13);
  EXPECT_NEAR(below.dc, above.dc, 1e-8);
}

TEST(RotationVector, IsTheInverseOfRotation) {
  std::mt19937 random(3);
  for (const double size : {1e-12, 1e-5, 0.1, 1.8}) {
    const Vector3 omega = any_vector(random, size);
    EXPECT_LE((rotation_vector(rotation_by(omega)) - omega).norm(),
              1e-15 * (1 + omega.norm()) * std::max(1e-3, size) * 10);
    EXPECT_LE((rotation_by(omega).toRotationMatrix() - rotation_from_vector(omega)).norm(), 1e-15);
  }
}

/// Tip of a unit rod under a moment that is constant in space: R' = R[C Rᵀm], r' = R e_x.
Vector3 tip_under_moment(const Vector3& compliance, const Vector3& m) {
  constexpr int steps = 20000;
  Matrix3 R = Matrix3::Identity();
  Vector3 r = Vector3::Zero();
  for (int i = 0; i < steps; ++i) {  // by midpoint rotations
    const auto turned = [&](const Matrix3& at, double step) -> Matrix3 {
      const Vector3 k = step * compliance.cwiseProduct(at.transpose() * m);
      return Eigen::AngleAxisd(k.norm(), k.normalized()).toRotationMatrix();
    };
    const Matrix3 half = R * turned(R, 0.5 / steps);
    r += half.col(0) / steps;
    R = R * turned(half, 1.0 / steps);
  }
  return r;
}

// Twist turns the plane of bending within an element: without that the error falls with the square of the load only, as
// the displacement by the rotation of the sections does.
TEST(DeformedBeam, TwistTurnsThePlaneOfBendingWithinElements) {
  const Vector3 moment(0.2, 0.35, -0.25);
  const BeamRigidity flat = {1e6, 2, 0.8, 0.5, rigid_in_shear, rigid_in_shear};
  std::vector<double> errors;
  for (const double share : {1.0, 0.5, 0.25}) {
    const Model m = column(2, 1, flat);
    const GeometricState s = solve(m, load_at(m, 2, Vector3::Zero(), share * moment), Geometry::finite);
    ASSERT_TRUE(s.converged) << s.message;
    const Vector3 exact = tip_under_moment({1 / flat.GJ, 1 / flat.EIy, 1 / flat.EIz}, share * moment);
    errors.push_back((s.u.segment<3>(12) - (exact - Vector3::UnitX())).norm());
  }
  EXPECT_GT(errors[0] / errors[1], 7);
  EXPECT_GT(errors[1] / errors[2], 7);
}

}  // namespace
}  // namespace deflect::frame
