#include "validation/cli/figures.h"

#include <fmt/format.h>

#include "msa/base/error.h"
#include "validation/cli/devices.h"
#include "validation/cli/talk.h"

namespace deflect::cli {

std::vector<Option> with_figures(std::vector<Option> options, FigureArguments* a) {
  options.push_back({"--figure-width", "LENGTH",
                     "width of figures on paper, with unit, such as '88 mm' (default: each figure's own)", &a->width});
  options.push_back(
      {"--figure-font", "NAME", "font of text in figures, by its fontconfig name (default: DejaVu Sans)", &a->font});
  options.push_back({"--figure-font-size", "PT", "size of text in figures, in points (default 8)", &a->size});
  return options;
}

figures::FigureStyle figure_style(const FigureArguments& a, const std::string& out) {
  if (out.empty() && !(a.width + a.font + a.size).empty())
    throw InputError("--figure-width, --figure-font and --figure-font-size belong to --out, which draws figures");
  figures::FigureStyle style;
  if (!a.width.empty()) style.width_mm = 1e3 * parse_length("--figure-width", a.width);
  if (!a.size.empty()) style.size_pt = parse_list("--figure-font-size", a.size, {1}, "points")[0];
  if (!a.font.empty()) {
    style.font = a.font;
    figures::check_font(style.font);
  }
  figures::check_size(style);
  return style;
}

std::string draw(const std::vector<figures::Figure>& figures, const std::filesystem::path& folder) {
  std::string names, sizes;
  for (const figures::Figure& figure : figures) {
    names += (names.empty() ? "" : ", ") + figure.name;
    sizes +=
        fmt::format("{}{}: {:.4g} x {:.4g} mm, {} {:g} pt", sizes.empty() ? "" : "; ", (folder / figure.name).string(),
                    figure.width_mm, figure.height_mm, figure.style.font, figure.style.size_pt);
  }
  if (figures.empty()) return "";
  const Step step(fmt::format("figure{} {}", figures.size() == 1 ? "" : "s", sizes));
  figures::render_all(figures, folder);
  return names;
}

}  // namespace deflect::cli
