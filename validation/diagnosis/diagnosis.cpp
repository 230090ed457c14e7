#include "validation/diagnosis/diagnosis.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <atomic>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>

#include "validation/compare/finding_text.h"
#include "validation/compare/findings.h"
#include "validation/compare/parallel.h"
#include "validation/diagnosis/evidence.h"

namespace deflect {
namespace {

constexpr double alike = 0.999;   // cosine from which signatures are one
constexpr double alarm = 0.02;    // chance above which nothing is called missing
constexpr double sure = 0.9;      // probability from which one effect is named
constexpr double called_for = 5;  // ln of the odds from which a further effect is added
constexpr std::size_t most_effects = 3, quality_of = 5;
constexpr double near_nothing = 6, hopeless = 30;           // gains in χ² that are not looked into
constexpr double prior_missing = 0.5, prior_unknown = 0.1;  // the second as a share of the first
constexpr double left_over_evidence = 3, left_over_p = 1e-3;

/// Prior of each signature: places of an entry share what the entry has, entries that do the same to these data have
/// one share together.
std::vector<double> priors(const std::vector<Signature>& all) {
  std::map<std::string, double> places;
  for (const Signature& s : all) places[s.effect.effect->name] += 1;
  std::vector<std::size_t> cluster(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    cluster[i] = i;
    for (std::size_t k = 0; k < i; ++k)
      if (all[i].basis.cols() == all[k].basis.cols() && cosine(all[i], all[k]) > alike) {
        cluster[i] = cluster[k];
        break;
      }
  }
  std::map<std::size_t, double> largest, sum;
  std::vector<double> weight(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    weight[i] = 1 / places[all[i].effect.effect->name];
    largest[cluster[i]] = std::max(largest[cluster[i]], weight[i]);
    sum[cluster[i]] += weight[i];
  }
  double total = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    weight[i] *= largest[cluster[i]] / sum[cluster[i]];
    total += weight[i];
  }
  for (double& w : weight) w *= prior_missing * (1 - prior_unknown) / total;
  return weight;
}

/// All patterns that a residual can have, site by site where they lie in sites; whitened.
MatrixX generic_columns(const Observations& o) {
  const ResidualStudy& s = o.comparison().study;
  std::vector<MatrixX> parts;
  for (const Pattern& p : patterns_of(s)) parts.push_back(rows_of(s.values, p.by_reading));
  if (!s.sites.front().empty()) {
    const auto f = [&](std::size_t i, std::size_t k) { return s.force[i](static_cast<Eigen::Index>(k)); };
    const auto site = [&](std::size_t i, std::size_t k) -> const Site& { return s.sites[s.data->readings[i].pose][k]; };
    const auto add = [&](const auto& e) { parts.push_back(rows_of(s.values, site_columns(s, e))); };
    add([&](std::size_t i, std::size_t k) { return f(i, k) == 0 ? 0 : std::copysign(1, f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::copysign(std::pow(std::abs(f(i, k)), 2.0 / 3), f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::copysign(f(i, k) * f(i, k), f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::abs(f(i, k)); });
    if (has_slides(s)) {
      add([&](std::size_t i, std::size_t k) { return f(i, k) * site(i, k).along; });
      for (const int power : {0, 1, 2, 3})
        add([&](std::size_t i, std::size_t k) {
          return f(i, k) * (1 - site(i, k).along) * std::pow(site(i, k).extension / mean_extension(s), power);
        });
    }
    if (s.sequence) add([&](std::size_t i, std::size_t k) { return s.heading[i](static_cast<Eigen::Index>(k)); });
  }
  Eigen::Index columns = 0;
  for (const MatrixX& p : parts) columns += p.cols();
  MatrixX out(o.null_residual().size(), columns);
  columns = 0;
  for (const MatrixX& p : parts) {
    out.middleCols(columns, p.cols()) = p;
    columns += p.cols();
  }
  return o.uncertainty().whitened(out);
}

/// Takes the span of `fitted` out of the columns.
MatrixX beside(const MatrixX& columns, const MatrixX& fitted) {
  if (fitted.cols() == 0) return columns;
  const Eigen::ColPivHouseholderQR<MatrixX> qr(fitted);
  const MatrixX Q = qr.householderQ() * MatrixX::Identity(fitted.rows(), qr.rank());
  return columns - Q * (Q.transpose() * columns);
}

/// p-value of what the columns hold of r.
double p_value_in(const VectorX& r, const MatrixX& columns) {
  const Eigen::ColPivHouseholderQR<MatrixX> qr = [&] {
    Eigen::ColPivHouseholderQR<MatrixX> out;
    out.setThreshold(1e-6);
    out.compute(columns);
    return out;
  }();
  const VectorX along = (qr.householderQ().transpose() * r).head(qr.rank());
  if (along.size() == 0) return 1;
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(static_cast<double>(along.size())), along.squaredNorm()));
}

Quality quality(const Observations& o, const Hypothesis& h, const Fit& f) {
  Quality q;
  q.chi2_per_dof = f.chi2 / std::max(1.0, static_cast<double>(o.numbers()) - static_cast<double>(f.values.size()));
  const Mechanism m = h.empty() ? o.device() : PreparedEffects(o.device(), h)(f.values);
  q.rmse = o.rmse(m);
  q.held_out = o.held_out_rmse(m);
  return q;
}

/// What is left, in words.
std::string left_over_pattern(const Observations& o, const Mechanism& m) {
  const ResidualStudy& s = o.comparison().study;
  const std::vector<Pattern> patterns = patterns_of(s);
  std::vector<MatrixX> columns;
  for (const Pattern& p : patterns) columns.push_back(rows_of(s.values, p.by_reading));
  std::string out;
  for (const Finding& f : find_patterns(s, o.uncertainty(), o.residual(m), patterns, columns).findings)
    out += (out.empty() ? "" : "; then ") + f.sentence;
  return out.empty() ? "no pattern that was looked for" : out;
}

/// Hypotheses with one more effect, in the order of the signatures. What by its signature cannot come near the best, or
/// has next to nothing to explain, is judged by its signature.
std::vector<Candidate> step(const Observations& o, const std::vector<Signature>& all, const Hypothesis& before,
                            const Fit& so_far, const DiagnosisOptions& options) {
  std::vector<Candidate> out(all.size());
  double best = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Candidate& c = out[i];
    c.hypothesis = before;
    c.hypothesis.push_back(all[i].effect);
    const bool there = std::any_of(before.begin(), before.end(), [&](const PlacedEffect& p) {
      return p.effect == all[i].effect.effect && p.leg == all[i].effect.leg;
    });
    c.gain = there ? 0 : most_gain(all[i], so_far.residual, so_far.signature);
    c.chi2_per_dof = (so_far.chi2 - c.gain) / static_cast<double>(o.numbers());
    best = std::max(best, c.gain);
  }
  const double enough = std::max(near_nothing, 0.5 * best - hopeless);
  std::atomic<std::size_t> done = 0;
  for_each_case(all.size(), 1, options.threads, [&](std::size_t i) {
    Candidate& c = out[i];
    if (c.gain >= enough) {
      const std::optional<VectorX> first = guess(all[i], so_far.residual);
      c.fit = fit(o, c.hypothesis, so_far.values, first);
      c.gain = c.fit.found ? std::max(0.0, so_far.chi2 - c.fit.chi2) : 0;
      c.chi2_per_dof = c.fit.chi2 / static_cast<double>(o.numbers());
    } else if (all[i].one_sided && all[i].at_start.dot(so_far.residual) > 0) {
      c.gain = 0;
    }
    if (options.progress) options.progress(++done, all.size());
  });
  return out;
}

double log_odds(const Signature& s, const Candidate& c, double prior, double prior_none) {
  return std::log(prior / prior_none) + log_evidence(c.gain, static_cast<int>(s.basis.cols()), s.one_sided);
}

std::vector<Detectable> detectable_sizes(const std::vector<Signature>& all) {
  std::vector<Detectable> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Signature& s = all[i];
    Detectable d{s.effect, s.at_start.norm(), {}, "", 0};
    const VectorX start = start_values(*s.effect.effect);
    for (Eigen::Index k = 0; k < start.size(); ++k) {
      const EffectParameter& p = s.effect.effect->parameters[static_cast<std::size_t>(k)];
      if (!p.vanishes) continue;
      // The signature grows with the distance from where the effect vanishes, for stiffnesses with the compliance.
      const double value = std::isinf(*p.vanishes) ? start(k) * d.lambda_at_start / 4
                                                   : *p.vanishes + (start(k) - *p.vanishes) * 4 / d.lambda_at_start;
      if (p.low <= value && value <= p.high) d.smallest.push_back(value);
    }
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k].effect.effect != s.effect.effect)
        if (const double c = cosine(s, all[k]); c > d.cosine) d.cosine = c, d.mistaken_for = name_of(all[k].effect);
    if (d.cosine < 0.9) d.mistaken_for.clear();
    out.push_back(std::move(d));
  }
  return out;
}

}  // namespace

