// Results of commands (--json) as they are read back: what a page shows of each kind must be there, of the right type.
#pragma once

#include <string>

#include "validation/json/json_text.h"

namespace deflect::result_files {

struct ReadResult {
  std::string kind;  ///< "diagnosis", "comparison", "history", "validation", "map", "drawing", "check", "frame",
                     ///< "solve", "validity", "fit", "prediction", "plan", "foresight"
  Json json;
};

/// The kind is the member "kind" of the result, or told from two of its members where there is none (results of
/// versions before that). Throws InputError "origin:line: …" for text that is no JSON, "origin: member
/// 'candidates[3].site' …" for a result that lacks what its command writes, and for JSON that is no result at all.
ReadResult read_result(const std::string& text, const std::string& origin);

}  // namespace deflect::result_files
