#include "validation/report/inner_sites_results.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/index.h"
#include "validation/report/text.h"

namespace deflect::report {
namespace {

constexpr std::size_t most_sites = 5;

std::string known_by(bool determinate, double redundancy) {
  return determinate ? "statics" : fmt::format("the model ({:.2f})", redundancy);
}

/// How many of the places statics determines, and what the members' redundancies add up to.
std::string determinacy(const subject::InnerSites& sites) {
  std::size_t by_statics = 0;
  for (const subject::InnerSite& s : sites.all) by_statics += s.determinate ? 1 : 0;
  const std::size_t all = sites.all.size();
  if (by_statics == all) return "Statics alone determines the forces in all members and supports.";
  return fmt::format(
      "Statics alone determines the force in {} of {} members and supports; the model's stiffnesses share out the "
      "others.",
      by_statics, all);
}

}  // namespace

std::string inner_sites_text(const compare::Comparison& c) {
  if (c.study.inner.all.empty()) return "";
  std::string out = determinacy(c.study.inner) + "\n";
  std::vector<std::vector<std::string>> rows = {
      {"what one place alone would have to yield", "force up to", "known by", "yields at it", "of the misfit", "p"}};
  for (std::size_t i = 0; i < std::min(most_sites, c.inner.size()); ++i) {
    const compare::InnerSiteFit& s = c.inner[i];
    rows.push_back({"  " + s.site, fmt::format("{:.4g} {}", s.most, s.rotation ? "Nm" : "N"),
                    known_by(s.determinate, s.redundancy),
                    fmt::format("{:.4g} ± {:.2g} {}", um * s.most * s.per_force, um * s.most * s.deviation,
                                s.rotation ? "µrad" : "µm"),
                    fmt::format("{:.0f} %", 100 * s.share),
                    s.p_value < 1e-16 ? "< 1e-16" : fmt::format("{:.2g}", s.p_value)});
  }
  return out + (c.inner.empty() ? "" : aligned(rows));
}

Json inner_sites_json(const compare::Comparison& c) {
  if (c.study.inner.all.empty()) return nullptr;
  Json out = {{"sites", Json::array()}, {"residual_forces", Json::array()}};
  const measurement::Measurements& data = *c.study.data;
  out["reading_line"] = data.readings[c.telling].line;
  const auto per = [](bool rotation) { return rotation ? 1 / mm : mm; };  // rad/Nm to rad/Nmm, m/N to mm/N
  for (const compare::InnerSiteFit& s : c.inner)
    out["sites"].push_back({{"name", s.site},
                            {"determined_by", s.determinate ? "statics" : "model"},
                            {"redundancy", s.redundancy},
                            {"largest_force", (s.rotation ? mm : 1) * s.most},
                            {"force_unit", s.rotation ? "Nmm" : "N"},
                            {"yields_per_force", per(s.rotation) * s.per_force},
                            {"deviation", per(s.rotation) * s.deviation},
                            {"yield_unit", s.rotation ? "rad/Nmm" : "mm/N"},
                            {"chi2_gain", s.gain},
                            {"p_value", s.p_value},
                            {"share_of_misfit", s.share}});
  const VectorX predicted = compare::inner_forces(c.study).col(as_index(c.telling));
  for (std::size_t k = 0; k < c.study.inner.all.size(); ++k) {
    const subject::InnerSite& s = c.study.inner.all[k];
    const double unit = s.rotation ? mm : 1;
    out["residual_forces"].push_back(
        {{"name", s.name},
         {"predicted", json::json_number(unit * predicted(as_index(k)), "force")},
         {"more_than_predicted", json::json_number(unit * c.residual_forces(as_index(k)), "residual force")},
         {"unit", s.rotation ? "Nmm" : "N"}});
  }
  return out;
}

}  // namespace deflect::report
