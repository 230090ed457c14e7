#include "validation/report/solve_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/json/json_text.h"
#include "validation/report/large_displacements.h"
#include "validation/report/text.h"
#include "validation/report/theory_words.h"

namespace deflect::report {
namespace {

constexpr const char* tool_displacements[] = {"ux", "uy", "uz", "thx", "thy", "thz"};
constexpr const char* tool_wrench[] = {"fx", "fy", "fz", "mx", "my", "mz"};

Json json_theory(const studies::TheorySolution& solution, const std::string& name, Geometry geometry) {
  Json json;
  json["displacement"] = json::json_numbers(solution.displacement_mm_rad, name + ".displacement");
  json["stiffness"] = json::json_rows(solution.stiffness_mm, name + ".stiffness");
  if (geometry != Geometry::linear)
    json["from_linear"] = json::json_number(solution.from_linear, name + ".from_linear");
  return json;
}

/// null where play ends nowhere, as with a friction that slides for ever.
Json json_limits(const Vector6& values) {
  Json json = Json::array();
  for (const double v : values) json.push_back(std::isfinite(v) ? Json(v) : Json());
  return json;
}

/// √(K_ii K_jj): the measure of an entry that does not depend on units of length.
double scale(const Matrix6& K, int i, int j) { return std::sqrt(std::abs(K(i, i) * K(j, j))); }

/// Entries that are only rounding are shown as 0, so that the pattern can be seen.
std::string stiffness_table(const Matrix6& K) {
  std::vector<std::vector<std::string>> rows = {{""}};
  rows.front().insert(rows.front().end(), std::begin(tool_displacements), std::end(tool_displacements));
  for (int i = 0; i < 6; ++i) {
    rows.push_back({std::string("  ") + tool_wrench[i]});
    for (int j = 0; j < 6; ++j)
      rows.back().push_back(std::abs(K(i, j)) < 1e-10 * scale(K, i, j) ? "0" : fmt::format("{:.6g}", K(i, j)));
  }
  return aligned(rows);
}

/// How far one theory's stiffness is from the one that is shown.
std::string stiffness_difference(const theories::Theory& theory, const Matrix6& K, const Matrix6& shown) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1e-3);  // rotations at 1 m
  const double rounding = 1e-15 * (weight.asDiagonal() * shown * weight.asDiagonal()).cwiseAbs().maxCoeff();
  double largest = -1;
  int row = 0, column = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double difference = std::abs(K(i, j) - shown(i, j));
      if (weight(i) * weight(j) * difference <= rounding) difference = 0;
      const double relative = difference == 0 ? 0 : difference / scale(shown, i, j);
      if (relative <= largest) continue;
      largest = relative, row = i, column = j;
      if (std::isnan(relative))
        return fmt::format("the {} stiffness cannot be compared: it is not a number throughout\n", theory.title);
    }
  if (largest == 0) return fmt::format("the {} stiffness is the same\n", theory.title);
  return fmt::format("the {} stiffness differs by at most {:.1e} of √(K_ii K_jj), at {} {}\n", theory.title, largest,
                     tool_wrench[row], tool_displacements[column]);
}

std::string displacement_table(const studies::SolveResult& result) {
  std::vector<std::vector<std::string>> rows = {{"displacement"}};
  for (const theories::Theory* theory : result.theories) rows.front().push_back(theory->title);
  rows.front().push_back("");
  for (int i = 0; i < 6; ++i) {
    const auto number = [i](double value) {
      const std::string text = fmt::format("{:.{}f}", value, i < 3 ? 6 : 9);
      return text.find_first_not_of("-0.") == std::string::npos ? text.substr(text.front() == '-') : text;  // no -0
    };
    rows.push_back({std::string("  ") + tool_displacements[i]});
    for (const studies::TheorySolution& s : result.solutions) rows.back().push_back(number(s.displacement_mm_rad[i]));
    rows.back().push_back(i < 3 ? " mm" : "rad");
  }
  return aligned(rows);
}

const char* geometry_name(const studies::SolveResult& result) { return nth(geometry_names, result.geometry); }

std::string geometry_line(const studies::SolveResult& result) {
  std::vector<std::string> shares;
  for (std::size_t t = 0; t < result.theories.size(); ++t)
    shares.push_back(fmt::format("{:.3g} % ({})", 100 * result.solutions[t].from_linear, result.theories[t]->title));
  return fmt::format("equilibrium in the deformed shape ({}); from the linear one the displacement differs by {}\n",
                     geometry_name(result), fmt::join(shares, ", "));
}

