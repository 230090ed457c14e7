// The options of commands that draw, and the drawing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/cli/command.h"
#include "validation/figures/gnuplot.h"

namespace deflect::cli {

struct FigureArguments {
  std::string width, font, size;
};

/// The command's own options, and those of figures behind them.
std::vector<Option> with_figures(std::vector<Option>, FigureArguments*);

/// Before any work: InputError where text or font cannot be had, or where no figures are asked for (`out` is empty).
FigureStyle figure_style(const FigureArguments&, const std::string& out);

/// Draws all of them, side by side, into the folder; their names, joined by commas.
std::string draw(const std::vector<Figure>&, const std::filesystem::path& folder);

}  // namespace deflect::cli
