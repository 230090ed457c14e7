#include "analytic/deformed.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "analytic/beam_column.h"
#include "analytic/flexibility.h"
#include "analytic/rotation_vector.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

constexpr double small_error = 1e-6;  // relative: is divided no further
constexpr int most_pieces = 64;
constexpr double known_to = 0.01;    // of the load at which it gives way
constexpr double follows = 0.4;      // a step of Newton's method beside the one before, on the path of equilibria
constexpr double least_step = 1e-6;  // of the load
constexpr double settled = 1e-12;    // of the last step of Newton's method
constexpr double stalls = 1e-9;      // steps no longer shorten; ten times that where forces of second order move play
constexpr double nearly = 5e-3;      // from a step of which the next one may be the last
constexpr double close = 1e-6;       // of a step, where Newton's method squares what is left

std::size_t legs_step(const VirtualChain& whole) {
  return as_size(std::find_if(whole.steps.begin(), whole.steps.end(),
                              [](const VirtualStep& s) { return std::holds_alternative<VirtualGroup>(s); }) -
                 whole.steps.begin());
}

const VirtualGroup& legs_of(const VirtualChain& whole) { return std::get<VirtualGroup>(whole.steps[legs_step(whole)]); }

Vector3 translation(const VirtualChain& whole, const Linearised& l, Geometry geometry) {
  return geometry == Geometry::finite ? l.end.displacement(whole.p_E) : Vector3(l.J.topRows<3>() * l.x);
}

/// What the freedoms that the whole chain has under a known wrench resist with.
struct Tangent {
  Tangent(const Linearised& l, const Vector3& moment) : J(l.J * l.Z), A(l.Z.transpose() * (l.K - l.H) * l.Z) {
    const MatrixX spins = J.bottomRows<3>();
    A -= 0.5 * spins.transpose() * skew(moment) * spins;
  }

  MatrixX solve(const MatrixX& right) const { return A.size() == 0 ? right : MatrixX(A.partialPivLu().solve(right)); }
  /// Without moment.
  bool positive() const {
    return A.size() == 0 ||
           Eigen::SelfAdjointEigenSolver<MatrixX>(scaled(), Eigen::EigenvaluesOnly).eigenvalues()(0) > 1e-13;
  }
  /// With a moment, which makes it unsymmetric: that is no question of definiteness. A positive determinant stands for
  /// it: no critical load was passed, or two.
  bool regains() const { return A.size() == 0 || scaled().partialPivLu().determinant() > 0; }

  MatrixX scaled() const {
    const VectorX s = A.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    return s.asDiagonal() * A * s.asDiagonal();
  }

  MatrixX J, A;
};

/// Newton's method in finite motions needs the stiffness by spins of a dead moment; second order solves by K_E + K_G.
Vector3 turning_moment(const Deformed& d) {
  return d.conditions.geometry == Geometry::finite ? Vector3(d.whole.F.tail<3>()) : Vector3::Zero();
}

/// What the last step of Newton's method knows of the state that it leaves, where it was looked at whether that is
/// stable: all but nothing was left to move.
struct LastStep {
  Linearised before;
  Vector6 moves = Vector6::Zero();  // [δ; ψ] of the end
};

