#include "validation/matrix/matrix_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "validation/json/json_text.h"
#include "validation/matrix/matrix_text.h"

namespace deflect::matrix {
namespace {

using Eigen::Index;

constexpr double largest_number = 1e100;
constexpr int largest_power = 100;  ///< of ten: a zero may have any exponent, its rounding has none beyond this

/// Of a power of ten as text: beyond it only zero is a double.
constexpr int largest_exponent = 1'000'000;

/// Fewer digits than these are taken for round numbers typed by hand, not for a bad print.
constexpr int fewest_digits = 3;

struct Number {
  double value = 0;
  int last = 0;    ///< power of ten of the last digit printed
  int digits = 0;  ///< printed from the first that is not zero
};

/// Power of ten of the first digit.
int leading(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

/// As std::from_chars reads it: decimal point, exponent "e", no sign "+" in front.
std::string plain(std::string cell, bool decimal_comma) {
  for (char& c : cell) {
    if (c == 'D' || c == 'd' || c == 'E') c = 'e';
    if (decimal_comma && c == ',') c = '.';
  }
  return cell;
}

Number number(const MatrixRow& row, std::size_t column, const MatrixText& layout, const std::string& file) {
  const std::string& cell = row.cells[column];
  const std::string text = plain(cell, layout.decimal_comma);
  const auto refuse = [&](std::string_view why) {
    throw InputError(fmt::format("{}:{}: column {}: {}", file, row.line, column + 1, why));
  };
  if (cell.empty()) refuse("the cell is empty; a finite number is wanted, 0 where there is no stiffness");
  Number n;
  const auto parsed = outcome_of<InputError>([&] { return parse_number(text); });
  if (parsed)
    n.value = *parsed;
  else
    refuse(number_like(cell) && text.find_first_of("0123456789") == text.npos
               ? fmt::format("'{}' is not a finite number; it usually comes from the inverse of a singular matrix, or "
                             "from 0/0 at a singular pose",
                             cell)
               : fmt::format("'{}' is not a finite number; write one such as -12.5 or 1.25e-3", cell));
  if (std::abs(n.value) > largest_number) refuse(fmt::format("'{}' is too large for a stiffness", cell));
  const std::size_t e = std::min(text.find('e'), text.size());
  const std::string_view mantissa = std::string_view(text).substr(0, e);
  if (e < text.size()) {
    const std::size_t from = text[e + 1] == '+' ? e + 2 : e + 1;
    std::from_chars(text.data() + from, text.data() + text.size(), n.last);
    n.last = std::clamp(n.last, -largest_exponent, largest_exponent);
  }
  if (const auto point = mantissa.find('.'); point != mantissa.npos)
    n.last -= static_cast<int>(mantissa.size() - point - 1);
  for (const char c : mantissa) n.digits += c >= '0' && c <= '9' && (n.digits > 0 || c != '0');
  return n;
}

bool counts_up(const std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] != std::to_string(i) && cells[i] != std::to_string(i + 1)) return false;
  return cells.size() > 1;
}

/// A first row of names ("ux, uy, …"), or of column numbers as pandas writes them.
bool is_header(const std::vector<MatrixRow>& rows) {
  if (rows.size() < 2) return false;
  const std::vector<std::string>& first = rows.front().cells;
  if (counts_up(first)) return rows.size() == 7 || rows[1].cells.size() == first.size() + 1;
  if (first.front().empty() && counts_up({first.begin() + 1, first.end()})) return true;
  return first.size() > 1 && std::none_of(first.begin() + 1, first.end(), [](const auto& c) { return number_like(c); });
}

/// A first column of names, or of row numbers below a header that has no cell for it, beside others.
bool is_name_column(const std::vector<MatrixRow>& rows, const MatrixRow* header) {
  if (std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.cells.size() < 2; })) return false;
  std::vector<std::string> first;
  for (const MatrixRow& row : rows) first.push_back(row.cells.front());
  if (std::none_of(first.begin(), first.end(), [](const auto& c) { return number_like(c); })) return true;
  return header && counts_up(first) &&
         (header->cells.front().empty() || header->cells.size() + 1 == rows.front().cells.size());
}

