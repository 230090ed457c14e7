#include "validation/figures/fig11.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "msa/base/index.h"
#include "validation/figures/contours.h"
#include "validation/figures/map_scale.h"
#include "validation/figures/map_words.h"
#include "validation/figures/sheet.h"
#include "validation/report/by_point.h"
#include "validation/report/map_correlation.h"
#include "validation/report/map_results.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

constexpr double iso_text = 0.8;  // of the style's size
const double none = std::numeric_limits<double>::quiet_NaN();

/// A plane of the grid: `across` and `up` are axes, the third stands at `at`.
struct Slice {
  int across, up, at;
  int fixed() const { return 3 - across - up; }
};

std::vector<Slice> slices_of(const studies::MapGrid& g) {
  const auto [nx, ny, nz] = g.counts;
  std::vector<Slice> list;
  if (nx > 1 && ny > 1) {
    if (nz > 1) list.push_back({0, 1, nz - 1});
    if (nz != 2) list.push_back({0, 1, (nz - 1) / 2});
    if (nz > 1) list.push_back({0, 1, 0});
  }
  if (nz > 1 && nx > 1)
    list.push_back({0, 2, (ny - 1) / 2});
  else if (nz > 1 && ny > 1)
    list.push_back({1, 2, (nx - 1) / 2});
  return list;
}

const studies::MapPose& at(const studies::StiffnessMap& map, const Slice& s, int i, int j) {
  std::array<int, 3> index{};
  nth(index, s.across) = i;
  nth(index, s.up) = j;
  nth(index, s.fixed()) = s.at;
  return map.poses[map.options.grid.index(index[0], index[1], index[2])];
}

/// Interpolated bilinearly in the logarithm, with some steps between poses; NaN outside the cells whose four corners
/// are reached. Nothing where no cell is whole.
std::optional<GridField> surface(const studies::StiffnessMap& map, const Slice& s, int axis) {
  const studies::MapGrid& g = map.options.grid;
  const int n = nth(g.counts, s.across), m = nth(g.counts, s.up);
  const auto steps = [](int count) { return std::max(1, static_cast<int>(std::ceil(60.0 / (count - 1)))); };
  const int fine_x = steps(n), fine_y = steps(m);
  const auto log_value = [&](int i, int j) {
    const studies::MapValues* v = report::shown(at(map, s, i, j));
    return v ? std::log(v->stiffness_N_mm(axis)) : none;
  };
  const auto in_cell = [&](int i, int j, double u, double v) {  // NaN where the cell is not whole or not there
    if (i < 0 || j < 0 || i + 1 >= n || j + 1 >= m) return none;
    return (1 - v) * ((1 - u) * log_value(i, j) + u * log_value(i + 1, j)) +
           v * ((1 - u) * log_value(i, j + 1) + u * log_value(i + 1, j + 1));
  };
  const auto place = [&](int where, int low, double t) {
    const double from = g.coordinate(where, low);
    return t == 0 ? from : from + t * (g.coordinate(where, low + 1) - from);
  };
  GridField field;
  for (int x = 0; x <= (n - 1) * fine_x; ++x)
    field.x.push_back(place(s.across, x / fine_x, static_cast<double>(x % fine_x) / fine_x));
  bool whole = false;
  for (int y = 0; y <= (m - 1) * fine_y; ++y) {
    const int j = y / fine_y;
    const double v = static_cast<double>(y % fine_y) / fine_y;
    for (int x = 0; x <= (n - 1) * fine_x; ++x) {
      const int i = x / fine_x;
      const double u = static_cast<double>(x % fine_x) / fine_x;
      double value = in_cell(i, j, u, v);  // a point on an edge belongs to the cells on both sides
      if (std::isnan(value) && u == 0) value = in_cell(i - 1, j, 1, v);
      if (std::isnan(value) && v == 0) value = in_cell(i, j - 1, u, 1);
      if (std::isnan(value) && u == 0 && v == 0) value = in_cell(i - 1, j - 1, 1, 1);
      field.values.push_back(std::exp(value));
      whole = whole || !std::isnan(value);
    }
    field.y.push_back(place(s.up, j, v));
  }
  return whole ? std::optional(field) : std::nullopt;
}

/// The mean positions of the slides that occur in a slice; briefly for narrow paper.
std::string slide_text(const studies::StiffnessMap& map, const Slice& s, bool brief) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int j = 0; j < nth(map.options.grid.counts, s.up); ++j)
    for (int i = 0; i < nth(map.options.grid.counts, s.across); ++i)
      if (const studies::MapPose& p = at(map, s, i, j); p.reached()) {
        low = std::min(low, p.slide_mean_mm);
        high = std::max(high, p.slide_mean_mm);
      }
  if (low > high) return ": out of reach";
  return map.slides.key.empty()
             ? ""
             : fmt::format(": {}{} {:.0f}–{:.0f} mm", brief ? "" : "mean ", map.slides.words, low, high);
}

