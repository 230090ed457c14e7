#include "validation/compare/contrasts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "msa/base/index.h"
#include "validation/compare/errors_by_group.h"
#include "validation/statistics/tail.h"

namespace deflect::compare {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Weights = std::vector<std::pair<std::size_t, double>>;  // reading, weight

constexpr std::size_t most_contrasts = 1200;

/// Contrasts whose noise is not independent lie in one block; blocks as small as they are.
std::vector<statistics::NoiseBlock> blocks_of(const MatrixX& noise) {
  std::vector<statistics::NoiseBlock> out;
  Eigen::Index first = 0, reaches = 0;  // the last contrast that those since `first` have to do with
  for (Eigen::Index i = 0; i < noise.rows(); ++i) {
    Eigen::Index last = noise.rows() - 1;
    while (last > i && noise(i, last) == 0) --last;
    reaches = std::max(reaches, last);
    if (reaches > i) continue;
    const Eigen::Index size = i + 1 - first;
    out.push_back({first, size, noise.block(first, first, size, size)});
    first = reaches = i + 1;
  }
  return out;
}

/// Of contrasts z at least as large, by chance. Directions whose variance is lost beside the others' (1e-9, each
/// contrast in its own deviation) do not count: where the noise alone is more than that there are none, for errors in
/// common only add to it; else all directions are looked at.
double chance_of(const VectorX& z, const statistics::Uncertainty::OfContrasts& of, const VectorX& deviation) {
  constexpr double lost = 1e-9;
  const std::vector<statistics::NoiseBlock> blocks = blocks_of(of.noise);
  const VectorX scale = deviation.cwiseInverse();
  const bool all_count = std::all_of(blocks.begin(), blocks.end(), [&](const statistics::NoiseBlock& b) {
    const VectorX own = scale.segment(b.first, b.size);
    const Eigen::SelfAdjointEigenSolver<MatrixX> axes(MatrixX(own.asDiagonal() * b.covariance * own.asDiagonal()),
                                                      Eigen::EigenvaluesOnly);
    return axes.eigenvalues()(0) > lost;
  });
  if (all_count)
    return statistics::chi_squared_tail(static_cast<double>(z.size()),
                                        statistics::Whitening(blocks, of.errors)(z).squaredNorm());
  const MatrixX errors = scale.asDiagonal() * of.errors.dense();
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(
      MatrixX(scale.asDiagonal() * of.noise * scale.asDiagonal() + errors * errors.transpose()));
  const VectorX along = axes.eigenvectors().transpose() * scale.cwiseProduct(z);
  double chi2 = 0;
  int freedoms = 0;
  for (Eigen::Index i = 0; i < along.size(); ++i)
    if (axes.eigenvalues()(i) > lost) {
      chi2 += along(i) * along(i) / axes.eigenvalues()(i);
      ++freedoms;
    }
  return statistics::chi_squared_tail(freedoms, chi2);
}

/// Contrasts of translations, or, where only rotations were read, of these: one row for each channel that all its
/// readings have. Channels 0 … 2 are the components at the tool point, the sensors follow.
class Contrasts {
 public:
  Contrasts(const ResidualStudy& s, const std::vector<bool>& set_aside) : aside_(set_aside) {
    quantity_ = quantity_of_errors(s.values);
    row_.assign(s.data->readings.size(), std::vector<Eigen::Index>(3 + s.data->instruments.sensors.size(), -1));
    for (std::size_t i = 0; i < s.values.size(); ++i) {
      const measurement::MeasuredValue& v = s.values[i];
      if (v.quantity == quantity_) row_[v.reading][v.of_tool_point() ? v.channel % 3 : v.channel - 3] = as_index(i);
    }
    columns_ = std::ssize(s.values);
  }

  bool rotations() const { return quantity_ == measurement::Quantity::angle; }

  void add(const Weights& w) {
    for (std::size_t k = 0; k < row_.front().size(); ++k) add_channel(w, k);
  }

