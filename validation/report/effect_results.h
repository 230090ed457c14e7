// Effects as a table, as a page for a person, and as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "validation/effects/with_effect.h"
#include "validation/json/json_text.h"

namespace deflect::report {

/// One paragraph per effect: name, scope, title, parameters.
std::string effect_table(const std::vector<effects::Effect>&);

/// {"kind", "part", "path"} and, where it has them, "motion" and "leg".
Json place_json(const subject::Place&, std::optional<int> leg);

/// Which of them have a place in the device; of the others, why not. Laws at places by place.
std::string effects_in_device(const std::vector<effects::Effect>&, const subject::Subject&);

/// Everything about one effect.
std::string effect_page(const effects::Effect&);

/// [{"effect", "title", "scope", "parameters": [{"name", "unit", "start", "low", "high", "scale", "vanishes",
/// "about"}], "edits": [{"at": […], "action", "value"}], "pages": {…}, "see"}]; with a device also "applies" and
/// "reason". "vanishes" is a number, "infinity", or absent.
std::string effects_json(const std::vector<effects::Effect>&, const std::optional<subject::Subject>& device);

/// "guide_root_compliance (stiffness_Nmm_per_rad = 5e+06)", "leg_defect of leg 4 (factor = 0.7)".
std::string words(const effects::EffectInstance&);

/// {"device", "new_device", "added": [{"effect", "site", "leg" (where it is one), "parameters": [{"name", "value"}]}]}.
std::string added_json(const std::string& device, const std::string& new_device,
                       const std::vector<effects::EffectInstance>&);

/// {"device", "data", "readings", "poses", "seed", "hidden": the same list as "added"}.
std::string simulated_json(const std::string& device, const std::string& data, std::size_t readings, std::size_t poses,
                           const std::vector<effects::EffectInstance>& hidden, std::uint64_t seed);

}  // namespace deflect::report
