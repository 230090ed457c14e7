// A place of a subject: where an effect can act, whatever the subject calls its parts.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace deflect::subject {

/// What a place is.
enum class PlaceKind {
  drive,       ///< a driven freedom
  joint,       ///< a freedom of a joint that nothing drives: free, elastic or rigid
  clamp,       ///< a rigid direction in which a member or a slide is held by what stands before it
  member,      ///< a member, its material or its section
  member_end,  ///< where a member passes into what follows without a joint between
  line,        ///< along a bar that can carry nothing but a force along itself
  platform,
  base,
  tool,
  support,
  load,
  load_cell,
  sensor,
};
inline constexpr std::array place_kind_names = {"drive", "joint",     "clamp", "member", "member end",
                                                "line",  "platform",  "base",  "tool",   "support",
                                                "load",  "load cell", "sensor"};

/// How a freedom is held in the description.
enum class Hold { rigid, elastic, free };

struct Place {
  PlaceKind kind = PlaceKind::joint;
  std::optional<int> leg = {};  ///< 1-based; none: the same place of every leg, or of a part that is in no leg
  std::string part;             ///< as parts nest in the description: "elbow", "forearm.knee", "base"
  std::string path;             ///< of the part in the description: "leg.forearm.leg.knee"
  /// Those of its freedoms tx ty tz rx ry rz (0 … 5) that are meant, of one kind; none: the part as a whole.
  std::vector<std::size_t> freedoms = {};
  Hold hold = Hold::rigid;
  bool one_stiffness = false;  ///< elastic by one linear law alone
  bool slides = false;         ///< of a joint that is driven along an axis

  bool rotation() const { return !freedoms.empty() && freedoms.front() >= 3; }
  /// In every leg alike, so that an effect may also sit in one of them.
  bool in_legs() const { return path.starts_with("leg."); }
};

/// "rz"; "across" for tx and ty together, "tilt" for rx and ry; "" for a part as a whole.
std::string motion_of(const Place&);
/// "elbow.rz": the place in the ids of effects.
std::string id_of(const Place&);
/// "elbow rz", "leg 3 elbow rz".
std::string name_of(const Place&);

}  // namespace deflect::subject
