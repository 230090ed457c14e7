#include "validation/figures/residual_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

constexpr double depth_x = 0.42, depth_z = 0.26;  // of a step along y, into the page

// Blue, white, red of ColorBrewer's RdBu, told apart with any colour vision.
constexpr const char* diverging_palette =
    "set palette defined (-1 '#053061', -0.75 '#2166AC', -0.5 '#4393C3', -0.25 '#92C5DE', 0 '#F7F7F7', 0.25 '#F4A582', "
    "0.5 '#D6604D', 0.75 '#B2182B', 1 '#67001F')";

/// Where poses lie, mm; as wide as a tenth of the largest extent at least.
struct Box {
  Vector3 low, high;
  double across(const Vector3& p) const { return p.x() + depth_x * (p.y() - low.y()); }
  double up(const Vector3& p) const { return p.z() + depth_z * (p.y() - low.y()); }
};

Box box_of(const compare::Comparison& c) {
  Vector3 low = Vector3::Constant(INFINITY), high = -low;
  for (std::size_t p = 0; p < c.study.standing->poses(); ++p) {
    const Vector3 at = report::mm * c.study.standing->tool(p).p_W;
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  const double least = std::max(0.1 * (high - low).maxCoeff(), 1.0);
  for (int k = 0; k < 3; ++k) {
    const double middle = (low(k) + high(k)) / 2, half = std::max((high(k) - low(k)) / 2, least / 2) * 1.12;
    low(k) = middle - half, high(k) = middle + half;
  }
  return {low, high};
}

/// Edges of the box, and each pose's foot on its floor.
std::string frame_of(const Box& box) {
  std::string out = "$box << EOD\n";
  const auto corner = [&](int i) {
    return Vector3(i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                   i & 4 ? box.high.z() : box.low.z());
  };
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4})
      if (!(i & bit)) {
        for (const Vector3& p : {corner(i), corner(i | bit)})
          out += fmt::format("{:.5g} {:.5g}\n", box.across(p), box.up(p));
        out += "\n";
      }
  return out + "EOD\n";
}

}  // namespace

std::vector<SignedResidual> signed_residuals(const compare::Comparison& c) {
  const std::vector<report::ReadingCells> cells = report::cells_of(c);
  std::vector<SignedResidual> out;
  for (const measurement::PoseGroup& pose : c.study.data->poses) {
    Vector3 moved = Vector3::Zero(), load = moved, sum = moved, count = moved;
    for (const std::size_t i : pose.readings) {
      if (cells[i].set_aside) continue;
      for (int k = 0; k < 3; ++k) {
        const double r = cells[i].residual(k), F = cells[i].load(k);
        if (!std::isfinite(r)) continue;
        moved(k) += F * r, load(k) += std::abs(F), sum(k) += r, count(k) += 1;
      }
    }
    SignedResidual s;
    for (int k = 0; k < 3; ++k) {
      s.along(k) = load(k) > 0 ? moved(k) / load(k) : NAN;
      s.mean(k) = count(k) > 0 ? sum(k) / count(k) : NAN;
    }
    out.push_back(s);
  }
  return out;
}

namespace {

/// The figure: one panel for each component and quantity, every pose a mark where the tool point stands.
class SignedMap {
 public:
  SignedMap(const compare::Comparison& c, const FigureStyle& style)
      : c_(c),
        unit_(report::error_unit(c)),
        values_(signed_residuals(c)),
        box_(box_of(c)),
        s_("residual-map", style, 160) {
    find_scale();
    seen_ = fmt::format("x to the right {}, y into the page {}, z up {} mm", range(0), range(1), range(2));
  }

  Figure figure() {
    put_data();
    lay_out();
    const double top =
        s_.heading("Signed residual by pose", {report::subjects(c_), seen_ + "; circles > 0, squares < 0"});
    for (std::size_t i = 0; i < rows_ * columns_; ++i) draw(i, top);
    s_.put("unset multiplot");
    return s_.figure(top + static_cast<double>(rows_) * row_ + (upright() ? 3.2 * s_.line() : 0.5 * s_.line()),
                     caption());
  }

