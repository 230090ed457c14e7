#include "validation/figures/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/parallel/cases.h"
#include "validation/parallel/child_process.h"

namespace deflect::figures {
namespace {

constexpr const char* remedy = "install it with `apt-get install gnuplot-nox fonts-dejavu-core`";
constexpr double points_per_mm = 72 / 25.4;
constexpr double png_dpi = 300;      // what printers ask for
constexpr double pango = 72.0 / 96;  // the cairo terminals take a point of text for 1/96 inch

/// Sizes are points in all three: the SVG's user unit is a point and its outer size is set in mm afterwards,
/// because gnuplot scales everything but markers there.
std::string terminal(const std::string& suffix, const Figure& figure) {
  const auto in_points = [](double length) { return std::lround(length * points_per_mm); };
  const auto in_pixels = [](double length) { return std::lround(length * png_dpi / 25.4); };
  const double w = figure.width_mm, h = figure.height_mm;
  const std::string font = fmt::format("font '{},{:.4g}'", figure.style.font, figure.style.size_pt);
  if (suffix == "svg") {  // standalone: images inside the file
    std::string name = figure.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
    return fmt::format("svg enhanced standalone size {},{} name '{}' {} background '#ffffff'", in_points(w),
                       in_points(h), name, font);
  }
  if (suffix == "pdf")
    return fmt::format("pdfcairo enhanced size {}cm,{}cm {} fontscale {} linewidth 1", w / 10, h / 10, font, pango);
  const double scale = png_dpi / 72;
  return fmt::format("pngcairo enhanced size {},{} {} fontscale {} linewidth {} pointscale {} background '#ffffff'",
                     in_pixels(w), in_pixels(h), font, pango * scale, scale, scale);
}

constexpr const char* common_look = R"(set minussign
set border 3 lc rgb '#404040' lw 0.7
set tics nomirror out scale 0.5 textcolor rgb '#202020'
set grid lt 1 lc rgb '#dedede' lw 0.5, lt 1 lc rgb '#dedede' lw 0.5
)";

/// Replaces in place what lies between `before` and `after`, first occurrence; nothing when they are not
/// there.
void replace_between(std::string& text, std::string_view before, std::string_view after, std::string_view with) {
  const std::size_t start = text.find(before);
  if (start == text.npos) return;
  const std::size_t from = start + before.size(), to = text.find(after, from);
  if (to != text.npos) text.replace(from, to - from, with);
}

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

/// What the figure is drawn with stands at the end of its caption.
std::string caption_of(const Figure& figure) {
  return figure.caption.empty() ? "" : fmt::format("{} Drawn by deflect {}.", figure.caption, DEFLECT_VERSION);
}

std::string finished_svg(std::string svg, const Figure& figure) {
  const std::string family = fmt::format("font-family=\"{}", figure.style.font);
  replace_between(svg, "width=\"", "\"", fmt::format("{}mm", figure.width_mm));
  replace_between(svg, "height=\"", "\"", fmt::format("{}mm", figure.height_mm));
  replace_between(svg, "<title>", "</title>", xml_text(figure.title.empty() ? figure.name : figure.title));
  replace_between(svg, "<desc>", "</desc>", xml_text(caption_of(figure)));
  replace_all(svg, family + ":Bold\"", family + "\" font-weight=\"bold\"");
  replace_all(svg, family + "\"", family + ", Verdana, sans-serif\"");
  return svg;
}

std::string draw(const std::string& suffix, const Figure& figure) {
  const std::string head = fmt::format("set encoding utf8\nset terminal {}\n{}", terminal(suffix, figure), common_look);
  // -d: a user's own gnuplotrc does not change the figure.
  parallel::ChildOutcome outcome = parallel::run_child({"gnuplot", "-d"}, head + figure.body + "\n");
  if (outcome.start_error != 0)
    throw InputError(fmt::format("figures need gnuplot, which cannot be started ({}): {}",
                                 std::strerror(outcome.start_error), remedy));
  if (outcome.errors.find("unknown or ambiguous terminal type") != std::string::npos)
    throw InputError(fmt::format("this gnuplot cannot write {} files: {}", suffix, remedy));
  if (!outcome.succeeded() || outcome.output.empty())
    throw std::logic_error(fmt::format("figure {}: gnuplot refused the script ({} lines stand before its body):\n{}",
                                       figure.name, std::count(head.begin(), head.end(), '\n'), outcome.errors));
  // Cairo stamps the time into a PDF, whatever SOURCE_DATE_EPOCH says; same length, so that its table of
  // offsets holds.
  if (suffix == "pdf") replace_between(outcome.output, "/CreationDate (D:", "Z)", "20000101000000");
  return suffix == "svg" ? finished_svg(std::move(outcome.output), figure) : std::move(outcome.output);
}

}  // namespace

std::vector<std::filesystem::path> render_all(const std::vector<Figure>& figures, const std::filesystem::path& folder) {
  const std::string allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  for (const Figure& figure : figures)
    if (figure.name.empty() || figure.name.find_first_not_of(allowed) != std::string::npos)
      throw std::logic_error(fmt::format("'{}' is no name for a figure's files", figure.name));
  const std::array<std::string, 3> suffixes = {"svg", "pdf", "png"};
  std::vector<std::string> pictures(figures.size() * suffixes.size());
  parallel::for_each_case(pictures.size(), 1, 0, [&](std::size_t i) {
    pictures[i] = draw(suffixes[i % suffixes.size()], figures[i / suffixes.size()]);
  });
  std::vector<std::filesystem::path> paths;
  for (std::size_t k = 0; k < figures.size(); ++k) {
    for (std::size_t i = 0; i < suffixes.size(); ++i) {
      paths.push_back(folder / (figures[k].name + "." + suffixes[i]));
      write_text(paths.back(), pictures[k * suffixes.size() + i]);
    }
    if (figures[k].caption.empty()) continue;
    paths.push_back(folder / (figures[k].name + ".txt"));
    write_text(paths.back(), caption_of(figures[k]) + "\n");
  }
  return paths;
}

std::vector<std::filesystem::path> render(const Figure& figure, const std::filesystem::path& folder) {
  return render_all({figure}, folder);
}

std::string gnuplot_quote(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += '\'';
    quoted += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return quoted + "'";
}

std::string gnuplot_tic_label(std::string_view text) {
  std::string doubled;
  for (const char c : text) doubled.append(c == '%' ? 2 : 1, c);
  return gnuplot_quote(doubled);
}

}  // namespace deflect::figures
