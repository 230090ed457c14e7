#include "validation/figures/errata_figure.h"

#include <algorithm>
#include <cmath>

#include "validation/figures/sheet.h"
#include "validation/report/by_point.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

constexpr double linear_to = 1e-3, knee = 2;

/// Signed: the logarithm of the change up to a factor of 2 (0.1 %, 1 %, 10 % take equal steps), beyond it that of the
/// factor.
double place(double ratio) {
  const double x = std::abs(std::log(ratio)), most = std::log(knee);
  const double size =
      std::log10(1 + std::min(x, most) / linear_to) + (x > most ? 0.8 * (x - most) / std::log(10.0) : 0);
  return std::copysign(size, std::log(ratio));
}

struct Mark {
  double ratio;
  const char* name;
};
constexpr Mark marks[] = {{1e-4, "÷10⁴"}, {1e-3, "÷1000"}, {0.01, "÷100"}, {0.1, "÷10"},   {0.5, "÷2"},
                          {0.9, "−10 %"}, {0.99, "−1 %"},  {1, "0"},       {1.01, "+1 %"}, {1.1, "+10 %"},
                          {2, "×2"},      {10, "×10"},     {100, "×100"},  {1e3, "×1000"}, {1e4, "×10⁴"}};

bool drawable(double ratio) { return std::isfinite(ratio) && ratio > 0; }

struct Ends {
  double low, high;  // of the axis, as place()
};

Ends ends_of(const std::vector<studies::ErratumPrice>& prices) {
  Ends e{place(0.9), place(1.1)};
  for (const studies::ErratumPrice& p : prices)
    for (int axis = 0; axis < 3; ++axis)
      for (const double ratio : {p.smallest(axis), p.largest(axis)})
        if (p.refused.empty() && drawable(ratio))
          e.low = std::min(e.low, place(ratio)), e.high = std::max(e.high, place(ratio));
  const double beside = 0.04 * (e.high - e.low);
  return {e.low - beside, e.high + beside};
}

/// As many marks as have room on an axis of w mm, outwards from none.
std::string tics_of(const Sheet& s, const Ends& e, double w) {
  std::string tics;
  const auto add_marks = [&](auto chosen) {
    double last = -INFINITY, half = 0;
    for (const Mark& mark : chosen) {
      const double at = place(mark.ratio), offset = w * std::abs(at) / (e.high - e.low),
                   own = s.text_mm(report::letters(mark.name)) / 2;
      if (at < e.low || at > e.high || offset - last < half + own + 0.6 * s.line()) continue;
      last = offset, half = own;
      tics += fmt::format("{}{} {:.6g}", tics.empty() ? "" : ", ", gnuplot_tic_label(mark.name), at);
    }
  };
  const auto none = std::find_if(std::begin(marks), std::end(marks), [](const Mark& m) { return m.ratio == 1; });
  add_marks(std::vector<Mark>(none, std::end(marks)));
  add_marks(std::vector<Mark>(std::make_reverse_iterator(none), std::rend(marks)));
  return tics;
}

/// Which mark stands for which direction of the load; how high it is.
double put_directions(Sheet& s, double y) {
  double x = 3;
  for (int axis = 0; axis < 3; ++axis) {
    s.label((s.narrow() ? "load " : "load along ") + std::string(report::axis_names[axis]), x + 3, y, "left");
    s.put("set label {} '' at screen {:.5f},1-{:.4f}/H point pt {} ps 0.7 lc rgb '{}'", 40 + axis,
          (x + 1.2) / s.width(), y, shapes[axis], colours[axis]);
    x += s.text_mm(12) + 5;
  }
  return 1.9 * s.line();
}

