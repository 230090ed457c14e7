#include "validation/diagnosis/observations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/error.h"
#include "validation/compare/outliers.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/prediction.h"

namespace deflect {
namespace {

constexpr double shape_known_to = 0.2;

std::vector<bool> set_aside_by(const Comparison& c) {
  std::vector<bool> aside(c.readings, false);
  const std::set<std::size_t> lines(c.set_aside.begin(), c.set_aside.end());
  for (std::size_t i = 0; i < c.readings; ++i) aside[i] = lines.contains(c.study.data->readings[i].line);
  return aside;
}

Uncertainty uncertainty_of(const Comparison& c, const PartedColumns& A, const std::vector<bool>& aside) {
  return Uncertainty(A, c.study.values, c.sigma, c.study.predicted, c.study.mechanism->tolerances.load, aside);
}

}  // namespace

Observations::Observations(const Mechanism& m, const Measurements& data, const ComparisonOptions& o)
    : device_(&m),
      comparison_(compare(m, data, o)),
      patterns_(discrepancy_families(comparison_.study)),
      threads_(o.threads),
      A_(comparison_.tolerances.A),
      aside_(set_aside_by(comparison_)),
      uncertainty_(uncertainty_of(comparison_, A_, aside_)) {
  const ResidualStudy& s = comparison_.study;
  measured_ = comparison_.residual + rows_of(s.values, s.predicted);
  shape_ = s.deformed_shape.empty() ? VectorX(VectorX::Zero(measured_.size())) : rows_of(s.values, s.deformed_shape);
  tolerance_scale_ = uncertainty_.scale_of_tolerances(residual(m), patterns_.front().shared);
  A_ *= tolerance_scale_;
  A_.shared.conservativeResize(Eigen::NoChange, A_.shared.cols() + 1);
  count_shape();
  weigh(aside_);
}

void Observations::count_shape() { A_.shared.rightCols<1>() = shape_known_to * shape_; }

void Observations::weigh(const std::vector<bool>& aside) {
  aside_ = aside;
  uncertainty_ = uncertainty_of(comparison_, A_, aside_);
  held_out_.emplace(comparison_.study, uncertainty_, aside_);
  whitened_patterns_.reset();
  null_ = whitened_residual(*device_);
}

std::shared_ptr<const WhitenedFamilies> Observations::whitened_patterns() {
  if (!whitened_patterns_)
    whitened_patterns_ = std::make_shared<const WhitenedFamilies>(patterns_, uncertainty_.whitening(), threads_);
  return whitened_patterns_;
}

std::size_t Observations::set_aside() const {
  return static_cast<std::size_t>(std::count(aside_.begin(), aside_.end(), true));
}

VectorX Observations::residual(const Mechanism& m) const {
  const ResidualStudy& s = comparison_.study;
  PredictionOptions o;
  o.geometry = Geometry::linear;
  o.threads = 1;
  return measured_ - shape_ - rows_of(s.values, predict(m, configure_all(m, *s.data), *s.data, o));
}

VectorX Observations::whitened_residual(const Mechanism& m) const { return uncertainty_.whitened(residual(m)); }

double Observations::rmse(const Mechanism& m) const {
  return rms_of_kept(comparison_.study.values, residual(m), aside_);
}

double Observations::held_out_rmse(const Mechanism& m) const { return held_out_->rmse(residual(m)); }

std::vector<std::pair<std::string, double>> Observations::strained(const Mechanism& m) const {
  const VectorX eta = uncertainty_.nuisances(residual(m));
  const Eigen::Index shape = A_.shared.cols() - 1;  // between the tolerances of all poses and those of each
  std::vector<std::pair<std::string, double>> out;
  const auto look_at = [&](const std::string& name, double deviations) {
    if (std::abs(deviations) > 2) out.emplace_back(name, deviations);
  };
  for (Eigen::Index i = 0; i < eta.size(); ++i)
    if (i != shape)
      look_at(comparison_.tolerances.nuisances[static_cast<std::size_t>(i < shape ? i : i - 1)].name,
              tolerance_scale_ * eta(i));
  look_at("the deformed shape", eta(shape));
  return out;
}

void Observations::take_for_granted(const Mechanism& m) {
  const ResidualStudy& s = comparison_.study;
  const std::vector<Configuration> machines = configure_all(m, *s.data);
  PredictionOptions linear, finite;
  linear.geometry = Geometry::linear;
  finite.geometry = Geometry::finite;
  try {
    shape_ = rows_of(s.values, predict(m, machines, *s.data, finite)) -
             rows_of(s.values, predict(m, machines, *s.data, linear));
  } catch (const NumericalError&) {  // beyond what the deformed shape carries: the one known stays
  } catch (const ModelError&) {      // it does not stand in the deformed shape
  }
  count_shape();
  const std::vector<bool> aside = gross_outliers(s, A_, comparison_.sigma, residual(m), {}).aside;
  const auto count = static_cast<std::size_t>(std::count(aside.begin(), aside.end(), true));
  weigh(20 * count <= aside.size() ? aside : aside_);
}

}  // namespace deflect
