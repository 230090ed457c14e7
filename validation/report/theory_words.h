// How results name the theories that they hold.
#pragma once

#include <string>

#include "validation/json/json_text.h"
#include "validation/theories/theory.h"

namespace deflect::report {

/// [{"name": "analytic", "title": "analytic", "spoken": "the analytic theory"}, …]: members of the result that are
/// called by the name hold what the theory says.
Json json_theories(const theories::Theories&);

/// "analytic against MSA", "analytic, MSA and softer against each other"; empty for one theory.
std::string against_text(const theories::Theories&);

}  // namespace deflect::report
