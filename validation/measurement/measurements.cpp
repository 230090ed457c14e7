#include "validation/measurement/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/spatial.h"
#include "validation/measurement/csv.h"
#include "validation/measurement/decimal_commas.h"
#include "validation/measurement/measurement_columns.h"
#include "validation/measurement/number_limits.h"
#include "validation/measurement/parse_plan.h"

namespace deflect::measurement {
namespace {

constexpr double absolute_zero_C = -273.15;

// Of poses with one label, as encoders read them: from the first of them.
constexpr double scatter_mm = 0.05, scatter_deg = 0.05, scatter_rad = 1e-3;

/// What instruments and spreadsheets write where there is no number.
bool says_not_measured(std::string_view cell) {
  static constexpr std::string_view words[] = {"-",  "--",   "–",    "—",    "nan",    "#n/a",    "n/a",
                                               "na", "n.a.", "null", "none", "#null!", "#value!", "#div/0!"};
  std::string lower(cell);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return std::find(std::begin(words), std::end(words), lower) != std::end(words);
}

bool is_dash(std::string_view cell) { return cell == "-" || cell == "--" || cell == "–" || cell == "—"; }

class Reader {
 public:
  Reader(const CsvTable& table, const std::string& origin, const Instruments& known, bool plan)
      : table_(table), columns_(measurement_columns(table, known, plan)) {
    for (const SensorColumn& s : columns_.sensors) m_.instruments.sensors.push_back(s.sensor);
    for (const LoadPointColumns& p : columns_.load_points) m_.instruments.load_points.push_back(p.name);
    for (const LoadCaseColumn& c : columns_.load_cases) m_.instruments.load_cases.push_back(c.name);
    m_.instruments.stationary = known.stationary;
    m_.origin = origin;
    m_.joint_rotates = columns_.joint_rotates;
    m_.temperature_recorded = columns_.temperature.has_value();
    for (const std::size_t column : columns_.notes) m_.note_columns.push_back(table.header()[column]);
  }

  Measurements read() {
    m_.readings.reserve(table_.rows());
    for (std::size_t row = columns_.first_row; row < table_.rows(); ++row) m_.readings.push_back(reading(row));
    tell_how();
    return std::move(m_);
  }

  /// Whether there is a column of this component of the displacement.
  bool reads(std::size_t component) const { return columns_.displacement[component].has_value(); }

 private:
  Reading reading(std::size_t row) {
    Reading r;
    r.line = table_.line(row);
    r.pose = group(row);
    for (std::size_t i = 0; i < 6; ++i) {
      if (const auto& column = columns_.load[i]) r.load(as_index(i)) = number(row, *column) / (i < 3 ? 1 : 1e3);
      if (const auto value = measured(row, columns_.displacement[i])) r.displacement[i] = *value / (i < 3 ? 1e3 : 1);
    }
    for (const SensorColumn& s : columns_.sensors) {
      r.sensors.push_back(measured(row, s.column));
      if (r.sensors.back()) *r.sensors.back() /= row_of(s.sensor.quantity).per_SI;
    }
    for (const LoadCaseColumn& c : columns_.load_cases) r.factors.push_back(load_or_none(row, c.column));
    if (!columns_.load_points.empty()) r.at_tool = r.load;
    for (const LoadPointColumns& p : columns_.load_points) {
      r.at_points.push_back(Vector6::Zero());
      for (std::size_t i = 0; i < 6; ++i)
        if (p.load[i]) r.at_points.back()(as_index(i)) = load_or_none(row, *p.load[i]) / (i < 3 ? 1 : 1e3);
    }
    r.sigma_u = sigma(row, columns_.sigma_u, 1e3);
    r.sigma_th = sigma(row, columns_.sigma_th, 1);
    if (columns_.sequence) r.sequence = sequence(row, *columns_.sequence);
    if (const auto t = measured(row, columns_.temperature)) {
      if (*t < absolute_zero_C) table_.refuse(row, columns_.temperature->index, "below absolute zero; °C are wanted");
      r.temperature_C = *t;
    }
    for (const std::size_t column : columns_.notes) r.notes.emplace_back(table_.text(row, column));
    return r;
  }