 private:
  bool upright() const { return s_.narrow(); }  // one column, else one row for each quantity

  /// What there is to draw, and how large it is.
  void find_scale() {
    for (const SignedResidual& v : values_)
      for (int k = 0; k < 3; ++k)
        for (const int kind : {0, 1}) {
          const double x = (kind == 0 ? v.along : v.mean)(k);
          if (!std::isfinite(x)) continue;
          any_[kind][k] = true;
          most_ = std::max(most_, report::um * std::abs(x));
        }
    most_ = std::max(most_, 1e-3);
    for (const int kind : {0, 1})
      if (any_[kind][0] || any_[kind][1] || any_[kind][2]) kinds_.push_back(kind);
    for (int k = 0; k < 3; ++k)
      if (any_[0][k] || any_[1][k]) components_.push_back(k);
  }

  Vector3 at_mm(std::size_t pose) const { return report::mm * c_.study.standing->tool(pose).p_W; }

  std::string range(int k) const {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t p = 0; p < c_.study.standing->poses(); ++p)
      low = std::min(low, at_mm(p)(k)), high = std::max(high, at_mm(p)(k));
    return low == high ? fmt::format("{:.4g}", low + 0.0) : fmt::format("{:.4g} … {:.4g}", low + 0.0, high + 0.0);
  }

