#include "analytic/erratum.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/units.h"

namespace deflect {

const std::vector<ErratumInfo>& errata() {
  static const std::vector<ErratumInfo> list = {
      {Erratum::contact_modulus, "contact-modulus", "(23)",
       "the effective modulus is half of Hertz's: 1/E' where 2/E' belongs"},
      {Erratum::line_contact, "line-contact", "(30)",
       "line contact without the bulk of the bodies: what the law hertz_line is; hertz_line_bulk has it"},
      {Erratum::ujoint_parallel, "ujoint-parallel", "(33)",
       "the universal joint's contact and pin side by side, where the force passes one after the other"},
      {Erratum::guideway_matrix, "guideway-matrix", "(35)",
       "entry (2,6) with L^3 for L^2, numbers in N and mm, entry (5,5) 6EI/L for 4EI/L: an asymmetric stiffness"},
      {Erratum::link_matrix, "link-matrix", "(41)", "E missing in two entries, taken in N and mm"},
      {Erratum::link_frame, "link-frame", "(40)",
       "the link's frame is undefined where the link is vertical: refused there"},
      {Erratum::passive_joints, "passive-joints", "(45), (46)",
       "the legs carry moments that ball and universal joints cannot: passive joints not released"},
      {Erratum::tcp_transfer, "tcp-transfer", "(46)",
       "the legs' stiffnesses are summed at their platform joints, not moved to the TCP"},
      {Erratum::scalar_direction, "scalar-direction", "(45)",
       "a joint's scalar compliance is added in all six directions, numbers in N and mm"},
  };
  return list;
}

const ErratumInfo& info(Erratum e) {
  return *std::find_if(errata().begin(), errata().end(), [e](const ErratumInfo& i) { return i.erratum == e; });
}

std::set<Erratum> parse_errata(std::string_view list) {
  std::set<Erratum> out;
  if (list == "none" || list.empty()) return out;
  std::vector<std::string> names;
  for (const ErratumInfo& i : errata()) names.emplace_back(i.name);
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t to = std::min(list.find(',', from), list.size());
    const std::string_view word = list.substr(from, to - from);
    from = to + 1;
    const auto found = std::find(names.begin(), names.end(), word);
    if (word == "all")
      for (const ErratumInfo& i : errata()) out.insert(i.erratum);
    else if (found != names.end())
      out.insert(nth(errata(), found - names.begin()).erratum);
    else
      throw InputError(fmt::format("--as-printed: there is no erratum '{}'{}; known: all, none, {}", word,
                                   nearest(word, names).empty() ? "" : ", did you mean '" + nearest(word, names) + "'?",
                                   fmt::join(names, ", ")));
  }
  return out;
}

}  // namespace deflect
