#include "validation/compare/residual_study.h"

#include <algorithm>

#include "analytic/model.h"
#include "msa/base/error.h"
#include "validation/measurement/configure_all.h"
#include "validation/parallel/cases.h"
#include "validation/prediction/prediction.h"

namespace deflect {
namespace {

/// Tangent compliance at T; contacts as under 1 N each way.
Matrix6 compliance_of(const Configuration& c) {
  const analytic::AnalyticModel model(c);
  Vector6 F = Vector6::Zero();
  if (!model.linear()) F.head<3>().setConstant(1);
  return model.compliance(model.solve(F));
}

void add_forces(ResidualStudy& s) {
  const std::vector<Reading>& readings = s.data->readings;
  s.force.resize(readings.size());
  s.heading.resize(readings.size());
  for (std::size_t p = 0; p < s.data->poses.size(); ++p) {
    std::vector<std::size_t> order = s.data->poses[p].readings;
    if (s.sequence)
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return readings[a].sequence < readings[b].sequence; });
    const auto sites = static_cast<Eigen::Index>(s.sites[p].size());
    VectorX before = VectorX::Zero(sites), heading = VectorX::Zero(sites);
    for (const std::size_t i : order) {
      VectorX f(sites);
      for (Eigen::Index k = 0; k < sites; ++k) f(k) = s.sites[p][static_cast<std::size_t>(k)].g.dot(readings[i].load);
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

ResidualStudy residual_study(const Mechanism& m, const Measurements& data, int threads, const Told& told) {
  ResidualStudy s;
  s.mechanism = &m;
  s.data = &data;
  s.machines = configure_all(m, data);
  s.values = measured_values(data);
  s.sequence =
      std::all_of(data.readings.begin(), data.readings.end(), [](const Reading& r) { return r.sequence.has_value(); });
  PredictionOptions o;
  o.threads = threads;
  o.progress = told;
  s.predicted = predict(m, s.machines, data, o);
  s.sites.resize(s.machines.size());
  s.compliance.resize(s.machines.size());
  for_each_case(s.machines.size(), 1, threads, [&](std::size_t p) {
    s.sites[p] = sites_of(s.machines[p]);
    s.compliance[p] = compliance_of(s.machines[p]);
  });
  add_forces(s);
  return s;
}

std::vector<Vector6> deformed_shape_of(const ResidualStudy& s, int threads, const Told& told) {
  if (s.mechanism->geometry != Geometry::linear) return {};
  PredictionOptions o;
  o.threads = threads;
  o.geometry = Geometry::finite;
  o.progress = told;
  try {
    std::vector<Vector6> shape = predict(*s.mechanism, s.machines, *s.data, o);
    for (std::size_t i = 0; i < shape.size(); ++i) shape[i] -= s.predicted[i];
    return shape;
  } catch (const NumericalError&) {  // a load beyond what the deformed shape carries
  } catch (const ModelError&) {      // it does not stand there
  }
  return {};
}

Vector6 deformed_shape_under(const ResidualStudy& s, std::size_t reading, const Vector6& load) {
  if (s.deformed_shape.empty()) return Vector6::Zero();
  const double size = s.machines.front().size;
  const auto squared = [size](const Vector6& F) {
    return F.head<3>().squaredNorm() + F.tail<3>().squaredNorm() / (size * size);
  };
  const double recorded = squared(s.data->readings[reading].load);
  return (recorded > 0 ? squared(load) / recorded : 0) * s.deformed_shape[reading];
}

}  // namespace deflect
