#include "analytic/steps.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace deflect::analytic {
namespace {

enum class Phase { start, plus, minus, open, sticks };  // of one-sided laws, plus pulls and minus pushes

// Of the largest force: a law that carries less is not loaded. Signs and limits are judged to a hundredth of it.
constexpr double unloaded = 1e-9, tolerance = 1e-11;

double sign(double f) { return f > 0 ? 1 : f < 0 ? -1 : 0; }

double compliance(const OneSidedLaw& l, double f) { return (f < 0 ? l.push : l.pull).value_or(0); }

/// A law with its phase, in terms of the transmitted force f.
struct Member {
  const SteppedLaw* stepped;
  double slip = 0;
  Phase phase = Phase::start;
  double imposed = 0;  // offset while released
  int flips = 0;       // of a clearance, from side to side
  bool idle = false;   // open since it was never loaded: it stays in the middle if nothing asks for more

  const Law& law() const { return stepped->law; }
  bool released() const {
    return phase == Phase::open || (std::holds_alternative<FrictionLaw>(law()) && phase != Phase::sticks);
  }
  double known_force() const {
    const auto* friction = std::get_if<FrictionLaw>(&law());
    const double own = !friction ? 0 : phase == Phase::plus ? friction->force : -friction->force;
    return own - stepped->preload;
  }
  Step step() const {
    if (released()) return {imposed, 0, true, phase == Phase::open && !idle && stepped->preload == 0};
    const double P = stepped->preload;
    if (const auto* l = std::get_if<OneSidedLaw>(&law())) {
      const double c = compliance(*l, phase == Phase::minus ? -1 : 1);
      return {c * P - compliance(*l, P) * P, c, false};
    }
    if (const auto* l = std::get_if<ClearanceLaw>(&law())) {
      const double at = phase == Phase::plus ? l->gap : phase == Phase::minus ? -l->gap : 0;
      return {at - l->gap * sign(P), 0, false};
    }
    return {slip, 1 / std::get<FrictionLaw>(law()).stiffness, false};
  }

  /// The phase that the force (and the offset, of a released law) speaks for; `stuck`: no offset changes the force.
  Phase judged(double f, double scale, bool stuck) const {
    const double own = f + stepped->preload, little = tolerance * scale;
    if (std::holds_alternative<OneSidedLaw>(law())) {
      if (phase == Phase::plus) return own < -little ? Phase::minus : phase;
      if (phase == Phase::minus) return own > little ? Phase::plus : phase;
      return own < 0 ? Phase::minus : Phase::plus;
    }
    if (const auto* l = std::get_if<ClearanceLaw>(&law())) {
      const Phase closed = own > 0 ? Phase::plus : Phase::minus;
      const bool loaded = std::abs(own) > unloaded * scale;
      if (phase == Phase::start) return loaded ? closed : Phase::open;
      if (phase != Phase::open) {
        if (own * (phase == Phase::plus ? 1 : -1) > -little) return phase;
        return flips < 3 ? closed : Phase::open;  // across at first, into the middle where that does not settle
      }
      if (stuck) return loaded ? closed : phase;
      const double at = imposed + l->gap * sign(stepped->preload);
      return at > l->gap ? Phase::plus : at < -l->gap ? Phase::minus : phase;
    }
    const auto& l = std::get<FrictionLaw>(law());
    if (phase == Phase::sticks || phase == Phase::start)
      return own > l.force + little ? Phase::plus : own < -l.force - little ? Phase::minus : Phase::sticks;
    if (stuck) return Phase::sticks;
    const double moved = imposed - known_force() / l.stiffness - slip, least = tolerance * std::abs(imposed);
    return phase == Phase::plus ? (moved < -least ? Phase::sticks : phase) : moved > least ? Phase::sticks : phase;
  }
};

class Balance {
 public:
  Balance(const std::vector<SteppedLaw>& laws, const std::vector<double>& slips,
          const std::function<SteppedForces(const std::vector<Step>&)>& ask)
      : ask_(ask) {
    for (const SteppedLaw& l : laws) {
      members_.push_back({&l});
      if (const auto* friction = std::get_if<FrictionLaw>(&l.law)) {
        const auto n = static_cast<std::size_t>(friction->number);
        if (friction->number >= 0 && n < slips.size()) members_.back().slip = slips[n];
        members_.back().phase = Phase::sticks;
      }
    }
  }