/// Rows of the data: axis, row, smallest, largest, the end with the larger effect. What cannot be drawn is said in its
/// row; `x`: the middle of the panel, `y`: its top.
std::string rows_of(Sheet& s, const std::vector<studies::ErratumPrice>& prices, double x, double y, double row) {
  std::string data;
  for (std::size_t i = 0; i < prices.size(); ++i) {
    const studies::ErratumPrice& p = prices[i];
    const auto in_row = [&](int axis) { return static_cast<double>(i) + 0.24 * (axis - 1); };
    const auto note = [&](const std::string& text, int axis) {
      s.label(text, x, y + row * (in_row(axis) + 0.5),
              "center " + s.font(0.8) + (axis == 1 ? "" : fmt::format(" textcolor rgb '{}'", colours[axis])));
    };
    if (!p.refused.empty()) {
      note("no solution", 1);
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double low = p.smallest(axis), high = p.largest(axis);
      if (!drawable(low) || !drawable(high)) {
        note(fmt::format("{:.3g} … {:.3g}", low, high), axis);
        continue;
      }
      const double a = place(low), b = place(high);
      data +=
          fmt::format("{} {:.6g} {:.6g} {:.6g} {:.6g}\n", axis, in_row(axis), a, b, std::abs(a) > std::abs(b) ? a : b);
    }
  }
  return data;
}

}  // namespace

Figure errata_figure(const std::vector<studies::ErratumPrice>& prices, const studies::Validation& v,
                     const FigureStyle& style) {
  Sheet s("errata", style, 160);
  const Ends e = ends_of(prices);
  std::size_t longest = 1;
  std::string names;
  for (std::size_t i = 0; i < prices.size(); ++i) {
    const char* name = info(prices[i].erratum).name;
    longest = std::max(longest, report::letters(name));
    names += fmt::format("{}{} {}", i ? ", " : "", gnuplot_tic_label(name), i);
  }
  double y = s.heading("Price of the errata: deflection as printed / corrected",
                       {fmt::format("{}, {} along x, y, z, smallest to largest of the points",
                                    report::clip(v.device, 40), report::load_text(v))});
  y += 0.4 * s.line();
  y += put_directions(s, y);

  const double left = s.text_mm(longest) + 3, w = s.width() - left - 4;
  const double row = 1.9 * s.line(), height = row * static_cast<double>(prices.size());
  s.label("← too stiff", left, y - 0.7 * s.line(), "left textcolor rgb '#505050'");
  s.label("too soft →", left + w, y - 0.7 * s.line(), "right textcolor rgb '#505050'");
  s.put("$data << EOD\n{}EOD\nunset key", rows_of(s, prices, left + w / 2, y, row));
  s.panel(left, y, w, height);
  s.axis_names("change of the deflection by the erratum", "", {});
  s.put("set xrange [{0}:{1}]\nset yrange [{2}:-0.5]\nset xtics ({3}) noenhanced\nset ytics ({4}) noenhanced", e.low,
        e.high, static_cast<double>(prices.size()) - 0.5, tics_of(s, e, w), names);
  s.put("set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb '#404040' lw 0.8 back");
  std::string series;
  for (int axis = 0; axis < 3; ++axis)
    series += fmt::format(
        "{0}$data using ($1=={1}?$3:NaN):2:($4-$3):(0) with vectors nohead lw 2 lc rgb '{2}', '' using "
        "($1=={1}?$5:NaN):2 "
        "with points pt {3} ps 0.6 lc rgb '{2}'",
        axis ? ", " : "plot ", axis, colours[axis], shapes[axis]);
  s.plot(series);
  return s.figure(
      y + height + s.below(),
      fmt::format("Price of each erratum of the paper, taken as printed one at a time: displacement of the tool "
                  "point of {} along a force of {} on it in x, y and z (base axes), as printed over corrected, "
                  "both by the closed form. Lines: from the smallest to the largest of the {} points; dots: "
                  "the end with the larger effect. Signed, logarithmic in the change up to a factor of 2 (linear "
                  "below 0.1 %) and in the factor beyond: to the left the erratum makes the device too stiff "
                  "(÷2: half the deflection), to the right too soft. Computed, no measurements and no noise.",
                  v.device, report::load_text(v), report::by_point(v).size()));
}

}  // namespace deflect::figures
