#include "tests/attack/shape_oracle.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "msa/base/index.h"
#include "tests/attack/shape_chain.h"

namespace deflect::attack {
namespace {

struct State {
  std::vector<MotionL> bodies;
  std::vector<Vector6L> wrenches;  ///< over the scale
  std::vector<VectorL> numbers;
};

class ShapeMethod {
 public:
  ShapeMethod(const Configuration& c, const Vector6& F, double size, Shear shear)
      : p_T_(c.pose.p_WT.cast<Long>()), shear_(shear) {
    load_ = F.cast<Long>();
    load_.head<3>() += c.weight.cast<Long>();
    scale_.length = c.size > 0 ? c.size : 1;
    scale_.move = size;
    scale_.force = std::max(load_.head<3>().norm(), load_.tail<3>().norm() / scale_.length);
    if (!(scale_.force > 0)) scale_.force = 1;
    const int base = c.base.rigid() ? ChainL::ground : add_body();
    if (base != ChainL::ground) add_chain({c.base}, ChainL::ground, base, nullptr);
    const int platform = add_body();
    for (const PlacedLeg& leg : c.legs) add_parts(leg, base, platform);
    tool_ = platform;
    if (!c.tool.rigid()) add_chain({c.tool}, platform, tool_ = add_body(), nullptr);
    for (const ChainL& chain : chains_) first_.push_back(equations_), equations_ += 6 + chain.numbers;
    first_body_ = equations_;
    equations_ += 6 * bodies_;
  }

  ShapeTruth solve() {
    State state{std::vector<MotionL>(as_size(bodies_)), {}, {}};
    for (const ChainL& chain : chains_) {
      state.wrenches.push_back(Vector6L::Zero());
      state.numbers.push_back(VectorL::Zero(chain.numbers));
    }
    ShapeTruth out;
    // Laws that are not linear have kinks at rest, across which fine differences change signs.
    const Factor at_rest = straight_ ? factor(matrix(state, 0, 0, 1e-9L, Differences::fine))
                                     : factor(matrix(state, 0, 0, 1e-3L, Differences::coarse));
    sign_ = at_rest.sign;
    out.regular = at_rest.regular();
    out.at_rest = compliance(state, at_rest);
    if (misfits_ && !settle(state, 0, 1, out)) return out;
    State rest = state;
    follow(state, out);
    if (out.found && out.stable) refine(rest, state, out);
    if (out.found) {
      if (out.regular) held_ = 0;  // where much is held by much else, it would count
      out.compliance = compliance(state, factor(matrix(state, 1, 1, held_, Differences::fine)));
    }
    return out;
  }

 private:
  int add_body() { return bodies_++; }

  void add_chain(const std::vector<PlacedPart>& parts, int start, int end, const Vector6* misfit) {
    ChainL chain{start, end, {}, 0};
    for (const PlacedPart& part : parts) {
      kept_.push_back(std::make_unique<PlacedPart>(part));
      chain.add(*kept_.back(), p_T_, shear_);
      if (const auto* joint = std::get_if<PlacedJoint>(&part))
        for (const auto& laws : joint->laws)
          straight_ = straight_ && std::all_of(laws.begin(), laws.end(), [](const Law& law) { return is_linear(law); });
    }
    if (misfit && !misfit->isZero(0)) chain.parts.emplace_back(SeatL{misfit->cast<Long>()}), misfits_ = true;
    chains_.push_back(std::move(chain));
  }

  void add_parts(const PlacedLeg& leg, int start, int end) {
    std::vector<PlacedPart> passed;
    int from = start;
    for (const PlacedPart& part : leg.parts) {
      const auto* group = std::get_if<PlacedParallel>(&part);
      if (!group) {
        passed.push_back(part);
        continue;
      }
      const int near = passed.empty() ? from : add_body(), far = add_body();
      if (!passed.empty()) add_chain(passed, from, near, nullptr);
      for (const PlacedLeg& branch : group->branches) add_parts(branch, near, far);
      passed.clear();
      from = far;
    }
    add_chain(passed, from, end, &leg.misfit);
  }

