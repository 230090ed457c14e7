#include <algorithm>

#include "msa/base/index.h"
#include "msa/frame/deformed/geometric_solver.h"

namespace deflect::frame {
namespace {

struct Sums {
  std::vector<std::pair<std::string, double>> by_part;
  void add(const std::string& part, double energy) {
    const auto found = std::find_if(by_part.begin(), by_part.end(), [&](const auto& s) { return s.first == part; });
    if (found == by_part.end())
      by_part.emplace_back(part, energy);
    else
      found->second += energy;
  }
};

}  // namespace

std::vector<std::pair<std::string, double>> energies(const Model& m, const ExtendedVector& u,
                                                     const std::vector<double>& strains) {
  Sums sums;
  for (std::size_t e = 0; e < m.beams.size(); ++e) {
    const Beam& beam = m.beams[e];
    Vector12 d = end_displacements(beam, u);
    if (!strains.empty()) d.segment<3>(6) -= strains[e] * beam.length * beam.R_WM.col(0);
    sums.add(beam.part, 0.5 * d.dot(pull(beam, d)));
  }
  for (const Spring& spring : m.springs)
    sums.add(spring.part, stored_energy(spring.law, evaluate(spring.elongation, u)));
  return sums.by_part;
}

std::vector<std::pair<std::string, double>> energies(const Model& m, const GeometricState& state) {
  Sums sums;
  for (std::size_t e = 0; e < m.beams.size(); ++e) sums.add(m.beams[e].part, state.beams[e].energy);
  for (std::size_t i = 0; i < m.springs.size(); ++i)
    sums.add(m.springs[i].part, stored_energy(state.law(m, i), state.elongations(as_index(i))));
  return sums.by_part;
}

}  // namespace deflect::frame
