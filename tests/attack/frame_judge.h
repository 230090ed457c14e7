// What the program says of a frame, judged by the oracles.
#pragma once

#include <map>
#include <string>

#include "tests/attack/dense_oracle.h"
#include "tests/attack/random_frame.h"
#include "tests/attack/standing_oracle.h"

namespace deflect::attack {

enum class Outcome {
  answered,          ///< right
  refused_rightly,   ///< cannot stand
  digits_gone,       ///< refused, where rounding times the condition leaves fewer than three digits
  answered_wrongly,  ///< a mechanism, or numbers beyond what rounding explains
  refused_wrongly,   ///< stands, or moves only idly
  crashed            ///< an exception of another kind
};
inline constexpr const char* outcome_names[] = {"answered",         "refused rightly", "refused, digits gone",
                                                "answered wrongly", "refused wrongly", "crashed"};
inline bool is_wrong(Outcome o) { return o >= Outcome::answered_wrongly; }

struct Judgement {
  Outcome outcome = Outcome::answered;
  Standing standing = Standing::stands;
  double condition = 1;         ///< of the frame, where it was solved
  double largest_response = 0;  ///< DenseSolution's
  double error = 0;             ///< largest difference of displacements from the independent solution, relative
  double force_error = 0;
  bool warned = false;  ///< the program says that digits are lost
  std::string words;    ///< what the program said, or how far off it is
};

/// The relative error that an answer may have: each entry of the assembled stiffness is off by a few units of its last
/// place, which the condition enlarges. Never more than 1e-6, unless the program warns of lost digits itself.
double allowed_error(double condition, bool warned);

/// Whether a note says that an idle motion was held.
bool tells_of_holding(const std::vector<std::string>& notes);

/// Whether rounding leaves three digits. Where it does not, a refusal is right as well.
bool digits_left(double condition);

/// The program's answer to the frame in its own size, judged by the oracles on the ideal one.
Judgement judge(const RandomFrame&);

/// The difference of two displacement fields (by node), relative to the largest of `right` and at least to `least`;
/// rotations weigh by `size`; rotations of nodes that turn idly are left out.
double field_difference(const std::vector<Vector6>& left, const std::vector<Vector6>& right, double size,
                        const std::vector<bool>& turns, double least);

/// Writes the frame where it can be run by hand and says where: "seed 17 (truss): … deflect frame PATH".
std::string reproduction(const RandomFrame&, const Judgement&);

}  // namespace deflect::attack