/// Newton's method under the wrench F and a share of the misfits.
bool equilibrium(Deformed& d, const Vector6& F, double misfit, std::optional<LastStep>& last) {
  ShapeConditions& c = d.conditions;
  VirtualChain& whole = d.whole;
  whole.F = F;
  c.misfit = misfit;
  double largest = largest_wrench(whole), previous = 1, step = 0;
  const bool finite = c.geometry == Geometry::finite;
  // Contacts have no stiffness at rest: where nothing is strained yet they are taken as under the whole load.
  const auto& branches = legs_of(whole).branches;
  const bool at_rest = std::ranges::all_of(branches, [](const auto& leg) { return largest_wrench(leg) == 0; });
  c.least = !at_rest ? 1e-9 * largest : largest > 0 ? largest : 1;
  LawsAtRest laws(whole.length);
  for (int i = 0; i < 50; ++i) {
    ++d.iterations;
    if (d.move_steps && i > 0)
      if (!laws.go_on(d.move_steps(forces_in_held(whole, c), largest, c.steps))) {
        d.undecided = true;
        return false;
      }
    ShapeConditions here = c;
    here.judged = i > 0 && d.residual <= nearly;
    Linearised l = whole.linearise(here);
    const Tangent tangent(l, turning_moment(d));
    const MatrixX difference = l.K - l.H;
    const VectorX delta =
        l.offset + l.Z * tangent.solve(l.Z.transpose() * (l.J.transpose() * F - l.s - difference * l.offset));
    if (!delta.allFinite()) return false;
    const Progress progress = whole.advance(l, delta, c);
    largest = largest_wrench(whole);
    if (!std::isfinite(progress.step + largest)) return false;
    c.least = 1e-9 * (largest > 0 ? largest : 1);
    // Shapes are known to rounding, 1e-16 of their size, at best.
    const double size = progress.reach + 1e-3 * whole.length;
    d.residual = progress.step / size;
    // A first step from rest takes contacts for what they will be.
    if (finite && i > (at_rest ? 1 : 0) && d.residual > 1e-7 && progress.step > follows * step &&
        !laws.explain(progress.step))
      return false;
    step = progress.step;
    // Newton's method squares what is left: the next step would be no step.
    const bool foretold = d.residual <= close && std::pow(d.residual, 3) <= settled * previous * previous &&
                          laws.stay_within(settled * size);
    const bool there = d.residual <= settled || (here.judged && foretold);
    last.reset();  // of the last step alone: laws may have moved since an earlier one was judged
    if (here.judged && there) {
      const Vector6 moves = l.J * delta;
      last = LastStep{std::move(l), moves};
    }
    const bool rest = (i > 0 || !d.move_steps) && laws.rest();
    if (rest && (there || (d.residual <= (d.move_steps ? 10 * stalls : stalls) && d.residual > 0.3 * previous)))
      return true;
    previous = d.residual;
  }
  d.undecided = d.move_steps != nullptr;
  return false;
}

/// Turns the wrenches of the legs into base axes, and its transpose motions of T into those of the legs. In second
/// order the legs' displacements y, φ on a base that turned by θ move T by (1 + [θ]×) y and turn it by (1 + ½[θ]×) φ,
/// so that what they carry in their own axes is (1 − [θ]×) f and (1 − ½[θ]×) m.
Matrix6 to_base_axes(const VirtualChain& whole, Geometry geometry) {
  const std::size_t legs = legs_step(whole);
  if (geometry == Geometry::finite) return rotate_twist(whole.motion_before(legs, geometry).R());
  Vector3 theta = Vector3::Zero();
  for (std::size_t i = 0; i < legs; ++i) {
    const VirtualJoint& base = std::get<VirtualJoint>(whole.steps[i]);
    theta += base.joint.R_WJ * Eigen::Map<const Vector3>(base.x.data() + 3);
  }
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = (Matrix3::Identity() - skew(theta)).inverse();
  out.bottomRightCorner<3, 3>() = (Matrix3::Identity() - 0.5 * skew(theta)).inverse();
  return out;
}

/// Reads off the state what is asked of it; false where it is not stable.
bool conclude(Deformed& d, std::optional<LastStep> last) {
  const Geometry geometry = d.conditions.geometry;
  if (!last) {
    ShapeConditions asked = d.conditions;
    asked.judged = true;
    last = LastStep{d.whole.linearise(asked)};
  }
  const Linearised& l = last->before;
  const Vector3 turn = last->moves.tail<3>();
  d.translation = translation(d.whole, l, geometry) + last->moves.head<3>();
  if (geometry == Geometry::finite) {
    d.turning = combined(turning(turn), l.end.D);
    d.rotation_vector = rotation_vector(d.turning);
  } else {
    d.rotation_vector = l.J.bottomRows<3>() * l.x + turn;
  }
  const Matrix6 axes = to_base_axes(d.whole, geometry);
  d.leg_wrenches.clear();
  for (const VirtualChain& leg : legs_of(d.whole).branches) d.leg_wrenches.push_back(axes * leg.F);
  const Vector3 moment = d.whole.F.tail<3>();
  return l.stable && (Tangent(l, Vector3::Zero()).positive() || (!moment.isZero(0) && Tangent(l, moment).regains()));
}

bool all_fit(const std::vector<PlacedLeg>& legs) {
  return std::all_of(legs.begin(), legs.end(), [](const PlacedLeg& leg) {
    return leg.misfit.isZero(0) && std::all_of(leg.parts.begin(), leg.parts.end(), [](const PlacedPart& part) {
             const auto* group = std::get_if<PlacedParallel>(&part);
             return !group || all_fit(group->branches);
           });
  });
}

/// Whether there is a stable state under the wrench F and a share of the misfits; d is then in it.
bool settles(Deformed& d, const Vector6& F, double misfit) {
  std::optional<LastStep> last;
  return equilibrium(d, F, misfit, last) && conclude(d, std::move(last));
}

