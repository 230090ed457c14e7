// A strict reader of CSV tables with a header row.
//
// UTF-8 with or without byte order mark; lines end with LF or CRLF; cells are separated by commas, or by
// semicolons or tabs where the header is, and then numbers may have decimal commas (one sort per file). Cells may be
// quoted, "" inside quotes is a quote, spaces around a cell do not count. Blank lines and rows of empty cells are
// skipped, and so are lines that begin with '#', unless every row does: then '#' is part of the first column. A line
// "sep=;" above the header, as Excel reads and writes it, names the separator.
//
// Every refusal is one InputError that begins with "file:line:" and says what to do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deflect::measurement {

class CsvTable {
 public:
  const std::vector<std::string>& header() const { return header_; }
  std::size_t rows() const { return lines_.size(); }

  /// Between columns: a comma, a semicolon or a tab.
  char separator() const { return separator_; }

  /// Lines that were skipped because they begin with '#'.
  const std::vector<std::size_t>& comments() const { return comments_; }

  /// Column of that name, counted from 0.
  std::optional<std::size_t> column(std::string_view name) const;

  /// The cell without quotes; valid as long as the table is neither moved nor destroyed.
  std::string_view text(std::size_t row, std::size_t column) const;

  /// The cell as a finite number; InputError for anything else, an empty cell included.
  double number(std::size_t row, std::size_t column) const;

  /// The number in rad, of cells in units of which one is `rad`; InputError also where it is so large an angle that its
  /// digits are lost.
  double angle(std::size_t row, std::size_t column, double rad) const;

  /// Line of the file on which the row begins, counted from 1.
  std::size_t line(std::size_t row) const { return lines_[row]; }

  /// Whether the cell's text is a finite number.
  bool is_number(std::size_t row, std::size_t column) const;

  /// InputError "file:line: column 'name': message" for a cell, "file:line: message" for the header.
  [[noreturn]] void refuse(std::size_t row, std::size_t column, std::string_view message) const;
  [[noreturn]] void refuse_header(std::string_view message) const;

 private:
  friend class CsvParser;
  struct Cell {
    std::uint32_t begin = 0, size = 0;  // of bytes_: views would not survive a move, and weigh twice as much
  };
  std::string file_, bytes_;
  std::vector<std::string> header_;
  std::vector<Cell> cells_;  // row by row
  std::vector<std::uint32_t> lines_;
  std::vector<std::size_t> comments_;
  std::size_t header_line_ = 1;
  bool decimal_comma_ = false;
  char separator_ = ',';
};

/// The table in the text; `file` is for messages only. Refuses text without rows.
CsvTable parse_csv(std::string text, std::string file);

/// The same of a file.
CsvTable read_csv(const std::string& file);

}  // namespace deflect::measurement
