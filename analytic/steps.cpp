#include "analytic/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analytic/deflection.h"
#include "analytic/table.h"
#include "msa/base/index.h"
#include "msa/base/play_alone.h"
#include "msa/base/set_valued_laws.h"
#include "msa/base/settle.h"
#include "msa/mechanism/table.h"

namespace deflect::analytic {
namespace {

enum class Phase { start, plus, minus, open, sticks, bends };  // of one-sided laws, plus pulls and minus pushes

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double no_force = 1e-11;   // of the largest
constexpr double idle_share = 1e-9;  // of LinearRelation::size

double sign(double f) { return f > 0 ? 1 : f < 0 ? -1 : 0; }

/// A law in a phase.
struct Member {
  const SteppedLaw* stepped;
  double slip = 0;
  Phase phase = Phase::start;
  double imposed = 0;  // offset while released
  double force = 0;    // of a law that bends
  double limit = 0;    // of a friction

  const Law& law() const { return stepped->law; }
  bool released() const {
    return phase == Phase::open || (std::holds_alternative<FrictionLaw>(law()) && phase != Phase::sticks);
  }
  Step step() const {
    if (released()) return {imposed, 0, true};
    const double P = stepped->preload;
    if (phase == Phase::bends) {
      const double d = analytic::deflection(law(), force + P) - at_rest(law(), P);
      const double c = analytic::compliance(law(), force + P);
      const double stored = remembers(law()) ? analytic::stored_energy(law(), force) : 0;
      return std::isfinite(c) ? Step{d - c * force, c, false, stored} : Step{d, 0, true};
    }
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
};

/// A law that bends, without load: some have no stiffness then.
bool lets_go(const Member& m, double no_load) {
  const double own = m.force + m.stepped->preload;
  return std::abs(own) <= no_load && !std::isfinite(analytic::compliance(m.law(), 0));
}

/// Whether it bends: its force follows from its deflection.
bool bends(const Law& law) { return !deflect::jumps(law) || remembers(law); }

Phase phase_at_rest(const Law& law) {
  if (bends(law)) return Phase::bends;
  return std::holds_alternative<FrictionLaw>(law) ? Phase::sticks : Phase::plus;
}

class Balance {
 public:
  Balance(const std::vector<SteppedLaw>& laws, const std::vector<double>& slips, const AskSteps& ask, Imposed& imposed,
          bool extent)
      : ask_(ask), imposed_(imposed), extent_(extent), n_(std::ssize(laws)), own_laws_(laws) {
    for (SteppedLaw& l : own_laws_) {
      members_.push_back({&l});
      if (auto* table = std::get_if<TableLaw>(&l.law); table && table->remembers())
        for (std::size_t k = 0; k < 2; ++k) {
          const std::size_t n = as_size(table->number) + k;
          table->left[k] = table->number >= 0 && n < slips.size() ? slips[n] : 0;
        }
      if (const auto* friction = std::get_if<FrictionLaw>(&l.law)) {
        const auto n = as_size(friction->number);
        if (friction->number >= 0 && n < slips.size()) members_.back().slip = slips[n];
        members_.back().limit = friction->force;
        if (friction->share > 0 && l.load >= 0) growing_.push_back(std::ssize(members_) - 1);
      }
      laws_.push_back(scalar_law(l.law, l.preload, members_.back().slip, members_.back().limit));
    }
  }

  /// The compliances and what offsets do without load; where both are known, what offsets do in the shape under a load.
  void impose() {
    const bool known = imposed_.S.size() > 0;
    if (!known) stiff();
    linearise(VectorX::Zero(n_), answer(VectorX::Zero(n_)), known ? 1e-7 : 1e3);
  }

