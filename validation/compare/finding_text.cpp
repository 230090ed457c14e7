#include "validation/compare/finding_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "msa/base/index.h"
#include "msa/base/number_words.h"
#include "validation/compare/exponents.h"
#include "validation/compare/slides.h"

namespace deflect::compare {
namespace {

std::string plus_minus(double value, double deviation, double scale, const char* unit) {
  return fmt::format("{} {}", plus_minus_words(scale * value, scale * deviation), unit);
}

std::string by_column(const Finding& f, double scale, const char* unit) {
  std::string out;
  for (std::size_t i = 0; i < f.columns.size(); ++i) {
    const auto k = as_index(i);
    out += fmt::format("{}{} {}", i ? ", " : "", f.columns[i], plus_minus(f.amplitude(k), f.deviation(k), scale, unit));
  }
  return out;
}

std::string sentence_from(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& p : parts) out += (out.empty() ? "" : "; ") + p;
  return out;
}

/// How much a site of this geometry yields in the pattern found, which grows as a root's or a guide's does across
/// slides.
double weight_of(const Finding& found, double mean_extension, const subject::Site& site) {
  if (found.id == PatternId::elastic_along_slides) return site.along;
  if (found.id != PatternId::elastic_across_slides) return 1;
  const double L = site.extension / mean_extension;
  double weight = 0, power = 1;
  for (Eigen::Index k = 0; k < found.amplitude.size(); ++k, power *= L) weight += found.amplitude(k) * power;
  return (1 - site.along) * weight / found.amplitude.cwiseAbs().maxCoeff();
}

/// Whether each site's own size of the same shape says more than a common one.
std::string alike(const Finding& found, const ResidualStudy& s, const statistics::Uncertainty& u, const VectorX& r,
                  const MatrixX& beside) {
  const std::vector<subject::Site>& sites = s.sites.front();
  if (sites.size() < 2) return "";
  const double mean = mean_extension(s);
  const auto shape = [&](std::size_t i, std::size_t k) {
    return weight_of(found, mean, s.sites[s.data->readings[i].pose][k]) * s.force[i](as_index(k));
  };
  const MatrixX own = statistics::rows_of(s.values, site_columns(s, shape));
  MatrixX both(r.size(), beside.cols() + found.shape.cols());
  both << beside, found.shape;
  const statistics::Regression spread = statistics::regress(u, r, own, both);
  const std::string p = digits_of(spread.p_value, 2);
  return std::stod(p) > 0.01 ? fmt::format("the same at all {} sites (p = {})", sites.size(), p)
                             : fmt::format("not the same at all sites (p = {})", p);
}

std::string elastic(const Finding& f, const ResidualStudy& s, const statistics::Uncertainty& u, const VectorX& r,
                    const MatrixX& beside) {
  std::vector<std::string> parts;
  const bool rotation = s.sites.front().front().rotation;
  const bool softer = f.columns.size() != 1 || f.amplitude(0) > 0;
  std::string first = softer ? "an elastic compliance is missing" : "the machine is stiffer than the model";
  if (f.id == PatternId::elastic_at) first += fmt::format(" at {} alone", f.site);
  if (f.id == PatternId::elastic_along_slides) first += " along the slides";
  if (f.id == PatternId::elastic_across_slides) first += " across the slides";
  if (f.columns.size() == 1)
    first += rotation
                 ? fmt::format(": {} under each moment", plus_minus(f.amplitude(0), f.deviation(0), 1e3, "µrad/Nmm"))
                 : fmt::format(": {}", plus_minus(f.amplitude(0), f.deviation(0), 1e6, "µm/N"));
  else if (f.id == PatternId::elastic_by_site)
    first += ": " + (rotation ? by_column(f, 1e3, "µrad/Nmm") : by_column(f, 1e6, "µm/N"));
  parts.push_back(first);
  const auto weight = [&, mean = mean_extension(s)](const subject::Site& site) { return weight_of(f, mean, site); };
  const statistics::Regressions regressions(u, r, beside);
  if (const auto p = force_exponent(s, regressions, weight); p && f.id != PatternId::elastic_at) {
    const double power = as_printed(p->value, 2), deviation = as_printed(p->deviation, 2);
    parts.push_back(fmt::format("odd in the load and {} (it grows as the force to the {:.2f} ± {:.2f})",
                                std::abs(power - 1) < 3 * deviation + 0.05 ? "proportional" : "not quite proportional",
                                power, deviation));
  }
  if (f.id != PatternId::elastic_at)
    if (const auto p = extension_exponent(s, regressions); p && f.id == PatternId::elastic_across_slides)
      parts.push_back(fmt::format("the excess grows as their length to the {:.1f} ± {:.1f}", p->value, p->deviation));
  if (f.id != PatternId::elastic_at && f.id != PatternId::elastic_by_site)
    if (const std::string same = alike(f, s, u, r, beside); !same.empty()) parts.push_back(same);
  return sentence_from(parts);
}

std::string power(const ResidualStudy& s, const statistics::Regressions& regressions) {
  const auto p = force_exponent(s, regressions, [](const subject::Site&) { return 1.0; });
  const bool less = !p || as_printed(p->value, 2) < 1;
  return fmt::format(
      "the misfit is odd in the load and grows {} than in proportion{}: {}", less ? "less" : "no less",
      p ? fmt::format(" (as the force to the {:.2f} ± {:.2f})", p->value, p->deviation) : "",
      less ? "a contact that stiffens under load" : "near a contact that stiffens under load, but not that alone");
}

/// "lvdt 3.1 ± 0.2 µm, F3 12 ± 1 N": each channel in units of its own.
std::string by_channel(const Finding& f, const ResidualStudy& s, const char* per) {
  std::string out;
  for (std::size_t i = 0; i < f.columns.size(); ++i)
    for (const measurement::SensorChannel& sensor : s.data->instruments.sensors) {
      if (sensor.name != f.columns[i]) continue;
      const measurement::QuantityRow& row = measurement::row_of(sensor.quantity);
      out +=
          fmt::format("{}{} {}{}", out.empty() ? "" : ", ", sensor.name,
                      plus_minus(f.amplitude(as_index(i)), f.deviation(as_index(i)), row.fine_per_SI, row.fine), per);
    }
  return out;
}

/// Patterns of a subject that is read by sensors alone; empty for the others.
std::string of_channels(const Finding& f, const ResidualStudy& s) {
  switch (f.id) {
    case PatternId::offset:
      return "every reading of a sensor is off alike, whatever the load: " + by_channel(f, s, "");
    case PatternId::drift:
      return "readings drift with time, over the sequence by " + by_channel(f, s, "");
    case PatternId::temperature:
      return "readings follow the temperature: " + by_channel(f, s, "/K");
    case PatternId::load_gain:
      return fmt::format(
          "all readings are {} than predicted by one factor, {}: the loads as recorded, or, where "
          "displacements are read, the modulus of everything",
          f.amplitude(0) > 0 ? "larger" : "smaller", plus_minus_words(1 + f.amplitude(0), f.deviation(0)));
    case PatternId::sensor_gain: {
      std::string out;
      for (std::size_t i = 0; i < f.columns.size(); ++i)
        out += fmt::format("{}{} {}", i ? ", " : "", f.columns[i],
                           plus_minus_words(1 + f.amplitude(as_index(i)), f.deviation(as_index(i))));
      return "each sensor reads a factor of its own of what is predicted: " + out;
    }
    default:
      return "";
  }
}

std::string of_machine(const Finding& f, const ResidualStudy& s, const statistics::Uncertainty& u, const VectorX& r,
                       const MatrixX& beside) {
  const bool rotation = !s.sites.front().empty() && s.sites.front().front().rotation;
  // Its sign is told by the words.
  const auto amplitude = [&](double scale, const char* unit) {
    return plus_minus(std::abs(f.amplitude(0)), f.deviation(0), scale, unit);
  };
  switch (f.id) {
    case PatternId::elastic:
    case PatternId::elastic_by_site:
    case PatternId::elastic_at:
    case PatternId::elastic_along_slides:
    case PatternId::elastic_across_slides:
      return elastic(f, s, u, r, beside);
    case PatternId::step:
      return fmt::format(
          "the misfit does not grow with the load: every site {} {} as soon as it is loaded, in the sense of its "
          "force: free travel",
          f.amplitude(0) > 0 ? "gives way by" : "holds back by",
          rotation ? amplitude(1e6, "µrad") : amplitude(1e6, "µm"));
    case PatternId::power:
      return power(s, statistics::Regressions(u, r, beside));
    case PatternId::one_sided:
      return fmt::format("the misfit is even in the load: sites give {} where they are {}, not in the other sense",
                         rotation ? amplitude(2e3, "µrad/Nmm") : amplitude(2e6, "µm/N"),
                         f.amplitude(0) > 0 ? "pulled" : "pushed");
    case PatternId::hysteresis:
      return "the misfit depends on the way the load was reached and lags behind it: hysteresis, friction";
    case PatternId::base_tilt:
      return fmt::format("the whole machine tilts under the load's moment about its base: {}; no single leg does this",
                         by_column(f, 1e3, "µrad/Nmm"));
    case PatternId::tool:
      return "the point measured moves against the platform: " + by_column(f, 1e6, "µm/N");
    case PatternId::weight:
      return fmt::format(
          "the misfit does not depend on the load and points where a constant force of {} {} would push: even",
          amplitude(1, "N"), f.amplitude(0) > 0 ? "downwards" : "upwards");
    case PatternId::offset:
      return "every reading is displaced alike, whatever pose and load: " + by_column(f, 1e6, "µm");
    case PatternId::drift:
      return "readings drift with time, over the sequence by " + by_column(f, 1e6, "µm");
    case PatternId::temperature:
      return "readings follow the temperature: " + by_column(f, 1e6, "µm/K");
    case PatternId::load_gain:
      return fmt::format(
          "all displacements are {} than predicted by one factor, {}: the modulus of everything, or the load cell's "
          "gain",
          f.amplitude(0) > 0 ? "larger" : "smaller", plus_minus_words(1 + f.amplitude(0), f.deviation(0)));
    case PatternId::load_axes:
      return "the misfit is perpendicular to the model's answer and not reciprocal: loads are recorded in axes turned "
             "by " +
             by_column(f, 1e3, "mrad") + ": misaligned";
    case PatternId::sensor_gain:  // of channels alone
      break;
    case PatternId::sensor_axes:
      return "the misfit is perpendicular to the displacement and not reciprocal: the sensor's axes are turned by " +
             by_column(f, 1e3, "mrad") + ": misaligned";
  }
  throw std::logic_error("a pattern without a sentence");
}

}  // namespace

std::string sentence_of(const Finding& f, const ResidualStudy& s, const statistics::Uncertainty& u, const VectorX& r,
                        const MatrixX& beside) {
  const std::string words = s.standing->has_tool_point() ? "" : of_channels(f, s);
  return words.empty() ? of_machine(f, s, u, r, beside) : words;
}

}  // namespace deflect::compare
