#include "validation/fit/predicted.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::fit {
namespace {

using measurement::MeasuredValue;
using measurement::Measurements;
using subject::Subject;

/// Predictions as readings of all channels: of the named sensors or, without any, of the displacement of T.
void fill(Measurements& plan, const std::vector<VectorX>& predicted, bool tool_point) {
  for (std::size_t i = 0; i < plan.readings.size(); ++i) {
    measurement::Reading& r = plan.readings[i];
    r.sensors.assign(plan.instruments.sensors.size(), std::nullopt);
    for (std::size_t k = 0; k < r.sensors.size(); ++k) r.sensors[k] = predicted[i](as_index(6 + k));
    for (std::size_t k = 0; k < 6; ++k)
      if (tool_point || r.sensors.empty()) r.displacement[k] = predicted[i](as_index(k));
  }
}

std::vector<VectorX> by_theory(const subject::Standing& standing, const Measurements& plan, const theories::Theory& t,
                               Geometry geometry, const parallel::Work& work) {
  prediction::PredictionOptions o;
  o.theory = &t;
  o.geometry = geometry;
  return standing.predict(plan, o, work);
}

std::vector<VectorX> linear(const subject::Standing& standing, const Measurements& plan) {
  return by_theory(standing, plan, *theories::all_theories().front(), Geometry::linear, parallel::alone);
}

/// Tolerances and the deformed shape at the plan: those that the fit knows, in its order, and others. `without`: the
/// subject without the effects that were fitted, if any were.
struct Tolerances {
  MatrixX known, other;  // measured numbers × tolerances
  VectorX own;           // variance by the pose's own
  std::vector<statistics::GroupColumns> groups;
};

Tolerances tolerances_of(const Subject& s, const subject::Standing& standing, const Measurements& plan,
                         const std::vector<MeasuredValue>& values, const VectorX& shape,
                         const std::optional<Knowledge>& fit, const subject::Standing* without,
                         const parallel::Work& work) {
  const statistics::ToleranceModel model = statistics::tolerance_model(standing, plan, values, work);
  const double scale = fit ? fit->tolerance_scale : 1;
  std::vector<std::string> names = fit ? fit->tolerances : std::vector<std::string>();
  std::vector<bool> taken(names.size());
  const auto n = std::ssize(values);
  Tolerances out{MatrixX::Zero(n, std::ssize(names)), MatrixX(n, 0), VectorX::Zero(n), model.A.groups};
  std::vector<std::size_t> replaced =
      fit ? replaced_tolerances(s, fit->parameters, model.nuisances) : std::vector<std::size_t>();
  if (without)
    for (const std::size_t i :
         added_tolerances(statistics::tolerance_model(*without, plan, values, work).nuisances, model.nuisances))
      replaced.push_back(i);
  const auto put = [&](const std::string& name, const VectorX& column) {
    for (std::size_t k = 0; k < names.size(); ++k)
      if (!taken[k] && names[k] == name) {
        out.known.col(as_index(k)) = column;
        taken[k] = true;
        return;
      }
    out.other.conservativeResize(Eigen::NoChange, out.other.cols() + 1);
    out.other.rightCols<1>() = column;
  };
  for (std::size_t k = 0; k < as_size(model.A.shared.cols()); ++k) {
    const bool counts = !model.nuisances[k].zero && std::find(replaced.begin(), replaced.end(), k) == replaced.end();
    if (counts) put(model.nuisances[k].name, scale * model.A.shared.col(as_index(k)));
  }
  put("deformed shape", compare::shape_known_to * shape);
  for (statistics::GroupColumns& group : out.groups) {
    group.columns *= scale;
    for (std::size_t i = 0; i < group.rows.size(); ++i)
      out.own(group.rows[i]) += group.columns.row(as_index(i)).squaredNorm();
  }
  return out;
}

/// Variances of P δ + A η in two parts, and their mean.
struct Joint {
  VectorX mean, parameters, tolerances;
  statistics::PartedColumns root;
};

Joint joint_of(const MatrixX& P, const Tolerances& A, const std::optional<Knowledge>& fit) {
  const auto n = A.own.size();
  Joint out{VectorX::Zero(n), VectorX::Zero(n), A.other.rowwise().squaredNorm() + A.own, A.other};
  out.root.groups = A.groups;
  if (!fit) return out;
  const Eigen::Index k = P.cols(), m = A.known.cols();
  const MatrixX& C = fit->posterior.covariance;
  const MatrixX of_parameters = C.topLeftCorner(k, k), cross = C.bottomLeftCorner(m, k);
  const MatrixX given = C.bottomRightCorner(m, m) - cross * of_parameters.ldlt().solve(cross.transpose());
  MatrixX columns(n, k + m);
  columns << P, A.known;
  out.mean = columns * fit->posterior.mean;
  const VectorX both = (columns * C).cwiseProduct(columns).rowwise().sum();
  const VectorX tolerances = (A.known * given).cwiseProduct(A.known).rowwise().sum().cwiseMax(0);
  const MatrixX L = C.llt().matrixL();
  out.root.shared = statistics::side_by_side({A.other, columns * L}, n);
  out.parameters = (both - tolerances).cwiseMax(0);
  out.tolerances += tolerances;
  return out;
}

std::optional<double> noise_of(const Measurements& plan, const MeasuredValue& v, const std::optional<Knowledge>& fit,
                               const PredictedPlanOptions& o) {
  if (!v.of_tool_point())
    if (const auto sigma = plan.instruments.sensors[v.channel - 6].sigma) return sigma;
  if (fit)
    for (const auto& [quantity, sigma] : fit->sigma)
      if (quantity == v.quantity) return sigma;
  if (v.quantity == measurement::Quantity::length) return o.sigma_u;
  if (v.quantity == measurement::Quantity::angle) return o.sigma_th;
  return std::nullopt;
}

/// Of each quantity. What was not read may lack as much as the worst of what was.
class KnownDiscrepancies {
 public:
  KnownDiscrepancies(const std::optional<Knowledge>& fit, const PredictedPlanOptions& o)
      : all_(o.discrepancies.empty() && fit ? fit->discrepancies : o.discrepancies) {}

