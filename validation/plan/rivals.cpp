#include "validation/plan/rivals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/measurement/random.h"
#include "validation/parallel/cases.h"
#include "validation/plan/posterior.h"

namespace deflect::plan {
namespace {

constexpr int quadrature = 121;
constexpr double tails = 6;

/// Expected probability of the truth, whose competitors have the prior odds and λ² given: 2 ln of each ratio of
/// likelihoods is N(λ², 4 λ²), all of them together at the same quantile.
double expected_probability(const std::vector<std::pair<double, double>>& competitors) {
  double sum = 0, weights = 0;
  for (int i = 0; i < quadrature; ++i) {
    const double z = tails * (2.0 * i / (quadrature - 1) - 1), weight = std::exp(-z * z / 2);
    double against = 1;
    for (const auto& [odds, separation] : competitors)
      against += odds * std::exp(-separation / 2 + std::sqrt(separation) * z);
    sum += weight / against, weights += weight;
  }
  return sum / weights;
}

std::vector<Linearised> all_at_fit(const std::vector<RivalModel>& models, const std::vector<Rival>& rivals,
                                   int threads) {
  std::vector<Linearised> out(models.size());
  std::vector<std::string> why(models.size());
  parallel::for_each_case(models.size(), 1, threads, [&](std::size_t r) {
    auto found = outcome_of([&] { return models[r].at_fit(); });
    if (found)
      out[r] = std::move(*found.value);
    else
      why[r] = found.why;
  });
  for (std::size_t r = 0; r < rivals.size(); ++r)
    if (!why[r].empty())
      throw InputError(
          fmt::format("{} cannot be predicted under these loads: {}; lower them with --max-force and "
                      "--max-moment, or choose poses with --poses",
                      diagnosis::name_of(rivals[r].own()), why[r]));
  return out;
}

/// By rival, its predictions with `draws` values of its parameters (draws_of(); fewer than three: the fit itself);
/// nothing where one fails.
std::vector<std::vector<std::optional<VectorX>>> drawn_predictions(const std::vector<RivalModel>& models,
                                                                   const std::vector<Linearised>& fits,
                                                                   std::size_t draws, std::uint64_t seed, int threads) {
  std::vector<MatrixX> drawn(fits.size());
  parallel::for_each_case(fits.size(), 1, threads, [&](std::size_t r) {
    measurement::Random random(seed + r);
    drawn[r] = draws < 3 ? MatrixX(fits[r].at.replicate(1, as_index(draws)))
                         : draws_of(models[r], fits[r], as_index(draws), random);
  });
  std::vector<std::vector<std::optional<VectorX>>> out(fits.size(), std::vector<std::optional<VectorX>>(draws));
  parallel::for_each_case(fits.size() * draws, 1, threads, [&](std::size_t i) {
    const std::size_t r = i / draws;
    std::optional<VectorX>& one = out[r][i % draws];
    const VectorX x = drawn[r].col(as_index(i % draws));
    if (x == fits[r].at) {
      one = fits[r].predicted;
      return;
    }
    auto predicted = outcome_of([&] { return models[r].predicted(x); });
    if (predicted && predicted->allFinite()) one = std::move(*predicted.value);
  });
  return out;
}

}  // namespace

Rivalry::Rivalry(const Prospect& prospect, const subject::Subject& s, std::vector<Rival> rivals, int draws,
                 std::uint64_t seed, const parallel::Work& work)
    : prospect_(&prospect), rivals_(std::move(rivals)) {
  for (const Rival& r : rivals_) models_.emplace_back(*prospect_, s, r);
  fits_ = all_at_fit(models_, rivals_, work.threads);
  if (work.progress) work.progress(0.3);
  predicted_ = drawn_predictions(models_, fits_, as_size(std::max(1, draws)), seed, work.threads);
  for (std::size_t b = 0; b < rivals_.size(); ++b) linearised_.push_back(linearisation(b, fits_[b], others(b)));
}

std::vector<std::size_t> Rivalry::others(std::size_t fitted) const {
  std::vector<std::size_t> out;
  for (std::size_t a = 0; a < rivals_.size(); ++a)
    if (a != fitted) out.push_back(a);
  return out;
}

Rivalry::Linearisation Rivalry::linearisation(std::size_t fitted, const Linearised& about,
                                              const std::vector<std::size_t>& truths) const {
  Linearisation out{fitted, about.beside, {}, {}};
  std::vector<VectorX> columns;
  for (const std::size_t a : truths)
    for (std::size_t k = 0; k < predicted_[a].size(); ++k)
      if (predicted_[a][k]) {
        columns.push_back(models_[fitted].target(*predicted_[a][k], about));
        out.origin.push_back({a, k});
      }
  out.targets.resize(prospect_->numbers(), std::ssize(columns));
  for (Eigen::Index i = 0; i < out.targets.cols(); ++i) out.targets.col(i) = nth(columns, i);
  return out;
}

Rivalry Rivalry::about(const FitsToTruths& points, const parallel::Work& work) const {
  Rivalry out = *this;
  const std::size_t n = rivals_.size();
  std::vector<std::optional<Linearisation>> all(n * n);
  parallel::for_each_case(all.size(), 1, work.threads, [&](std::size_t i) {
    const std::size_t b = i / n, a = i % n;
    if (a == b) return;
    const auto there = outcome_of([&] { return models_[b].at(points[b][a]); });
    all[i] = linearisation(b, there ? *there : fits_[b], {a});
  });
  out.linearised_.clear();
  for (std::optional<Linearisation>& each : all)
    if (each) out.linearised_.push_back(std::move(*each));
  return out;
}

Design Rivalry::design(const Linearisation& l, bool all) const {
  return prospect_->design(l.targets, l.beside, models_[l.fitted].prior(), all);
}

Gains Rivalry::gain_of_all() const {
  Gains out;
  for (const Linearisation& l : linearised_)
    out.emplace_back(design(l, true).Q().diagonal() - design(l, false).Q().diagonal());
  return out;
}

Refits Rivalry::refitted(const parallel::Work& work) const {
  Refits out{{}, FitsToTruths(rivals_.size(), std::vector<VectorX>(rivals_.size()))};
  std::vector<std::pair<std::size_t, std::size_t>> all;  // linearisation, target
  for (std::size_t l = 0; l < linearised_.size(); ++l) {
    const std::size_t n = linearised_[l].origin.size();
    out.gain.push_back(VectorX::Zero(as_index(n)));
    for (std::size_t t = 0; t < n; ++t) all.emplace_back(l, t);
  }
  parallel::for_each_case(all.size(), 1, work.threads, [&](std::size_t i) {
    const auto [l, t] = all[i];
    const auto [a, k] = linearised_[l].origin[t];
    const std::size_t b = linearised_[l].fitted;
    const VectorX& y = *predicted_[a][k];
    Refitted to_all = models_[b].fitted_to(y, fits_[b], true);
    out.gain[l](as_index(t)) = to_all.left - models_[b].fitted_to(y, fits_[b], false).left;
    if (k == 0) out.at[b][a] = std::move(to_all.at);
  });
  return out;
}

std::vector<Pair> Rivalry::pairs(const Gains& gain) const {
  std::vector<Pair> out;
  for (std::size_t a = 0; a < rivals_.size(); ++a)
    for (std::size_t b = a + 1; b < rivals_.size(); ++b) {
      Pair p{a, b, 0, 0, 0, INFINITY};
      double of_a = 0, of_b = 0;
      for (std::size_t l = 0; l < linearised_.size(); ++l)
        for (std::size_t t = 0; t < linearised_[l].origin.size(); ++t) {
          if (std::minmax(linearised_[l].fitted, linearised_[l].origin[t].truth) != std::minmax(a, b)) continue;
          const double here = std::max(0.0, gain[l](as_index(t)));
          if (linearised_[l].origin[t].truth == a)
            p.if_a += here, of_a += 1;
          else
            p.if_b += here, of_b += 1;
          p.least = std::min(p.least, here);
        }
      if (of_a > 0) p.if_a /= of_a;
      if (of_b > 0) p.if_b /= of_b;
      p.separation = (of_a * p.if_a + of_b * p.if_b) / std::max(1.0, of_a + of_b);
      out.push_back(p);
    }
  return out;
}

double Rivalry::probability(const Gains& gain) const {
  // Of each truth and draw: prior odds of the others and λ² to them.
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::pair<double, double>>> competitors;
  for (std::size_t l = 0; l < linearised_.size(); ++l)
    for (std::size_t t = 0; t < linearised_[l].origin.size(); ++t) {
      const Target& truth = linearised_[l].origin[t];
      const double odds = rivals_[linearised_[l].fitted].probability / std::max(1e-9, rivals_[truth.truth].probability);
      competitors[{truth.truth, truth.draw}].emplace_back(odds, std::max(0.0, gain[l](as_index(t))));
    }
  double sum = 0, weights = 0;
  for (const auto& [truth, all] : competitors) {
    sum += rivals_[truth.first].probability * expected_probability(all);
    weights += rivals_[truth.first].probability;
  }
  return weights > 0 ? sum / weights : 0;
}

VectorX RivalryAim::Said::separations() const {
  if (bb.size() == 0) return tt;
  const MatrixX white = Eigen::LLT<MatrixX>(bb).matrixL().solve(bt);
  return tt - white.colwise().squaredNorm().transpose();
}

void RivalryAim::Said::add(const MatrixX& white, double sense) {
  const auto t = white.middleCols(first, tt.size()), b = white.middleCols(first + tt.size(), bb.cols());
  tt += sense * t.colwise().squaredNorm().transpose();
  bt += sense * b.transpose() * t;
  bb += sense * b.transpose() * b;
}

RivalryAim::RivalryAim(const Rivalry& r, const std::vector<Pair>& hopeless, double wanted)
    : rivalry_(&r), wanted_(wanted), design_({}, {}, {}) {
  const MatrixX none(r.prospect_->numbers(), 0);
  std::vector<MatrixX> absorbed;
  Eigen::Index columns = 0;
  for (const Rivalry::Linearisation& l : r.linearised_) {
    const Eigen::Index t = l.targets.cols(), b = l.beside.cols();
    MatrixX both(none.rows(), t + b);
    both << l.targets, l.beside;
    const Design alone = r.prospect_->design(both, none, VectorX(0));
    const MatrixX& Q = alone.Q();
    said_.push_back({columns, Q.diagonal().head(t), Q.bottomLeftCorner(b, t), Q.bottomRightCorner(b, b)});
    said_.back().bb.diagonal() += r.models_[l.fitted].prior().cwiseInverse();
    absorbed.push_back(alone.absorbed());
    design_ = Design(alone.covariance(), {}, {});
    columns += t + b;
    before_.push_back(said_.back().separations());
    gain_.push_back(VectorX::Zero(t));
    std::vector<bool>& counts = counts_.emplace_back();
    for (const Rivalry::Target& target : l.origin)
      counts.push_back(std::none_of(hopeless.begin(), hopeless.end(), [&](const Pair& p) {
        return std::minmax(p.a, p.b) == std::minmax(target.truth, l.fitted);
      }));
  }
  MatrixX alpha(design_.covariance().rows(), columns);
  for (std::size_t l = 0; l < said_.size(); ++l) alpha.middleCols(said_[l].first, absorbed[l].cols()) = absorbed[l];
  design_ = Design(design_.covariance(), std::move(alpha), {});
}

double RivalryAim::with(std::size_t block) const {
  const MatrixX white = design_.innovations(rows(block), false);
  Gains gain;
  for (std::size_t l = 0; l < said_.size(); ++l) {
    Said there = said_[l];
    there.add(white, 1);
    gain.emplace_back(there.separations() - before_[l]);
  }
  return soft_least(gain);
}

void RivalryAim::update(std::size_t block, bool taken) {
  const WhiteRows read = rows(block);
  const MatrixX white = design_.innovations(read, taken);
  if (taken)
    design_.drop(read);
  else
    design_.take(read);
  for (std::size_t l = 0; l < said_.size(); ++l) {
    said_[l].add(white, taken ? -1 : 1);
    gain_[l] = said_[l].separations() - before_[l];
  }
}

WhiteRows RivalryAim::rows(std::size_t block) const {
  const Prospect& p = *rivalry_->prospect_;
  const MatrixX none(p.numbers(), 0);
  WhiteRows out = p.rows(block, none, none);
  const auto [first, n] = p.numbers_of(block);
  out.targets.resize(n, design_.absorbed().cols());
  for (std::size_t l = 0; l < said_.size(); ++l) {
    const Rivalry::Linearisation& of = rivalry_->linearised_[l];
    out.targets.middleCols(said_[l].first, of.targets.cols()) = of.targets.middleRows(first, n);
    out.targets.middleCols(said_[l].first + of.targets.cols(), of.beside.cols()) = of.beside.middleRows(first, n);
  }
  return out;
}

double RivalryAim::soft_least(const Gains& gain) const {
  double least = INFINITY, sum = 0, n = 0;
  const auto each = [&](const auto& look) {
    for (std::size_t l = 0; l < gain.size(); ++l)
      for (Eigen::Index t = 0; t < gain[l].size(); ++t)
        if (counts_[l][as_size(t)]) look(gain[l](t));
  };
  each([&](double q) { least = std::min(least, q); });
  if (std::isinf(least)) return 0;
  each([&](double q) { sum += std::exp((least - q) / 8), n += 1; });
  return least - 8 * std::log(sum / n);
}

}  // namespace deflect::plan
