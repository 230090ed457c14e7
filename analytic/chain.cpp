#include "analytic/chain.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "analytic/member.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

Step step_of(const SteppedLaw& law, double force, const ChainConditions& c) {
  const auto n = as_size(law.number);
  return law.number >= 0 && n < c.steps.size() ? c.steps[n] : law.at_force(force);
}

void append(Matrix6X& columns, const Matrix6X& more) {
  columns.conservativeResize(6, columns.cols() + more.cols());
  columns.rightCols(more.cols()) = more;
}

void add_compliance(Chain& chain, const Matrix6& C, const std::string& part) {
  chain.members.push_back({C, part});
  chain.C += C;
}

/// C = root rootᵀ.
void add_root(Chain& chain, const Matrix6& root, const std::string& part) {
  add_compliance(chain, root * root.transpose(), part);
  append(chain.roots, root);
}

void add_member(Chain& chain, const PlacedMember& m, const Vector3& p_W, bool first, const AsPrinted& p) {
  Matrix3 R = m.R_WM;
  Matrix6 C_tip = Matrix6::Zero();  // as printed
  if (first && p.count(Erratum::guideway_matrix)) {
    C_tip = tip_compliance_guideway_as_printed(m);
  } else if (!first && p.count(Erratum::link_matrix)) {
    R = link_axes_as_printed(m);
    C_tip = tip_compliance_link_as_printed(m);
  } else {
    if (!first && p.count(Erratum::link_frame)) link_axes_as_printed(m);  // a round link feels only where it is refused
    const Matrix6 root = tip_compliance(m).llt().matrixL();
    add_root(chain, shift_twist(p_W - m.p_W_end) * rotate_twist(R) * root, m.part);
  }
  if (!C_tip.isZero(0)) {
    add_compliance(chain, moved_to(p_W, m, R, C_tip), m.part);
    chain.rooted = false;
  }
  chain.expansion.head<3>() += m.expansion * (m.p_W_end - m.p_W_start);
}

void add_joint(Chain& chain, const PlacedJoint& j, const Vector3& p_W, const AsPrinted& p) {
  if (j.stiffness) {
    Matrix6 J;
    for (std::size_t i = 0; i < 6; ++i) J.col(as_index(i)) = freedom_twist(j, i, p_W);
    const Eigen::LLT<Matrix6> L(*j.stiffness);  // K = L Lᵀ
    add_root(chain, L.matrixL().solve(J.transpose()).transpose(), j.part);
    return;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    if (j.free(i)) append(chain.J_q, freedom_twist(j, i, p_W));
    if (!j.elastic(i)) continue;
    ElasticFreedom freedom{freedom_twist(j, i, p_W), {{}, j.preload[i]}, j.part, {}, i >= 3};
    for (const Law& law : j.laws[i])
      if (deflect::jumps(law))
        freedom.stepped.push_back({law, j.preload[i], i >= 3, j.part, -1, i});
      else
        freedom.spring.laws.push_back(law);
    if (!p.count(Erratum::scalar_direction)) {
      chain.freedoms.push_back(freedom);
      continue;
    }
    for (Eigen::Index k = 0; k < 6; ++k) {  // mm/N read as rad/Nmm in the rotations
      freedom.twist = Vector6::Unit(k) * (k < 3 ? 1 : 1e3);
      chain.freedoms.push_back(freedom);
    }
  }
}

void add_yielding(Flexibility& f, const Vector6& twist, double compliance) {
  f.C += twist * compliance * twist.transpose();
  if (compliance > 0) append(f.roots, twist * std::sqrt(compliance));
}

double share_of(const SteppedLaw& law) {
  const auto* friction = std::get_if<FrictionLaw>(&law.law);
  return friction ? friction->share : 0;
}

/// The freedom of the same joint that a freedom of another branch stands beside.
ElasticFreedom* beside(Chain& joint, const ElasticFreedom& f) {
  const auto same = [&](const ElasticFreedom& each) {
    return each.rotation == f.rotation && each.twist.isApprox(f.twist, 1e-12);
  };
  const auto found = std::find_if(joint.freedoms.begin(), joint.freedoms.end(), same);
  return found == joint.freedoms.end() ? nullptr : &*found;
}

/// Where a friction's limit grows with what the laws beside it carry, a law that is rigid in both senses stands in
/// series with these: as a step it tells their force.
void watch_loads(std::vector<Chain>& branches) {
  for (const Chain& branch : branches)
    for (const ElasticFreedom& f : branch.freedoms) {
      if (std::none_of(f.stepped.begin(), f.stepped.end(), [](const SteppedLaw& l) { return share_of(l) > 0; }))
        continue;
      ElasticFreedom* joint = beside(branches.front(), f);
      if (joint && joint->stepped.empty())
        joint->stepped.push_back({OneSidedLaw{0, 0}, joint->spring.preload, joint->rotation, joint->part});
    }
}

