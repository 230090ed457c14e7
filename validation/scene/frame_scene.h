// A solved frame as data of the 3D view.
#pragma once

#include <string>
#include <vector>

#include "msa/frame/file/frame_analysis.h"
#include "validation/json/json_text.h"

namespace deflect::scene {

/// A frame with more members than this is not drawn in 3D: a browser turns no more of them smoothly.
inline constexpr std::size_t most_drawn_members = 3000;

/// As scene_json (page_scene.h) with "kind": "frame": one pose, a shape with its "name" for each load case, nodes that
/// supports hold as ground, and no tool. Of a linear frame with few members each is divided into eight elements, so
/// that it is seen to bend; others are drawn as they were solved. Null above `most_drawn_members`.
/// `guilty`: members, supported nodes and sensors to be marked, as changed_parts() gives them.
Json frame_scene_json(const frame::FrameDescription&, const frame::FrameResult&,
                      const std::vector<std::string>& guilty = {});

/// "member beam", "start of beam" where only that end differs, "support B", "spring bed", "sensor lvdt": entries that
/// are not alike in two versions of a frame. Sections and materials stand for the members that have them.
std::vector<std::string> changed_parts(const frame::FrameDescription&, const frame::FrameDescription&);

}  // namespace deflect::scene
