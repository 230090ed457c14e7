#include "validation/compare/residual_study.h"

#include <algorithm>

#include "analytic/model.h"
#include "msa/base/error.h"
#include "validation/compare/prediction.h"
#include "validation/measurement/configure_all.h"
#include "validation/parallel/cases.h"

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
  o.progress = part_of(told, 0, 0.1);
  s.predicted = predict(m, s.machines, data, o);
  if (m.geometry == Geometry::linear) try {
      Mechanism true_axes = m;  // the difference is small: what the rig does to it does not count
      o.geometry = Geometry::finite;
      o.progress = part_of(told, 0.1, 1);
      s.deformed_shape = predict(true_axes, s.machines, data, o);
      for (std::size_t i = 0; i < s.deformed_shape.size(); ++i) s.deformed_shape[i] -= s.predicted[i];
    } catch (const NumericalError&) {
      s.deformed_shape.clear();  // a load beyond what the deformed shape carries
    } catch (const ModelError&) {
      s.deformed_shape.clear();  // it does not stand there
    }
  s.sites.resize(s.machines.size());
  s.compliance.resize(s.machines.size());
  for_each_case(s.machines.size(), 1, threads, [&](std::size_t p) {
    s.sites[p] = sites_of(s.machines[p]);
    s.compliance[p] = compliance_of(s.machines[p]);
  });
  add_forces(s);
  return s;
}

}  // namespace deflect
