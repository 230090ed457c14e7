#include "validation/diagnosis/splitting.h"

#include <fmt/format.h>

#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/subject/trials.h"

namespace deflect::diagnosis {
namespace {

using measurement::Measurements;
using measurement::Reading;
using subject::Subject;

/// What is read at once: the displacement of T, then the sensors.
struct Channels {
  std::vector<std::string> names;
  std::vector<measurement::Quantity> quantities;
  std::vector<double> sigma;  ///< 0: not read, or of unknown noise
};

Channels channels_of(const Measurements& m, double sigma_u, double size) {
  Channels out;
  const Reading& r = m.readings.front();
  const double along = r.sigma_u.value_or(sigma_u), about = r.sigma_th.value_or(along / (0.1 * size));
  for (std::size_t i = 0; i < 6; ++i) {
    out.names.push_back(std::string(i < 3 ? "u" : "th") + "xyz"[i % 3]);
    out.quantities.push_back(measurement::displacement_quantity(i));
    out.sigma.push_back(!r.displacement[i] ? 0 : i < 3 ? along : about);
  }
  for (const measurement::SensorChannel& s : m.instruments.sensors) {
    out.names.push_back(s.name);
    out.quantities.push_back(s.quantity);
    out.sigma.push_back(s.sigma.value_or(0));
  }
  return out;
}

/// By row of the trial: what has changed since the row before; the first of each load is unloaded.
MatrixX changes(const std::vector<VectorX>& readings) {
  MatrixX out = MatrixX::Zero(std::ssize(readings), readings.front().size());
  for (Eigen::Index i = 1; i < out.rows(); ++i)
    if (i % subject::rows_of_a_load != 0) out.row(i) = (nth(readings, i) - nth(readings, i - 1)).transpose();
  return out;
}

/// The variance of those changes by the tolerances of the subject.
MatrixX variance_of_tolerances(const Subject& s, const Measurements& trial) {
  const auto deviations = s.stand(trial)->deviations(trial);
  const MatrixX drawn = changes(deviations->drawn().predict(trial));
  MatrixX out = MatrixX::Zero(drawn.rows(), drawn.cols());
  for (std::size_t k = 0; k < deviations->tolerances().size(); ++k)
    if (!deviations->tolerances()[k].pose) out += (changes(deviations->with(k)->predict(trial)) - drawn).cwiseAbs2();
  const double load = s.load_tolerance();  // each of these rows has one load
  return out + (load * load) * drawn.cwiseAbs2();
}

}  // namespace

std::optional<Splitting> splitting_reading(const Observations& o, const Measurements& data, const Tie& tie) {
  if (tie.rivals.size() < 2) return std::nullopt;
  const auto found = outcome_of([&]() -> std::optional<Splitting> {
    std::vector<Subject> both;
    for (std::size_t i = 0; i < 2; ++i)
      both.push_back(subject::instrumented(subject_with(o, tie.rivals[i].hypothesis, tie.rivals[i].fit.values)));
    const Measurements trial = subject::trial_readings(both.front(), data);
    if (trial.readings.empty()) return std::nullopt;
    const auto standing = both[0].stand(trial);
    const MatrixX difference =
        changes(standing->predict(trial)) - changes(both[1].stand(trial, standing.get())->predict(trial));
    const MatrixX variance = variance_of_tolerances(subject::instrumented(o.subject()), trial);
    const Channels channels = channels_of(trial, o.comparison().sigma_u, standing->size());
    Splitting best;
    for (Eigen::Index i = 1; i < difference.rows(); ++i)
      for (Eigen::Index k = 0; k < difference.cols(); ++k) {
        const double sigma = nth(channels.sigma, k);
        if (!(sigma > 0)) continue;
        const double size = std::abs(difference(i, k)), many = size / std::sqrt(2 * sigma * sigma + variance(i, k));
        if (!(many > best.deviations)) continue;
        const Eigen::Index step = i % subject::rows_of_a_load;
        const bool on = step == 1 || step == 3;
        best = {{},
                fmt::format("{} as {} {}", nth(channels.names, k), nth(trial.readings, i).notes.front(),
                            on ? "goes on" : "comes off"),
                nth(channels.quantities, k),
                size,
                many};
      }
    for (std::size_t i = 0; i < 2; ++i) best.between.push_back(tie.rivals[i].added().effect->name);
    if (best.reading.empty()) return std::nullopt;
    return best;
  });
  return found ? *found.value : std::nullopt;  // what cannot be predicted under these loads is not proposed
}

}  // namespace deflect::diagnosis
