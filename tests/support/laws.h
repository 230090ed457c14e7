// The examples of the table of laws, in a device's drive.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "msa/mechanism/law.h"
#include "tests/support/devices.h"

namespace deflect::test {

struct LawSite {
  const LawRow* law;
  bool rotation;
};

inline std::vector<LawSite> law_sites() {
  std::vector<LawSite> all;
  for (const LawRow& law : law_rows) {
    all.push_back({&law, false});
    if (law.about) all.push_back({&law, true});
  }
  return all;
}

inline std::string name_of(const LawSite& site) {
  return site.law->name + std::string(site.rotation ? "_about" : "_along");
}

/// For the names of tests.
inline void PrintTo(const LawSite& site, std::ostream* out) { *out << name_of(site); }

inline Mechanism with_law(const LawSite& site) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  const std::string fields = site.rotation ? site.law->about : site.law->along;
  return with(m, site.rotation ? "leg.actuator.ry" : "leg.actuator.tz",
              fmt::format("{{law: {}, {}}}", site.law->name, fields));
}

/// As the description has it, its material by name.
inline const Law& law_of(const Mechanism& m, const LawSite& site) {
  return std::get<Joint>(*find(m.leg, "actuator")).laws[site.rotation ? 4 : 2].front();
}

/// As it stands at the home pose, its material resolved.
inline Law resolved_law(const LawSite& site) {
  const Mechanism m = with_law(site);
  const Configuration c = configure(m, home_pose(m));
  for (const PlacedPart& part : c.legs.front().parts)
    if (const auto* joint = std::get_if<PlacedJoint>(&part); joint && joint->part.find("actuator") != std::string::npos)
      return joint->laws[site.rotation ? 4 : 2].front();
  throw std::logic_error("the device has no actuator");
}

}  // namespace deflect::test