std::string shares_table(const studies::SolveResult& result) {
  auto shares = result.shares;
  std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::vector<std::string>> rows;
  for (const auto& [part, share] : shares) rows.push_back({"  " + part, fmt::format("{:.2f} %", 100 * share)});
  return "share of each part in the elastic energy\n" + aligned(rows);
}

std::string joints_line(const studies::SolveResult& result) {
  std::string line = "joints ";
  for (const studies::JointValue& joint : result.joints)
    line += fmt::format("{}{} {:.6g} {}", &joint == result.joints.data() ? "" : ", ", joint.name, joint.value,
                        joint.rotation ? "rad" : "mm");
  return line + "\n";
}

std::string assembly_table(const studies::Assembly& assembly, const theories::Theories& theories) {
  std::vector<std::vector<std::string>> rows = {{"assembled, without load"}};
  rows.front().insert(rows.front().end(), std::begin(tool_wrench), std::end(tool_wrench));
  double largest = 0;
  for (const auto& [leg, wrench] : assembly.leg_wrenches_N_Nmm)
    largest = std::max(largest, wrench.cwiseAbs().maxCoeff());
  for (const auto& [leg, wrench] : assembly.leg_wrenches_N_Nmm) {
    rows.push_back({"  on " + leg + " at T (N, Nmm)"});
    for (const double value : wrench)
      rows.back().push_back(std::abs(value) < 1e-9 * largest ? "0" : fmt::format("{:.4g}", value));
  }
  const auto offset = [](const Vector6& d) {
    return fmt::format("({:.6f}, {:.6f}, {:.6f}) mm, ({:.3g}, {:.3g}, {:.3g}) rad", d(0), d(1), d(2), d(3), d(4), d(5));
  };
  std::string text = aligned(rows);
  constexpr const char* what = "tool point beside its place: ";
  const std::size_t indent = std::string(what).size() + theories.front()->title.size();
  for (std::size_t t = 0; t < theories.size(); ++t)
    text += (t == 0 ? what + theories[t]->title : fmt::format("{:>{}}", theories[t]->title, indent)) + " " +
            offset(assembly.offsets_mm_rad[t]) + "\n";
  return text;
}

/// "floats within its play by ux ±0.02 mm, …", the axes along which it does.
std::string floating_note(const studies::FloatingPlay& play) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1e3);  // rad at 1 m
  const double size = weight.cwiseProduct(play.most_mm_rad - play.least_mm_rad).maxCoeff();
  std::vector<std::string> ways;
  for (int i = 0; i < 6; ++i) {
    const double least = play.least_mm_rad(i), most = play.most_mm_rad(i);
    if (!(weight(i) * (most - least) > 1e-9 * std::min(size, 1e3))) continue;
    const char* unit = i < 3 ? "mm" : "rad";
    const bool even = std::isfinite(most) && std::abs(most + least) <= 1e-6 * (most - least);
    ways.push_back(even ? fmt::format("{} ±{:.4g} {}", tool_displacements[i], most, unit)
                        : fmt::format("{} {:.4g} to {:+.4g} {}", tool_displacements[i], least, most, unit));
  }
  const std::string parts = fmt::format("play of {} that nothing loads", fmt::join(play.parts, ", "));
  if (ways.empty())
    return fmt::format("parts between base and platform float within {}; the tool point does not", parts);
  return fmt::format("floats within its play by {}, without force: {}; the displacement is the middle of it",
                     fmt::join(ways, ", "), parts);
}

/// The result's own, and whether its geometry will do.
std::vector<std::string> solve_notes(const studies::SolveResult& result) {
  std::vector<std::string> notes = result.notes;
  if (!result.rigid_motions.empty())
    notes.insert(notes.begin(), fmt::format("held rigidly: nothing yields in {}: the stiffness is infinite there, and "
                                            "shown is that of the other motions",
                                            fmt::join(result.rigid_motions, "; in ")));
  if (result.floating) notes.insert(notes.begin(), floating_note(*result.floating));
  Displacements d;
  d.points = result.mesh.points;
  for (const LineCell& cell : result.mesh.cells) d.lines.emplace_back(as_size(cell.a), as_size(cell.b));
  for (const PointField& field : result.fields.points) {
    if (field.name == "rotation_rad") d.turned = field.values;
    if (field.name != "displacement_mm") continue;
    for (const Vector3& u : field.values) d.moved.push_back(u / 1e3);
  }
  if (d.moved.size() != d.points.size()) return notes;  // a result without its structure
  if (const auto note = large_displacement_note(d, result.geometry, "solve with --geometry finite"))
    notes.push_back(*note);
  return notes;
}

}  // namespace

