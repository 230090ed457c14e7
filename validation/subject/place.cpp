#include "validation/subject/place.h"

#include <fmt/format.h>

#include "msa/mechanism/joint_table.h"

namespace deflect::subject {

std::string freedom_name(const Place& p, std::size_t freedom) {
  const char* name = freedom_names.at(freedom);
  return p.base_axes && freedom < 3 ? fmt::format("u{}", name[1]) : name;
}

std::string motion_of(const Place& p) {
  if (p.freedoms.empty()) return "";
  if (p.freedoms.size() > 1) return p.rotation() ? "tilt" : "across";
  return freedom_name(p, p.freedoms.front());
}

std::string id_of(const Place& p) {
  const std::string motion = motion_of(p);
  return motion.empty() ? p.part : p.part + "." + motion;
}

std::string name_of(const Place& p) {
  const std::string motion = motion_of(p);
  const std::string where = p.kind == PlaceKind::sensor    ? "sensor "
                            : p.kind == PlaceKind::support ? "support "
                            : p.leg ? fmt::format("leg {} ", *p.leg) : "";
  return fmt::format("{}{}{}{}", where, p.part, motion.empty() ? "" : " ", motion);
}

}  // namespace deflect::subject
