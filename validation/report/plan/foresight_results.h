// What a campaign will be able to tell as a report for a person, JSON and a table.
#pragma once

#include <string>

#include "validation/plan/foresight.h"

namespace deflect::report {

/// Both campaigns side by side: effects that show and pairs that are alike, indices, error in use; then, of the given
/// one, what shows least.
std::string foresight_report(const plan::Foresight&);
/// That no better campaign was found, of a foresight where that is so.
std::string no_better_words(const plan::Foresight&);
/// {"kind": "foresight", "better_found", "given": {…}, "better": {…}}; `better` is the given one where none was found.
std::string foresight_json(const plan::Foresight&);
/// The matrix of cosines of the given campaign, a row and a column for each effect.
std::string foresight_csv(const plan::Foresight&);

}  // namespace deflect::report
