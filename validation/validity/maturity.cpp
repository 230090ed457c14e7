#include "validation/validity/maturity.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/number_words.h"
#include "validation/validity/validation.h"

namespace deflect::validity {
namespace {

/// The largest u_num over the size of what it belongs to.
double largest_num(const ValidationStudy& s) {
  double out = 0;
  for (const ChannelValidity& c : s.channels)
    if (c.rms_D > 0) out = std::max(out, c.num / c.rms_D);
  return out;
}

std::string verification(const ValidationStudy& s) {
  if (s.theories < 2)
    return "One theory (MSA), checked at every answer: symmetry, sign, equilibrium, energy. No second theory here.";
  return fmt::format(
      "Two theories that share no stiffness formula differ by {} of what they predict at these readings at most; every "
      "answer is checked for symmetry, sign, equilibrium and energy.",
      digits_of(s.theories_differ, 2));
}

std::string solution(const ValidationStudy& s) {
  std::string order = "the differences are rounding";
  for (const MeshOrder& each : s.mesh)
    if (each.order) order = fmt::format("observed order {}", digits_of(*each.order, 2));
  return fmt::format("u_num by elements of the MSA halved twice, {}: {} of what was measured, the largest quantity.",
                     order, digits_of(largest_num(s), 2));
}

std::string validated(const ValidationStudy& s) {
  return fmt::format("{} numbers of {} readings at {} pose{}: χ² = {} with {} degrees of freedom, p = {}{}.",
                     s.agreement.numbers, s.comparison.readings, s.comparison.poses, s.comparison.poses == 1 ? "" : "s",
                     digits_of(s.agreement.chi2, 4), s.agreement.numbers, digits_of(s.agreement.p_value, 2),
                     s.calibration ? fmt::format("; calibration data are others ({})", s.calibration->data) : "");
}

std::string uncertainty(const ValidationStudy& s) {
  return fmt::format(
      "Noise, load cell, {} tolerance{}{}, the size of the elements are propagated; what the model lacks is {}.",
      s.comparison.tolerances.nuisances.size(), s.comparison.tolerances.nuisances.size() == 1 ? "" : "s",
      s.calibrated ? ", fitted parameters" : "",
      agrees(s.agreement) ? "below what these data can show" : "estimated from these data");
}

std::string robustness(const ValidationStudy& s) {
  const auto changes =
      std::count_if(s.without.begin(), s.without.end(), [](const WithoutGroup& w) { return w.changes; });
  return fmt::format("The verdict changes without {} of {} single poses, load directions and sessions.", changes,
                     s.without.size());
}

std::string pedigree(const ValidationStudy& s) {
  return s.assumed ? fmt::format("{} numbers of the description are marked as assumed.", s.assumed)
                   : "No number of the description is marked as assumed.";
}

std::string physics(const ValidationStudy& s) {
  if (s.comparison.findings.empty()) return "No pattern beyond noise and tolerances is left in the residual.";
  return fmt::format("{} pattern{} left in the residual: something is missing (see the report).",
                     s.comparison.findings.size(), s.comparison.findings.size() == 1 ? " is" : "s are");
}

}  // namespace

std::vector<MaturityRow> maturity(const ValidationStudy& s) {
  return {
      {"PCMM", "Representation and geometric fidelity", pedigree(s)},
      {"PCMM", "Physics and material model fidelity", physics(s)},
      {"PCMM", "Code verification", verification(s)},
      {"PCMM", "Solution verification", solution(s)},
      {"PCMM", "Model validation", validated(s)},
      {"PCMM", "Uncertainty quantification and sensitivity analysis", uncertainty(s)},
      {"NASA-STD-7009", "Verification", verification(s)},
      {"NASA-STD-7009", "Validation", validated(s)},
      {"NASA-STD-7009", "Input pedigree", pedigree(s)},
      {"NASA-STD-7009", "Results uncertainty", uncertainty(s)},
      {"NASA-STD-7009", "Results robustness", robustness(s)},
      {"NASA-STD-7009", "Use history", ""},
      {"NASA-STD-7009", "M&S management", ""},
      {"NASA-STD-7009", "People qualifications", ""},
  };
}

}  // namespace deflect::validity
