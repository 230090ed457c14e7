#include "validation/compare/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_set>
#include <utility>

#include "msa/base/number_words.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_description.h"
#include "validation/compare/channel_screen.h"
#include "validation/compare/correction_screen.h"
#include "validation/compare/file_oddities.h"
#include "validation/compare/shown_instead.h"
#include "validation/recording/channel_mistakes.h"
#include "validation/recording/recording_mistakes.h"

namespace deflect::compare {
namespace {

constexpr double chance_of_bad_fit = 1e-4, share_set_aside = 0.02, share_of_misfit = 0.05;
constexpr double excess_cured = 1.0 / 9, excess_far_less = 1.0 / 36, gross_misfit = 0.25, right_to_noise = 2;
constexpr double misfit_cured = 1.0 / 3, misfit_far_less = 1.0 / 6, all_of_misfit = 1.0 / 20;  // of the share
constexpr double deviations_of_right = 5;                                                      // of χ²
constexpr double hardly_more = 1.05;                                                           // of shares, by noise
constexpr double hardly_worse = 20;            // of χ²: tolerances come into it
constexpr double clearly = 30;                 // of χ², by which corrected data are easier to explain
constexpr double cost_of_reading = 25;         // χ² that setting one aside is worth
constexpr std::size_t most_tried = 4;          // on all readings
constexpr std::size_t looked_at_exactly = 12;  // where losses can be estimated

bool fits_badly(const Comparison& c, const MisfitAccount& account) {
  return c.p_value < chance_of_bad_fit ||
         static_cast<double>(c.set_aside.size()) > share_set_aside * static_cast<double>(c.readings) ||
         (c.sigma_from_residuals && account.share > share_of_misfit);
}

/// What it takes to describe the data: −2 ln of their density beside the findings, up to a constant, and as much as
/// ln n for each number fitted.
double description(const MisfitAccount& a, int fitted, std::size_t readings) {
  const double columns = std::log(static_cast<double>(readings)) * (a.columns + fitted);
  const double aside = cost_of_reading * static_cast<double>(a.set_aside);
  return a.left + a.density + columns + aside;
}

/// Of the recorded numbers y the corrected ones f y are told. Where σ is not told with them, σ/|f| is what y scatter
/// by: −2 ln of the density of y is then χ² − 2 ln |f| a number, against χ² of y as they stand.
double cost_of_scale(const Comparison& c, const recording::Correction& correction) {
  double sum = 0;
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    if (c.estimated[i]) continue;  // it follows
    const measurement::MeasuredValue& v = c.study.values[i];
    const measurement::Reading& r = c.study.data->readings[v.reading];
    const bool told =
        correction.sigma_too && (v.quantity == measurement::Quantity::angle ? r.sigma_th : r.sigma_u).has_value();
    if (!told && v.of_tool_point()) sum -= 2 * std::log(std::abs(correction.displacement.factor[v.channel]));
    for (const auto& [channel, factor] : correction.scaled_channels)
      if (v.channel == channel) sum -= 2 * std::log(std::abs(factor));
  }
  return sum;
}

/// Whether noise and tolerances leave as much.
bool is_right(const MisfitAccount& a) { return a.chi2 < a.numbers + deviations_of_right * std::sqrt(2 * a.numbers); }

/// Whether the corrected data are right, or so much better that the mistake is certain. `gain`: by how much their
/// description is shorter.
bool cures(const MisfitAccount& before, const MisfitAccount& after, int fitted, double gain) {
  if (after.share > hardly_more * before.share) return false;
  const std::size_t common = std::min(before.set_aside, after.set_aside);
  const auto excess = [&](const MisfitAccount& a) {
    return std::max(0.0, a.chi2 - a.numbers) + cost_of_reading * static_cast<double>(a.set_aside - common);
  };
  const bool grossly = before.share > gross_misfit, falls = after.share < misfit_cured * before.share;
  const bool right = before.estimated || is_right(after);
  const bool cured =
      before.estimated ? falls : excess(after) < (right ? excess_cured : excess_far_less) * excess(before);
  // What physics can leave, a shift of the poses or of the point of the load can follow a long way.
  const bool all_of_it = after.share < all_of_misfit * before.share && after.chi2 < right_to_noise * after.numbers;
  if (fitted > 0 && !(cured && (right || all_of_it))) return false;
  if (fitted == 0 && right && all_of_it) return true;  // no chance that physics is that near a unit or an axis
  if (fitted == 0 && grossly && falls && right && gain > -hardly_worse) return true;
  return gain > clearly && (cured || (grossly && after.share < misfit_far_less * before.share));
}

/// Of rotations beside translations, or of little that is right at last, χ² says it where root mean squares do not.
std::string what_would_fall(const MisfitAccount& before, const MisfitAccount& after) {
  if (after.share < misfit_cured * before.share)
    return fmt::format("the misfit would fall from {} % of what was measured",
                       fall_words(100 * before.share, 100 * after.share));
  return fmt::format("chi2 of a measured number would fall from {}",
                     fall_words(before.chi2 / before.numbers, after.chi2 / after.numbers));
}

/// The sensors' channels that a correction rewrites.
std::vector<std::size_t> changed_channels(const measurement::Measurements& before,
                                          const measurement::Measurements& after) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < before.instruments.sensors.size(); ++k)
    for (std::size_t i = 0; i < before.readings.size(); ++i)
      if (before.readings[i].sensors[k] != after.readings[i].sensors[k]) {
        out.push_back(6 + k);
        break;
      }
  return out;
}

