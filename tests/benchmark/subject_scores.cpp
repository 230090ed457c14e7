#include "tests/benchmark/subject_scores.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "msa/base/index.h"
#include "tests/benchmark/cases.h"

namespace deflect::benchmark {
namespace {

using Sets = std::vector<SubjectSet>;
using Which = std::function<bool(const SubjectSet&)>;

bool right(const SubjectSet& s) { return exactly(s.answer, s.classes); }
bool open(const SubjectSet& s) { return is_open(s.kind); }
bool unknown(const SubjectSet& s) { return s.answer.verdict == "unknown_effect"; }
bool wrong(const SubjectSet& s) { return !right(s) && confident_and_wrong(s.answer, s.classes); }
Which of(SetKind kind, double lambda = 0) {
  return [=](const SubjectSet& s) { return s.kind == kind && (lambda == 0 || s.lambda == lambda); };
}
bool known(const SubjectSet& s) { return s.kind == SetKind::one || s.kind == SetKind::pair; }
bool large(const SubjectSet& s) { return s.kind == SetKind::one && s.lambda > 7; }

std::string ratio(double part, double whole) {
  return whole > 0 ? fmt::format("{:.2f} ({:g})", part / whole, whole) : "";
}

/// "0.83 (12)": share and number of sets.
std::string share(const Sets& all, const Which& which, const Which& does) {
  double sets = 0, yes = 0;
  for (const SubjectSet& s : all)
    if (which(s)) ++sets, yes += does(s);
  return ratio(yes, sets);
}

std::string right_class(const Sets& all, double lambda) { return share(all, of(SetKind::one, lambda), right); }
std::string truth_reported(const Sets& all) {
  return share(all, large, [](const SubjectSet& s) { return all_reported(s.answer, s.classes); });
}
std::string false_alarms(const Sets& all, SetKind kind) {
  return share(all, of(kind), [](const SubjectSet& s) { return !right(s); });
}

std::string alarms_under(const Sets& all, Stress stress) {
  return share(
      all, [=](const SubjectSet& s) { return s.stress == static_cast<int>(stress); },
      [](const SubjectSet& s) { return !right(s); });
}

/// Of the sets that the oracle answers rightly: of pairs, or of one effect or none.
std::string beside_oracle(const Sets& all, bool pairs) {
  return share(
      all, [=](const SubjectSet& s) { return s.oracle_asked && s.oracle_right && (s.kind == SetKind::pair) == pairs; },
      right);
}

/// "2.1 / 1.9": how many effects are left in question by the diagnosis and by the oracle, where one is named.
std::string sizes(const Sets& all) {
  double own = 0, oracle = 0;
  for (const SubjectSet& s : all)
    if (large(s) && names_effects(s.answer))
      own += static_cast<double>(reported(s.answer).size()), oracle += static_cast<double>(s.oracle_reported);
  const double sets =
      std::count_if(all.begin(), all.end(), [](const SubjectSet& s) { return large(s) && names_effects(s.answer); });
  return sets > 0 ? fmt::format("{:.1f} / {:.1f}", own / sets, oracle / sets) : "";
}

/// F1 of the places told where the law is not among the candidates, and the number of sets.
std::string localisation(const Sets& all) {
  double sets = 0, found = 0, told = 0, rightly = 0;
  for (const SubjectSet& s : all) {
    if (!open(s)) continue;
    ++sets;
    found += s.told_rightly > 0;
    told += static_cast<double>(s.told.size());
    rightly += s.told_rightly;
  }
  if (sets == 0) return "";
  const double recall = found / sets, precision = told > 0 ? rightly / told : 0;
  const double f1 = recall + precision > 0 ? 2 * recall * precision / (recall + precision) : 0;
  return fmt::format("{:.2f} ({:g})", f1, sets);
}

std::string mean_bias(const Sets& all) {
  double sum = 0;
  int sets = 0;
  for (const SubjectSet& s : all)
    if (s.bias) sum += *s.bias, ++sets;
  return sets > 0 ? fmt::format("{:+.2f} ± {:.2f}", sum / sets, 1 / std::sqrt(static_cast<double>(sets))) : "";
}

std::string intervals(const Sets& all) {
  double count = 0, covering = 0;
  for (const SubjectSet& s : all) count += s.intervals, covering += s.covering;
  return ratio(covering, count);
}

/// Of all effects reported where two are hidden, the share that is false.
std::string false_discoveries(const Sets& all) {
  double reported = 0, untrue = 0;
  for (const SubjectSet& s : all)
    if (s.kind == SetKind::pair)
      reported += static_cast<double>(s.answer.missing.size()),
          untrue += static_cast<double>(false_reports(s.answer, s.classes));
  return ratio(untrue, reported);
}

std::string median(std::vector<double> x, const char* format) {
  if (x.empty()) return "";
  std::sort(x.begin(), x.end());
  return fmt::format(fmt::runtime(format), x[x.size() / 2], x.size());
}

std::string new_poses(const Sets& all) {
  std::vector<double> errors;
  for (const SubjectSet& s : all)
    if (s.new_poses) errors.push_back(*s.new_poses);
  return median(errors, "{:.3f} ({})");
}

std::string seconds(const Sets& all) {
  std::vector<double> out;
  for (const SubjectSet& s : all) out.push_back(s.seconds);
  return median(out, "{:.1f}");
}

struct ScoreRow {
  const char *name, *wanted;
  std::function<std::string(const Sets&)> value;
};

Which res(double low, double high) {
  return [=](const SubjectSet& s) { return open(s) && s.lambda_res > low && s.lambda_res <= high; };
}

const std::vector<ScoreRow>& score_rows() {
  static const auto tied = [](const SubjectSet& s) { return large(s) && s.classes.front().size() > 1; };
  static const std::vector<ScoreRow> rows = {
      {"right class named, λ = 4", ".75", [](const Sets& s) { return right_class(s, 4); }},
      {"– λ = 8", ".95", [](const Sets& s) { return right_class(s, 8); }},
      {"– λ = 16", ".99", [](const Sets& s) { return right_class(s, 16); }},
      {"share of the oracle's right answers", ".95", [](const Sets& s) { return beside_oracle(s, false); }},
      {"truth among the effects reported, λ ≥ 8", ".98", truth_reported},
      {"effects reported / by the oracle, mean, λ ≥ 8", "1.1 ×", sizes},
      {"ties said to be ties, λ ≥ 8", "",
       [](const Sets& s) { return share(s, tied, [](const SubjectSet& x) { return !x.answer.groups.empty(); }); }},
      {"false alarms on healthy sets", ".03", [](const Sets& s) { return false_alarms(s, SetKind::healthy); }},
      {"– doubled tolerances, t(3) noise, outliers", ".06",
       [](const Sets& s) { return false_alarms(s, SetKind::stress); }},
      {"–– doubled tolerances", "", [](const Sets& s) { return alarms_under(s, Stress::tolerances); }},
      {"–– t(3) noise", "", [](const Sets& s) { return alarms_under(s, Stress::heavy_tails); }},
      {"–– 2 % outliers", "", [](const Sets& s) { return alarms_under(s, Stress::outliers); }},
      {"confident and wrong, effect among the candidates", ".01", [](const Sets& s) { return share(s, known, wrong); }},
      {"– not among them, λ_res > 6", ".02", [](const Sets& s) { return share(s, res(6, INFINITY), wrong); }},
      {"unknown recognised, λ_res 6–12", ".80", [](const Sets& s) { return share(s, res(6, 12), unknown); }},
      {"– λ_res > 12", ".98", [](const Sets& s) { return share(s, res(12, INFINITY), unknown); }},
      {"falsely unknown", ".03",
       [](const Sets& s) {
         return share(
             s, [](const SubjectSet& x) { return !open(x); }, unknown);
       }},
      {"place of what is not among the candidates, F1", ".90", localisation},
      {"two effects exactly, λ = 8", ".88", [](const Sets& s) { return share(s, of(SetKind::pair, 8), right); }},
      {"– λ = 16", ".97", [](const Sets& s) { return share(s, of(SetKind::pair, 16), right); }},
      {"– by the oracle", "",
       [](const Sets& s) { return share(s, of(SetKind::pair), [](const SubjectSet& x) { return x.oracle_right; }); }},
      {"– share of the oracle's right answers", ".95", [](const Sets& s) { return beside_oracle(s, true); }},
      {"false of all effects reported where two are hidden", "", false_discoveries},
      {"95 % intervals that hold the truth", ".93–.97", intervals},
      {"bias of the value, σ", "0", mean_bias},
      {"error at new poses / σ of a reading, median, λ ≥ 8", ".08", new_poses}};
  return rows;
}

Sets made(const std::vector<SubjectRow>& rows, const std::function<bool(const SubjectRow&)>& which) {
  Sets out;
  for (const SubjectRow& r : rows)
    if (which(r))
      std::copy_if(r.sets.begin(), r.sets.end(), std::back_inserter(out),
                   [](const SubjectSet& s) { return s.skipped.empty(); });
  return out;
}

}  // namespace

std::string subjects_report(const std::vector<SubjectRow>& rows) {
  const Sets machines = made(rows, [](const SubjectRow&r) { return !r.frame; }),
             frames = made(rows, [](const SubjectRow&r) { return r.frame; }),
             all = made(rows, [](const SubjectRow&) { return true; });
  std::string out = "| score | wanted | machines | frames | all |\n|---|---|---|---|---|\n";
  for (const ScoreRow& row : score_rows())
    out += fmt::format("| {} | {} | {} | {} | {} |\n", row.name, row.wanted, row.value(machines), row.value(frames),
                       row.value(all));
  out +=
      "\n| subject | candidates that act | right class, λ 4 | λ 8 | λ 16 | truth reported | false alarms | confident "
      "and "
      "wrong | two effects exactly | intervals that hold | of the oracle's right answers | place, F1 | s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SubjectRow& r : rows) {
    const Sets own = made({r}, [](const SubjectRow&) { return true; });
    out +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", r.name, r.candidates,
                    right_class(own, 4), right_class(own, 8), right_class(own, 16), truth_reported(own),
                    false_alarms(own, SetKind::healthy), share(own, known, wrong), share(own, of(SetKind::pair), right),
                    intervals(own), beside_oracle(own, false), localisation(own), seconds(own));
  }
  for (const SubjectRow& r : rows)
    for (const SubjectSet& s : r.sets)
      if (!s.skipped.empty())
        out += fmt::format("\nSkipped: {}, {}: {}.\n", r.name, nth(set_kind_names, s.kind), s.skipped);
  return out;
}