/// Why no equilibrium follows on the last stable one.
std::string why_it_ends(Deformed& d, const char* what) {
  const std::string chain = at_dead_centre(d.whole, d.conditions);
  d.at_dead_centre = !chain.empty();
  if (d.at_dead_centre)
    return fmt::format(
        "the passive joints of {} come to a singular position (a dead centre) at {:.4g} of the {}: from there it would "
        "lock or jump. Load it less, or where that leg is farther from it",
        chain, d.load_factor, what);
  return fmt::format(
      "it gives way at {:.4g} of the {}, a buckling or limit load: that is what the last stable equilibrium on the way "
      "carries",
      d.load_factor, what);
}

/// From the state as it is to all of the misfits under F, where F is given to a state that has them already.
void approach(Deformed& d, const Vector6& F, bool fitting) {
  d.load_factor = 0;
  for (double step = 1; d.load_factor < 1;) {
    Deformed next = d;
    const double factor = std::min(1.0, d.load_factor + step);
    const bool stable = settles(next, fitting ? Vector6::Zero() : Vector6(factor * F), fitting ? factor : 1);
    d.iterations = next.iterations;
    if (stable) {
      d = std::move(next);
      d.converged = true;
      d.load_factor = factor;
      step *= 2;
      continue;
    }
    d.residual = next.residual;
    step /= 2;
    if (step > least_step && !next.undecided) continue;
    d.converged = false;
    d.undecided = next.undecided;
    if (d.undecided) return;
    d.message = why_it_ends(d, fitting ? "misfits" : "load");
    return;
  }
}

void find_bends(const VirtualChain& chain, Geometry geometry, std::vector<double>& bends) {
  for (const VirtualStep& step : chain.steps)
    if (const auto* m = std::get_if<VirtualMember>(&step))
      bends[m->number] = std::max(bends[m->number], left_out(m->member, m->tip.x, geometry));
    else if (const auto* group = std::get_if<VirtualGroup>(&step))
      for (const VirtualChain& branch : group->branches) find_bends(branch, geometry, bends);
}

/// By member, what the law of its pieces leaves out under the whole load; from the load that the state carries.
std::vector<double> bends_of(const Deformed& d) {
  std::vector<double> bends(d.pieces.size(), 0.0);
  find_bends(d.whole, d.conditions.geometry, bends);
  for (double& bend : bends) bend /= d.load_factor > 0 ? std::pow(d.load_factor, 4) : 1;
  return bends;
}

/// Twice as many; of a state under the whole load so many to begin with that little is left out of each.
std::vector<int> divided(std::vector<int> pieces, const std::vector<double>& bends, bool whole_load) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (bends[i] <= small_error / 10) continue;
    const bool whole = pieces[i] == 1 && whole_load;
    pieces[i] = std::min(2 * pieces[i], most_pieces);
    while (whole && bends[i] > 0.005 * std::pow(pieces[i], 4) && 2 * pieces[i] < most_pieces) pieces[i] *= 2;
  }
  return pieces;
}

/// The estimate is small beside the displacement, rotations weighed by a length.
double relative(const Eigen::Vector2d& e, const Deformed& d, double length) {
  const double moved = std::max(d.translation.norm(), length * d.rotation_vector.norm());
  return moved > 0 ? std::max(e(0), length * e(1)) / moved : 0;
}

Deformed unloaded(const Configuration& c, const ShapeConditions& under, std::vector<int> pieces,
                  MoveSteps move_steps = nullptr) {
  Deformed d;
  d.move_steps = std::move(move_steps);
  d.pieces = std::move(pieces);
  Pieces of_members{d.pieces};
  const PlacedParallel legs{"legs", Vector3::Zero(), c.pose.p_WT, c.legs};
  d.whole = virtual_chain_of({"the mechanism", {c.base, legs, c.tool}}, c.pose.p_WT, c.pose.p_WT, c.size, of_members);
  d.conditions.geometry = under.geometry;
  d.conditions.steps = under.steps;
  if (!under.steps.empty() && hold_laws(d.whole) != under.steps.size())
    throw std::invalid_argument("not as many steps as laws");
  d.leg_wrenches.assign(c.legs.size(), Vector6::Zero());
  return d;
}

Deformed loaded(Deformed d, const Configuration& c, const Vector6& F) {
  const bool fits = all_fit(c.legs);
  if (!fits || F.isZero(0)) approach(d, F, true);
  if ((fits || d.converged) && !F.isZero(0)) approach(d, F, false);
  return d;
}

/// `coarser`: with fewer pieces, whose state is taken for the beginning where it is one.
Deformed with_pieces(const Configuration& c, const Vector6& F, std::vector<int> pieces, const Deformed& coarser) {
  Deformed d = unloaded(c, coarser.conditions, std::move(pieces), coarser.move_steps);
  if (coarser.converged) {
    Deformed same = d;
    take_state(same.whole, coarser.whole);
    same.converged = settles(same, F, 1);
    same.load_factor = 1;
    if (same.converged) return same;
  }
  return loaded(std::move(d), c, F);
}