  /// Index of the row's pose group, which is made where the label is new.
  std::size_t group(std::size_t row) {
    const std::string_view label = columns_.pose ? table_.text(row, *columns_.pose) : "all";
    if (label.empty()) table_.refuse(row, *columns_.pose, "the label is empty: give every approach of a pose a label");
    const auto [found, is_new] = group_of_.emplace(label, m_.poses.size());
    if (is_new) {
      m_.poses.push_back(new_group(row));
      beside_first_.emplace_back();
    } else {
      check_same_command(row, m_.poses[found->second].readings.front() + columns_.first_row, found->second);
    }
    m_.poses[found->second].readings.push_back(row - columns_.first_row);
    return found->second;
  }

  bool turns(std::size_t i) const { return m_.by_joints() ? m_.joint_rotates[i] : i >= 3; }

  PoseGroup new_group(std::size_t row) const {
    PoseGroup group;
    group.label = columns_.pose ? table_.text(row, *columns_.pose) : "all";
    const std::vector<ReadColumn>& columns = columns_.command;
    if (m_.by_joints()) group.joints.resize(std::ssize(columns));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto at = as_index(i);
      const double value = number(row, columns[i]);
      if (turns(i)) table_.angle(row, columns[i].index, columns[i].factor * (m_.by_joints() ? 1 : pi / 180));
      if (m_.by_joints())
        group.joints(at) = m_.joint_rotates[i] ? value : value / 1e3;
      else
        group.pose_mm_deg(at) = value;
    }
    return group;
  }

  void check_same_command(std::size_t row, std::size_t first, std::size_t group) {
    const std::vector<ReadColumn>& columns = columns_.command;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::size_t column = columns[i].index;
      if (table_.text(row, column) == table_.text(first, column)) continue;
      const double beside = number(row, columns[i]) - number(first, columns[i]);
      if (beside == 0) continue;
      if (std::abs(beside) > (!turns(i) ? scatter_mm : m_.by_joints() ? scatter_rad : scatter_deg) * (1 + 1e-9))
        table_.refuse(
            row, column,
            fmt::format("{} here and {} in line {}, both of pose '{}': one label is one approach of one "
                        "commanded pose, which may scatter by {} mm and {} deg; use another label",
                        excerpt(table_.text(row, column)), excerpt(table_.text(first, column)), table_.line(first),
                        excerpt(table_.text(row, *columns_.pose)), scatter_mm, scatter_deg));
      VectorX& sum = beside_first_[group];
      if (sum.size() == 0) sum = VectorX::Zero(std::ssize(columns));
      sum(as_index(i)) += beside;
      double& most = turns(i) ? most_turned_ : most_moved_;
      most = std::max(most, std::abs(beside));
    }
  }

  /// The mean of the poses of a label where they scatter.
  void take_means() {
    for (std::size_t p = 0; p < m_.poses.size(); ++p) {
      const VectorX& sum = beside_first_[p];
      PoseGroup& pose = m_.poses[p];
      for (Eigen::Index i = 0; i < sum.size(); ++i) {
        const double mean = sum(i) / static_cast<double>(pose.readings.size());
        if (m_.by_joints())
          pose.joints(i) += nth(m_.joint_rotates, i) ? mean : mean / 1e3;
        else
          pose.pose_mm_deg(i) += mean;
      }
    }
  }

  void tell_how() {
    take_means();
    m_.how_read = columns_.how_read;
    std::vector<std::size_t> text = columns_.notes;
    if (columns_.pose) text.push_back(*columns_.pose);
    if (std::string words = decimal_comma_words(table_, columns_.first_row, text); !words.empty())
      m_.how_read.push_back(std::move(words));
    const auto labels =
        std::count_if(beside_first_.begin(), beside_first_.end(), [](const VectorX& sum) { return sum.size() > 0; });
    if (labels > 0)
      m_.how_read.push_back(fmt::format(
          "the poses of {} label{} scatter, by {:.3g} mm and {:.3g} {} from the first at most: their mean is taken",
          labels, labels == 1 ? "" : "s", most_moved_, most_turned_, m_.by_joints() ? "rad" : "deg"));
    if (too_fine_ > 0)
      m_.how_read.push_back(fmt::format(
          "{} standard deviation{} such as {} in line {}, column '{}', {} finer than instruments read (below 1e-9 mm, "
          "1e-12 rad): is the unit another?",
          too_fine_, too_fine_ == 1 ? "" : "s", excerpt(table_.text(first_fine_row_, first_fine_column_)),
          table_.line(first_fine_row_), excerpt(table_.header()[first_fine_column_]), too_fine_ == 1 ? "is" : "are"));
    if (not_measured_ > 0)
      m_.how_read.push_back(fmt::format("{} cell{} such as '{}' in line {} count as not measured", not_measured_,
                                        not_measured_ == 1 ? "" : "s", excerpt(first_word_), first_word_line_));
    if (const std::size_t lines = table_.comments().size(); lines > 0)
      m_.how_read.push_back(fmt::format("{} line{} with '#' are skipped, the first is line {}", lines,
                                        lines == 1 ? "" : "s that begin", table_.comments().front()));
  }

