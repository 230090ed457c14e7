#include "validation/report/solve_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validation/report/json_text.h"
#include "validation/report/large_displacements.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

constexpr const char* displacement_names[] = {"ux", "uy", "uz", "thx", "thy", "thz"};
constexpr const char* wrench_names[] = {"fx", "fy", "fz", "mx", "my", "mz"};

Json json_theory(const TheorySolution& theory, const std::string& name) {
  Json json;
  json["displacement"] = json_numbers(theory.displacement_mm_rad, name + ".displacement");
  json["stiffness"] = json_rows(theory.stiffness_mm, name + ".stiffness");
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
  rows.front().insert(rows.front().end(), std::begin(displacement_names), std::end(displacement_names));
  for (int i = 0; i < 6; ++i) {
    rows.push_back({std::string("  ") + wrench_names[i]});
    for (int j = 0; j < 6; ++j)
      rows.back().push_back(std::abs(K(i, j)) < 1e-10 * scale(K, i, j) ? "0" : fmt::format("{:.6g}", K(i, j)));
  }
  return aligned(rows);
}

std::string stiffness_difference(const Matrix6& analytic, const Matrix6& msa) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1e-3);  // rotations at 1 m
  const double rounding = 1e-15 * (weight.asDiagonal() * msa * weight.asDiagonal()).cwiseAbs().maxCoeff();
  double largest = -1;
  int row = 0, column = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double difference = std::abs(analytic(i, j) - msa(i, j));
      if (weight(i) * weight(j) * difference <= rounding) difference = 0;
      const double relative = difference == 0 ? 0 : difference / scale(msa, i, j);
      if (relative <= largest) continue;
      largest = relative, row = i, column = j;
      if (std::isnan(relative)) return "the analytic stiffness cannot be compared: it is not a number throughout\n";
    }
  if (largest == 0) return "the analytic stiffness is the same\n";
  return fmt::format("the analytic stiffness differs by at most {:.1e} of √(K_ii K_jj), at {} {}\n", largest,
                     wrench_names[row], displacement_names[column]);
}

std::string displacement_table(const SolveResult& result) {
  std::vector<std::vector<std::string>> rows = {{"displacement", "analytic", "MSA", ""}};
  for (int i = 0; i < 6; ++i) {
    const auto number = [i](double value) {
      const std::string text = fmt::format("{:.{}f}", value, i < 3 ? 6 : 9);
      return text.find_first_not_of("-0.") == std::string::npos ? text.substr(text.front() == '-') : text;  // no -0
    };
    rows.push_back({std::string("  ") + displacement_names[i], number(result.analytic.displacement_mm_rad[i]),
                    number(result.msa.displacement_mm_rad[i]), i < 3 ? " mm" : "rad"});
  }
  return aligned(rows);
}

const char* geometry_name(const SolveResult& result) { return geometry_names[static_cast<int>(result.geometry)]; }

std::string geometry_line(const SolveResult& result) {
  return fmt::format(
      "equilibrium in the deformed shape ({}); from the linear one the displacement differs by {:.3g} % (analytic), "
      "{:.3g} % (MSA)\n",
      geometry_name(result), 100 * result.analytic_from_linear, 100 * result.msa_from_linear);
}

std::string shares_table(const SolveResult& result) {
  auto shares = result.shares;
  std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::vector<std::string>> rows;
  for (const auto& [part, share] : shares) rows.push_back({"  " + part, fmt::format("{:.2f} %", 100 * share)});
  return "share of each part in the elastic energy\n" + aligned(rows);
}

std::string joints_line(const SolveResult& result) {
  std::string line = "joints ";
  for (const JointValue& joint : result.joints)
    line += fmt::format("{}{} {:.6g} {}", &joint == result.joints.data() ? "" : ", ", joint.name, joint.value,
                        joint.rotation ? "rad" : "mm");
  return line + "\n";
}

std::string assembly_table(const Assembly& assembly) {
  std::vector<std::vector<std::string>> rows = {{"assembled, without load"}};
  rows.front().insert(rows.front().end(), std::begin(wrench_names), std::end(wrench_names));
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
  return aligned(rows) + "tool point beside its place: analytic " + offset(assembly.analytic_mm_rad) + "\n" +
         "                                  MSA " + offset(assembly.msa_mm_rad) + "\n";
}

/// "floats within its play by ux ±0.02 mm, …", the axes along which it does.
std::string floating_note(const FloatingPlay& play) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1e3);  // rad at 1 m
  const double size = weight.cwiseProduct(play.most_mm_rad - play.least_mm_rad).maxCoeff();
  std::vector<std::string> ways;
  for (int i = 0; i < 6; ++i) {
    const double least = play.least_mm_rad(i), most = play.most_mm_rad(i);
    if (!(weight(i) * (most - least) > 1e-9 * std::min(size, 1e3))) continue;
    const char* unit = i < 3 ? "mm" : "rad";
    const bool even = std::isfinite(most) && std::abs(most + least) <= 1e-6 * (most - least);
    ways.push_back(even ? fmt::format("{} ±{:.4g} {}", displacement_names[i], most, unit)
                        : fmt::format("{} {:.4g} to {:+.4g} {}", displacement_names[i], least, most, unit));
  }
  const std::string parts = fmt::format("play of {} that nothing loads", fmt::join(play.parts, ", "));
  if (ways.empty())
    return fmt::format("parts between base and platform float within {}; the tool point does not", parts);
  return fmt::format("floats within its play by {}, without force: {}; the displacement is the middle of it",
                     fmt::join(ways, ", "), parts);
}

