#include "validation/diagnosis/pairs.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/diagnosis/candidates.h"
#include "validation/diagnosis/fit_in_turn.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"

namespace deflect::diagnosis {
namespace {

constexpr double left_by_others = 0.05;  // share of a column that others must leave it
constexpr double too_little_alone = 6;   // gain in χ² alone
constexpr double left_squared = left_by_others * left_by_others;

/// The columns of a signature that apply together: all of them, or of a shaped one a single one.
struct Part {
  std::size_t signature;
  Eigen::Index first, count;
  double gain = 0, log_prior = 0;
  int sign = 0;  ///< that the coefficient of its column must have, 0: any
};

/// Inner products of columns and residual beside what is fitted.
struct Beside {
  MatrixX gram;
  VectorX along;
};

Beside beside_of(const std::vector<Signature>& all, const MatrixX& between, const VectorX& residual,
                 const MatrixX& fitted) {
  MatrixX in_fitted(between.rows(), fitted.cols());
  VectorX along(between.rows());
  Eigen::Index at = 0;
  for (const Signature& s : all) {
    in_fitted.middleRows(at, s.basis.cols()) = s.basis.transpose() * fitted;
    along.segment(at, s.basis.cols()) = s.basis.transpose() * residual;
    at += s.basis.cols();
  }
  return {between - in_fitted * in_fitted.transpose(), along - in_fitted * (fitted.transpose() * residual)};
}

/// The reduction of χ² by columns with these inner products, and their coefficients; 0 where they are all but
/// dependent.
double gain_of(const MatrixX& gram, const VectorX& along, VectorX& coefficients) {
  const Eigen::LDLT<MatrixX> factor(gram);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > left_squared * gram.diagonal().maxCoeff()))
    return 0;
  coefficients = factor.solve(along);
  return along.dot(coefficients);
}

/// Physics lets an effect act to one side: its coefficient, by which the residual is explained, has the other sign than
/// what it changes.
int wanted_sign(const Signature& s) {
  if (!s.one_sided) return 0;
  return s.shaped || s.start(0) > 0 ? -1 : 1;
}

bool may_be(const Part& p, double coefficient) { return p.sign == 0 || p.sign * coefficient > 0; }

std::vector<Part> parts_of(const std::vector<Signature>& all, const Beside& b,
                           const std::function<double(std::size_t, double)>& log_odds) {
  std::vector<Part> out;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Signature& s = all[i];
    const Eigen::Index columns = s.basis.cols(), step = s.shaped ? 1 : columns;
    for (Eigen::Index k = 0; k < columns; k += step) {
      Part p{i, at + k, step};
      VectorX coefficients;
      if (b.gram.diagonal().segment(p.first, step).maxCoeff() < left_squared) continue;
      p.gain = gain_of(b.gram.block(p.first, p.first, step, step), b.along.segment(p.first, step), coefficients);
      if (!(p.gain > too_little_alone)) continue;
      p.sign = step == 1 ? wanted_sign(s) : 0;
      p.log_prior = log_odds(i, 0);
      out.push_back(p);
    }
    at += columns;
  }
  return out;
}

double gain_of_two(const Beside& b, const Part& x, const Part& y) {
  if (x.count == 1 && y.count == 1) {
    const double xx = b.gram(x.first, x.first), yy = b.gram(y.first, y.first), xy = b.gram(x.first, y.first);
    const double determinant = xx * yy - xy * xy, along_x = b.along(x.first), along_y = b.along(y.first);
    if (!(determinant > left_squared * xx * yy)) return 0;
    const double of_x = (yy * along_x - xy * along_y) / determinant, of_y = (xx * along_y - xy * along_x) / determinant;
    return may_be(x, of_x) && may_be(y, of_y) ? along_x * of_x + along_y * of_y : 0;
  }
  const Eigen::Index n = x.count + y.count;
  MatrixX gram(n, n);
  gram << b.gram.block(x.first, x.first, x.count, x.count), b.gram.block(x.first, y.first, x.count, y.count),
      b.gram.block(y.first, x.first, y.count, x.count), b.gram.block(y.first, y.first, y.count, y.count);
  VectorX along(n), coefficients;
  along << b.along.segment(x.first, x.count), b.along.segment(y.first, y.count);
  const double gain = gain_of(gram, along, coefficients);
  return gain > 0 && may_be(x, coefficients(0)) && may_be(y, coefficients(x.count)) ? gain : 0;
}

struct Found {
  PairOfSignatures pair;
  double log_odds;
};

bool same_two(const PairOfSignatures& a, const PairOfSignatures& b) {
  return std::minmax(a.first, a.second) == std::minmax(b.first, b.second);
}

