// Device files: YAML in, YAML out, and edits of a description.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "msa/fields/edit.h"
#include "msa/mechanism/description.h"

namespace deflect {

/// Reads a device. Strict: an unknown or doubled key, a wrong or missing unit, a missing field, a value out of its
/// range, a name that does not resolve is an InputError "file:line: path: what, and the nearest valid name".
Mechanism read_mechanism(const std::filesystem::path&);

/// The same from text; `origin` stands for the file's name in messages.
Mechanism parse_mechanism(std::string_view yaml, const std::string& origin);

/// The description as a device file; reading it again gives an equal description, to the last bit of every number.
std::string write_mechanism(const Mechanism&);

/// A new description with the edit in it, checked like a file; the old one is untouched. A value that was assumed
/// ("ours") and is edited is no longer marked so. Throws InputError naming path, value and the nearest valid name.
Mechanism edited(const Mechanism&, const Edit&);

/// Several edits, one after the other, checked when all are done; none reaches into a value that another has set.
Mechanism edited_in_turn(const Mechanism&, const std::vector<Edit>&);

/// The parts of one leg, variations applied. leg is 1-based.
Named<Part> leg_parts(const Mechanism&, int leg);

/// The same mechanism with its variations worked out, so that configure() need not do so at every pose. It is for
/// models: it cannot be edited or written.
Mechanism resolved(const Mechanism&);

}  // namespace deflect