  BalancedSteps search() {
    if (imposed_.c.size() == 0) stiff();
    SteppedForces at = answer(VectorX::Zero(n_));
    const bool relaxed = std::all_of(members_.begin(), members_.end(), [](const Member& m) {
      const auto* table = std::get_if<TableLaw>(&m.law());
      return m.slip == 0 && (!table || table->left == std::array<double, 2>{});
    });
    // Without any force only play has an extent to be told.
    const bool floats = extent_ && std::any_of(members_.begin(), members_.end(), [](const Member& m) {
                          return std::holds_alternative<ClearanceLaw>(m.law()) && m.stepped->preload == 0;
                        });
    if (relaxed && at.forces.isZero(0) && at.largest == 0 && !floats) return unloaded();
    if (imposed_.S.size() == 0) linearise(VectorX::Zero(n_), at, 1e3);
    VectorX o = VectorX::Zero(n_), p;
    SetValuedSolution found;
    double before = infinite, least = infinite;
    for (int round = 0, nearest = 0; round < 200 && round < nearest + 25; ++round) {
      found = settled_about(o, at);
      if (found.outcome != SetValuedSolution::Outcome::solved) return failed(found);
      // Where other laws bend, no further than brings the forces nearer, along p = δ + c f, of which every law has one.
      const VectorX target = found.d + imposed_.c.cwiseProduct(found.s);
      VectorX s = found.s;
      o = found.o;
      double lacking = 0;
      for (double part = 1;; part /= 2) {
        at = answer(o);
        const double size = std::max({largest(at.forces), largest(found.s), at.largest});
        const double off = largest(at.forces - s);
        lacking = size > 0 ? off / size : 0;
        const double rounding = 1e-15 * largest(VectorX(o.cwiseQuotient(imposed_.c)));  // of s = (d − o)/c
        if (lacking <= (at.idle > 0 ? 1e-9 : 1e-11) || off <= rounding || (lacking <= 1e-8 && lacking > 0.5 * before))
          return result(found);
        if ((at.converged && lacking < (1 - 1e-4 * part) * before) || part < 1e-4 || p.size() == 0) break;
        for (Eigen::Index i = 0; i < n_; ++i) {
          const double c = imposed_.c(i), here = p(i) + part / 2 * (target(i) - p(i));
          const double d = deflection_at_sum(nth(laws_, i), c, here);
          s(i) = (here - d) / c;
          o(i) = d - c * s(i);
        }
      }
      p = o + 2 * imposed_.c.cwiseProduct(s);
      // Where all other laws are linear, S is right but for rounding, of which small offsets would give it far more. In
      // the deformed shape it is right but for what the shape changes, and every answer is dear.
      const bool told_by_S = lacking < (at.idle > 0 ? 0.2 : 1e-3) * std::min(before, 1.0);
      before = lacking;
      if (lacking < 0.9 * least) least = lacking, nearest = round;
      if (told_by_S) continue;
      own_ = imposed_;
      linearise(o, at, 1e-7);
    }
    BalancedSteps out = result(found);
    out.converged = false;
    out.reason = "the laws that bend (contacts, power laws) were not solved beside those that jump";
    return out;
  }

  /// One round of search(): the laws where they agree with what S makes of these forces at the offsets o.
  BalancedSteps round(const VectorX& o, const SteppedForces& at, double& lacking) {
    const SetValuedSolution found = settled_about(o, at);
    if (found.outcome != SetValuedSolution::Outcome::solved) return failed(found);
    const double size = std::max({largest(at.forces), largest(found.s), at.largest});
    lacking = size > 0 ? largest(at.forces - found.s) / size : 0;
    return result(found);
  }

 private:
  SetValuedSolution settled_about(const VectorX& o, const SteppedForces& at) {
    const VectorX f0 = at.forces + imposed_.S * o;
    const MatrixX P = MatrixX::Identity(n_, n_) - MatrixX(imposed_.c.asDiagonal() * imposed_.S);
    sizes_ = VectorX::Constant(n_, std::max({at.largest, at.idle / idle_share, held_by_slips(at.length)}));
    for (Eigen::Index i = 0; i < n_; ++i)
      if (nth(members_, i).stepped->rotation) sizes_(i) *= at.length;
    const LinearRelation relation{imposed_.c, imposed_.c.cwiseProduct(f0), P, sizes_};
    // A deformed shape pushes some play outwards.
    return settled(at.idle > 0 ? monotone(relation, o, laws_) : relation);
  }

  /// N: what earlier loads have left in frictions. Without a load it is the scale beside which other forces are none.
  double held_by_slips(double length) const {
    double most = 0;
    for (const Member& m : members_)
      if (const auto* friction = std::get_if<FrictionLaw>(&m.law()))
        most = std::max(most, std::abs(m.slip) * friction->stiffness / (m.stepped->rotation ? length : 1));
    return most;
  }

  /// The laws in equilibrium, with limits of frictions that are those of the loads beside them.
  SetValuedSolution settled(const LinearRelation& relation) {
    if (growing_.empty()) return solve_apart(relation, laws_, watched());
    SetValuedSolution found;
    VectorX limits(std::ssize(growing_));
    for (Eigen::Index i = 0; i < limits.size(); ++i) limits(i) = nth(members_, nth(growing_, i)).limit;
    const double rounding = 1e-14 * held_by_slips(1);
    const auto of_loads = [&](const VectorX& tried) -> std::optional<VectorX> {
      VectorX out = tried;
      for (Eigen::Index i = 0; i < tried.size(); ++i) {
        Member& m = nth(members_, nth(growing_, i));
        m.limit = tried(i);
        nth(laws_, nth(growing_, i)) = scalar_law(m.law(), m.stepped->preload, m.slip, m.limit);
      }
      found = solve_apart(relation, laws_, watched());
      if (found.outcome != SetValuedSolution::Outcome::solved) return std::nullopt;
      for (Eigen::Index i = 0; i < tried.size(); ++i) {
        const SteppedLaw& law = *nth(members_, nth(growing_, i)).stepped;
        const auto& friction = std::get<FrictionLaw>(law.law);
        out(i) = friction.force + friction.share * std::abs(found.s(law.load));
      }
      return out;
    };
    if (!settle(limits, of_loads, rounding)) found.outcome = SetValuedSolution::Outcome::undecided;
    return found;
  }

