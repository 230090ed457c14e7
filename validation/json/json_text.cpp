#include "validation/json/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::json {
namespace {

/// One line, "{"point": 0, "pose": [0.0, …]}": nlohmann's compact form has no spaces.
std::string one_line(const Json& value) {
  if (!value.is_structured()) return compact(value);
  std::string text;
  for (const auto& [key, item] : value.items()) {
    if (!text.empty()) text += ", ";
    if (value.is_object()) text += compact(key) + ": ";
    text += one_line(item);
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

std::string indented(const Json& value, std::size_t depth, bool in_list) {
  const bool plain = std::none_of(value.begin(), value.end(), [](const Json& item) { return item.is_structured(); });
  if (!value.is_structured() || value.empty() || (value.is_array() && plain) || in_list) return one_line(value);
  const std::string margin(2 * depth + 2, ' ');
  std::string text;
  for (const auto& [key, item] : value.items()) {
    text += (text.empty() ? "\n" : ",\n") + margin;
    if (value.is_object()) text += compact(key) + ": ";
    text += indented(item, depth + 1, value.is_array());
  }
  text.append("\n").append(2 * depth, ' ');
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

constexpr int deepest = 32;  // lists and objects in each other: results have six

std::size_t line_at(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + as_index(std::min(byte, text.size()));
  return 1 + as_size(std::count(text.begin(), end, '\n'));
}

/// A nesting that is too deep is refused before the parser follows it.
void require_shallow(const std::string& text, const std::string& origin, const std::string& remedy) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quoted && text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      quoted = !quoted;
    else if (!quoted && (text[i] == '[' || text[i] == '{')) {
      if (++depth > deepest)
        throw InputError(fmt::format("{}:{}: nested more than {} deep: {}", origin, line_at(text, i), deepest, remedy));
    } else if (!quoted && (text[i] == ']' || text[i] == '}'))
      --depth;
  }
}

}  // namespace

std::string compact(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json json_number(double value, const std::string& what) {
  if (!std::isfinite(value)) throw NumericalError(fmt::format("result '{}' is {}, not a number to write", what, value));
  return value;
}

Json json_numbers(const Vector6& values, const std::string& what) {
  Json list = Json::array();
  for (int i = 0; i < 6; ++i) list.push_back(json_number(values[i], fmt::format("{}[{}]", what, i)));
  return list;
}

Json json_rows(const Matrix6& values, const std::string& what) {
  Json rows = Json::array();
  for (int i = 0; i < 6; ++i) rows.push_back(json_numbers(values.row(i).transpose(), fmt::format("{}[{}]", what, i)));
  return rows;
}

std::string json_text(const Json& value) { return indented(value, 0, false) + "\n"; }

Json parse_json(const std::string& text, const std::string& origin, const std::string& remedy) {
  if (text.find_first_not_of(" \t\r\n") == text.npos) throw InputError(fmt::format("{}:1: the file is empty", origin));
  require_shallow(text, origin, remedy);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    throw InputError(
        fmt::format("{}:{}: not valid JSON: {}", origin, line_at(text, e.byte > 0 ? e.byte - 1 : 0), remedy));
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}: a number is beyond what a double holds: {}", origin, remedy));
  }
}

}  // namespace deflect::json
