// Recognises what a YAML file describes by its top-level keys, for files that are given to the wrong command.
#pragma once

#include <string>

#include "msa/fields/yaml_tree.h"

namespace deflect {

enum class FileKind { unknown, device, frame, effect };

FileKind kind_of(const YamlNode& tree);

/// Throws InputError "origin:line: this file describes a frame, not a device: 'deflect frame FILE' solves it" where the
/// file is clearly of another kind.
void require_kind(const YamlNode& tree, FileKind wanted, const std::string& origin);

}  // namespace deflect
