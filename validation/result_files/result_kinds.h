// What the result of each command must hold so that it can be shown: one row for one kind.
#pragma once

#include <vector>

namespace deflect::result_files {

/// A member by its path, "candidates[].site", "cases{}.energy_Nmm" of an object with names of its own, and what it must
/// be: text, number, number or null (an infinite one is written so), truth, list, object; three, six, 6×6 numbers.
struct WantedMember {
  const char* path;
  enum class Type { text, number, number_or_null, truth, list, object, three, six, six_by_six } type;
};

struct ResultKind {
  const char* name;
  const char* members[2];  ///< by which it is known where it does not say its kind
  std::vector<WantedMember> wanted;
};

/// The commands whose results are shown.
inline constexpr const char* commands_with_pages =
    "diagnose, compare, history, solve, validate, map, frame, check, show, fit, predict, plan";

/// In the order in which a result that does not say its kind is asked for it.
const std::vector<ResultKind>& result_kinds();

}  // namespace deflect::result_files