/// The same with the share of these channels, where there are any: errors of displacements say nothing of a force.
MisfitAccount of_channels(MisfitAccount a, const std::vector<std::size_t>& channels) {
  if (channels.empty()) return a;
  double sum = 0;
  for (const std::size_t k : channels) sum += std::pow(a.share_of_channel[k], 2);
  a.share = std::sqrt(sum / static_cast<double>(channels.size()));
  return a;
}

struct Tried {
  recording::Correction correction;
  double loss = 0;
};

/// The corrections that take a good part of the misfit away, the best first.
class Promising {
 public:
  explicit Promising(double least) : least_(least) {}
  void add(const recording::Correction& correction, double loss, bool known_to_be = false) {
    if (known_to_be || loss < least_) all_.push_back({correction, loss});
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
  Promising out(screen.promising());
  for (const recording::Correction& correction : recording::mistaken_readings(*c.study.data))
    out.add(correction, screen.loss(correction));
  if (const auto point = screen.best_point()) out.add(point->correction, point->loss, point->leaves_noise);
  return std::move(out).sorted();
}

/// These want predictions of their own.
std::vector<Tried> promising_poses(const Comparison& c, const CorrectionScreen& screen) {
  Promising out(screen.promising());
  for (const auto& corrections :
       {recording::mistaken_poses(*c.study.data), recording::mistaken_pose_lengths(*c.study.data)})
    for (const recording::Correction& correction : corrections) out.add(correction, screen.loss_elsewhere(correction));
  for (int axis = 0; axis < 3; ++axis)
    if (const auto shift = screen.best_shift(axis)) out.add(*shift, screen.loss_elsewhere(*shift));
  return std::move(out).sorted();
}

/// Where losses can be estimated, the best of them are looked at exactly.
std::vector<Tried> promising_channels(const ChannelScreen& screen, const std::vector<recording::Correction>& all) {
  Promising out(screen.promising());
  std::vector<Tried> estimated;
  for (const recording::Correction& correction : all) {
    if (!screen.follows(correction)) continue;
    const std::optional<double> loss = screen.estimated_loss(correction);
    if (!loss)
      out.add(correction, screen.loss(correction));
    else if (*loss < screen.estimated_promising())
      estimated.push_back({correction, *loss});
  }
  std::stable_sort(estimated.begin(), estimated.end(), [](const Tried& a, const Tried& b) { return a.loss < b.loss; });
  for (std::size_t i = 0; i < std::min(looked_at_exactly, estimated.size()); ++i)
    out.add(estimated[i].correction, screen.loss(estimated[i].correction));
  return std::move(out).sorted();
}

std::vector<Tried> promising_others(const ChannelScreen& screen, const Comparison& c) {
  std::vector<Tried> out;
  for (auto& [correction, loss] : screen.other_quantities(c)) out.push_back({std::move(correction), loss});
  std::stable_sort(out.begin(), out.end(), [](const Tried& a, const Tried& b) { return a.loss < b.loss; });
  return out;
}

/// The subject as it is read where sensors show other quantities.
subject::Subject subject_as_read(const subject::Subject& subject, const recording::Correction& correction) {
  if (!correction.description) return subject;
  frame::FrameDescription f = *subject.frame();
  correction.description(f);
  return f;
}

/// Those that do as well as the first from `from` on.
std::size_t end_of_equals(const std::vector<Tried>& all, std::size_t from, double within) {
  std::size_t to = from + 1;
  while (to < all.size() && all[to].loss <= all[from].loss + within) ++to;
  return to;
}

class MistakeSearch {
 public:
  MistakeSearch(const Comparison& c, const MisfitAccount& before, double equal_within, const ComparedAs& again)
      : c_(c), before_(before), equal_within_(equal_within), again_(again) {}

