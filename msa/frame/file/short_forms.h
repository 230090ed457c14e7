// Short forms of frame files: `A: clamped` for `A: {holds: clamped}` in supports, and `ux: 5 N/mm` for `ux: {law:
// linear, stiffness: 5 N/mm}` in springs. Fields and edits know the long ones only.
#pragma once

#include "msa/fields/tree_edit.h"
#include "msa/fields/yaml_tree.h"

namespace deflect::frame {

/// A frame's file with the long forms; what is neither form stays for the reader to refuse.
YamlNode spelled_out(YamlNode file);

/// A written file with the short forms where they say the same.
YamlNode shortened(YamlNode file);

/// An edit of a short form as one of the long form: `springs.bed.ux *= 2`, `supports.A += uy`.
TreeEdit spelled_out(TreeEdit);

}  // namespace deflect::frame
