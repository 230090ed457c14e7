#include "validation/diagnosis/observations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/compare/outliers.h"
#include "validation/statistics/open_play.h"

namespace deflect::diagnosis {
namespace {

std::vector<bool> set_aside_by(const compare::Comparison& c) {
  std::vector<bool> aside(c.readings, false);
  const std::set<std::size_t> lines(c.set_aside.begin(), c.set_aside.end());
  for (std::size_t i = 0; i < c.readings; ++i) aside[i] = lines.contains(c.study.data->readings[i].line);
  return aside;
}

std::shared_ptr<const statistics::Uncertainty> uncertainty_of(const compare::Comparison& c,
                                                              const statistics::PartedColumns& A,
                                                              const statistics::LoadErrors& loads,
                                                              const std::vector<bool>& aside) {
  return std::make_shared<const statistics::Uncertainty>(A, c.study.values, c.sigma, loads, aside);
}

prediction::Predicted in_linear_geometry(const compare::ResidualStudy& s, const subject::Standing& standing) {
  prediction::PredictionOptions linear;
  linear.geometry = Geometry::linear;
  return standing.predicted(*s.data, linear, parallel::alone);
}

/// What equilibrium in the deformed shape adds to what `linear` predicts of a subject's readings; nothing where it does
/// not stand in it.
std::optional<VectorX> deformed_shape_of(const compare::ResidualStudy& s, const subject::Subject& subject,
                                         const VectorX& linear, prediction::PredictionOptions finite = {}) {
  if (subject.true_geometry() == Geometry::linear) return std::nullopt;
  finite.geometry = subject.true_geometry();
  return outcome_of([&] {
           return VectorX(
               statistics::rows_of(s.values, subject.stand(*s.data, s.standing.get())->predict(*s.data, finite)) -
               linear);
         })
      .value;
}

/// The last shared column becomes that of the deformed shape. Where play stands in the deformed shape is a yes or no
/// that a fifth of the shape does not change.
std::shared_ptr<const statistics::PartedColumns> beside_shape(statistics::PartedColumns A, const VectorX& bent) {
  A.shared.rightCols<1>() = compare::shape_known_to * bent;
  return std::make_shared<const statistics::PartedColumns>(std::move(A));
}

/// Whether so many readings may be set aside as gross outliers: one in twenty, but of a few readings one as well.
bool are_few(const std::vector<bool>& aside) {
  const auto count = as_size(std::count(aside.begin(), aside.end(), true));
  return 20 * count <= aside.size() || (count == 1 && aside.size() >= 10);
}

}  // namespace

Observations::Observations(const subject::Subject& subject, const measurement::Measurements& data,
                           const compare::ComparisonOptions& o, const parallel::Work& work,
                           std::optional<double> tolerance_scale)
    : subject_(subject),
      comparison_(std::make_shared<const compare::Comparison>(compare::compare(subject, data, o, work))),
      threads_(work.threads),
      aside_(set_aside_by(*comparison_)),
      load_errors_(std::make_shared<const statistics::LoadErrors>(comparison_->study.load_errors)),
      uncertainty_(uncertainty_of(*comparison_, comparison_->tolerances.A, *load_errors_, aside_)) {
  const compare::ResidualStudy& s = comparison_->study;
  measured_ = comparison_->residual + statistics::rows_of(s.values, s.predicted);
  in_linear_ = statistics::rows_of(s.values, s.predicted);
  shape_ = VectorX::Zero(measured_.size());
  floating_ = s.floating;
  if (!s.deformed_shape.empty()) shape_ = statistics::rows_of(s.values, s.deformed_shape);
  if (subject.geometry() != Geometry::linear) {  // the shape is in what the comparison predicts
    shape_ = in_linear_;
    Linear own = linear(subject);
    floating_ = std::move(own.floating);
    in_linear_ = std::move(own.values);
    shape_ -= in_linear_;
  }
  bent_ = bent_of(subject);
  tolerance_scale_ =
      tolerance_scale ? *tolerance_scale : uncertainty_->scale_of_tolerances(residual(subject), site_patterns(s));
  statistics::PartedColumns A = comparison_->tolerances.A;
  A *= tolerance_scale_;
  A.shared.conservativeResize(Eigen::NoChange, A.shared.cols() + 1);
  A_ = beside_shape(std::move(A), bent_);
  weigh(aside_);
}

std::vector<double> Observations::log_likelihood_of_scales(const subject::Subject& subject,
                                                           const std::vector<double>& scales) const {
  std::vector<Eigen::Index> free;
  const std::vector<subject::Tolerance>& all = comparison_->tolerances.nuisances;
  for (Eigen::Index i = 0; i + 1 < A_->shared.cols(); ++i)
    if (nth(all, i).zero) free.push_back(i);
  free.push_back(A_->shared.cols() - 1);  // of the deformed shape
  return uncertainty_->log_likelihood_of_scales(residual(subject), MatrixX(measured_.size(), 0), scales, free);
}

VectorX Observations::bent_of(const subject::Subject& subject) const {
  if (floating_.at_readings.empty()) return shape_;
  prediction::PredictionOptions apart;
  apart.apart = true;
  return deformed_shape_of(comparison_->study, subject, in_linear_, apart).value_or(shape_);
}

void Observations::move_tolerances(const subject::Subject& subject) {
  const compare::ResidualStudy& s = comparison_->study;
  auto moved = outcome_of([&] {
    return statistics::tolerance_model(*subject.stand(*s.data, s.standing.get()), *s.data, s.values, {threads_});
  });
  if (!moved || moved->A.groups.size() != A_->groups.size()) return;
  // A law that an effect adds may have numbers to which a tolerance applies: these are fitted. They come behind those
  // of the laws that were there, by the same name.
  const Eigen::Index shared = A_->shared.cols();
  std::vector<Eigen::Index> same;
  for (Eigen::Index i = 0; i < moved->A.shared.cols() && std::ssize(same) + 1 < shared; ++i)
    if (nth(moved->nuisances, i).name == comparison_->tolerances.nuisances[same.size()].name) same.push_back(i);
  if (std::ssize(same) + 1 != shared) return;
  statistics::PartedColumns A = std::move(moved->A);
  A.shared = MatrixX(A.shared(Eigen::all, same));
  A *= tolerance_scale_;
  A.shared.conservativeResize(Eigen::NoChange, shared);
  A_ = beside_shape(std::move(A), bent_);
}

void Observations::weigh(const std::vector<bool>& aside) {
  aside_ = aside;
  uncertainty_ = uncertainty_of(*comparison_, *A_, *load_errors_, aside_);
  held_out_.emplace(comparison_->study, *uncertainty_, aside_);
  null_ = whitened_residual(subject_);
}

std::shared_ptr<const WhitenedFamilies> Observations::whitened_patterns() const {
  return std::make_shared<const WhitenedFamilies>(discrepancy_families(comparison_->study), uncertainty_->whitening(),
                                                  threads_);
}

std::size_t Observations::set_aside() const { return as_size(std::count(aside_.begin(), aside_.end(), true)); }

std::shared_ptr<const subject::Standing> Observations::stand(const subject::Subject& subject) const {
  return subject.stand(*comparison_->study.data, comparison_->study.standing.get());
}

Observations::Linear Observations::linear(const subject::Subject& subject) const {
  const compare::ResidualStudy& s = comparison_->study;
  prediction::Predicted found = in_linear_geometry(s, *stand(subject));
  return {statistics::rows_of(s.values, found.readings), std::move(found.floating)};
}

VectorX Observations::residual(const subject::Subject& subject) const {
  if (!true_geometry_) {
    const Linear l = linear(subject);
    return measured_ - shape_beside(l, subject) - l.values;
  }
  return residual_in_shape(subject, {});
}

VectorX Observations::residual_in_shape(const subject::Subject& subject, const std::vector<bool>& only) const {
  const compare::ResidualStudy& s = comparison_->study;
  prediction::PredictionOptions finite;
  finite.geometry = subject.true_geometry();
  finite.only = only;
  return measured_ - statistics::rows_of(s.values, stand(subject)->predict(*s.data, finite, parallel::alone));
}

VectorX Observations::shape_for(const subject::Subject& subject) const {
  return subject.true_geometry() == Geometry::linear ? shape_ : shape_beside(linear(subject), subject);
}

VectorX Observations::shape_beside(const Linear& l, const subject::Subject& subject) const {
  if (l.floating.at_readings == floating_.at_readings) return shape_;
  const compare::ResidualStudy& s = comparison_->study;
  const auto open = [](const prediction::Floating& f, std::size_t i) {
    return f.at(i) ? f.at_readings[i] : std::set<std::string>();
  };
  prediction::PredictionOptions finite;
  for (std::size_t i = 0; i < s.data->readings.size(); ++i)
    finite.only.push_back(open(l.floating, i) != open(floating_, i));
  VectorX out = shape_;
  if (const auto own = deformed_shape_of(s, subject, l.values, finite))
    for (std::size_t k = 0; k < s.values.size(); ++k)
      if (finite.only[s.values[k].reading]) out(as_index(k)) = (*own)(as_index(k));
  return out;
}

bool Observations::has_history(const subject::Subject& subject) const { return stand(subject)->has_history(); }

VectorX Observations::whitened_residual(const subject::Subject& subject) const {
  return uncertainty_->whitened(residual(subject));
}

VectorX Observations::whitened_residual(const subject::Subject& subject, const VectorX& shape) const {
  if (true_geometry_) return whitened_residual(subject);
  return uncertainty_->whitened(measured_ - shape - linear(subject).values);
}

double Observations::rmse(const subject::Subject& subject) const {
  return compare::rms_of_kept(comparison_->study.values, from_zero(residual(subject)), aside_);
}

VectorX Observations::from_zero(VectorX residual) const {
  const std::vector<subject::Tolerance>& all = comparison_->tolerances.nuisances;
  if (std::none_of(all.begin(), all.end(), [](const subject::Tolerance& t) { return t.zero; })) return residual;
  const VectorX eta = uncertainty_->nuisances(residual);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].zero) residual -= eta(as_index(i)) * A_->shared.col(as_index(i));
  return residual;
}

