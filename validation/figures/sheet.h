// A figure laid out in mm from its upper left corner, for any width of paper and any size of text.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "validation/figures/gnuplot.h"

namespace deflect::figures {

/// Steps of an axis and the letters of its longest number.
struct Tics {
  double step = 1;
  std::size_t letters = 1;
};

/// Sizes of text are multiples of the style's. Widths of text are estimates that suit wide fonts.
class Sheet {
 public:
  Sheet(std::string name, const FigureStyle&, double usual_width_mm);

  double width() const { return width_; }
  double line() const { return 0.5 * style_.size_pt; }  ///< mm from one line of text to the next
  bool narrow() const { return width_ < 29 * line(); }  ///< one column of a journal rather than two
  double text_mm(std::size_t letters, double size = 1) const;
  std::size_t letters_in(double room_mm, double size = 1, bool bold = false) const;
  std::string font(double size = 1, bool bold = false) const;  ///< "font 'DejaVu Sans:Bold,9'"

  /// Round steps over a range on an axis of so many mm, as many as its numbers leave room for: side by side, or, of an
  /// upright axis, one above the other. At least two.
  Tics tics(double low, double high, double room_mm, bool upright = false) const;
  /// mm left of an upright axis and below a level one, for its numbers and, in one line, its name.
  double left_of(const Tics& t) const { return 2 * line() + text_mm(t.letters); }
  double below() const { return 2.75 * line(); }

  template <class... T>
  void put(fmt::format_string<T...> format, T&&... values) {
    body_ += fmt::format(format, std::forward<T>(values)...) + "\n";
  }
  /// A bold title and grey notes, each wrapped to the paper; y below them. The title is kept for the SVG.
  double heading(const std::string& title, const std::vector<std::string>& notes, double x = 3);
  /// A label of the next plot alone; `how` as gnuplot has it: "center rotate by 90".
  void label(std::string_view text, double x, double y, const std::string& how);
  /// The names of both axes of the panel, outside its numbers.
  void axis_names(const std::string& across, const std::string& up, const Tics& up_tics);
  /// Where the next plot stands.
  void panel(double x, double y, double w, double h);
  /// Plots into the panel and takes its labels away.
  void plot(const std::string& series);

  std::string at(double x, double y) const;  ///< "at screen …"
  Figure figure(double height_mm, std::string caption) const;

 private:
  std::string name_, title_, body_;
  FigureStyle style_;
  double width_, x_ = 0, y_ = 0, w_ = 0, h_ = 0;
  int labels_ = 0;
};

}  // namespace deflect::figures
