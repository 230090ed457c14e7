#include "validation/figures/figure_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "msa/base/error.h"
#include "validation/parallel/child_process.h"

namespace deflect::figures {
namespace {

constexpr double narrowest_in_lines = 15.5, line_mm_per_pt = 0.5;

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// Whether one of the names of "DejaVu Sans,DejaVu Sans Condensed" is this one.
bool names_family(const std::string& families, const std::string& family) {
  for (std::size_t from = 0; from <= families.size();) {
    const std::size_t to = std::min(families.find(',', from), families.size());
    if (lower(families.substr(from, to - from)) == lower(family)) return true;
    from = to + 1;
  }
  return false;
}

}  // namespace

void check_size(const FigureStyle& style) {
  if (!(style.size_pt >= 4 && style.size_pt <= 24))
    throw InputError(fmt::format("figures: text of {:g} pt: 4 to 24 pt are wanted", style.size_pt));
  if (style.width_mm == 0) return;
  if (!(style.width_mm >= 30 && style.width_mm <= 600))
    throw InputError(fmt::format("figures: a width of {:g} mm: 30 to 600 mm are wanted", style.width_mm));
  const double narrowest = narrowest_in_lines * line_mm_per_pt * style.size_pt;
  if (style.width_mm < narrowest)
    throw InputError(
        fmt::format("figures: {:g} mm are too narrow for text of {:g} pt: give {:.0f} mm or more, or smaller text",
                    style.width_mm, style.size_pt, narrowest));
}

void check_font(const std::string& family) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 ||
           std::string_view(" -_.+&").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (family.empty() || !std::all_of(family.begin(), family.end(), plain))
    throw InputError(fmt::format("figures: '{}' is no name of a font's family; `fc-list : family` lists them", family));
  std::string pattern;
  for (const char c : family) pattern += c == '-' ? std::string("\\-") : std::string(1, c);
  const parallel::ChildOutcome found = parallel::run_child({"fc-match", "--format", "%{family}", pattern}, "");
  if (!found.succeeded())
    throw InputError(
        fmt::format("figures: whether the font '{}' is installed cannot be seen without fc-match: install it with "
                    "`apt-get install fontconfig`",
                    family));
  if (names_family(found.output, family)) return;
  throw InputError(fmt::format(
      "figures: the font '{}' is not installed; fontconfig would take '{}' in its place. Install it, or name "
      "one that `fc-list : family` lists",
      family, found.output.substr(0, found.output.find(','))));
}

}  // namespace deflect::figures