Json subjects_json(const std::vector<SubjectRow>& rows) {
  Json out = Json::array();
  for (const SubjectRow& r : rows) {
    Json one = {{"subject", r.name}, {"frame", r.frame}, {"candidates", r.candidates}, {"sets", Json::array()}};
    for (const SubjectSet& s : r.sets) {
      Json set = {{"kind", nth(set_kind_names, s.kind)},
                  {"stress", s.stress < 0 ? "" : nth(stress_names, s.stress)},
                  {"skipped", s.skipped},
                  {"hidden", s.hidden},
                  {"classes", s.classes},
                  {"lambda", s.lambda},
                  {"lambda_res", s.lambda_res},
                  {"verdict", s.answer.verdict},
                  {"missing", s.answer.missing},
                  {"tied", s.answer.groups},
                  {"probability", s.answer.probability},
                  {"right", right(s)},
                  {"wrong", wrong(s)},
                  {"oracle_right", s.oracle_right},
                  {"oracle_reported", s.oracle_reported},
                  {"intervals", s.intervals},
                  {"covering", s.covering},
                  {"places_told", s.told},
                  {"places_right", s.told_rightly},
                  {"seconds", s.seconds}};
      if (s.bias) set["bias"] = *s.bias;
      if (s.new_poses) set["new_poses"] = *s.new_poses;
      one["sets"].push_back(std::move(set));
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace deflect::benchmark