  /// The best of several are tried on all readings, until one leaves nothing to explain.
  void look_among(const std::vector<Tried>& all) {
    for (std::size_t from = 0, tries = 0; from < all.size() && tries < most_tried && !right_; ++tries) {
      const std::size_t to = end_of_equals(all, from, equal_within_);
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
  /// By how much the corrected data's description is shorter than the recorded ones'.
  double shorter_by(const MisfitAccount& after, const recording::Correction& correction) const {
    return description(before_, 0, c_.readings) - description(after, correction.fitted, c_.readings) -
           cost_of_scale(c_, correction);
  }

  void try_one(const std::vector<Tried>& all, std::size_t from, std::size_t to,
               const recording::Correction& correction) {
    const measurement::Measurements data = recording::corrected(*c_.study.data, correction);
    const std::vector<std::size_t> changed = changed_channels(*c_.study.data, data);
    const auto cured = [&](const MisfitAccount& after, double gain) {
      return cures(of_channels(before_, changed), of_channels(after, changed), correction.fitted, gain);
    };
    const auto compared = outcome_of([&] {
      return again_(subject_as_read(*c_.study.subject, correction), data, [&](const MisfitAccount& at_best) {
        return cured(at_best,
                     at_best.left > 0 ? shorter_by(at_best, correction) : std::numeric_limits<double>::infinity());
      });
    });
    if (!compared || !*compared) return;  // the corrected data ask for what the machine cannot do, or cannot be right
    const MisfitAccount& after = **compared;
    const double gain = shorter_by(after, correction);
    if (!cured(after, gain)) return;
    if (found_ && gain <= most_) return;
    most_ = gain;
    right_ = !before_.estimated && after.chi2 < right_to_noise * after.numbers &&
             after.chi2 > after.numbers / right_to_noise;
    found_.emplace();
    std::string words;
    for (std::size_t i = from; i < to; ++i) {
      const recording::Correction& each = all[i].correction;
      if (std::find(found_->ids.begin(), found_->ids.end(), each.id) != found_->ids.end()) continue;
      found_->ids.push_back(each.id);
      words += (words.empty() ? "" : "; or ") + each.sentence;
    }
    found_->sentence = fmt::format("these data look like {}; {}", words, what_would_fall(before_, after));
    // Legs of other lengths yield otherwise: a guideway's clamp that gives way follows a shift to the noise.
    found_->certain = correction.fitted == 0 || (!correction.pose && !correction.effect_alike);
    if (!found_->certain) found_->sentence += "; a missing effect can look alike";
  }

  const Comparison& c_;
  const MisfitAccount& before_;
  const double equal_within_;
  const ComparedAs& again_;
  std::optional<RecordingMistake> found_;
  double most_ = 0;  // shorter by
  bool right_ = false;
};

/// MisfitAccount::density, without the readings of these lines.
double density_of_estimated(const Comparison& c, const std::unordered_set<std::size_t>& lines) {
  struct Channel {
    double measured = 0, logarithms = 0, n = 0;
  };
  std::map<std::pair<measurement::Quantity, std::size_t>, Channel> channels;
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    if (!c.estimated[i] || lines.contains(c.study.data->readings[v.reading].line)) continue;
    Channel& channel = channels[{v.quantity, v.of_tool_point() ? 0 : v.channel}];
    channel.measured += v.value * v.value, channel.logarithms += std::log(c.sigma[i]), channel.n += 1;
  }
  double sum = 0;
  for (const auto& [key, channel] : channels)
    if (channel.measured > 0) sum += 2 * channel.logarithms - channel.n * std::log(channel.measured / channel.n);
  return sum;
}

}  // namespace

std::vector<double> shares_by_channel(const Comparison& c) {
  const std::size_t channels = 6 + c.study.data->instruments.sensors.size();
  std::vector<double> misfit(channels, 0), measured(channels, 0);
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    misfit[v.channel] += std::pow(c.residual(as_index(i)), 2), measured[v.channel] += v.value * v.value;
  }
  for (std::size_t k = 0; k < channels; ++k) misfit[k] = measured[k] > 0 ? std::sqrt(misfit[k] / measured[k]) : 0;
  return misfit;
}