void add_parallel(Chain& chain, const PlacedParallel& parallel, const Vector3& p_W, const AsPrinted& p) {
  std::vector<Chain> branches;
  for (const PlacedLeg& branch : parallel.branches) branches.push_back(chain_of(branch, p_W, chain.length, p));
  watch_loads(branches);
  chain.groups.push_back(group_of(parallel.part, std::move(branches), chain.length));
  append(chain.J_q, chain.groups.back().J);
}

}  // namespace

Vector6 freedom_twist(const PlacedJoint& j, std::size_t i, const Vector3& p_W) {
  const Vector3 axis = j.R_WJ.col(as_index(i % 3));
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

ChainResponse Chain::respond(const Vector6& F, double least, const ChainConditions& c) const {
  ChainResponse r;
  r.d = misfit + c.warmer * expansion + C * F;
  r.tangent = {C, roots, rooted, c.printed.count(Erratum::passive_joints) ? Matrix6X(6, 0) : J_q, N};
  const Eigen::Index passive = r.tangent.J.cols();
  for (const ElasticFreedom& f : freedoms) {
    const double force = f.twist.dot(F);
    double yields = analytic::compliance(f.spring, force, least, c.printed);
    bool lets_go = !std::isfinite(yields);
    r.d += f.twist * analytic::deflection(f.spring, force, c.printed);
    for (const SteppedLaw& law : f.stepped) {
      const Step step = step_of(law, force, c);
      r.d += f.twist * (step.offset + step.compliance * force);
      yields += step.compliance;
      lets_go = lets_go || (step.released && least == 0);
    }
    if (lets_go)
      append(r.tangent.J, f.twist);
    else
      add_yielding(r.tangent, f.twist, yields);
  }
  for (const Group& g : groups) {
    const Group::State state = g.solve(F, c);
    const Flexibility tangent = g.flexibility(state.wrenches, least, c);
    r.d += state.t;
    r.converged = r.converged && state.converged;
    r.tangent.C += tangent.C;
    r.tangent.rooted = r.tangent.rooted && tangent.rooted;
    append(r.tangent.roots, tangent.roots);
    if (tangent.J.cols() > g.J.cols()) append(r.tangent.J, tangent.J);
  }
  if (r.tangent.J.cols() > passive) r.tangent.N = carried_wrenches(r.tangent.J, length);
  return r;
}

Vector6 Chain::deflection(const Vector6& F, const ChainConditions& c, bool* converged) const {
  Vector6 d = misfit + c.warmer * expansion + C * F;
  for (const ElasticFreedom& f : freedoms) {
    const double force = f.twist.dot(F);
    d += f.twist * analytic::deflection(f.spring, force, c.printed);
    for (const SteppedLaw& law : f.stepped) {
      const Step step = step_of(law, force, c);
      d += f.twist * (step.offset + step.compliance * force);
    }
  }
  for (const Group& g : groups) {
    const Group::State state = g.solve(F, c);
    d += state.t;
    if (converged && !state.converged) *converged = false;
  }
  return d;
}

VectorX Chain::passive_motions(const Vector6& F, const Vector6& t, const ChainConditions& under) const {
  if (J_q.cols() == 0) return {};
  Vector6 weights = Vector6::Ones();
  weights.tail<3>().setConstant(length);
  const MatrixX J = weights.asDiagonal() * J_q;
  return J.completeOrthogonalDecomposition().solve(weights.cwiseProduct(t - deflection(F, under)));
}

Matrix6 Chain::stiffness(const Vector6& F, const ChainConditions& c) const {
  return analytic::stiffness(respond(F, 0, c).tangent, length, name);
}

Resistance Chain::resistance(const Vector6& F, const ChainConditions& c) const {
  return analytic::resistance(respond(F, 0, c).tangent, length);
}

bool Chain::linear() const {
  const auto linear_spring = [](const ElasticFreedom& f) {
    return f.stepped.empty() && std::all_of(f.spring.laws.begin(), f.spring.laws.end(), deflect::is_linear);
  };
  return std::all_of(freedoms.begin(), freedoms.end(), linear_spring) &&
         std::all_of(groups.begin(), groups.end(), [](const Group& g) { return g.linear(); });
}

bool Chain::straight(const ChainConditions& c) const {
  const auto held = [&](const SteppedLaw& law) {
    const auto n = as_size(law.number);
    return law.number >= 0 && n < c.steps.size() && !c.steps[n].released;
  };
  const auto same_at_any_force = [&](const ElasticFreedom& f) {
    return std::all_of(f.stepped.begin(), f.stepped.end(), held) &&
           std::all_of(f.spring.laws.begin(), f.spring.laws.end(), deflect::is_linear);
  };
  return std::all_of(freedoms.begin(), freedoms.end(), same_at_any_force) &&
         std::all_of(groups.begin(), groups.end(), [&](const Group& g) {
           return std::all_of(g.branches.begin(), g.branches.end(), [&](const Chain& b) { return b.straight(c); });
         });
}

bool Chain::fits() const {
  return misfit.isZero(0) && std::all_of(groups.begin(), groups.end(), [](const Group& g) { return g.fits(); });
}

void Chain::add_energies(const Vector6& F, const ChainConditions& c, std::map<std::string, double>& sums) const {
  for (const FlexiblePart& m : members) sums[m.part] += 0.5 * F.dot(m.C * F);
  for (const ElasticFreedom& f : freedoms) {
    const double force = f.twist.dot(F);
    sums[f.part] += analytic::stored_energy(f.spring, force, c.printed);
    for (const SteppedLaw& law : f.stepped) sums[f.part] += law.stored_energy(force, step_of(law, force, c));
  }
  for (const Group& g : groups) {
    const Group::State state = g.solve(F, c);
    for (std::size_t i = 0; i < g.branches.size(); ++i) g.branches[i].add_energies(state.wrenches[i], c, sums);
  }
}

void Chain::bent_laws_to_steps() {
  for (ElasticFreedom& f : freedoms) {
    const auto linear = std::stable_partition(f.spring.laws.begin(), f.spring.laws.end(), deflect::is_linear);
    for (auto law = linear; law != f.spring.laws.end(); ++law)
      f.stepped.push_back({*law, f.spring.preload, f.rotation, f.part});
    f.spring.laws.erase(linear, f.spring.laws.end());
  }
  for (Group& g : groups)
    for (Chain& branch : g.branches) branch.bent_laws_to_steps();
}

void Chain::number_steps(std::vector<SteppedLaw>& all) {
  for (ElasticFreedom& f : freedoms)
    for (SteppedLaw& law : f.stepped) {
      law.number = static_cast<int>(all.size());
      all.push_back(law);
    }
  for (Group& g : groups) {
    for (Chain& branch : g.branches) branch.number_steps(all);
    for (const Chain& branch : g.branches)
      for (const ElasticFreedom& f : branch.freedoms)
        for (const SteppedLaw& law : f.stepped) {
          if (share_of(law) == 0) continue;
          const ElasticFreedom* joint = beside(g.branches.front(), f);
          if (joint && !joint->stepped.empty()) all[as_size(law.number)].load = joint->stepped.front().number;
        }
  }
}

void Chain::add_step_forces(const Vector6& F, const ChainConditions& c, VectorX& forces) const {
  for (const ElasticFreedom& f : freedoms)
    for (const SteppedLaw& law : f.stepped) forces(law.number) = f.twist.dot(F);
  for (const Group& g : groups) {
    const bool any = std::any_of(g.branches.begin(), g.branches.end(), [](const Chain& b) { return b.has_steps(); });
    if (!any) continue;
    const Group::State state = g.solve(F, c);
    for (std::size_t i = 0; i < g.branches.size(); ++i) g.branches[i].add_step_forces(state.wrenches[i], c, forces);
  }
}

bool Chain::has_steps() const {
  return std::any_of(freedoms.begin(), freedoms.end(), [](const ElasticFreedom& f) { return !f.stepped.empty(); }) ||
         std::any_of(groups.begin(), groups.end(), [](const Group& g) {
           return std::any_of(g.branches.begin(), g.branches.end(), [](const Chain& b) { return b.has_steps(); });
         });
}

Group legs_of(const Configuration& c, const AsPrinted& as_printed) {
  std::vector<Chain> chains;
  for (const PlacedLeg& leg : c.legs) {
    Vector3 reference = c.pose.p_WT;
    if (leg.beside) {  // which no equation of the paper is about
      chains.push_back(chain_of(leg, reference, c.size));
      continue;
    }
    if (as_printed.count(Erratum::tcp_transfer))  // the platform joint: where the last member ends
      for (const PlacedPart& part : leg.parts)
        if (const auto* m = std::get_if<PlacedMember>(&part)) reference = m->p_W_end;
    chains.push_back(chain_of(leg, reference, c.size, as_printed));
  }
  return group_of("the mechanism", std::move(chains), c.size);
}

Matrix6 Group::stiffness(const std::vector<Vector6>& wrenches, const ChainConditions& c) const {
  Matrix6 K = Matrix6::Zero();
  for (std::size_t i = 0; i < branches.size(); ++i) K += branches[i].stiffness(wrenches[i], c);
  return K;
}

Resistance Group::resistance(const std::vector<Vector6>& wrenches, const ChainConditions& c) const {
  std::vector<Resistance> parts;
  for (std::size_t i = 0; i < branches.size(); ++i) parts.push_back(branches[i].resistance(wrenches[i], c));
  return side_by_side(parts, length);
}

bool Group::linear() const {
  return std::all_of(branches.begin(), branches.end(), [](const Chain& c) { return c.linear(); });
}

bool Group::fits() const {
  return std::all_of(branches.begin(), branches.end(), [](const Chain& c) { return c.fits(); });
}

}  // namespace deflect::analytic
