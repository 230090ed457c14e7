#include "validation/figures/sheet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "msa/base/index.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

constexpr double mm_per_pt = 25.4 / 72;
// Widths in sizes of the font, on average in DejaVu Sans: of numbers and names, of sentences, of bold sentences.
constexpr double letter = 0.62, prose = 0.53, bold_prose = 0.61;
constexpr double title_size = 1.125, note_size = 0.94;

/// 1, 2 or 5 times a power of ten, the smallest that is not below x > 0.
double nice_above(double x) {
  const double power = std::pow(10, std::floor(std::log10(x))), lead = x / power;
  return (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10) * power;
}

}  // namespace

Sheet::Sheet(std::string name, const FigureStyle& style, double usual_width_mm)
    : name_(std::move(name)), style_(style), width_(style.width_mm > 0 ? style.width_mm : usual_width_mm) {
  check_size({width_, style.font, style.size_pt});
}

double Sheet::text_mm(std::size_t letters, double size) const {
  return static_cast<double>(letters) * size * style_.size_pt * mm_per_pt * letter;
}

std::size_t Sheet::letters_in(double room_mm, double size, bool bold) const {
  return static_cast<std::size_t>(
      std::max(8.0, room_mm / (size * style_.size_pt * mm_per_pt * (bold ? bold_prose : prose))));
}

std::string Sheet::font(double size, bool bold) const {
  return fmt::format("font '{}{},{:.4g}'", style_.font, bold ? ":Bold" : "", size * style_.size_pt);
}

Tics Sheet::tics(double low, double high, double room_mm, bool upright) const {
  const double span = high > low ? high - low : 1;
  Tics t;
  for (double steps = 8; steps >= 2; --steps) {
    t.step = nice_above(span / steps * (1 - 1e-9));
    t.letters = 1;
    for (const double end : {std::floor(low / t.step) + 1, std::ceil(high / t.step) - 1})
      t.letters = std::max(t.letters, report::letters(fmt::format("{:.6g}", end * t.step)));
    const double each = upright ? 1.6 * line() : text_mm(t.letters + 2);
    if ((span / t.step) * each <= room_mm) break;
  }
  while (high > low && std::floor(high / t.step) - std::ceil(low / t.step) < 1) {  // one number says no scale
    t.step = nice_above(t.step * 0.4);
    t.letters = std::max(t.letters, report::letters(fmt::format("{:.6g}", std::ceil(low / t.step) * t.step)));
  }
  return t;
}

double Sheet::heading(const std::string& title, const std::vector<std::string>& notes, double x) {
  title_ = title;
  double y = 0.875 * line();
  const double room = width_ - x - 2;
  for (const std::string& each : report::wrap(title, letters_in(room, title_size, true))) {
    label(each, x, y, "left " + font(title_size, true));
    y += 1.1 * line();
  }
  for (const std::string& note : notes)
    for (const std::string& each : report::wrap(note, letters_in(room, note_size))) {
      label(each, x, y, "left textcolor rgb '#505050' " + font(note_size));
      y += line();
    }
  return y - 0.3 * line();
}

void Sheet::label(std::string_view text, double x, double y, const std::string& how) {
  put("set label {} {} {} noenhanced {}", ++labels_, gnuplot_quote(report::with_minus(text)), at(x, y), how);
}

void Sheet::axis_names(const std::string& across, const std::string& up, const Tics& up_tics) {
  if (!across.empty()) {
    const double half = static_cast<double>(report::letters(across)) * style_.size_pt * mm_per_pt * prose / 2 + 1.5;
    label(across, std::max(half, std::min(x_ + w_ / 2, width_ - half)), y_ + h_ + 2.1 * line(), "center");
  }
  if (!up.empty()) label(up, x_ - left_of(up_tics) + 0.5 * line(), y_ + h_ / 2, "center rotate by 90");
}

void Sheet::panel(double x, double y, double w, double h) {
  x_ = x, y_ = y, w_ = w, h_ = h;
  put("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", x / width_, (x + w) / width_);
  put("set tmargin at screen 1-{:.4f}/H\nset bmargin at screen 1-{:.4f}/H", y, y + h);
}

void Sheet::plot(const std::string& series) {
  put("{}", series);
  for (; labels_ > 0; --labels_) put("unset label {}", labels_);
}

std::string Sheet::at(double x, double y) const { return fmt::format("at screen {:.5f},1-{:.4f}/H", x / width_, y); }

Figure Sheet::figure(double height_mm, std::string caption) const {
  return {name_, fmt::format("H = {:.4f}\n", height_mm) + body_, width_, height_mm, title_, report::with_minus(caption),
          style_};
}

}  // namespace deflect::figures