  /// In the unit of the contract.
  double number(std::size_t row, const ReadColumn& column) const {
    const double written = table_.number(row, column.index);
    const double value = column.factor == 1 && column.offset == 0 ? written : column.factor * (written + column.offset);
    if (!(std::abs(value) <= largest_measured))
      table_.refuse(
          row, column.index,
          fmt::format("{} is out of all proportion: numbers up to {:g} are read; correct the cell, or leave it "
                      "empty where nothing was measured",
                      excerpt(table_.text(row, column.index)), largest_measured));
    return value;
  }

  /// The cell's number; empty where there is neither column nor text, and where the text says so.
  std::optional<double> measured(std::size_t row, const std::optional<ReadColumn>& column) {
    if (!column) return std::nullopt;
    const std::string_view cell = table_.text(row, column->index);
    if (cell.empty()) return std::nullopt;
    if (says_not_measured(cell)) {
      if (++not_measured_ == 1) first_word_ = cell, first_word_line_ = table_.line(row);
      return std::nullopt;
    }
    return number(row, *column);
  }

  /// Of a load beside others an empty cell or a dash says that there is none; no number says nothing.
  double load_or_none(std::size_t row, const ReadColumn& column) {
    const std::string_view cell = table_.text(row, column.index);
    if (cell.empty() || is_dash(cell)) return 0;
    if (says_not_measured(cell))
      table_.refuse(row, column.index,
                    fmt::format("'{}' is no load: write its number, 0 where there was none, or leave the row away "
                                "where nobody knows it",
                                excerpt(cell)));
    return number(row, column);
  }

  std::optional<double> sigma(std::size_t row, const std::optional<ReadColumn>& column, double per_SI) {
    std::optional<double> value = measured(row, column);
    if (!value) return value;
    const char* what = *value > 0 ? "too small for a standard deviation" : "not positive";
    *value /= per_SI;
    if (!(*value > least_sigma))
      table_.refuse(row, column->index,
                    fmt::format("{} is {}: no reading is exact, leave the cell empty where the standard deviation is "
                                "not known",
                                excerpt(table_.text(row, column->index)), what));
    if (*value < finest_sigma && ++too_fine_ == 1) first_fine_row_ = row, first_fine_column_ = column->index;
    return value;
  }

  double sequence(std::size_t row, std::size_t column) {
    if (table_.text(row, column).empty())
      table_.refuse(row, column, "the cell is empty: number all readings or remove the column");
    const double value = table_.number(row, column);
    const auto [same, is_new] = row_of_sequence_.emplace(value, row);
    if (is_new) return value;
    const std::string_view here = table_.text(row, column), there = table_.text(same->second, column);
    if (here != there && std::abs(value) >= 9007199254740992)  // 2^53
      table_.refuse(row, column,
                    fmt::format("{} and {} in line {} differ beyond the 16 digits that are read: count from the first "
                                "reading",
                                excerpt(here), excerpt(there), table_.line(same->second)));
    table_.refuse(row, column,
                  fmt::format("{} stands in line {} too: two readings are not taken at once, number them in the order "
                              "they were taken",
                              excerpt(here), table_.line(same->second)));
  }

  const CsvTable& table_;
  const MeasurementColumns columns_;
  Measurements m_;
  std::unordered_map<std::string_view, std::size_t> group_of_;
  std::unordered_map<double, std::size_t> row_of_sequence_;
  std::vector<VectorX> beside_first_;  // by group: sums of what poses differ by from its first; empty where alike
  double most_moved_ = 0, most_turned_ = 0;
  std::size_t not_measured_ = 0, first_word_line_ = 0;
  std::size_t too_fine_ = 0, first_fine_row_ = 0, first_fine_column_ = 0;
  std::string_view first_word_;
};

}  // namespace