VectorX Observations::residual_held_out(const subject::Subject& subject) const {
  const VectorX all = residual(subject);
  // Of one pose no other says where the readings count from.
  return comparison_->study.data->poses.size() > 1 ? all : from_zero(all);
}

double Observations::held_out_rmse(const subject::Subject& subject) const {
  return held_out_->rmse(residual_held_out(subject));
}

bool Observations::falls_held_out(const subject::Subject& subject, const subject::Subject& other) const {
  constexpr double by_chance = 2;  // standard errors
  const VectorX more = held_out_->squares(residual_held_out(subject)) - held_out_->squares(residual_held_out(other));
  return more.sum() <= (more.size() > 1 ? by_chance * more.norm() : 0);
}

std::vector<std::pair<std::string, double>> Observations::strained(const subject::Subject& subject) const {
  const VectorX eta = uncertainty_->nuisances(residual(subject));
  const Eigen::Index shape = A_->shared.cols() - 1;  // between the tolerances of all poses and those of each
  std::vector<std::pair<std::string, double>> out;
  const auto look_at = [&](const std::string& name, double deviations) {
    if (std::abs(deviations) > 2) out.emplace_back(name, deviations);
  };
  for (Eigen::Index i = 0; i < eta.size(); ++i)
    if (i != shape)
      look_at(nth(comparison_->tolerances.nuisances, i < shape ? i : i - 1).name, tolerance_scale_ * eta(i));
  look_at("the deformed shape", eta(shape));
  return out;
}