std::string solve_json(const studies::SolveResult& result) {
  Json json;
  json["kind"] = "solve";
  json["pose"] = json::json_numbers(result.pose_mm_deg, "pose");
  json["load"] = json::json_numbers(result.load_N_Nmm, "load");
  json["theories"] = json_theories(result.theories);
  json["reference"] = result.theories[theories::reference_of(result.theories)]->name;
  for (std::size_t t = 0; t < result.theories.size(); ++t)
    json[result.theories[t]->name] = json_theory(result.solutions[t], result.theories[t]->name, result.geometry);
  if (result.theories.size() > 1)
    json["relative_difference"] = json::json_number(result.relative_difference, "relative_difference");
  json["checks"]["symmetric"] = result.symmetric;
  json["checks"]["positive"] = result.positive;
  if (result.geometry == Geometry::linear) {
    json["checks"]["passive_joints_free"] = result.passive_joints_free;
  } else {
    json["geometry"] = geometry_name(result);
  }
  json["shares"] = Json::array();
  for (const auto& [part, share] : result.shares) {
    Json entry;
    entry["part"] = part;
    entry["share"] = json::json_number(share, "share of " + part);
    json["shares"].push_back(std::move(entry));
  }
  json["joints"] = Json::array();
  for (const studies::JointValue& joint : result.joints)
    json["joints"].push_back({{"name", joint.name}, {joint.rotation ? "value_rad" : "value_mm", joint.value}});
  json["redundant_constraints"] = result.redundant_constraints;
  if (result.assembly) {
    Json& assembly = json["assembly"];
    for (std::size_t t = 0; t < result.theories.size(); ++t) {
      const std::string name = result.theories[t]->name + "_offset";
      assembly[name] = json::json_numbers(result.assembly->offsets_mm_rad[t], "assembly." + name);
    }
    for (const auto& [leg, wrench] : result.assembly->leg_wrenches_N_Nmm)
      assembly["leg_wrenches_N_Nmm"][leg] = json::json_numbers(wrench, "assembly wrench of " + leg);
  }
  if (!result.rigid_motions.empty()) json["rigid"] = result.rigid_motions;
  if (result.floating)
    json["floating"] = {{"parts", result.floating->parts},
                        {"least", json_limits(result.floating->least_mm_rad)},
                        {"most", json_limits(result.floating->most_mm_rad)}};
  if (const auto notes = solve_notes(result); !notes.empty()) json["notes"] = notes;
  return json::json_text(json);
}

std::string solve_report(const studies::SolveResult& result) {
  const Vector6 &p = result.pose_mm_deg, &F = result.load_N_Nmm;
  const auto check = [](bool held) { return held ? "yes" : "NO"; };
  std::string text = fmt::format("pose   x {:.9g}, y {:.9g}, z {:.9g} mm; roll {:.9g}, pitch {:.9g}, yaw {:.9g} deg\n",
                                 p[0], p[1], p[2], p[3], p[4], p[5]);
  text += fmt::format("load   fx {}, fy {}, fz {} N; mx {}, my {}, mz {} Nmm\n\n", F[0], F[1], F[2], F[3], F[4], F[5]);
  if (!result.joints.empty()) text.insert(text.size() - 1, joints_line(result));
  text += displacement_table(result);
  if (result.theories.size() > 1) text += fmt::format("relative difference {:.1e}\n", result.relative_difference);
  if (result.geometry != Geometry::linear) text += geometry_line(result);
  text += "\n";
  const std::size_t shown = theories::reference_of(result.theories);
  const Matrix6& K = result.solutions[shown].stiffness_mm;
  text += fmt::format("stiffness by {}, base axes (N/mm, N, Nmm)\n", result.theories[shown]->title);
  text += stiffness_table(K);
  for (std::size_t t = 0; t < result.theories.size(); ++t)
    if (t != shown) text += stiffness_difference(*result.theories[t], result.solutions[t].stiffness_mm, K);
  text += "\n";
  if (!result.shares.empty()) text += shares_table(result) + "\n";
  if (result.assembly) text += assembly_table(*result.assembly, result.theories) + "\n";
  std::vector<std::vector<std::string>> checks = {{"  stiffness symmetric", check(result.symmetric)},
                                                  {"  stiffness positive", check(result.positive)}};
  if (result.geometry == Geometry::linear)
    checks.push_back({"  passive joints free", check(result.passive_joints_free)});
  text += "checks\n" + aligned(checks);
  if (result.redundant_constraints > 0)
    text +=
        fmt::format("note: over-constrained: {} more constraint{} than hold it; parts yield, so that it is solved\n",
                    result.redundant_constraints, result.redundant_constraints == 1 ? "" : "s");
  for (const std::string& note : solve_notes(result)) text += "note: " + note + "\n";
  return text;
}

}  // namespace deflect::report
