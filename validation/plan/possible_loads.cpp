#include "validation/plan/possible_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/prediction/campaign.h"
#include "validation/subject/trials.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;

const char* sign_of(double x) { return x < 0 ? "-" : "+"; }

/// Four digits, so that a laboratory can set it.
double settable(double x) {
  if (x == 0) return 0;
  const double scale = std::pow(10, 3 - std::floor(std::log10(std::abs(x))));
  return std::round(x * scale) / scale;
}

std::vector<PossibleLoad> loads_of_machine(const subject::LargestLoads& most, bool forces_only, bool together) {
  std::vector<PossibleLoad> out;
  const char* names[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  for (Eigen::Index i = 0; i < (forces_only ? 3 : 6); ++i)
    for (const double sense : {1.0, -1.0}) {
      const double size = sense * (i < 3 ? most.force : most.moment);
      if (size == 0) continue;
      PossibleLoad load;
      load.at_T = settable(size) * Vector6::Unit(i);
      load.words = fmt::format("{}{}", sign_of(sense), nth(names, i));
      out.push_back(load);
    }
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0}) {
        if (!together || most.force == 0) continue;
        PossibleLoad load;
        load.at_T.head<3>() = settable(most.force / std::sqrt(3)) * Vector3(x, y, z);
        load.words = fmt::format("{}fx {}fy {}fz", sign_of(x), sign_of(y), sign_of(z));
        load.in_full = true;
        out.push_back(load);
      }
  if (!together || forces_only || most.force == 0 || most.moment == 0) return out;
  for (Eigen::Index i = 0; i < 3; ++i)  // beside the tool point
    for (const double force : {1.0, -1.0})
      for (int turn = 0; turn < 8; ++turn) {
        const double angle = turn * std::numbers::pi / 4;
        PossibleLoad load;
        load.at_T(i) = settable(force * most.force);
        load.words = fmt::format("{}{}", sign_of(force), nth(names, i));
        for (const auto& [k, share] :
             {std::pair{(i + 1) % 3, std::cos(angle)}, std::pair{(i + 2) % 3, std::sin(angle)}}) {
          if (std::abs(share) < 1e-9) continue;
          load.at_T(3 + k) = settable(share * most.moment);
          load.words += fmt::format(" {}{}", sign_of(share), nth(names, 3 + k));
        }
        load.in_full = true;
        out.push_back(load);
      }
  return out;
}

/// A load of a frame, and all loads of that many further cases at most beside it, from the case `from` on.
void add_with_further(std::vector<PossibleLoad>& out, const PossibleLoad& load, std::size_t from, std::size_t further,
                      const std::vector<double>& most, const std::vector<std::string>& names) {
  if (!load.words.empty()) out.push_back(load);
  for (std::size_t k = from; k < most.size() && further > 0; ++k)
    for (const double sense : {1.0, -1.0}) {
      PossibleLoad next = load;
      next.in_full = !load.words.empty();
      next.factors[k] = sense * most[k];
      next.words += fmt::format("{}{}load.{}", load.words.empty() ? "" : " ", sign_of(sense), names[k]);
      add_with_further(out, next, k + 1, further - 1, most, names);
    }
}

std::vector<PossibleLoad> loads_of_frame(const subject::Subject& s, const Measurements& data, std::size_t cases) {
  const std::vector<double> most = subject::largest_factors(s, data);
  PossibleLoad none;
  none.factors.assign(most.size(), 0);
  std::vector<PossibleLoad> out;
  add_with_further(out, none, 0, cases, most, s.instruments().load_cases);
  return out;
}

/// How many load cases stand together: all of a few, which are 3^n loads, else two.
std::size_t cases_together(const subject::Subject& s, const Limits& limits) {
  constexpr std::size_t few = 5;
  const std::size_t all = s.instruments().load_cases.size(), at_most = all <= few ? all : 2;
  return limits.cases == 0 ? at_most : std::min(at_most, limits.cases);
}

void add_loads_at_nodes(std::vector<PossibleLoad>& out, const subject::Subject& s, const Measurements& data,
                        const Limits& limits) {
  const subject::ForcesAtNodes forces = subject::forces_at_nodes(s, data, limits.nodes);
  const double most = settable(limits.force.value_or(forces.most));
  if (!limits.nodes.empty() && !limits.force && most == 0)
    throw InputError(fmt::format(
        "{}: no load case and no row has a force at a node: say with --max-force how large one may be", s.name()));
  const char* names[] = {"fx", "fy", "fz"};
  for (const std::string& point : forces.points)
    for (const Eigen::Index i : forces.axes)
      for (const double sense : {1.0, -1.0}) {
        if (most == 0) continue;
        PossibleLoad load;
        load.factors.assign(s.instruments().load_cases.size(), 0);
        load.point = point;
        load.at_point = sense * most * Vector6::Unit(i);
        load.words = fmt::format("{}{}.{}", sign_of(sense), point, nth(names, i));
        out.push_back(load);
      }
}

}  // namespace

std::vector<PossibleLoad> possible_loads(const subject::Subject& s, const Measurements& data, const Limits& limits,
                                         bool together) {
  if (!s.frame() && !limits.nodes.empty())
    throw InputError(fmt::format(
        "{} is a machine: it is loaded at its tool point and has no nodes to load: leave them out", s.name()));
  std::vector<PossibleLoad> out;
  if (s.frame()) {
    out = loads_of_frame(s, data, together ? cases_together(s, limits) : 1);
    add_loads_at_nodes(out, s, data, limits);
  } else {
    subject::LargestLoads most = subject::largest_loads(s, data);
    if (limits.force) most.force = *limits.force;
    if (limits.moment)
      most.moment = *limits.moment;
    else if (most.moment == 0)
      most.moment = prediction::lever * most.force;
    out = loads_of_machine(most, limits.forces_only, together);
  }
  if (out.empty())
    throw InputError(fmt::format("{}: no load is allowed: give {} above zero", s.name(),
                                 s.frame() ? "--nodes and --max-force" : "--max-force or --max-moment"));
  return out;
}

}  // namespace deflect::plan
