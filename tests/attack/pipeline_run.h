// Measurements run through the program as a user does it: simulate, compare, diagnose, add, history, report; and what
// its results say held against each other.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/attack/random_pipeline.h"

namespace deflect::attack {

/// A file that contradicts itself or another, or a step that ended as it must not.
struct Contradiction {
  std::string check;  ///< "diagnose ends", "probabilities": the same for the same failure of another file
  std::string words;
};

struct PipelineJudgement {
  std::vector<Contradiction> wrong;
  std::string refused;               ///< by which step, and its words; empty where all steps ran
  std::string verdict;               ///< of the diagnosis, where there is one
  std::vector<std::string> missing;  ///< "leg_defect (leg 5)"
  /// Missing, or tied with what is: names of the same form.
  std::vector<std::string> reported;
  bool mistaken = false;   ///< a mistake of recording was found instead
  double gain = 0;         ///< λ² of the hidden effect by its own fit: χ² of "nothing" less χ² with it
  double probability = 0;  ///< of the first candidate
};

/// Writes subject.yaml and data.csv into the folder. False where the program refuses, with its words in the judgement.
bool simulate(const Pipeline&, const std::filesystem::path& folder, PipelineJudgement&);

/// Runs the other steps on subject.yaml and data.csv of the folder. `page`: with the report.
void run_from_data(const std::filesystem::path& folder, bool page, PipelineJudgement&);

/// Both in a folder of its own.
PipelineJudgement judge(const Pipeline&);

/// λ² of the hidden effect, from the diagnosis in the folder.
double gain_of(const HiddenEffect&, const std::filesystem::path& folder);

/// Removes rows of data.csv and parts of subject.yaml as long as the same check fails; keeps both where they can be run
/// by hand and says where.
std::string shrunk(const Pipeline&, const Contradiction&);

/// "name (leg 5)"; leg 0: none.
std::string placed_name(const std::string& effect, int leg);

}  // namespace deflect::attack
