#include "validation/cli/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "analytic/erratum.h"
#include "msa/base/error.h"
#include "validation/cli/devices.h"
#include "validation/theories/theory.h"

namespace deflect::cli {
namespace {

/// Reads the command line up to the cursor: which command, which option is open, which positional argument is next.
/// `_deflect_takes` says what can stand there: words, @files, @folders, + first where any number of values may follow,
/// nothing where it cannot be listed; it fails where there is no such option or argument with a value.
constexpr const char* reader = R"bash(_deflect() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]-} takes='' open='' place=1 words='' at i
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$(_deflect_options '')" -- "$word")
    return
  fi
  for ((i = 2; i < COMP_CWORD; ++i)); do
    at=${COMP_WORDS[i]}
    if [[ $at == = ]]; then
      continue
    elif [[ $at == -[a-z-]* ]]; then
      open=
      if takes=$(_deflect_takes "$command" "$at"); then open=yes; fi
    elif [[ -z $open ]]; then
      ((++place))
    elif [[ $takes != +* ]]; then
      open=
    fi
  done
  if [[ $word == = ]]; then word=; fi
  if [[ -z $open ]] && ! takes=$(_deflect_takes "$command" "$place"); then words=$(_deflect_options "$command"); fi
  if [[ $word == -* ]] && [[ -z $open || $takes == +* ]]; then
    takes='' words=$(_deflect_options "$command")
  fi
  for at in ${takes#+}; do
    if [[ $at != @* ]]; then words+=" $at"; fi
  done
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  case $takes in
    *@files*)
      if ((${#COMPREPLY[@]})); then
        mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$word")
        compopt -o filenames 2>/dev/null
      else
        compopt -o default 2>/dev/null
      fi
      ;;
    *@folders*) compopt -o dirnames 2>/dev/null ;;
  esac
}
complete -F _deflect deflect
)bash";

/// Names of the YAML files in a folder of the program's data.
std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / folder, error))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

bool is_word(const std::string& piece) {
  return !piece.empty() && std::all_of(piece.begin(), piece.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

/// One line of `_deflect_takes`.
std::string line(const std::string& command, const std::string& place, const Option& option) {
  const Choices c = choices_of(option.value);
  std::vector<std::string> answer;
  if (c.files) answer.emplace_back("@files");
  if (c.folders) answer.emplace_back("@folders");
  answer.insert(answer.end(), c.words.begin(), c.words.end());
  const bool many = std::holds_alternative<std::vector<std::string>*>(option.target);
  return fmt::format("    '{} '{}) echo '{}{}' ;;\n", command, place, many ? "+" : "", fmt::join(answer, " "));
}

}  // namespace

Choices choices_of(const std::string& value) {
  static const std::vector<std::string> read_or_written = {"FILE", "DATA", "NEW_DEVICE", "K", "J", "R"};
  Choices c;
  for (const std::string& piece : split(value, '|')) {
    std::vector<std::string> names;
    if (piece == "DEVICE") {
      names = device_names();
    } else if (piece == "FRAME") {
      names = names_in("cases");
      for (const std::string& frame : names_in("frames")) names.push_back(frame);
    } else if (piece == "MACHINE") {  // a built-in one, no file
      names = device_names();
      for (const std::string& frame : names_in("frames")) names.push_back(frame);
    } else if (split(piece, ',').front() == "EFFECT") {
      names = names_in("effects/catalogue");
    } else if (piece == "THEORIES") {
      for (const theories::Theory* t : theories::all_theories()) names.push_back(t->name);
    } else if (piece == "ERRATA") {
      for (const ErratumInfo& e : errata()) names.push_back(e.name);
      names.emplace_back("all");
    } else if (is_word(piece)) {
      names = {piece};
    }
    c.words.insert(c.words.end(), names.begin(), names.end());
    const bool file = std::find(read_or_written.begin(), read_or_written.end(), piece) != read_or_written.end();
    c.files = c.files || file || piece == "DEVICE" || piece == "FRAME" || piece.ends_with(".json") ||
              piece.ends_with(".html");
    c.folders = c.folders || piece == "DIR";
  }
  return c;
}

std::string bash_completion(const std::vector<Command>& commands) {
  std::string takes, options, names;
  for (const Command& command : commands) {
    names += command.name + " ";
    std::string flags = "--help --quiet --verbose";
    int place = 0;
    for (const Option& option : command.options) {
      if (option.flags.front() != '-') {
        const bool many = std::holds_alternative<std::vector<std::string>*>(option.target);
        takes += line(command.name, many ? "[0-9]*" : std::to_string(++place), option);
        continue;
      }
      for (const std::string& flag : split(option.flags, ',')) {
        flags += " " + flag;
        if (!std::holds_alternative<bool*>(option.target)) takes += line(command.name, flag, option);
      }
    }
    options += fmt::format("    {}) echo '{}' ;;\n", command.name, flags);
  }
  return fmt::format(
      "# Completion of deflect in bash, made by 'deflect completion bash'.\n"
      "_deflect_takes() {{\n  case \"$1 $2\" in\n{}    *) return 1 ;;\n  esac\n}}\n"
      "_deflect_options() {{\n  case $1 in\n    '') echo '{}--help --version' ;;\n{}  esac\n}}\n{}",
      takes, names, options, reader);
}

Command completion_command(const std::vector<Command>& others) {
  auto shell = std::make_shared<std::string>();
  Command own{"completion",
              "Print a script that makes the shell complete commands, options, files, and the names of devices, "
              "effects and frames. Packages install it. Without a package, put the example's line into ~/.bashrc",
              "source <(deflect completion bash)",
              {{"shell", "bash", "the shell", shell.get(), true}},
              {}};
  std::vector<Command> all = others;
  all.push_back(own);
  own.run = Run([all, shell] {
    if (*shell != "bash")
      throw InputError(fmt::format("completion: there is no script for '{}', only for bash", *shell));
    fmt::print("{}", bash_completion(all));
  });
  return own;
}

}  // namespace deflect::cli
