#include "validation/compare/file_oddities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "msa/base/index.h"
#include "validation/measurement/column_names.h"

namespace deflect::compare {
namespace {

constexpr std::size_t least_numbers = 10;       // of which a verdict can be made
constexpr double sigma_out_of_scale = 50;       // between σ as stated and as seen
constexpr std::size_t replicates_to_trust = 5;  // degrees of freedom
constexpr std::size_t least_of_standstill = 6;  // readings
constexpr double far_beyond = 10;               // of expected deviations
constexpr const char* measured_names[] = {"ux_mm", "uy_mm", "uz_mm", "thx_rad", "thy_rad", "thz_rad"};

std::string size_words(double value, measurement::Quantity q) {
  return fmt::format("{:.3g} {}", measurement::row_of(q).fine_per_SI * value, measurement::row_of(q).fine);
}

bool temperature_varies(const measurement::Measurements& data) {
  return data.temperature_recorded &&
         std::any_of(data.readings.begin(), data.readings.end(), [&](const measurement::Reading& r) {
           return r.temperature_C != data.readings.front().temperature_C;
         });
}

/// Root mean squares by channel of what was measured, of what is predicted there, and how many there are.
struct ByChannel {
  std::vector<double> measured, predicted, sigma;
  std::vector<std::size_t> count;
  std::vector<measurement::Quantity> quantity;

