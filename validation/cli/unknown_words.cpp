#include "validation/cli/unknown_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "msa/base/index.h"
#include "msa/base/units.h"

namespace deflect::cli {
namespace {

bool is_option(const std::string& word) {  // "-50,0,0" is a value
  return word.size() > 1 && word[0] == '-' && (word[1] == '-' || std::isalpha(static_cast<unsigned char>(word[1])));
}

/// "-o,--output" as two.
void add_flags(const std::string& flags, std::vector<std::string>& known) {
  for (std::size_t from = 0; from < flags.size();) {
    const std::size_t to = std::min(flags.find(',', from), flags.size());
    if (flags[from] == '-') known.push_back(flags.substr(from, to - from));
    from = to + 1;
  }
}

std::string with_nearest(const std::string& what, const std::string& word, const std::vector<std::string>& known) {
  const std::string hint = nearest(word, known);
  return fmt::format("{}{} (known: {})", what, hint.empty() ? "" : fmt::format(", did you mean '{}'?", hint),
                     fmt::join(known, ", "));
}

std::string unknown_option(const Command& command, const std::vector<std::string>& arguments, std::size_t from) {
  std::vector<std::string> known;
  for (const Option& option : command.options) add_flags(option.flags, known);
  known.insert(known.end(), {"--quiet", "--verbose", "--help", "-h"});
  for (std::size_t i = from; i < arguments.size(); ++i) {
    const std::string word = arguments[i].substr(0, arguments[i].find('='));
    if (!is_option(word) || std::find(known.begin(), known.end(), word) != known.end()) continue;
    if (word[1] != '-' && std::find(known.begin(), known.end(), word.substr(0, 2)) != known.end()) continue;  // -oFILE
    known.pop_back();
    return with_nearest(fmt::format("{} has no option '{}'", command.name, word), word, known);
  }
  return "";
}

}  // namespace

std::string unknown_word(const std::vector<Command>& commands, const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  const auto typed = std::find_if_not(arguments.begin(), arguments.end(), is_option);
  if (typed == arguments.end())
    return arguments.empty() ? fmt::format("give a command: {}; 'deflect --help' explains them", fmt::join(names, ", "))
                             : "";
  for (const Command& command : commands)
    if (command.name == *typed) return unknown_option(command, arguments, as_size(typed - arguments.begin()) + 1);
  return with_nearest(fmt::format("there is no command '{}'", *typed), *typed, names);
}

}  // namespace deflect::cli
