// Scores of machines and frames, and their tables.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmark/subjects.h"
#include "validation/json/json_text.h"

namespace deflect::benchmark {

/// Two tables in Markdown: every score beside what is wanted, of machines, of frames and of all; the main ones subject
/// by subject. Then the sets that were skipped, and why.
std::string subjects_report(const std::vector<SubjectRow>&);

/// Every set.
Json subjects_json(const std::vector<SubjectRow>&);

}  // namespace deflect::benchmark
