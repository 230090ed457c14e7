#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/units.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/studies/workspace.h"

namespace deflect::cli {
namespace {
namespace fs = std::filesystem;

struct NewArguments {
  std::string like, out;
  bool force = false;
};

/// Words for kinds of machines, and the built-in device or frame that is given for each.
struct Likeness {
  const char *word, *built_in;
};
constexpr Likeness likenesses[] = {
    {"scara", "scara"}, {"arm", "arm"},     {"gantry", "gantry"},   {"delta", "delta"}, {"hexapod", "stewart-6ups"},
    {"3-rrr", "3-rrr"}, {"3-upu", "3-upu"}, {"flexure", "flexure"}, {"truss", "truss"}, {"portal", "portal"}};

struct Template {
  fs::path file;
  bool frame = false;
};

Template template_of(const std::string& like) {
  std::vector<std::string> words;
  for (const Likeness& each : likenesses) words.emplace_back(each.word);
  const auto found = std::find(words.begin(), words.end(), like);
  const std::string name = found == words.end() ? like : likenesses[found - words.begin()].built_in;
  const auto among = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (among(device_names())) return {device_file(name), false};
  if (among(frame_names())) return {frame_file(name), true};
  const std::string hint = nearest(like, words);
  throw InputError(
      fmt::format("--like {}: there is no such machine{} (known: {}, and the names that 'deflect devices' "
                  "lists)",
                  like, hint.empty() ? "" : fmt::format(", did you mean '{}'?", hint), fmt::join(words, ", ")));
}

/// As a shell takes it.
std::string quoted(const std::string& path) {
  const bool plain = std::all_of(path.begin(), path.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '/' || c == '.' || c == '-' || c == '_' || c > 127;
  });
  return plain ? path : "'" + path + "'";
}

/// Commands that take the file as it is.
std::vector<std::string> first_commands(const Template& source, const std::string& file) {
  if (source.frame)
    return {fmt::format("deflect show {} --report drawing.html", file), fmt::format("deflect frame {}", file)};
  const Mechanism m = read_mechanism(source.file);
  std::string where;
  if (!actuators_of(m).empty()) {
    Vector6 pose = ((studies::workspace_points(m).front().pose_mm_deg * 1e6).array().round() / 1e6).matrix();
    pose += Vector6::Zero();  // no −0
    where = fmt::format(" --pose={:.10g}", fmt::join(pose, ","));
  }
  return {fmt::format("deflect show {} --report drawing.html", file),
          fmt::format("deflect solve {}{} --load 0,0,-10", file, where),
          fmt::format("deflect map {} --n 5", file),
          fmt::format("deflect simulate {} --campaign paper --with tool_compliance --seed 1 -o data.csv", file),
          fmt::format("deflect compare {} data.csv", file),
          fmt::format("deflect diagnose {} data.csv", file)};
}

/// The file with its own name in it, and what to do with it above.
std::string text_of(const Template& source, const fs::path& out, const std::vector<std::string>& commands) {
  const std::string text = read_text(source.file), mark = "\nname: ";
  const std::size_t at = text.find(mark), end = text.find('\n', at + 1);
  std::string stem = out.stem().string();
  const bool plain =
      !stem.empty() && stem.size() < 100 && std::isalpha(static_cast<unsigned char>(stem.front())) &&
      std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; });
  if (!plain) stem = source.file.stem().string();
  std::string head = "# Edit this file and try:\n";
  for (const std::string& command : commands) head += fmt::format("#   {}\n", command);
  head += fmt::format("# All keys: deflect {} --schema\n#\n", source.frame ? "frame" : "devices");
  return head + text.substr(0, at) + mark + stem + text.substr(end);
}

void run(const NewArguments& a) {
  const Template source = template_of(a.like);
  std::error_code error;
  if (!a.force && fs::is_regular_file(a.out, error))
    throw InputError(fmt::format("{}: exists already: name another file, or overwrite it with --force", a.out));
  const std::vector<std::string> commands = first_commands(source, quoted(a.out));
  const std::string text = text_of(source, a.out, commands);
  if (source.frame)
    frame::parse_frame(text, a.out);
  else
    parse_mechanism(text, a.out);
  write_file(a.out, text);
  fmt::print("{}: a {} like {}. Try:\n  {}\n", a.out, source.frame ? "frame" : "device", a.like,
             fmt::join(commands, "\n  "));
}

}  // namespace

Command new_command() {
  auto a = std::make_shared<NewArguments>();
  std::vector<std::string> words;
  for (const Likeness& each : likenesses) words.emplace_back(each.word);
  return {"new",
          "Write a first file for your own machine: a commented device or frame to edit. It runs unchanged, and the "
          "comments at its top list commands to try",
          "deflect new --like scara -o mine.yaml",
          {{"--like", "MACHINE", fmt::format("{}, or any built-in device or frame", fmt::join(words, ", ")), &a->like,
            true},
           {"-o,--output", "FILE", "file to write", &a->out, true},
           {"--force", "", "overwrite an existing file", &a->force}},
          [a] { run(*a); }};
}

}  // namespace deflect::cli
