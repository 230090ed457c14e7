#include "validation/report/diagnosis_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/diagnosis/interval.h"
#include "validation/json/json_text.h"
#include "validation/report/effect_results.h"
#include "validation/report/short_lists.h"
#include "validation/report/text.h"
#include "validation/report/verdict_words.h"

namespace deflect::report {
namespace {

constexpr const char* mistakes_remedy =
    "No effect was looked for: correct the file and diagnose again, or take it as it is with --as-recorded.\n";

const char* micro(const diagnosis::Diagnosis& d) { return measurement::row_of(d.quantity).fine; }
double fine(const diagnosis::Diagnosis& d) { return measurement::row_of(d.quantity).fine_per_SI; }
double coarse(const diagnosis::Diagnosis& d) { return measurement::row_of(d.quantity).coarse_per_SI; }

std::string candidates_table(const diagnosis::Diagnosis& d) {
  std::vector<std::vector<std::string>> rows = {{d.missing.size() > 1 ? "candidate, alone" : "candidate", "probability",
                                                 fmt::format("rms {}", micro(d)), "held-out", "chi2/n",
                                                 "values with 95 % interval"}};
  std::size_t shown = 0;
  for (const diagnosis::Candidate& c : d.candidates) {
    if (shown >= 8 || (c.probability < 1e-6 && shown >= 3)) break;
    rows.push_back({"  " + placed_words(c.added()), fmt::format("{:.3g}", c.probability),
                    fmt::format("{:.2f}", fine(d) * c.rmse), fmt::format("{:.2f}", fine(d) * c.held_out),
                    fmt::format("{:.2f}", c.chi2_per_dof), c.fit.found ? fitted_words(c.hypothesis, c.fit) : "no fit"});
    ++shown;
  }
  rows.push_back(
      {"  nothing", fmt::format("{:.3g}", d.probability_nothing), fmt::format("{:.2f}", fine(d) * d.baseline.rmse),
       fmt::format("{:.2f}", fine(d) * d.baseline.held_out), fmt::format("{:.2f}", d.baseline.chi2_per_dof), ""});
  rows.push_back({"  something unknown", fmt::format("{:.3g}", d.probability_unknown)});
  return aligned(rows);
}

Json quality_json(const diagnosis::Quality& q, double coarse) {
  return {{"rmse_mm", json::json_number(coarse * q.rmse, "rmse")},
          {"held_out_rmse_mm", json::json_number(coarse * q.held_out, "held-out rmse")},
          {"chi2_per_dof", json::json_number(q.chi2_per_dof, "chi2")}};
}

Json parameters_json(const diagnosis::Hypothesis& h, const diagnosis::Fit& f, std::size_t from, std::size_t count) {
  Json out = Json::array();
  const std::vector<const effects::EffectParameter*> all = diagnosis::parameters_of(h);
  for (std::size_t i = from; i < from + count && f.found; ++i) {
    const auto [low, high] = diagnosis::interval95(h, f, i);
    const bool open = std::isinf(high);
    out.push_back({{"name", all[i]->name},
                   {"value", f.values(as_index(i))},
                   {"low95", low},
                   {"high95", open ? all[i]->high : high}});
    if (open) out.back()["at_least"] = true;
  }
  return out;
}

/// An effect and its place: in words, where it is one leg as its number, of a law at a place the place.
Json placed_json(const effects::PlacedEffect& e) {
  Json out = {{"effect", e.effect->name}, {"title", e.effect->title}, {"site", effects::site_of(e)}};
  if (e.leg) out["leg"] = *e.leg;
  if (e.effect->place) out["place"] = place_json(*e.effect->place, e.leg);
  return out;
}

Json candidates_json(const std::vector<diagnosis::Candidate>& candidates, double coarse) {
  Json out = Json::array();
  for (const diagnosis::Candidate& c : candidates) {
    Json one = placed_json(c.added());
    one["probability"] = c.probability;
    one["parameters"] = parameters_json(c.hypothesis, c.fit, 0, c.added().effect->parameters.size());
    one["rmse_mm"] = coarse * c.rmse;
    one["held_out_rmse_mm"] = coarse * c.held_out;
    one["chi2_per_dof"] = json::json_number(c.chi2_per_dof, "chi2");
    out.push_back(std::move(one));
  }
  return out;
}

/// Of what a sensor reads of another: the sensor.
subject::Place whole_place(subject::Place p) {
  if (p.other.empty()) return p;
  p.part = subject::sensor_of(p);
  p.path = "sensors." + p.part;
  p.other.clear();
  return p;
}

/// What is left of the misfit, and where it acts.
Json unexplained_json(const diagnosis::Diagnosis& d) {
  Json localised = Json::array();
  for (const diagnosis::Localised& l : d.localised)
    localised.push_back({{"what", l.what},
                         {"share", l.share},
                         {"probability", l.probability},
                         {"effect", l.effect ? Json(l.effect->name) : Json()},
                         {"place", place_json(whole_place(l.place), l.leg)}});
  return {{"significant", d.unexplained}, {"share_of_misfit", d.share_unexplained},
          {"pattern", d.pattern},         {"localised", localised},
          {"nearest", d.nearest},         {"nearest_share", d.nearest_share}};
}

Json splitting_json(const std::vector<diagnosis::Splitting>& all) {
  Json out = Json::array();
  for (const diagnosis::Splitting& s : all) {
    const measurement::QuantityRow& row = measurement::row_of(s.quantity);
    out.push_back({{"between", s.between},
                   {"reading", s.reading},
                   {"difference", json::json_number(row.coarse_per_SI * s.difference, "difference")},
                   {"unit", row.coarse},
                   {"standard_deviations", json::json_number(s.deviations, "deviations")},
                   {"sentence", splitting_words(s)}});
  }
  return out;
}

/// Effects that were fitted together.
Json fitted_json(const diagnosis::Hypothesis& h, const diagnosis::Fit& f) {
  Json out = Json::array();
  std::size_t from = 0;
  for (const effects::PlacedEffect& e : h) {
    Json one = placed_json(e);
    one["parameters"] = parameters_json(h, f, from, e.effect->parameters.size());
    out.push_back(std::move(one));
    from += e.effect->parameters.size();
  }
  return out;
}

/// Of each tie what was fitted, for the plan of what to measure next.
Json ties_json(const std::vector<diagnosis::Tie>& ties) {
  Json out = Json::array();
  for (const diagnosis::Tie& tie : ties) {
    Json rivals = Json::array();
    for (const diagnosis::Candidate& c : tie.rivals)
      rivals.push_back({{"probability", c.probability}, {"effects", fitted_json(c.hypothesis, c.fit)}});
    out.push_back({{"rivals", std::move(rivals)}});
  }
  return out;
}

Json detectable_json(const std::vector<diagnosis::Detectable>& detectable) {
  Json out = Json::array();
  for (const diagnosis::Detectable& e : detectable) {
    Json names = Json::array();
    for (const effects::EffectParameter& p : e.effect.effect->parameters) names.push_back(p.name);
    Json one = placed_json(e.effect);
    one["parameters"] = names;
    one["smallest"] = e.smallest;
    one["mistaken_for"] = e.mistaken_for;
    one["cosine"] = e.cosine;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

std::string diagnosis_report(const diagnosis::Diagnosis& d, const std::string& device, const std::string& data) {
  std::string out = fmt::format("{} against {}\n\n{}\n\n", device, data, verdict_words(d));
  for (const compare::RecordingMistake& mistake : d.mistakes)
    if (!mistake.certain) out += mistake.sentence + "\n\n";
  out += how_read_text(d.how_read);
  if (diagnosis::is_mistaken(d)) return out + mistakes_remedy;
  if (!d.missing.empty()) out += "fitted: " + fitted_words(d.missing, d.fit) + "\n\n";
  for (const diagnosis::Splitting& s : d.splitting) out += splitting_words(s) + "\n\n";
  out += candidates_table(d);
  out += fmt::format("\nchance that some effect looks as good in data with nothing missing: {:.2g} ({} sets drawn)\n",
                     d.chance, d.bootstrap_sets);
  if (d.unexplained) {
    out += fmt::format("left unexplained: {:.0f} % of the misfit; of that", 100 * d.share_unexplained);
    for (const diagnosis::Localised& l : d.localised)
      out += fmt::format(" {:.0f} % at one place, {}'{}' (probability of this place {:.2f});", 100 * l.share,
                         l.effect ? "most like " : "", l.what, l.probability);
    if (!d.nearest.empty()) out += fmt::format(" the nearest entry, {}, {:.0f} %", d.nearest, 100 * d.nearest_share);
    out += "\n";
  }
  if (d.tolerance_scale > 1)
    out += fmt::format("the machine's tolerances look {:.1f} times as large as declared and count so\n",
                       d.tolerance_scale);
  if (d.set_aside > 0) out += fmt::format("readings set aside as gross outliers: {}\n", d.set_aside);
  out += in_play_words(d.in_play, d.readings);
  if (!d.strained.empty())
    out += fmt::format("tolerances beyond two standard deviations: {}\n", strained_words(d.strained));
  return out + left_out_words(d.left_out) + "\n" + detectable_table(d.detectable);
}

std::string candidates_csv(const diagnosis::Diagnosis& d) {
  const char* unit = measurement::row_of(d.quantity).coarse;
  std::string csv = fmt::format(
      "effect,leg,probability,rmse_{0},held_out_rmse_{0},chi2_per_dof,parameter,unit,value,low95,high95\n", unit);
  const auto add = [&](const std::string& name, const std::string& leg, double probability, const diagnosis::Quality& q,
                       const std::string& value) {
    csv += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", csv_cell(name), leg, probability, coarse(d) * q.rmse,
                       coarse(d) * q.held_out, q.chi2_per_dof, value);
  };
  for (const diagnosis::Candidate& c : d.candidates) {
    const effects::PlacedEffect& e = c.added();
    const std::string leg = e.leg ? std::to_string(*e.leg) : "";
    const diagnosis::Quality quality{c.rmse, c.held_out, c.chi2_per_dof};
    if (!c.fit.found || e.effect->parameters.empty()) add(e.effect->name, leg, c.probability, quality, ",,,,");
    for (std::size_t i = 0; c.fit.found && i < e.effect->parameters.size(); ++i) {
      const auto [low, high] = diagnosis::interval95(c.hypothesis, c.fit, i);
      const effects::EffectParameter& p = e.effect->parameters[i];
      add(e.effect->name, leg, c.probability, quality,
          fmt::format("{},{},{:.6g},{:.6g},{}", p.name, csv_cell(p.unit), c.fit.values(as_index(i)), low,
                      std::isinf(high) ? std::string() : fmt::format("{:.6g}", high)));
    }
  }
  add("nothing", "", d.probability_nothing, d.baseline, ",,,,");
  csv += fmt::format("something unknown,,{:.6g},,,,,,,,\n", d.probability_unknown);
  return csv;
}

std::string detectable_csv(const diagnosis::Diagnosis& d) {
  std::string csv = "effect,leg,parameter,unit,smallest,mistaken_for,cosine\n";
  for (const diagnosis::Detectable& e : d.detectable)
    for (std::size_t i = 0; i < e.effect.effect->parameters.size() && i < e.smallest.size(); ++i) {
      const effects::EffectParameter& p = e.effect.effect->parameters[i];
      csv += fmt::format("{},{},{},{},{:.6g},{},{:.6g}\n", csv_cell(e.effect.effect->name),
                         e.effect.leg ? std::to_string(*e.effect.leg) : "", p.name, csv_cell(p.unit), e.smallest[i],
                         csv_cell(e.mistaken_for), e.cosine);
    }
  return csv;
}

std::string diagnosis_json(const diagnosis::Diagnosis& d) {
  Json j;
  j["kind"] = "diagnosis";
  j["verdict"] = nth(diagnosis::verdict_names, d.verdict);
  j["device"] = d.device;
  j["data"] = d.data;
  j["notes"] = d.how_read;
  j["sentence"] = verdict_words(d);
  j["headline"] = headline_words(d);
  j["mistakes"] = mistakes_json(d.mistakes);
  j["missing"] = Json::array();
  for (const effects::PlacedEffect& e : d.missing) j["missing"].push_back(e.effect->name);
  j["candidates"] = candidates_json(d.candidates, coarse(d));
  j["indistinguishable"] = d.indistinguishable;
  j["ties"] = ties_json(d.ties);
  j["splitting"] = splitting_json(d.splitting);
  j["baseline"] = quality_json(d.baseline, coarse(d));
  j["final"] = quality_json(d.final, coarse(d));
  j["unit"] = measurement::row_of(d.quantity).coarse;  // of what ends with _mm
  j["noise_floor_mm"] = json::json_number(coarse(d) * d.noise_floor, "noise floor");
  j["unexplained"] = unexplained_json(d);
  j["found"] = fitted_json(d.missing, d.fit);
  j["probability_nothing"] = d.probability_nothing;
  j["probability_larger_tolerances"] = d.probability_larger_tolerances;
  j["larger_tolerances"] = d.larger_tolerances;
  j["probability_unknown"] = d.probability_unknown;
  j["chance_of_any"] = d.chance;
  j["bootstrap_sets"] = d.bootstrap_sets;
  j["tolerance_scale"] = d.tolerance_scale;
  j["readings"] = d.readings;
  j["set_aside"] = d.set_aside;
  j["in_play"] = d.in_play;
  j["strained_tolerances"] = strained_json(d.strained);
  j["detectable"] = detectable_json(d.detectable);
  j["left_out"] = left_out_json(d.left_out);
  return json::json_text(j);
}

}  // namespace deflect::report