Diagnosis diagnose(const Mechanism& m, const Measurements& data, const std::vector<Effect>& effects,
                   const DiagnosisOptions& options) {
  Observations o(m, data, options.comparison);
  Diagnosis d;
  d.noise_floor = o.comparison().sigma_u;
  d.baseline = {o.comparison().all.rmse, o.comparison().held_out, o.comparison().chi2_per_dof};
  const std::vector<Signature> all = signatures(o, effects, options.threads);
  const std::vector<double> prior = priors(all);
  d.detectable = detectable_sizes(all);
  Fit so_far;
  so_far.residual = o.null_residual();
  so_far.chi2 = so_far.residual.squaredNorm();
  so_far.found = true;

  // The first step, with "nothing" and "unknown" beside the effects.
  d.candidates = step(o, all, {}, so_far, options);
  const MatrixX generic = generic_columns(o);
  std::vector<double> weights;
  double least_p = 1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    weights.push_back(log_odds(all[i], d.candidates[i], prior[i], 1));
    least_p = std::min(least_p, single_p_value(all[i], d.candidates[i].gain));
  }
  weights.push_back(std::log(1 - prior_missing));
  weights.push_back(std::log(prior_missing * prior_unknown) + log_evidence_of_discrepancy(so_far.residual, generic));
  const std::vector<double> probability = normalised(weights);
  for (std::size_t i = 0; i < all.size(); ++i) d.candidates[i].probability = probability[i];
  d.probability_nothing = probability[all.size()];
  d.probability_unknown = probability[all.size() + 1];
  d.chance = chance_of_any(all, least_p);
  const double p_generic = p_value_in(so_far.residual, generic);
  const bool missing =
      (d.chance < alarm && d.probability_nothing < 0.5) || (d.probability_unknown > sure && p_generic < left_over_p);

  std::vector<std::size_t> order(all.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probability[a] > probability[b]; });

  std::vector<Candidate> now = d.candidates;
  std::vector<std::vector<std::string>> groups;
  while (missing && d.missing.size() < most_effects) {
    // Where one more is called for: the best of those that are, and what ties with it.
    std::vector<double> odds;
    for (std::size_t i = 0; i < all.size(); ++i)
      odds.push_back(now[i].fit.found ? log_odds(all[i], now[i], prior[i], d.missing.empty() ? 1 : 1 - prior_missing)
                                      : -1e9);
    const auto best = static_cast<std::size_t>(std::max_element(odds.begin(), odds.end()) - odds.begin());
    if (!d.missing.empty() && odds[best] < called_for) break;
    const std::vector<double> among = normalised(odds);
    if (among[best] < sure) {
      std::vector<std::size_t> by(all.size());
      for (std::size_t i = 0; i < by.size(); ++i) by[i] = i;
      std::stable_sort(by.begin(), by.end(), [&](std::size_t a, std::size_t b) { return among[a] > among[b]; });
      std::vector<std::string> group;
      double sum = 0;
      for (const std::size_t i : by) {
        const std::string& name = all[i].effect.effect->name;
        if (std::find(group.begin(), group.end(), name) == group.end()) group.push_back(name);
        if ((sum += among[i]) > 0.95) break;
      }
      if (group.size() > 1) groups.push_back(group);
    }
    d.missing = now[best].hypothesis;
    so_far = now[best].fit;
    // The deformed shape is that of a device with the effect in it.
    o.take_deformed_shape_of(PreparedEffects(m, d.missing)(so_far.values));
    so_far = fit(o, d.missing,
                 so_far.values.head(so_far.values.size() -
                                    static_cast<Eigen::Index>(d.missing.back().effect->parameters.size())));
    now = step(o, all, d.missing, so_far, options);
  }
  d.fit = so_far;

  // What is left.
  const MatrixX left = beside(generic, so_far.signature);
  const VectorX rest = so_far.residual;
  const double evidence = log_evidence_of_discrepancy(rest, left);
  d.unexplained = missing && evidence > left_over_evidence && p_value_in(rest, left) < left_over_p;
  const double beyond = std::max(1.0, o.null_residual().squaredNorm() - static_cast<double>(o.numbers()));
  d.share_unexplained =
      d.unexplained ? std::clamp((rest.squaredNorm() - static_cast<double>(o.numbers())) / beyond, 0.0, 1.0) : 0;

  d.verdict = !missing         ? Verdict::nothing_missing
              : d.unexplained  ? Verdict::unknown_effect
              : groups.empty() ? Verdict::effect
                               : Verdict::ambiguous;
  d.indistinguishable = groups;
  d.final = quality(o, d.missing, so_far);
  d.strained = o.strained(d.missing.empty() ? m : PreparedEffects(m, d.missing)(so_far.values));
  if (d.unexplained) {
    // The pattern that what is left looks like most; it is asked beside what has been fitted.
    d.pattern = left_over_pattern(o, d.missing.empty() ? m : PreparedEffects(m, d.missing)(so_far.values));
  }
  std::vector<Candidate> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(d.candidates[i]));
  d.candidates = std::move(sorted);
  for (std::size_t i = 0; i < d.candidates.size(); ++i) {
    Candidate& c = d.candidates[i];
    // Those of the table; of the others what they leave is not asked for beyond χ².
    if (i < quality_of && c.fit.found) {
      const Quality q = quality(o, c.hypothesis, c.fit);
      c.rmse = q.rmse;
      c.held_out = q.held_out;
    } else {
      c.rmse = d.baseline.rmse;
      c.held_out = d.baseline.held_out;
    }
  }
  return d;
}

}  // namespace deflect
