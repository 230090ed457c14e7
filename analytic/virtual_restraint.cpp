// What a chain of virtual joints does to a body that holds its end, and branches side by side; its laws in steps, and
// what it stores.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "analytic/beam_column.h"
#include "analytic/flexibility.h"
#include "analytic/rotation_vector.h"
#include "analytic/virtual_chain.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

/// Rotations by length, or moments by its inverse.
Vector6 weights(double rotation) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(rotation);
  return w;
}

int negatives(const MatrixX& symmetric, double zero) {
  if (symmetric.rows() == 0) return 0;
  const VectorX eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixX>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
  return static_cast<int>((eigenvalues.array() < -zero * eigenvalues.cwiseAbs().maxCoeff()).count());
}

/// Symmetric, with ones on the diagonal but for signs.
MatrixX equilibrated(const MatrixX& A) {
  const VectorX s = A.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  return s.asDiagonal() * A * s.asDiagonal();
}

/// Of a system that may be singular, but not contradictory.
MatrixX smallest_solution(const MatrixX& A, const MatrixX& right) {
  if (A.size() == 0) return MatrixX::Zero(A.cols(), right.cols());
  if (A.rows() == A.cols()) {
    const Eigen::PartialPivLU<MatrixX> lu(A);
    const VectorX pivots = lu.matrixLU().diagonal().cwiseAbs();
    if (pivots.minCoeff() > 1e-8 * pivots.maxCoeff()) return lu.solve(right);  // not singular for certain
  }
  Eigen::CompleteOrthogonalDecomposition<MatrixX> cod;
  cod.setThreshold(1e-14);
  cod.compute(A);
  return cod.solve(right);
}

/// Whether C and A + Jᵀ C⁻¹ J are positive definite, so that as many eigenvalues of [C J; Jᵀ −A] are positive as C has.
bool plainly_splits(const MatrixX& C, const MatrixX& J, const MatrixX& A) {
  const Eigen::LLT<MatrixX> yields(C);
  if (yields.info() != Eigen::Success) return false;
  const MatrixX half = yields.matrixL().solve(J);
  return MatrixX(A + half.transpose() * half).llt().info() == Eigen::Success;
}

/// A basis of the wrenches under which nothing yields, by the compliance C and the twists J of passive freedoms, in
/// weighed coordinates. A direction whose compliance is lost in the rounding of the largest one counts as rigid: a
/// lever that only the deformed shape gives a spring carries nothing that could be told.
MatrixX held_rigidly(const MatrixX& C, const MatrixX& J) {
  constexpr double lost_compliance = 1e-12;
  const double most = C.cwiseAbs().maxCoeff();
  if (const Eigen::LLT<MatrixX> yields(C);
      yields.info() == Eigen::Success && yields.matrixLLT().diagonal().minCoeff() > 1e-5 * std::sqrt(most))
    return MatrixX(C.rows(), 0);
  const MatrixX S = complement(J);
  if (S.cols() == 0) return S;
  const Eigen::SelfAdjointEigenSolver<MatrixX> left(S.transpose() * C * S);
  std::vector<Eigen::Index> rigid;
  for (Eigen::Index i = 0; i < S.cols(); ++i)
    if (std::abs(left.eigenvalues()(i)) <= lost_compliance * most) rigid.push_back(i);
  return S * left.eigenvectors()(Eigen::all, rigid);
}

/// What the end of a chain lacks to where it is held.
Vector6 gap(const Tip& end, const Linearised& l, const Vector3& p_E, const Vector6& misfit, bool finite) {
  Vector6 c;
  if (finite)
    c << end.x.head<3>() - l.end.displacement(p_E), rotation_vector(combined(end.D, l.end.D.transpose()));
  else
    c = end.x - misfit - l.J * l.x;
  if (!l.all) c -= l.J * l.offset;
  return c;
}

MatrixX pick(const MatrixX& A, const std::vector<Eigen::Index>& rows, const std::vector<Eigen::Index>& cols) {
  return A(rows, cols);
}

