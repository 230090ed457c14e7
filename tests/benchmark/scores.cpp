#include "tests/benchmark/scores.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace deflect::benchmark {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), recognisable = 6, plain = 12;
constexpr double separable = 9;  // difference of 2 ln L

using Which = std::function<bool(const Record&)>;
using Value = std::function<double(const Record&, std::size_t method)>;

/// Mean of the value over those sets; values that are NaN do not count.
Score mean(const std::vector<Record>& all, std::string name, std::string goal, const Which& which, const Value& value) {
  Score out{std::move(name), std::move(goal), 0, {}};
  for (std::size_t method = 0; method < std::size(method_names); ++method) {
    double sum = 0, count = 0;
    std::size_t sets = 0;
    for (const Record& r : all) {
      if (!r.skipped.empty() || !which(r)) continue;
      ++sets;
      const double v = value(r, method);
      if (!std::isnan(v)) sum += v, ++count;
    }
    out.sets = sets;
    out.values.push_back(count > 0 ? sum / count : nan);
  }
  return out;
}

/// Share of answers, of methods that answer.
template <class Does>
Value answers(const Does& does) {
  return [does](const Record& r, std::size_t method) {
    return method < r.answers.size() ? static_cast<double>(does(r, r.answers[method])) : nan;
  };
}

const auto right = [](const Record& r, const Answer& a) { return judge(r.truth, a) == Outcome::right; };
const auto wrong = [](const Record& r, const Answer& a) { return judge(r.truth, a) == Outcome::wrong; };
const auto alarm = [](const Record& r, const Answer& a) { return judge(r.truth, a) != Outcome::right; };
const auto says_unknown = [](const Record&, const Answer& a) { return a.verdict == "unknown_effect"; };
const auto has_truth = [](const Record& r, const Answer& a) { return holds(reported(a), r.truth.effects.front()); };

bool large(const Record& r) { return r.order.lambda >= 8; }
bool one(const Record& r) { return r.order.group == "one"; }

/// Median over sets of the error at new poses.
Score new_poses(const std::vector<Record>& all, std::string name, std::string goal, const Which& which) {
  Score out{std::move(name), std::move(goal), 0, {}};
  for (std::size_t method = 0; method < std::size(method_names); ++method) {
    std::vector<double> errors;
    for (const Record& r : all)
      if (!r.new_poses.empty() && which(r) && !std::isnan(r.new_poses[method])) errors.push_back(r.new_poses[method]);
    out.sets = std::max(out.sets, errors.size());
    std::sort(errors.begin(), errors.end());
    out.values.push_back(errors.empty() ? nan : errors[errors.size() / 2]);
  }
  return out;
}

Score coverage(const std::vector<Record>& all) {
  Score out{"95 % intervals that hold the truth", ".93–.97", 0, std::vector<double>(std::size(method_names), nan)};
  int intervals = 0, covering = 0;
  for (const Record& r : all) {
    out.sets += r.intervals > 0;
    intervals += r.intervals;
    covering += r.covering;
  }
  if (intervals > 0) out.values[0] = static_cast<double>(covering) / intervals;
  return out;
}

}  // namespace

