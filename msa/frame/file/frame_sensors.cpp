#include "msa/frame/file/frame_sensors.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::frame {
namespace {

std::size_t index_of(int found, const char* what, const std::string& name) {
  if (found < 0) throw InputError(fmt::format("there is no {} '{}'", what, name));
  return as_size(found);
}

/// The element of a member at a share of its length, and the distance from the element's start, m.
std::pair<std::size_t, double> element_at(const FrameModel& m, std::size_t member, double share) {
  const auto first = as_size(m.first_element[member]), end = as_size(m.first_element[member + 1]);
  double length = 0;
  for (std::size_t e = first; e < end; ++e) length += m.model.beams[e].length;
  double x = share * length;
  for (std::size_t e = first; e + 1 < end; ++e) {
    if (x <= m.model.beams[e].length) return {e, x};
    x -= m.model.beams[e].length;
  }
  return {end - 1, std::min(x, m.model.beams[end - 1].length)};
}

/// [N, Vy, Vz, T, My, Mz] there, and the beam.
std::pair<Vector6, const Beam*> section_at(const FrameSensor& s, const FrameModel& m, const CaseResult& r) {
  const auto [e, x] = element_at(m, index_of(m.members.find(s.of), "member", s.of), s.at);
  const Beam* beam = &m.model.beams[e];
  if (!r.courses.empty()) return {section_forces(r.courses[e], x), beam};
  const ElementLoad load = e < r.loads.size() ? r.loads[e] : ElementLoad{};
  return {section_forces(r.end_forces[e], load, x), beam};
}

}  // namespace

double true_reading(const FrameSensor& s, const FrameDescription& f, const FrameModel& m, const CaseResult& r) {
  switch (s.reads) {
    case FrameSensor::Reads::displacement: {
      const Vector6& d = r.displacements[index_of(m.nodes.find(s.of), "node", s.of)];
      return s.axis.dot(s.rotation ? d.tail<3>() : d.head<3>());
    }
    case FrameSensor::Reads::force:
      return section_at(s, m, r).first(as_index(s.component));
    case FrameSensor::Reads::strain: {
      const auto [forces, beam] = section_at(s, m, r);
      const BeamRigidity& k = beam->rigidity;
      return forces(0) / k.EA - s.y * forces(5) / k.EIz + s.z * forces(4) / k.EIy;
    }
    case FrameSensor::Reads::reaction:
      return r.reactions[index_of(NameIndex(f.supports).find(s.of), "support at node", s.of)](as_index(s.component));
  }
  return 0;
}

double recorded_by(const FrameSensor& s, const FrameDescription& f, const FrameModel& m, const CaseResult& r) {
  return s.gain * true_reading(s, f, m, r) + s.zero;
}

}  // namespace deflect::frame
