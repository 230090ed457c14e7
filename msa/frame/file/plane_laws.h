// Laws of a plane frame at freedoms that its plane holds: they would have no effect.
#pragma once

#include <string>

#include "msa/fields/yaml_tree.h"
#include "msa/frame/file/frame_description.h"

namespace deflect::frame {

/// InputError with file and line for a law across the plane, or about an axis in it, at a support, in a spring or at an
/// end of a member. `tree` is that of the frame.
void require_laws_in_plane(const FrameDescription&, const YamlNode& tree, const std::string& origin);

}  // namespace deflect::frame