std::vector<Score> scores(const std::vector<Record>& all) {
  std::vector<Score> out;
  const auto row = [&](const std::string& name, const char* goal, const Which& which, const Value& value) {
    out.push_back(mean(all, name, goal, which, value));
  };
  const auto alone = [](double lambda) {
    return [lambda](const Record& r) { return one(r) && r.truth.tied.empty() && r.order.lambda == lambda; };
  };
  for (const auto& [lambda, goal] : {std::pair{4.0, ".80"}, {8.0, ".96"}, {16.0, ".99"}}) {
    const Which which = alone(lambda);
    row(fmt::format("right effect named, λ = {}", lambda), goal, which, answers(right));
    row(
        "– where no other entry comes near it (2 Δ ln L > 9)", "",
        [=](const Record& r) { return which(r) && r.separation > separable; }, answers(right));
  }
  const auto one_large = [](const Record& r) { return one(r) && large(r); };
  row("truth among the effects reported, λ ≥ 8", ".98", one_large, answers(has_truth));
  row("effects reported, mean number", "1.2", one_large, [](const Record& r, std::size_t method) {
    const std::size_t n = method < r.answers.size() ? reported(r.answers[method]).size() : 0;
    return n > 0 ? static_cast<double>(n) : nan;
  });
  row(
      "false alarms on healthy sets", ".04", [](const Record& r) { return r.order.group == "healthy"; },
      answers(alarm));
  row(
      "false alarms under stress", ".07", [](const Record& r) { return r.order.group == "stress"; }, answers(alarm));
  for (std::size_t i = 0; i < std::size(stress_names); ++i)
    row(
        fmt::format("– {}", stress_names[i]), "",
        [i](const Record& r) { return r.order.group == "stress" && static_cast<std::size_t>(r.order.stress) == i; },
        answers(alarm));
  row(
      "confident and wrong, effect in the catalogue", ".01",
      [](const Record& r) { return !r.truth.unknown && !r.truth.effects.empty(); }, answers(wrong));
  row(
      "confident and wrong, effect not in it, λ_res > 6", ".03",
      [](const Record& r) { return r.truth.unknown && r.lambda_left > recognisable; }, answers(wrong));
  const auto unknown = [](const char* group, double low, double high) {
    return [=](const Record& r) {
      return r.truth.unknown && (!*group || r.order.group == group) && low < r.lambda_left && r.lambda_left <= high;
    };
  };
  row("unknown recognised, λ_res 6–12", ".80", unknown("", recognisable, plain), answers(right));
  row("unknown recognised, λ_res > 12", ".98", unknown("", plain, 1e9), answers(right));
  row("– entry left out, λ_res > 6", "", unknown("left-out", recognisable, 1e9), answers(right));
  row("– laws outside the vocabulary", "", unknown("law", recognisable, 1e9), answers(right));
  row("– λ_res < 6, not to be expected", "", unknown("", -1, recognisable), answers(right));
  row("falsely unknown", ".05", one, answers(says_unknown));
  row(
      "ties said to be ties, λ ≥ 8", "", [](const Record& r) { return !r.truth.tied.empty() && large(r); },
      answers(right));
  for (const double lambda : {8, 16}) {
    const auto two = [=](const Record& r) { return r.order.group == "pair" && r.order.lambda == lambda; };
    row(fmt::format("two effects exactly, λ = {}", lambda), lambda < 10 ? ".88" : ".97", two, answers(right));
    row(
        "– where no other entry comes near either", "",
        [=](const Record& r) { return two(r) && r.separation > separable; }, answers(right));
  }
  out.push_back(coverage(all));
  out.push_back(new_poses(all, "model error at new poses / σ of a reading, median, one effect, λ ≥ 8", ".08",
                          [](const Record& r) { return r.order.group != "pair" && large(r); }));
  out.push_back(new_poses(all, "the same, two effects", "", [](const Record& r) { return r.order.group == "pair"; }));
  return out;
}

std::vector<Reliability> reliability(const std::vector<Record>& all) {
  constexpr double edges[] = {0, 0.5, 0.8, 0.9, 0.95, 0.99, 1};
  std::vector<Reliability> out;
  for (const std::size_t method : {0, 3})  // those that give probabilities
    for (std::size_t i = 0; i + 1 < std::size(edges); ++i) {
      Reliability bin{method_names[method], edges[i], edges[i + 1]};
      for (const Record& r : all) {
        const bool counts = r.truth.unknown ? r.lambda_left > recognisable : r.truth.effects.size() <= 1;
        if (!r.skipped.empty() || !counts || method >= r.answers.size()) continue;
        const Answer& a = r.answers[method];
        const bool last = i + 2 == std::size(edges);
        if (a.first.empty() || a.probability < bin.low || !(a.probability < bin.high || last)) continue;
        ++bin.sets;
        bin.mean += a.probability;
        bin.right += !r.truth.unknown && holds(r.truth.effects, a.first);
      }
      if (bin.sets == 0) continue;
      bin.mean /= static_cast<double>(bin.sets);
      bin.right /= static_cast<double>(bin.sets);
      out.push_back(bin);
    }
  return out;
}

}  // namespace deflect::benchmark
