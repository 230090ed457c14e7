#include "validation/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_description.h"
#include "validation/compare/errors_by_group.h"
#include "validation/compare/findings.h"
#include "validation/compare/held_out.h"
#include "validation/compare/outliers.h"
#include "validation/compare/residual_study.h"
#include "validation/compare/shown_instead.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/channel_noise.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/tail.h"

namespace deflect::compare {
namespace {

/// σ of every measured number: the file's or replicates', else the option's.
std::vector<std::optional<double>> told_sigma(const std::vector<measurement::MeasuredValue>& values,
                                              const ComparisonOptions& o) {
  std::vector<std::optional<double>> out;
  for (const measurement::MeasuredValue& v : values)
    out.push_back(v.sigma                                       ? v.sigma
                  : v.quantity == measurement::Quantity::length ? o.sigma_u
                  : v.quantity == measurement::Quantity::angle  ? o.sigma_th
                                                                : std::nullopt);
  return out;
}

/// Of forces the largest load, of moments that by the subject's size.
statistics::LargestNumbers largest_numbers(const ResidualStudy& s) {
  const double size = s.standing->size();
  const auto force = [size](const Vector6& w) { return w.head<3>().norm() + w.tail<3>().norm() / size; };
  const frame::FrameDescription* f = s.subject->frame();
  std::vector<double> of_case;
  for (const std::string& name : s.data->instruments.load_cases) {
    of_case.push_back(0);
    if (const frame::LoadCase* load = f ? find(f->loads, name) : nullptr) {
      for (const auto& [node, wrench] : load->nodes) of_case.back() += std::abs(load->factor) * force(wrench);
      for (const auto& [member, line] : load->members) of_case.back() += std::abs(load->factor) * line.q.norm() * size;
    }
  }
  double largest = 0;
  for (const measurement::Reading& r : s.data->readings) {
    double sum = force(r.load);
    for (std::size_t k = 0; k < r.factors.size(); ++k) sum += std::abs(r.factors[k]) * of_case[k];
    for (const Vector6& wrench : r.at_points) sum += force(wrench);
    largest = std::max(largest, sum);
  }
  return {{measurement::Quantity::force, largest}, {measurement::Quantity::moment, largest * size}};
}

/// The same with that of the other numbers of the channel, or else of the quantity, root mean square, where none is
/// told: one instrument read them. Nullopt where nobody tells any of a quantity.
std::optional<std::vector<double>> as_of_others(const std::vector<measurement::MeasuredValue>& values,
                                                const std::vector<std::optional<double>>& told) {
  const auto mean = [&](const auto& alike) -> std::optional<double> {
    double squares = 0, n = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (told[i] && alike(values[i])) squares += *told[i] * *told[i], n += 1;
    return n > 0 ? std::optional(std::sqrt(squares / n)) : std::nullopt;
  };
  std::vector<double> out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::optional<double> sigma = told[i];
    if (!sigma) sigma = mean([&](const auto& v) { return v.channel == values[i].channel; });
    if (!sigma) sigma = mean([&](const auto& v) { return v.quantity == values[i].quantity; });
    if (!sigma) return std::nullopt;
    out.push_back(*sigma);
  }
  return out;
}

/// What is told, and what is estimated beside patterns; for a subject without tool point beside all that a linear
/// effect can do, if it is read often enough for that.
std::vector<double> estimated_sigma(const ResidualStudy& s, const std::vector<std::optional<double>>& told,
                                    const VectorX& r, const MatrixX& patterns, const statistics::PartedColumns& A) {
  if (std::all_of(told.begin(), told.end(), [](const auto& sigma) { return sigma.has_value(); })) {
    std::vector<double> all;
    for (const std::optional<double>& sigma : told) all.push_back(*sigma);
    return all;
  }
  const statistics::LargestNumbers largest = largest_numbers(s);
  const VectorX of_loads = s.load_errors.deviations(s.values).cwiseAbs2();
  if (!s.standing->has_tool_point()) {
    const MatrixX all = statistics::side_by_side({patterns, linear_answers(s)}, r.size());
    if (auto found = statistics::channel_noise(s.values, told, r, all, A, of_loads, largest)) return *found;
  }
  if (auto found = statistics::channel_noise(s.values, told, r, patterns, A, of_loads, largest)) return *found;
  if (auto found = as_of_others(s.values, told)) return *found;
  throw InputError(
      fmt::format("{}: neither σ nor replicates, and {} measured numbers are too few to read the scatter off what no "
                  "pattern explains: add a column sigma_u_mm (sigma_th_rad), repeat readings, or give --sigma "
                  "(--sigma-rotation), or sigma of the sensors in the description",
                  s.data->origin, s.values.size()));
}

/// Variances of measured numbers by noise and tolerances, without unknown zeros.
VectorX expected_variances(const ResidualStudy& s, const statistics::ToleranceModel& t,
                           const std::vector<double>& sigma) {
  VectorX out = t.A.squared_row_norms();
  for (std::size_t k = 0; k < t.nuisances.size(); ++k)
    if (t.nuisances[k].zero) out -= t.A.shared.col(as_index(k)).cwiseAbs2();
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const double load = s.load_errors.deviation(s.values[i]);
    out(as_index(i)) += sigma[i] * sigma[i] + load * load;
  }
  return out.cwiseMax(0);
}

