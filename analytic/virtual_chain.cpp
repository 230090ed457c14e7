#include "analytic/virtual_chain.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "analytic/beam_column.h"
#include "analytic/flexibility.h"
#include "analytic/rotation_vector.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

RigidMotion shift(const Vector3& u) { return {Matrix3::Zero(), u}; }
RigidMotion turn(const Matrix3& D, const Vector3& about) { return {D, -D * about}; }

RigidMotion motion_of(const VirtualJoint& v) {
  const Matrix3& A = v.joint.R_WJ;
  Matrix3 D = Matrix3::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) D = combined(D, turning(nth(v.x, 3 + i) * Vector3::Unit(i)));
  return shift(A * Vector3(v.x[0], v.x[1], v.x[2])) * turn(A * D * A.transpose(), v.joint.p_W);
}

RigidMotion motion_of(const VirtualStep& step) {
  if (const auto* joint = std::get_if<VirtualJoint>(&step)) return motion_of(*joint);
  if (const auto* member = std::get_if<VirtualMember>(&step)) return member->tip.motion();
  return std::get<VirtualGroup>(step).tip.motion();
}

/// A freedom as it moves the end: spin ω, and velocity v once the end is known; until then the point on its axis.
struct Column {
  Vector3 omega, v;
  int tip = -1;  // rotations of one tip belong together
};

/// Of a joint that has moved by x.
void add_columns(const VirtualJoint& v, const std::array<double, 6>& x, const RigidMotion& before,
                 std::vector<Column>& columns) {
  Matrix3 axes = before.R() * v.joint.R_WJ;
  const Vector3 point = before(v.joint.p_W + v.joint.R_WJ * Vector3(x[0], x[1], x[2]));
  std::size_t next = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3 axis = axes.col(as_index(i % 3));
    if (next < v.freedoms.size() && v.freedoms[next] == i) {
      columns.push_back(i < 3 ? Column{Vector3::Zero(), axis} : Column{axis, point});
      ++next;
    }
    if (i >= 3) axes = Eigen::AngleAxisd(x[i], axis) * axes;
  }
}

void add_columns(const Tip& tip, const RigidMotion& before, std::vector<Column>& columns) {
  const Matrix3 axes = before.R() * tip.A;
  const Vector3 point = before(tip.motion()(tip.p));
  const int number = static_cast<int>(columns.size());
  for (Eigen::Index i = 0; i < 3; ++i) columns.push_back({Vector3::Zero(), axes.col(i)});
  for (Eigen::Index i = 0; i < 3; ++i) columns.push_back({axes.col(i), point, number});
}

/// The freedoms of steps in series.
struct Freedoms {
  std::vector<Column> columns;
  std::vector<Eigen::Index> first;  // by step its first freedom, and one behind the last
  std::vector<double> x;
  RigidMotion end;  // as the steps move it, where the shape is finite
};

/// Columns in the shape of the state where that is `finite`, else in the undeformed one.
Freedoms freedoms_of(const std::vector<VirtualStep>& steps, bool finite) {
  Freedoms out;
  for (const VirtualStep& step : steps) {
    out.first.push_back(std::ssize(out.columns));
    if (const auto* joint = std::get_if<VirtualJoint>(&step)) {
      add_columns(*joint, finite ? joint->x : std::array<double, 6>{}, out.end, out.columns);
      for (const std::size_t i : joint->freedoms) out.x.push_back(joint->x[i]);
    } else {
      Tip tip = std::holds_alternative<VirtualMember>(step) ? std::get<VirtualMember>(step).tip
                                                            : std::get<VirtualGroup>(step).tip;
      const Vector6 moved = tip.x;
      if (!finite) tip = {tip.p, tip.A};
      add_columns(tip, out.end, out.columns);
      out.x.insert(out.x.end(), moved.data(), moved.data() + 6);
    }
    if (finite) out.end = out.end * motion_of(step);
  }
  out.first.push_back(std::ssize(out.columns));
  return out;
}

