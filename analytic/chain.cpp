#include "analytic/chain.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

#include "analytic/member.h"
#include "msa/base/error.h"

namespace deflect::analytic {
namespace {

// Moments weigh against forces by this length where ranks are decided: the size of a desk-top mechanism's tool.
constexpr double weighing_length = 0.1;

void add_member(Chain& chain, const PlacedMember& m, const Vector3& p_W, bool first, const AsPrinted& p) {
  Matrix3 R = m.R_WM;
  Matrix6 C_tip;
  if (first && p.count(Erratum::guideway_matrix)) {
    C_tip = tip_compliance_guideway_as_printed(m);
  } else if (!first && p.count(Erratum::link_matrix)) {
    R = link_axes_as_printed(m);
    C_tip = tip_compliance_link_as_printed(m);
  } else {
    if (!first && p.count(Erratum::link_frame)) link_axes_as_printed(m);  // a round link feels only where it is refused
    C_tip = tip_compliance(m);
  }
  chain.members.push_back({moved_to(p_W, m, R, C_tip), m.part});
  chain.C += chain.members.back().C;
}

void add_joint(Chain& chain, const PlacedJoint& j, const Vector3& p_W, const AsPrinted& p) {
  for (std::size_t i = 0; i < 6; ++i) {
    if (j.free(i)) {
      chain.J_q.conservativeResize(6, chain.J_q.cols() + 1);
      chain.J_q.rightCols<1>() = freedom_twist(j, i, p_W);
    }
    if (!j.elastic(i)) continue;
    if (!p.count(Erratum::scalar_direction)) {
      chain.freedoms.push_back({freedom_twist(j, i, p_W), j.laws[i], j.part});
      continue;
    }
    for (Eigen::Index k = 0; k < 6; ++k)  // mm/N read as rad/Nmm in the rotations
      chain.freedoms.push_back({Vector6::Unit(k) * (k < 3 ? 1 : 1e3), j.laws[i], j.part});
  }
}

Matrix6 stiffness_of(const Matrix6X& N, const Matrix6& C, const std::string& name) {
  if (N.cols() == 0) return Matrix6::Zero();
  const MatrixX G = N.transpose() * C * N;
  const Eigen::FullPivLU<MatrixX> lu(G);
  if (!lu.isInvertible())
    throw ModelError(
        fmt::format("{}: the chain is rigid against {} of the wrenches that it carries: its stiffness is "
                    "infinite; give a member, joint or actuator of it some compliance",
                    name, G.cols() - lu.rank()));
  return N * lu.solve(N.transpose());
}

}  // namespace

Vector6 freedom_twist(const PlacedJoint& j, std::size_t i, const Vector3& p_W) {
  const Vector3 axis = j.R_WJ.col(static_cast<Eigen::Index>(i % 3));
  Vector6 twist = Vector6::Zero();
  if (i < 3)
    twist.head<3>() = axis;
  else
    twist << axis.cross(p_W - j.p_W), axis;
  return twist;
}

Matrix6X carried_wrenches(const Matrix6X& J, double length) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(length);
  if (J.cols() == 0) return weight.asDiagonal() * Matrix6::Identity();
  const MatrixX weighed = weight.asDiagonal() * J;
  Eigen::JacobiSVD<MatrixX> svd(weighed, Eigen::ComputeFullU);
  svd.setThreshold(1e-9);
  return weight.asDiagonal() * svd.matrixU().rightCols(6 - svd.rank());
}

Chain chain_of(const PlacedLeg& leg, const Vector3& p_W, const AsPrinted& p) {
  Chain chain;
  chain.name = leg.name;
  chain.J_q.resize(6, 0);
  for (const PlacedPart& part : leg.parts)
    if (const auto* member = std::get_if<PlacedMember>(&part))
      add_member(chain, *member, p_W, chain.members.empty(), p);
    else
      add_joint(chain, std::get<PlacedJoint>(part), p_W, p);
  chain.N =
      p.count(Erratum::passive_joints) ? Matrix6X(Matrix6::Identity()) : carried_wrenches(chain.J_q, weighing_length);
  return chain;
}

Vector6 Chain::deflection(const Vector6& F, const AsPrinted& p) const {
  Vector6 d = C * F;
  for (const ElasticFreedom& f : freedoms) d += f.twist * analytic::deflection(f.laws, f.twist.dot(F), p);
  return d;
}

Matrix6 Chain::tangent_compliance(const Vector6& F, double least, const AsPrinted& p) const {
  Matrix6 T = C;
  for (const ElasticFreedom& f : freedoms) {
    const double force = std::max(std::abs(f.twist.dot(F)), least);
    T += f.twist * compliance(f.laws, force, p) * f.twist.transpose();
  }
  return T;
}

Matrix6 Chain::tangent_stiffness(const Vector6& F, const AsPrinted& p) const {
  Matrix6 T = C;
  Matrix6X released = J_q;
  if (p.count(Erratum::passive_joints)) released.resize(6, 0);
  for (const ElasticFreedom& f : freedoms) {
    const double c = compliance(f.laws, f.twist.dot(F), p);
    if (std::isfinite(c)) {
      T += f.twist * c * f.twist.transpose();
    } else {
      released.conservativeResize(6, released.cols() + 1);
      released.rightCols<1>() = f.twist;
    }
  }
  return stiffness_of(released.cols() == J_q.cols() ? N : carried_wrenches(released, weighing_length), T, name);
}

}  // namespace deflect::analytic
