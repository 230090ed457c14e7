#include "validation/compare/patterns.h"
#include "msa/base/index.h"
#include "validation/statistics/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace deflect::compare {
namespace {

using Block = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A pattern as displacements of T.
struct ToolPattern {
  PatternId id;
  std::vector<std::string> columns;
  std::string unit;
  Columns by_reading;
};

constexpr PatternRow pattern_rows[] = {
    {PatternId::elastic, "elastic", "a compliance is missing, alike everywhere"},
    {PatternId::elastic_by_site, "elastic by site", "a compliance is missing, not alike"},
    {PatternId::step, "step", "free travel, whatever the force"},
    {PatternId::power, "power", "contact that stiffens under load"},
    {PatternId::one_sided, "one-sided", "gives in one sense only"},
    {PatternId::hysteresis, "hysteresis", "lags behind the load: friction"},
    {PatternId::base_tilt, "base tilt", "the whole machine tilts on its base"},
    {PatternId::tool, "tool", "the tool yields on its platform"},
    {PatternId::weight, "weight", "a constant load pulls downwards"},
    {PatternId::offset, "offset", "every reading is displaced alike"},
    {PatternId::drift, "drift", "readings drift with time"},
    {PatternId::temperature, "temperature", "readings follow the temperature"},
    {PatternId::load_gain, "load gain", "loads are recorded with a wrong factor"},
    {PatternId::load_axes, "load axes", "loads are recorded in turned axes"},
    {PatternId::sensor_axes, "sensor axes", "displacements are recorded in turned axes"},
    {PatternId::sensor_gain, "sensor gain", "a sensor reads with a wrong factor"},
    {PatternId::elastic_at, "elastic at", "a compliance is missing at one site"},
    {PatternId::elastic_along_slides, "elastic along slides", "a compliance is missing along slides"},
    {PatternId::elastic_across_slides, "elastic across slides", "a compliance is missing across slides"},
};
constexpr bool in_order() {
  for (std::size_t i = 0; i < std::size(pattern_rows); ++i)
    if (static_cast<std::size_t>(pattern_rows[i].id) != i) return false;
  return true;
}
static_assert(in_order() && std::size(pattern_rows) == static_cast<std::size_t>(PatternId::elastic_across_slides) + 1);

const std::vector<std::string> axes = {"x", "y", "z"};

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Columns of a reading, made one by one.
Columns by_reading(const ResidualStudy& s, const std::function<Block(std::size_t)>& make) {
  Columns out;
  out.reserve(s.data->readings.size());
  for (std::size_t i = 0; i < s.data->readings.size(); ++i) out.push_back(make(i));
  return out;
}

const Vector6& load(const ResidualStudy& s, std::size_t reading) { return s.data->readings[reading].load; }

/// Columns d_k = Rotation by a unit of axis k of the six-vector v, then M.
Block turned(const Matrix6& M, const Vector6& v) {
  Block out(6, 3);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Matrix3 S = skew(Vector3::Unit(k));
    Vector6 d;
    d << S * v.head<3>(), S * v.tail<3>();
    out.col(k) = M * d;
  }
  return out;
}

Block translations(double size) {
  Block out = Block::Zero(6, 3);
  out.topRows<3>() = size * Matrix3::Identity();
  return out;
}

/// Rank in the sequence over N, about its middle.
std::vector<double> ranks(const measurement::Measurements& m) {
  std::vector<double> out(m.readings.size());
  const std::vector<std::size_t> order = measurement::in_sequence(m, "drift");
  for (std::size_t i = 0; i < order.size(); ++i)
    out[order[i]] = (static_cast<double>(i) + 0.5) / static_cast<double>(order.size()) - 0.5;
  return out;
}

ToolPattern base_tilt(const ResidualStudy& s) {
  return {PatternId::base_tilt, {"rx", "ry"}, "rad/Nm", by_reading(s, [&](std::size_t i) {
            const std::size_t pose = s.data->readings[i].pose;
            const subject::BodyFrame base = s.standing->base(pose);
            const Vector3 arm = s.standing->tool(pose).p_W - base.p_W;
            Block out(6, 2);
            for (std::size_t k = 0; k < 2; ++k) {
              Vector6 t;
              const Vector3 axis = base.R_W.col(as_index(k));
              t << axis.cross(arm), axis;
              out.col(as_index(k)) = t * t.dot(load(s, i));
            }
            return out;
          })};
}

ToolPattern tool(const ResidualStudy& s) {
  return {PatternId::tool, axes, "m/N", by_reading(s, [&](std::size_t i) {
            const Matrix3 R = s.standing->tool(s.data->readings[i].pose).R_W;
            Block out = Block::Zero(6, 3);
            for (Eigen::Index k = 0; k < 3; ++k) out.col(k).head<3>() = R.col(k) * R.col(k).dot(load(s, i).head<3>());
            return out;
          })};
}

constexpr double stops[] = {0.02, 0.05, 0.1, 0.2, 0.4};  // of the largest force