/// The result's own, and whether its geometry will do.
std::vector<std::string> notes_of(const SolveResult& result) {
  std::vector<std::string> notes = result.notes;
  if (!result.rigid_motions.empty())
    notes.insert(notes.begin(), fmt::format("held rigidly: nothing yields in {}: the stiffness is infinite there, and "
                                            "shown is that of the other motions",
                                            fmt::join(result.rigid_motions, "; in ")));
  if (result.floating) notes.insert(notes.begin(), floating_note(*result.floating));
  Displacements d;
  d.points = result.mesh.points;
  for (const LineCell& cell : result.mesh.cells)
    d.lines.emplace_back(static_cast<std::size_t>(cell.a), static_cast<std::size_t>(cell.b));
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

std::string solve_json(const SolveResult& result) {
  Json json;
  json["kind"] = "solve";
  json["pose"] = json_numbers(result.pose_mm_deg, "pose");
  json["load"] = json_numbers(result.load_N_Nmm, "load");
  json["analytic"] = json_theory(result.analytic, "analytic");
  json["msa"] = json_theory(result.msa, "msa");
  json["relative_difference"] = json_number(result.relative_difference, "relative_difference");
  json["checks"]["symmetric"] = result.symmetric;
  json["checks"]["positive"] = result.positive;
  if (result.geometry == Geometry::linear) {
    json["checks"]["passive_joints_free"] = result.passive_joints_free;
  } else {
    json["geometry"] = geometry_name(result);
    json["analytic"]["from_linear"] = json_number(result.analytic_from_linear, "analytic.from_linear");
    json["msa"]["from_linear"] = json_number(result.msa_from_linear, "msa.from_linear");
  }
  json["shares"] = Json::array();
  for (const auto& [part, share] : result.shares) {
    Json entry;
    entry["part"] = part;
    entry["share"] = json_number(share, "share of " + part);
    json["shares"].push_back(std::move(entry));
  }
  json["joints"] = Json::array();
  for (const JointValue& joint : result.joints)
    json["joints"].push_back({{"name", joint.name}, {joint.rotation ? "value_rad" : "value_mm", joint.value}});
  json["redundant_constraints"] = result.redundant_constraints;
  if (result.assembly) {
    Json& assembly = json["assembly"];
    assembly["analytic_offset"] = json_numbers(result.assembly->analytic_mm_rad, "assembly.analytic_offset");
    assembly["msa_offset"] = json_numbers(result.assembly->msa_mm_rad, "assembly.msa_offset");
    for (const auto& [leg, wrench] : result.assembly->leg_wrenches_N_Nmm)
      assembly["leg_wrenches_N_Nmm"][leg] = json_numbers(wrench, "assembly wrench of " + leg);
  }
  if (!result.rigid_motions.empty()) json["rigid"] = result.rigid_motions;
  if (result.floating)
    json["floating"] = {{"parts", result.floating->parts},
                        {"least", json_limits(result.floating->least_mm_rad)},
                        {"most", json_limits(result.floating->most_mm_rad)}};
  if (const auto notes = notes_of(result); !notes.empty()) json["notes"] = notes;
  return json_text(json);
}

std::string solve_report(const SolveResult& result) {
  const Vector6 &p = result.pose_mm_deg, &F = result.load_N_Nmm;
  const auto check = [](bool held) { return held ? "yes" : "NO"; };
  std::string text = fmt::format("pose   x {:.9g}, y {:.9g}, z {:.9g} mm; roll {:.9g}, pitch {:.9g}, yaw {:.9g} deg\n",
                                 p[0], p[1], p[2], p[3], p[4], p[5]);
  text += fmt::format("load   fx {}, fy {}, fz {} N; mx {}, my {}, mz {} Nmm\n\n", F[0], F[1], F[2], F[3], F[4], F[5]);
  if (!result.joints.empty()) text.insert(text.size() - 1, joints_line(result));
  text += displacement_table(result);
  text += fmt::format("relative difference {:.1e}\n", result.relative_difference);
  if (result.geometry != Geometry::linear) text += geometry_line(result);
  text += "\n";
  text += "stiffness by MSA, base axes (N/mm, N, Nmm)\n" + stiffness_table(result.msa.stiffness_mm);
  text += stiffness_difference(result.analytic.stiffness_mm, result.msa.stiffness_mm) + "\n";
  if (!result.shares.empty()) text += shares_table(result) + "\n";
  if (result.assembly) text += assembly_table(*result.assembly) + "\n";
  std::vector<std::vector<std::string>> checks = {{"  stiffness symmetric", check(result.symmetric)},
                                                  {"  stiffness positive", check(result.positive)}};
  if (result.geometry == Geometry::linear)
    checks.push_back({"  passive joints free", check(result.passive_joints_free)});
  text += "checks\n" + aligned(checks);
  if (result.redundant_constraints > 0)
    text +=
        fmt::format("note: over-constrained: {} more constraint{} than hold it; parts yield, so that it is solved\n",
                    result.redundant_constraints, result.redundant_constraints == 1 ? "" : "s");
  for (const std::string& note : notes_of(result)) text += "note: " + note + "\n";
  return text;
}

}  // namespace deflect
