// A channel that shows another quantity than its name says (other_quantities.h): a mistake of recording that is told by
// a comparison with the subject as it was really read.
#pragma once

#include "validation/compare/plausibility.h"

namespace deflect::compare {

/// Compares other data with a subject whose sensors may show other quantities; nullopt as soon as they cannot be right.
using ComparedAs = std::function<std::optional<MisfitAccount>(const subject::Subject&, const measurement::Measurements&,
                                                              const CanBeRight&)>;

/// Looked for in frames that fit badly, where one channel holds most of the misfit; reported by the rule of corrections
/// of units (plausibility.h). Quantities that do equally well stand side by side.
std::optional<RecordingMistake> shown_instead(const subject::Subject&, const Comparison&, int threads,
                                              const ComparedAs&);

}  // namespace deflect::compare