Observations Observations::granted(const subject::Subject& subject) const {
  Observations out = *this;
  const compare::ResidualStudy& s = comparison_->study;
  Linear own = linear(subject);
  std::vector<MatrixX> play;
  if (!own.floating.at_readings.empty()) play = statistics::open_play(*stand(subject), *s.data);
  if (std::optional<VectorX> shape = deformed_shape_of(s, subject, own.values)) {
    out.shape_ = std::move(*shape);
    out.in_linear_ = std::move(own.values);
    out.floating_ = std::move(own.floating);
    out.bent_ = out.bent_of(subject);
  }
  out.A_ = beside_shape(*A_, out.bent_);
  out.move_tolerances(subject);
  const VectorX left = out.residual(subject);
  const std::vector<double>& sigma = comparison_->sigma;
  out.load_errors_ = std::make_shared<const statistics::LoadErrors>(
      compare::with_open_play(s, *load_errors_, play, *out.A_, sigma, left));
  const std::vector<bool> aside = compare::gross_outliers(s, *out.load_errors_, *out.A_, sigma, left, {}).aside;
  out.weigh(are_few(aside) ? aside : aside_);
  return out;
}

double Observations::in_noise(const VectorX& values) const {
  return values.cwiseQuotient(Eigen::Map<const VectorX>(comparison_->sigma.data(), values.size())).norm();
}

