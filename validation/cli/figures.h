// Options of commands that draw figures, and drawing them.
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

/// The command's own options, followed by those of figures.
std::vector<Option> with_figures(std::vector<Option>, FigureArguments*);

/// To call before any work. InputError if the size or font is unusable, or if options are given without `out`.
figures::FigureStyle figure_style(const FigureArguments&, const std::string& out);

/// Draws all figures, in parallel, into the folder. Returns their names, separated by commas.
std::string draw(const std::vector<figures::Figure>&, const std::filesystem::path& folder);

}  // namespace deflect::cli
