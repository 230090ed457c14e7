#include "validation/figures/validity_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"
#include "validation/report/text.h"
#include "validation/report/validity/validity_results.h"

namespace deflect::figures {
namespace {

/// Of each quantity its errors over u_val: their mean, and two of their standard deviations to either side.
std::string error_rows(const validity::ValidationStudy& s, std::string& labels, double& most) {
  std::string out = "$errors << EOD\n";
  for (std::size_t i = 0; i < s.channels.size(); ++i) {
    const validity::ChannelValidity& c = s.channels[i];
    const double mean = c.val > 0 ? c.mean_E / c.val : 0, rms = c.val > 0 ? c.rms_E / c.val : 0;
    const double spread = std::sqrt(std::max(0.0, rms * rms - mean * mean));
    out += fmt::format("{} {:.5g} {:.5g} {:.5g}\n", i, mean, mean - 2 * spread, mean + 2 * spread);
    labels += fmt::format("{}{} {}", i ? ", " : "", gnuplot_tic_label(c.name), i);
    most = std::max({most, std::abs(mean - 2 * spread), std::abs(mean + 2 * spread)});
  }
  return out + "EOD\n";
}

std::string curve_rows(const std::vector<double>& u) {
  std::string out = "$curve << EOD\n0 0\n";
  double before = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double here = static_cast<double>(i + 1) / static_cast<double>(u.size());
    out += fmt::format("{0:.6g} {1:.6g}\n{0:.6g} {2:.6g}\n", u[i], before, here);
    before = here;
  }
  return out + "1 1\nEOD\n";
}

}  // namespace

Figure validity_figure(const validity::ValidationStudy& s, const FigureStyle& style) {
  Sheet sheet("validation", style, 160);
  std::string labels;
  double most = 2;
  std::string errors = error_rows(s, labels, most);
  sheet.put("{}", errors + curve_rows(s.u) + "set multiplot\nunset key");
  const double top =
      sheet.heading("Validation: errors, and both distribution functions", {report::subjects(s.comparison)}) +
      1.4 * sheet.line();
  std::size_t longest = 1;
  for (const validity::ChannelValidity& c : s.channels) longest = std::max(longest, report::letters(c.name));
  const bool narrow = sheet.narrow();
  const double left = sheet.text_mm(longest) + 6, w = narrow ? sheet.width() - left - 5 : 0.46 * sheet.width() - left;
  const double height = std::max(1.6 * sheet.line() * static_cast<double>(s.channels.size() + 1), 0.34 * sheet.width());
  sheet.panel(left, top, w, height);
  sheet.axis_names("E/u_val", "", {});
  sheet.put(
      "set object 1 rectangle from first -2,graph 0 to first 2,graph 1 fc rgb '#E8E8E8' fs solid noborder behind");
  sheet.put("set yrange [{}:-0.6]\nset ytics ({}) noenhanced\nset xrange [{}:{}]\nset xtics {}",
            static_cast<double>(s.channels.size()) - 0.4, labels, -1.1 * most, 1.1 * most,
            sheet.tics(-most, most, w).step);
  sheet.plot("plot $errors using 2:1:3:4 with xerrorbars pt 7 ps 0.6 lw 1.5 lc rgb '#0072B2'");
  sheet.put("unset object 1\nset ytics autofreq enhanced");
  const Tics tics = sheet.tics(0, 1, 0.3 * sheet.width(), true);
  const double x = narrow ? sheet.left_of(tics) : 0.5 * sheet.width() + sheet.left_of(tics);
  const double y = narrow ? top + height + 2 * sheet.below() : top, side = sheet.width() - x - 5;
  sheet.panel(x, y, side, height);
  sheet.axis_names("u = F(D)", "share of the measurements", tics);
  sheet.put("set xrange [0:1]\nset yrange [0:1]\nset xtics {0}\nset ytics {0}", tics.step);
  sheet.plot("plot $curve using 1:2 with lines lw 1.5 lc rgb '#0072B2', x with lines dt 2 lw 1.5 lc rgb '#D55E00'");
  sheet.put("unset multiplot");
  return sheet.figure(
      y + height + sheet.below(),
      fmt::format(
          "Left: comparison errors E = S − D over the validation uncertainty, mean and two standard deviations for "
          "each quantity; grey: ±2. Right: u-pooling; each measurement mapped by the distribution function of its "
          "own prediction (line), and the diagonal of a right model (dashed); the area between them is {:.3g}, for "
          "a right model with independent errors {:.3g} on average. {} {} {} {}",
          s.area, s.expected_area, report::validity_words(s), report::axes_sentence(s.comparison),
          report::data_sentence(s.comparison), report::noise_sentence(s.comparison)));
}

}  // namespace deflect::figures
