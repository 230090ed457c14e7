#include "validation/report/frame_results.h"

#include <fmt/format.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/name_index.h"
#include "validation/json/json_text.h"
#include "validation/report/large_displacements.h"

namespace deflect::report {
namespace {

using frame::CaseResult;
using frame::FrameDescription;
using frame::FrameResult;
using frame::MemberForces;
using Names = std::array<const char*, 6>;

constexpr Names displacement_names = {"ux_mm", "uy_mm", "uz_mm", "rx_rad", "ry_rad", "rz_rad"};
constexpr Names force_names = {"fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"};
constexpr Names section_names = {"N_N", "Vy_N", "Vz_N", "T_Nmm", "My_Nmm", "Mz_Nmm"};

constexpr frame::Freedoms all_held = {true, true, true, true, true, true};

/// Forces and moments in N and Nmm.
Vector6 forces_mm(const Vector6& SI) {
  Vector6 f = SI;
  f.tail<3>() *= 1e3;
  return f;
}

// JSON

void put(Json& json, const Vector6& values, const Names& names, const frame::Freedoms& held, const std::string& what) {
  for (std::size_t i = 0; i < 6; ++i)
    if (held[i]) json[names[i]] = json::json_number(values(as_index(i)), what + " " + names[i]);
}

Json json_member(const std::string& name, const MemberForces& m, const std::string& where) {
  const std::string what = where + ", member " + name;
  Json json;
  json["member"] = name;
  put(json["start"], forces_mm(m.start), section_names, all_held, what);
  put(json["end"], forces_mm(m.end), section_names, all_held, what);
  json["largest_My_Nmm"] = json::json_number(1e3 * m.My.value, what);
  json["largest_My_at_mm"] = json::json_number(1e3 * m.My.at, what);
  json["largest_Mz_Nmm"] = json::json_number(1e3 * m.Mz.value, what);
  json["largest_Mz_at_mm"] = json::json_number(1e3 * m.Mz.at, what);
  json["energy_Nmm"] = json::json_number(1e3 * m.energy, what);
  return json;
}

Json json_constraint(const std::string& name, const frame::FrameConstraint& c, double lambda, const std::string& what) {
  const bool moment = c.terms.front().freedom >= 3 && !c.terms.front().arm;
  Json json;
  json["constraint"] = name;
  json[moment ? "moment_Nmm" : "force_N"] =
      json::json_number(moment ? 1e3 * lambda : lambda, what + ", constraint " + name);
  return json;
}

double share(double part, double whole) { return whole > 0 ? part / whole : 0; }

Json json_path(const frame::PathSummary& p, const std::string& what) {
  Json json;
  json["converged"] = p.converged;
  json["stable"] = p.stable;
  json["load_factor"] = json::json_number(p.load_factor, what + ", load factor");
  json["steps"] = p.steps;
  json["iterations"] = p.iterations;
  json["message"] = p.message;
  return json;
}

Json json_equations(const frame::EquationSummary& e) {
  Json json;
  json["name"] = e.solver;
  json["why"] = e.why;
  json["freedoms"] = e.freedoms;
  if (e.error_bound) {
    json["iterations"] = e.iterations;
    json["error_bound"] = json::json_number(*e.error_bound, "error bound");
  }
  return json;
}

Json json_case(const FrameDescription& f, const CaseResult& c, bool linear) {
  const std::string what = "case " + c.name;
  const auto row = [&](const char* kind, const std::string& name, const Vector6& values, const Names& names,
                       const frame::Freedoms& held) {
    Json json;
    json[kind] = name;
    put(json, values, names, held, what + ", " + kind + " " + name);
    return json;
  };
  Json json;
  if (!linear) json["path"] = json_path(c.path, what);
  for (const char* list : {"displacements", "reactions", "springs", "constraints", "members"})
    json[list] = Json::array();
  for (std::size_t i = 0; i < f.nodes.size(); ++i)
    json["displacements"].push_back(
        row("node", f.nodes[i].first, twist_in_mm(c.displacements[i]), displacement_names, all_held));
  for (std::size_t i = 0; i < f.supports.size(); ++i)
    json["reactions"].push_back(
        row("node", f.supports[i].first, forces_mm(c.reactions[i]), force_names, f.supports[i].second.acting()));
  for (std::size_t i = 0; i < f.springs.size(); ++i)
    json["springs"].push_back(
        row("spring", f.springs[i].first, forces_mm(c.springs[i]), force_names, f.springs[i].second.acting()));
  for (std::size_t i = 0; i < f.constraints.size(); ++i)
    json["constraints"].push_back(
        json_constraint(f.constraints[i].first, f.constraints[i].second, c.constraints[i], what));
  for (std::size_t i = 0; i < f.members.size(); ++i)
    json["members"].push_back(json_member(f.members[i].first, c.members[i], what));
  json["energy_Nmm"] = json::json_number(1e3 * c.energy, what + ", energy");
  json["shares"] = Json::array();
  for (const auto& [part, energy] : c.energies) {
    Json entry;
    entry["part"] = part;
    entry["share"] = json::json_number(share(energy, c.energy), fmt::format("{}, share of {}", what, part));
    json["shares"].push_back(std::move(entry));
  }
  json["checks"]["residual"] = json::json_number(c.checks.residual, what + ", residual");
  json["checks"]["equilibrium"] = json::json_number(c.checks.equilibrium, what + ", equilibrium");
  if (linear) json["checks"]["energy"] = json::json_number(c.checks.energy, what + ", energy check");
  return json;
}

// CSV

std::string header(const std::string& first, const Names& names) {
  return first + fmt::format(",{}", fmt::join(names, ",")) + "\n";
}

std::string cell(double value, const std::string& what) {
  if (!std::isfinite(value)) throw NumericalError(fmt::format("result '{}' is {}, not a number to write", what, value));
  return fmt::format(",{}", value);
}

std::string cells(const Vector6& values, const std::string& what, const frame::Freedoms& held = all_held) {
  std::string text;
  for (std::size_t i = 0; i < 6; ++i) text += held[i] ? cell(values(as_index(i)), what) : ",";
  return text;
}

std::string members_header() {
  std::string text = "case,member";
  for (const char* end : {"start", "end"})
    for (const std::string name : section_names)
      text += fmt::format(",{}_{}{}", name.substr(0, name.find('_')), end, name.substr(name.find('_')));
  return text + ",largest_My_Nmm,largest_My_at_mm,largest_Mz_Nmm,largest_Mz_at_mm,energy_Nmm\n";
}

}  // namespace

std::string frame_json(const FrameDescription& f, const FrameResult& result) {
  Json json;
  json["kind"] = "frame";
  json["frame"] = result.name;
  json["geometry"] = nth(geometry_names, result.geometry);
  json["cases"] = Json::object();
  const bool linear = result.geometry == Geometry::linear;
  for (const CaseResult& c : result.cases) json["cases"][c.name] = json_case(f, c, linear);
  if (linear && result.linear_laws) json["reciprocity"] = json::json_number(result.reciprocity, "reciprocity");
  if (linear) json["solver"] = json_equations(result.equations);
  json["notes"] = notes_of(f, result);
  return json::json_text(json);
}

std::vector<std::string> notes_of(const FrameDescription& f, const FrameResult& result) {
  std::vector<std::string> notes = result.notes;
  Displacements d;
  for (const auto& [name, p] : f.nodes) d.points.push_back(p);
  const frame::NameIndex nodes(f.nodes);
  for (const auto& [name, m] : f.members) d.lines.emplace_back(as_size(nodes.find(m.from)), as_size(nodes.find(m.to)));
  for (const CaseResult& c : result.cases) {
    d.moved.clear();
    d.turned.clear();
    for (const Vector6& u : c.displacements) {
      d.moved.push_back(u.head<3>());
      d.turned.push_back(u.tail<3>());
    }
    if (const auto note = large_displacement_note(d, result.geometry, "write 'geometry: finite' in the file"))
      notes.push_back(fmt::format("load case '{}': {}", c.name, *note));
  }
  return notes;
}

FrameTables frame_tables(const FrameDescription& f, const FrameResult& result) {
  FrameTables t{header("case,node", displacement_names), header("case,kind,name", force_names), members_header(),
                "case,part,energy_Nmm,share\n"};
  for (const CaseResult& c : result.cases) {
    for (std::size_t i = 0; i < f.nodes.size(); ++i) {
      const std::string name = fmt::format("{},{}", c.name, f.nodes[i].first);
      t.displacements += name + cells(twist_in_mm(c.displacements[i]), name) + "\n";
    }
    for (std::size_t i = 0; i < f.supports.size(); ++i) {
      const std::string name = fmt::format("{},support,{}", c.name, f.supports[i].first);
      t.reactions += name + cells(forces_mm(c.reactions[i]), name, f.supports[i].second.acting()) + "\n";
    }
    for (std::size_t i = 0; i < f.springs.size(); ++i) {
      const std::string name = fmt::format("{},spring,{}", c.name, f.springs[i].first);
      t.reactions += name + cells(forces_mm(c.springs[i]), name, f.springs[i].second.acting()) + "\n";
    }
    for (std::size_t i = 0; i < f.members.size(); ++i) {
      const std::string name = fmt::format("{},{}", c.name, f.members[i].first);
      const MemberForces& m = c.members[i];
      t.members += name + cells(forces_mm(m.start), name) + cells(forces_mm(m.end), name);
      for (const double value : {m.My.value, m.My.at, m.Mz.value, m.Mz.at, m.energy})
        t.members += cell(1e3 * value, name);
      t.members += "\n";
    }
    for (const auto& [part, energy] : c.energies) {
      const std::string name = fmt::format("{},{}", c.name, part);
      t.shares += name + cell(1e3 * energy, name) + cell(share(energy, c.energy), name) + "\n";
    }
  }
  return t;
}

}  // namespace deflect::report
