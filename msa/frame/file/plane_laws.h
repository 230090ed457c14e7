// Places of a plane frame whose laws all stand at freedoms that its plane holds: they would have no effect.
#pragma once

#include <string>

#include "msa/fields/yaml_tree.h"
#include "msa/frame/file/frame_description.h"

namespace deflect::frame {

/// InputError with file and line for a support, a spring or an end of a member all of whose laws act across the plane
/// or about an axis in it. `tree` is that of the frame.
void require_laws_in_plane(const FrameDescription&, const YamlNode& tree, const std::string& origin);

}  // namespace deflect::frame