// Viridis, which grows evenly lighter for every colour vision.
constexpr const char* palette =
    "set palette defined (0 '#440154', 0.125 '#472d7b', 0.25 '#3b528b', 0.375 '#2c728e', 0.5 '#21918c', 0.625 "
    "'#28ae80', 0.75 '#5ec962', 0.875 '#addc30', 1 '#fde725')";

/// Three panels in a row for each slice, one for each direction of the force; the bar of colours beside them, on narrow
/// paper below.
class Slices {
 public:
  Slices(const studies::StiffnessMap& map, const FigureStyle& style)
      : map_(map),
        g_(map.options.grid),
        slices_(slices_of(g_)),
        e_(range_of_stiffness(map)),
        all_reached_(
            std::all_of(map.poses.begin(), map.poses.end(), [](const studies::MapPose& p) { return p.reached(); })),
        script_("fig11", style, 170.5),
        line_(script_.line()),
        width_(script_.width()),
        left_(3.5 * line_),
        below_(script_.narrow()),
        gap_(below_ ? 3 : 4.5),
        bar_room_(below_ ? 3 : 4 + bar + script_.text_mm(4) + 2.45 * line_),
        panel_((width_ - left_ - 2 * gap_ - bar_room_) / 3),
        row_title_(1.375 * line_),
        row_foot_(script_.below() - 0.25 * line_) {}

  bool any() const { return !slices_.empty() && e_.high != 0; }

  Figure figure() {
    put_series();
    script_.put("{}\nset logscale cb\nset cbrange [{:.6g}:{:.6g}]\nset cbtics ({}) scale 0.5", palette, e_.low,
                std::max(e_.high, e_.low * 1.001), tics_in(e_));
    script_.put("set multiplot\nunset key\nunset grid\nset border 15 lc rgb '#404040' lw 0.7");
    double y = map_heading(script_, map_, "stiffness over the workspace", all_reached_ ? "" : "; hatched: out of reach",
                           below_ ? 3 : left_) +
               1.3 * line_;
    top_ = foot_ = y + row_title_;
    for (const Slice& s : slices_) foot_ += height_of(s) + row_foot_ + row_title_;
    foot_ -= row_foot_ + row_title_;
    for (std::size_t r = 0; r < slices_.size(); ++r) {
      y += row_title_;
      for (int axis = 0; axis < 3; ++axis) draw(r, axis, y);
      y += height_of(slices_[r]) + row_foot_;
    }
    script_.put("unset multiplot");
    return script_.figure(
        y + (below_ ? bar + 3.2 * line_ : 0),
        map_caption(map_, fmt::format("Slices of the workspace, by the direction of the force, on one "
                                      "logarithmic scale of colours ({:.4g} … {:.4g} N/mm) with "
                                      "iso-curves{}.",
                                      e_.low, e_.high, all_reached_ ? "" : "; hatched: out of reach")));
  }

 private:
  double height_of(const Slice& s) const {
    const auto extent = [&](int axis) { return g_.high_mm(axis) - g_.low_mm(axis); };
    return std::clamp(panel_ * extent(s.up) / extent(s.across), 0.5 * panel_, 1.4 * panel_);
  }

  /// The data of every panel and how it is plotted.
  void put_series() {
    const std::vector<double> iso = levels_in(e_, below_ ? 8 : 14), index = levels_in(e_, 4);
    const double light = std::exp(std::log(e_.low) + 0.62 * std::log(e_.high / e_.low));
    for (std::size_t r = 0; r < slices_.size(); ++r)
      for (int axis = 0; axis < 3; ++axis) {
        series_.emplace_back("plot '+' using 1:(NaN):(1) with points palette");
        const std::optional<GridField> field = surface(map_, slices_[r], axis);
        whole_.push_back(field && std::none_of(field->values.begin(), field->values.end(),
                                               [](double value) { return std::isnan(value); }));
        if (!field) continue;
        const LabelledCurves curves(*field, panel_, height_of(slices_[r]), script_.text_mm(1, iso_text),
                                    iso_text * line_);
        const CurveRows drawn = curve_rows(curves, iso, index, light);
        script_.put("$s{}{} << EOD\n{}EOD", r, axis, matrix_rows(*field));
        series_.back() = fmt::format("plot $s{}{} {} with image", r, axis, matrix_columns(*field));
        const auto over = [&](const char* name, const std::string& rows, const std::string& how) {
          if (rows.empty()) return;
          script_.put("${}{}{} << EOD\n{}EOD", name, r, axis, rows);
          series_.back() += fmt::format(", ${}{}{} using {}", name, r, axis, how);
        };
        over("thin", drawn.thin, "1:2:3 with lines lc rgb variable lw 0.3");
        over("heavy", drawn.heavy, "1:2:3 with lines lc rgb variable lw 0.9");
        over("values", drawn.values,
             fmt::format("1:2:(sprintf('%g',$3)):4 with labels {} textcolor rgb variable", script_.font(iso_text)));
      }
  }

