#include "validation/figures/drawing_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "msa/base/index.h"
#include "msa/mechanism/joint_table.h"
#include "validation/json/json_text.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

constexpr std::size_t most_rows = 80;

double tidy(double x) { return std::abs(x) < 1e-9 ? 0 : x; }

std::string in_mm(const Vector3& p) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", tidy(report::mm * p.x()), tidy(report::mm * p.y()),
                     tidy(report::mm * p.z()));
}
std::string direction(const Vector3& v) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", tidy(v.x()), tidy(v.y()), tidy(v.z()));
}

Json list_in_mm(const Vector3& p) {
  return {tidy(report::mm * p.x()), tidy(report::mm * p.y()), tidy(report::mm * p.z())};
}
Json axes_json(const Matrix3& R) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < 3; ++i) out.push_back({tidy(R(0, i)), tidy(R(1, i)), tidy(R(2, i))});
  return out;
}

std::vector<std::string> freedoms_with(const DrawnJoint& joint, char letter) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < 6; ++i)
    if (joint.letters[i] == letter) out.emplace_back(freedom_names[i]);
  return out;
}

std::vector<std::string> elastic_freedoms(const DrawnJoint& joint) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < 6; ++i)
    if (joint.elastic[i]) out.emplace_back(freedom_names[i]);
  return out;
}

/// "drives rz; laws rz rx"
std::string words(const DrawnJoint& joint) {
  std::string text;
  const auto add = [&](const char* what, const std::vector<std::string>& freedoms) {
    if (!freedoms.empty()) text += fmt::format("{}{} {}", text.empty() ? "" : "; ", what, fmt::join(freedoms, " "));
  };
  add("drives", freedoms_with(joint, 'a'));
  add("free in", freedoms_with(joint, 'f'));
  add("laws on", elastic_freedoms(joint));
  return text.empty() ? "rigid" : text;
}

std::string whole_name(const std::string& leg, const std::string& part) {
  return leg.empty() ? part : leg + " " + part;
}

std::string coordinate(const Actuator& a) {
  return a.rotation ? fmt::format("{} {:.5g} deg", a.name, tidy(a.value * 180 / pi))
                    : fmt::format("{} {:.5g} mm", a.name, tidy(report::mm * a.value));
}

std::vector<std::vector<std::string>> member_rows(const MachineDrawing& d) {
  std::vector<std::vector<std::string>> rows = {
      {"member", "section, material", "from mm", "to mm", "length mm", "local y", "local z"}};
  for (const DrawnMember& m : d.members)
    rows.push_back({whole_name(m.leg, m.part), m.section + ", " + m.material, in_mm(m.start), in_mm(m.end),
                    fmt::format("{:.6g}", report::mm * (m.end - m.start).norm()), direction(m.axes.col(1)),
                    direction(m.axes.col(2))});
  return rows;
}

std::vector<std::vector<std::string>> joint_rows(const MachineDrawing& d) {
  std::vector<std::vector<std::string>> rows = {{"joint", "what it does", "at mm", "its x", "its z"}};
  for (const DrawnJoint& j : d.joints)
    rows.push_back(
        {whole_name(j.leg, j.part), words(j), in_mm(j.at), direction(j.axes.col(0)), direction(j.axes.col(2))});
  return rows;
}

std::vector<std::vector<std::string>> instrument_rows(const MachineDrawing& d) {
  std::vector<std::vector<std::string>> rows = {{"instrument", "what it is", "at mm", "reads along"}};
  for (const DrawnInstrument& i : d.instruments)
    rows.push_back({i.name, i.words, in_mm(i.at), i.axis ? direction(*i.axis) : ""});
  return rows;
}

std::vector<std::vector<std::string>> node_rows(const MachineDrawing& d) {
  std::vector<std::vector<std::string>> rows = {{"node", "at mm", "held"}};
  for (const DrawnPoint& p : d.frames) rows.push_back({p.name, in_mm(p.at), p.held});
  return rows;
}

std::vector<std::vector<std::string>> entry_rows(const MachineDrawing& d, DrawnEntry::Kind kind) {
  std::vector<std::vector<std::string>> rows = {{nth(entry_kinds, kind), ""}};
  for (const DrawnEntry& e : d.entries)
    if (e.kind == kind) rows.push_back({e.name, e.words});
  return rows;
}

std::string table(std::vector<std::vector<std::string>> rows) {
  if (rows.size() < 2) return "";
  const std::size_t all = rows.size() - 1;
  rows.resize(std::min(rows.size(), most_rows + 1));
  std::string text = "\n" + report::aligned(rows);
  if (all > most_rows) text += fmt::format("… and {} more, all of them in --json\n", all - most_rows);
  return text;
}

}  // namespace