/// J at the end, whose place is given; the columns then have their velocities.
Matrix6X twists_at(const Vector3& end, std::vector<Column>& columns) {
  Matrix6X J(6, std::ssize(columns));
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    Column& column = nth(columns, i);
    if (!column.omega.isZero(0)) column.v = column.omega.cross(end - column.v);
    J.col(i) << column.v, column.omega;
  }
  return J;
}

/// H of the wrench F at the end.
MatrixX second_derivative(const std::vector<Column>& columns, const Vector6& F) {
  const auto n = std::ssize(columns);
  const Vector3 f = F.head<3>(), m = F.tail<3>();
  MatrixX H = MatrixX::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i; j < n; ++j) {
      const Column &a = nth(columns, i), &b = nth(columns, j);
      H(i, j) = a.tip >= 0 && a.tip == b.tip ? 0.5 * f.dot(a.omega.cross(b.v) + b.omega.cross(a.v))
                : i < j                      ? f.dot(a.omega.cross(b.v)) + 0.5 * m.dot(a.omega.cross(b.omega))
                                             : f.dot(a.omega.cross(b.v));
      H(j, i) = H(i, j);
    }
  return H;
}

/// Adds the joint's laws under the forces s at its freedoms.
void add_laws(const VirtualJoint& v, const ShapeConditions& c, Eigen::Ref<VectorX> s, Eigen::Ref<MatrixX> K,
              std::vector<bool>& kept) {
  const VectorX static_force = s;
  s.setZero();
  for (std::size_t k = 0; k < v.freedoms.size(); ++k) {
    const auto at = as_index(k);
    const std::size_t i = v.freedoms[k];
    kept.push_back(!v.elastic(i));
    if (kept.back()) continue;
    if (v.joint.stiffness) {
      for (std::size_t j = 0; j < 6; ++j) {
        K(at, as_index(j)) = (*v.joint.stiffness)(at, as_index(j));
        s(at) += K(at, as_index(j)) * v.x[j];
      }
      continue;
    }
    const double force = v.tangent_force(i, static_force(at), c);
    const Step laws = v.deflected(i, force, c);
    K(at, at) = 1 / laws.compliance;
    s(at) = force + K(at, at) * (v.x[i] - laws.offset);
  }
}

/// Adds s, K and Z by the laws of all steps, with `first` as in Freedoms and statics' forces `along` the freedoms. By
/// column of Z: the step of a joint, −1 of members and groups.
std::vector<int> add_all_laws(std::vector<VirtualStep>& steps, const std::vector<Eigen::Index>& first,
                              const VectorX& along, const ShapeConditions& c, double length, Linearised& l) {
  const Eigen::Index n = along.size();
  l.K = MatrixX::Zero(n, n);
  MatrixX Z = MatrixX::Identity(n, n);
  l.offset = VectorX::Zero(n);
  std::vector<Eigen::Index> allowed;  // columns of Z that remain
  std::vector<int> joint_of;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Eigen::Index at = first[k], size = first[k + 1] - at;
    if (auto* joint = std::get_if<VirtualJoint>(&steps[k])) {
      add_laws(*joint, c, l.s.segment(at, size), l.K.block(at, at, size, size), l.kept);
      for (Eigen::Index i = 0; i < size; ++i) allowed.push_back(at + i);
    } else if (auto* member = std::get_if<VirtualMember>(&steps[k])) {
      const TipLaw law = tip_law(member->member, member->tip.x, along.segment<3>(at), c.geometry);
      l.s.segment<6>(at) = law.s;
      l.K.block<6, 6>(at, at) = law.K;
      l.stable = l.stable && law.stable;
      l.kept.insert(l.kept.end(), 6, false);
      for (Eigen::Index i = 0; i < 6; ++i) allowed.push_back(at + i);
    } else {
      const Restraint held = std::get<VirtualGroup>(steps[k]).restrain(c);
      l.s.segment<6>(at) = held.F0;
      l.K.block<6, 6>(at, at) = held.K;
      l.stable = l.stable && held.stable;
      l.all = l.all && held.B.cols() == 0;
      const Matrix6X free = held.B.cols() == 0 ? Matrix6X(Matrix6::Identity()) : free_twists(held.B, length);
      if (held.B.cols() > 0)
        l.offset.segment<6>(at) = VectorX(MatrixX(held.B.transpose()).completeOrthogonalDecomposition().solve(held.b));
      Z.block(at, at, 6, free.cols()) = free;
      l.kept.insert(l.kept.end(), as_size(free.cols()), true);
      for (Eigen::Index i = 0; i < free.cols(); ++i) allowed.push_back(at + i);
    }
    joint_of.resize(allowed.size(), std::holds_alternative<VirtualJoint>(steps[k]) ? static_cast<int>(k) : -1);
  }
  l.Z = Z(Eigen::all, allowed);
  return joint_of;
}

