// Device files: YAML in, YAML out, and edits of a description.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "msa/fields/edit.h"
#include "msa/mechanism/description.h"

namespace deflect {

/// Reads a device strictly. Throws InputError "file:line: path: what is wrong, and the nearest valid name" for an
/// unknown or repeated key, a wrong or missing unit, a missing field, a value out of range, and a name that does not
/// resolve.
Mechanism read_mechanism(const std::filesystem::path&);

/// The same from text; `origin` takes the place of the file's name in messages.
Mechanism parse_mechanism(std::string_view yaml, const std::string& origin);

/// The description as a device file; reading it again gives an equal description, to the last bit of every number.
std::string write_mechanism(const Mechanism&);

/// A copy with the edit made, checked like a file. An edited value loses its mark as assumed ("ours"). Throws
/// InputError with path, value and the nearest valid name.
Mechanism edited(const Mechanism&, const Edit&);

/// Several edits in order, checked after the last. No edit may change something inside a value that another edit has
/// set.
Mechanism edited_in_turn(const Mechanism&, const std::vector<Edit>&);

/// The parts of one leg, variations applied. leg is 1-based.
Named<Part> leg_parts(const Mechanism&, int leg);

/// The same mechanism with variations applied, so that configure() need not apply them at every pose. It is for
/// computation only: it cannot be edited or written.
Mechanism resolved(const Mechanism&);

}  // namespace deflect