std::string drawing_report(const MachineDrawing& d) {
  std::string text = fmt::format("{}{}{}\n", d.name, d.about.empty() ? "" : ": ", d.about);
  if (!d.frame && d.motions.empty() && d.trouble.empty())
    text += fmt::format("tool at ({:.6g}) mm, roll pitch yaw ({:.6g}) deg, unloaded\n",
                        fmt::join(Vector3(d.pose_mm_deg.head<3>()).unaryExpr(&tidy), ", "),
                        fmt::join(Vector3(d.pose_mm_deg.tail<3>()).unaryExpr(&tidy), ", "));
  std::vector<std::string> driven;
  for (const Actuator& a : d.driven) driven.push_back(coordinate(a));
  if (!d.frame) text += driven.empty() ? "nothing is driven\n" : fmt::format("driven: {}\n", fmt::join(driven, ", "));
  text += table(member_rows(d)) + table(joint_rows(d)) + table(instrument_rows(d));
  if (d.frame) text += table(node_rows(d));
  for (const DrawnEntry::Kind kind : DrawnEntry::kinds) text += table(entry_rows(d, kind));
  if (!d.trouble.empty()) text += fmt::format("\n{}\n", d.trouble);
  for (const DrawnMotion& motion : d.motions) text += fmt::format("  {}\n", motion.words);
  return text;
}

std::string drawing_json(const MachineDrawing& d) {
  Json out;
  out["kind"] = "drawing";
  out["drawing"] = d.frame ? "frame" : "device";
  out["name"] = d.name;
  out["about"] = d.about;
  if (!d.frame) out["pose_mm_deg"] = json::json_numbers(d.pose_mm_deg, "pose");
  out["driven"] = Json::array();
  for (const Actuator& a : d.driven)
    out["driven"].push_back({{"name", a.name},
                             {"value", a.rotation ? a.value * 180 / pi : report::mm * a.value},
                             {"unit", a.rotation ? "deg" : "mm"}});
  for (const char* list : {"members", "joints", "frames", "instruments", "points_mm", "lines", "motions"})
    out[list] = Json::array();
  for (const DrawnMember& m : d.members)
    out["members"].push_back({{"leg", m.leg},
                              {"part", m.part},
                              {"section", m.section},
                              {"material", m.material},
                              {"start_mm", list_in_mm(m.start)},
                              {"end_mm", list_in_mm(m.end)},
                              {"length_mm", report::mm * (m.end - m.start).norm()},
                              {"axes", axes_json(m.axes)},
                              {"size_mm", {report::mm * m.size_y, report::mm * m.size_z}},
                              {"round", m.round}});
  for (const DrawnJoint& j : d.joints)
    out["joints"].push_back({{"leg", j.leg},
                             {"part", j.part},
                             {"at_mm", list_in_mm(j.at)},
                             {"axes", axes_json(j.axes)},
                             {"freedoms", j.letters},
                             {"elastic", elastic_freedoms(j)},
                             {"words", words(j)},
                             {"driven", j.driven()}});
  for (const DrawnPoint& p : d.frames)
    out["frames"].push_back(
        {{"name", p.name}, {"at_mm", list_in_mm(p.at)}, {"axes", axes_json(p.axes)}, {"held", p.held}});
  for (const DrawnInstrument& i : d.instruments) {
    out["instruments"].push_back({{"name", i.name}, {"words", i.words}, {"at_mm", list_in_mm(i.at)}});
    if (i.axis) out["instruments"].back()["axis"] = {tidy(i.axis->x()), tidy(i.axis->y()), tidy(i.axis->z())};
  }
  for (const DrawnEntry::Kind kind : DrawnEntry::kinds) {
    if (!d.frame) break;
    Json& list = out[nth(entry_lists, kind)] = Json::array();
    for (const DrawnEntry& e : d.entries)
      if (e.kind == kind) list.push_back({{"name", e.name}, {"words", e.words}});
  }
  for (const Vector3& p : d.points) out["points_mm"].push_back(list_in_mm(p));
  for (const MachineDrawing::Line& line : d.lines) out["lines"].push_back({line.a, line.b, line.member});
  for (const DrawnMotion& motion : d.motions) {
    Json u = Json::array();
    for (const Vector3& each : motion.displacements) u.push_back(list_in_mm(each));
    out["motions"].push_back({{"words", motion.words}, {"displacement_mm", std::move(u)}});
  }
  out["trouble"] = d.trouble;
  return json::json_text(out);
}

}  // namespace deflect::figures
