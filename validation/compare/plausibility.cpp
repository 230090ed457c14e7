#include "validation/compare/plausibility.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "validation/compare/correction_screen.h"
#include "validation/compare/file_oddities.h"
#include "validation/compare/number_words.h"
#include "validation/compare/recording_mistakes.h"
#include "validation/measurement/configure_all.h"

namespace deflect {
namespace {

constexpr double chance_of_bad_fit = 1e-4, share_set_aside = 0.02, share_of_misfit = 0.05;
constexpr double excess_cured = 1.0 / 9, gross_misfit = 0.25, gross_misfit_cured = 1.0 / 3, right_to_noise = 2;
constexpr double clearly = 30;          // of χ², by which corrected data are easier to explain
constexpr double cost_of_reading = 25;  // χ² that setting one aside is worth
constexpr std::size_t most_tried = 4;   // on all readings

bool fits_badly(const Comparison& c, const MisfitAccount& account) {
  return c.p_value < chance_of_bad_fit ||
         static_cast<double>(c.set_aside.size()) > share_set_aside * static_cast<double>(c.readings) ||
         (c.sigma_from_residuals && account.share > share_of_misfit);
}

/// What it takes to describe the data: χ² left, and as much as ln n for each number fitted.
double description(const MisfitAccount& a, int fitted, std::size_t readings) {
  const double columns = std::log(static_cast<double>(readings)) * (a.columns + fitted);
  const double aside = cost_of_reading * static_cast<double>(a.set_aside);
  return (a.scatter > 0 ? 2 * a.numbers * std::log(a.scatter) : a.left) + columns + aside;
}

/// Whether the corrected data are right, or so much better that the mistake is certain.
bool cures(const MisfitAccount& before, const MisfitAccount& after, int fitted, std::size_t readings) {
  if (after.share > before.share) return false;
  const std::size_t common = std::min(before.set_aside, after.set_aside);
  const auto excess = [&](const MisfitAccount& a) {
    return std::max(0.0, a.chi2 - a.numbers) + cost_of_reading * static_cast<double>(a.set_aside - common);
  };
  const bool estimated = before.scatter > 0;
  const bool grossly = before.share > gross_misfit, falls = after.share < gross_misfit_cured * before.share;
  const double gain = description(before, 0, readings) - description(after, fitted, readings);
  if (grossly && falls && gain > -clearly && fitted == 0)
    if (estimated || after.chi2 < right_to_noise * after.numbers) return true;
  return gain > clearly && ((grossly && falls) || (estimated ? falls : excess(after) < excess_cured * excess(before)));
}

struct Tried {
  Correction correction;
  double loss = 0;
};

/// A load about another point P: moments about T are then M + p_TP × f. The one point that explains the residual best.
std::optional<Correction> other_point(const Comparison& c) {
  const ResidualStudy& s = c.study;
  const double size = s.machines.front().size;
  MatrixX X(static_cast<Eigen::Index>(s.values.size()), 3);
  VectorX y(X.rows());
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const MeasuredValue& v = s.values[i];
    const Reading& r = s.data->readings[v.reading];
    const auto row = static_cast<Eigen::Index>(i), k = static_cast<Eigen::Index>(v.component);
    const double weight = v.component < 3 ? 1 : size;
    // C [0; p × f] = −C_·θ [f]× p
    X.row(row) = -weight * s.compliance[r.pose].row(k).tail<3>() * skew(r.load.head<3>());
    y(row) = weight * (v.value - s.predicted[v.reading](k));
  }
  const Eigen::ColPivHouseholderQR<MatrixX> qr(X);
  if (qr.rank() < 3) return std::nullopt;
  const Vector3 p = qr.solve(y);
  if (!(p.norm() > 1e-3)) return std::nullopt;
  return forces_elsewhere(p);
}

/// The corrections that take a good part of the misfit away, the best first.
class Promising {
 public:
  explicit Promising(const CorrectionScreen& screen) : least_(screen.promising()) {}
  void add(const Correction& correction, double loss) {
    if (loss < least_) all_.push_back({correction, loss});
  }
  std::vector<Tried> sorted() && {
    std::stable_sort(all_.begin(), all_.end(), [](const Tried& a, const Tried& b) { return a.loss < b.loss; });
    return std::move(all_);
  }

 private:
  double least_;
  std::vector<Tried> all_;
};

std::vector<Tried> promising_readings(const Comparison& c, const CorrectionScreen& screen) {
  Promising out(screen);
  for (const Correction& correction : mistaken_readings(*c.study.data)) out.add(correction, screen.loss(correction));
  if (const auto point = other_point(c)) out.add(*point, screen.loss(*point));
  return std::move(out).sorted();
}

/// These want predictions of their own.
std::vector<Tried> promising_poses(const Comparison& c, const CorrectionScreen& screen) {
  Promising out(screen);
  for (const Correction& correction : mistaken_poses(*c.study.data))
    out.add(correction, screen.loss_elsewhere(correction));
  for (int axis = 0; axis < 3; ++axis)
    if (const auto shift = screen.best_shift(axis)) out.add(*shift, screen.loss_elsewhere(*shift));
  return std::move(out).sorted();
}

/// Those that do as well as the first from `from` on.
std::size_t end_of_equals(const std::vector<Tried>& all, std::size_t from) {
  std::size_t to = from + 1;
  while (to < all.size() && all[to].loss <= 1.02 * all[from].loss + 1e-9) ++to;
  return to;
}

class MistakeSearch {
 public:
  MistakeSearch(const Comparison& c, const MisfitAccount& before,
                const std::function<MisfitAccount(const Measurements&)>& again)
      : c_(c), before_(before), again_(again) {}

