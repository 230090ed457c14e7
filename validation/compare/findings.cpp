#include "validation/compare/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/index.h"
#include "validation/compare/errors_by_group.h"
#include "validation/compare/finding_text.h"
#include "validation/compare/slides.h"
#include "validation/parallel/cases.h"

namespace deflect::compare {
namespace {

constexpr double least_score = 10, close_call = 10, least_p = 1e-4;
constexpr std::size_t most_findings = 4;

struct Candidate {
  PatternId id;
  std::string site;  // of a single one
  std::vector<std::string> names;
  std::string unit;
  MatrixX columns;
  bool is_pattern = false;  // of the list, in its order

  std::string name() const { return site.empty() ? row_of(id).name : fmt::format("{} {}", row_of(id).name, site); }
};

/// What one site alone can do: yield along its line; where it has a slide, along this, across it, and across as a bent
/// guide does.
void add_single_sites(const ResidualStudy& s, const Pattern& p, const MatrixX& columns, std::vector<Candidate>& out) {
  const bool slides = has_slides(s);
  const double mean = mean_extension(s);
  for (std::size_t site = 0; site < p.columns.size(); ++site) {
    const auto only = [&](const auto& e) {
      return rows_of_sites(s, [&](std::size_t reading, std::size_t k) {
        return k == site ? e(s.sites[s.data->readings[reading].pose][k]) * s.force[reading](as_index(k)) : 0.0;
      });
    };
    Candidate c{PatternId::elastic_at, p.columns[site], {p.columns[site]}, p.unit, columns.col(as_index(site))};
    if (slides) {
      c.columns.resize(Eigen::NoChange, 3);
      c.columns.col(0) = only([](const subject::Site& x) { return x.along; });
      c.columns.col(1) = only([](const subject::Site& x) { return 1 - x.along; });
      c.columns.col(2) = only([&](const subject::Site& x) { return (1 - x.along) * std::pow(x.extension / mean, 3); });
      c.names = {"along its slide", "across", "across, as L^3"};
    }
    out.push_back(std::move(c));
  }
}

/// The patterns; elastic ones along and across slides; and the elastic one of each site alone.
std::vector<Candidate> candidates_of(const ResidualStudy& s, const std::vector<Pattern>& patterns,
                                     const std::vector<MatrixX>& columns) {
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    const Pattern& p = patterns[i];
    if (p.id == PatternId::elastic_by_site) add_single_sites(s, p, columns[i], out);
    out.push_back({p.id, "", p.columns, p.unit, columns[i], true});
    if (p.id == PatternId::elastic && has_slides(s)) {
      out.push_back({PatternId::elastic_along_slides, "", {"all"}, p.unit, elastic_along(s)});
      const int powers = varies_in_extension(s) ? 4 : 1;  // a carriage, its guide's clamp tilting, the guide bending
      MatrixX across(columns[i].rows(), powers);
      std::vector<std::string> names;
      for (int power = 0; power < powers; ++power) {
        names.push_back(fmt::format("L^{}", power));
        across.col(power) = elastic_across(s, power);
      }
      out.push_back({PatternId::elastic_across_slides, "", names, p.unit, across});
    }
  }
  return out;
}

MatrixX joined(const MatrixX& a, const MatrixX& b) {
  MatrixX out(b.rows(), a.cols() + b.cols());
  if (a.cols() > 0) out.leftCols(a.cols()) = a;
  out.rightCols(b.cols()) = b;
  return out;
}

/// Whitened, by candidate.
std::vector<MatrixX> whitened_columns(const std::vector<Candidate>& candidates, const statistics::Uncertainty& u) {
  std::vector<MatrixX> out(candidates.size());
  parallel::for_each_case(out.size(), 1, u.threads(),
                          [&](std::size_t i) { out[i] = u.whitened(candidates[i].columns); });
  return out;
}

std::vector<statistics::Regression> fits_of(const statistics::Regressions& regressions,
                                            const std::vector<MatrixX>& whitened) {
  std::vector<statistics::Regression> out(whitened.size());
  parallel::for_each_case(out.size(), 1, regressions.threads(),
                          [&](std::size_t i) { out[i] = regressions.on_whitened(whitened[i]); });
  return out;
}

}  // namespace

Findings find_patterns(const ResidualStudy& s, const statistics::Uncertainty& u, const VectorX& r,
                       const std::vector<Pattern>& patterns, const std::vector<MatrixX>& columns, bool in_words) {
  const std::vector<Candidate> candidates = candidates_of(s, patterns, columns);
  const double penalty = std::log(static_cast<double>(s.data->readings.size()));
  const double chi2 = u.inner(r, r)(0, 0), freedoms = static_cast<double>(u.count());
  Findings out;
  out.columns = MatrixX(r.size(), 0);
  out.chi2_left = chi2;
  const std::vector<MatrixX> whitened = whitened_columns(candidates, u);
  std::vector<bool> found(candidates.size(), false);  // beside what it all but follows from, rounding of one is left
  while (out.findings.size() < most_findings) {
    const std::vector<statistics::Regression> fits = fits_of(statistics::Regressions(u, r, out.columns), whitened);
    if (out.alone.empty())
      for (std::size_t i = 0; i < fits.size(); ++i)
        if (candidates[i].is_pattern) out.alone.push_back(fits[i]);
    std::vector<double> scores;
    for (std::size_t i = 0; i < fits.size(); ++i)
      scores.push_back(found[i] ? -std::numeric_limits<double>::infinity() : fits[i].gain - penalty * fits[i].freedoms);
    const auto best = as_size(std::max_element(scores.begin(), scores.end()) - scores.begin());
    const Candidate& c = candidates[best];
    const statistics::Regression& fit = fits[best];
    if (scores[best] < least_score || fit.p_value * static_cast<double>(candidates.size()) > least_p) break;
    found[best] = true;
    Finding f;
    f.id = c.id;
    f.pattern = c.name();
    f.site = c.site;
    f.columns = c.names;
    f.unit = c.unit;
    f.amplitude = fit.amplitude;
    f.deviation = fit.covariance.diagonal().cwiseMax(0).cwiseSqrt();
    f.gain = fit.gain;
    f.freedoms = fit.freedoms;
    f.p_value = fit.p_value;
    f.size = rms_of_errors(s.values, c.columns * fit.amplitude);
    f.share = fit.gain / std::max(chi2 - freedoms, fit.gain);
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (i != best && scores[i] > scores[best] - close_call && scores[i] > 0)
        f.instead.push_back(candidates[i].name());
    f.shape = c.columns;
    if (in_words) f.sentence = sentence_of(f, s, u, r, out.columns);
    out.columns = joined(out.columns, c.columns);
    out.findings.push_back(std::move(f));
  }
  // Of all together: one by one, gains of patterns that are nearly alike add up to more than there is.
  if (!out.findings.empty()) out.chi2_left = std::max(0.0, chi2 - statistics::Regressions(u, r).on(out.columns).gain);
  return out;
}

}  // namespace deflect::compare