/// Root mean square of a residual that Errors speak of, with nothing missing.
double expected_rmse(const ResidualStudy& s, const VectorX& variances) {
  double squares = 0, n = 0;
  const measurement::Quantity quantity = quantity_of_errors(s.values);
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    if (s.values[i].quantity != quantity) continue;
    squares += variances(as_index(i));
    n += 1;
  }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

}  // namespace

namespace {

/// Everything but the mistakes of recording, step by step.
class Comparing {
 public:
  Comparison c;

  Comparing(const subject::Subject& subject, const measurement::Measurements& data, const ComparisonOptions& o,
            const parallel::Work& work)
      : options_(o), work_(work) {
    if (data.readings.size() < 2)
      throw InputError(fmt::format("{}: one reading says nothing of a model: two or more are wanted", data.origin));
    c.device = subject.name();
    c.data = data.origin;
    c.readings = data.readings.size();
    c.poses = data.poses.size();
    c.study = residual_study(subject, data, work.part(0, 0.05));
    const ResidualStudy& s = c.study;
    c.numbers = s.values.size();
    c.pure_error = measurement::pure_error_of(data, quantity_of_errors(s.values));
    VectorX measured(std::ssize(s.values));
    for (std::size_t i = 0; i < s.values.size(); ++i) measured(as_index(i)) = s.values[i].value;
    c.residual = measured - statistics::rows_of(s.values, s.predicted);
    add_errors(c);
  }

  void add_deformed_shape() { c.study.deformed_shape = deformed_shape_of(c.study, work_.part(0.05, 0.5)); }

  void add_tolerances() {
    const ResidualStudy& s = c.study;
    c.tolerances = statistics::tolerance_model(*s.standing, *s.data, s.values, work_.part(0.5, 0.8));
    patterns_ = patterns_of(s);
    for (Pattern& p : patterns_) columns_.push_back(std::move(p.rows));
  }

  /// χ², and which readings are set aside.
  void weigh() {
    const ResidualStudy& s = c.study;
    const MatrixX all = statistics::side_by_side(columns_, c.residual.size());
    // A linear model leaves the deformed shape out, which is known in size: what follows looks for other things.
    left_ = c.residual;
    shape_.resize(0);
    c.deformed_shape = 0;
    if (!s.deformed_shape.empty()) {
      shape_ = statistics::rows_of(s.values, s.deformed_shape);
      c.deformed_shape = rms_of_errors(s.values, shape_);
      left_ -= shape_;
    }
    take_noise(all);
    c.study.load_errors = with_open_play(s, s.load_errors, s.open_play, c.tolerances.A, c.sigma, left_, work_.threads);
    Outliers outliers = gross_outliers(s, s.load_errors, c.tolerances.A, c.sigma, left_, all, work_.threads);
    aside_ = std::move(outliers.aside);
    uncertainty_ = std::move(outliers.uncertainty);
    take_zero();
    c.set_aside.clear();
    for (std::size_t i = 0; i < aside_.size(); ++i)
      if (aside_[i]) c.set_aside.push_back(s.data->readings[i].line);
    c.kept_rmse = rms_of_kept(s.values, left_, aside_);
    const double chi2 = uncertainty_->inner(c.residual, c.residual)(0, 0);
    const auto freedoms = static_cast<double>(uncertainty_->count());
    c.chi2_per_dof = chi2 / freedoms;
    c.chi2_beside_shape = chi2_beside_shape() / freedoms;
    c.p_value = statistics::chi_squared_tail(freedoms, chi2);
    c.sigma_u = rms_of_errors(s.values, Eigen::Map<const VectorX>(c.sigma.data(), std::ssize(c.sigma)));
    c.noise_and_tolerances = expected_rmse(s, expected_variances(s, c.tolerances, c.sigma));
  }

  /// By how much the χ² of what is left may change, up to chance, where the deformed shape is off by shape_known_to.
  double doubt_of_shape() const { return 2 * shape_known_to * uncertainty_->whitened(shape_).norm(); }