MisfitAccount account_of(const Comparison& c) {
  MisfitAccount a;
  double aside = 0;
  const std::unordered_set<std::size_t> lines(c.set_aside.begin(), c.set_aside.end());
  for (const measurement::MeasuredValue& v : c.study.values)
    aside += lines.contains(c.study.data->readings[v.reading].line);
  a.numbers = static_cast<double>(c.numbers) - aside;
  a.chi2 = c.chi2_per_dof * a.numbers;
  for (const Finding& f : c.findings) a.columns += f.freedoms;
  a.left = c.unexplained_chi2_per_dof * std::max(1.0, a.numbers - a.columns);
  a.set_aside = c.set_aside.size();
  a.share = c.all.measured > 0 ? c.all.rmse / c.all.measured : 0;
  a.share_of_channel = shares_by_channel(c);
  a.estimated = c.sigma_from_residuals;
  a.density = density_of_estimated(c, lines);
  return a;
}

std::vector<RecordingMistake> recording_mistakes(const subject::Subject& subject, const Comparison& c, int threads,
                                                 const ComparedAgain& compared) {
  const ComparedAs again = [&](const subject::Subject&, const measurement::Measurements& data,
                               const CanBeRight& can_be_right) { return compared(data, can_be_right); };
  std::vector<RecordingMistake> out = file_oddities(c);
  const MisfitAccount before = account_of(c);
  // Where nearly all is misfit it may be the readings that are in another unit than their σ: they are asked first.
  const std::vector<RecordingMistake> sigma = sigma_oddities(c);
  if (out.empty() && before.share < gross_misfit) out = sigma;
  if (out.empty() && subject.frame() && fits_badly(c, before)) {
    const ChannelScreen screen(subject, c, threads);
    MistakeSearch search(c, before, screen.equal_within(), again);
    const measurement::Measurements& data = *c.study.data;
    search.look_among(promising_channels(screen, recording::mistaken_channels(data)));
    if (!search.right()) search.look_among(promising_channels(screen, recording::mistaken_loads(data)));
    if (!search.right())
      search.look_among(promising_channels(screen, recording::misplaced_loads(data, *subject.frame())));
    if (search.found()) out.push_back(*search.found());
  }
  if (out.empty() && c.study.standing->has_tool_point() && fits_badly(c, before)) {
    const CorrectionScreen screen(subject, c, threads);
    MistakeSearch search(c, before, screen.equal_within(), again);
    search.look_among(promising_readings(c, screen));
    if (!search.right()) search.look_among(promising_poses(c, screen));
    if (search.found()) out.push_back(*search.found());
  }
  if (out.empty()) out = sigma;
  for (RecordingMistake& each : contradictions(c)) out.push_back(std::move(each));
  return out;
}

std::optional<RecordingMistake> shown_instead(const subject::Subject& subject, const Comparison& c, int threads,
                                              const ComparedAs& again) {
  const MisfitAccount before = account_of(c);
  if (!subject.frame() || !fits_badly(c, before)) return std::nullopt;
  const ChannelScreen screen(subject, c, threads);
  MistakeSearch search(c, before, screen.equal_within(), again);
  search.look_among(promising_others(screen, c));
  return search.found();
}

std::string within_reach_hint(const subject::Subject& subject, const measurement::Measurements& data) {
  if (outcome_of<ModelError>([&] { return subject.stand(data); }))
    return "; the machine as drawn stands at every pose, but not with its parts off by their tolerances. Where more "
           "constraints than needed hold a machine, it fits together only as drawn: take tolerances of positions and "
           "lengths (joint_position, link_length, member.length, …) out of the device";
  std::string words;
  for (const auto& corrections : {recording::mistaken_pose_lengths(data), recording::mistaken_poses(data)})
    for (const recording::Correction& correction : corrections)
      if (outcome_of<ModelError>([&] { return subject.stand(recording::corrected(data, correction)); }))
        words += (words.empty() ? "" : "; or ") + correction.sentence;
  return words.empty() ? "" : "; all poses could be reached if these data were " + words;
}

}  // namespace deflect::compare