  const MotionL& tool(const State& s) const { return s.bodies[as_size(tool_)]; }
  MotionL body(const State& s, int i) const { return i == ChainL::ground ? MotionL{} : s.bodies[as_size(i)]; }

  WrenchL wrench(const Vector6L& w) const {
    return {scale_.force * w.head<3>(), scale_.force * scale_.length * w.tail<3>(), p_T_};
  }

  ChainLeft left(const State& s, std::size_t c, Long misfit) const {
    return left_of(chains_[c], body(s, chains_[c].start), body(s, chains_[c].end), wrench(s.wrenches[c]), s.numbers[c],
                   misfit, scale_);
  }

  Long unit(const ChainL& chain, Eigen::Index number) const {
    for (const auto& part : chain.parts)
      if (const auto* j = std::get_if<JointL>(&part)) {
        if (number < std::ssize(j->numbers))
          return scale_.move * (nth(j->numbers, number).freedom < 3 ? scale_.length : 1);
        number -= std::ssize(j->numbers);
      }
    return 1;
  }

  /// Moves unknown k by x, scaled.
  void move(State& s, Eigen::Index k, Long x) const {
    if (k >= first_body_) {
      MotionL& at = s.bodies[as_size((k - first_body_) / 6)];
      const Eigen::Index i = (k - first_body_) % 6;
      if (i < 3)
        at.u(i) += x * scale_.move * scale_.length;
      else
        at.R = rotation_by(x * scale_.move * Vector3L::Unit(i - 3)) * at.R;
      return;
    }
    const auto c = static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), k) - first_.begin() - 1);
    const Eigen::Index i = k - first_[c];
    if (i < 6)
      s.wrenches[c](i) += x;
    else
      s.numbers[c](i - 6) += x * unit(chains_[c], i - 6);
  }

  void move_all(State& s, const VectorL& x) const {
    for (Eigen::Index k = 0; k < first_body_; ++k) move(s, k, x(k));
    for (Eigen::Index b = 0; b < bodies_; ++b) {
      MotionL& at = s.bodies[as_size(b)];
      at.u += scale_.move * scale_.length * x.segment<3>(first_body_ + 6 * b);
      at.R = rotation_by(scale_.move * x.segment<3>(first_body_ + 6 * b + 3)) * at.R;
    }
  }

  /// The dead wrench at T where it stands, about where it was drawn.
  Vector6L outer(const State& s, const Vector6L& at_T) const {
    Vector6L w = at_T;
    w.tail<3>() += tool(s).u.cross(Vector3L(at_T.head<3>()));
    w.head<3>() /= scale_.force, w.tail<3>() /= scale_.force * scale_.length;
    return w;
  }

  VectorL balance(const State& s, Long share) const {
    VectorL out = VectorL::Zero(6 * bodies_);
    out.segment<6>(6 * tool_) = outer(s, share * load_);
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      if (chains_[c].end != ChainL::ground) out.segment<6>(6 * chains_[c].end) -= s.wrenches[c];
      if (chains_[c].start != ChainL::ground) out.segment<6>(6 * chains_[c].start) += s.wrenches[c];
    }
    return out;
  }

  VectorL residual(const State& s, Long share, Long misfit) const {
    VectorL out(equations_);
    for (std::size_t c = 0; c < chains_.size(); ++c)
      out.segment(first_[c], 6 + chains_[c].numbers) = left(s, c, misfit).left;
    out.tail(6 * bodies_) = balance(s, share);
    return out;
  }

  /// Newton's method bears coarse ones. A stiffness is compared: where one chain, which others hold, would turn by
  /// hundreds of radians under the load alone, a difference over 1e-5 of it is off by 1e-3 or more.
  enum class Differences { coarse, fine };

  /// By differences, chain by chain; slopes of laws at least `floor`.
  MatrixL matrix(const State& s, Long share, Long misfit, Long floor, Differences d) const {
    MatrixL J = MatrixL::Zero(equations_, equations_);
    for (std::size_t c = 0; c < chains_.size(); ++c) fill_chain(J, s, c, misfit, floor, d);
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      const Matrix6 one = Matrix6::Identity();
      if (const int e = chains_[c].end; e != ChainL::ground) {
        J.block<6, 6>(first_body_ + 6 * e, first_[c]) -= one.cast<Long>();
        J.block<6, 6>(first_[c], first_body_ + 6 * e) -= one.cast<Long>();
      }
      if (const int b = chains_[c].start; b != ChainL::ground)
        J.block<6, 6>(first_body_ + 6 * b, first_[c]) += one.cast<Long>();
    }
    const Vector3L f = share * load_.head<3>() / scale_.force;
    J.block<3, 3>(first_body_ + 6 * tool_ + 3, first_body_ + 6 * tool_) -= scale_.move * cross_matrix(f);
    return J;
  }

  void fill_chain(MatrixL& J, const State& s, std::size_t c, Long misfit, Long floor, Differences differences) const {
    const bool fine = differences == Differences::fine;
    const Long h = fine ? 1e-6L : 1e-5L;
    const Eigen::Index first = first_[c], rows = 6 + chains_[c].numbers;
    State moved = s;
    const auto column = [&](Eigen::Index k) {
      const State before = {{}, {moved.wrenches[c]}, {moved.numbers[c]}};
      const int b = k >= first_body_ ? static_cast<int>((k - first_body_) / 6) : 0;
      const MotionL motion = moved.bodies[as_size(b)];
      const auto at = [&](Long x) {
        move(moved, k, x);
        const VectorL out = left(moved, c, misfit).left;
        moved.wrenches[c] = before.wrenches[0], moved.numbers[c] = before.numbers[0], moved.bodies[as_size(b)] = motion;
        return out;
      };
      VectorL slope = (at(h) - at(-h)) / (2 * h);
      if (fine) slope = (4 * slope - (at(2 * h) - at(-2 * h)) / (4 * h)) / 3;
      J.block(first, k, rows, 1) = slope;
    };
    for (Eigen::Index k = first; k < first + rows; ++k) column(k);
    if (chains_[c].start != ChainL::ground)
      for (Eigen::Index i = 0; i < 6; ++i) column(first_body_ + 6 * chains_[c].start + i);
    for (Eigen::Index i = 0; i < 6; ++i) J(first + i, first + i) += held_;
    const VectorL slopes = left(s, c, misfit).slopes;
    for (Eigen::Index i = 0; i < chains_[c].numbers; ++i) {
      const Long slope = slopes(i) * unit(chains_[c], i);
      if (slope < floor) J(first + 6 + i, first + 6 + i) -= floor - slope;
    }
  }

  struct Factor {
    Eigen::PartialPivLU<MatrixL> lu;
    VectorL rows;
    int sign = 1;
    bool regular() const {
      const VectorL pivots = lu.matrixLU().diagonal().cwiseAbs();
      return pivots.minCoeff() > 1e-7L * pivots.maxCoeff();
    }
    VectorL solve(const VectorL& r) const { return lu.solve(VectorL(rows.cwiseProduct(r))); }
  };
  static Factor factor(const MatrixL& J) {
    Factor out;
    out.rows = J.cwiseAbs().rowwise().maxCoeff().cwiseMax(1e-300L).cwiseInverse();
    out.lu.compute(out.rows.asDiagonal() * J);
    out.sign = static_cast<int>(out.lu.permutationP().determinant());
    const VectorL diagonal = out.lu.matrixLU().diagonal();
    for (Eigen::Index i = 0; i < diagonal.size(); ++i) out.sign *= diagonal(i) < 0 ? -1 : 1;
    return out;
  }

  /// Newton's method from the state as it is; the matrix serves while the steps fall by it.
  bool settle(State& state, Long share, Long misfit, ShapeTruth& out) {
    State s = state;
    std::optional<Factor> f;
    Long before = 0;
    int made = 0;
    for (int i = 0; i < 100 && left_to_make_ > 0; ++i) {
      const Long floor = straight_ || made > 10 ? 1e-9L : made > 5 ? 1e-6L : 1e-3L;
      const bool fresh = !f;
      if (fresh) f = factor(matrix(s, share, misfit, floor, Differences::coarse)), ++made, --left_to_make_;
      const VectorL step = -f->solve(residual(s, share, misfit));
      const Long size = step.cwiseAbs().maxCoeff();
      if (!(size < 1e6L)) return false;
      move_all(s, step);
      if (!straight_ || (!fresh && size > 0.1L * before)) f.reset();
      before = size;
      if (size > 1e-11L) continue;
      state = std::move(s);
      if (sign_ != factor(matrix(state, share, misfit, 1e-9L, Differences::coarse)).sign) out.stable = false;
      return true;
    }
    return false;
  }

  void follow(State& state, ShapeTruth& out) {
    Long reached = 0, step = straight_ ? 0.5L : 0.25L;
    while (reached < 1) {
      const Long next = std::min(Long(1), reached + step);
      if (settle(state, next, 1, out)) {
        reached = next;
        out.carried = static_cast<double>(reached);
        if (!out.stable) return;
      } else if ((step /= 2) < 1e-3L) {
        return;
      }
    }
    out.found = true;
  }

  void refine(State& rest, State& state, ShapeTruth& out) {
    constexpr int most = 64;
    Vector6 before = between(rest, state);
    while (out.found) {
      scale_.steps *= 2;
      left_to_make_ = std::max(left_to_make_, 4);
      out.found = scale_.steps <= most && (!misfits_ || settle(rest, 0, 1, out)) && settle(state, 1, 1, out);
      out.displacement = between(rest, state);
      Vector6 w = Vector6::Ones();
      w.tail<3>().setConstant(static_cast<double>(scale_.length));
      out.left = w.cwiseProduct(out.displacement - before).norm() / w.cwiseProduct(before).norm();
      if (out.left < 1e-7) return;
      before = out.displacement;
    }
  }

  Vector6 between(const State& rest, const State& state) const {
    const MotionL &a = tool(rest), &b = tool(state);
    Vector6 out;
    out << (b.u - a.u).cast<double>(), vector_of(b.R * a.R.transpose()).cast<double>();
    return out;
  }

  Matrix6 compliance(const State& s, const Factor& f) const {
    Matrix6 out;
    for (Eigen::Index i = 0; i < 6; ++i) {
      VectorL more = VectorL::Zero(equations_);
      more.segment<6>(first_body_ + 6 * tool_) = outer(s, Vector6L::Unit(i));
      const Vector6L d = -f.solve(more).segment<6>(first_body_ + 6 * tool_);
      out.col(i) << (scale_.move * scale_.length * d.head<3>()).cast<double>(),
          (scale_.move * d.tail<3>()).cast<double>();
    }
    return out;
  }

  Vector3L p_T_;
  Shear shear_;
  Vector6L load_;
  Long held_ = 1e-9L;  ///< compliance of chains in the matrix
  ShapeScale scale_;
  int bodies_ = 0, tool_ = 0, sign_ = 0, left_to_make_ = 40;
  bool misfits_ = false, straight_ = true;
  std::vector<std::unique_ptr<PlacedPart>> kept_;
  std::vector<ChainL> chains_;
  std::vector<Eigen::Index> first_;
  Eigen::Index first_body_ = 0, equations_ = 0;
};

}  // namespace

ShapeTruth solve_in_shape(const Configuration& c, const Vector6& F, double size, Shear shear) {
  return ShapeMethod(c, F, size, shear).solve();
}

}  // namespace deflect::attack
