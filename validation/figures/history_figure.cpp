#include "validation/figures/history_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

/// The bars of a version, side by side.
struct BarKind {
  const char *name, *colour;
};
constexpr BarKind bar_kinds[] = {
    {"all poses", "#0072B2"}, {"held-out poses", "#8CC4E8"}, {"placebo in its place", "#BBBBBB"}};

/// A name in up to five lines of so many letters, broken behind its hyphens and spaces where it has some; the last line
/// takes the rest.
std::vector<std::string> name_lines(std::string name, std::size_t most_letters) {
  std::vector<std::string> parts;
  while (report::letters(name) > most_letters && parts.size() < 4) {
    std::size_t cut = name.find_last_of("-_ ", most_letters);
    cut = cut == std::string::npos || cut == 0 ? most_letters : cut + 1;
    parts.push_back(name.substr(0, cut));
    name.erase(0, cut);
  }
  parts.push_back(name);
  return parts;
}

/// Three bars for each version over the line of noise and tolerances.
class HistoryBars {
 public:
  HistoryBars(const compare::History& h, const FigureStyle& style)
      : h_(h),
        all_(h.versions),
        unit_(report::error_unit(all_.front())),
        n_(static_cast<double>(all_.size())),
        s_("history", style, 160),
        floor_(unit_.fine * all_.back().noise_and_tolerances),
        most_(floor_) {}

  Figure draw() {
    put_data();
    const std::string file = all_.front().data.substr(all_.front().data.find_last_of('/') + 1);
    const double notes =
        s_.heading("The error falling from version to version", {fmt::format("measurements {}", file)});
    top_ = put_legend(notes + 0.7 * s_.line());
    const double height = std::clamp(0.4 * s_.width(), 8 * s_.line(), 75.0);
    const Tics tics = s_.tics(0, 1.08 * most_, height, true);
    left_ = s_.left_of(tics), w_ = s_.width() - left_ - 4;
    s_.panel(left_, top_, w_, height);
    s_.axis_names(
        "",
        fmt::format(s_.narrow() ? fmt::runtime("rms residual ({})") : fmt::runtime("rms of measured − predicted ({})"),
                    unit_.micro),
        tics);
    const std::size_t lines = put_names(top_ + height);
    plot_bars(tics);
    s_.put("unset multiplot");
    return s_.figure(top_ + height + (static_cast<double>(lines) + 0.9) * s_.line(), caption());
  }

 private:
  /// A row for each version; the largest number of all.
  void put_data() {
    std::string data = "$data << EOD\n";
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const double wrong = h_.placebo[i] ? unit_.fine * *h_.placebo[i] : NAN;
      data += fmt::format("{} {:.6g} {:.6g} {:.6g}\n", i, unit_.fine * all_[i].all.rmse, unit_.fine * all_[i].held_out,
                          wrong);
      for (const double x : {unit_.fine * all_[i].all.rmse, unit_.fine * all_[i].held_out, wrong})
        if (std::isfinite(x)) most_ = std::max(most_, x);
    }
    s_.put("{}EOD\nset multiplot\nunset key", data);
  }

  /// Keys from y on, beside each other as far as the paper goes; y below them.
  double put_legend(double y) {
    double x = 3;
    const auto key = [&](const char* name, const std::string& mark) {
      const double room = 7 + s_.text_mm(report::letters(name)) + 2;
      if (x > 3 && x + room > s_.width()) x = 3, y += 1.1 * s_.line();
      s_.put("{}", fmt::format(fmt::runtime(mark), fmt::format("{:.4f},1-{:.4f}/H", x / s_.width(), y),
                               fmt::format("{:.4f},1-{:.4f}/H", (x + 5) / s_.width(), y)));
      s_.label(name, x + 6.5, y, "left");
      x += room;
    };
    int tag = 0;
    for (const BarKind& k : bar_kinds) {
      ++tag;
      key(k.name, fmt::format("set arrow {} from screen {{}} to screen {{}} nohead lw 7 lc rgb '{}'", tag, k.colour));
    }
    key("noise and tolerances", "set arrow 4 from screen {} to screen {} nohead dt 2 lw 1.5 lc rgb '#D55E00'");
    return y + 1.2 * s_.line();
  }

  /// Names under the bars, in as many lines as they need; how many lines the longest has.
  std::size_t put_names(double foot) {
    std::size_t lines = 1;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const std::vector<std::string> parts = name_lines(report::clip(all_[i].device, 40), s_.letters_in(w_ / n_ - 2));
      lines = std::max(lines, parts.size());
      for (std::size_t k = 0; k < parts.size(); ++k)
        s_.label(parts[k], left_ + w_ * (static_cast<double>(i) + 0.6) / (n_ + 0.2),
                 foot + (1.1 + static_cast<double>(k)) * s_.line(), "center");
    }
    return lines;
  }

  void plot_bars(const Tics& tics) {
    s_.put("set format x ''\nset xtics 1\nset xrange [-0.6:{}]\nset yrange [0:{}]\nset ytics {}", n_ - 0.4,
           1.08 * most_, tics.step);
    s_.put("set boxwidth 0.24\nset style fill solid noborder");
    s_.plot(
        fmt::format("plot $data using ($1-0.26):2 with boxes lc rgb '{}', '' using 1:3 with boxes lc rgb '{}', '' "
                    "using ($1+0.26):4 with boxes lc rgb '{}', {} with lines dt 2 lw 1.5 lc rgb '#D55E00'",
                    bar_kinds[0].colour, bar_kinds[1].colour, bar_kinds[2].colour, floor_));
  }

  std::string caption() const {
    std::string names;
    for (const compare::Comparison& c : all_) names += (names.empty() ? "" : ", ") + c.device;
    return fmt::format(
        "Root mean square of measured − predicted in {} for the versions {}, over all poses and at held-out poses, to "
        "which tolerances were bent by what the other poses say; placebo: the same change of the predictions with its "
        "sign drawn by lot at every pose. Dashed: what noise and tolerances give with nothing missing, {:.3g} {}. {} "
        "{} {}",
        unit_.micro, names, floor_, unit_.micro, report::axes_sentence(all_.front()),
        report::data_sentence(all_.front()), report::noise_sentence(all_.front()));
  }

  const compare::History& h_;
  const std::vector<compare::Comparison>& all_;
  report::ErrorUnit unit_;
  double n_;  // versions
  Sheet s_;
  double floor_, most_;                // of noise and tolerances; the largest number
  double top_ = 0, left_ = 0, w_ = 0;  // of the panel, mm
};

}  // namespace

Figure history_figure(const compare::History& h, const FigureStyle& style) { return HistoryBars(h, style).draw(); }

}  // namespace deflect::figures
