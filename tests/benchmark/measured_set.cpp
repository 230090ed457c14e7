#include "tests/benchmark/measured_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/benchmark/as_measured.h"
#include "tests/benchmark/laws.h"
#include "validation/effects/effect_file.h"

namespace deflect::benchmark {
namespace {

using namespace compare;
using namespace diagnosis;
using namespace effects;
using namespace measurement;
using namespace prediction;
using namespace statistics;

constexpr double most_alike = 0.9;  // cosine of the effects of a pair

class Maker {
 public:
  Maker(const Case& c, const Mechanism& device, const std::vector<Effect>& effects, const Plan& plan)
      : case_(c), effects_(effects), plan_(plan), random_(c.seed + 5) {
    out_.plan = &plan;
    out_.machine = device;
    out_.known = effects;
  }

  MeasuredSet make() {
    if (case_.group == "one" || case_.group == "left-out") hide_one();
    if (case_.group == "tie") hide_tied();
    if (case_.group == "pair") hide_pair();
    if (!out_.skipped.empty()) return std::move(out_);
    const std::optional<Stress> stress = case_.group == "stress" ? std::optional(case_.stress) : std::nullopt;
    if (std::optional<Measurements> data = as_measured(plan_, out_.machine, stress, case_.seed))
      out_.data = std::move(*data);
    else
      out_.skipped = "the MSA finds no equilibrium";
    if (case_.group == "law" && out_.skipped.empty()) add_law();
    return std::move(out_);
  }

 private:
  void hide(const Hidden& h) {
    out_.hidden.push_back(h.effect);
    out_.truth.effects.push_back(h.effect.effect->name);
    out_.machine = with_effect(out_.machine, h.effect);
    out_.lambda = std::hypot(out_.lambda, h.lambda());
  }

  void compare_with_others(const Hidden& h) {
    const Nearest nearest = nearest_entry(plan_, h);
    out_.truth.tied = nearest.tie() ? nearest.entry : "";
    out_.separation = nearest.separation;
  }

  void hide_one() {
    const Effect& e = find_effect(effects_, case_.effect);
    const std::optional<Hidden> h = hidden_effect(plan_, e, case_.lambda, random_);
    if (!h) {
      out_.skipped = fmt::format("{} does not reach λ = {} within its bounds on this plan", e.name, case_.lambda);
      return;
    }
    hide(*h);
    if (case_.group == "one") {
      compare_with_others(*h);
    } else {
      out_.truth.unknown = true;
      out_.lambda_left = beyond_catalogue(plan_, h->change, &e).norm();
      std::erase_if(out_.known, [&](const Effect& known) { return known.name == e.name; });
    }
  }

  /// The next entry, from the case's place in its group on, that has a partner on this plan.
  void hide_tied() {
    const std::size_t n = entries().size(), first = static_cast<std::size_t>(case_.index) * 3 % n;
    for (std::size_t i = 0; i < n; ++i) {
      const Effect& e = find_effect(effects_, entries()[(first + i) % n]);
      const std::optional<Hidden> h = hidden_effect(plan_, e, case_.lambda, random_);
      if (!h) continue;
      compare_with_others(*h);
      if (out_.truth.tied.empty()) continue;
      hide(*h);
      return;
    }
    out_.skipped = "no entry has a partner on this plan";
  }

  /// Two entries drawn by lot, neither with a partner of its own.
  void hide_pair() {
    for (int tries = 0; tries < 50; ++tries) {
      std::vector<Hidden> two;
      while (two.size() < 2) {
        const auto lot = static_cast<std::size_t>(random_.uniform(0, static_cast<double>(entries().size())));
        const std::string& name = entries()[lot];
        if (name == "joint_friction" && case_.campaign != "cycle") continue;
        if (!two.empty() && two.front().effect.effect->name == name) continue;
        const std::optional<Hidden> h = hidden_effect(plan_, find_effect(effects_, name), case_.lambda, random_);
        if (h && !nearest_entry(plan_, *h).tie()) two.push_back(*h);
      }
      if (cosine(two[0], two[1]) >= most_alike) continue;
      out_.separation = std::min(nearest_entry(plan_, two[0]).separation, nearest_entry(plan_, two[1]).separation);
      hide(two[0]);
      hide(two[1]);
      return;
    }
    out_.skipped = "no pair of effects is far enough apart";
  }

  void add_law() {
    const ResidualStudy& study = plan_.observations->comparison().study;
    const std::vector<Vector6> added = added_by(laws()[case_.law], plan_);
    const VectorX change = plan_.observations->uncertainty().whitened(rows_of(study.values, added));
    const double times = case_.lambda / beyond_catalogue(plan_, change).norm();
    for (std::size_t i = 0; i < added.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        *out_.data.readings[i].displacement[k] += times * added[i](static_cast<Eigen::Index>(k));
    out_.truth.unknown = true;
    out_.lambda = times * change.norm();
    out_.lambda_left = case_.lambda;
  }

  const Case& case_;
  const std::vector<Effect>& effects_;
  const Plan& plan_;
  Random random_;
  MeasuredSet out_;
};

}  // namespace

MeasuredSet measured_set(const Case& c, const Mechanism& m, const std::vector<Effect>& effects, Plans& plans) {
  return Maker(c, m, effects, plans.at(c.campaign, c.variant)).make();
}

}  // namespace deflect::benchmark
