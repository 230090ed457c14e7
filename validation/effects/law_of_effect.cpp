#include "validation/effects/law_of_effect.h"

#include <algorithm>

#include "msa/fields/field_reader.h"
#include "msa/mechanism/fields.h"
#include "validation/effects/effect_value.h"
#include "validation/effects/with_effect.h"

namespace deflect::effects {

std::optional<Law> law_in_series(const Effect& e, const VectorX& values) {
  if (!e.place || e.place->freedoms.empty() || e.place->hold == subject::Hold::free || e.parameters.size() != 1 ||
      e.edits.empty())
    return std::nullopt;
  for (const EffectEdit& edit : e.edits)
    if (edit.action != EffectEdit::Action::append || edit.value != e.edits.front().value) return std::nullopt;
  const YamlNode node = filled_in(parse_yaml(e.edits.front().value, e.name), e, values);
  FieldReader reader(e.name);
  reader.surroundings.rotation = e.place->rotation();
  Law law;
  reader.read(node, [&] { describe(reader, law); });
  return law;
}

std::optional<Law> law_in_series(const Effect& e) { return law_in_series(e, start_values(e)); }

}  // namespace deflect::effects
