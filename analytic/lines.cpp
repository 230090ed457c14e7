#include "analytic/lines.h"
#include "msa/base/index.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

namespace deflect::analytic {
namespace {

/// The friction of a branch that is nothing else.
const SteppedLaw* friction_alone(const Chain& branch) {
  if (branch.freedoms.size() != 1 || !branch.members.empty() || !branch.groups.empty()) return nullptr;
  const ElasticFreedom& freedom = branch.freedoms.front();
  if (!freedom.spring.laws.empty() || freedom.stepped.size() != 1 || !branch.fits()) return nullptr;
  const SteppedLaw& law = freedom.stepped.front();
  return std::holds_alternative<FrictionLaw>(law.law) && law.preload == 0 && !law.rotation ? &law : nullptr;
}

/// Laws that jump, if any, whose phase is that of their own force.
bool known_by_force(const Chain& leg) {
  for (const ElasticFreedom& f : leg.freedoms)
    for (const SteppedLaw& law : f.stepped)
      if (!std::holds_alternative<OneSidedLaw>(law.law)) return false;
  return std::none_of(leg.groups.begin(), leg.groups.end(), [](const Group& g) {
    return std::any_of(g.branches.begin(), g.branches.end(), [](const Chain& b) { return b.has_steps(); });
  });
}

/// α with b = α a, where the wrenches lie on one line.
std::optional<double> ratio(const Vector6& a, const Vector6& b, double length) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1 / length);
  const Vector6 u = weight.cwiseProduct(a), v = weight.cwiseProduct(b);
  const double alpha = u.dot(v) / u.squaredNorm();
  if (!((v - alpha * u).norm() <= 1e-12 * v.norm())) return std::nullopt;
  return alpha;
}

/// What the leg of a line carries, and the friction beside it.
struct Shared {
  double leg = 0, friction = 0, slip = 0;
  bool sticks = true;
};

/// `moves`: the friction's motion by the leg's force. Where it sticks the leg's force is the unknown, so that it keeps
/// its digits beside a stiff friction: δ(x) − slip = (λ − x)/(β k).
template <class Moves>
Shared share(const FrictionLaw& law, double slip, double lambda, double beta, const Moves& moves) {
  const double k = law.stiffness, F = law.force;
  double size = 0;
  const auto excess = [&](double x) {
    const double delta = moves(x), f_k = (lambda - x) / (beta * k);
    size = std::max({std::abs(delta), std::abs(f_k), std::abs(slip)});
    return delta - slip - f_k;
  };
  const auto slides = [&](double f) {
    const double x = lambda - beta * f;
    return Shared{x, f, moves(x) - f / k, false};
  };
  const double high_f = excess(lambda - beta * F), low_f = excess(lambda + beta * F);
  if (high_f >= 0) return slides(F);
  if (low_f <= 0) return slides(-F);
  const double fall = (low_f - high_f) / (2 * beta * F);
  double x = lambda - beta * F - high_f / fall;
  for (int refined = 0; refined < 2; ++refined) x -= excess(x) / fall;  // exact where the leg is linear
  if (const double at = excess(x); std::abs(at) > 8 * std::numeric_limits<double>::epsilon() * size) {
    double low = lambda - std::abs(beta) * F, high = lambda + std::abs(beta) * F;
    double at_low = beta > 0 ? high_f : low_f, at_high = beta > 0 ? low_f : high_f;
    if (low < x && x < high)
      ((at > 0) == (at_low > 0) ? low : high) = x, ((at > 0) == (at_low > 0) ? at_low : at_high) = at;
    std::uintmax_t most = 100;
    const auto root = boost::math::tools::toms748_solve(excess, low, high, at_low, at_high,
                                                        boost::math::tools::eps_tolerance<double>(52), most);
    x = (root.first + root.second) / 2;
  }
  return {x, (lambda - x) / beta, slip, true};
}