Measurements parse_measurements(std::string text, const std::string& origin, const Instruments& known) {
  const CsvTable table = parse_csv(std::move(text), origin);
  return Reader(table, origin, known, false).read();
}

Measurements read_measurements(const std::filesystem::path& path, const Instruments& known) {
  return parse_measurements(read_text(path), path.string(), known);
}

Measurements parse_plan(std::string text, const std::string& origin, const Instruments& known) {
  const CsvTable table = parse_csv(std::move(text), origin);
  Measurements m = Reader(table, origin, known, true).read();
  m.instruments.sensors.clear();
  for (Reading& r : m.readings) r.displacement = {}, r.sensors.clear();
  return m;
}

Measurements parse_campaign(std::string text, const std::string& origin, const Instruments& known) {
  const CsvTable table = parse_csv(std::move(text), origin);
  Reader reader(table, origin, known, true);
  Measurements m = reader.read();
  for (Reading& r : m.readings) {
    for (std::size_t i = 0; i < 6; ++i) r.displacement[i] = reader.reads(i) ? std::optional(0.0) : std::nullopt;
    r.sensors.assign(m.instruments.sensors.size(), 0.0);
  }
  return m;
}

Measurements read_campaign(const std::filesystem::path& path, const Instruments& known) {
  return parse_campaign(read_text(path), path.string(), known);
}

Measurements read_plan(const std::filesystem::path& path, const Instruments& known) {
  return parse_plan(read_text(path), path.string(), known);
}

namespace {

/// Components at named points that some reading has, by point and component.
std::vector<std::pair<std::size_t, std::size_t>> loaded_components(const Measurements& m) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t p = 0; p < m.instruments.load_points.size(); ++p)
    for (std::size_t i = 0; i < 6; ++i)
      if (std::any_of(m.readings.begin(), m.readings.end(),
                      [&](const Reading& r) { return r.at_points[p](as_index(i)) != 0; }))
        out.emplace_back(p, i);
  return out;
}

constexpr const char* wrench_names[] = {"fx", "fy", "fz", "mx", "my", "mz"};

}  // namespace

std::vector<LoadChannel> load_channels(const Measurements& m) {
  std::vector<LoadChannel> out;
  if (!m.instruments.stationary) {
    for (std::size_t i = 0; i < 6; ++i) out.push_back({wrench_names[i], i >= 3});
    return out;
  }
  for (const std::string& name : m.instruments.load_cases) out.push_back({"load." + name});
  for (const auto& [point, component] : loaded_components(m))
    out.push_back({m.instruments.load_points[point] + "." + wrench_names[component], component >= 3});
  return out;
}

MatrixX loads_of(const Measurements& m) {
  const auto readings = std::ssize(m.readings);
  if (!m.instruments.stationary) {
    MatrixX out(6, readings);
    for (Eigen::Index i = 0; i < readings; ++i) out.col(i) = nth(m.readings, i).load;
    return out;
  }
  const auto components = loaded_components(m);
  const auto cases = std::ssize(m.instruments.load_cases);
  MatrixX out(cases + std::ssize(components), readings);
  for (Eigen::Index i = 0; i < readings; ++i) {
    const Reading& r = nth(m.readings, i);
    for (Eigen::Index k = 0; k < cases; ++k) out(k, i) = nth(r.factors, k);
    for (std::size_t k = 0; k < components.size(); ++k)
      out(cases + as_index(k), i) = r.at_points[components[k].first](as_index(components[k].second));
  }
  return out;
}

Measurements one_pose(const Measurements& m, std::size_t pose) {
  Measurements out{m.origin, m.joint_rotates, m.note_columns, m.temperature_recorded, {m.poses.at(pose)},
                   {},       m.how_read,      m.instruments};
  for (std::size_t& i : out.poses.front().readings) {
    out.readings.push_back(m.readings[i]);
    out.readings.back().pose = 0;
    i = out.readings.size() - 1;
  }
  return out;
}

std::vector<std::size_t> in_sequence(const Measurements& m, const std::string& purpose) {
  std::vector<std::size_t> order(m.readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!std::all_of(m.readings.begin(), m.readings.end(), [](const Reading& r) { return r.sequence.has_value(); }))
    throw InputError(
        fmt::format("{}:1: column 'sequence' is missing: {} needs the order in which the readings were "
                    "taken",
                    m.origin, purpose));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return m.readings[a].sequence < m.readings[b].sequence; });
  return order;
}

}  // namespace deflect::measurement
