// Text for people: UTF-8 lengths, lines, aligned tables.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace deflect::report {

/// Of a line in the terminal.
inline constexpr std::size_t line_length = 110;

/// In one m, or of mrad and µrad in one rad.
inline constexpr double mm = 1e3, um = 1e6;

/// Code points of a UTF-8 text.
std::size_t letters(std::string_view utf8);

/// The text, or its beginning and "…" where it has more than `most` letters.
std::string clip(std::string_view utf8, std::size_t most);

/// "1 reading", "2 readings": a number of things whose plural ends in s.
std::string counted(std::size_t number, std::string_view one);

/// A cell of a CSV file: in quotes, those of the text doubled.
std::string csv_cell(std::string_view text);

/// The text with typographic minus signs before its numbers: "from -2 to 3" → "from −2 to 3"; "leg-2" stays.
std::string with_minus(std::string_view utf8);

/// Lines of at most `most` letters, broken at spaces; a longer word gets a line of its own.
std::vector<std::string> wrap(std::string_view text, std::size_t most);

/// Rows as lines of aligned columns with two spaces between them: the first column to the left, the others to
/// the right, nothing behind the last. Rows may have different lengths.
std::string aligned(const std::vector<std::vector<std::string>>& rows);

}  // namespace deflect::report