/// What an element beside each site takes over: by reading, sites × stops.
std::vector<MatrixX> stop_forces(const ResidualStudy& s) {
  double most = 0;
  for (const VectorX& f : s.force) most = std::max(most, f.size() > 0 ? f.cwiseAbs().maxCoeff() : 0);
  std::vector<MatrixX> out(s.force.size());
  for (const measurement::PoseGroup& group : s.data->poses) {
    std::vector<std::size_t> order = group.readings;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return s.data->readings[a].sequence < s.data->readings[b].sequence;
    });
    VectorX before = VectorX::Zero(s.force[order.front()].size());
    MatrixX state = MatrixX::Zero(before.size(), std::ssize(stops));
    for (const std::size_t i : order) {
      for (Eigen::Index r = 0; r < state.cols(); ++r) {
        const double limit = stops[r] * most;
        state.col(r) = (state.col(r) + s.force[i] - before).cwiseMax(-limit).cwiseMin(limit);
      }
      before = s.force[i];
      out[i] = state;
    }
  }
  return out;
}

ToolPattern hysteresis(const ResidualStudy& s, bool rotation) {
  ToolPattern p{PatternId::hysteresis,
                {"lag"},
                rotation ? "rad" : "m",
                site_column(s, [&](std::size_t i, std::size_t k) { return -s.heading[i](as_index(k)); })};
  if (s.sites.front().front().s.isZero(0)) return p;
  const std::vector<MatrixX> stopped = stop_forces(s);
  for (const double r : stops) p.columns.push_back("stop at " + std::to_string(static_cast<int>(100 * r)) + " %");
  for (std::size_t i = 0; i < p.by_reading.size(); ++i) {
    const std::size_t pose = s.data->readings[i].pose;
    Block moved = Block::Zero(6, std::ssize(stops));
    for (std::size_t k = 0; k < s.sites[pose].size(); ++k)
      moved -= (s.compliance[pose] * s.sites[pose][k].s) * stopped[i].row(as_index(k));
    Block both(6, 1 + moved.cols());
    both << p.by_reading[i], moved;
    p.by_reading[i] = both;
  }
  return p;
}

}  // namespace

const PatternRow& row_of(PatternId id) { return nth(pattern_rows, id); }

Columns site_column(const ResidualStudy& s, const std::function<double(std::size_t, std::size_t)>& elongation) {
  return by_reading(s, [&](std::size_t i) {
    const std::vector<subject::Site>& sites = s.sites[s.data->readings[i].pose];
    Block out = Block::Zero(6, 1);
    for (std::size_t k = 0; k < sites.size(); ++k) out.col(0) += sites[k].g * elongation(i, k);
    return out;
  });
}

VectorX rows_of_sites(const ResidualStudy& s, const std::function<double(std::size_t, std::size_t)>& elongation) {
  VectorX out(std::ssize(s.values));
  Vector6 moved;
  for (std::size_t n = 0; n < s.values.size(); ++n) {
    const std::size_t i = s.values[n].reading;
    if (n == 0 || i != s.values[n - 1].reading) {
      const std::vector<subject::Site>& sites = s.sites[s.data->readings[i].pose];
      moved.setZero();
      for (std::size_t k = 0; k < sites.size(); ++k) moved += sites[k].g * elongation(i, k);
    }
    out(as_index(n)) = s.values[n].form.dot(moved);
  }
  return out;
}

Columns site_columns(const ResidualStudy& s, const std::function<double(std::size_t, std::size_t)>& elongation) {
  return by_reading(s, [&](std::size_t i) {
    const std::vector<subject::Site>& sites = s.sites[s.data->readings[i].pose];
    Block out(6, std::ssize(sites));
    for (std::size_t k = 0; k < sites.size(); ++k) out.col(as_index(k)) = sites[k].g * elongation(i, k);
    return out;
  });
}

