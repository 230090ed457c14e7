// What spreadsheets write above the header of a CSV table.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace deflect::measurement {

/// The separator that a line "sep=;" names for Excel, quoted or not; nothing where the line is no such line.
std::optional<std::string_view> told_separator(std::string_view line);

/// Where a title stands in place of a header: how many lines below the first the names of columns seem to stand. That
/// is the first line with more cells than those above it, all of them words, on top of a row of as many cells with
/// numbers in it.
std::optional<std::size_t> header_below(std::string_view text);

}  // namespace deflect::measurement
