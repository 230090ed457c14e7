#include "validation/report/solve_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validation/report/json_text.h"
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

/// √(K_ii K_jj): the measure of an entry that does not depend on units of length.
double scale(const Matrix6& K, int i, int j) { return std::sqrt(std::abs(K(i, i) * K(j, j))); }

/// Entries that are only rounding are shown as 0, so that the pattern can be seen.
std::string stiffness_table(const Matrix6& K) {
  std::vector<std::vector<std::string>> rows = {{""}};
  rows.front().insert(rows.front().end(), std::begin(displacement_names), std::end(displacement_names));
  for (int i = 0; i < 6; ++i) {
    rows.push_back({std::string("  ") + wrench_names[i]});
    for (int j = 0; j < 6; ++j)
      rows.back().push_back(std::abs(K(i, j)) < 1e-12 * scale(K, i, j) ? "0" : fmt::format("{:.6g}", K(i, j)));
  }
  return aligned(rows);
}

std::string stiffness_difference(const Matrix6& analytic, const Matrix6& msa) {
  double largest = -1;
  int row = 0, column = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double difference = std::abs(analytic(i, j) - msa(i, j));
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

std::string shares_table(const SolveResult& result) {
  auto shares = result.shares;
  std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::vector<std::string>> rows;
  for (const auto& [part, share] : shares) rows.push_back({"  " + part, fmt::format("{:.2f} %", 100 * share)});
  return "share of each part in the elastic energy\n" + aligned(rows);
}

}  // namespace

std::string solve_json(const SolveResult& result) {
  Json json;
  json["pose"] = json_numbers(result.pose_mm_deg, "pose");
  json["load"] = json_numbers(result.load_N_Nmm, "load");
  json["analytic"] = json_theory(result.analytic, "analytic");
  json["msa"] = json_theory(result.msa, "msa");
  json["relative_difference"] = json_number(result.relative_difference, "relative_difference");
  json["checks"]["symmetric"] = result.symmetric;
  json["checks"]["positive"] = result.positive;
  json["checks"]["passive_joints_free"] = result.passive_joints_free;
  json["shares"] = Json::array();
  for (const auto& [part, share] : result.shares) {
    Json entry;
    entry["part"] = part;
    entry["share"] = json_number(share, "share of " + part);
    json["shares"].push_back(std::move(entry));
  }
  if (!result.notes.empty()) json["notes"] = result.notes;
  return json_text(json);
}

std::string solve_report(const SolveResult& result) {
  const Vector6 &p = result.pose_mm_deg, &F = result.load_N_Nmm;
  const auto check = [](bool held) { return held ? "yes" : "NO"; };
  std::string text = fmt::format("pose   x {:.9g}, y {:.9g}, z {:.9g} mm; roll {:.9g}, pitch {:.9g}, yaw {:.9g} deg\n",
                                 p[0], p[1], p[2], p[3], p[4], p[5]);
  text += fmt::format("load   fx {}, fy {}, fz {} N; mx {}, my {}, mz {} Nmm\n\n", F[0], F[1], F[2], F[3], F[4], F[5]);
  text += displacement_table(result);
  text += fmt::format("relative difference {:.1e}\n\n", result.relative_difference);
  text += "stiffness by MSA, base axes (N/mm, N, Nmm)\n" + stiffness_table(result.msa.stiffness_mm);
  text += stiffness_difference(result.analytic.stiffness_mm, result.msa.stiffness_mm) + "\n";
  if (!result.shares.empty()) text += shares_table(result) + "\n";
  text += "checks\n" + aligned({{"  stiffness symmetric", check(result.symmetric)},
                                {"  stiffness positive", check(result.positive)},
                                {"  passive joints free", check(result.passive_joints_free)}});
  for (const std::string& note : result.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace deflect