  /// Weights by component: rows of a matrix that differ.
  void add(const std::vector<std::array<double, 3>>& by_component, const std::vector<std::size_t>& readings) {
    std::vector<std::pair<Eigen::Index, double>> row;
    for (std::size_t i = 0; i < readings.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (by_component[i][k] != 0) {
          if (!usable(readings[i], k)) return;
          row.emplace_back(row_[readings[i]][k], by_component[i][k]);
        }
    rows_.push_back(std::move(row));
  }

  bool usable(std::size_t reading, std::size_t component) const {
    return row_[reading][component] >= 0 && (aside_.empty() || !aside_[reading]);
  }

  ContrastTest judge(ContrastTest t, const statistics::Uncertainty& u, const VectorX& r) const {
    std::vector<std::vector<std::pair<Eigen::Index, double>>> rows = rows_;
    if (rows.size() > most_contrasts) {  // evenly over the plan
      std::vector<std::vector<std::pair<Eigen::Index, double>>> some;
      for (std::size_t i = 0; i < most_contrasts; ++i) some.push_back(rows[i * rows.size() / most_contrasts]);
      rows = std::move(some);
    }
    t.contrasts = rows.size();
    if (rows.empty()) return t;
    Sparse T(std::ssize(rows), columns_);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (const auto& [column, weight] : rows[i]) entries.emplace_back(as_index(i), column, weight);
    T.setFromTriplets(entries.begin(), entries.end());
    const VectorX z = T * r;
    const statistics::Uncertainty::OfContrasts of = u.of_contrasts(T);
    const VectorX variance = of.noise.diagonal() + of.errors.squared_row_norms();
    t.p_value = chance_of(z, of, variance.cwiseSqrt());
    t.size = std::sqrt(std::max(0.0, (z.squaredNorm() - variance.sum()) / static_cast<double>(z.size())));
    return t;
  }

 private:
  void add_channel(const Weights& w, std::size_t component) {
    std::vector<std::pair<Eigen::Index, double>> row;
    for (const auto& [reading, weight] : w) {
      if (!usable(reading, component)) return;
      row.emplace_back(row_[reading][component], weight);
    }
    rows_.push_back(std::move(row));
  }

  const std::vector<bool>& aside_;
  measurement::Quantity quantity_ = measurement::Quantity::length;
  std::vector<std::vector<Eigen::Index>> row_;
  Eigen::Index columns_ = 0;
  std::vector<std::vector<std::pair<Eigen::Index, double>>> rows_;
};

using Key = std::vector<long long>;

/// A load to 1e-9 N and Nm, so that equal ones meet.
Key key(const VectorX& F) {
  Key out;
  for (const double each : F) out.push_back(std::llround(1e9 * each));
  return out;
}

Weights mean(const std::vector<std::size_t>& readings, double weight) {
  Weights out;
  for (const std::size_t i : readings) out.emplace_back(i, weight / static_cast<double>(readings.size()));
  return out;
}

Weights operator+(Weights a, const Weights& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

using ByLoad = std::map<Key, std::vector<std::size_t>>;

ByLoad by_load(const ResidualStudy& s, const measurement::PoseGroup& group, const std::vector<bool>& aside) {
  ByLoad out;
  for (const std::size_t i : group.readings)
    if (aside.empty() || !aside[i]) out[key(s.loads.col(as_index(i)))].push_back(i);
  return out;
}

Key opposite(Key k) {
  for (long long& x : k) x = -x;
  return k;
}

void add_parity(Contrasts& c, const ByLoad& loads) {
  for (const auto& [load, readings] : loads) {
    const auto other = opposite(load);
    if (!(load < other)) continue;
    if (const auto found = loads.find(other); found != loads.end())
      c.add(mean(readings, 0.5) + mean(found->second, 0.5));
  }
}

/// Lines of loads: unit vector to readings of that sense, and their magnitudes.
void add_intercepts(Contrasts& c, const ResidualStudy& s, const ByLoad& loads) {
  std::map<Key, std::vector<std::pair<double, std::size_t>>> lines;
  for (const auto& [load, readings] : loads)
    for (const std::size_t i : readings) {
      const VectorX F = s.loads.col(as_index(i));
      if (F.isZero(0)) continue;
      lines[key(F / F.norm() * 1e-3)].emplace_back(F.norm(), i);
    }
  for (const auto& [direction, points] : lines) {
    double sum = 0, squares = 0;
    const auto n = static_cast<double>(points.size());
    for (const auto& [F, i] : points) sum += F, squares += F * F;
    const double spread = squares - sum * sum / n;
    if (!(spread > 1e-6 * squares)) continue;
    Weights w;  // of the intercept of a straight line: Σ w = 1, Σ w F = 0
    for (const auto& [F, i] : points) w.emplace_back(i, 1 / n - (F - sum / n) * (sum / n) / spread);
    c.add(w);
  }
}

/// Along the load: whether it was reached from below or from above (by its change since the reading before).
void add_hysteresis(Contrasts& c, const ResidualStudy& s, const measurement::PoseGroup& group, const ByLoad& loads) {
  std::vector<std::size_t> order = group.readings;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return s.data->readings[a].sequence < s.data->readings[b].sequence; });
  std::map<std::size_t, VectorX> change;
  VectorX before = VectorX::Zero(s.loads.rows());
  for (const std::size_t i : order) {
    change[i] = s.loads.col(as_index(i)) - before;
    before = s.loads.col(as_index(i));
  }
  for (const auto& [load, readings] : loads) {
    std::vector<std::size_t> up, down;
    const VectorX F = s.loads.col(as_index(readings.front()));
    for (const std::size_t i : readings) {
      double along = change[i].dot(F);
      if (F.isZero(0)) along = change[i].sum();
      if (std::abs(along) > 0) (along > 0 ? up : down).push_back(i);
    }
    if (!up.empty() && !down.empty()) c.add(mean(up, 1) + mean(down, -1));
  }
}

void add_drift(Contrasts& c, const ResidualStudy& s, const ByLoad& loads) {
  for (const auto& [load, readings] : loads) {
    std::vector<std::size_t> order = readings;
    if (order.size() < 2) continue;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return s.data->readings[a].sequence < s.data->readings[b].sequence;
    });
    const auto middle = order.begin() + as_index(order.size() / 2);
    c.add(mean({middle, order.end()}, 1) + mean({order.begin(), middle}, -1));
  }
}

