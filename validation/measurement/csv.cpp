#include "validation/measurement/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/number_words.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "validation/measurement/column_names.h"
#include "validation/measurement/csv_titles.h"

namespace deflect::measurement {
namespace {

std::string_view trim(std::string_view s) {
  const auto from = s.find_first_not_of(" \t");
  if (from == s.npos) return {};
  return s.substr(from, s.find_last_not_of(" \t") - from + 1);
}

bool finite_number(std::string_view text, double& value) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

/// "1,5" and the like as a number with a decimal comma.
bool decimal_comma_number(std::string_view text, double& value) {
  std::string with_point(text);
  const auto comma = with_point.find(',');
  if (comma == with_point.npos || with_point.find('.') != with_point.npos) return false;
  with_point[comma] = '.';
  return finite_number(with_point, value);
}

/// Bytes of the UTF-8 sequence at the start of the text; 0 when it is none (RFC 3629: no overlong forms, no
/// surrogates, nothing above U+10FFFF).
std::size_t utf8_sequence(std::string_view s) {
  const auto byte = [s](std::size_t i) { return i < s.size() ? static_cast<unsigned char>(s[i]) : 0u; };
  const auto tail = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) {
    return byte(i) >= low && byte(i) <= high;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return tail(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF)
    return tail(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && tail(2) ? 3 : 0;
  if (first >= 0xF0 && first <= 0xF4)
    return tail(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && tail(2) && tail(3) ? 4 : 0;
  return 0;
}

}  // namespace

/// Walks once through the bytes. Quoted cells are unquoted in place: they only get shorter.
class CsvParser {
 public:
  CsvParser(std::string text, std::string file) {
    table_.file_ = std::move(file);
    table_.bytes_ = std::move(text);
  }

  CsvTable parse() {
    check_encoding();
    if (bytes().substr(at_).find_first_not_of(" \t\r\n") == std::string_view::npos) refuse(1, "the file is empty");
    skip_to_header();
    find_separator();
    read_header();
    while (read_row()) {
    }
    settle_comments();
    table_.separator_ = separator_;
    if (table_.lines_.empty()) refuse(table_.header_line_, "there is a header but no row below it");
    return std::move(table_);
  }

 private:
  std::string_view bytes() const { return table_.bytes_; }

  [[noreturn]] void refuse(std::size_t line, std::string_view message) const {
    throw InputError(fmt::format("{}:{}: {}", table_.file_, line, message));
  }

  /// Of a table whose first line is no header but a title, that is said.
  [[noreturn]] void refuse_table(std::size_t line, std::string_view message) const {
    const std::optional<std::size_t> below = header_below(bytes().substr(header_at_));
    if (!below) refuse(line, message);
    refuse(header_line(), fmt::format("this line is no header: the names of the columns seem to stand in line {}; "
                                      "delete the lines above them, or begin each of those with '#'",
                                      header_line() + *below));
  }
  std::size_t header_line() const {
    return 1 + as_size(std::count(bytes().begin(), bytes().begin() + as_index(header_at_), '\n'));
  }

  void check_encoding() {
    if (bytes().size() >= std::numeric_limits<std::uint32_t>::max())
      refuse(1, "the file is larger than 4 GB: split it into several");
    if (bytes().substr(0, 4) == "PK\x03\x04" || bytes().substr(0, 4) == "\xD0\xCF\x11\xE0")
      refuse(1, "this is a workbook (XLSX, ODS, XLS) and not text: save its sheet as CSV (UTF-8)");
    if (bytes().substr(0, 2) == "\xFF\xFE" || bytes().substr(0, 2) == "\xFE\xFF")
      refuse(1, "the file is UTF-16: save it as UTF-8");
    if (bytes().substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
    std::size_t line = 1;
    for (std::size_t i = at_; i < bytes().size();) {
      const char c = bytes()[i];
      if (c == '\n') ++line;
      if (c == '\0') refuse(line, "there is a NUL byte: the file is binary or damaged, save it as UTF-8 text");
      const std::size_t n = static_cast<unsigned char>(c) < 0x80 ? 1 : utf8_sequence(bytes().substr(i));
      if (n == 0)
        refuse(line, fmt::format("byte 0x{:02X} is not UTF-8: save the file as UTF-8", static_cast<unsigned char>(c)));
      i += n;
    }
  }

  void find_separator() {
    if (told_) return;
    bool quoted = false, comma = false, semicolon = false, tab = false, bar = false;
    for (std::size_t i = at_; i < bytes().size() && (quoted || bytes()[i] != '\n'); ++i) {
      const char c = bytes()[i];
      if (c == '"') quoted = !quoted;
      comma = comma || (!quoted && c == ',');
      semicolon = semicolon || (!quoted && c == ';');
      tab = tab || (!quoted && c == '\t');
      bar = bar || (!quoted && c == '|');
    }
    if (comma && semicolon)
      refuse_table(line_, "the header has both commas and semicolons: separate columns by one of them");
    if (bar && !comma && !semicolon && !tab)
      refuse(line_,
             "columns are separated by '|' here; commas, semicolons and tabs are read: put semicolons in place of "
             "it, as 'tr \"|\" \";\"' does");
    separator_ = semicolon ? ';' : tab && !comma ? '\t' : ',';
  }

  /// Space around a cell; a tab is none where it separates.
  bool padding(std::size_t i) const {
    return i < bytes().size() && (bytes()[i] == ' ' || (bytes()[i] == '\t' && separator_ != '\t'));
  }

  /// The next record's cells into `cells_`; false at the end of the file. Afterwards start_ is the record's
  /// line.
  bool next_record() {
    cells_.clear();
    start_ = line_;
    if (at_ >= bytes().size()) return false;
    for (;;) {
      cells_.push_back(next_cell());
      if (at_ >= bytes().size()) return true;
      const char c = bytes()[at_++];
      if (c == separator_) continue;
      if (c == '\r') ++at_;
      ++line_;
      return true;
    }
  }

  bool ends_cell(std::size_t i) const {
    return i >= bytes().size() || bytes()[i] == separator_ || bytes()[i] == '\n' ||
           (bytes()[i] == '\r' && i + 1 < bytes().size() && bytes()[i + 1] == '\n');
  }

  /// Leaves at_ on the separator, on the line end or behind the last byte.
  CsvTable::Cell next_cell() {
    while (padding(at_)) ++at_;
    if (at_ < bytes().size() && bytes()[at_] == '"') return quoted_cell();
    const std::size_t begin = at_;
    for (; !ends_cell(at_); ++at_) {
      if (bytes()[at_] == '"') refuse(line_, "a quote inside a cell: quote the whole cell and double the quotes in it");
      if (bytes()[at_] == '\r' && at_ + 1 < bytes().size())
        refuse(line_, "a carriage return inside the line: end lines with LF or CRLF");
    }
    std::string_view cell = bytes().substr(begin, at_ - begin);
    if (!cell.empty() && cell.back() == '\r') cell.remove_suffix(1);  // CR as the very last byte
    return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(trim(cell).size())};
  }

  CsvTable::Cell quoted_cell() {
    const std::size_t opened = line_, begin = ++at_;
    std::size_t to = begin;
    for (;;) {
      if (at_ >= bytes().size()) refuse(opened, "a quoted cell begins here and never ends");
      const char c = bytes()[at_++];
      if (c == '"') {
        if (at_ >= bytes().size() || bytes()[at_] != '"') break;
        ++at_;
      }
      if (c == '\n') ++line_;
      table_.bytes_[to++] = c;
    }
    while (padding(at_)) ++at_;
    if (!ends_cell(at_)) refuse(line_, "text follows the closing quote of a cell");
    return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(to - begin)};
  }

  std::string_view view(CsvTable::Cell cell) const { return bytes().substr(cell.begin, cell.size); }
  bool blank() const {
    return std::all_of(cells_.begin(), cells_.end(), [](CsvTable::Cell cell) { return cell.size == 0; });
  }

  /// Whether the line names the separator, as Excel reads it.
  bool take_separator(std::string_view line) {
    const std::optional<std::string_view> told = told_separator(line);
    if (!told) return false;
    if (*told != "," && *told != ";" && *told != "\t")
      refuse(line_, fmt::format("'sep={}': columns are separated by commas, semicolons or tabs; save the file so",
                                excerpt(*told)));
    separator_ = told->front();
    told_ = true;
    return true;
  }

  /// Past blank lines and lines that begin with '#', before the header; where the separator is looked for.
  void skip_to_header() {
    for (std::size_t end; at_ < bytes().size(); at_ = end, ++line_) {
      end = std::min(bytes().find('\n', at_), bytes().size() - 1) + 1;
      const std::string_view line = bytes().substr(at_, end - at_);
      if (take_separator(line)) continue;
      const std::size_t from = line.find_first_not_of(" \t\r\n,;");
      if (from != line.npos && line[from] != '#') {
        header_at_ = at_;
        return;
      }
      if (from != line.npos) table_.comments_.push_back(line_);
    }
    refuse(1, "there is no header: every line is blank or begins with '#'");
  }

  /// The line from here on is a comment, or a row whose first cell begins with '#'.
  bool at_comment() const {
    std::size_t i = at_;
    while (padding(i)) ++i;
    return i < bytes().size() && bytes()[i] == '#';
  }

  void skip_line() {
    const std::size_t end = bytes().find('\n', at_);
    at_ = end == std::string_view::npos ? bytes().size() : end + 1;
    ++line_;
  }

  /// Rows that begin with '#' are rows where no other row is, else comments.
  void settle_comments() {
    if (hash_lines_.empty()) return;
    if (table_.lines_.empty()) {
      table_.lines_ = std::move(hash_lines_);
      table_.cells_ = std::move(hash_cells_);
    } else {
      table_.comments_.insert(table_.comments_.end(), hash_lines_.begin(), hash_lines_.end());
      std::sort(table_.comments_.begin(), table_.comments_.end());
    }
  }

  void read_header() {
    next_record();
    table_.header_line_ = start_;
    const auto is_a_number = [&](CsvTable::Cell cell) {
      double ignored = 0;
      return finite_number(view(cell), ignored) || decimal_comma_number(view(cell), ignored);
    };
    if (2 * std::count_if(cells_.begin(), cells_.end(), is_a_number) > as_index(cells_.size()))
      refuse(start_, fmt::format("there is no header: this line holds numbers; write the names of the columns above "
                                 "it{}",
                                 table_.comments_.empty()
                                     ? ""
                                     : fmt::format(", without '#' where line {} has them", table_.comments_.back())));
    std::unordered_map<std::string, std::size_t> seen;
    for (const CsvTable::Cell cell : cells_) {
      const std::string name(view(cell));
      const std::size_t number = table_.header_.size() + 1;
      if (name.empty())
        refuse_table(start_, fmt::format("column {} has no name{}", number,
                                         number == cells_.size() ? ": is there a separator at the end?" : ""));
      const auto [same, is_new] = seen.emplace(name, number);
      if (!is_new)
        refuse(start_, fmt::format("column '{}' stands twice, as column {} and column {}: remove or rename one",
                                   excerpt(name), same->second, number));
      table_.header_.push_back(name);
    }
  }

  bool read_row() {
    const bool hash = at_comment();
    const std::size_t begin = at_, line = line_;
    if (hash) {  // quotes in a comment mean nothing
      const std::size_t end = std::min(bytes().find('\n', at_), bytes().size());
      if (std::count(bytes().begin() + as_index(at_), bytes().begin() + as_index(end), '"') > 0) {
        table_.comments_.push_back(line_);
        skip_line();
        return true;
      }
    }
    if (!next_record()) return false;
    if (blank()) return true;
    if (hash && cells_.size() != table_.header_.size()) {
      at_ = begin, line_ = line;
      table_.comments_.push_back(line_);
      skip_line();
      return true;
    }
    if (cells_.size() != table_.header_.size())
      refuse_table(start_, fmt::format("{} cells where the header has {} columns{}", cells_.size(),
                                       table_.header_.size(), remedy_of_count()));
    if (separator_ != ',' && !table_.decimal_comma_) {
      double ignored = 0;
      table_.decimal_comma_ = std::any_of(
          cells_.begin(), cells_.end(), [&](CsvTable::Cell cell) { return decimal_comma_number(view(cell), ignored); });
    }
    (hash ? hash_lines_ : table_.lines_).push_back(static_cast<std::uint32_t>(start_));
    std::vector<CsvTable::Cell>& cells = hash ? hash_cells_ : table_.cells_;
    cells.insert(cells.end(), cells_.begin(), cells_.end());
    return true;
  }

  const char* remedy_of_count() const {
    if (cells_.size() < table_.header_.size()) return ": is the line cut short? A cell without a value stays empty";
    if (cells_.size() == table_.header_.size() + 1 && cells_.back().size == 0)
      return ": is there a separator at the end?";
    return ": quote a cell that holds a separator; decimal commas need semicolons between cells";
  }

  CsvTable table_;
  std::vector<CsvTable::Cell> cells_;
  std::vector<std::uint32_t> hash_lines_;  // rows that begin with '#', until it is known what they are
  std::vector<CsvTable::Cell> hash_cells_;
  std::size_t at_ = 0, line_ = 1, start_ = 1;
  std::size_t header_at_ = 0;
  char separator_ = ',';
  bool told_ = false;  // the separator, by a line "sep=;"
};

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) return std::nullopt;
  return as_size(found - header_.begin());
}

