#include "validation/statistics/load_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "msa/base/index.h"
#include "msa/base/outcome.h"

namespace deflect::statistics {
namespace {

using measurement::Measurements;

/// p_c of readings with several loads: channels × loads.
using ByReading = std::map<std::size_t, MatrixX>;

constexpr double less = 0.01;  // by this share a load is changed for a difference

std::vector<VectorX> in_linear_geometry(const subject::Standing& standing, const Measurements& data) {
  prediction::PredictionOptions linear;
  linear.geometry = Geometry::linear;
  return standing.predict(data, linear, parallel::alone);
}

/// Each reading once more with less of each of its loads, all of them at once.
ByReading apart(const subject::Subject& s, const subject::Standing& standing, const Measurements& data,
                const std::vector<std::size_t>& several) {
  std::vector<std::size_t> rows;
  for (const std::size_t i : several)
    rows.insert(rows.end(), 1 + measurement::loads_of_row(data.readings[i]).size(), i);
  Measurements trial = measurement::repeated(data, rows);
  auto changed = trial.readings.begin();
  for (const std::size_t i : several) {
    ++changed;
    for (const std::size_t load : measurement::loads_of_row(data.readings[i]))
      measurement::scale_load(*changed++, load, 1 - less);
  }
  const std::vector<VectorX> read = in_linear_geometry(standing, s.placed(std::move(trial)));
  ByReading out;
  auto at = read.begin();
  for (const std::size_t i : several) {
    const VectorX& whole = *at++;
    MatrixX& columns = out[i];
    columns.resize(whole.size(), std::ssize(measurement::loads_of_row(data.readings[i])));
    for (auto column : columns.colwise()) column = (whole - *at++) / less;
  }
  return out;
}

/// Readings that depend on the loads before them: with less of each load in all of them.
ByReading in_sequence(const subject::Subject& s, const subject::Standing& standing, const Measurements& data,
                      const std::vector<std::size_t>& several) {
  const std::vector<VectorX> whole = in_linear_geometry(standing, data);
  std::map<std::size_t, std::vector<VectorX>> with_less;  // by load
  for (const std::size_t i : several)
    for (const std::size_t load : measurement::loads_of_row(data.readings[i])) with_less[load];
  for (auto& [load, read] : with_less) {
    Measurements trial = data;
    for (measurement::Reading& r : trial.readings) measurement::scale_load(r, load, 1 - less);
    read = in_linear_geometry(standing, s.placed(std::move(trial)));
  }
  ByReading out;
  for (const std::size_t i : several) {
    const std::vector<std::size_t> loads = measurement::loads_of_row(data.readings[i]);
    MatrixX& columns = out[i];
    columns.resize(whole[i].size(), std::ssize(loads));
    for (std::size_t c = 0; c < loads.size(); ++c)
      columns.col(as_index(c)) = (whole[i] - with_less.at(loads[c])[i]) / less;
  }
  return out;
}

/// What the columns leave of `whole`, by their sizes.
void share_rest(const VectorX& whole, MatrixX& columns) {
  for (Eigen::Index k = 0; k < whole.size(); ++k) {
    const double rest = whole(k) - columns.row(k).sum(), sizes = columns.row(k).cwiseAbs().sum();
    if (sizes > 0)
      columns.row(k) += (rest / sizes) * columns.row(k).cwiseAbs();
    else
      columns.row(k).setConstant(rest / static_cast<double>(columns.cols()));
  }
}

}  // namespace

LoadErrors::LoadErrors(double t, const std::vector<VectorX>& predicted) {
  for (const VectorX& each : predicted) columns_.emplace_back(t * each);
}

LoadErrors::LoadErrors(const subject::Subject& s, const subject::Standing& standing, const Measurements& data,
                       const std::vector<VectorX>& predicted)
    : LoadErrors(s.load_tolerance(), predicted) {
  std::vector<std::size_t> several;
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    if (measurement::loads_of_row(data.readings[i]).size() > 1) several.push_back(i);
  if (several.empty() || s.load_tolerance() == 0) return;
  // What stands in its deformed shape alone has no linear response: there all loads of a reading are off by one factor.
  auto parts = outcome_of([&] {
    return standing.has_history() ? in_sequence(s, standing, data, several) : apart(s, standing, data, several);
  });
  if (!parts) return;
  for (auto& [reading, columns] : *parts) {
    share_rest(predicted[reading], columns);
    columns_[reading] = s.load_tolerance() * columns;
  }
}

LoadErrors LoadErrors::with_play(const std::vector<MatrixX>& play) const {
  LoadErrors out = *this;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Eigen::Index loads = columns_[i].cols() - (play_.empty() ? 0 : play_[i].cols());
    const Eigen::Index more = play.empty() ? 0 : play[i].cols();
    out.columns_[i].conservativeResize(Eigen::NoChange, loads + more);
    if (more > 0) out.columns_[i].rightCols(more) = play[i];
  }
  out.play_ = play;
  return out;
}

std::size_t LoadErrors::readings_in_play() const {
  return as_size(std::count_if(play_.begin(), play_.end(), [](const MatrixX& each) { return each.cols() > 0; }));
}

double LoadErrors::deviation(const measurement::MeasuredValue& v) const {
  return columns_[v.reading].row(as_index(v.channel)).norm();
}

VectorX LoadErrors::deviations(const std::vector<measurement::MeasuredValue>& values) const {
  VectorX out(std::ssize(values));
  for (std::size_t i = 0; i < values.size(); ++i) out(as_index(i)) = deviation(values[i]);
  return out;
}

double noise_beside_loads(double scatter, double mean_square) {
  constexpr double least_share = 0.1;
  const double square = scatter * scatter;
  return std::sqrt(std::max(square - mean_square, least_share * square));
}

void take_off_load_errors(std::vector<measurement::MeasuredValue>& values, const LoadErrors& errors,
                          const measurement::Measurements& data) {
  std::vector<bool> repeated(data.readings.size());
  for (const std::vector<std::size_t>& group : measurement::replicates(data))
    for (const std::size_t i : group) repeated[i] = true;
  // T's components of one quantity have one σ, each sensor its own.
  const auto source = [](const measurement::MeasuredValue& v) {
    return std::pair(v.quantity, v.of_tool_point() ? 0 : v.channel);
  };
  std::map<std::pair<measurement::Quantity, std::size_t>, std::pair<double, double>> sums;
  for (const measurement::MeasuredValue& v : values) {
    if (!v.by_replicates || !repeated[v.reading]) continue;
    const double l = errors.deviation(v);
    sums[source(v)].first += l * l, sums[source(v)].second += 1;
  }
  for (measurement::MeasuredValue& v : values)
    if (const auto sum = sums.find(source(v)); v.by_replicates && sum != sums.end())
      v.sigma = noise_beside_loads(*v.sigma, sum->second.first / sum->second.second);
}

}  // namespace deflect::statistics
