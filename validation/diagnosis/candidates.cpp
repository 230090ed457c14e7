#include "validation/diagnosis/candidates.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "validation/compare/parallel.h"
#include "validation/diagnosis/evidence.h"

namespace deflect {
namespace {

constexpr double alike = 0.999;                    // cosine from which signatures are one
constexpr double near_nothing = 6, hopeless = 30;  // gains in χ² that are not looked into
constexpr double bent = 8;                         // that a fit may gain beyond what the signature says, where small
constexpr double of_its_own = 0.05;                // share of a signature that others must leave it

std::vector<double> shared_priors(const std::vector<Signature>& all) {
  std::map<std::string, double> places;
  for (const Signature& s : all) places[s.effect.effect->name] += 1;
  std::vector<std::size_t> cluster(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    cluster[i] = i;
    for (std::size_t k = 0; k < i; ++k)
      if (all[i].amplitudes() == all[k].amplitudes() && all[i].shaped == all[k].shaped &&
          cosine(all[i], all[k]) > alike) {
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
  for (double& w : weight) w *= Candidates::prior_missing * (1 - Candidates::prior_unknown) / total;
  return weight;
}

bool same(const PlacedEffect& a, const PlacedEffect& b) { return a.effect == b.effect && a.leg == b.leg; }

}  // namespace

Candidates::Candidates(const Observations& o, const std::vector<Signature>& all, int threads,
                       std::function<void(std::size_t, std::size_t)> progress)
    : observations_(o),
      signatures_(all),
      threads_(threads),
      progress_(std::move(progress)),
      priors_(shared_priors(all)) {}

double Candidates::log_odds(std::size_t i, double gain) const {
  const Signature& s = signatures_[i];
  // Of the shapes tried one in three, or so, does what the best does.
  const double shape = s.shaped ? std::log(3.0) : 0;
  return std::log(priors_[i] / (1 - prior_missing)) + log_evidence(gain, s.amplitudes(), s.one_sided) - shape;
}

double Candidates::log_odds_of(const PlacedEffect& e, double gain) const {
  for (std::size_t i = 0; i < signatures_.size(); ++i)
    if (same(signatures_[i].effect, e)) return log_odds(i, gain);
  return -1e9;
}

std::vector<Candidate> Candidates::beside(const Hypothesis& before, const Fit& so_far, double least) const {
  std::vector<Candidate> out(signatures_.size());
  std::vector<char> allowed(out.size(), 1);
  double best = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Signature& s = signatures_[i];
    Candidate& c = out[i];
    c.hypothesis = before;
    c.hypothesis.push_back(s.effect);
    const bool there = std::any_of(before.begin(), before.end(), [&](const auto& p) { return same(p, s.effect); });
    allowed[i] = !there && own_share(s, so_far.signature) > of_its_own;
    c.gain = allowed[i] ? most_gain(s, so_far.residual, so_far.signature) : 0;
    best = std::max(best, c.gain);
  }
  const double enough = std::max(near_nothing, 0.5 * best - hopeless);
  std::atomic<std::size_t> done = 0;
  for_each_case(out.size(), 1, threads_, [&](std::size_t i) {
    Candidate& c = out[i];
    const Signature& s = signatures_[i];
    if (allowed[i] && c.gain >= enough && log_odds(i, 1.2 * c.gain + bent) > least) {
      c.fit = fit(observations_, c.hypothesis, so_far.values, guess(s, so_far.residual));
      c.gain = c.fit.found ? std::max(0.0, so_far.chi2 - c.fit.chi2) : 0;
    } else if (!s.shaped && s.one_sided && s.at_start.dot(so_far.residual) > 0) {
      c.gain = 0;
    }
    c.log_odds = allowed[i] ? log_odds(i, c.gain) : -1e9;
    c.chi2_per_dof = (so_far.chi2 - c.gain) / static_cast<double>(observations_.numbers());
    if (progress_) progress_(++done, out.size());
  });
  return out;
}

}  // namespace deflect