  /// How far T can move in unloaded play is searched for only where it is asked for.
  MatrixX watched() const { return extent_ ? imposed_.T : MatrixX(0, n_); }

  SteppedForces answer(const VectorX& o) const {
    std::vector<Step> steps;
    for (Eigen::Index i = 0; i < n_; ++i) steps.push_back({o(i), imposed_.c(i), false});
    return ask_(steps);
  }

  /// The compliances: first less than all else, then as much as the mechanism itself yields along each law.
  void stiff() {
    imposed_.c = VectorX::Constant(n_, 1e-10);
    const double length = answer(VectorX::Zero(n_)).length;
    for (Eigen::Index i = 0; i < n_; ++i)
      if (nth(members_, i).stepped->rotation) imposed_.c(i) /= length * length;
    // Several frictions side by side hold each other alone: digits are kept by the stiffness with which they stick. In
    // a table a deflection may be left without any force.
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (const auto* friction = std::get_if<FrictionLaw>(&nth(members_, i).law()))
        imposed_.c(i) = std::max(imposed_.c(i), 1 / friction->stiffness);
      if (const auto* table = std::get_if<TableLaw>(&nth(members_, i).law()); table && table->remembers())
        imposed_.c(i) = std::max(imposed_.c(i), table_compliance(identified({table->points}), 0));
    }
    linearise(VectorX::Zero(n_), answer(VectorX::Zero(n_)), 1e3);
    for (Eigen::Index i = 0; i < n_; ++i)
      if (imposed_.S(i, i) * imposed_.c(i) > 1e-12) imposed_.c(i) = 1 / imposed_.S(i, i);
    imposed_.S.resize(0, 0);
  }

  /// Play that moves against forces of second order alone, which small offsets would not show.
  bool floats_freely(Eigen::Index i) const {
    return imposed_.S.size() > 0 && std::isfinite(nth(laws_, i).low) && imposed_.S(i, i) * imposed_.c(i) <= 1e-3;
  }

  /// S and T by offsets that change forces by so much of the largest.
  void linearise(const VectorX& o, const SteppedForces& at, double change) {
    MatrixX S(n_, n_);
    imposed_.T.resize(6, n_);
    const double force = at.largest > 0 ? at.largest : 1;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const bool rotation = nth(members_, i).stepped->rotation;
      VectorX moved = o;
      double h = change * force * (rotation ? at.length : 1) * imposed_.c(i);
      if (floats_freely(i)) h = std::max(h, 0.01 * nth(laws_, i).half);
      moved(i) += h;
      const SteppedForces next = answer(moved);
      S.col(i) = (at.forces - next.forces) / h;
      imposed_.T.col(i) = (next.displacement - at.displacement) / h;
    }
    imposed_.S = S;
  }

  BalancedSteps unloaded() {
    for (Member& m : members_) m.phase = phase_at_rest(m.law());
    for (Member& m : members_)
      if (std::holds_alternative<ClearanceLaw>(m.law()) && m.stepped->preload == 0) m.phase = Phase::open;
    BalancedSteps out = conclude();
    out.offsets = VectorX::Zero(n_);
    return out;
  }

  BalancedSteps result(const SetValuedSolution& found) {
    for (Eigen::Index i = 0; i < n_; ++i) {
      const auto at = as_size(i);
      Member& m = members_[at];
      m.imposed = found.d(i);
      m.force = found.s(i);
      if (std::holds_alternative<ClearanceLaw>(m.law()))
        m.phase = found.end[at] > 0 ? Phase::plus : found.end[at] < 0 ? Phase::minus : Phase::open;
      else if (std::holds_alternative<FrictionLaw>(m.law()))
        m.phase = found.end[at] > 0 ? Phase::plus : found.end[at] < 0 ? Phase::minus : Phase::sticks;
      else if (bends(m.law()))
        m.phase = lets_go(m, no_force * sizes_(i)) ? Phase::open : Phase::bends;
      else
        m.phase = found.s(i) + m.stepped->preload < -no_force * sizes_(i) ? Phase::minus : Phase::plus;
    }
    BalancedSteps out = conclude();
    out.offsets = found.o;
    for (Eigen::Index i = 0; i < n_ && found.loose.cols() > 0; ++i)
      if (found.loose.row(i).cwiseAbs().maxCoeff() > 0) out.loose.push_back(as_size(i));
    out.moves = found.loose.cols() > 0 &&
                (imposed_.T * found.loose).cwiseAbs().maxCoeff() > 1e-6 * found.loose.cwiseAbs().maxCoeff();
    if (extent_) {
      out.twists = imposed_.T * found.loose;
      out.least = found.least, out.most = found.most;
    }
    if (own_) imposed_ = Imposed();  // belongs to this load alone
    return out;
  }

