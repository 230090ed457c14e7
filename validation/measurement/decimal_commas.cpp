#include "validation/measurement/decimal_commas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "validation/measurement/column_names.h"

namespace deflect::measurement {
namespace {

constexpr std::size_t most_columns_named = 6;

/// The first row whose cell in this column has a decimal comma; rows() where none has.
std::size_t first_comma(const CsvTable& table, std::size_t first_row, std::size_t column) {
  std::size_t row = first_row;
  while (row < table.rows() &&
         !(table.text(row, column).find(',') != std::string_view::npos && table.is_number(row, column)))
    ++row;
  return row;
}

}  // namespace

std::string decimal_comma_words(const CsvTable& table, std::size_t first_row, const std::vector<std::size_t>& text) {
  if (table.separator() == ',') return "";
  std::vector<std::string> names;
  std::size_t row = table.rows(), column = 0, all = 0;
  for (std::size_t c = 0; c < table.header().size(); ++c) {
    if (std::find(text.begin(), text.end(), c) != text.end()) continue;
    const std::size_t found = first_comma(table, first_row, c);
    if (found == table.rows()) continue;
    if (++all <= most_columns_named) names.push_back(excerpt(table.header()[c]));
    if (found < row) row = found, column = c;
  }
  if (names.empty()) return "";
  return fmt::format(
      "numbers with decimal commas are read, as '{}' in line {} is {}, in the column{} {}{}; {} separate "
      "columns",
      excerpt(table.text(row, column)), table.line(row), table.number(row, column), all == 1 ? "" : "s",
      fmt::join(names, ", "), all > names.size() ? fmt::format(" and {} more", all - names.size()) : "",
      table.separator() == ';' ? "semicolons (;)" : "tabs");
}

}  // namespace deflect::measurement
