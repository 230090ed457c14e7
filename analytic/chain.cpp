#include "analytic/chain.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "analytic/member.h"

namespace deflect::analytic {
namespace {

void append(Matrix6X& columns, const Matrix6X& more) {
  columns.conservativeResize(6, columns.cols() + more.cols());
  columns.rightCols(more.cols()) = more;
}

void add_compliance(Chain& chain, const Matrix6& C, const std::string& part) {
  chain.members.push_back({C, part});
  chain.C += C;
}

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
  add_compliance(chain, moved_to(p_W, m, R, C_tip), m.part);
}

void add_joint(Chain& chain, const PlacedJoint& j, const Vector3& p_W, const AsPrinted& p) {
  if (j.stiffness) {
    Matrix6 J;
    for (std::size_t i = 0; i < 6; ++i) J.col(static_cast<Eigen::Index>(i)) = freedom_twist(j, i, p_W);
    add_compliance(chain, J * j.stiffness->llt().solve(J.transpose()), j.part);
    return;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    if (j.free(i)) append(chain.J_q, freedom_twist(j, i, p_W));
    if (!j.elastic(i)) continue;
    const Spring spring{j.laws[i], j.preload[i]};
    if (!p.count(Erratum::scalar_direction)) {
      chain.freedoms.push_back({freedom_twist(j, i, p_W), spring, j.part});
      continue;
    }
    for (Eigen::Index k = 0; k < 6; ++k)  // mm/N read as rad/Nmm in the rotations
      chain.freedoms.push_back({Vector6::Unit(k) * (k < 3 ? 1 : 1e3), spring, j.part});
  }
}

void add_parallel(Chain& chain, const PlacedParallel& parallel, const Vector3& p_W, const AsPrinted& p) {
  std::vector<Chain> branches;
  for (const PlacedLeg& branch : parallel.branches) branches.push_back(chain_of(branch, p_W, chain.length, p));
  chain.groups.push_back(group_of(parallel.part, std::move(branches), chain.length));
  append(chain.J_q, chain.groups.back().J);
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

Chain chain_of(const PlacedLeg& leg, const Vector3& p_W, double length, const AsPrinted& p) {
  Chain chain;
  chain.name = leg.name;
  chain.length = length;
  chain.misfit = leg.misfit;
  bool first = true;
  for (const PlacedPart& part : leg.parts)
    if (const auto* member = std::get_if<PlacedMember>(&part)) {
      add_member(chain, *member, p_W, first, p);
      first = false;
    } else if (const auto* joint = std::get_if<PlacedJoint>(&part)) {
      add_joint(chain, *joint, p_W, p);
    } else {
      add_parallel(chain, std::get<PlacedParallel>(part), p_W, p);
    }
  chain.N = carried_wrenches(p.count(Erratum::passive_joints) ? Matrix6X(6, 0) : chain.J_q, length);
  return chain;
}

Response Chain::respond(const Vector6& F, double least, const AsPrinted& p) const {
  Response r;
  r.d = misfit + C * F;
  r.tangent = {C, p.count(Erratum::passive_joints) ? Matrix6X(6, 0) : J_q, N};
  const Eigen::Index passive = r.tangent.J.cols();
  for (const ElasticFreedom& f : freedoms) {
    const double force = f.twist.dot(F), c = analytic::compliance(f.spring, force, least, p);
    r.d += f.twist * analytic::deflection(f.spring, force, p);
    if (std::isfinite(c))
      r.tangent.C += f.twist * c * f.twist.transpose();
    else
      append(r.tangent.J, f.twist);
  }
  for (const Group& g : groups) {
    const Group::State state = g.solve(F, p);
    const Flexibility tangent = g.flexibility(state.wrenches, least, p);
    r.d += state.t;
    r.converged = r.converged && state.converged;
    r.tangent.C += tangent.C;
    if (tangent.J.cols() > g.J.cols()) append(r.tangent.J, tangent.J);
  }
  if (r.tangent.J.cols() > passive) r.tangent.N = carried_wrenches(r.tangent.J, length);
  return r;
}

Matrix6 Chain::stiffness(const Vector6& F, const AsPrinted& p) const {
  return analytic::stiffness(respond(F, 0, p).tangent, length, name);
}

bool Chain::linear() const {
  const auto linear_spring = [](const ElasticFreedom& f) {
    return std::all_of(f.spring.laws.begin(), f.spring.laws.end(), is_linear);
  };
  return std::all_of(freedoms.begin(), freedoms.end(), linear_spring) &&
         std::all_of(groups.begin(), groups.end(), [](const Group& g) { return g.linear(); });
}

bool Chain::fits() const {
  return misfit.isZero(0) && std::all_of(groups.begin(), groups.end(), [](const Group& g) { return g.fits(); });
}

void Chain::add_energies(const Vector6& F, const AsPrinted& p, std::map<std::string, double>& sums) const {
  for (const FlexiblePart& m : members) sums[m.part] += 0.5 * F.dot(m.C * F);
  for (const ElasticFreedom& f : freedoms) sums[f.part] += stored_energy(f.spring, f.twist.dot(F), p);
  for (const Group& g : groups) {
    const Group::State state = g.solve(F, p);
    for (std::size_t i = 0; i < g.branches.size(); ++i) g.branches[i].add_energies(state.wrenches[i], p, sums);
  }
}

}  // namespace deflect::analytic