/// Takes it among the best; of several shapes of the same two the best one.
void take(std::vector<Found>& best, const Found& found, std::size_t most) {
  const auto there =
      std::find_if(best.begin(), best.end(), [&](const Found& f) { return same_two(f.pair, found.pair); });
  if (there == best.end())
    best.push_back(found);
  else if (found.log_odds > there->log_odds)
    *there = found;
  std::stable_sort(best.begin(), best.end(), [](const Found& a, const Found& b) { return a.log_odds > b.log_odds; });
  if (best.size() > most) best.pop_back();
}

}  // namespace

std::vector<PairOfSignatures> best_pairs(const std::vector<Signature>& all, const MatrixX& between,
                                         const VectorX& residual, const MatrixX& beside,
                                         const std::function<double(std::size_t, double)>& log_odds, double least,
                                         std::size_t most) {
  const Beside b = beside_of(all, between, residual, beside);
  const std::vector<Part> parts = parts_of(all, b, log_odds);
  std::vector<Found> best;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const bool in_order = parts[i].gain > parts[k].gain;
      const Part &x = in_order ? parts[i] : parts[k], &y = in_order ? parts[k] : parts[i];
      if (x.signature == y.signature) continue;
      const double gain = gain_of_two(b, x, y);
      const double bar = best.size() < most ? least : std::max(least, best.back().log_odds);
      // The sum of the logarithms is at most this: the larger part of the work is spared.
      if (!(x.log_prior + y.log_prior + gain / 2 + 2 * std::log(2.0) > bar) || !(gain > x.gain)) continue;
      const Found found{{x.signature, y.signature, x.gain, gain},
                        log_odds(x.signature, x.gain) + log_odds(y.signature, gain - x.gain)};
      if (found.log_odds > bar) take(best, found, most);
    }
  std::vector<PairOfSignatures> out;
  for (const Found& f : best) out.push_back(f.pair);
  return out;
}

std::optional<TwoCandidates> Candidates::two_beside(const Observations& o, const Hypothesis& before, const Fit& so_far,
                                                    double least, double each) const {
  constexpr std::size_t looked_at = 4;
  constexpr double signatures_may_miss = 4;  // of ln of the odds
  const MatrixX fitted = statistics::orthonormal(so_far.signature);
  const auto of_class = [&](std::size_t i, double gain) {
    return is_among(before, signatures_[i].effect) ? out_of_question : log_odds(i, gain, class_priors_[i]);
  };
  const std::vector<PairOfSignatures> promising =
      best_pairs(signatures_, between_, so_far.residual, fitted, of_class, least - signatures_may_miss, looked_at);
  const auto together = [&](const Hypothesis& others, const Fit& fitted_so_far, std::size_t i) {
    Hypothesis h = others;
    h.push_back(signatures_[i].effect);
    return TwoCandidates{h, fit(o, h, fitted_so_far.values, guess(signatures_[i], fitted_so_far.residual))};
  };
  std::map<std::size_t, TwoCandidates> alone;  // the first ones of pairs, each fitted once
  for (const PairOfSignatures& p : promising) alone[p.first];
  parallel::for_each_case(alone.size(), 1, threads_, [&](std::size_t k) {
    auto& [first, fitted_alone] = *std::next(alone.begin(), as_index(k));
    fitted_alone = together(before, so_far, first);
  });
  std::vector<TwoCandidates> all(promising.size(), {{}, {}, out_of_question});
  parallel::for_each_case(promising.size(), 1, threads_, [&](std::size_t k) {
    const auto [first, second, gain_of_first, gain] = promising[k];
    const TwoCandidates& one = alone.at(first);
    if (!one.fit.found) return;
    TwoCandidates both = together(one.hypothesis, one.fit, second);
    if (!both.fit.found || wants_more_than_there_can_be(both.hypothesis, both.fit)) return;
    const double of_second = of_class(second, std::max(0.0, one.fit.chi2 - both.fit.chi2));
    both.log_odds = of_class(first, std::max(0.0, so_far.chi2 - one.fit.chi2)) + of_second;
    if (of_second < each || !(both.log_odds > least)) return;
    const TwoCandidates other = together(before, so_far, second);
    if (!other.fit.found || of_class(first, std::max(0.0, other.fit.chi2 - both.fit.chi2)) < each) return;
    all[k] = std::move(both);
  });
  const auto best = std::ranges::max_element(all, {}, &TwoCandidates::log_odds);
  return best == all.end() || best->log_odds <= least ? std::nullopt : std::optional(std::move(*best));
}

}  // namespace deflect::diagnosis
