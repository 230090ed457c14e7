#include "msa/mechanism/numbers.h"

#include <fmt/format.h>

#include "msa/mechanism/fields.h"

namespace deflect {

void for_each_number(Mechanism& m, const std::function<void(std::size_t, double&)>& f) {
  NumberCalls walk(f);
  describe(walk, m);
  walk.surroundings = surroundings_of(m);
  for (Named<Part>& leg : m.legs) describe_leg(walk, leg);
}

std::vector<double> numbers_of(const Mechanism& m) {
  Mechanism copy = m;
  std::vector<double> out;
  for_each_number(copy, [&](std::size_t, double& x) { out.push_back(x); });
  return out;
}

std::vector<DescribedNumber> described_numbers(const Mechanism& m) {
  Mechanism copy = m;
  NumberList walk;
  describe(walk, copy);
  walk.surroundings = surroundings_of(copy);
  for (std::size_t i = 0; i < copy.legs.size(); ++i) {
    walk.leg = fmt::format("leg[{}]", i + 1);
    describe_leg(walk, copy.legs[i]);
  }
  return std::move(walk.found);
}

}  // namespace deflect
