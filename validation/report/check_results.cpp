#include "validation/report/check_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validation/json/json_text.h"
#include "validation/report/text.h"

namespace deflect::report {
namespace {

std::string bound_text(const matrix::Check& c) {
  if (std::isfinite(c.at_least) && std::isfinite(c.at_most))
    return fmt::format("{:.3g} … {:.3g}", c.at_least, c.at_most);
  return std::isfinite(c.at_most) ? fmt::format("≤ {:.2g}", c.at_most) : fmt::format("≥ {:.2g}", c.at_least);
}

std::string named(std::string id) {
  std::replace(id.begin(), id.end(), '_', ' ');
  return id;
}

std::string checks_table(const matrix::MatrixCheck& m) {
  std::vector<std::vector<std::string>> rows = {{"check", "measured", "bound", ""}};
  for (const matrix::Check& c : m.checks)
    rows.push_back({fmt::format("  {}: {}", named(c.id), c.quantity),
                    c.measured ? fmt::format("{:.3g}", *c.measured) : "-", bound_text(c),
                    !c.measured  ? "not judged"
                    : c.passes() ? "passes"
                                 : "FAILS"});
  return aligned(rows);
}

std::string triple(const Vector3& v, double tidy_below) {
  const auto tidy = [&](double x) { return std::abs(x) < tidy_below ? 0.0 : x; };
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", tidy(v.x()), tidy(v.y()), tidy(v.z()));
}

std::string structure_text(const matrix::MatrixCheck& m) {
  std::string text;
  if (m.structure) {
    const matrix::ElasticStructure& s = *m.structure;
    const double small = 1e-6 * std::max(s.length, 1e-3);
    text += fmt::format("centre of stiffness     T + {} mm\n", triple(s.centre_of_stiffness, small));
    if (s.centre_of_compliance)
      text += fmt::format("centre of compliance    T + {} mm\n", triple(*s.centre_of_compliance, small));
    text += fmt::format("characteristic length   {:.4g} mm\n", s.length);
    text += "principal stiffnesses\n";
    for (int i = 0; i < 3; ++i)
      text += fmt::format("  translation           {:.5g} N/mm along {}\n", s.translational(i),
                          triple(s.axes.col(i), 1e-6));
    text += fmt::format("  rotation              {:.5g}, {:.5g}, {:.5g} Nmm/rad about the centre of stiffness\n",
                        s.rotational(0), s.rotational(1), s.rotational(2));
  }
  const Vector6& e = m.eigenvalues_N_mm;
  text += fmt::format("eigenvalues             {:.4g} N/mm\n", fmt::join(e.begin(), e.end(), ", "));
  text += fmt::format("                        rotations weighed by {:.4g} mm\n", m.weighing_length_mm);
  return text;
}

/// `matrix`, `reference`: what they are called; the reference "" where there is none.
std::string check_verdict(const matrix::MatrixCheck& m, const std::string& matrix, const std::string& reference) {
  if (m.passes()) {
    const bool one_leg = std::any_of(m.checks.begin(), m.checks.end(),
                                     [](const matrix::Check& c) { return c.id.starts_with("passive"); });
    return fmt::format("{} passes: it is symmetric and positive and {}{}.", matrix,
                       one_leg ? "leaves its passive joints free and nothing else" : "holds every direction",
                       reference.empty() ? "" : ", and it equals " + reference);
  }
  std::vector<std::string> sentences;
  for (const matrix::MatrixDiagnosis& d : m.explanations) sentences.push_back(d.sentence);
  std::string text = sentences.empty() ? "" : fmt::format("{}", fmt::join(sentences, "; or "));
  if (sentences.size() > 1) text = "either " + text;
  if (m.guessed && !text.empty()) text = "by its size it is no machine's; most likely " + text;
  for (const matrix::MatrixDiagnosis& d : m.findings) text += (text.empty() ? "" : "; ") + d.sentence;
  return fmt::format("{} fails: {}.", matrix, text);
}

std::string remedies(const matrix::MatrixCheck& m) {
  std::vector<std::string> list;
  for (const auto* part : {&m.explanations, &m.findings})
    for (const matrix::MatrixDiagnosis& d : *part)
      if (std::find(list.begin(), list.end(), d.remedy) == list.end()) list.push_back(d.remedy);
  return fmt::format("{}", fmt::join(list, m.explanations.size() > 1 ? "; or " : "; "));
}

std::string paragraph(const std::string& text) { return fmt::format("{}\n", fmt::join(wrap(text, line_length), "\n")); }

Json json_vector(const Vector3& v, const std::string& what) {
  Json list = Json::array();
  for (int i = 0; i < 3; ++i) list.push_back(json::json_number(v(i), what));
  return list;
}

Json json_check(const matrix::Check& c) {
  Json json;
  json["check"] = c.id;
  json["quantity"] = c.quantity;
  if (c.measured) json["measured"] = json::json_number(*c.measured, c.id);
  if (std::isfinite(c.at_least)) json["at_least"] = c.at_least;
  if (std::isfinite(c.at_most)) json["at_most"] = c.at_most;
  json["passes"] = c.passes();
  return json;
}

Json json_diagnosis(const matrix::MatrixDiagnosis& d, bool certain) {
  return {{"id", d.id}, {"sentence", d.sentence}, {"remedy", d.remedy}, {"certain", certain}};
}

}  // namespace

std::string check_report(const matrix::MatrixCheck& m, const CheckedFiles& f) {
  std::string text = paragraph(check_verdict(m, f.matrix, f.reference));
  if (!m.passes()) text += paragraph("Remedy: " + remedies(m) + ".");
  text += "\n" + checks_table(m) + "\n" + structure_text(m);
  if (f.reference.empty())
    text +=
        "\n" + paragraph(
                   "One matrix cannot show another point or other axes, a factor, or the rule of a compliance applied "
                   "on both sides: compare it with --reference or --device.");
  return text;
}

std::string check_json(const matrix::MatrixCheck& m, const CheckedFiles& f) {
  Json json;
  json["kind"] = "check";
  json["file"] = f.matrix;
  if (!f.reference.empty()) json["reference"] = f.reference;
  json["verdict"] = check_verdict(m, "The stiffness", f.reference.empty() ? "" : "the reference");
  json["passes"] = m.passes();
  json["matrix"] = json::json_rows(m.K_mm, "matrix");
  json["checks"] = Json::array();
  for (const matrix::Check& c : m.checks) json["checks"].push_back(json_check(c));
  json["diagnosis"] = Json::array();
  for (const matrix::MatrixDiagnosis& d : m.explanations)
    json["diagnosis"].push_back(json_diagnosis(d, m.explanations.size() == 1 && !m.guessed));
  for (const matrix::MatrixDiagnosis& d : m.findings) json["diagnosis"].push_back(json_diagnosis(d, true));
  json["max_asymmetry"] = json::json_number(m.max_asymmetry, "max_asymmetry");
  json["weighing_length_mm"] = json::json_number(m.weighing_length_mm, "weighing_length_mm");
  json["eigenvalues_N_per_mm"] = json::json_numbers(m.eigenvalues_N_mm, "eigenvalues_N_per_mm");
  if (m.structure) {
    const matrix::ElasticStructure& s = *m.structure;
    json["centre_of_stiffness_mm"] = json_vector(s.centre_of_stiffness, "centre_of_stiffness_mm");
    if (s.centre_of_compliance)
      json["centre_of_compliance_mm"] = json_vector(*s.centre_of_compliance, "centre_of_compliance_mm");
    json["characteristic_length_mm"] = json::json_number(s.length, "characteristic_length_mm");
    json["principal_translation_N_per_mm"] = json_vector(s.translational, "principal_translation_N_per_mm");
    json["principal_axes"] = Json::array();
    for (int i = 0; i < 3; ++i) json["principal_axes"].push_back(json_vector(s.axes.col(i), "principal_axes"));
    json["principal_rotation_Nmm_per_rad"] = json_vector(s.rotational, "principal_rotation_Nmm_per_rad");
  }
  if (m.ratio) json["ratio_to_reference"] = {(*m.ratio)(0), (*m.ratio)(1)};
  return json::json_text(json);
}

std::string checks_csv(const matrix::MatrixCheck& m) {
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format("{}", x) : std::string(); };
  std::string csv = "check,quantity,measured,at_least,at_most,passes\n";
  for (const matrix::Check& c : m.checks)
    csv += fmt::format("{},{},{},{},{},{}\n", c.id, csv_cell(c.quantity),
                       c.measured ? fmt::format("{}", *c.measured) : "", cell(c.at_least), cell(c.at_most), c.passes());
  return csv;
}

std::string structure_csv(const matrix::MatrixCheck& m) {
  std::string csv = "quantity,unit,1,2,3\n";
  const auto row = [&csv](const char* name, const char* unit, const Vector3& v) {
    csv += fmt::format("{},{},{},{},{}\n", name, unit, v(0), v(1), v(2));
  };
  row("eigenvalues_1_to_3", "N/mm", m.eigenvalues_N_mm.head<3>());
  row("eigenvalues_4_to_6", "N/mm", m.eigenvalues_N_mm.tail<3>());
  if (!m.structure) return csv;
  const matrix::ElasticStructure& s = *m.structure;
  row("centre_of_stiffness", "mm", s.centre_of_stiffness);
  if (s.centre_of_compliance) row("centre_of_compliance", "mm", *s.centre_of_compliance);
  row("principal_translation", "N/mm", s.translational);
  for (int i = 0; i < 3; ++i) row(fmt::format("principal_axis_{}", i + 1).c_str(), "1", s.axes.col(i));
  row("principal_rotation", "Nmm/rad", s.rotational);
  return csv;
}

}  // namespace deflect::report
