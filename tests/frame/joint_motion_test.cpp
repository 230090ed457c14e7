// The finite motion of a connection: its derivatives, what rigid motion does to it, and the joints that it makes.
#include "msa/frame/elements/joint_motion.h"

#include <gtest/gtest.h>

#include "msa/frame/deformed/linearisation.h"
#include "tests/support/finite_motion.h"

namespace deflect::frame {
namespace {

using test::any_vector;
using test::carried;
using test::moved;

constexpr std::array<bool, 6> all = {true, true, true, true, true, true};
constexpr double h = 1e-4, by_difference = 1e-7;  // as in deformed_beam_test.cpp

struct TwoBodies {
  Vector3 X_a{0.3, -0.2, 0.1}, X_b{0.9, 0.4, -0.5}, p{0.5, 0.6, 0.2};
  BodyMotion a, b;
  std::array<Matrix3, 2> axes;

  explicit TwoBodies(int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    a = {any_vector(random, 0.5), rotation_by(any_vector(random, 1.5))};
    b = {any_vector(random, 0.5), (rotation_by(any_vector(random, 0.6)) * a.Q).normalized()};
    axes[0] = rotation_by(any_vector(random, 2)).toRotationMatrix();
    axes[1] = rotation_by(any_vector(random, 2)).toRotationMatrix();
  }
  JointMotion motion() const { return joint_motion(X_a, a, X_b, b, p, axes, all); }
  TwoBodies displaced(const Vector12& d) const {
    TwoBodies out = *this;
    out.a = moved(a, d.head<6>());
    out.b = moved(b, d.tail<6>());
    return out;
  }
};

TEST(JointMotion, GradientsAreDerivativesBySpins) {
  for (int seed = 1; seed <= 10; ++seed) {
    const TwoBodies bodies(seed);
    const JointMotion at = bodies.motion();
    for (int i = 0; i < 12; ++i) {
      const Vector12 d = h * Vector12::Unit(i);
      const Vector6 slope =
          (bodies.displaced(d).motion().components - bodies.displaced(-d).motion().components) / (2 * h);
      for (int c = 0; c < 6; ++c)
        EXPECT_NEAR(at.gradient[static_cast<std::size_t>(c)](i), slope(c), by_difference) << seed;
    }
  }
}

TEST(JointMotion, HessiansAreDerivativesLessHalfTheMomentOfTheGradient) {
  for (int seed = 1; seed <= 10; ++seed) {
    const TwoBodies bodies(seed);
    const JointMotion at = bodies.motion();
    for (std::size_t c = 0; c < 6; ++c) {
      Matrix12 H = at.hessian[c];
      EXPECT_EQ((H - H.transpose()).cwiseAbs().maxCoeff(), 0);
      H.block<3, 3>(3, 3) -= skew(at.gradient[c].segment<3>(3)) / 2;
      H.block<3, 3>(9, 9) -= skew(at.gradient[c].segment<3>(9)) / 2;
      for (int i = 0; i < 12; ++i) {
        const Vector12 d = h * Vector12::Unit(i);
        const Vector12 slope =
            (bodies.displaced(d).motion().gradient[c] - bodies.displaced(-d).motion().gradient[c]) / (2 * h);
        EXPECT_LE((H.col(i) - slope).cwiseAbs().maxCoeff(), by_difference * (1 + H.cwiseAbs().maxCoeff()))
            << seed << " " << c;
      }
    }
  }
}

TEST(JointMotion, DoesNotSeeWhatBothBodiesDo) {
  std::mt19937 random(5);
  for (int seed = 1; seed <= 10; ++seed) {
    TwoBodies bodies(seed);
    const Vector6 before = bodies.motion().components;
    const Eigen::Quaterniond Q = rotation_by(any_vector(random, 3));
    const Vector3 t = any_vector(random, 2);
    bodies.a = carried(bodies.a, bodies.X_a, Q, t);
    bodies.b = carried(bodies.b, bodies.X_b, Q, t);
    EXPECT_LE((bodies.motion().components - before).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(JointMotion, IsTheOneThatWasMade) {
  // Body b: first turned as Rx Ry Rz in the joint's axes about the joint's point, then carried along those axes.
  const Vector6 wanted = (Vector6() << 0.1, -0.2, 0.3, 0.7, -0.5, 1.1).finished();
  TwoBodies bodies(3);
  bodies.axes[1] = bodies.axes[0];
  const Matrix3 R = bodies.axes[0];
  const Eigen::Quaterniond turn(rotation_from_vector({wanted(3), 0, 0}) * rotation_from_vector({0, wanted(4), 0}) *
                                rotation_from_vector({0, 0, wanted(5)}));
  const Eigen::Quaterniond relative = Eigen::Quaterniond(R) * turn * Eigen::Quaterniond(R).conjugate();
  bodies.b.Q = relative;
  bodies.b.u = relative * (bodies.X_b - bodies.p) + bodies.p + R * wanted.head<3>() - bodies.X_b;
  const BodyMotion a = bodies.a;
  bodies.a = {};
  EXPECT_LE((bodies.motion().components - wanted).cwiseAbs().maxCoeff(), 1e-15);
  // The same seen from a body a that has moved itself.
  bodies.b = carried(bodies.b, bodies.X_b, a.Q, a.u + bodies.X_a - a.Q * bodies.X_a);
  bodies.a = a;
  EXPECT_LE((bodies.motion().components - wanted).cwiseAbs().maxCoeff(), 2e-15);
}

// Motions far below the rounding of positions and of axes have the components of the linear form to all digits.
TEST(JointMotion, KeepsTheDigitsOfTheSmallestMotions) {
  for (int seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    TwoBodies bodies(seed);
    const Vector3 u_a = any_vector(random, 1), u_b = any_vector(random, 1), w_a = any_vector(random, 1),
                  w_b = any_vector(random, 1);
    const double tiny = 1e-18;
    bodies.a = {tiny * u_a, rotation_by(tiny * w_a)};
    bodies.b = {tiny * u_b, rotation_by(tiny * w_b)};
    const JointMotion at = bodies.motion();
    Vector6 linear;
    linear << bodies.axes[0].transpose() *
                  (u_b + w_b.cross(bodies.p - bodies.X_b) - u_a - w_a.cross(bodies.p - bodies.X_a)),
        bodies.axes[1].transpose() * (w_b - w_a);
    EXPECT_TRUE((at.components / tiny).isApprox(linear, 1e-13)) << (at.components / tiny - linear).transpose();
  }
}

TEST(JointMotion, AtRestItIsTheLinearFormOfTheModel) {
  Model m;
  m.add_node("a", {0.3, -0.2, 0.1});
  m.add_node("b", {0.9, 0.4, -0.5});
  std::array<ConnectionFreedom, 6> freedoms;
  for (const std::size_t i : {0u, 2u, 4u}) freedoms[i] = {false, {LinearSpring{1}, LinearSpring{2}}};
  freedoms[3] = {false, {}};
  m.fix(0, "ground");
  m.connect(0, 1, {0.5, 0.6, 0.2}, rotation_from_rpy(0.3, 0.7, -1.2), freedoms, "joint", "joint");
  m.join(0, 1, "weld");
  const StructureConditions none{{}, VectorX::Zero(static_cast<Eigen::Index>(m.springs.size())), m.constraints.size()};
  const Linearisation at = linearise_finite(m, Shape(m), none);
  for (std::size_t k = 0; k < m.constraints.size(); ++k) {
    VectorX linear = VectorX::Zero(m.dofs()), finite = linear;
    for (const Term& t : m.constraints[k].form) linear(t.dof) += t.coefficient;
    for (const Term& t : at.forms[k]) finite(t.dof) += t.coefficient;
    EXPECT_LE((linear - finite).cwiseAbs().maxCoeff(), 1e-15) << m.constraints[k].name;
  }
}

}  // namespace
}  // namespace deflect::frame
