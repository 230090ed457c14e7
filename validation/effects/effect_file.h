// Effect files: YAML in. `deflect effects NAME` prints one to start from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "validation/effects/effect.h"

namespace deflect::effects {

/// As strict as for device files: throws InputError "file:line: path: what is wrong, and the nearest valid name".
Effect read_effect(const std::filesystem::path&);

/// The same from text; `origin` takes the place of the file's name in messages.
Effect parse_effect(std::string_view yaml, const std::string& origin);

/// The effect as text of a file, as a template for new ones. Characters that a name cannot contain become '_'.
std::string write_effect(const Effect&);

/// The effects in the files *.yaml of a folder (effects/catalogue, or share/deflect/effects/catalogue where installed),
/// sorted by file name.
std::vector<Effect> catalogue(const std::filesystem::path& folder);

/// Appends an effect. Throws InputError where one of the same name exists.
void add_effect(std::vector<Effect>&, Effect);

/// The effect of that name. Throws InputError with the nearest name where there is none.
const Effect& find_effect(const std::vector<Effect>&, const std::string& name);

}  // namespace deflect::effects
