#include "validation/compare/residual_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/open_play.h"

namespace deflect::compare {
namespace {

/// A load that does nothing at the site leaves rounding: a joint whose axis it meets.
double force_at(const subject::Site& site, const Vector6& load) {
  constexpr double rounding = 1e-12;
  const double f = site.g.dot(load);
  return std::abs(f) > rounding * site.g.norm() * load.norm() ? f : 0;
}

void add_forces(ResidualStudy& s) {
  const std::vector<measurement::Reading>& readings = s.data->readings;
  s.force.resize(readings.size());
  s.heading.resize(readings.size());
  for (std::size_t p = 0; p < s.data->poses.size(); ++p) {
    std::vector<std::size_t> order = s.data->poses[p].readings;
    if (s.sequence)
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return readings[a].sequence < readings[b].sequence; });
    const auto sites = std::ssize(s.sites[p]);
    VectorX before = VectorX::Zero(sites), heading = VectorX::Zero(sites);
    for (const std::size_t i : order) {
      VectorX f(sites);
      for (Eigen::Index k = 0; k < sites; ++k) f(k) = force_at(nth(s.sites[p], k), readings[i].load);
      // Nothing is driven in a flexure or a load cell: there are no sites.
      const double small = sites > 0 ? 1e-9 * (f.cwiseAbs().maxCoeff() + before.cwiseAbs().maxCoeff()) : 0;
      for (Eigen::Index k = 0; k < sites; ++k)
        if (const double change = f(k) - before(k); std::abs(change) > small) heading(k) = change > 0 ? 1 : -1;
      s.force[i] = f;
      s.heading[i] = heading;
      before = f;
    }
  }
}

}  // namespace

ResidualStudy residual_study(const subject::Subject& subject, const measurement::Measurements& data,
                             const parallel::Work& work) {
  ResidualStudy s;
  s.subject = subject;
  s.data = &data;
  s.standing = subject.stand(data);
  s.loads = measurement::loads_of(data);
  s.values = measurement::measured_values(data, s.standing->sensor_forms(data));
  if (s.values.empty())
    throw InputError(fmt::format("{}: no reading holds a number: fill in what was measured", data.origin));
  s.sequence = std::all_of(data.readings.begin(), data.readings.end(),
                           [](const measurement::Reading& r) { return r.sequence.has_value(); });
  prediction::Predicted predicted = s.standing->predicted(data, {}, work);
  s.predicted = std::move(predicted.readings);
  s.load_errors = {subject, *s.standing, data, s.predicted};
  statistics::take_off_load_errors(s.values, s.load_errors, data);
  s.floating = std::move(predicted.floating);
  if (!s.floating.at_readings.empty()) s.open_play = statistics::open_play(*s.standing, data);
  const std::size_t poses = s.standing->poses();
  s.sites.resize(poses);
  s.compliance.resize(poses);
  parallel::for_each_case(poses, 1, work.threads, [&](std::size_t p) {
    s.sites[p] = s.standing->sites(p);
    s.compliance[p] = s.standing->compliance(p);
  });
  add_forces(s);
  return s;
}

std::vector<VectorX> deformed_shape_of(const ResidualStudy& s, const parallel::Work& work) {
  if (s.subject->geometry() != Geometry::linear || s.subject->true_geometry() == Geometry::linear) return {};
  prediction::PredictionOptions o;
  o.geometry = s.subject->true_geometry();
  // A load may be beyond what the deformed shape carries, or the subject does not stand in it.
  const auto finite = outcome_of([&] { return s.standing->predict(*s.data, o, work); });
  std::vector<VectorX> shape = finite.value.value_or(std::vector<VectorX>());
  for (std::size_t i = 0; i < shape.size(); ++i) shape[i] -= s.predicted[i];
  return shape;
}

VectorX deformed_shape_under(const ResidualStudy& s, std::size_t reading, const Vector6& load) {
  if (s.deformed_shape.empty()) return VectorX::Zero(s.predicted[reading].size());
  const double size = s.standing->size();
  const auto squared = [size](const Vector6& F) {
    return F.head<3>().squaredNorm() + F.tail<3>().squaredNorm() / (size * size);
  };
  const double recorded = squared(s.data->readings[reading].load);
  return (recorded > 0 ? squared(load) / recorded : 0) * s.deformed_shape[reading];
}

}  // namespace deflect::compare
