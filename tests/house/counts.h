// What is counted in the sources: names that a room must not know, long functions, casts between kinds of index, places
// where errors are caught.
#pragma once

#include "tests/house/rules.h"

namespace deflect::house {

/// "file:line: names WORD" for each of the words in a source of one of the rooms, comments left out.
std::vector<std::string> named_in(const std::vector<Source>& sources, const std::vector<std::string>& rooms,
                                  const std::vector<std::string>& words);

/// "file:line: n lines" for every function with more than `limit`, as clang-format lays it out; of those in `tables`
/// ("file: function") the length is that of a table.
std::vector<std::string> long_functions(const std::vector<Source>& sources, int limit,
                                        const std::vector<std::string>& tables);

/// How often one kind of index or whole number is cast to another.
int index_casts(const std::vector<Source>& sources);

/// "file:line" of every catch.
std::vector<std::string> catches(const std::vector<Source>& sources);

}  // namespace deflect::house
