#include "validation/report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "msa/base/error.h"
#include "msa/base/files.h"

namespace deflect {
namespace {

constexpr const char* remedy = "install it with `apt-get install gnuplot-nox fonts-dejavu-core`";
constexpr double points_per_mm = 72 / 25.4;
constexpr double png_dpi = 200;
constexpr double pango = 72.0 / 96;  // the cairo terminals take a point of text for 1/96 inch

/// A file in memory. The child reads and writes such files instead of pipes: nobody ever waits for a reader,
/// and no half-written picture can remain on a disk.
class MemoryFile {
 public:
  MemoryFile() : fd_(::memfd_create("deflect-gnuplot", MFD_CLOEXEC)) {
    if (fd_ < 0) throw InputError(fmt::format("no memory for a figure ({})", std::strerror(errno)));
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(fd_); }

  int fd() const { return fd_; }

  void write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t n = ::write(fd_, text.data(), text.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) throw InputError(fmt::format("no memory for a figure ({})", std::strerror(errno)));
      text.remove_prefix(static_cast<std::size_t>(n));
    }
    ::lseek(fd_, 0, SEEK_SET);
  }

  std::string read() const {
    ::lseek(fd_, 0, SEEK_SET);
    std::string text;
    std::array<char, 65536> block;
    for (;;) {
      const ssize_t n = ::read(fd_, block.data(), block.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return text;
      text.append(block.data(), static_cast<std::size_t>(n));
    }
  }

 private:
  int fd_;
};

struct Outcome {
  int status = 0;  ///< as waitpid gives it
  std::string output, errors;
};

Outcome run_gnuplot(const std::string& script) {
  const MemoryFile input, output, errors;
  input.write(script);

  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, input.fd(), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, output.fd(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, errors.fd(), STDERR_FILENO);
  std::string program = "gnuplot", option = "-d";  // -d: a user's own gnuplotrc does not change the figure
  std::array<char*, 3> arguments = {program.data(), option.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw InputError(
        fmt::format("figures need gnuplot, which cannot be started ({}): {}", std::strerror(error), remedy));

  Outcome outcome;
  while (::waitpid(child, &outcome.status, 0) < 0)
    if (errno != EINTR) throw std::logic_error(fmt::format("waiting for gnuplot: {}", std::strerror(errno)));
  outcome.output = output.read();
  outcome.errors = errors.read();
  return outcome;
}

/// Sizes are points in all three: the SVG's user unit is a point and its outer size is set in mm afterwards,
/// because gnuplot scales everything but markers there.
std::string terminal(const std::string& suffix, const Figure& figure) {
  const auto in_points = [](double mm) { return std::lround(mm * points_per_mm); };
  const auto in_pixels = [](double mm) { return std::lround(mm * png_dpi / 25.4); };
  const double w = figure.width_mm, h = figure.height_mm;
  if (suffix == "svg") {  // standalone: images inside the file
    std::string name = figure.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
    return fmt::format("svg enhanced standalone size {},{} name '{}' font 'DejaVu Sans,8' background '#ffffff'",
                       in_points(w), in_points(h), name);
  }
  if (suffix == "pdf")
    return fmt::format("pdfcairo enhanced size {}cm,{}cm font 'DejaVu Sans,8' fontscale 1 linewidth 1", w / 10, h / 10);
  const double scale = png_dpi / 72;
  return fmt::format(
      "pngcairo enhanced size {},{} font 'DejaVu Sans,8' fontscale {} linewidth {} pointscale {} "
      "background '#ffffff'",
      in_pixels(w), in_pixels(h), pango * scale, scale, scale);
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

std::string draw(const std::string& suffix, const Figure& figure) {
  const std::string head = fmt::format("set encoding utf8\nset terminal {}\n{}", terminal(suffix, figure), common_look);
  Outcome outcome = run_gnuplot(head + figure.body + "\n");
  if (outcome.errors.find("unknown or ambiguous terminal type") != std::string::npos)
    throw InputError(fmt::format("this gnuplot cannot write {} files: {}", suffix, remedy));
  if (!WIFEXITED(outcome.status) || WEXITSTATUS(outcome.status) != 0 || outcome.output.empty())
    throw std::logic_error(fmt::format("figure {}: gnuplot refused the script ({} lines stand before its body):\n{}",
                                       figure.name, std::count(head.begin(), head.end(), '\n'), outcome.errors));
  // Cairo stamps the time into a PDF, whatever SOURCE_DATE_EPOCH says; same length, so that its table of
  // offsets holds.
  if (suffix == "pdf") replace_between(outcome.output, "/CreationDate (D:", "Z)", "20000101000000");
  if (suffix == "svg") {
    replace_between(outcome.output, "width=\"", "\"", fmt::format("{}mm", figure.width_mm));
    replace_all(outcome.output, R"(font-family="DejaVu Sans:Bold")", R"(font-family="DejaVu Sans" font-weight="bold")");
    replace_all(outcome.output, R"(font-family="DejaVu Sans")", R"(font-family="DejaVu Sans, Verdana, sans-serif")");
    replace_between(outcome.output, "height=\"", "\"", fmt::format("{}mm", figure.height_mm));
  }
  return outcome.output;
}

}  // namespace

std::vector<std::filesystem::path> render(const Figure& figure, const std::filesystem::path& folder) {
  const std::string allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  if (figure.name.empty() || figure.name.find_first_not_of(allowed) != std::string::npos)
    throw std::logic_error(fmt::format("'{}' is no name for a figure's files", figure.name));
  const std::array<std::string, 3> suffixes = {"svg", "pdf", "png"};
  std::array<std::string, 3> pictures;
  std::transform(suffixes.begin(), suffixes.end(), pictures.begin(),
                 [&](const std::string& suffix) { return draw(suffix, figure); });
  std::vector<std::filesystem::path> paths;
  for (std::size_t i = 0; i < suffixes.size(); ++i) {
    paths.push_back(folder / (figure.name + "." + suffixes[i]));
    write_text(paths.back(), pictures[i]);
  }
  return paths;
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

}  // namespace deflect
