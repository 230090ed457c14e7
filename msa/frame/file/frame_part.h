// The part of a frame that edits of single entries concern: these entries with what they refer to. Editing and reading
// it takes the time of a few entries, whatever the size of the frame.
//
// An entry is a member, a support, a spring or a sensor: "members.beam.factor" is of the entry beam of the list
// members. Whether it is allowed follows from itself and from what it refers to, except where
//   a load case prescribes a displacement of the support, which must then be rigid,
//   a member gets another material, which loads by heat and gravity look at,
//   a value is replaced, because a tolerance may name a number of the one before,
//   a number may become zero of which some tolerance is a share:
// such edits need the whole frame.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "msa/frame/file/frame_file.h"

namespace deflect::frame {

/// The list and the name of an entry: "members", "beam".
using EntryName = std::pair<std::string, std::string>;

/// The entries that these edits address. Nullopt where they need the whole frame.
std::optional<std::set<EntryName>> edited_entries(const FrameDescription&, const std::vector<TreeEdit>&);

/// The entries, with the nodes, materials and sections of the frame. Reads back like a frame: it has some load case.
DependentFrame part_of(const DependentFrame&, const std::set<EntryName>&);

/// The frame with its entries as they are in the part.
DependentFrame with_part(DependentFrame, const std::set<EntryName>&, DependentFrame part);

}  // namespace deflect::frame