  void find(bool in_words) {
    found_ = find_patterns(c.study, *uncertainty_, left_, patterns_, columns_, in_words);
    c.findings = found_.findings;
    const auto freedoms = static_cast<double>(uncertainty_->count());
    c.unexplained_chi2_per_dof =
        found_.chi2_left / std::max(1.0, freedoms - static_cast<double>(found_.columns.cols()));
  }

  void add_curves() {
    ResidualStudy& s = c.study;
    const statistics::Uncertainty& u = *uncertainty_;
    if (s.standing->has_tool_point()) {
      c.curves = elongation_curves(s, u, left_);
      return;
    }
    s.inner = s.standing->inner_sites(*s.data);
    InnerFits fits = fits_of_inner_sites(s, u, left_);
    c.inner = std::move(fits.all);
    c.curves = std::move(fits.curves);
    VectorX of_reading = VectorX::Zero(std::ssize(s.data->readings));
    for (std::size_t i = 0; i < s.values.size(); ++i)
      if (!aside_[s.values[i].reading])
        of_reading(as_index(s.values[i].reading)) += std::pow(left_(as_index(i)) / c.sigma[i], 2);
    Eigen::Index most = 0;
    of_reading.maxCoeff(&most);
    c.telling = as_size(most);
    c.residual_forces = residual_forces(s, c.sigma, c.tolerances.A.shared, left_, c.telling);
  }

  /// Tests, curves, held-out poses.
  void test() {
    const ResidualStudy& s = c.study;
    const statistics::Uncertainty& u = *uncertainty_;
    for (std::size_t i = 0; i < patterns_.size(); ++i) {
      const PatternRow& row = row_of(patterns_[i].id);
      PatternTest t{row.name, row.title, found_.alone[i], 0};
      t.size = rms_of_errors(s.values, columns_[i] * t.alone.amplitude);
      c.patterns.push_back(std::move(t));
    }
    columns_.clear();
    VectorX eta;
    const std::function<void()> tests[] = {
        [&] { c.contrasts = contrast_tests(s, u, left_, aside_); }, [&] { add_curves(); },
        [&] { c.held_out = HeldOut(s, u, aside_).rmse(c.residual); }, [&] { eta = u.nuisances(left_); },
        [&] {
          if (shape_.size() > 0) c.deformed_shape_fit = statistics::regress(u, c.residual, shape_, found_.columns);
        }};
    parallel::for_each_case(std::size(tests), 1, work_.threads, [&](std::size_t i) { tests[i](); });
    for (Eigen::Index i = 0; i < eta.size(); ++i)
      if (std::abs(eta(i)) > 2) c.strained.emplace_back(nth(c.tolerances.nuisances, i).name, eta(i));
  }

 private:
  void take_noise(const MatrixX& patterns) {
    std::vector<std::optional<double>> told = told_sigma(c.study.values, options_);
    c.estimated.clear();
    for (const auto& sigma : told) c.estimated.push_back(!sigma);
    const measurement::Quantity errors = quantity_of_errors(c.study.values);
    c.sigma_from_residuals = false;
    for (std::size_t i = 0; i < told.size(); ++i) {
      c.sigma_from_residuals = c.sigma_from_residuals || (!told[i] && c.study.values[i].quantity == errors);
      if (!told[i] && !options_.sigma.empty()) told[i] = options_.sigma[i];
    }
    c.sigma = estimated_sigma(c.study, told, left_, patterns, c.tolerances.A);
  }

  /// χ² = rᵀr − (sᵀr)²/(1/known² + sᵀs) of what is left, r, and the deformed shape, s, both whitened.
  double chi2_beside_shape() const {
    const double left = uncertainty_->inner(left_, left_)(0, 0);
    if (shape_.size() == 0) return left;
    const double along = uncertainty_->inner(shape_, left_)(0, 0), own = uncertainty_->inner(shape_, shape_)(0, 0);
    return left - along * along / (1 / (shape_known_to * shape_known_to) + own);
  }

  /// Where nobody knows the zero of the readings they count from here on from where the model as it is puts it; how
  /// well it is known stays in the tolerances.
  void take_zero() {
    VectorX shift = VectorX::Zero(c.residual.size());
    VectorX eta;
    for (std::size_t k = 0; k < c.tolerances.nuisances.size(); ++k) {
      if (!c.tolerances.nuisances[k].zero) continue;
      if (eta.size() == 0) eta = uncertainty_->nuisances(left_);
      shift += eta(as_index(k)) * c.tolerances.A.shared.col(as_index(k));
    }
    if (eta.size() == 0) return;
    for (std::size_t i = 0; i < c.study.values.size(); ++i) c.study.values[i].value -= shift(as_index(i));
    c.residual -= shift;
    left_ -= shift;
    add_errors(c);
  }

