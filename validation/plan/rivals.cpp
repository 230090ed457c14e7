#include "validation/plan/rivals.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/effects/effect_file.h"
#include "validation/measurement/random.h"
#include "validation/parallel/cases.h"

namespace deflect::plan {
namespace {

constexpr double wide = 3, half_range = 1;  // prior deviation of a coordinate: of a logarithm, e³; of a linear one
constexpr double step = 1e-5;               // of derivatives
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

}  // namespace

std::vector<Rival> rivals_of(const diagnosis::FoundTie& tie, const std::vector<effects::Effect>& all) {
  std::vector<Rival> out;
  double sum = 0;
  for (const diagnosis::FoundTie::Rival& found : tie.rivals) {
    Rival& rival = out.emplace_back();
    rival.probability = found.probability;
    sum += found.probability;
    for (const diagnosis::FoundEffect& each : found.effects) {
      const effects::EffectInstance instance = diagnosis::instance(effects::find_effect(all, each.effect), each);
      const Eigen::Index before = rival.values.size(), own = instance.values.size();
      rival.values.conservativeResize(before + own);
      rival.values.tail(own) = instance.values;
      rival.hypothesis.push_back(instance);
    }
  }
  for (Rival& r : out) r.probability = sum > 0 ? r.probability / sum : 1 / static_cast<double>(out.size());
  return out;
}

subject::Subject subject_with(const subject::Subject& s, const Rival& r, const VectorX& values) {
  return effects::PreparedEffects(s, r.hypothesis)(values);
}

namespace {

/// What the plan asks of a rival at its fit.
struct AtFit {
  VectorX predicted, prior;  // prior variances of its coordinates
  MatrixX beside;            // derivatives of the prediction with respect to them, whitened
  MatrixX root;              // of the covariance of its coordinates, given the readings taken
};

AtFit at_fit(const Prospect& prospect, const subject::Subject& s, const Rival& rival) {
  AtFit out;
  const effects::PreparedEffects prepared(s, rival.hypothesis);
  const VectorX x = diagnosis::coordinates_of(rival.hypothesis, rival.values);
  const auto parameters = diagnosis::parameters_of(rival.hypothesis);
  out.prior.resize(x.size());
  out.predicted = prospect.predicted(prepared(rival.values));
  MatrixX J = MatrixX::Zero(out.predicted.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double deviation = nth(parameters, i)->log ? wide : half_range;
    out.prior(i) = deviation * deviation;
    for (const double by : {step, -step}) {
      VectorX moved = x;
      moved(i) += by;
      const VectorX values = diagnosis::values_at(rival.hypothesis, moved);
      if (values(i) == rival.values(i)) continue;  // at a bound
      J.col(i) = (prospect.predicted(prepared(values)) - out.predicted) / by;
      break;
    }
  }
  out.beside = prospect.white(J);
  const MatrixX P = prospect.design(MatrixX(out.predicted.size(), 0), out.beside, out.prior).covariance();
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(P.bottomRightCorner(x.size(), x.size()));
  out.root = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  return out;
}

std::vector<AtFit> all_at_fit(const Prospect& prospect, const subject::Subject& s, const std::vector<Rival>& rivals,
                              int threads) {
  std::vector<AtFit> out(rivals.size());
  std::vector<std::string> why(rivals.size());
  parallel::for_each_case(rivals.size(), 1, threads, [&](std::size_t r) {
    auto found = outcome_of([&] { return at_fit(prospect, s, rivals[r]); });
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

/// Standard normal coordinates (rows) of so many draws, the first of them zero. Each has the mean 0 and the mean square
/// 1 over all draws, so that the mean of what is quadratic in one coordinate is exact; with two draws or one they are
/// zero.
MatrixX standardised(Eigen::Index coordinates, std::size_t draws, measurement::Random& random) {
  MatrixX out = MatrixX::Zero(coordinates, as_index(draws));
  for (Eigen::Index k = 1; k < out.cols(); ++k)
    for (Eigen::Index i = 0; i < coordinates; ++i) out(i, k) = random.normal();
  if (draws < 3) return MatrixX::Zero(coordinates, as_index(draws));
  for (Eigen::Index i = 0; i < coordinates; ++i) {
    auto drawn = out.row(i).tail(out.cols() - 1);
    drawn.array() -= drawn.mean();
    drawn *= std::sqrt(static_cast<double>(draws)) / drawn.norm();
  }
  return out;
}

/// By rival, its predictions with `draws` values of its parameters, the fit itself first; nothing where one fails.
std::vector<std::vector<std::optional<VectorX>>> drawn_predictions(const Prospect& prospect, const subject::Subject& s,
                                                                   const std::vector<Rival>& rivals,
                                                                   const std::vector<AtFit>& fits, std::size_t draws,
                                                                   std::uint64_t seed, int threads) {
  std::vector<MatrixX> lots;
  measurement::Random random(seed);
  for (const Rival& r : rivals) lots.push_back(standardised(r.values.size(), draws, random));
  std::vector<std::vector<std::optional<VectorX>>> out(rivals.size(), std::vector<std::optional<VectorX>>(draws));
  parallel::for_each_case(rivals.size() * draws, 1, threads, [&](std::size_t i) {
    const std::size_t r = i / draws;
    std::optional<VectorX>& one = out[r][i % draws];
    if (i % draws == 0) {
      one = fits[r].predicted;
      return;
    }
    const diagnosis::Hypothesis& h = rivals[r].hypothesis;
    const VectorX x = diagnosis::coordinates_of(h, rivals[r].values) + fits[r].root * lots[r].col(as_index(i % draws));
    const VectorX values = diagnosis::values_at(h, x);
    auto predicted = outcome_of([&] { return prospect.predicted(subject_with(s, rivals[r], values)); });
    if (predicted && predicted->allFinite()) one = std::move(*predicted.value);
  });
  return out;
}

}  // namespace

Rivalry::Rivalry(const Prospect& prospect, const subject::Subject& s, std::vector<Rival> rivals, int draws,
                 std::uint64_t seed, const parallel::Work& work)
    : prospect_(prospect), rivals_(std::move(rivals)) {
  const std::vector<AtFit> fits = all_at_fit(prospect_, s, rivals_, work.threads);
  if (work.progress) work.progress(0.3);
  const auto drawn = drawn_predictions(prospect_, s, rivals_, fits, as_size(std::max(1, draws)), seed, work.threads);
  for (std::size_t b = 0; b < rivals_.size(); ++b) {
    beside_.push_back(fits[b].beside);
    prior_.push_back(fits[b].prior);
    std::vector<VectorX> columns;
    std::vector<Target> origin;
    for (std::size_t a = 0; a < rivals_.size(); ++a)
      for (std::size_t k = 0; k < drawn[a].size(); ++k)
        if (a != b && drawn[a][k]) {
          columns.push_back(*drawn[a][k] - fits[b].predicted);
          origin.push_back({a, k});
        }
    MatrixX targets(prospect_.numbers(), std::ssize(columns));
    for (Eigen::Index i = 0; i < targets.cols(); ++i) targets.col(i) = nth(columns, i);
    targets_.push_back(prospect_.white(targets));
    origin_.push_back(std::move(origin));
  }
}

Design Rivalry::design(std::size_t fitted, bool all) const {
  return prospect_.design(targets_[fitted], beside_[fitted], prior_[fitted], all);
}

std::vector<MatrixX> Rivalry::gain_of_all() const {
  std::vector<MatrixX> out;
  for (std::size_t b = 0; b < rivals_.size(); ++b) out.push_back(design(b, true).Q() - design(b, false).Q());
  return out;
}

std::vector<Pair> Rivalry::pairs(const std::vector<MatrixX>& gain) const {
  std::vector<Pair> out;
  for (std::size_t a = 0; a < rivals_.size(); ++a)
    for (std::size_t b = a + 1; b < rivals_.size(); ++b) {
      Pair p{a, b, 0, INFINITY};
      double count = 0;
      for (const auto& [fitted, truth] : {std::pair{a, b}, std::pair{b, a}})
        for (std::size_t t = 0; t < origin_[fitted].size(); ++t)
          if (origin_[fitted][t].truth == truth) {
            const double here = std::max(0.0, gain[fitted](as_index(t), as_index(t)));
            p.separation += here, count += 1;
            p.least = std::min(p.least, here);
          }
      if (count > 0) p.separation /= count;
      out.push_back(p);
    }
  return out;
}

double Rivalry::probability(const std::vector<MatrixX>& gain) const {
  double sum = 0, weights = 0;
  for (std::size_t a = 0; a < rivals_.size(); ++a) {
    std::size_t draws = 0;
    for (const std::vector<Target>& all : origin_)
      for (const Target& t : all) draws = std::max(draws, t.draw + 1);
    for (std::size_t d = 0; d < draws; ++d) {
      std::vector<std::pair<double, double>> competitors;
      for (std::size_t b = 0; b < rivals_.size(); ++b)
        for (std::size_t t = 0; t < origin_[b].size(); ++t)
          if (origin_[b][t].truth == a && origin_[b][t].draw == d)
            competitors.emplace_back(rivals_[b].probability / std::max(1e-9, rivals_[a].probability),
                                     std::max(0.0, gain[b](as_index(t), as_index(t))));
      if (competitors.empty()) continue;  // a draw that failed
      sum += rivals_[a].probability * expected_probability(competitors);
      weights += rivals_[a].probability;
    }
  }
  return weights > 0 ? sum / weights : 0;
}

RivalryAim::RivalryAim(const Rivalry& r, const std::vector<Pair>& hopeless, double wanted)
    : rivalry_(&r), wanted_(wanted) {
  for (std::size_t b = 0; b < r.rivals_.size(); ++b) {
    designs_.push_back(r.design(b, false));
    before_.push_back(designs_.back().Q());
    gain_.push_back(MatrixX::Zero(before_.back().rows(), before_.back().cols()));
    std::vector<bool>& counts = counts_.emplace_back();
    for (const Rivalry::Target& t : r.origin_[b])
      counts.push_back(std::none_of(hopeless.begin(), hopeless.end(), [&](const Pair& p) {
        return (p.a == t.truth && p.b == b) || (p.b == t.truth && p.a == b);
      }));
  }
}

double RivalryAim::with(std::size_t block) const {
  std::vector<MatrixX> gain;
  for (std::size_t b = 0; b < designs_.size(); ++b) gain.push_back(designs_[b].with(rows(block, b)) - before_[b]);
  return soft_least(gain);
}

void RivalryAim::take(std::size_t block) {
  for (std::size_t b = 0; b < designs_.size(); ++b) {
    designs_[b].take(rows(block, b));
    gain_[b] = designs_[b].Q() - before_[b];
  }
}

void RivalryAim::drop(std::size_t block) {
  for (std::size_t b = 0; b < designs_.size(); ++b) {
    designs_[b].drop(rows(block, b));
    gain_[b] = designs_[b].Q() - before_[b];
  }
}

WhiteRows RivalryAim::rows(std::size_t block, std::size_t fitted) const {
  return rivalry_->prospect_.rows(block, rivalry_->targets_[fitted], rivalry_->beside_[fitted]);
}

double RivalryAim::soft_least(const std::vector<MatrixX>& gain) const {
  double least = INFINITY, sum = 0, n = 0;
  const auto each = [&](const auto& look) {
    for (std::size_t b = 0; b < gain.size(); ++b)
      for (Eigen::Index t = 0; t < gain[b].cols(); ++t)
        if (counts_[b][as_size(t)]) look(gain[b](t, t));
  };
  each([&](double q) { least = std::min(least, q); });
  if (std::isinf(least)) return 0;
  each([&](double q) { sum += std::exp((least - q) / 8), n += 1; });
  return least - 8 * std::log(sum / n);
}

}  // namespace deflect::plan