  BalancedSteps search() {
    const std::size_t n = members_.size(), together = 5 + n, rounds = 50 + 20 * n;
    for (std::size_t round = 0; round < rounds; ++round) {
      release();
      if (answer_.forces.isZero(0) && answer_.largest == 0) return result("");
      const bool one_by_one = round >= together;
      const std::size_t first = one_by_one ? 7 * round % n : 0;
      bool changed = close_pushed(first, one_by_one);
      const bool closed = changed;
      for (std::size_t k = 0; k < n && !(changed && one_by_one); ++k) {
        const std::size_t i = (first + k) % n;
        Member& m = members_[i];
        const Phase next = m.judged(force(i), scale(i), stuck_[i]);
        if (next == m.phase || (closed && stuck_[i])) continue;
        // Where an offset begins: at the side that opens, at the slip so far.
        const Step now = m.step();
        m.imposed = m.phase == Phase::start ? 0 : now.offset + now.compliance * force(i);
        if (m.phase != Phase::start && next != Phase::open) ++m.flips;
        m.idle = m.phase == Phase::start && next == Phase::open;
        m.phase = next;
        changed = true;
      }
      if (!changed) return result(answer_.converged ? overcome() : "the laws between the jumps were not solved");
    }
    if (const std::string reason = overcome(); !reason.empty()) return result(reason);
    return result(
        fmt::format("no state of the clearances and frictions was found that agrees with itself in {} rounds", rounds));
  }

 private:
  double force(std::size_t i) const { return answer_.forces(static_cast<Eigen::Index>(i)); }
  double scale(std::size_t i) const { return answer_.largest * (members_[i].stepped->rotation ? answer_.length : 1); }

  std::vector<Step> steps() const {
    std::vector<Step> out;
    for (const Member& m : members_) out.push_back(m.step());
    return out;
  }

  BalancedSteps result(const std::string& reason) const {
    BalancedSteps out{steps(), {}, reason.empty(), reason};
    for (std::size_t i = 0; i < members_.size(); ++i)
      if (const auto* friction = std::get_if<FrictionLaw>(&members_[i].law())) {
        const auto n = static_cast<std::size_t>(std::max(friction->number, 0));
        out.slips.resize(std::max(out.slips.size(), n + 1));
        const Member& m = members_[i];
        out.slips[n] = m.released() ? m.imposed - m.known_force() / friction->stiffness : m.slip;
      }
    return out;
  }

  /// A friction that would have to carry more than it can, whatever it slides.
  std::string overcome() const {
    for (std::size_t i = 0; i < members_.size(); ++i)
      if (const auto* l = std::get_if<FrictionLaw>(&members_[i].law()))
        if (std::abs(force(i)) > l->force + unloaded * scale(i))
          return fmt::format("equilibrium wants {:.6g} N of a friction that slips at {:.6g} N", std::abs(force(i)),
                             l->force);
    return "";
  }

  /// How the released forces fall with their offsets, by differences that change forces by a thousandth of the largest.
  MatrixX falls(const std::vector<std::size_t>& free, std::vector<double>& change) {
    const auto n = static_cast<Eigen::Index>(free.size());
    MatrixX S(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::size_t at = free[static_cast<std::size_t>(j)];
      double& h = change[at];
      for (int pass = 0; pass < 4; ++pass) {
        members_[at].imposed += h;
        const SteppedForces beside = ask_(steps());
        const VectorX& moved = beside.forces;
        members_[at].imposed -= h;
        follow_.col(static_cast<Eigen::Index>(at)) = (beside.motions - answer_.motions) / h;
        for (Eigen::Index i = 0; i < n; ++i) {
          const auto k = static_cast<Eigen::Index>(free[static_cast<std::size_t>(i)]);
          S(i, j) = (answer_.forces(k) - moved(k)) / h;
        }
        const double seen = std::abs(S(j, j)) * h, wanted = 1e-3 * scale(at);
        if (seen < 1e-9 * scale(at) || (seen > 0.1 * wanted && seen < 10 * wanted)) break;
        h *= wanted / seen;
      }
    }
    return S;
  }

  /// A friction slides in vain where an open clearance hands it the load: the side that it pushes to closes.
  bool close_pushed(std::size_t first, bool only_one) {
    bool any = false;
    for (std::size_t k = 0; k < members_.size() && !(any && only_one); ++k)
      if (const std::size_t i = (first + k) % members_.size(); pushed_[i] != 0 && members_[i].phase == Phase::open) {
        members_[i].phase = pushed_[i] > 0 ? Phase::plus : Phase::minus;
        any = true;
      }
    return any;
  }