  /// The poses, from behind to the front.
  void put_data() {
    std::vector<std::size_t> order(values_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return at_mm(a).y() > at_mm(b).y(); });
    s_.put("{}$data << EOD", frame_of(box_));
    for (const std::size_t p : order) {
      const Vector3 at = at_mm(p), foot(at.x(), at.y(), box_.low.z());
      std::string row = fmt::format("{:.5g} {:.5g} {:.5g}", box_.across(at), box_.up(at), box_.up(foot));
      for (const Vector3& v : {values_[p].along, values_[p].mean})
        for (int k = 0; k < 3; ++k) row += fmt::format(" {:.5g}", report::um * v(k));
      s_.put("{}", row);
    }
    s_.put("EOD\nset multiplot\nunset key\nunset border\nunset tics\n{}\nset cbrange [{}:{}]", diverging_palette,
           -most_, most_);
  }

  void lay_out() {
    columns_ = upright() ? kinds_.size() : components_.size();
    rows_ = upright() ? components_.size() : kinds_.size();
    bar_ = upright() ? 0 : 6 + s_.text_mm(5) + 1.5 * s_.line();
    const auto count = static_cast<double>(columns_);
    w_ = std::min((s_.width() - 2 * margin - bar_ - gap * (count - 1)) / count, 60.0);
    const Vector3 extent = box_.high - box_.low;
    const double wide = extent.x() + depth_x * extent.y(), tall = extent.z() + depth_z * extent.y();
    h_ = std::clamp(w_ * tall / wide, 0.45 * w_, 1.3 * w_);
    row_ = h_ + 1.9 * s_.line();
    const double room = 1.03 * std::max(tall / h_, wide / w_);  // mm of the machine for one on paper
    s_.put("set xrange [{}:{}]\nset yrange [{}:{}]", box_.low.x() + wide / 2 - room * w_ / 2,
           box_.low.x() + wide / 2 + room * w_ / 2, box_.low.z() + tall / 2 - room * h_ / 2,
           box_.low.z() + tall / 2 + room * h_ / 2);
  }

  void draw(std::size_t i, double top) {
    const int kind = kinds_[upright() ? i % columns_ : i / columns_],
              k = components_[upright() ? i / columns_ : i % columns_];
    const double x = margin + static_cast<double>(i % columns_) * (w_ + gap),
                 y = top + static_cast<double>(i / columns_) * row_ + 1.6 * s_.line();
    s_.panel(x, y, w_, h_);
    s_.label(kind == 0 ? fmt::format("{} in the sense of {}", unit_.components[k], unit_.loads[k])
                       : fmt::format("{}, mean", unit_.components[k]),
             x + w_ / 2, y - 0.6 * s_.line(), "center");
    if (i + 1 == rows_ * columns_)
      put_colours(top, y);
    else
      s_.put("unset colorbox");
    const double marker =
        std::clamp(0.048 * w_ / std::sqrt(std::max(1.0, static_cast<double>(values_.size()) / 12)), 0.5, 2.0);
    const int column = 4 + 3 * kind + k;
    const std::string some = fmt::format("'' using (${0}>=0?$1:NaN):2", column),
                      less = fmt::format("'' using (${0}<0?$1:NaN):2", column);
    s_.plot(fmt::format(
        "plot $box with lines lc rgb '#B0B0B0' lw 0.5, $data using 1:2:(0):($3-$2) with vectors nohead lc rgb "
        "'#B0B0B0' "
        "lw 0.5, {0} with points pt 7 ps {2:.3f} lc rgb '#404040', {0}:{4} with points pt 7 ps {3:.3f} lc palette, "
        "{1} with points pt 5 ps {2:.3f} lc rgb '#404040', {1}:{4} with points pt 5 ps {3:.3f} lc palette",
        some, less, marker, 0.86 * marker, column));
  }

  /// The bar of colours: beside the panels, on narrow paper below the last one, whose top is y.
  void put_colours(double top, double y) {
    const Tics tics = s_.tics(-most_, most_, upright() ? 0.7 * s_.width() : 40, !upright());
    if (upright()) {
      s_.put("set colorbox horizontal user {} size screen {:.4f},{:.4f}/H\nset cbtics {} scale 0.4",
             "origin " + s_.at(0.15 * s_.width(), y + h_ + 1.2 * s_.line() + 3).substr(3), 0.7, 3.0, tics.step);
      s_.label(unit_.micro, 0.85 * s_.width() + 2, y + h_ + 1.2 * s_.line() + 1.5, "left");
      return;
    }
    s_.put("set colorbox vertical user {} size screen {:.4f},{:.4f}/H\nset cbtics {} scale 0.4",
           "origin " + s_.at(s_.width() - bar_, y + h_).substr(3), 3.5 / s_.width(), y + h_ - top - 1.6 * s_.line(),
           tics.step);
    s_.label(fmt::format("measured − predicted ({})", unit_.micro), s_.width() - 0.6 * s_.line(),
             (top + 1.6 * s_.line() + y + h_) / 2, "center rotate by 90");
  }

  std::string caption() const {
    std::string meaning;
    if (any_[0][0] || any_[0][1] || any_[0][2])
      meaning = fmt::format(
          "In the sense of {0}: the mean of the residual with the sign of the load's component ({1}), weighed by its "
          "size, "
          "so that positive means that the machine yields more than predicted. ",
          unit_.loads[0] + std::string(", ") + unit_.loads[1] + ", " + unit_.loads[2], unit_.load);
    return fmt::format(
        "Signed residual of each component at every pose, in {0}, on one scale of ±{1:.3g} {0} "
        "(blue and squares negative, red and circles positive). {2}Mean: over all readings of the "
        "pose, what does not change its sign with the load.{3} The workspace is seen obliquely, {4}. "
        "{5} {6} {7}",
        unit_.micro, most_, meaning,
        c_.set_aside.empty() ? "" : fmt::format(" {} gross outliers are left out.", c_.set_aside.size()), seen_,
        report::axes_sentence(c_), report::data_sentence(c_), report::noise_sentence(c_));
  }

  static constexpr double margin = 3, gap = 3;  // mm

  const compare::Comparison& c_;
  report::ErrorUnit unit_;
  std::vector<SignedResidual> values_;
  Box box_;
  Sheet s_;
  bool any_[2][3] = {};                  // by quantity (in the sense of the load, mean) and component
  std::vector<int> kinds_, components_;  // of which there are any
  double most_ = 0;                      // the end of the scale
  std::string seen_;
  std::size_t rows_ = 0, columns_ = 0;
  double bar_ = 0, w_ = 0, h_ = 0, row_ = 0;  // mm: room of the bar of colours, a panel, a row of panels
};

}  // namespace

std::optional<Figure> residual_map(const compare::Comparison& c, const FigureStyle& style) {
  return SignedMap(c, style).figure();
}

}  // namespace deflect::figures