namespace {

std::vector<ToolPattern> tool_patterns(const ResidualStudy& s) {
  std::vector<ToolPattern> out;
  const auto& sites = s.sites.front();
  const auto f = [&](std::size_t i, std::size_t k) { return s.force[i](as_index(k)); };
  std::vector<std::string> names;
  for (const subject::Site& site : sites) names.push_back(site.name);
  const bool alike = !sites.empty() && std::all_of(sites.begin(), sites.end(), [&](const subject::Site& x) {
    return x.rotation == sites[0].rotation;
  });
  const std::string per_force = alike && sites[0].rotation ? "rad/Nm" : "m/N";
  const bool rotation = alike && sites[0].rotation;
  if (alike) {
    out.push_back({PatternId::elastic, {"all"}, per_force, site_column(s, f)});
    if (names.size() > 1) out.push_back({PatternId::elastic_by_site, names, per_force, site_columns(s, f)});
    out.push_back({PatternId::step, {"all"}, rotation ? "rad" : "m", site_column(s, [&](std::size_t i, std::size_t k) {
                     return sign(f(i, k));
                   })});
    out.push_back({PatternId::power,
                   {"all"},
                   rotation ? "rad/Nm^2/3" : "m/N^2/3",
                   site_column(s, [&](std::size_t i, std::size_t k) {
                     return sign(f(i, k)) * std::pow(std::abs(f(i, k)), 2.0 / 3);
                   })});
    out.push_back({PatternId::one_sided, {"all"}, per_force, site_column(s, [&](std::size_t i, std::size_t k) {
                     return std::abs(f(i, k));
                   })});
    if (s.sequence) out.push_back(hysteresis(s, rotation));
  }
  out.push_back(base_tilt(s));
  out.push_back(tool(s));
  out.push_back({PatternId::weight, {"-z"}, "N", by_reading(s, [&](std::size_t i) {
                   return Block(-s.compliance[s.data->readings[i].pose].col(2));
                 })});
  out.push_back({PatternId::offset, axes, "m", by_reading(s, [&](std::size_t) { return translations(1); })});
  if (s.sequence) {
    const std::vector<double> rank = ranks(*s.data);
    out.push_back({PatternId::drift, axes, "m", by_reading(s, [&](std::size_t i) { return translations(rank[i]); })});
  }
  if (s.data->temperature_recorded)
    out.push_back({PatternId::temperature, axes, "m/K",
                   by_reading(s, [&](std::size_t i) { return translations(s.data->readings[i].temperature_C - 20); })});
  out.push_back({PatternId::load_gain, {"gain"}, "1", by_reading(s, [&](std::size_t i) {
                   return Block(s.predicted[i].head<6>());
                 })});
  out.push_back({PatternId::load_axes, axes, "rad", by_reading(s, [&](std::size_t i) {
                   return turned(s.compliance[s.data->readings[i].pose], load(s, i));
                 })});
  out.push_back({PatternId::sensor_axes, axes, "rad",
                 by_reading(s, [&](std::size_t i) { return turned(Matrix6::Identity(), s.predicted[i].head<6>()); })});
  return out;
}

/// One column for each channel that was read: what `value` gives for a number of it.
Pattern by_channel(const ResidualStudy& s, PatternId id, const std::string& unit,
                   const std::function<double(const measurement::MeasuredValue&)>& value) {
  Pattern p{id, {}, unit, {}};
  std::vector<Eigen::Index> column(6 + s.data->instruments.sensors.size(), -1);
  for (const measurement::MeasuredValue& v : s.values)
    if (Eigen::Index& k = column[v.channel]; k < 0) {
      k = std::ssize(p.columns);
      p.columns.push_back(measurement::channel_name(*s.data, v.channel));
    }
  p.rows = MatrixX::Zero(std::ssize(s.values), std::ssize(p.columns));
  for (std::size_t i = 0; i < s.values.size(); ++i)
    p.rows(as_index(i), column[s.values[i].channel]) = value(s.values[i]);
  return p;
}

std::vector<Pattern> channel_patterns(const ResidualStudy& s) {
  std::vector<Pattern> out;
  const auto predicted = [&](const measurement::MeasuredValue& v) {
    return s.predicted[v.reading](as_index(v.channel));
  };
  out.push_back(by_channel(s, PatternId::offset, "SI", [](const auto&) { return 1; }));
  if (s.sequence)
    out.push_back(
        by_channel(s, PatternId::drift, "SI", [rank = ranks(*s.data)](const auto& v) { return rank[v.reading]; }));
  if (s.data->temperature_recorded)
    out.push_back(by_channel(s, PatternId::temperature, "SI/K",
                             [&](const auto& v) { return s.data->readings[v.reading].temperature_C - 20; }));
  out.push_back({PatternId::load_gain, {"gain"}, "1", statistics::rows_of(s.values, s.predicted)});
  out.push_back(by_channel(s, PatternId::sensor_gain, "1", predicted));
  return out;
}

}  // namespace

std::vector<Pattern> patterns_of(const ResidualStudy& s) {
  if (!s.standing->has_tool_point()) return channel_patterns(s);
  std::vector<Pattern> out;
  for (ToolPattern& p : tool_patterns(s))
    out.push_back({p.id, std::move(p.columns), std::move(p.unit), statistics::rows_of(s.values, p.by_reading)});
  return out;
}

MatrixX linear_answers(const ResidualStudy& s) {
  const Eigen::Index channels = 6 + std::ssize(s.data->instruments.sensors);
  MatrixX all = MatrixX::Zero(std::ssize(s.values), channels * s.loads.rows());
  for (std::size_t i = 0; i < s.values.size(); ++i)
    for (Eigen::Index load = 0; load < s.loads.rows(); ++load)
      all(as_index(i), load * channels + as_index(s.values[i].channel)) = s.loads(load, as_index(s.values[i].reading));
  constexpr Eigen::Index fewest_rows = 4;  // under a load, for its own share in a channel
  std::vector<Eigen::Index> known;
  for (Eigen::Index k = 0; k < all.cols(); ++k)
    if ((all.col(k).array() != 0).count() >= fewest_rows) known.push_back(k);
  return all(Eigen::all, known);
}

}  // namespace deflect::compare