std::string_view CsvTable::text(std::size_t row, std::size_t column) const {
  const Cell& cell = cells_[row * header_.size() + column];
  return std::string_view(bytes_).substr(cell.begin, cell.size);
}

double CsvTable::angle(std::size_t row, std::size_t column, double rad) const {
  const double value = rad * number(row, column);
  const auto has_digits = outcome_of<InputError>([&] {
    require_digits_of_angle(value, excerpt(text(row, column)));
    return true;
  });
  if (!has_digits) refuse(row, column, has_digits.why);
  return value;
}

bool CsvTable::is_number(std::size_t row, std::size_t column) const {
  const std::string_view cell = trim(text(row, column));
  double value = 0;
  return finite_number(cell, value) || (decimal_comma_ && decimal_comma_number(cell, value));
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  const std::string_view cell = trim(text(row, column));
  double value = 0;
  if (finite_number(cell, value)) {
    if (!decimal_comma_ || cell.find('.') == cell.npos) return value;
    // "1.234" beside "1,5" may be a thousand or a decimal point: a wrong guess is a factor of 1000.
    refuse(row, column,
           fmt::format("'{}' has a decimal point in a file with decimal commas; write them all alike", excerpt(cell)));
  }
  if (decimal_comma_ && decimal_comma_number(cell, value)) return value;
  if (cell.empty()) refuse(row, column, "the cell is empty; a finite number is wanted");
  refuse(row, column,
         fmt::format("'{}' is not a finite number; write one such as {}{}", excerpt(cell),
                     decimal_comma_ ? "-12,5 or 1,25e-3" : "-12.5 or 1.25e-3", odd_character_words(cell)));
}

void CsvTable::refuse(std::size_t row, std::size_t column, std::string_view message) const {
  throw InputError(fmt::format("{}:{}: column '{}': {}", file_, line(row), excerpt(header_[column]), message));
}

void CsvTable::refuse_header(std::string_view message) const {
  throw InputError(fmt::format("{}:{}: {}", file_, header_line_, message));
}

CsvTable parse_csv(std::string text, std::string file) { return CsvParser(std::move(text), std::move(file)).parse(); }

CsvTable read_csv(const std::string& file) { return parse_csv(read_text(file), file); }

}  // namespace deflect::measurement
