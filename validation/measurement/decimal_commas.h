// Numbers with decimal commas, as a note on how a file was read.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validation/measurement/csv.h"

namespace deflect::measurement {

/// "numbers with decimal commas are read, as '698,1' in line 3 is 698.1, in the columns Ux, Uy; …": empty where the
/// rows from `first_row` on have none. Columns of `text` are labels and remarks.
std::string decimal_comma_words(const CsvTable&, std::size_t first_row, const std::vector<std::size_t>& text);

}  // namespace deflect::measurement
