// Verdicts as sentences. What a sentence says of its numbers is decided on the numbers as it prints them.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/comparison.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/json/json_text.h"

namespace deflect::report {

std::string verdict_words(const compare::Comparison&);
std::string verdict_words(const diagnosis::Diagnosis&);

/// The same verdict for the head of a page: what is missing first and in words, without the ids of effects.
std::string headline_words(const diagnosis::Diagnosis&);

/// "37 of 720 readings (5.1 %) are gross outliers …" where they are more than one in twenty; empty otherwise.
std::string outlier_words(std::size_t set_aside, std::size_t readings);

/// "at 32 of 288 readings the load leaves play open: …", a line; empty where so many are none. `in_play`: as
/// Diagnosis::in_play.
std::string in_play_words(std::size_t in_play, std::size_t readings);

/// "how the file was read: …" with a line for each; empty without any.
std::string how_read_text(const std::vector<std::string>&);

/// "guide_root_compliance (leg 3)".
std::string placed_words(const effects::PlacedEffect&);

/// "stiffness_Nmm_per_rad = 5.00e6 (4.9e6 … 5.1e6)" of all parameters.
std::string fitted_words(const diagnosis::Hypothesis&, const diagnosis::Fit&);

/// "To tell A from B, read uz of node M as load.snow × 1 goes on: …"
std::string splitting_words(const diagnosis::Splitting&);

/// [{"ids": […], "sentence": "…", "certain": true}].
Json mistakes_json(const std::vector<compare::RecordingMistake>&);

}  // namespace deflect::report