  double share(measurement::Quantity quantity) {
    double worst = 0;
    for (const Discrepancy& d : all_) {
      if (d.quantity == quantity) return d.share;
      worst = std::max(worst, d.share);
    }
    if (worst > 0 && std::find(not_read_.begin(), not_read_.end(), quantity) == not_read_.end())
      not_read_.push_back(quantity);
    return worst;
  }
  const std::vector<measurement::Quantity>& not_read() const { return not_read_; }

 private:
  std::vector<Discrepancy> all_;
  std::vector<measurement::Quantity> not_read_;
};

}  // namespace

double Shares::of_prediction() const {
  return std::sqrt(parameters * parameters + tolerances * tolerances + load * load + discrepancy * discrepancy);
}
double Shares::of_reading() const { return std::hypot(of_prediction(), noise); }

PredictedPlan predict(const Subject& given, const Measurements& plan, const std::optional<Knowledge>& fit,
                      const PredictedPlanOptions& o, const parallel::Work& work) {
  const Subject s = fit ? with_values(given, fit->parameters, fit->values) : given;
  PredictedPlan out{s.name(), plan, o.theories, fit.has_value(), true, {}, {}};
  if (s.frame()) out.theories = {&theories::theory("msa")};
  out.plan.instruments.sensors = s.instruments().sensors;
  const auto standing = s.stand(out.plan);
  std::vector<std::vector<VectorX>> all;
  for (const theories::Theory* t : out.theories)
    all.push_back(by_theory(*standing, out.plan, *t, s.true_geometry(), work));
  fill(out.plan, all.front(), o.tool_point && !s.frame());
  const std::vector<MeasuredValue> values = measurement::measured_values(out.plan, standing->sensor_forms(out.plan));
  const VectorX predicted = statistics::rows_of(values, all.front());
  const VectorX shape = predicted - statistics::rows_of(values, linear(*standing, out.plan));
  MatrixX P(predicted.size(), 0);
  const Subject numbers = fit ? with_numbers(given, fit->parameters, fit->values) : given;
  if (fit)
    P = derivatives(numbers, in_version(fit->parameters, fit->values), fit->values, [&](const Subject& moved) {
      return statistics::rows_of(values, linear(*moved.stand(out.plan, standing.get()), out.plan));
    });
  const auto without = fit && has_effects(fit->parameters) ? numbers.stand(out.plan) : nullptr;
  Joint joint = joint_of(P, tolerances_of(s, *standing, out.plan, values, shape, fit, without.get(), work), fit);
  out.errors = std::move(joint.root);
  const statistics::LoadErrors load_errors(s, *standing, out.plan, all.front());
  KnownDiscrepancies discrepancies(fit, o);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto row = as_index(i);
    const MeasuredValue& v = values[i];
    PredictedNumber number{v.reading, v.channel, v.quantity, {}, predicted(row) + joint.mean(row), {}, 0, 0};
    for (const std::vector<VectorX>& each : all) number.by_theory.push_back(each[v.reading](as_index(v.channel)));
    const std::optional<double> noise = noise_of(out.plan, v, fit, o);
    out.noise_known = out.noise_known && noise;
    number.deviation = {std::sqrt(joint.parameters(row)), std::sqrt(joint.tolerances(row)), load_errors.deviation(v),
                        discrepancies.share(v.quantity) * size_of_prediction(values, predicted, v.reading, v.quantity),
                        noise.value_or(0)};
    const double half = normal95 * number.deviation.of_reading();
    number.low = number.value - half, number.high = number.value + half;
    out.numbers.push_back(std::move(number));
  }
  out.discrepancy_of_others = discrepancies.not_read();
  return out;
}

}  // namespace deflect::fit