Step& step_at(std::vector<Step>& steps, int number) {
  const auto n = as_size(number);
  if (steps.size() <= n) steps.resize(n + 1);
  return steps[n];
}

}  // namespace

std::optional<Lines> Lines::of(const Group& g) {
  Lines out;
  std::vector<std::size_t> besides;
  MatrixX D(g.R.cols(), 0);
  for (std::size_t i = 0; i < g.branches.size(); ++i) {
    const Chain& branch = g.branches[i];
    if (branch.N.cols() != 1) return std::nullopt;
    if (friction_alone(branch)) {
      besides.push_back(i);
      continue;
    }
    if (!known_by_force(branch)) return std::nullopt;
    out.lines_.push_back({i, std::nullopt});
    D.conservativeResize(Eigen::NoChange, D.cols() + 1);
    D.rightCols<1>() = g.R.transpose() * branch.N;
  }
  if (besides.empty() || D.cols() == 0 || D.cols() != D.rows()) return std::nullopt;
  out.statics_.compute(D);
  if (!(reciprocal_condition(out.statics_) > 1e-6)) return std::nullopt;
  for (const std::size_t i : besides) {
    const Chain& branch = g.branches[i];
    const SteppedLaw& law = *friction_alone(branch);
    const double c = branch.freedoms.front().twist.dot(branch.N.col(0));
    const auto line = std::find_if(out.lines_.begin(), out.lines_.end(), [&](const Line& l) {
      return !l.friction && ratio(g.branches[l.leg].N.col(0), branch.N.col(0), g.length);
    });
    if (line == out.lines_.end() || c == 0) return std::nullopt;
    const double alpha = *ratio(g.branches[line->leg].N.col(0), branch.N.col(0), g.length);
    line->friction = {i, alpha / c, std::get<FrictionLaw>(law.law), law.number};
  }
  return out;
}

std::optional<Lines::Answer> Lines::solve(const Group& g, const Vector6& F, const std::vector<double>& slips,
                                          const ChainConditions& c) const {
  Answer out;
  Group::State& s = out.state;
  s.iterations = 1;
  s.converged = true;
  s.wrenches.assign(g.branches.size(), Vector6::Zero());
  const VectorX lambda = statics_.solve(g.R.transpose() * F);
  VectorX e(lambda.size());
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const auto at = as_index(i);
    const Chain& leg = g.branches[line.leg];
    const Vector6 w = leg.N.col(0);
    const auto lengthens = [&](double force) { return w.dot(leg.deflection(w * force, c)); };
    double own = lambda(at);
    if (line.friction) {
      const Beside& b = *line.friction;
      const auto number = as_size(std::max(b.law.number, 0));
      const double slip = number < slips.size() ? slips[number] : 0;
      const Shared shared = share(b.law, slip, own, b.beta, [&](double x) { return b.beta * lengthens(x); });
      own = shared.leg;
      s.wrenches[b.branch] = w * (b.beta * shared.friction);
      step_at(out.steps, b.step) = shared.sticks ? Step{shared.slip, 1 / b.law.stiffness}
                                                 : Step{shared.slip + shared.friction / b.law.stiffness, 0, true};
      out.slips.resize(std::max(out.slips.size(), number + 1));
      out.slips[number] = shared.slip;
    }
    s.wrenches[line.leg] = w * own;
    const ChainResponse r = leg.respond(s.wrenches[line.leg], 0, c);
    if (r.tangent.N.cols() < 1) return std::nullopt;
    s.converged = s.converged && r.converged;
    e(at) = w.dot(r.d);
    for (const ElasticFreedom& f : leg.freedoms)
      for (const SteppedLaw& law : f.stepped)
        step_at(out.steps, law.number) = law.at_force(f.twist.dot(s.wrenches[line.leg]));
  }
  s.t = g.R * statics_.transpose().solve(e);
  return out;
}

}  // namespace deflect::analytic
