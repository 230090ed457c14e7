// The report for a person.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "msa/base/index.h"
#include "msa/frame/structure/elimination.h"
#include "validation/report/frame_results.h"
#include "validation/report/text.h"

namespace deflect::report {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Which rows of a long list are shown: those with the largest entries, in the order of the list. `sizes`: one per row.
std::vector<std::size_t> shown(const std::vector<double>& sizes, std::size_t most) {
  std::vector<std::size_t> rows(sizes.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  if (rows.size() <= most) return rows;
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  rows.resize(most);
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::string title(const std::string& what, std::size_t rows, std::size_t most) {
  return what + (rows > most ? fmt::format(", the {} largest of {}", most, rows) : "") + "\n";
}

/// What drowns in the rounding of the largest is shown as 0.
std::string number(double value, double largest) {
  return std::abs(value) <= 1e-11 * largest ? "0" : fmt::format("{:.6g}", value);
}

/// A table of rows [3; 3]. `arm` converts between the two kinds, so that both are measured by the larger: a rotation
/// times the size of the frame, a moment over it.
template <class NameOf>
std::string table(const std::vector<Vector6>& values, double arm, std::size_t most,
                  const std::vector<std::string>& header, NameOf name_of) {
  double first = 0, second = 0;
  for (const Vector6& v : values) {
    first = std::max(first, v.head<3>().cwiseAbs().maxCoeff());
    second = std::max(second, v.tail<3>().cwiseAbs().maxCoeff());
  }
  first = std::max(first, second * arm);
  second = std::max(second, first / arm);
  std::vector<double> sizes;
  sizes.reserve(values.size());
  for (const Vector6& v : values)
    sizes.push_back(std::max(v.head<3>().cwiseAbs().maxCoeff(), v.tail<3>().cwiseAbs().maxCoeff() * arm));
  Rows rows = {header};
  for (const std::size_t i : shown(sizes, most)) {
    rows.push_back({"  " + name_of(i)});
    for (int k = 0; k < 6; ++k) rows.back().push_back(number(values[i](k), k < 3 ? first : second));
  }
  return aligned(rows);
}

std::vector<Vector6> moments_in_mm(std::vector<Vector6> values) {
  for (Vector6& v : values) v.tail<3>() *= 1e3;
  return values;
}

std::string members(const frame::FrameDescription& f, const frame::CaseResult& c, bool finite, double size,
                    std::size_t most) {
  std::vector<Vector6> ends;
  for (const frame::MemberForces& m : c.members) {
    ends.push_back(m.start);
    ends.push_back(m.end);
  }
  const std::string axes =
      finite ? "member forces in the axes of the section there, N and Nmm" : "member forces in member axes, N and Nmm";
  return title(axes, ends.size(), most) +
         table(moments_in_mm(ends), 1 / size, most, {"", "N", "Vy", "Vz", "T", "My", "Mz"},
               [&](std::size_t i) { return f.members[i / 2].first + (i % 2 ? " end" : " start"); });
}

std::string inner_moments(const frame::FrameDescription& f, const frame::CaseResult& c, std::size_t most) {
  Rows rows;
  for (std::size_t i = 0; i < f.members.size() && rows.size() < most; ++i) {
    const frame::MemberForces& m = c.members[i];
    const auto add = [&](const char* name, const frame::LargestMoment& largest, int k) {
      const double ends = std::max(std::abs(m.start(k)), std::abs(m.end(k)));
      if (std::abs(largest.value) > ends * (1 + 1e-9))
        rows.push_back({"  " + f.members[i].first, name, fmt::format("{:.6g} Nmm", 1e3 * largest.value),
                        fmt::format("at {:.6g} mm", 1e3 * largest.at)});
    };
    add("My", m.My, 4);
    add("Mz", m.Mz, 5);
  }
  return rows.empty() ? "" : "largest moments between the ends\n" + aligned(rows);
}

std::string shares(const frame::CaseResult& c) {
  Rows rows;
  for (const auto& [part, energy] : c.energies)
    rows.push_back({"  " + part, fmt::format("{:.2f} %", c.energy > 0 ? 100 * energy / c.energy : 0)});
  return fmt::format("strain energy {:.6g} Nmm\n", 1e3 * c.energy) + aligned(rows);
}

std::string equations(const frame::EquationSummary& e) {
  std::string text = fmt::format("solver: {} ({})", e.solver, e.why);
  if (e.error_bound)
    text += fmt::format(", {} iterations, error bound {:.1e} of the energy norm", e.iterations, *e.error_bound);
  return text + "\n";
}

std::string path(const frame::PathSummary& p) {
  std::string text = fmt::format("{} step{}, {} iterations\n", p.steps, p.steps == 1 ? "" : "s", p.iterations);
  if (!p.message.empty()) text += fmt::format("at {:.4g} of the load; {}\n", p.load_factor, p.message);
  return text;
}

}  // namespace

std::string frame_report(const frame::FrameDescription& f, const frame::FrameResult& result, std::size_t most) {
  std::string text = fmt::format("{}: {} nodes, {} members, {} load case{}\n", result.name, f.nodes.size(),
                                 f.members.size(), result.cases.size(), result.cases.size() == 1 ? "" : "s");
  const bool linear = result.geometry == Geometry::linear;
  if (!linear) text += fmt::format("geometry: {}\n", nth(geometry_names, result.geometry));
  if (linear) text += equations(result.equations);
  for (const std::string& note : notes_of(f, result)) text += "note: " + note + "\n";
  const double size = 1e3 * frame::characteristic_length(result.structure.model);
  for (const frame::CaseResult& c : result.cases) {
    std::vector<Vector6> u;
    for (const Vector6& d : c.displacements) u.push_back(twist_in_mm(d));
    text += fmt::format("\nload case '{}'\n", c.name);
    if (!linear) text += path(c.path);
    text +=
        title("displacements, mm and rad", u.size(), most) +
        table(u, size, most, {"", "ux", "uy", "uz", "rx", "ry", "rz"}, [&](std::size_t i) { return f.nodes[i].first; });
    if (!f.supports.empty())
      text += title("reactions, N and Nmm", f.supports.size(), most) +
              table(moments_in_mm(c.reactions), 1 / size, most, {"", "fx", "fy", "fz", "mx", "my", "mz"},
                    [&](std::size_t i) { return f.supports[i].first; });
    if (!f.springs.empty())
      text += title("spring forces on their nodes, N and Nmm", f.springs.size(), most) +
              table(moments_in_mm(c.springs), 1 / size, most, {"", "fx", "fy", "fz", "mx", "my", "mz"},
                    [&](std::size_t i) { return f.springs[i].first; });
    if (!f.members.empty())
      text += members(f, c, result.geometry == Geometry::finite, size, most) + inner_moments(f, c, most);
    text += shares(c);
    text += fmt::format("checks: residual {:.1e}, equilibrium {:.1e}", c.checks.residual, c.checks.equilibrium);
    text += linear ? fmt::format(", energy {:.1e}\n", c.checks.energy) : "\n";
  }
  if (linear && result.linear_laws && result.cases.size() > 1)
    text += fmt::format("\nreciprocity of the cases {:.1e}\n", result.reciprocity);
  return text;
}

}  // namespace deflect::report
