// The count of what the program did with many random models.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "tests/attack/frame_judge.h"

namespace deflect::attack {

struct Table {
  std::map<std::string, int> kinds;  ///< of the models: what is right for them
  std::map<Outcome, int> outcomes;
  double error = 0;               ///< largest of the answers that are right, relative
  double error_of_condition = 0;  ///< the same over the condition
  double between = 0;             ///< both theories' largest difference, relative
  std::string failures;           ///< how to run each model that failed

  void add(const char* kind, Outcome outcome, double its_error, double condition, double its_between = 0) {
    ++kinds[kind];
    ++outcomes[outcome];
    if (outcome != Outcome::answered) return;
    error = std::max(error, its_error);
    error_of_condition = std::max(error_of_condition, its_error / condition);
    between = std::max(between, its_between);
  }

  std::string text(const std::string& what) const {
    int all = 0;
    for (const auto& [outcome, count] : outcomes) all += count;
    std::string out = fmt::format("{} random {}\n", all, what);
    for (const auto& [kind, count] : kinds) out += fmt::format("  {:<28}{:>7}\n", kind, count);
    out += "outcome\n";
    for (std::size_t i = 0; i < std::size(outcome_names); ++i) {
      const auto found = outcomes.find(static_cast<Outcome>(i));
      out += fmt::format("  {:<28}{:>7}\n", outcome_names[i], found == outcomes.end() ? 0 : found->second);
    }
    out += fmt::format("largest error {:.1e}, over the condition {:.1e}\n", error, error_of_condition);
    if (between > 0) out += fmt::format("theories at most {:.1e} apart\n", between);
    return out;
  }
};

}  // namespace deflect::attack
