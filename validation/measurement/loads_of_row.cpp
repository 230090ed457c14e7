// The loads that rows combine, and rows once more with others.
#include "validation/measurement/measurements.h"

namespace deflect::measurement {

void scale_load(Reading& r, double factor) {
  for (Vector6* load : {&r.load, &r.at_tool, &r.on_platform}) *load *= factor;
  for (Vector6& load : r.at_points) load *= factor;
  for (double& each : r.factors) each *= factor;
}

std::vector<std::size_t> loads_of_row(const Reading& r) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < r.factors.size(); ++k)
    if (r.factors[k] != 0) out.push_back(k);
  for (std::size_t p = 0; p < r.at_points.size(); ++p)
    if (!r.at_points[p].isZero(0)) out.push_back(r.factors.size() + p);
  if (!(r.at_points.empty() ? r.load : r.at_tool).isZero(0)) out.push_back(r.factors.size() + r.at_points.size());
  return out;
}

void scale_load(Reading& r, std::size_t load, double factor) {
  const std::size_t cases = r.factors.size();
  if (load < cases)
    r.factors[load] *= factor;
  else if (load < cases + r.at_points.size())
    r.at_points[load - cases] *= factor;
  else
    (r.at_points.empty() ? r.load : r.at_tool) *= factor;
}

void scale_loads(Reading& r, const std::function<double()>& factor) {
  const std::vector<std::size_t> loads = loads_of_row(r);
  if (loads.empty()) factor();
  for (const std::size_t load : loads) scale_load(r, load, factor());
}

Measurements repeated(const Measurements& m, const std::vector<std::size_t>& readings) {
  Measurements out{m.origin, m.joint_rotates, m.note_columns, m.temperature_recorded, m.poses,
                   {},       m.how_read,      m.instruments};
  for (PoseGroup& p : out.poses) p.readings.clear();
  for (const std::size_t i : readings) {
    out.poses[m.readings[i].pose].readings.push_back(out.readings.size());
    out.readings.push_back(m.readings[i]);
  }
  return out;
}

}  // namespace deflect::measurement