  void draw(std::size_t r, int axis, double y) {
    const Slice& s = slices_[r];
    const double h = height_of(s), x = left_ + axis * (panel_ + gap_);
    const std::size_t series = 3 * r + as_size(axis);
    script_.panel(x, y, panel_, h);
    script_.put("set xrange [{:.8g}:{:.8g}]\nset yrange [{:.8g}:{:.8g}]", g_.low_mm(s.across), g_.high_mm(s.across),
                g_.low_mm(s.up), g_.high_mm(s.up));
    // Hatching costs more than all the rest of a picture: only where it shows.
    if (whole_[series])
      script_.put("unset object");
    else
      script_.put(
          "set object 1 rect from graph 0,0 to graph 1,1 behind fc rgb '#f4f4f4' fs solid noborder\n"
          "set object 2 rect from graph 0,0 to graph 1,1 behind fc rgb '#b0b0b0' fs pattern 4 noborder");
    script_.put("set xtics ({}) offset 0,0.4\nset ytics ({}) offset 0.6,0\nset format y '{}'",
                inner_tics(script_, g_.low_mm(s.across), g_.high_mm(s.across), panel_),
                inner_tics(script_, g_.low_mm(s.up), g_.high_mm(s.up), h), axis == 0 ? "%g" : "");
    if (axis == 0) {
      script_.label(fmt::format("{} (mm)", report::axis_names[s.up]), 0.65 * line_, y + h / 2, "center rotate by 90");
      script_.label(fmt::format("{} = {:.4g} mm{}", report::axis_names[s.fixed()], g_.coordinate(s.fixed(), s.at),
                                slide_text(map_, s, below_)),
                    below_ ? 3 : left_, y - 0.6 * line_, "left textcolor rgb '#202020'");
    }
    script_.label(fmt::format("{} (mm)", report::axis_names[s.across]), x + panel_ / 2, y + h + 1.65 * line_, "center");
    if (r == 0)
      script_.label((below_ ? "force " : "force along ") + std::string(report::axis_names[axis]), x + panel_,
                    y - 1.6 * line_, fmt::format("right {} textcolor rgb '{}'", script_.font(1, true), colours[axis]));
    put_colours(r, axis);
    script_.plot(series_[series]);
  }

  void put_colours(std::size_t r, int axis) {
    const bool last_row = r + 1 == slices_.size();
    if (below_ && last_row && axis == 2) {
      const double bar_top = foot_ + row_foot_ + 0.3 * line_, bar_width = width_ - left_ - 6;
      script_.put("set colorbox horizontal user origin {} size screen {:.5f},{:.5f}/H",
                  script_.at(left_, bar_top + bar).substr(3), bar_width / width_, bar);
      script_.label("stiffness along the force (N/mm)", left_ + bar_width / 2, bar_top + bar + 2.2 * line_, "center");
    } else if (!below_ && r == 0 && axis == 2) {
      script_.put("set colorbox vertical user origin {} size screen {:.5f},{:.5f}/H",
                  script_.at(width_ - bar_room_ + 4, foot_).substr(3), bar / width_, foot_ - top_);
      script_.label("stiffness along the force (N/mm)", width_ - 0.55 * line_, (top_ + foot_) / 2,
                    "center rotate by 90");
    } else {
      script_.put("unset colorbox");
    }
  }

  static constexpr double bar = 4;  // mm

  const studies::StiffnessMap& map_;
  const studies::MapGrid& g_;
  std::vector<Slice> slices_;
  StiffnessRange e_;
  bool all_reached_;
  Sheet script_;
  double line_, width_, left_;  // mm, as all below
  bool below_;
  double gap_, bar_room_, panel_, row_title_, row_foot_;
  double top_ = 0, foot_ = 0;        // of the panels
  std::vector<std::string> series_;  // by row and axis
  std::vector<bool> whole_;          // whether every value is there
};

}  // namespace

std::vector<Figure> fig11(const studies::StiffnessMap& map, const FigureStyle& style) {
  Slices slices(map, style);
  if (!slices.any()) return {};
  return {slices.figure()};
}

}  // namespace deflect::figures
