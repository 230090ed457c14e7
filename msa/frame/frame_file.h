// Frame files: YAML in and out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "msa/frame/frame_description.h"

namespace deflect::frame {

/// Reads a frame. Strict: an unknown or doubled key, a wrong or missing unit, a missing field, a name that does not
/// resolve, a member without length, a load or a displacement where it cannot act is an InputError "file:line: path:
/// what, and the nearest valid name".
FrameDescription read_frame(const std::filesystem::path&);

/// The same from text; `origin` stands for the file's name in messages.
FrameDescription parse_frame(std::string_view yaml, const std::string& origin);

/// The description as a frame file; reading it again gives an equal description, to the last bit of every number.
std::string write_frame(const FrameDescription&);

}  // namespace deflect::frame
