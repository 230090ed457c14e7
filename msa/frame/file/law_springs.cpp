#include "msa/frame/file/law_springs.h"

#include <fmt/format.h>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/laws/component.h"
#include "msa/mechanism/table.h"

namespace deflect::frame {

SpringLaw LawSprings::spring(Law law, bool rotation) {
  std::visit(
      [this](auto& l) {
        if constexpr (requires { l.solid; }) {
          if (l.material.empty()) return;
          const int at = materials_.find(l.material);
          if (at < 0) throw InputError(fmt::format("there is no material '{}'", l.material));
          l.solid = nth(f_.materials, at).second.elastic;
        }
      },
      law);
  if (auto* friction = std::get_if<FrictionLaw>(&law)) friction->number = slips_++;
  if (auto* table = std::get_if<TableLaw>(&law)) {
    *table = identified(std::move(*table));
    if (table->remembers()) {
      table->number = slips_;
      slips_ += 2;
    }
  }
  SpringLaw out = spring_of(law);
  out.rotation = rotation;
  return out;
}

std::array<ConnectionFreedom, 6> LawSprings::freedoms(const Freedoms& rigid, const FreedomLaws& laws) {
  std::array<ConnectionFreedom, 6> out;
  for (std::size_t i = 0; i < 6; ++i) {
    out[i].rigid = rigid[i] && !laws.has(i);
    if (laws.empty()) continue;
    for (const Law& law : laws.at(i)) out[i].laws.push_back(spring(law, i >= 3));
    for (const Law& law : laws.at(i, true)) out[i].beside.push_back(spring(law, i >= 3));
  }
  return out;
}

}  // namespace deflect::frame