/// The part of F that passes through all passive joints; in equilibrium that is F. Nothing where no passive joint
/// idles. Newton's method, on its way, would take the rest for a stiffness of what idles, and drive it far by a force
/// that is no force.
std::optional<Vector6> let_through(const Vector6& F, const Linearised& l, const Matrix6X& twists,
                                   const std::vector<int>& step, double length) {
  std::vector<Eigen::Index> passive;
  for (std::size_t i = 0; i < l.kept.size(); ++i)
    if (l.kept[i] && step[i] >= 0) passive.push_back(as_index(i));
  if (passive.empty()) return std::nullopt;
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(length);
  const MatrixX moves = w.asDiagonal() * twists(Eigen::all, passive) * l.scale(passive).asDiagonal();
  if (plainly_span(moves.transpose())) return std::nullopt;
  Eigen::ColPivHouseholderQR<MatrixX> qr;
  qr.setThreshold(1e-9);
  qr.compute(moves);
  if (qr.rank() == std::ssize(passive)) return std::nullopt;
  const MatrixX Q = MatrixX(qr.householderQ()).leftCols(qr.rank());
  const Vector6 F_w = F.cwiseQuotient(w);
  return Vector6(w.cwiseProduct(F_w - Q * (Q.transpose() * F_w)));
}

/// Takes out of Z the motions of passive joints that do not move the end and let all between turn about one line, or
/// slide along one. `step`: of each column of Z that belongs to a joint; −1 of members and groups.
void hold_idle(Linearised& l, const std::vector<int>& step, double length) {
  std::vector<Eigen::Index> passive, others;
  for (std::size_t i = 0; i < l.kept.size(); ++i) (l.kept[i] && step[i] >= 0 ? passive : others).push_back(as_index(i));
  if (passive.empty()) return;
  const MatrixX Z = l.Z(Eigen::all, passive) * l.scale(passive).asDiagonal();
  MatrixX twists = l.J * Z;
  twists.bottomRows<3>() *= length;
  MatrixX idle(Z.cols(), 0);
  const MatrixX still = complement(twists.transpose());
  for (Eigen::Index k = 0; k < still.cols(); ++k) {
    // Twists of what stands behind each step.
    MatrixX between = MatrixX::Zero(6, nth(step, passive.back()) + 1);
    for (Eigen::Index i = 0; i < twists.cols(); ++i) {
      const int from = nth(step, nth(passive, i));
      between.rightCols(between.cols() - from).colwise() += still(i, k) * twists.col(i);
    }
    const VectorX sizes = between.jacobiSvd().singularValues();
    if (sizes.size() > 1 && sizes(1) > 1e-9 * sizes(0)) continue;
    idle.conservativeResize(Eigen::NoChange, idle.cols() + 1);
    idle.rightCols<1>() = still.col(k);
  }
  if (idle.cols() == 0) return;
  const MatrixX moving = Z * complement(idle), rest = l.Z(Eigen::all, others);
  std::vector<bool> kept;
  for (const Eigen::Index i : others) kept.push_back(nth(l.kept, i));
  kept.resize(as_size(rest.cols() + moving.cols()), true);
  VectorX scale = VectorX::Ones(rest.cols() + moving.cols());
  for (std::size_t i = 0; i < others.size(); ++i) scale(as_index(i)) = l.scale(others[i]);
  l.all = false;
  l.kept = kept;
  l.scale = scale;
  l.Z.resize(l.Z.rows(), rest.cols() + moving.cols());
  l.Z << rest, moving;
}