  ComparisonOptions options_;
  parallel::Work work_;
  std::vector<Pattern> patterns_;
  std::vector<MatrixX> columns_;  // of the patterns, over the measured numbers
  VectorX left_, shape_;          // the residual without the deformed shape
  std::vector<bool> aside_;
  std::optional<statistics::Uncertainty> uncertainty_;
  Findings found_;
};

Comparison compared_as_recorded(const subject::Subject& subject, const measurement::Measurements& data,
                                const ComparisonOptions& o, const parallel::Work& work) {
  Comparing comparing(subject, data, o, work);
  comparing.add_deformed_shape();
  comparing.add_tolerances();
  comparing.weigh();
  if (work.progress) work.progress(0.9);
  comparing.find(true);
  comparing.test();
  return std::move(comparing.c);
}

/// The deformed shape of readings as it follows from that of others: with the square of the predicted displacement.
std::vector<VectorX> supposed_shape(const ResidualStudy& known, const ResidualStudy& s) {
  const double size = s.standing->size();
  const auto squared = [size](const VectorX& d) {
    return d.head<3>().squaredNorm() + size * size * d.segment<3>(3).squaredNorm();
  };
  std::vector<VectorX> out = known.deformed_shape;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double before = squared(known.predicted[i]);
    out[i] *= before > 0 ? squared(s.predicted[i]) / before : 0;
  }
  return out;
}

/// The account of corrected data. The deformed shape takes longest: at first it is supposed from that of the recorded
/// data. Where the corrected ones are not right then, even if it is off by a fifth and half of what else speaks against
/// them is its doing, they are not.
std::optional<MisfitAccount> compared_again(const Comparison& recorded, const subject::Subject& subject,
                                            const measurement::Measurements& data, const ComparisonOptions& o,
                                            const parallel::Work& work, const CanBeRight& can_be_right) {
  Comparing comparing(subject, data, o, work);
  MisfitAccount at_best;
  at_best.numbers = static_cast<double>(comparing.c.numbers);
  at_best.share = comparing.c.all.measured > 0 ? comparing.c.all.rmse / comparing.c.all.measured : 0;
  at_best.share_of_channel = shares_by_channel(comparing.c);
  if (!can_be_right(at_best)) return std::nullopt;
  comparing.add_tolerances();
  if (!recorded.study.deformed_shape.empty() && !is_any_estimated(recorded)) {
    comparing.c.study.deformed_shape = supposed_shape(recorded.study, comparing.c.study);
    comparing.weigh();
    comparing.find(false);
    at_best = account_of(comparing.c);
    at_best.left -= comparing.doubt_of_shape();
    at_best.chi2 = std::min(at_best.chi2, (at_best.chi2 + at_best.numbers) / 2);
    at_best.set_aside /= 2;
    if (!can_be_right(at_best)) return std::nullopt;
  }
  comparing.add_deformed_shape();
  comparing.weigh();
  comparing.find(false);
  return account_of(comparing.c);
}

}  // namespace

VectorX expected_deviations(const Comparison& c) {
  return expected_variances(c.study, c.tolerances, c.sigma).cwiseSqrt();
}

bool is_any_estimated(const Comparison& c) {
  return std::find(c.estimated.begin(), c.estimated.end(), true) != c.estimated.end();
}

bool is_mistaken(const Comparison& c) { return !c.mistakes.empty() && c.mistakes.front().certain; }

Comparison compare(const subject::Subject& subject, const measurement::Measurements& data, const ComparisonOptions& o,
                   const parallel::Work& work) {
  auto compared = outcome_of<ModelError>([&] { return compared_as_recorded(subject, data, o, work); });
  if (!compared) throw ModelError(compared.why + within_reach_hint(subject, data), compared.cause);
  Comparison& c = *compared;
  if (o.as_recorded) return std::move(c);
  const ComparedAs again = [&](const subject::Subject& as_read, const measurement::Measurements& other,
                               const CanBeRight& can_be_right) {
    return compared_again(c, as_read, other, o, work.quiet(), can_be_right);
  };
  c.mistakes = recording_mistakes(subject, c, work.threads,
                                  [&](const measurement::Measurements& other, const CanBeRight& can_be_right) {
                                    return again(subject, other, can_be_right);
                                  });
  if (!is_mistaken(c))
    if (auto shown = shown_instead(subject, c, work.threads, again)) c.mistakes.insert(c.mistakes.begin(), *shown);
  return std::move(c);
}

}  // namespace deflect::compare
