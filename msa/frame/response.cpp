#include <algorithm>

#include "msa/frame/solver.h"

namespace deflect::frame {

std::vector<std::pair<std::string, double>> energies(const Model& m, const VectorX& u) {
  std::vector<std::pair<std::string, double>> sums;
  const auto add = [&sums](const std::string& part, double energy) {
    const auto found = std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == part; });
    if (found == sums.end())
      sums.emplace_back(part, energy);
    else
      found->second += energy;
  };
  for (const Beam& beam : m.beams) {
    const Vector12 d = end_displacements(beam, u);
    add(beam.part, 0.5 * d.dot(pull(beam, d)));
  }
  for (const Spring& spring : m.springs) add(spring.part, energy(spring.law, evaluate(spring.elongation, u)));
  return sums;
}

}  // namespace deflect::frame