  explicit ByChannel(const Comparison& c)
      : measured(6 + c.study.data->instruments.sensors.size(), 0),
        predicted(measured),
        sigma(measured),
        count(measured.size(), 0),
        quantity(measured.size(), measurement::Quantity::length) {
    for (std::size_t i = 0; i < c.study.values.size(); ++i) {
      const measurement::MeasuredValue& v = c.study.values[i];
      const double p = c.study.predicted[v.reading](as_index(v.channel));
      measured[v.channel] += v.value * v.value;
      predicted[v.channel] += p * p;
      sigma[v.channel] += c.sigma[i] * c.sigma[i];
      quantity[v.channel] = v.quantity;
      ++count[v.channel];
    }
    for (std::size_t k = 0; k < count.size(); ++k)
      for (auto* sum : {&measured, &predicted, &sigma})
        (*sum)[k] = std::sqrt((*sum)[k] / static_cast<double>(std::max<std::size_t>(1, count[k])));
  }
};

double recorded_value(const Comparison& c, const measurement::MeasuredValue& v) {
  const measurement::Reading& r = c.study.data->readings[v.reading];
  return v.channel < 6 ? v.value : r.sensors[v.channel - 6].value_or(v.value);
}

std::string column_of(const measurement::Measurements& data, std::size_t channel) {
  return channel < 6 ? measured_names[channel] : measurement::sensor_column(data.instruments.sensors[channel - 6]);
}

void add_empty_ones(const Comparison& c, std::vector<RecordingMistake>& out) {
  const measurement::Measurements& data = *c.study.data;
  const ByChannel by(c);
  const bool measured = std::any_of(c.study.values.begin(), c.study.values.end(),
                                    [](const measurement::MeasuredValue& v) { return v.value != 0; });
  const bool loaded = !c.study.loads.isZero(0);
  if (!loaded && !temperature_varies(data))
    out.push_back({{"nothing_loaded"},
                   "nothing was loaded: every load is 0 in all readings, and the stiffness of a machine shows under "
                   "load only"});
  if (!measured) {
    out.push_back(
        {{"nothing_measured"},
         fmt::format("nothing was measured: every reading is 0, where {} rms are predicted; leave the "
                     "cells empty that were not measured",
                     size_words(rms_of_errors(c.study.values, statistics::rows_of(c.study.values, c.study.predicted)),
                                quantity_of_errors(c.study.values)))});
    return;
  }
  for (std::size_t k = 0; k < by.count.size(); ++k)
    if (by.count[k] >= least_numbers && by.measured[k] == 0 && by.predicted[k] > 5 * by.sigma[k])
      out.push_back(
          {{fmt::format("zero_column_{}", column_of(data, k))},
           fmt::format("{} is 0 in every reading, where {} rms are predicted: was its sensor connected? Leave "
                       "the column away if it was not measured",
                       column_of(data, k), size_words(by.predicted[k], by.quantity[k]))});
}

/// Readings one after the other in which a channel has the same number.
struct Standstill {
  std::size_t first = 0, last = 0, count = 0;  // readings
  double moves = 0, deviation = 0;             // of what is predicted there, and the largest expected deviation
};

/// The longest one of a channel through which the prediction moves by far more than noise and tolerances.
std::optional<Standstill> standstill(const Comparison& c, std::size_t channel, const VectorX& deviation) {
  std::optional<Standstill> longest;
  Standstill now;
  double value = 0, low = 0, high = 0;
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    if (v.channel != channel) continue;
    const double p = c.study.predicted[v.reading](as_index(channel)), recorded = recorded_value(c, v);
    if (now.count == 0 || recorded != value) now = {v.reading, v.reading, 0, 0, 0}, value = recorded, low = high = p;
    low = std::min(low, p), high = std::max(high, p);
    now.last = v.reading, now.moves = high - low, ++now.count;
    now.deviation = std::max(now.deviation, deviation(as_index(i)));
    if (now.moves > far_beyond * now.deviation && (!longest || now.count > longest->count)) longest = now;
  }
  return longest;
}

/// Columns of zeros are told as such.
void add_stuck_ones(const Comparison& c, std::vector<RecordingMistake>& out) {
  const measurement::Measurements& data = *c.study.data;
  const ByChannel by(c);
  const VectorX deviation = expected_deviations(c);
  for (std::size_t k = 6; k < by.count.size(); ++k) {
    if (by.measured[k] == 0) continue;
    const std::optional<Standstill> stuck = standstill(c, k, deviation);
    if (!stuck || stuck->count < least_of_standstill) continue;
    out.push_back({{fmt::format("stuck_{}", column_of(data, k))},
                   fmt::format("{} stands still in {} readings, from line {} to line {}, where it should move by {}: "
                               "did its sensor stick, or was it at the end of its travel? Leave the cells empty in "
                               "which it did not measure",
                               column_of(data, k), stuck->count, data.readings[stuck->first].line,
                               data.readings[stuck->last].line, size_words(stuck->moves, by.quantity[k]))});
  }
}

/// Whether readings are written more finely than they scatter, so that chance does not make them alike: most of them
/// are no multiples of the power of ten below σ.
bool finely_written(const Comparison& c) {
  double fine = 0;
  for (const measurement::MeasuredValue& v : c.study.values) {
    const double unit = measurement::row_of(v.quantity).per_SI;
    const double scatter = unit * v.sigma.value_or(1e-3 * (c.all.measured > 0 ? c.all.measured : 1));
    const double steps = std::abs(unit * v.value) / std::pow(10, std::floor(std::log10(scatter)));
    if (std::abs(steps - std::round(steps)) > 1e-6 * std::max(1.0, steps)) ++fine;
  }
  return fine > 0.5 * static_cast<double>(c.study.values.size());
}

void add_identical_rows(const Comparison& c, std::vector<RecordingMistake>& out) {
  const measurement::Measurements& data = *c.study.data;
  if (c.study.sequence) return;
  using Row = std::tuple<std::size_t, std::vector<double>, std::array<std::optional<double>, 6>,
                         std::vector<std::optional<double>>, double>;
  std::map<Row, std::size_t> first;  // line
  std::size_t copies = 0, line = 0, of = 0;
  for (std::size_t i = 0; i < data.readings.size(); ++i) {
    const measurement::Reading& r = data.readings[i];
    const auto column = c.study.loads.col(as_index(i));
    const std::vector<double> load(column.begin(), column.end());
    const auto [same, is_new] = first.emplace(Row{r.pose, load, r.displacement, r.sensors, r.temperature_C}, r.line);
    if (is_new) continue;
    if (++copies == 1) line = r.line, of = same->second;
  }
  if (copies < 3 || 20 * copies < data.readings.size() || !finely_written(c)) return;
  out.push_back({{"identical_rows"},
                 fmt::format("{} rows are identical copies of others (line {} of line {} first): a reading that stands "
                             "twice is not two readings; remove the copies, or number the readings in a column "
                             "sequence if they were taken",
                             copies, line, of)});
}

/// A number that was read more than once, with its σ; that of a sensor with what errors of the load do to it.
struct Replicate {
  double value, sigma;
  std::size_t line;
};

std::optional<Replicate> replicate_of(const Comparison& c, std::size_t reading, std::size_t channel) {
  const measurement::Measurements& data = *c.study.data;
  const measurement::Reading& r = data.readings[reading];
  const std::optional<double>& value = channel < 6 ? r.displacement[channel] : r.sensors[channel - 6];
  const std::optional<double>& sigma = channel < 6 ? r.sigma_u : data.instruments.sensors[channel - 6].sigma;
  if (!value || !sigma) return std::nullopt;
  const auto of_loads = c.study.load_errors.of(reading).row(as_index(channel));
  double load = c.study.subject->load_tolerance() * *value;
  if (of_loads.size() > 1) load = std::max(std::abs(load), of_loads.norm());
  return Replicate{*value, std::hypot(*sigma, load), r.line};
}

/// "in µm" where σ is as many times what it should be.
std::string sigma_unit_words(double factor, bool rotation) {
  struct Unit {
    double factor;
    const char* words;
  };
  static const Unit lengths[] = {{1e3, "in µm"}, {1e6, "in nm"}, {1e-3, "in m"}, {1 / 25.4, "in inches"}};
  static const Unit angles[] = {{1e3, "in mrad"}, {1e6, "in µrad"}, {180 / pi, "in degrees"}};
  const auto near = [&](const Unit& u) { return std::abs(std::log(factor / u.factor)) < std::log(1.5); };
  for (const Unit& u : lengths)
    if (!rotation && near(u)) return u.words;
  for (const Unit& u : angles)
    if (rotation && near(u)) return u.words;
  return "in another unit";
}

void add_sigma(const Comparison& c, std::vector<RecordingMistake>& out) {
  const measurement::PureError pure = measurement::pure_error(*c.study.data);
  for (const bool rotation : {false, true}) {
    const auto quantity = rotation ? measurement::Quantity::angle : measurement::Quantity::length;
    double sigma = 0, n = 0, residual = 0;
    for (std::size_t i = 0; i < c.study.values.size(); ++i) {
      const measurement::MeasuredValue& v = c.study.values[i];
      const measurement::Reading& r = c.study.data->readings[v.reading];
      if (v.quantity != quantity || !v.of_tool_point() || !(rotation ? r.sigma_th : r.sigma_u)) continue;
      const double left = c.residual(as_index(i));
      sigma += c.sigma[i] * c.sigma[i], residual += left * left, n += 1;
    }
    if (n < static_cast<double>(least_numbers)) continue;
    sigma = std::sqrt(sigma / n), residual = std::sqrt(residual / n);
    const std::optional<measurement::NoiseEstimate>& seen = rotation ? pure.th : pure.u;
    const bool replicated = seen && seen->degrees_of_freedom >= replicates_to_trust;
    const double scatter = replicated ? seen->sigma : residual, factor = sigma / scatter;
    // Without replicates the scatter is the residual: of data that were computed it is all but nothing.
    const bool large = factor > sigma_out_of_scale && (replicated || factor < 1e4);
    const bool small = replicated && factor > 0.8e-3 && factor < 1.2e-3;
    if (!large && !small) continue;
    const char* column = rotation ? "sigma_th_rad" : "sigma_u_mm";
    out.push_back({{"sigma_unit"},
                   fmt::format("{} {}: it says {}, where {} {}: {} wants {}", column,
                               sigma_unit_words(factor, rotation), size_words(sigma, quantity),
                               replicated ? "replicates scatter by" : "measured and predicted differ by",
                               size_words(scatter, quantity), column, rotation ? "rad" : "mm")});
  }
}

}  // namespace