  /// The best of several are tried on all readings, until one leaves nothing to explain.
  void look_among(const std::vector<Tried>& all) {
    for (std::size_t from = 0, tries = 0; from < all.size() && tries < most_tried && !right_; ++tries) {
      const std::size_t to = end_of_equals(all, from);
      for (std::size_t i = from; i < to && !right_; ++i) {
        // Equals are tried once, but for the unit of σ.
        if (i > from && all[i].correction.id != all[from].correction.id) continue;
        try_one(all, from, to, all[i].correction);
      }
      from = to;
    }
  }

  /// One that is right to noise and tolerances is found: no other is looked for.
  bool right() const { return right_; }
  const std::optional<RecordingMistake>& found() const { return found_; }

 private:
  void try_one(const std::vector<Tried>& all, std::size_t from, std::size_t to, const Correction& correction) {
    MisfitAccount after;
    try {
      after = again_(corrected(*c_.study.data, correction));
    } catch (const std::runtime_error&) {
      return;  // the corrected data ask for what the machine cannot do
    }
    if (!cures(before_, after, correction.fitted, c_.readings)) return;
    const double size = description(after, correction.fitted, c_.readings);
    if (found_ && size >= least_) return;
    least_ = size;
    right_ = before_.scatter == 0 && after.chi2 < right_to_noise * after.numbers &&
             after.chi2 > after.numbers / right_to_noise;
    found_.emplace();
    std::string words;
    for (std::size_t i = from; i < to; ++i) {
      const Correction& each = all[i].correction;
      if (std::find(found_->ids.begin(), found_->ids.end(), each.id) != found_->ids.end()) continue;
      found_->ids.push_back(each.id);
      words += (words.empty() ? "" : "; or ") + each.sentence;
    }
    found_->sentence = fmt::format("these data look like {}; the misfit would fall from {} % of what was measured",
                                   words, fall_words(100 * before_.share, 100 * after.share));
  }

  const Comparison& c_;
  const MisfitAccount& before_;
  const std::function<MisfitAccount(const Measurements&)>& again_;
  std::optional<RecordingMistake> found_;
  double least_ = 0;
  bool right_ = false;
};

}  // namespace

MisfitAccount account_of(const Comparison& c) {
  MisfitAccount a;
  double aside = 0;
  for (const MeasuredValue& v : c.study.values)
    aside +=
        std::find(c.set_aside.begin(), c.set_aside.end(), c.study.data->readings[v.reading].line) != c.set_aside.end();
  a.numbers = static_cast<double>(c.numbers) - aside;
  a.chi2 = c.chi2_per_dof * a.numbers;
  for (const Finding& f : c.findings) a.columns += f.freedoms;
  a.left = c.unexplained_chi2_per_dof * std::max(1.0, a.numbers - a.columns);
  a.set_aside = c.set_aside.size();
  a.share = c.all.measured > 0 ? c.all.rmse / c.all.measured : 0;
  a.scatter = c.sigma_from_residuals && c.all.measured > 0 ? c.sigma_u / c.all.measured : 0;
  return a;
}

std::vector<RecordingMistake> recording_mistakes(const Mechanism& m, const Comparison& c, int threads,
                                                 const std::function<MisfitAccount(const Measurements&)>& again) {
  std::vector<RecordingMistake> out = file_oddities(c);
  const MisfitAccount before = account_of(c);
  // Where nearly all is misfit it may be the readings that are in another unit than their σ: they are asked first.
  const std::vector<RecordingMistake> sigma = sigma_oddities(c);
  if (out.empty() && before.share < gross_misfit) out = sigma;
  if (out.empty() && fits_badly(c, before)) {
    const CorrectionScreen screen(m, c, threads);
    MistakeSearch search(c, before, again);
    search.look_among(promising_readings(c, screen));
    if (!search.right()) search.look_among(promising_poses(c, screen));
    if (search.found()) out.push_back(*search.found());
  }
  if (out.empty()) out = sigma;
  for (RecordingMistake& each : contradictions(c)) out.push_back(std::move(each));
  return out;
}

std::string within_reach_hint(const Mechanism& m, const Measurements& data) {
  std::string words;
  for (const auto& corrections : {mistaken_pose_lengths(data), mistaken_poses(data)})
    for (const Correction& correction : corrections) try {
        configure_all(m, corrected(data, correction));
        words += (words.empty() ? "" : "; or ") + correction.sentence;
      } catch (const ModelError&) {  // not this one
      }
  return words.empty() ? "" : "; all poses could be reached if these data were " + words;
}

}  // namespace deflect
