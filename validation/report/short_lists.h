// Long lists, short in the terminal: what matters most of each, and how many more there are. JSON and page have all.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "validation/diagnosis/detectable.h"
#include "validation/json/json_text.h"

namespace deflect::report {

/// "modulus −90.0, leg 3 guide diameter −9.9, … and 28 more": names with multiples of their standard deviation, the
/// largest first.
std::string strained_words(std::vector<std::pair<std::string, double>>);

/// [{"name", "sigmas"}, …], all of them.
Json strained_json(const std::vector<std::pair<std::string, double>>&);

/// "not looked at: joint_preload, motor_compliance (why: --json)", a line; empty where nothing was left out.
std::string left_out_words(const std::vector<diagnosis::LeftOut>&);

/// [{"effect", "why"}, …], all of them.
Json left_out_json(const std::vector<diagnosis::LeftOut>&);

/// [[…], …] by rows. NumericalError naming `what` where a number is none.
Json rows_json(const MatrixX&, const std::string& what);

/// "stiffness_N_per_mm 29100", the smallest size that shows, or "none within bounds".
std::string sizes_of(const diagnosis::Detectable&);

/// A table of the effects that this plan shows least of, by the size that their search starts with: one line an effect,
/// of the leg where it is hardest to see.
std::string detectable_table(const std::vector<diagnosis::Detectable>&);

}  // namespace deflect::report
