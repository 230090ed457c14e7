// A place of a subject: where an effect can act. It follows from what a part is, not from the part's name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "validation/measurement/quantity.h"

namespace deflect::subject {

/// What a place is.
enum class PlaceKind {
  drive,       ///< a driven freedom
  joint,       ///< a freedom of a joint that nothing drives: free, elastic or rigid
  clamp,       ///< a rigid direction in which a joint holds a member, or a member's start is fixed to the part before
               ///< it
  member,      ///< a member, its material or its section
  member_end,  ///< where a member meets the next part without a joint
  line,        ///< along a bar that can carry only a force along itself
  platform,
  base,
  tool,
  support,
  load,
  load_cell,
  sensor,
  node,  ///< of a frame, where nothing is drawn between it and the ground
};
inline constexpr std::array place_kind_names = {"drive", "joint",     "clamp",  "member", "member end",
                                                "line",  "platform",  "base",   "tool",   "support",
                                                "load",  "load cell", "sensor", "node"};

/// A part of a group beside its first, as Place has it.
struct OtherPart {
  std::string part, path;
  std::vector<std::size_t> freedoms;
};

/// How a freedom is held in the description.
enum class Hold { rigid, elastic, free };

struct Place {
  PlaceKind kind = PlaceKind::joint;
  std::optional<int> leg = {};  ///< 1-based; none: the same place in every leg, or a part outside the legs
  std::string part;             ///< nested as in the description: "elbow", "forearm.knee", "base"
  std::string path;             ///< of the part in the description: "leg.forearm.leg.knee"
  /// The freedoms meant, as indices 0 … 5 of tx ty tz rx ry rz: all translations or all rotations. Empty: the part as a
  /// whole.
  std::vector<std::size_t> freedoms = {};
  Hold hold = Hold::rigid;
  bool one_stiffness = false;                       ///< its only law is one linear law
  bool slides = false;                              ///< the joint is driven along an axis
  bool base_axes = false;                           ///< of a frame's node: its freedoms are ux … rz
  std::optional<measurement::Quantity> reads = {};  ///< of a sensor whose zero is taken
  std::string other = {};                           ///< of a sensor: another, of which it may read a share
  std::vector<std::size_t> turns = {};              ///< of a load: axes about which it may be turned
  std::vector<std::size_t> shifts = {};  ///< of a load or a sensor: axes along which its point may lie elsewhere
  bool expands = false;                  ///< of a member whose material expands with heat
  bool misfit_shows = false;             ///< of a member: readings depend on its misfit
  bool may_stick = false;                ///< of a sensor whose description says how far it sticks
  std::string make = {};                 ///< type of a joint, section of a member or of one with this end
  std::string axes = {};                 ///< of a joint at a named point: their name
  /// Of a group (place_groups.h): its name in ids and in words, and the parts beside the one at `path`. Empty: one
  /// part.
  std::string group = {}, group_words = {};
  std::vector<OtherPart> others = {};
  /// Of a group of members: all that have their section, or all members, so that the section's dimensions or the
  /// modulus say the same of their stiffness.
  bool whole_section = false;

  bool rotation() const { return !freedoms.empty() && freedoms.front() >= 3; }
  /// Whether every leg has this place, so that an effect may also act in one leg only.
  bool in_legs() const {
    return path.starts_with("leg.") &&
           std::all_of(others.begin(), others.end(), [](const OtherPart& o) { return o.path.starts_with("leg."); });
  }
};

/// "tx", "rz"; at a frame's node "ux".
std::string freedom_name(const Place&, std::size_t freedom);
/// "rz"; "across" for tx and ty together, "tilt" for rx and ry; "" for a part as a whole, and for a group whose parts
/// have other freedoms each.
std::string motion_of(const Place&);
/// "elbow.rz", "revolute_joints.tilt", "supports.uz": how the place is written in the ids of effects.
std::string id_of(const Place&);
/// "elbow rz", "leg 3 elbow rz", "sensor probe", "group of revolute joints tilt".
std::string name_of(const Place&);
/// The sensor whose channel a place is about; empty for any other place.
std::string sensor_of(const Place&);
/// Whether two places are of one part; all that can be wrong with a channel is of its sensor.
bool of_one_part(const Place&, const Place&);

}  // namespace deflect::subject