  BalancedSteps conclude() const {
    BalancedSteps out;
    out.converged = true;
    for (const Member& m : members_) {
      out.steps.push_back(m.step());
      if (const auto* table = std::get_if<TableLaw>(&m.law()); table && table->remembers()) {
        const auto n = as_size(std::max(table->number, 0));
        out.slips.resize(std::max(out.slips.size(), n + 2));
        const std::array<double, 2> left = table_left(*table, m.force);
        std::copy(left.begin(), left.end(), out.slips.begin() + as_index(n));
      }
      const auto* friction = std::get_if<FrictionLaw>(&m.law());
      if (!friction) continue;
      const auto n = as_size(std::max(friction->number, 0));
      out.slips.resize(std::max(out.slips.size(), n + 1));
      const double known = (m.phase == Phase::plus ? m.limit : -m.limit) - m.stepped->preload;
      out.slips[n] = m.released() ? m.imposed - known / friction->stiffness : m.slip;
    }
    return out;
  }

  /// Why there is no equilibrium.
  BalancedSteps failed(const SetValuedSolution& found) {
    for (Member& m : members_) m.phase = phase_at_rest(m.law());
    BalancedSteps out = conclude();
    out.converged = false;
    out.reason = "no state of the clearances and frictions was found that agrees with itself";
    if (found.outcome == SetValuedSolution::Outcome::no_fit)
      out.reason = "the parts cannot be assembled: their misfits are larger than the play, and nothing yields";
    for (Eigen::Index i = 0; i < found.along.size(); ++i)
      if (std::holds_alternative<FrictionLaw>(nth(members_, i).law()) &&
          std::abs(found.along(i)) > 1e-3 * largest(found.along))
        out.reason = fmt::format("a friction slips at {:.6g} {} and nothing else holds what it lets go",
                                 nth(members_, i).limit, nth(members_, i).stepped->rotation ? "Nm" : "N");
    if (own_) imposed_ = Imposed();
    return out;
  }

  const AskSteps& ask_;
  Imposed& imposed_;
  bool extent_;
  std::optional<Imposed> own_;  // where S belongs to a load
  Eigen::Index n_;
  std::vector<SteppedLaw> own_laws_;  // tables with what is left in them
  std::vector<Member> members_;
  std::vector<ScalarLaw> laws_;
  std::vector<std::ptrdiff_t> growing_;  // frictions whose limit grows with a load
  VectorX sizes_;                        // of forces, by law
};

}  // namespace

Step SteppedLaw::at_force(double f) const {
  Member m{this};
  m.force = f;
  m.phase = bends(law)                                 ? Phase::bends
            : std::holds_alternative<FrictionLaw>(law) ? Phase::sticks
            : f + preload < 0                          ? Phase::minus
                                                       : Phase::plus;
  if (std::holds_alternative<ClearanceLaw>(law) && f + preload == 0) m.phase = Phase::start;
  return m.step();
}

double SteppedLaw::stored_energy(double f, const Step& s) const {
  const double own = f + preload, d = s.offset + s.compliance * f;
  if (remembers(law)) return s.stored;
  if (!deflect::jumps(law))
    return analytic::stored_energy(law, own) - analytic::stored_energy(law, preload) - preload * d;
  if (const auto* l = std::get_if<FrictionLaw>(&law)) return own * own / (2 * l->stiffness);
  const auto* l = std::get_if<OneSidedLaw>(&law);
  const auto stored = [&](double force) { return l ? compliance(*l, force) * force * force / 2 : 0; };
  return stored(own) - stored(preload) - preload * d;
}

Imposed imposed_on(const std::vector<SteppedLaw>& laws, const AskSteps& ask, Imposed unloaded) {
  Balance(laws, {}, ask, unloaded, false).impose();
  return unloaded;
}

BalancedSteps balance(const std::vector<SteppedLaw>& laws, const std::vector<double>& slips, const AskSteps& ask,
                      Imposed& imposed, bool extent) {
  return Balance(laws, slips, ask, imposed, extent).search();
}

BalancedSteps balance_about(const VectorX& offsets, const SteppedForces& at, const std::vector<SteppedLaw>& laws,
                            const std::vector<double>& slips, Imposed& imposed, double& lacking) {
  const AskSteps nobody;
  return Balance(laws, slips, nobody, imposed, false).round(offsets, at, lacking);
}

}  // namespace deflect::analytic
