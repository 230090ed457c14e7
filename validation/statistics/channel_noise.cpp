#include "validation/statistics/channel_noise.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "msa/base/index.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/load_errors.h"

namespace deflect::statistics {
namespace {

constexpr double fewest_left = 10;   // freedoms of all, for a scatter to within a quarter of itself
constexpr double fewest_of_one = 3;  // of one channel
constexpr int most_rounds = 50;
constexpr double stays = 0.005;  // relative, of σ
constexpr double rounding = 1e-12;

/// Numbers of one σ, as Qᵀ [G, r] where that is smaller.
struct Channel {
  Channel(MatrixX G, VectorX r, double sigma_told) : n(std::ssize(r)), sigma(sigma_told), told(sigma_told > 0) {
    if (G.rows() <= G.cols()) {
      columns = std::move(G), residual = std::move(r);
      return;
    }
    const Eigen::HouseholderQR<MatrixX> qr(G);
    r.applyOnTheLeft(qr.householderQ().transpose());
    columns = qr.matrixQR().topRows(G.cols()).triangularView<Eigen::Upper>();
    residual = r.head(G.cols());
    beyond = r.tail(n - G.cols()).squaredNorm();
  }

  Eigen::Index n = 0;
  MatrixX columns;
  VectorX residual;
  double beyond = 0;  // square of what no column reaches
  double sigma = 0, least = 0;
  bool told = false;
};

/// The channels' freedoms after σ was estimated anew; `change`: of σ, the largest.
struct Round {
  std::vector<double> freedoms;
  double change = 0;
};

Round estimate(std::vector<Channel>& channels) {
  Eigen::Index rows = 0;
  for (const Channel& c : channels) rows += c.columns.rows();
  MatrixX G(rows, channels.front().columns.cols());
  VectorX r(rows);
  rows = 0;
  for (const Channel& c : channels) {
    G.middleRows(rows, c.columns.rows()) = c.columns / c.sigma;
    r.segment(rows, c.columns.rows()) = c.residual / c.sigma;
    rows += c.columns.rows();
  }
  for (Eigen::Index k = 0; k < G.cols(); ++k) G.col(k).normalize();  // patterns have any unit
  const MatrixX Q = orthonormal(G);
  const VectorX left = r - Q * (Q.transpose() * r);
  Round out;
  rows = 0;
  for (Channel& c : channels) {
    const auto size = c.columns.rows();
    const double freedoms = static_cast<double>(c.n) - Q.middleRows(rows, size).squaredNorm();
    out.freedoms.push_back(std::max(0.0, freedoms));
    if (!c.told) {
      const double square = left.segment(rows, size).squaredNorm() + c.beyond / (c.sigma * c.sigma);
      const double sigma = std::max(c.least, c.sigma * std::sqrt(square / std::max(1e-3, freedoms)));
      out.change = std::max(out.change, std::abs(sigma / c.sigma - 1));
      c.sigma = sigma;
    }
    rows += size;
  }
  return out;
}

/// Numbers without a σ, by quantity and channel; 0: those of the quantity that share one.
using Members = std::map<std::pair<measurement::Quantity, std::size_t>, std::vector<Eigen::Index>>;

/// Estimates σ by member; returns the freedoms.
std::vector<double> estimate(const Members& members, const Channel& known, const MatrixX& G, const VectorX& r,
                             const VectorX& of_loads, const LargestNumbers& largest, std::vector<double>& sigma) {
  std::vector<Channel> channels;
  for (const auto& [key, rows] : members) {
    channels.emplace_back(G(rows, Eigen::all), r(rows), 0);
    Channel& c = channels.back();
    c.least = rounding * std::max(1.0, largest.at(key.first));
    c.sigma = std::max(c.least, std::sqrt(r(rows).squaredNorm() / static_cast<double>(c.n)));
  }
  channels.push_back(known);
  Round last;
  for (int round = 0; round < most_rounds; ++round)
    if (last = estimate(channels); last.change < stays) break;
  std::size_t k = 0;
  for (const auto& [key, rows] : members) {
    const double left = last.freedoms[k] - 2, of = left > 0 ? std::sqrt(last.freedoms[k] / left) : 1;
    const double noise = noise_beside_loads(of * channels[k].sigma, of_loads(rows).mean());
    for (const Eigen::Index i : rows) nth(sigma, i) = std::max(channels[k].least, noise);
    ++k;
  }
  last.freedoms.pop_back();
  return last.freedoms;
}

bool too_few(double freedoms) { return freedoms < fewest_of_one; }

/// Where a channel has too few freedoms, all of its quantity share one σ; whether there was such.
bool share(Members& members, const std::vector<double>& freedoms) {
  std::set<measurement::Quantity> few;
  std::size_t k = 0;
  for (const auto& [key, rows] : members)
    if (too_few(freedoms[k++]) && key.second > 0) few.insert(key.first);
  Members out;
  for (const auto& [key, rows] : members) {
    std::vector<Eigen::Index>& all = out[{key.first, few.contains(key.first) ? 0 : key.second}];
    all.insert(all.end(), rows.begin(), rows.end());
  }
  members = std::move(out);
  return !few.empty();
}

}  // namespace

std::optional<std::vector<double>> channel_noise(const std::vector<measurement::MeasuredValue>& values,
                                                 const std::vector<std::optional<double>>& told,
                                                 const VectorX& residual, const MatrixX& patterns,
                                                 const PartedColumns& A, const VectorX& of_loads,
                                                 LargestNumbers largest) {
  const MatrixX G = side_by_side({patterns, A.shared}, residual.size());
  std::vector<double> sigma(values.size());
  Members members;
  std::vector<Eigen::Index> known;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const measurement::MeasuredValue& v = values[i];
    double& most = largest[v.quantity];
    most = std::max(most, std::abs(v.value));
    if (told[i]) {
      sigma[i] = *told[i];
      known.push_back(as_index(i));
    } else {
      members[{v.quantity, v.of_tool_point() ? 0 : v.channel}].push_back(as_index(i));
    }
  }
  if (members.empty()) return sigma;
  // Tolerances are numbers that were read as 0, too.
  const auto n = std::ssize(known), tolerances = A.shared.cols();
  MatrixX of_known = MatrixX::Zero(n + tolerances, G.cols());
  VectorX known_residual = VectorX::Zero(n + tolerances);
  for (Eigen::Index k = 0; k < n; ++k) {
    of_known.row(k) = G.row(nth(known, k)) / sigma[as_size(nth(known, k))];
    known_residual(k) = residual(nth(known, k)) / sigma[as_size(nth(known, k))];
  }
  of_known.bottomRightCorner(tolerances, tolerances).setIdentity();
  const Channel known_channel(std::move(of_known), std::move(known_residual), 1);
  std::vector<double> freedoms;
  do {
    freedoms = estimate(members, known_channel, G, residual, of_loads, largest, sigma);
  } while (share(members, freedoms));
  if (std::any_of(freedoms.begin(), freedoms.end(), too_few) ||
      std::accumulate(freedoms.begin(), freedoms.end(), 0.0) < fewest_left)
    return std::nullopt;
  return sigma;
}

}  // namespace deflect::statistics