std::string sizes_remedy(const std::vector<MatrixRow>& rows) {
  std::vector<std::size_t> sizes;
  for (const MatrixRow& row : rows) sizes.push_back(row.cells.size());
  const std::vector<std::size_t> up = {1, 2, 3, 4, 5, 6}, down = {6, 5, 4, 3, 2, 1};
  return sizes == up || sizes == down ? "only one triangle is there: write both halves of the matrix"
                                      : "write as many numbers in each row; 0 where there is no stiffness";
}

PrintedMatrix numbers_of(MatrixText layout, const std::string& file) {
  const bool has_header = is_header(layout.rows);
  const MatrixRow header = has_header ? layout.rows.front() : MatrixRow{};
  if (has_header) layout.rows.erase(layout.rows.begin());
  if (is_name_column(layout.rows, has_header ? &header : nullptr))
    for (MatrixRow& row : layout.rows) row.cells.erase(row.cells.begin());

  const std::size_t columns = layout.rows.front().cells.size();
  std::vector<Number> numbers;
  bool comma = false, point = false;
  for (const MatrixRow& row : layout.rows) {
    for (std::size_t j = 0; j < row.cells.size(); ++j) {
      numbers.push_back(number(row, j, layout, file));
      comma = comma || row.cells[j].find(',') != std::string::npos;
      point = point || row.cells[j].find('.') != std::string::npos;
      // "1.234" beside "1,5" may be a thousand or a decimal point: a wrong guess is a factor of 1000.
      if (comma && point)
        throw InputError(
            fmt::format("{}:{}: column {}: '{}': decimal points and decimal commas stand in one file; "
                        "write them all alike",
                        file, row.line, j + 1, row.cells[j]));
    }
    if (row.cells.size() != columns)
      throw InputError(fmt::format("{}:{}: the row has {} numbers where the first has {}; {}", file, row.line,
                                   row.cells.size(), columns, sizes_remedy(layout.rows)));
  }
  if (!(std::abs(layout.factor) <= largest_number))
    throw InputError(fmt::format("{}: the factor {:g} is too large for a matrix", file, layout.factor));
  int digits = fewest_digits, last = numbers.front().last;
  double largest = 0;
  for (const Number& n : numbers) {
    digits = std::max(digits, n.digits), last = std::min(last, n.last);
    largest = std::max(largest, std::abs(n.value));
  }
  if (largest > 0) last = std::min(last, leading(largest) - fewest_digits + 1);

  PrintedMatrix out;
  out.values.resize(std::ssize(layout.rows), as_index(columns));
  out.rounding.resizeLike(out.values);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const Index i = as_index(k / columns), j = as_index(k % columns);
    const double value = numbers[k].value;
    const int significant = value == 0 ? last : leading(value) - digits + 1;
    out.values(i, j) = layout.factor * value;
    if (!(std::abs(out.values(i, j)) <= largest_number))
      throw InputError(fmt::format("{}:{}: column {}: {:g} times the factor {:g} is too large for a stiffness", file,
                                   nth(layout.rows, i).line, j + 1, value, layout.factor));
    const int power = std::min(std::max(significant, last), largest_power);
    out.rounding(i, j) = std::abs(layout.factor) * 0.5 * std::pow(10.0, power);
  }
  return out;
}

