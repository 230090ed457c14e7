#include "validation/report/verdict_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/number_words.h"
#include "validation/diagnosis/interval.h"
#include "validation/diagnosis/signatures.h"
#include "validation/report/compare_words.h"

namespace deflect::report {
namespace {

constexpr double like_noise = 1.3;            // χ² per degree of freedom up to which a residual passes for noise
constexpr double headline_of_outliers = 5;    // % of the readings
constexpr double likely = 0.5, rival = 0.01;  // probabilities of larger tolerances that are told

/// "2.13 µm rms, 1.02 times what noise and tolerances give (chi2 per degree of freedom)".
std::string residual_words(double rmse, double chi2_per_dof, measurement::Quantity q) {
  return fmt::format("{:.2f} {} rms, {:.2f} times what noise and tolerances give (chi2 per degree of freedom)",
                     fine_of(q) * rmse, fine_unit(q), chi2_per_dof);
}

bool passes_for_noise(double chi2_per_dof) { return as_printed(chi2_per_dof, 2) <= like_noise; }

std::string first_of_all(const std::vector<compare::RecordingMistake>& mistakes) {
  return "Before anything else: " + mistakes.front().sentence + ".";
}

/// "The guideway of one leg bends more easily than the others: leg 4".
std::string titled_words(const effects::PlacedEffect& e) {
  return e.leg ? fmt::format("{}: {}", e.effect->title, effects::site_of(e)) : e.effect->title;
}

std::string titled_with_id(const effects::PlacedEffect& e) {
  return fmt::format("{} ({})", e.effect->title, placed_words(e));
}

/// A title that goes on a sentence: "The clamp yields" → "the clamp yields"; a name such as "Young's modulus" stays.
std::string continued(std::string title) {
  constexpr const char* begins[] = {"The ", "A ", "An ", "Every ", "Each ", "One "};
  for (const char* word : begins)
    if (title.starts_with(word)) title.front() = static_cast<char>(title.front() - 'A' + 'a');
  return title;
}

/// Titles, which are sentences, as one sentence.
std::string joined_titles(const diagnosis::Hypothesis& effects, std::string (*words)(const effects::PlacedEffect&)) {
  std::string out;
  for (const effects::PlacedEffect& e : effects) out += out.empty() ? words(e) : "; and " + continued(words(e));
  return out;
}

/// An id of a group of indistinguishable effects in words, with the leg at which the effect was fitted.
std::string rival_words(const std::string& id, const diagnosis::Diagnosis& d,
                        std::string (*words)(const effects::PlacedEffect&)) {
  for (const diagnosis::Tie& tie : d.ties)
    for (const diagnosis::Candidate& c : tie.rivals)
      if (id == c.added().effect->name) return words(c.added());
  return id;
}

/// What the effects that were found take away, in the unit in which it can be seen.
std::string fall_of_error(const diagnosis::Diagnosis& d) {
  const char* unit = fine_unit(d.quantity);
  const double micro_per_SI = fine_of(d.quantity);
  const double from = as_printed(micro_per_SI * d.baseline.rmse, 2), to = as_printed(micro_per_SI * d.final.rmse, 2);
  const double percent = from > 0 ? as_printed(100 * (1 - to / from), 0) : 0;
  if (percent >= 1)
    return fmt::format(
        "With it the error falls from {:.2f} to {:.2f} {} rms ({:.0f} %); the readings' noise is {:.2f} {}.", from, to,
        unit, percent, micro_per_SI * d.noise_floor, unit);
  const bool fits_better = d.final.chi2_per_dof < d.baseline.chi2_per_dof;
  if (fits_better && percent <= -1)
    return fmt::format(
        "The error of the description alone rises with it, from {:.2f} to {:.2f} {} rms: together with tolerances of "
        "likely size it explains the readings better, chi2 per degree of freedom falls from {}.",
        from, to, unit, fall_words(d.baseline.chi2_per_dof, d.final.chi2_per_dof));
  if (fits_better)
    return fmt::format(
        "It hardly shows in the size of the error, {:.2f} {} rms beside a noise of {:.2f} {}, but in all readings "
        "together: chi2 per degree of freedom falls from {}.",
        to, unit, micro_per_SI * d.noise_floor, unit, fall_words(d.baseline.chi2_per_dof, d.final.chi2_per_dof));
  return fmt::format("The error does not fall with it: {:.2f} {} rms before, {:.2f} with it.", from, unit, to);
}

/// Where that is not out of the question: that no effect is needed if parts deviate farther than declared.
std::string larger_tolerances_words(const diagnosis::Diagnosis& d) {
  if (d.missing.empty() || !(d.probability_larger_tolerances > rival)) return "";
  const std::string size =
      d.larger_tolerances < 1.05 ? "as large as" : fmt::format("{:.1f} times as large as", d.larger_tolerances);
  return fmt::format(" Tolerances {} declared would explain the readings without it (probability {:.2g}).", size,
                     d.probability_larger_tolerances);
}

/// Of those that tie and have no upper limit: what they say.
std::string gone_words(const diagnosis::Diagnosis& d) {
  std::string out;
  for (const diagnosis::Tie& tie : d.ties)
    for (const diagnosis::Candidate& c : tie.rivals) {
      if (c.fit.limits.empty() || !std::isinf(c.fit.limits.back().second)) continue;
      out += fmt::format(
          " {} of at least {} {} is the same to these readings as a part that is gone: it carries nothing in them.",
          diagnosis::name_of(c.added()), digits_of(c.fit.limits.back().first, 3),
          c.added().effect->parameters.front().unit);
    }
  return out;
}

/// Of a friction without a lower limit beside play at its place: what it says.
std::string trace_of_friction_words(const diagnosis::Diagnosis& d) {
  std::string out;
  std::size_t first = 0;  // of its parameters
  for (const effects::PlacedEffect& e : d.missing) {
    const auto plays_there = [&](const effects::PlacedEffect& other) {
      return other.effect->name.starts_with("clearance@") && diagnosis::at_one_place(e, other);
    };
    if (e.effect->name.starts_with("friction@") && d.fit.found &&
        std::any_of(d.missing.begin(), d.missing.end(), plays_there) &&
        diagnosis::interval95(d.missing, d.fit, first).first <= (1 + 1e-6) * e.effect->parameters.front().low)
      out +=
          fmt::format(" {} may be next to nothing: then it says only that the play stays where the last load left it.",
                      diagnosis::name_of(e));
    first += e.effect->parameters.size();
  }
  return out;
}

std::string nothing_missing_words(const diagnosis::Diagnosis& d) {
  const std::string left = residual_words(d.baseline.rmse, d.baseline.chi2_per_dof, d.quantity) + ".";
  if (d.probability_larger_tolerances > likely)
    return fmt::format(
        "No effect is called for: the readings are those of parts that deviate {:.1f} times as far as "
        "the tolerances declare (probability {:.2g}). What is left is {}",
        d.larger_tolerances, d.probability_larger_tolerances, left);
  return (passes_for_noise(d.baseline.chi2_per_dof)
              ? "Nothing is missing that these data can show: what is left is "
              : "No effect is called for, but noise and tolerances do not explain all: what is left is ") +
         left;
}

}  // namespace

std::string outlier_words(std::size_t set_aside, std::size_t readings) {
  const double percent =
      as_printed(100 * static_cast<double>(set_aside) / static_cast<double>(std::max<std::size_t>(1, readings)), 1);
  if (!(percent > headline_of_outliers)) return "";
  return fmt::format(
      "{} of {} readings ({:.1f} %) are gross outliers and are set aside: look at them first, what follows rests on "
      "the others. ",
      set_aside, readings, percent);
}

std::string in_play_words(std::size_t in_play, std::size_t readings) {
  if (in_play == 0) return "";
  return fmt::format(
      "at {} of {} readings the load leaves play open: forces too small to be known say where in it the machine "
      "stands, which counts as unknown there\n",
      in_play, readings);
}

std::string verdict_words(const compare::Comparison& c) {
  if (compare::is_mistaken(c)) return first_of_all(c.mistakes);
  const char* unit = error_unit(c).micro;
  const double micro_per_SI = error_unit(c).fine;
  const std::string outliers = outlier_words(c.set_aside.size(), c.readings);
  if (c.findings.empty())
    return outliers +
           (passes_for_noise(c.unexplained_chi2_per_dof)
                ? "Nothing is missing that these readings can show: what is left is "
                : "Something is missing, and none of the patterns looked for describes it: what is left is ") +
           residual_words(c.kept_rmse, c.unexplained_chi2_per_dof, error_unit(c).quantity) + ".";
  const double rmse = as_printed(micro_per_SI * c.kept_rmse, 2);
  const double beyond =
      std::sqrt(std::max(0.0, c.kept_rmse * c.kept_rmse - c.noise_and_tolerances * c.noise_and_tolerances));
  const double percent = c.all.measured > 0 ? as_printed(100 * beyond / c.all.measured, 0) : 0;
  if (percent >= 1)
    return outliers + fmt::format(
                          "Something is missing: the model fails by {:.2f} {} rms beyond noise and tolerances ({:.0f} "
                          "% of what was "
                          "measured).",
                          micro_per_SI * beyond, unit, percent);
  return outliers + fmt::format(
                        "Something is missing, little against noise and tolerances ({:.2f} {} rms are left where they "
                        "give {:.2f}): what is found below takes chi2 per degree of freedom from {}.",
                        rmse, unit, micro_per_SI * c.noise_and_tolerances,
                        fall_words(c.chi2_per_dof, c.unexplained_chi2_per_dof));
}

std::string verdict_words(const diagnosis::Diagnosis& d) {
  if (diagnosis::is_mistaken(d)) return first_of_all(d.mistakes);
  const std::string outliers = outlier_words(d.set_aside, d.readings);
  const std::string names = joined_titles(d.missing, titled_with_id);
  switch (d.verdict) {
    case diagnosis::Verdict::nothing_missing:
      return outliers + nothing_missing_words(d);
    case diagnosis::Verdict::effect:
      return outliers + fmt::format("Missing: {}. {}", names, fall_of_error(d)) + trace_of_friction_words(d) +
             larger_tolerances_words(d);
    case diagnosis::Verdict::ambiguous: {
      std::string group;
      for (const std::vector<std::string>& g : d.indistinguishable) {
        group += group.empty() ? "" : "; and ";
        for (const std::string& id : g)
          group += (&id == &g.front() ? "" : " or ") + rival_words(id, d, diagnosis::name_of);
      }
      return outliers +
             fmt::format("Something is missing, and these data cannot tell what of: {}. Best: {}. {}", group, names,
                         fall_of_error(d)) +
             gone_words(d) + trace_of_friction_words(d) + larger_tolerances_words(d);
    }
    case diagnosis::Verdict::unknown_effect:
      return outliers +
             fmt::format(
                 "Something is missing that no effect of the catalogue explains to the noise{}. What is left: {}.",
                 names.empty() ? "" : ", not even with this: " + names, d.pattern);
  }
  return "";
}

std::string headline_words(const diagnosis::Diagnosis& d) {
  if (diagnosis::is_mistaken(d)) return verdict_words(d);
  const std::string outliers = outlier_words(d.set_aside, d.readings);
  switch (d.verdict) {
    case diagnosis::Verdict::nothing_missing:
      return verdict_words(d);
    case diagnosis::Verdict::effect:
      return outliers + fmt::format("{}. This is missing from the model. {}", joined_titles(d.missing, titled_words),
                                    fall_of_error(d));
    case diagnosis::Verdict::ambiguous: {
      std::string either;
      for (const std::vector<std::string>& group : d.indistinguishable) {
        if (!either.empty()) either += " And: ";
        for (const std::string& id : group)
          either += (&id == &group.front() ? "" : " – or – ") + rival_words(id, d, titled_words);
        either += ".";
      }
      return outliers +
             fmt::format("Something is missing, and these data cannot tell which of these: {} {}", either,
                         fall_of_error(d)) +
             gone_words(d);
    }
    case diagnosis::Verdict::unknown_effect:
      return outliers +
             fmt::format(
                 "Something is missing that no effect of the catalogue explains to the noise{}. What is left: {}.",
                 d.missing.empty() ? "" : ", not even with this: " + joined_titles(d.missing, titled_words), d.pattern);
  }
  return "";
}

std::string how_read_text(const std::vector<std::string>& how) {
  return how.empty() ? "" : fmt::format("\nhow the file was read:\n  {}\n", fmt::join(how, "\n  "));
}

std::string placed_words(const effects::PlacedEffect& e) {
  if (e.effect->place && !e.leg && e.effect->scope == effects::Scope::machine) return e.effect->name;  // says where
  return fmt::format("{} ({})", e.effect->name, effects::site_of(e));
}

std::string fitted_words(const diagnosis::Hypothesis& h, const diagnosis::Fit& f) {
  const std::vector<const effects::EffectParameter*> all = diagnosis::parameters_of(h);
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [low, high] = diagnosis::interval95(h, f, i);
    out += fmt::format("{}{} = {}", i ? ", " : "", all[i]->name, interval_words(f.values(as_index(i)), low, high));
  }
  return out;
}

std::string splitting_words(const diagnosis::Splitting& s) {
  const std::string& a = s.between.front();
  const std::string& b = s.between.back();
  const measurement::QuantityRow& row = measurement::row_of(s.quantity);
  const std::string size = fmt::format("{:.3g} {}", row.fine_per_SI * s.difference, row.fine);
  if (as_printed(s.deviations, 1) < 2)
    return fmt::format(
        "No single reading tried would tell {} from {} by two standard deviations of noise and tolerances; {} "
        "comes nearest ({}, {:.1f}).",
        a, b, s.reading, size, s.deviations);
  return fmt::format(
      "To tell {} from {}, read {}: the two differ by {} there, {:.1f} standard deviations of noise and "
      "tolerances.",
      a, b, s.reading, size, s.deviations);
}

Json mistakes_json(const std::vector<compare::RecordingMistake>& mistakes) {
  Json out = Json::array();
  for (const compare::RecordingMistake& m : mistakes)
    out.push_back({{"ids", m.ids}, {"sentence", m.sentence}, {"certain", m.certain}});
  return out;
}

}  // namespace deflect::report
