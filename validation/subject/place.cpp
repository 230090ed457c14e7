#include "validation/subject/place.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/mechanism/joint_table.h"

namespace deflect::subject {

std::string freedom_name(const Place& p, std::size_t freedom) {
  const char* name = freedom_names.at(freedom);
  return p.base_axes && freedom < 3 ? fmt::format("u{}", name[1]) : name;
}

std::string motion_of(const Place& p) {
  if (p.freedoms.empty()) return "";
  for (const OtherPart& other : p.others)
    if (other.freedoms != p.freedoms) return "";
  if (p.freedoms.size() > 1) return p.rotation() ? "tilt" : "across";
  return freedom_name(p, p.freedoms.front());
}

std::string id_of(const Place& p) {
  const std::string motion = motion_of(p), &part = p.others.empty() ? p.part : p.group;
  return motion.empty() ? part : part + "." + motion;
}

std::string name_of(const Place& p) {
  const std::string motion = motion_of(p);
  if (!p.other.empty()) return "sensor " + sensor_of(p);
  const std::string where = p.kind == PlaceKind::sensor ? "sensor " : p.leg ? fmt::format("leg {} ", *p.leg) : "";
  std::string part = p.others.empty() ? p.part : "group of " + p.group_words;
  if (p.base_axes && p.others.empty()) std::replace(part.begin(), part.end(), '.', ' ');  // "support.B" of a frame
  return fmt::format("{}{}{}{}", where, part, motion.empty() ? "" : " ", motion);
}

std::string sensor_of(const Place& p) {
  if (p.kind != PlaceKind::sensor) return "";
  return p.other.empty() ? p.part : p.part.substr(0, p.part.size() - p.other.size() - 1);
}

bool of_one_part(const Place& a, const Place& b) {
  return a.path == b.path || (a.kind == PlaceKind::sensor && sensor_of(a) == sensor_of(b));
}

}  // namespace deflect::subject
