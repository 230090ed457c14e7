// Figures by gnuplot, run as a child process: one script body, three files of one look, and a caption.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "validation/figures/figure_style.h"

namespace deflect::figures {

/// A figure as gnuplot commands with inline data. The body sets neither terminal nor output nor encoding; its
/// font sizes are points, its line widths points at `lw 1`, and it may count on the common look set by
/// render(): open border, tics outside, grey grid, typographic minus. Text without a font of its own has the style's.
struct Figure {
  std::string name;  ///< of the files, without suffix: letters, digits, '-', '_', '.'
  std::string body;
  double width_mm = 160, height_mm = 100;
  std::string title = {};    ///< of the SVG
  std::string caption = {};  ///< one paragraph, ready to paste: what is drawn, units, load, frame, sign, data
  FigureStyle style = {};    ///< font and size of the text; the body is laid out for them
};

/// Writes of each figure name.svg, name.pdf, name.png (300 dpi) and, with a caption, name.txt into the folder, creating
/// it, and returns their paths. The caption ends with the program's version and is the SVG's description too. Every
/// file is drawn by a gnuplot of its own, as many at a time as the machine has cores; all are drawn before the first is
/// written, so a refused script leaves the folder as it was, and each file is replaced whole. The same figure gives the
/// same bytes. Throws InputError when gnuplot is not installed or the folder cannot be written, std::logic_error with
/// gnuplot's own words when it refuses a script.
std::vector<std::filesystem::path> render_all(const std::vector<Figure>&, const std::filesystem::path& folder);
std::vector<std::filesystem::path> render(const Figure&, const std::filesystem::path& folder);

/// The text as a gnuplot string that prints as it is, wherever `noenhanced` is set; control characters become
/// spaces.
std::string gnuplot_quote(std::string_view text);

/// The same for a label of a tic, where gnuplot would take a percent sign as a format.
std::string gnuplot_tic_label(std::string_view text);

}  // namespace deflect::figures
