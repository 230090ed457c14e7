#include "validation/diagnosis/bootstrap.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>

#include "msa/base/index.h"
#include "validation/measurement/random.h"
#include "validation/parallel/journal.h"
#include "validation/parallel/pack.h"

namespace deflect::diagnosis {
namespace {

constexpr std::size_t block = 256;  // sets with one stream of random numbers
constexpr std::uint64_t seed = 20110101;

/// What the effect gains in χ² from the components of a set along its directions. `sense`: of the first of them along
/// the start, for an effect of one sense.
template <class Components>
double gain(const Signature& s, double sense, const Components& z) {
  if (s.shaped) {
    double most = 0;
    for (const double along : z)
      if (!(s.one_sided && along > 0)) most = std::max(most, along * along);
    return most;
  }
  const bool wrong_way = s.one_sided && z(0) * sense > 0;
  return wrong_way ? 0 : z.squaredNorm();
}

}  // namespace

double single_p_value(const Signature& s, double gain) {
  if (!(gain > 0)) return 1;
  const double p = statistics::chi_squared_tail(s.amplitudes(), gain);
  return s.one_sided ? p / 2 : p;
}

double gain_at_p_value(const Signature& s, double p) {
  const double own = s.one_sided ? 2 * p : p;
  return own < 1 ? statistics::chi_squared_at_tail(s.amplitudes(), own) : 0;
}

double chance_of_any(const std::vector<Signature>& all, const MatrixX& inner, double least_p, int sets_drawn,
                     const parallel::Work& work, const Counted& counted) {
  if (all.empty() || !(least_p < 1)) return 1;
  std::vector<double> wanted;
  const std::vector<double> weights = weights_of(all);
  std::vector<double> senses;
  for (const Signature& s : all) senses.push_back(s.one_sided && !s.shaped && s.basis.cols() > 0 ? s.start(0) : 0);
  for (std::size_t i = 0; i < all.size(); ++i)
    wanted.push_back(std::max(gain_at_p_value(all[i], least_p * weights[i]), std::numeric_limits<double>::min()));
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(inner);
  const Eigen::Index columns = axes.eigenvalues().size();
  const MatrixX root = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();

  const auto sets = as_size(sets_drawn);
  std::vector<int> as_good((sets + block - 1) / block);
  parallel::SharedCases blocks;
  blocks.count = as_good.size();
  blocks.work = [&](std::size_t k) {
    measurement::Random random(seed + k);
    MatrixX xi(columns, as_index(std::min(block, sets - k * block)));
    for (double& x : xi.reshaped()) x = random.normal();
    const MatrixX z = root * xi;
    as_good[k] = 0;
    for (const auto set : z.colwise()) {
      Eigen::Index at = 0;
      bool found = false;
      for (std::size_t i = 0; i < all.size() && !found; ++i) {
        found = gain(all[i], senses[i], set.segment(at, all[i].basis.cols())) >= wanted[i];
        at += all[i].basis.cols();
      }
      as_good[k] += found;
    }
  };
  blocks.result = [&](std::size_t k) { return parallel::pack(as_good[k]); };
  blocks.take = [&](std::size_t k, const std::string& bytes) { as_good[k] = parallel::unpack<int>(bytes); };
  const auto told = [&](std::size_t done) { counted(done, as_good.size()); };
  parallel::for_each_case(blocks, work.journal, 0, work.ranks, work.threads,
                          counted ? std::function<void(std::size_t)>(told) : nullptr);
  double chance = (std::accumulate(as_good.begin(), as_good.end(), 0.0) + 1) / (sets_drawn + 1.0);
  if (work.ranks) chance = parallel::unpack<double>(work.ranks->meet("", parallel::pack(chance)).said);
  return chance;
}

double least_p_value(const std::vector<Signature>& all, const std::vector<Candidate>& candidates) {
  double out = 1;
  const std::vector<double> weights = weights_of(all);
  for (std::size_t i = 0; i < all.size(); ++i)
    out = std::min(out, single_p_value(all[i], candidates[i].gain) / weights[i]);
  return out;
}

}  // namespace deflect::diagnosis
