// The layout of a matrix in a text: its rows of cells, not yet numbers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace deflect::matrix {

struct MatrixRow {
  std::vector<std::string> cells;
  std::size_t line = 0;  ///< of the file, from 1
};

/// Rows without comments, brackets, blank lines, quotes and empty cells at their end.
struct MatrixText {
  std::vector<MatrixRow> rows;
  double factor = 1;           ///< "1.0e+05 *" above MATLAB's columns
  bool decimal_comma = false;  ///< cells may have one
};

/// Throws InputError "file:line: …" on text that is binary or has no rows, and on brackets that do not match.
MatrixText lay_out(std::string_view text, const std::string& file);

/// Begins like a number, NaN and infinity included.
bool number_like(std::string_view cell);

}  // namespace deflect::matrix