  void ask() {
    answer_ = ask_(steps());
    for (std::size_t i = 0; i < members_.size(); ++i)
      if (const double d = answer_.motions(static_cast<Eigen::Index>(i)); std::isfinite(d)) members_[i].imposed = d;
  }

  /// Solves with the present phases: answer_, the offsets imposed, and whose forces they do not change.
  void release() {
    const std::size_t n = members_.size();
    stuck_.assign(n, 0);
    pushed_.assign(n, 0);
    follow_ = MatrixX::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    ask();
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < n; ++i)
      if (members_[i].released() && !std::isfinite(answer_.motions(static_cast<Eigen::Index>(i)))) free.push_back(i);
    if (free.empty() || answer_.largest == 0) return;
    std::vector<double> change(n, 1e-6);
    MatrixX S = falls(free, change);
    const auto size = static_cast<Eigen::Index>(free.size());
    VectorX weight(size);  // unit diagonal; 0 of those that nothing changes
    for (Eigen::Index j = 0; j < size; ++j) {
      const std::size_t at = free[static_cast<std::size_t>(j)];
      const bool changes = std::abs(S(j, j)) * change[at] > 1e-8 * scale(at);
      stuck_[at] = !changes;
      weight(j) = changes ? 1 / std::sqrt(std::abs(S(j, j))) : 0;
    }
    double before = std::numeric_limits<double>::infinity();
    int idle = 0;
    for (int iteration = 0; iteration < 60; ++iteration) {
      VectorX excess(size);
      double largest = 0;
      for (Eigen::Index j = 0; j < size; ++j) {
        const std::size_t at = free[static_cast<std::size_t>(j)];
        excess(j) = stuck_[at] ? 0 : force(at) - members_[at].known_force();
        largest = std::max(largest, std::abs(excess(j)) / scale(at));
      }
      if (largest <= 1e-15 || (largest < 1e-12 && largest > 0.5 * before)) break;
      if (largest > 0.9 * before && ++idle == 2) break;  // they contradict each other: what stays stuck is told below
      if (iteration > 0 && largest > 0.1 * before) S = falls(free, change);
      before = largest;
      Eigen::JacobiSVD<MatrixX> svd(weight.asDiagonal() * S * weight.asDiagonal(),
                                    Eigen::ComputeThinU | Eigen::ComputeThinV);
      svd.setThreshold(1e-9);
      const VectorX step = weight.cwiseProduct(svd.solve(weight.cwiseProduct(excess)));
      for (Eigen::Index j = 0; j < size; ++j) members_[free[static_cast<std::size_t>(j)]].imposed += step(j);
      ask();
    }
    for (const std::size_t at : free)
      if (std::abs(force(at) - members_[at].known_force()) > unloaded * scale(at)) {
        stuck_[at] = 1;
        const double way = force(at) - members_[at].known_force();
        for (std::size_t i = 0; i < n; ++i)
          if (const double moves = follow_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(at));
              std::isfinite(moves) && std::abs(moves) > 1e-3)
            pushed_[i] = way * moves > 0 ? 1 : -1;
      }
  }

  const std::function<SteppedForces(const std::vector<Step>&)>& ask_;
  std::vector<Member> members_;
  SteppedForces answer_;
  std::vector<char> stuck_;   // no offset brings the force to what is known
  std::vector<char> pushed_;  // open: to which side such a friction would move it
  MatrixX follow_;            // motions of what is open by the offsets of others
};

}  // namespace

Step SteppedLaw::at_force(double f) const {
  Member m{this};
  m.phase = std::holds_alternative<FrictionLaw>(law) ? Phase::sticks : f + preload < 0 ? Phase::minus : Phase::plus;
  if (std::holds_alternative<ClearanceLaw>(law) && f + preload == 0) m.phase = Phase::start;
  return m.step();
}

double SteppedLaw::stored_energy(double f, const Step& s) const {
  const double own = f + preload, d = s.offset + s.compliance * f;
  if (const auto* l = std::get_if<FrictionLaw>(&law)) return own * own / (2 * l->stiffness);
  const auto* l = std::get_if<OneSidedLaw>(&law);
  const auto stored = [&](double force) { return l ? compliance(*l, force) * force * force / 2 : 0; };
  return stored(own) - stored(preload) - preload * d;
}

BalancedSteps balance(const std::vector<SteppedLaw>& laws, const std::vector<double>& slips,
                      const std::function<SteppedForces(const std::vector<Step>&)>& ask) {
  return Balance(laws, slips, ask).search();
}

}  // namespace deflect::analytic
