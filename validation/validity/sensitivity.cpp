#include "validation/validity/sensitivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/parallel/cases.h"

namespace deflect::validity {
namespace {

using measurement::Measurements;

/// Groups by a key, named by it, in the order of their first readings.
Grouping by_key(const std::string& kind, const std::vector<std::string>& keys) {
  Grouping out{kind, {}, {}};
  std::map<std::string, std::size_t> known;
  for (const std::string& key : keys) {
    const auto [at, added] = known.emplace(key, out.names.size());
    if (added) out.names.push_back(key);
    out.group.push_back(at->second);
  }
  return out;
}

std::vector<std::string> labels_of(const Measurements& m) {
  std::vector<std::string> out;
  for (const measurement::Reading& r : m.readings) out.push_back(m.poses[r.pose].label);
  return out;
}

/// Channels of one kind are compared as they are: forces, moments, factors on load cases.
int kind_of(const measurement::LoadChannel& c) { return c.name.starts_with("load.") ? 2 : c.moment ? 1 : 0; }

/// The channel that is largest over the largest of its kind in the file, and its sense.
std::vector<std::string> directions_of(const Measurements& m) {
  const std::vector<measurement::LoadChannel> channels = measurement::load_channels(m);
  const MatrixX loads = measurement::loads_of(m);
  std::array<double, 3> largest_of = {1e-300, 1e-300, 1e-300};
  for (Eigen::Index i = 0; i < loads.rows(); ++i) {
    double& largest = nth(largest_of, kind_of(nth(channels, i)));
    largest = std::max(largest, loads.row(i).cwiseAbs().maxCoeff());
  }
  VectorX most(loads.rows());
  for (Eigen::Index i = 0; i < most.size(); ++i) most(i) = nth(largest_of, kind_of(nth(channels, i)));
  std::vector<std::string> out;
  for (Eigen::Index k = 0; k < loads.cols(); ++k) {
    Eigen::Index largest = 0;
    const double share = loads.col(k).cwiseAbs().cwiseQuotient(most).maxCoeff(&largest);
    out.push_back(share == 0 ? "no load"
                             : fmt::format("{} {} 0", nth(channels, largest).name, loads(largest, k) > 0 ? ">" : "<"));
  }
  return out;
}

std::vector<std::string> sizes_of(const Errors& e) {
  const compare::ResidualStudy& s = e.comparison().study;
  const VectorX predicted = statistics::rows_of(s.values, s.predicted);
  const measurement::Quantity quantity = compare::quantity_of_errors(s.values);
  std::vector<double> size;
  for (std::size_t i = 0; i < s.data->readings.size(); ++i)
    size.push_back(fit::size_of_prediction(s.values, predicted, i, quantity));
  std::vector<double> sorted = size;
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 3], high = sorted[2 * sorted.size() / 3];
  std::vector<std::string> out;
  for (const double each : size) out.push_back(each < low ? "small" : each < high ? "middle" : "large");
  return out;
}

std::vector<std::string> sessions_of(const Measurements& m) {
  for (std::size_t k = 0; k < m.note_columns.size(); ++k)
    for (const char* word : {"session", "day", "date"})
      if (m.note_columns[k].find(word) != std::string::npos) {
        std::vector<std::string> out;
        for (const measurement::Reading& r : m.readings) out.push_back(r.notes[k]);
        return out;
      }
  return {};
}

}  // namespace

std::vector<Grouping> groupings(const Errors& e) {
  const Measurements& m = *e.comparison().study.data;
  std::vector<Grouping> out;
  const auto add = [&](const char* kind, const std::vector<std::string>& keys) {
    Grouping g = by_key(kind, keys);
    if (g.names.size() > 1) out.push_back(std::move(g));
  };
  add("pose", labels_of(m));
  add("load direction", directions_of(m));
  add("load size", sizes_of(e));
  add("session", sessions_of(m));
  return out;
}

std::vector<WithoutGroup> leave_out(const Errors& e, const std::vector<Grouping>& all, int threads) {
  const bool verdict = agrees(e.agreement());
  std::vector<std::pair<const Grouping*, std::size_t>> cases;
  for (const Grouping& g : all)
    for (std::size_t i = 0; i < g.names.size() && g.kind != "load size"; ++i) cases.emplace_back(&g, i);
  std::vector<WithoutGroup> out(cases.size());
  parallel::for_each_case(cases.size(), 1, threads, [&](std::size_t i) {
    const auto& [grouping, own] = cases[i];
    std::vector<bool> without;
    for (const std::size_t g : grouping->group) without.push_back(g == own);
    WithoutGroup& w = out[i];
    w = {grouping->kind, grouping->names[own], 0, e.agreement(without), false};
    w.readings = as_size(std::count(without.begin(), without.end(), true));
    w.changes = agrees(w.agreement) != verdict;
  });
  return out;
}

std::vector<Sameness> same_everywhere(const Errors& e, const std::vector<Grouping>& all, const MatrixX& derivative,
                                      const std::vector<fit::FreeParameter>& parameters) {
  const std::vector<measurement::MeasuredValue>& values = e.comparison().study.values;
  const statistics::Regressions regressions(e.uncertainty(), e.residual(), derivative);
  std::vector<Sameness> out;
  for (std::size_t p = 0; p < parameters.size(); ++p)
    for (const Grouping& g : all) {
      MatrixX own = MatrixX::Zero(derivative.rows(), std::ssize(g.names) - 1);
      for (std::size_t i = 0; i < values.size(); ++i)
        if (const std::size_t group = g.group[values[i].reading]; group > 0)
          own(as_index(i), as_index(group - 1)) = derivative(as_index(i), as_index(p));
      const statistics::Regression r = regressions.on(own);
      if (r.freedoms > 0) out.push_back({parameters[p].path, g.kind, as_size(r.freedoms) + 1, r.p_value});
    }
  return out;
}

}  // namespace deflect::validity