/// The member "analytic.stiffness" of a JSON object, printed again: with the digits that it has.
std::string json_member(const Json& root, const std::string& key, const std::string& file) {
  Json at = root;
  for (std::size_t from = 0; from <= key.size();) {
    const std::size_t to = std::min(key.find('.', from), key.size());
    const std::string name = key.substr(from, to - from);
    if (!at.is_object() || !at.contains(name)) {
      std::vector<std::string> known;
      if (at.is_object())
        for (const auto& [other, value] : at.items()) known.push_back(other);
      throw InputError(fmt::format("{}: there is no '{}' on the way to '{}' (there: {}); name the matrix with --key",
                                   file, name, key,
                                   known.empty() ? "nothing" : fmt::format("{}", fmt::join(known, ", "))));
    }
    at = Json(at[name]);
    from = to + 1;
  }
  if (!at.is_array()) throw InputError(fmt::format("{}: '{}' is not a matrix; name it with --key", file, key));
  return at.dump();
}

void swap_halves(MatrixX& m) {
  const MatrixX upper = m.topRows(3);
  m.topRows(3) = m.bottomRows(3).eval();
  m.bottomRows(3) = upper;
}

void swap_order(MatrixX& K) {
  swap_halves(K);
  MatrixX t = K.transpose();
  swap_halves(t);
  K = t.transpose();
}

std::string shape_remedy(const MatrixX& K) {
  if (K.size() == 36) return "write six rows of six";
  if (K.rows() == 3 && K.cols() == 3) return "these are the translations only; all six directions are needed";
  if (K.rows() == 12 && K.cols() == 12)
    return "this is a member with two ends: write the 6×6 block of the end that moves, the other held";
  return "write the 6×6 that maps [δ; θ] to [f; m] at one point";
}

}  // namespace

PrintedMatrix parse_matrix(std::string text, const std::string& file) { return numbers_of(lay_out(text, file), file); }

PrintedMatrix read_stiffness(const std::filesystem::path& path, const MatrixConvention& convention,
                             const std::string& key) {
  const std::string text = read_text(path);
  const auto first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != text.npos && text[first] == '{';
  const Json json = is_json ? json::parse_json(text, path.string(), "JSON has no NaN and no infinity") : Json();
  // What `solve --json` wrote has its own units and order; older results do not say their kind.
  const bool is_result = is_json && (json.contains("kind") ? json["kind"] == "solve"
                                                           : key == "analytic.stiffness" || key == "msa.stiffness");
  PrintedMatrix K = is_json ? parse_matrix(json_member(json, key, path.string()), path.string() + " (" + key + ")")
                            : parse_matrix(text, path.string());
  if (K.values.rows() != 6 || K.values.cols() != 6)
    throw InputError(fmt::format("{}: the matrix is {}×{}, a stiffness is 6×6; {}", path.string(), K.values.rows(),
                                 K.values.cols(), shape_remedy(K.values)));
  if (K.values.isZero(0)) throw InputError(fmt::format("{}: all entries are zero", path.string()));
  for (MatrixX* m : {&K.values, &K.rounding}) {
    if (convention.rotation_first && !is_result) swap_order(*m);
    if (!is_result) continue;
    m->topLeftCorner<3, 3>() *= convention.unit_m / 1e-3;
    m->bottomRightCorner<3, 3>() *= 1e-3 / convention.unit_m;
  }
  return K;
}

PrintedMatrix read_twists(const std::filesystem::path& path, const MatrixConvention& convention) {
  PrintedMatrix J = parse_matrix(read_text(path), path.string());
  if (J.values.rows() != 6) J = {J.values.transpose().eval(), J.rounding.transpose().eval()};
  if (J.values.rows() != 6 || J.values.cols() > 5)
    throw InputError(
        fmt::format("{}: the matrix is {}×{}; write one to five twists [δ; θ] of six numbers, as rows or "
                    "as columns{}",
                    path.string(), J.values.cols(), J.values.rows(),
                    J.values.cols() > 5 ? ": six passive joints would leave nothing stiff" : ""));
  for (Index j = 0; j < J.values.cols(); ++j)
    if (J.values.col(j).isZero(0)) throw InputError(fmt::format("{}: twist {} is zero", path.string(), j + 1));
  if (convention.rotation_first)
    for (MatrixX* m : {&J.values, &J.rounding}) swap_halves(*m);
  return J;
}

}  // namespace deflect::matrix