void add_pieces(const PlacedMember& member, Pieces& pieces, std::vector<VirtualStep>& steps) {
  const int n = pieces.next < pieces.of.size() ? pieces.of[pieces.next] : 1;
  const Vector3 line = member.p_W_end - member.p_W_start;
  for (int i = 0; i < n; ++i) {
    PlacedMember piece = member;
    piece.p_W_start = member.p_W_start + i * line / n;
    if (i + 1 < n) piece.p_W_end = member.p_W_start + (i + 1) * line / n;
    steps.push_back(VirtualMember{piece, {piece.p_W_end, piece.R_WM}, pieces.next});
  }
  ++pieces.next;
}

/// n pieces that turn alike, each by R: their ends lie Σ Rⁱ r_1 = r apart.
void take_pieces(VirtualChain& chain, std::size_t& next, const VirtualMember& whole) {
  const double length = std::get<VirtualMember>(chain.steps[next]).member.length();
  const auto n = static_cast<int>(std::lround(whole.member.length() / length));
  const Vector3 rotation = whole.tip.x.tail<3>() / n;
  const Matrix3 D = n == 1 ? whole.tip.D : turning(rotation);
  Matrix3 sum = Matrix3::Identity();
  for (int i = 1; i < n; ++i) sum = Matrix3::Identity() + sum + D * sum;
  const Vector3 whole_line = whole.tip.x.head<3>() + whole.member.length() * Vector3::UnitX();
  const Vector3 line = sum.partialPivLu().solve(whole_line);
  for (int i = 0; i < n; ++i) {
    Tip& tip = std::get<VirtualMember>(chain.steps[next++]).tip;
    tip.D = D;
    tip.x << (n == 1 ? Vector3(whole.tip.x.head<3>()) : Vector3(line - length * Vector3::UnitX())), rotation;
  }
}

}  // namespace

RigidMotion Tip::motion() const { return shift(A * x.head<3>()) * turn(A * D * A.transpose(), p); }

void Tip::move(const Vector6& increment, Geometry geometry) {
  x.head<3>() += increment.head<3>();
  if (geometry == Geometry::finite) {
    D = combined(turning(increment.tail<3>()), D);
    x.tail<3>() = rotation_vector(D);
  } else {
    x.tail<3>() += increment.tail<3>();
  }
}

VirtualChain virtual_chain_of(const PlacedLeg& leg, const Vector3& p_E, const Vector3& p_WT, double length,
                              Pieces& pieces) {
  VirtualChain chain;
  chain.name = leg.name;
  chain.length = length;
  chain.p_E = p_E;
  chain.misfit = shift_twist(p_E - p_WT) * leg.misfit;
  for (const PlacedPart& part : leg.parts)
    if (const auto* joint = std::get_if<PlacedJoint>(&part)) {
      VirtualJoint v{*joint, {}, {}};
      for (std::size_t i = 0; i < 6; ++i)
        if (joint->free(i) || joint->elastic(i)) v.freedoms.push_back(i);
      if (!v.freedoms.empty()) chain.steps.push_back(std::move(v));
    } else if (const auto* member = std::get_if<PlacedMember>(&part)) {
      add_pieces(*member, pieces, chain.steps);
    } else {
      const auto& parallel = std::get<PlacedParallel>(part);
      VirtualGroup group{parallel.part, {parallel.p_W_end}, {}};
      for (const PlacedLeg& branch : parallel.branches)
        group.branches.push_back(virtual_chain_of(branch, parallel.p_W_end, p_WT, length, pieces));
      chain.steps.push_back(std::move(group));
    }
  return chain;
}

