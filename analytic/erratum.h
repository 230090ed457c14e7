// The paper's errata: variants of the analytic theory in which an equation is taken as printed.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace deflect {

enum class Erratum {
  contact_modulus,
  line_contact,
  ujoint_parallel,
  guideway_matrix,
  link_matrix,
  link_frame,
  passive_joints,
  tcp_transfer,
  scalar_direction,
};

struct ErratumInfo {
  Erratum erratum;
  const char* name;        ///< on the command line: "passive-joints"
  const char* equations;   ///< "(45), (46)"
  const char* as_printed;  ///< the effect of the variant, in one sentence
};

const std::vector<ErratumInfo>& errata();
const ErratumInfo& info(Erratum);

/// "passive-joints,ujoint-parallel", "all" or "none" → the set. Throws InputError with the nearest known name.
std::set<Erratum> parse_errata(std::string_view list);

}  // namespace deflect