/// The antisymmetric part of C in u = C f + c0, least squares over the pose's readings under forces alone; of rotations
/// under moments alone.
void add_reciprocity(Contrasts& c, const ResidualStudy& s, const measurement::PoseGroup& group) {
  std::vector<std::size_t> readings;
  const Eigen::Index own = c.rotations() ? 3 : 0, others = 3 - own;
  for (const std::size_t i : group.readings)
    if (s.data->readings[i].load.segment<3>(others).isZero(0) && c.usable(i, 0) && c.usable(i, 1) && c.usable(i, 2))
      readings.push_back(i);
  if (readings.size() < 4) return;
  MatrixX X(std::ssize(readings), 4);
  for (std::size_t i = 0; i < readings.size(); ++i)
    X.row(as_index(i)) << s.data->readings[readings[i]].load.segment<3>(own).transpose(), 0;
  const double force = X.norm() / std::sqrt(static_cast<double>(readings.size()));
  X.col(3).setConstant(force);
  const Eigen::ColPivHouseholderQR<MatrixX> qr(X);
  if (qr.rank() < 4) return;
  const MatrixX pseudo = qr.solve(MatrixX::Identity(X.rows(), X.rows()));  // C_kl = Σ_i pseudo(l, i) u_ik
  for (const auto& [k, l] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
    std::vector<std::array<double, 3>> weights(readings.size(), {0, 0, 0});
    for (std::size_t i = 0; i < readings.size(); ++i) {
      // In metres at the plan's force.
      weights[i][k] = 0.5 * force * pseudo(as_index(l), as_index(i));
      weights[i][l] = -0.5 * force * pseudo(as_index(k), as_index(i));
    }
    c.add(weights, readings);
  }
}

}  // namespace

std::vector<ContrastTest> contrast_tests(const ResidualStudy& s, const statistics::Uncertainty& u,
                                         const VectorX& residual, const std::vector<bool>& aside) {
  enum { parity, proportionality, hysteresis, zero, drift, reciprocity };
  std::vector<ContrastTest> tests = {
      {"parity", "is the misfit the same for a load and its opposite (even)?", 0, 0, 1, "pairs of opposite loads"},
      {"proportionality", "does the misfit begin away from zero?", 0, 0, 1, "two magnitudes of a load in one sense"},
      {"hysteresis", "does it depend on the way the load was reached?", 0, 0, 1,
       "a sequence with the same load reached from both sides"},
      {"zero return", "is something left without load?", 0, 0, 1, "readings at no load"},
      {"drift", "has a repeated reading changed?", 0, 0, 1, "a sequence with repeated loads"},
      {"reciprocity", "do forces and displacements answer each other alike?", 0, 0, 1,
       "forces in all directions at a pose"}};
  std::vector<Contrasts> contrasts(tests.size(), Contrasts(s, aside));
  for (const measurement::PoseGroup& group : s.data->poses) {
    const ByLoad loads = by_load(s, group, aside);
    add_parity(contrasts[parity], loads);
    add_intercepts(contrasts[proportionality], s, loads);
    if (s.sequence) {
      add_hysteresis(contrasts[hysteresis], s, group, loads);
      add_drift(contrasts[drift], s, loads);
    }
    if (const auto unloaded = loads.find(Key(as_size(s.loads.rows()))); unloaded != loads.end())
      for (const std::size_t i : unloaded->second) contrasts[zero].add(Weights{{i, 1}});
    if (s.standing->has_tool_point()) add_reciprocity(contrasts[reciprocity], s, group);
  }
  for (std::size_t i = 0; i < tests.size(); ++i) {
    tests[i] = contrasts[i].judge(std::move(tests[i]), u, residual);
    if (tests[i].contrasts > 0) tests[i].missing.clear();
  }
  return tests;
}

}  // namespace deflect::compare