std::vector<RecordingMistake> file_oddities(const Comparison& c) {
  std::vector<RecordingMistake> out;
  add_empty_ones(c, out);
  if (c.numbers < least_numbers)
    out.push_back(
        {{"too_few"},
         fmt::format("{} readings with {} measured numbers are too few to conclude anything: take at least {} "
                     "numbers, under loads in several directions",
                     c.readings, c.numbers, least_numbers)});
  add_identical_rows(c, out);
  add_stuck_ones(c, out);
  return out;
}

std::vector<RecordingMistake> sigma_oddities(const Comparison& c) {
  std::vector<RecordingMistake> out;
  add_sigma(c, out);
  return out;
}

std::vector<RecordingMistake> contradictions(const Comparison& c) {
  const measurement::Measurements& data = *c.study.data;
  const std::size_t sensors = data.instruments.sensors.size();
  std::vector<RecordingMistake> out;
  std::size_t more = 0;
  constexpr std::size_t most = 5;
  for (const std::vector<std::size_t>& group : measurement::replicates(data))
    for (std::size_t k = 0; k < 3 + sensors; ++k) {
      const std::size_t channel = k < 3 ? k : k + 3;
      std::optional<Replicate> low, high;
      for (const std::size_t i : group)
        if (const auto each = replicate_of(c, i, channel)) {
          if (!low || each->value < low->value) low = each;
          if (!high || each->value > high->value) high = each;
        }
      if (!low) continue;
      const double apart = high->value - low->value, deviation = std::hypot(low->sigma, high->sigma);
      if (!(apart > 10 * deviation)) continue;
      if (out.size() == most) {
        ++more;
        continue;
      }
      const measurement::Quantity quantity =
          channel < 6 ? measurement::Quantity::length : data.instruments.sensors[channel - 6].quantity;
      out.push_back({{"contradiction"},
                     fmt::format("lines {} and {} contradict each other: {} differs by {:.3g} at the same {}load, "
                                 "{:.0f} of its standard deviations",
                                 std::min(low->line, high->line), std::max(low->line, high->line),
                                 column_of(data, channel), measurement::row_of(quantity).per_SI * apart,
                                 data.instruments.stationary ? "" : "pose and ", apart / deviation),
                     false});
    }
  if (more > 0) out.push_back({{"contradiction"}, fmt::format("{} more such pairs", more), false});
  return out;
}

}  // namespace deflect::compare