/// J, K − H and what it resists with, by z.
struct ByFreeMotions {
  MatrixX J, A;
  VectorX r;
};

ByFreeMotions by_free_motions(const Linearised& l) {
  MatrixX difference = l.K - l.H;
  if (l.all) return {l.J, std::move(difference), l.s};
  return {l.J * l.Z, l.Z.transpose() * difference * l.Z, l.Z.transpose() * (l.s + difference * l.offset)};
}

/// The free motions E, which are eliminated, and Q, which stay.
struct Elimination {
  std::vector<Eigen::Index> E, Q;
  MatrixX J_E, J_Q, A_EE, A_EQ, A_QQ;
  VectorX r_Q;
  MatrixX yields, A_EE_EQ;  // A_EE⁻¹ J_Eᵀ and A_EE⁻¹ A_EQ
  VectorX A_EE_r;           // A_EE⁻¹ r_E
  bool positive = true;     // A_EE is, definitely
};

/// `kept`: the motions that stay.
Elimination elimination_of(const ByFreeMotions& by_z, const std::vector<bool>& kept) {
  Elimination out;
  for (std::size_t i = 0; i < kept.size(); ++i) (kept[i] ? out.Q : out.E).push_back(as_index(i));
  const std::vector<Eigen::Index> six = {0, 1, 2, 3, 4, 5};
  out.J_E = pick(by_z.J, six, out.E), out.J_Q = pick(by_z.J, six, out.Q);
  out.A_EE = pick(by_z.A, out.E, out.E), out.A_EQ = pick(by_z.A, out.E, out.Q), out.A_QQ = pick(by_z.A, out.Q, out.Q);
  out.r_Q = by_z.r(out.Q);
  const Eigen::Index stay = std::ssize(out.Q);
  MatrixX solved(std::ssize(out.E), 7 + stay);
  solved.leftCols(6) = out.J_E.transpose();
  solved.middleCols(6, stay) = out.A_EQ;
  solved.rightCols(1) = by_z.r(out.E);
  if (!out.E.empty()) {
    const Eigen::LLT<MatrixX> llt(out.A_EE);
    out.positive = llt.info() == Eigen::Success;
    if (out.positive)
      llt.solveInPlace(solved);
    else
      solved = Eigen::PartialPivLU<MatrixX>(out.A_EE).solve(solved).eval();
  }
  out.yields = solved.leftCols(6);
  out.A_EE_EQ = solved.middleCols(6, stay);
  out.A_EE_r = solved.col(6 + stay);
  return out;
}

std::string branch_at_dead_centre(const VirtualChain& chain) {
  constexpr double singular = 1e-4;
  for (const VirtualStep& step : chain.steps)
    if (const auto* group = std::get_if<VirtualGroup>(&step))
      for (const VirtualChain& branch : group->branches) {
        if (branch.mobility() < singular) return branch.name;
        if (std::string within = branch_at_dead_centre(branch); !within.empty()) return within;
      }
  return {};
}

void hold_laws_of_joints(VirtualChain& chain, std::size_t& next) {
  for (VirtualStep& step : chain.steps)
    if (auto* v = std::get_if<VirtualJoint>(&step); v && !v->joint.stiffness)
      for (const std::size_t i : v->freedoms) {
        std::vector<Law>& laws = v->joint.laws[i];
        const auto held = std::stable_partition(laws.begin(), laws.end(), is_linear);
        for (auto law = held; law != laws.end(); ++law) v->held[i].push_back(next++);
        laws.erase(held, laws.end());
      }
}

void hold_laws_of_leg(VirtualChain& leg, std::size_t& next) {
  hold_laws_of_joints(leg, next);
  for (VirtualStep& step : leg.steps)
    if (auto* group = std::get_if<VirtualGroup>(&step))
      for (VirtualChain& branch : group->branches) hold_laws_of_leg(branch, next);
}

