// Parts of a machine by what they are for, whatever they are called. In the words of a slide-driven leg, base to
// platform:
//   guide     a driven slide that holds a member, and that member, the guided one;
//   carriage  a fixed joint at the tip of a guided member;
//   bar       a member that can carry only a force along itself: between two pivots that leave it no more turns than
//   one,
//             about itself;
//   seat      a fixed joint at the end of a leg in the axes of the platform.
// A pivot is a joint along which nothing moves and that turns freely.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"

namespace deflect::subject {

/// Paths in the description, "leg.guideway", of the legs, of separate mounts and of branches inside legs.
std::vector<std::string> guides(const Mechanism&);
std::vector<std::string> guided_members(const Mechanism&);
std::vector<std::string> carriages(const Mechanism&);
std::vector<std::string> seats(const Mechanism&);

/// The pivot at which each bar begins, where its axes run along the bar (z): in families with named axes. Turns against
/// springs count as free here.
std::vector<std::string> pivots_of_bars(const Mechanism&);

/// The names of the guided members' sections, each once.
std::vector<std::string> guided_sections(const Mechanism&);

/// Whether the part, a member of that chain, is a bar.
bool is_bar(const Named<Part>& chain, std::size_t part);

}  // namespace deflect::subject
