// The sets of the benchmark, as orders: what is to be hidden where, how large, read how.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "validation/effects/effect.h"

namespace deflect::benchmark {

/// one       one effect of the catalogue
/// healthy   nothing
/// stress    nothing, but doubled tolerances, or heavy-tailed reading noise, or gross outliers
/// left-out  one effect, its entry taken out of the catalogue
/// law       a law that no entry describes
/// tie       an effect on a plan that cannot tell it from another entry
/// pair      two effects
inline constexpr const char* group_names[] = {"one", "healthy", "stress", "left-out", "law", "tie", "pair"};
inline constexpr const char* stress_names[] = {"doubled tolerances", "t(3) noise", "2 % outliers"};
enum class Stress { tolerances, heavy_tails, outliers };

struct Case {
  std::string group, campaign;
  int index = 0;    ///< in its group
  int variant = 0;  ///< of the plan
  std::uint64_t seed = 0;
  std::string effect;   ///< of "one" and "left-out"
  double lambda = 0;    ///< of each effect; of a law what is left of it beyond the catalogue
  std::size_t law = 0;  ///< of "law"
  Stress stress = Stress::tolerances;
};

/// The entries that are hidden. Equilibrium in the deformed shape is none of them: it is in all sets.
const std::vector<std::string>& entries();

/// All sets, or about `most` of them, every group thinned alike, those of one group where it is named. A set is the
/// same however many are asked for.
std::vector<Case> cases(std::uint64_t seed, const std::string& group, std::size_t most);

}  // namespace deflect::benchmark
