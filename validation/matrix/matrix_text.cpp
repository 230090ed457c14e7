#include "validation/matrix/matrix_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"

namespace deflect::matrix {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view stripped(std::string_view s) {
  const auto from = s.find_first_not_of(blanks);
  return from == s.npos ? std::string_view{} : s.substr(from, s.find_last_not_of(blanks) - from + 1);
}

[[noreturn]] void refuse(const std::string& file, std::size_t line, std::string_view message) {
  throw InputError(fmt::format("{}:{}: {}", file, line, message));
}

void check_encoding(std::string_view text, const std::string& file) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    refuse(file, 1, "the file is UTF-16: save it as UTF-8");
  if (text.find('\0') != text.npos) refuse(file, 1, "the file is binary (a .mat or .npy file?): save it as text");
}

std::string without_comments(std::string_view text) {
  std::string out;
  bool comment = false;
  for (const char c : text) {
    if (c == '\n') comment = false;
    if (c == '#' || c == '%') comment = true;
    if (!comment) out += c;
  }
  return out;
}

std::string unquoted(std::string_view cell) {
  cell = stripped(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
  return std::string(stripped(cell));
}

std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> cells;
  if (separator == ' ') {
    for (line = stripped(line); !line.empty();) {
      const std::size_t end = std::min(line.find_first_of(blanks), line.size());
      cells.push_back(unquoted(line.substr(0, end)));
      line = stripped(line.substr(end));
    }
    return cells;
  }
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(separator, from), line.size());
    cells.push_back(unquoted(line.substr(from, to - from)));
    from = to + 1;
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells;
}

/// "[1 2; 3 4]" of MATLAB, "[[1, 2], [3, 4]]" of NumPy and JSON. Where rows have brackets of their own a line may end
/// inside of them.
class Brackets {
 public:
  Brackets(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::vector<MatrixRow> rows() {
    const std::size_t open = text_.find('[');
    for (const char c : text_.substr(0, open)) line_ += c == '\n';
    if (const std::string_view before = stripped(text_.substr(0, open)); !before.empty() && number_like(before))
      refuse(file_, 1, "there are numbers before the bracket: keep one matrix in the file");
    int depth = 0;
    for (std::size_t i = open; i < text_.size(); ++i) {
      const char c = text_[i];
      if (text_.substr(i).starts_with("..."))
        i = skip_continuation(i), ++line_;
      else if (c == '[') {
        if (++depth > 2) refuse(file_, line_, "brackets stand three deep: a matrix has rows and columns only");
      } else if (c == ']') {
        end_row();
        if (--depth == 0) {
          check_tail(i + 1);
          return std::move(rows_);
        }
      } else if (depth == 1 && (c == ';' || c == '\n')) {
        end_row();
      } else if (blanks.find(c) != blanks.npos || c == ',') {
        end_cell();
      } else {
        cell_ += c;
      }
      line_ += c == '\n';
    }
    refuse(file_, line_, "a bracket is not closed");
  }

 private:
  std::size_t skip_continuation(std::size_t i) const { return std::min(text_.find('\n', i), text_.size() - 1); }

  void end_cell() {
    if (cell_.empty()) return;
    if (row_.cells.empty()) row_.line = line_;
    row_.cells.push_back(std::move(cell_));
    cell_.clear();
  }

  void end_row() {
    end_cell();
    if (!row_.cells.empty()) rows_.push_back(std::move(row_));
    row_ = {};
  }

  void check_tail(std::size_t from) const {
    const std::string_view tail = stripped(text_.substr(from));
    if (tail.find_first_not_of(" \t\r\n;)") == tail.npos || tail.starts_with(", dtype")) return;
    refuse(file_, line_, fmt::format("'{}' follows the matrix: keep one matrix in the file", tail.substr(0, 20)));
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t line_ = 1;
  std::string cell_;
  MatrixRow row_;
  std::vector<MatrixRow> rows_;
};

/// Blanks separate although there are commas: "1,5 2,5", where each word has one comma inside.
bool commas_are_decimal(const std::vector<std::pair<std::string_view, std::size_t>>& lines) {
  bool several = false;
  for (const auto& [line, number] : lines) {
    const std::vector<std::string> words = split(line, ' ');
    several = several || words.size() > 1;
    for (const std::string& word : words)
      if (std::count(word.begin(), word.end(), ',') > 1 || word.starts_with(',') || word.ends_with(',')) return false;
  }
  return several;
}

char separator_of(const std::vector<std::pair<std::string_view, std::size_t>>& lines) {
  const auto any = [&](char c) {
    return std::any_of(lines.begin(), lines.end(), [c](const auto& l) { return l.first.find(c) != l.first.npos; });
  };
  if (any(';')) return ';';
  if (any('\t')) return '\t';
  return any(',') && !commas_are_decimal(lines) ? ',' : ' ';
}

MatrixText lines_laid_out(std::string_view text, const std::string& file) {
  MatrixText out;
  std::vector<std::pair<std::string_view, std::size_t>> lines;
  std::size_t number = 0;
  for (std::size_t from = 0; from < text.size(); ++number) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    std::string_view line = text.substr(from, to - from);
    from = to + 1;
    // Tabs before the first or behind the last cell separate empty cells; MATLAB ends a row with a semicolon.
    while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.remove_suffix(1);
    if (line.ends_with(';')) line.remove_suffix(1);
    const std::string_view words = stripped(line);
    if (words.empty() || (words.ends_with('=') && lines.empty())) continue;  // "K ="
    if (words.ends_with('*') && lines.empty()) {
      const auto factor = outcome_of<InputError>([&] { return parse_number(words.substr(0, words.size() - 1)); });
      if (!factor) refuse(file, number + 1, fmt::format("{} as a factor of the matrix", factor.why));
      out.factor = *factor;
      continue;
    }
    lines.emplace_back(line, number + 1);
  }
  const char separator = separator_of(lines);
  out.decimal_comma = separator != ',';
  for (const auto& [line, at] : lines)
    if (MatrixRow row{split(line, separator), at}; !row.cells.empty()) out.rows.push_back(std::move(row));
  return out;
}

}  // namespace

bool number_like(std::string_view cell) {
  while (!cell.empty() && (cell.front() == '+' || cell.front() == '-')) cell.remove_prefix(1);
  if (cell.empty()) return false;
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  if (digit(cell.front()) || ((cell.front() == '.' || cell.front() == ',') && cell.size() > 1 && digit(cell[1])))
    return true;
  std::string lower(cell);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

MatrixText lay_out(std::string_view text, const std::string& file) {
  check_encoding(text, file);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::string bare = without_comments(text);
  MatrixText out;
  if (bare.find('[') != bare.npos)
    out.rows = Brackets(bare, file).rows();
  else
    out = lines_laid_out(bare, file);
  if (out.rows.empty()) refuse(file, 1, "there are no numbers in the file");
  return out;
}

}  // namespace deflect::matrix