Linearised VirtualChain::linearise(const ShapeConditions& c) {
  Linearised out;
  const bool finite = c.geometry == Geometry::finite;
  Freedoms freedoms = freedoms_of(steps, finite);
  out.end = freedoms.end;
  if (finite) out.end = out.end * shift(c.misfit * misfit.head<3>()) * turn(turning(c.misfit * misfit.tail<3>()), p_E);
  const auto n = std::ssize(freedoms.columns);
  out.J = twists_at(out.end(p_E), freedoms.columns);
  out.H = second_derivative(freedoms.columns, F);
  if (!finite)
    for (std::size_t k = 0; k < steps.size(); ++k)
      if (const Eigen::Index at = freedoms.first[k]; std::holds_alternative<VirtualMember>(steps[k]))
        out.H.row(at).setZero(), out.H.col(at).setZero();
  out.x = Eigen::Map<const VectorX>(freedoms.x.data(), n);
  // Forces that statics puts on the freedoms; then what the laws make of them.
  const VectorX along = out.J.transpose() * F;
  out.turned = VectorX::Zero(n);
  if (!finite) {  // the misfit is the motion of a last tip, which H sees too
    const Vector3 f = F.head<3>(), m = F.tail<3>();
    const Vector6 beside = c.misfit * misfit;
    const Vector3 moment = beside.head<3>().cross(f) + 0.5 * beside.tail<3>().cross(m);
    out.turned = out.H * out.x + out.J.bottomRows<3>().transpose() * moment;
  }
  out.s = along + out.turned;
  const std::vector<int> joint_of = add_all_laws(steps, freedoms.first, along, c, length, out);
  out.s -= out.turned;
  out.scale = VectorX::Ones(out.Z.cols());
  const Matrix6X twists = out.all ? out.J : Matrix6X(out.J * out.Z);
  for (Eigen::Index i = 0; i < out.Z.cols(); ++i)  // a freedom turns when it turns the end
    if (twists.col(i).tail<3>().norm() * length > 1e-9 * twists.col(i).head<3>().norm()) out.scale(i) = 1 / length;
  if (finite)
    if (const std::optional<Vector6> through = let_through(F, out, twists, joint_of, length))
      out.H = second_derivative(freedoms.columns, *through);
  hold_idle(out, joint_of, length);
  return out;
}

RigidMotion VirtualChain::motion_before(std::size_t step, Geometry geometry) const {
  RigidMotion motion;
  if (geometry == Geometry::finite)
    for (std::size_t i = 0; i < step; ++i) motion = motion * motion_of(steps[i]);
  return motion;
}

Progress VirtualChain::advance(const Linearised& at, const VectorX& delta, const ShapeConditions& c) {
  const VectorX s = at.J.transpose() * F + at.H * delta + at.turned;
  Progress progress;
  const auto count = [&](std::size_t freedom, double x, double step) {
    const double scale = freedom < 3 ? 1 : length;
    progress.add({scale * std::abs(x), scale * std::abs(step)});
  };
  Eigen::Index next = 0;
  for (VirtualStep& step : steps)
    if (auto* joint = std::get_if<VirtualJoint>(&step)) {
      for (const std::size_t i : joint->freedoms) {
        joint->x[i] += delta(next);
        count(i, joint->x[i], delta(next++));
      }
    } else {
      const Vector6 increment = delta.segment<6>(next);
      Tip& tip = std::holds_alternative<VirtualMember>(step) ? std::get<VirtualMember>(step).tip
                                                             : std::get<VirtualGroup>(step).tip;
      tip.move(increment, c.geometry);
      for (std::size_t i = 0; i < 6; ++i) count(i, tip.x(as_index(i)), increment(as_index(i)));
      if (auto* group = std::get_if<VirtualGroup>(&step)) progress.add(group->follow(increment, s.segment<6>(next), c));
      next += 6;
    }
  return progress;
}

void take_state(VirtualChain& chain, const VirtualChain& coarser) {
  chain.F = coarser.F;
  std::size_t next = 0;
  for (const VirtualStep& step : coarser.steps) {
    if (const auto* joint = std::get_if<VirtualJoint>(&step)) {
      std::get<VirtualJoint>(chain.steps[next++]).x = joint->x;
    } else if (const auto* group = std::get_if<VirtualGroup>(&step)) {
      auto& same = std::get<VirtualGroup>(chain.steps[next++]);
      same.tip = group->tip;
      for (std::size_t i = 0; i < group->branches.size(); ++i) take_state(same.branches[i], group->branches[i]);
    } else {
      take_pieces(chain, next, std::get<VirtualMember>(step));
    }
  }
}

}  // namespace deflect::analytic