void add_forces(const VirtualChain& chain, const ShapeConditions& c, VectorX& forces) {
  for (const VirtualStep& step : chain.steps)
    if (const auto* v = std::get_if<VirtualJoint>(&step)) {
      for (const std::size_t i : v->freedoms) {
        if (v->held[i].empty()) continue;
        const Step laws = v->deflected(i, 0, c);  // all that are left are linear
        for (const std::size_t number : v->held[i])
          forces(as_index(number)) = (v->x[i] - laws.offset) / laws.compliance;
      }
    } else if (const auto* group = std::get_if<VirtualGroup>(&step)) {
      for (const VirtualChain& branch : group->branches) add_forces(branch, c, forces);
    }
}

/// 1/√(largest |entry|) of each row, 1 at most; of no rows none.
VectorX by_row(const MatrixX& M) {
  if (M.size() == 0) return VectorX();
  return M.cwiseAbs().rowwise().maxCoeff().cwiseMax(1).cwiseSqrt().cwiseInverse();
}

}  // namespace

// With A = K − H, δ = offset + Z z and z split into E, which is eliminated, and Q, which stays,
//   z_E = A_EE⁻¹ (J_EᵀF − r_E − A_EQ z_Q)
//   [ C        Ĵ  ] [F ]   [ t + c + e ]    C = J_E A_EE⁻¹ J_Eᵀ,  Ĵ = J_Q − J_E A_EE⁻¹ A_EQ,  e = J_E A_EE⁻¹ r_E,
//   [ Ĵᵀ  −Â ] [z_Q] = [ r̂ ]              Â = A_QQ − A_QE A_EE⁻¹ A_EQ,  r̂ = r_Q − A_QE A_EE⁻¹ r_E,
// F = W (P f + B μ) with moments weighed, P and B a basis: Bᵀ J = 0. Idle freedoms make the matrix singular and stay
// where they are (smallest solution). The chain is stable while its end is held if A is positive definite on Jδ = 0,
// which by Sylvester's law means: as many positive eigenvalues of the matrix and negative ones of A_EE as f has
// entries.
const Restraint& VirtualChain::restrain(const Tip& end, const ShapeConditions& conditions) {
  held_ = linearise(conditions);
  const Linearised& l = held_;
  const bool finite = conditions.geometry == Geometry::finite;
  lack_ = gap(end, l, p_E, conditions.misfit * misfit, finite);
  const Vector6& c = lack_;
  const ByFreeMotions by_z = by_free_motions(l);
  const auto [E, Q, J_E, J_Q, A_EE, A_EQ, A_QQ, r_Q, yields, A_EE_EQ, A_EE_r, positive] = elimination_of(by_z, l.kept);
  const VectorX scale = l.scale(Q);
  const Vector6 e = J_E * A_EE_r;

  const Vector6 W = weights(length);
  const MatrixX B =
      held_rigidly(W.asDiagonal() * (J_E * yields) * W.asDiagonal(), W.asDiagonal() * J_Q * scale.asDiagonal());
  const MatrixX P = complement(B);
  const Eigen::Index rank = P.cols(), passive = J_Q.cols();
  const auto along_P = [&](const MatrixX& X) -> MatrixX {  // Pᵀ W X
    const MatrixX weighed = W.asDiagonal() * X;
    return B.cols() == 0 ? weighed : MatrixX(P.transpose() * weighed);
  };
  const MatrixX C = along_P(along_P(J_E * yields).transpose());
  const MatrixX J_hat = along_P(J_Q - J_E * A_EE_EQ) * scale.asDiagonal();
  if (conditions.judged) passive_ = J_hat;
  const MatrixX A_hat = scale.asDiagonal() * (A_QQ - A_EQ.transpose() * A_EE_EQ) * scale.asDiagonal();
  // In units in which the compliance is 1, so that ranks can be told.
  const double stiffest = A_hat.size() > 0 ? A_hat.cwiseAbs().maxCoeff() : 0;
  double unit = C.size() > 0 ? C.cwiseAbs().maxCoeff() : 0;
  if (!(unit > 0)) unit = stiffest > 0 ? 1 / stiffest : 1;
  MatrixX M = MatrixX::Zero(rank + passive, rank + passive);
  M << C / unit, J_hat, J_hat.transpose(), -unit * A_hat;
  MatrixX right = MatrixX::Zero(rank + passive, 7);
  right.topRows(rank) << along_P(Matrix6::Identity()) / unit, along_P(e) / unit;
  right.bottomRightCorner(passive, 1) = scale.cwiseProduct(r_Q - A_EQ.transpose() * A_EE_r);
  // What is stiff beside the compliance would hide the others from ranks and signs.
  const VectorX smaller = by_row(M);
  M = smaller.asDiagonal() * M * smaller.asDiagonal();
  const MatrixX solution = smaller.asDiagonal() * smallest_solution(M, smaller.asDiagonal() * right);
  const MatrixX along = B.cols() == 0 ? MatrixX(solution.topRows(rank)) : MatrixX(P * solution.topRows(rank));
  const MatrixX forces = W.asDiagonal() * along;  // F by [t + c; 1]
  response_.resize(by_z.J.cols(), 7);
  const MatrixX z_Q = unit * (scale.asDiagonal() * solution.bottomRows(passive));
  MatrixX z_E = yields * forces - A_EE_EQ * z_Q;
  z_E.col(6) -= A_EE_r;
  response_(E, Eigen::all) = z_E;
  response_(Q, Eigen::all) = z_Q;

  Restraint& held = restraint_;
  held.K = forces.leftCols<6>();
  held.K = (held.K + held.K.transpose()).eval() / 2;
  held.F0 = held.K * c + forces.col(6);
  held.m = finite ? Vector3(F.tail<3>()) : Vector3::Zero();
  held.F0.tail<3>() -= 0.5 * held.m.cross(c.tail<3>());
  held.B = W.asDiagonal() * B;
  held.b = -held.B.transpose() * c;
  held.stable = l.stable;
  if (conditions.judged && held.stable)
    held.stable = (positive && plainly_splits(C / unit, J_hat, unit * A_hat)) ||
                  negatives(equilibrated(A_EE), 1e-12) + negatives(-M, 1e-14) == rank;
  return held;
}

