// Effect files: YAML in. `deflect effects NAME` prints one to start from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "validation/effects/effect.h"

namespace deflect::effects {

/// Strict as device files are: InputError "file:line: path: what, and the nearest valid name".
Effect read_effect(const std::filesystem::path&);

/// The same from text; `origin` stands for the file's name in messages.
Effect parse_effect(std::string_view yaml, const std::string& origin);

/// The effect as a file to start one's own from; what a name cannot hold becomes '_'.
std::string write_effect(const Effect&);

/// The files *.yaml of a folder (effects/catalogue, or share/deflect/effects/catalogue where installed), by name of
/// file.
std::vector<Effect> catalogue(const std::filesystem::path& folder);

/// Joins an effect to others; InputError when one of them has its name.
void add_effect(std::vector<Effect>&, Effect);

/// The effect of that name, or InputError with the nearest one.
const Effect& find_effect(const std::vector<Effect>&, const std::string& name);

}  // namespace deflect::effects