double Observations::change_of_shape(const subject::Subject& to) const {
  constexpr double growth = 2;
  if (shape_.isZero(0)) return 0;
  return growth * in_noise(shape_) * in_noise(linear(to).values - in_linear_) / in_noise(in_linear_);
}

bool Observations::is_slender() const {
  constexpr double share = 0.05;
  return in_noise(bent_) > share * in_noise(in_linear_);
}

Observations Observations::in_true_geometry() const {
  Observations out = *this;
  out.true_geometry_ = true;
  if (auto null = outcome_of([&] { return out.whitened_residual(subject_); })) out.null_ = std::move(*null);
  return out;
}

Observations Observations::in_shape_of(const subject::Subject& subject) const {
  Observations out = *this;
  if (true_geometry_ || subject.true_geometry() == Geometry::linear) return out;
  Linear own = linear(subject);
  if (own.floating.at_readings == floating_.at_readings) return out;
  out.shape_ = shape_beside(own, subject);
  out.floating_ = std::move(own.floating);
  out.in_linear_ = std::move(own.values);
  out.bent_ = out.bent_of(subject);
  out.null_ = out.whitened_residual(subject_);
  return out;
}

Observations Observations::weighed_for(const subject::Subject& subject) const {
  Observations out = *this;
  const compare::ResidualStudy& s = comparison_->study;
  auto load_errors = outcome_of([&] {
    const auto standing = stand(subject);
    return statistics::LoadErrors(subject, *standing, *s.data, in_linear_geometry(s, *standing).readings);
  });
  if (!load_errors) return out;
  out.load_errors_ = std::make_shared<const statistics::LoadErrors>(load_errors->with_play(load_errors_->of_play()));
  out.move_tolerances(subject);
  out.weigh(aside_);
  return out;
}

Observations Observations::about(const subject::Subject& subject) const {
  Observations out = *this;
  out.subject_ = subject;
  out.null_ = out.whitened_residual(subject);
  return out;
}

Observations Observations::keeping(const std::vector<bool>& aside) const {
  Observations out = *this;
  out.weigh(aside);
  return out;
}

Observations Observations::exact_in(const std::vector<std::size_t>& tolerances) const {
  Observations out = *this;
  statistics::PartedColumns A = *A_;
  for (const std::size_t i : tolerances) A.shared.col(as_index(i)).setZero();
  out.A_ = std::make_shared<const statistics::PartedColumns>(std::move(A));
  out.weigh(out.aside_);
  return out;
}

}  // namespace deflect::diagnosis