double VirtualChain::mobility() const {
  if (passive_.size() == 0) return 1;
  const VectorX moves = passive_.jacobiSvd().singularValues();
  return moves(moves.size() - 1) / moves(0);
}

Progress VirtualChain::follow(const Vector6& t, const VectorX& mu, const ShapeConditions& conditions) {
  F = restraint_.F0 + restraint_.K * t + restraint_.B * mu;
  F.tail<3>() -= 0.5 * restraint_.m.cross(t.tail<3>());
  Eigen::Matrix<double, 7, 1> driving;
  driving << t + lack_, 1;
  return advance(held_, held_.offset + held_.Z * (response_ * driving), conditions);
}

Restraint VirtualGroup::restrain(const ShapeConditions& c) {
  if (known && !c.judged) return *known;
  Restraint all;
  for (VirtualChain& branch : branches) {
    const Restraint& one = branch.restrain(tip, c);
    all.K += one.K;
    all.F0 += one.F0;
    all.m += one.m;
    const Eigen::Index before = all.B.cols(), more = one.B.cols();
    all.B.conservativeResize(6, before + more);
    all.B.rightCols(more) = one.B;
    all.b.conservativeResize(before + more);
    all.b.tail(more) = one.b;
    all.stable = all.stable && one.stable;
  }
  return all;
}

Progress VirtualGroup::follow(const Vector6& t, const Vector6& F, const ShapeConditions& c) {
  known.reset();
  // What rigid branches carry is what the others leave of F.
  Vector6 rest = F;
  MatrixX B(6, 0);
  for (const VirtualChain& branch : branches) {
    const Restraint& held = branch.restraint();
    rest -= held.F0 + held.K * t;
    B.conservativeResize(6, B.cols() + held.B.cols());
    B.rightCols(held.B.cols()) = held.B;
  }
  const Vector6 moments = weights(1 / branches.front().length);
  const VectorX mu = smallest_solution(moments.asDiagonal() * B, moments.asDiagonal() * rest);
  Eigen::Index next = 0;
  Progress progress;
  for (VirtualChain& branch : branches) {
    const Eigen::Index own = branch.restraint().B.cols();
    progress.add(branch.follow(t, mu.segment(next, own), c));
    next += own;
  }
  return progress;
}