std::vector<int> whole_members(const Configuration& c) {
  std::size_t members = 0;
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.section; }) ++members;
  });
  return std::vector<int>(members, 1);
}

/// The first step of Newton's method from there has the same legs for every load.
Deformed knowing_legs(Deformed rest, const Configuration& c, bool linear) {
  if (!linear || !all_fit(c.legs)) return rest;
  auto& legs = std::get<VirtualGroup>(rest.whole.steps[legs_step(rest.whole)]);
  legs.known = legs.restrain(rest.conditions);
  return rest;
}

}  // namespace

Deformed at_rest(const Configuration& c, Geometry geometry, bool linear) {
  return knowing_legs(unloaded(c, {geometry}, whole_members(c)), c, linear);
}

Deformed at_rest_in(const std::vector<Step>& steps, const Configuration& c, Geometry geometry) {
  ShapeConditions under{geometry};
  under.steps = steps;
  const bool unmoved = std::all_of(steps.begin(), steps.end(), [](const Step& s) { return s.offset == 0; });
  return knowing_legs(unloaded(c, under, whole_members(c)), c, unmoved);
}

Deformed in_other_steps(const Deformed& from, const std::vector<Step>& steps, const Configuration& c) {
  Deformed d = from;
  d.iterations = 0;
  d.conditions.steps = steps;
  if (settles(d, from.whole.F, 1)) return d;
  return deform(at_rest_in(steps, c, from.conditions.geometry), c, from.whole.F);
}

Deformed deform(const Deformed& rest, const Configuration& c, const Vector6& F) {
  Deformed d = loaded(rest, c, F);
  const std::vector<double> bends = bends_of(d);
  const double most = bends.empty() ? 0 : *std::max_element(bends.begin(), bends.end());
  d.discretisation = {most * d.translation.norm(), most * d.rotation_vector.norm()};
  if (most <= small_error || d.conditions.geometry != Geometry::finite)
    return d;  // what one piece leaves is known by its order
  for (double left = 1; left > small_error && !d.undecided;) {
    std::vector<int> pieces = divided(d.pieces, bends, d.converged);
    if (pieces == d.pieces) {
      if (!d.converged || left <= 1e-4) break;
      d.converged = false;
      d.message = fmt::format("members bend so far that {} pieces each leave an error of {:.1e}", most_pieces, left);
      break;
    }
    Deformed finer = with_pieces(c, F, std::move(pieces), d);
    finer.discretisation = {(finer.translation - d.translation).norm() / 3,
                            rotation_vector(combined(finer.turning, d.turning.transpose())).norm() / 3};
    left = d.converged && finer.converged ? relative(finer.discretisation, finer, c.size) : 1;
    const bool alike = (d.at_dead_centre && finer.at_dead_centre) ||
                       std::abs(finer.load_factor - d.load_factor) <= known_to * finer.load_factor;
    const bool gives_way = !d.converged && !finer.converged && alike;
    d = std::move(finer);
    if (gives_way) break;
  }
  return d;
}

Matrix6 stiffness(const Deformed& d) {
  VirtualChain whole = d.whole;
  const Tangent tangent(whole.linearise(d.conditions), d.whole.F.tail<3>());
  if (tangent.J.cols() == 6) {  // as when base and tool are rigid: no digits are lost by inverting twice
    const Eigen::FullPivLU<Matrix6> lu(tangent.J.transpose());
    if (lu.isInvertible()) {
      const Matrix6 half = lu.solve(tangent.A);
      return lu.solve(half.transpose()).transpose();
    }
  }
  const Matrix6 C = tangent.J * tangent.solve(tangent.J.transpose());
  return stiffness(
      Flexibility{C, Matrix6X(6, 0), false, Matrix6X(6, 0), carried_wrenches(Matrix6X(6, 0), whole.length)},
      whole.length, whole.name);
}

Matrix6 compliance(const Deformed& d) {
  VirtualChain whole = d.whole;
  const Tangent tangent(whole.linearise(d.conditions), d.whole.F.tail<3>());
  return tangent.J * tangent.solve(tangent.J.transpose());
}

Matrix6 leg_stiffness(const Deformed& d, std::size_t leg) {
  VirtualChain whole = d.whole;
  whole.linearise(d.conditions);
  const Matrix6 axes = to_base_axes(d.whole, d.conditions.geometry);
  return axes * legs_of(whole).branches[leg].restraint().K * axes.transpose();
}

}  // namespace deflect::analytic