Step VirtualJoint::deflected(std::size_t i, double f, const ShapeConditions& c) const {
  const Spring spring{joint.laws[i], joint.preload[i]};
  Step out{deflection(spring, f), compliance(spring, f, c.least), false};
  for (const std::size_t number : held[i]) {
    out.offset += c.steps[number].offset + c.steps[number].compliance * f;
    out.compliance += c.steps[number].compliance;
  }
  return out;
}

double VirtualJoint::tangent_force(std::size_t i, double f, const ShapeConditions& c) const {
  if (std::ranges::all_of(joint.laws[i], is_linear)) return f;
  const double unloaded = -joint.preload[i], way = x[i] - deflected(i, unloaded, c).offset;
  if (!((f - unloaded) * way < 0)) return f;
  const auto short_of = [&](double size) {
    return std::abs(deflected(i, unloaded + std::copysign(size, way), c).offset - (x[i] - way)) < std::abs(way);
  };
  double low = 0, high = std::abs(f - unloaded);
  while (short_of(high) && high < 1e300) low = high, high *= 4;
  if (short_of(high)) return f;  // no force gives that deflection
  for (int k = 0; k < 200 && high - low > 1e-12 * high; ++k) {
    const double between = low + (high - low) / 2;
    (short_of(between) ? low : high) = between;
  }
  return unloaded + std::copysign(high, way);
}

void VirtualChain::add_energies(const ShapeConditions& c, std::map<std::string, double>& sums) const {
  VirtualChain copy = *this;
  const Linearised l = copy.linearise(c);
  const VectorX s = l.J.transpose() * F + l.turned;
  Eigen::Index next = 0;
  for (const VirtualStep& step : steps)
    if (const auto* v = std::get_if<VirtualJoint>(&step)) {
      const PlacedJoint& j = v->joint;
      const Vector6 x = Eigen::Map<const Vector6>(v->x.data());
      if (j.stiffness) sums[j.part] += 0.5 * x.dot(*j.stiffness * x);
      for (const std::size_t i : v->freedoms) {
        if (!j.laws[i].empty() && !j.stiffness) sums[j.part] += stored_energy({j.laws[i], j.preload[i]}, s(next));
        ++next;
      }
    } else if (const auto* member = std::get_if<VirtualMember>(&step)) {
      sums[member->member.part] += tip_law(member->member, member->tip.x, s.segment<3>(next), c.geometry).energy;
      next += 6;
    } else {
      for (const VirtualChain& branch : std::get<VirtualGroup>(step).branches) branch.add_energies(c, sums);
      next += 6;
    }
}

double largest_wrench(const VirtualChain& chain) {
  double largest = chain.F.head<3>().norm() + chain.F.tail<3>().norm() / chain.length;
  for (const VirtualStep& step : chain.steps)
    if (const auto* group = std::get_if<VirtualGroup>(&step))
      for (const VirtualChain& branch : group->branches) largest = std::max(largest, largest_wrench(branch));
  return largest;
}

std::string at_dead_centre(VirtualChain whole, ShapeConditions conditions) {
  conditions.judged = true;
  whole.linearise(conditions);
  return branch_at_dead_centre(whole);
}

std::size_t hold_laws(VirtualChain& whole) {
  std::size_t next = 0;
  for (VirtualStep& step : whole.steps)
    if (auto* legs = std::get_if<VirtualGroup>(&step))
      for (VirtualChain& leg : legs->branches) hold_laws_of_leg(leg, next);
  hold_laws_of_joints(whole, next);
  return next;
}

VectorX forces_in_held(const VirtualChain& whole, const ShapeConditions& c) {
  VectorX forces = VectorX::Zero(std::ssize(c.steps));
  add_forces(whole, c, forces);
  return forces;
}

}  // namespace deflect::analytic
