#include "validation/diagnosis/changes.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/compare/yielding.h"
#include "validation/effects/law_of_effect.h"
#include "validation/parallel/cases.h"

namespace deflect::diagnosis {
namespace {

constexpr double agreed = 1e-2;
constexpr double unseen = 1e-6;           // standard deviations of noise
constexpr double sampled = 0.125;         // share of the readings that leave play open which is asked whether it shows
constexpr double most_sampled = 64;       // readings at most that are asked
constexpr double rounding = 1e-11;        // of a prediction: less is no change
constexpr double size_of_a_curve = 1e-3;  // m
constexpr double no_force = 1e-9;         // of the largest
constexpr std::size_t parts_of_a_line = 7, parts_of_a_finer_line = 61;
constexpr std::size_t forces_of_a_part = 10;  // of a finer line, at least

/// A thousandth of the start, where an effect of one parameter is of the first order in it.
VectorX small_values(const effects::Effect& e) {
  VectorX out = effects::start_values(e);
  const std::optional<double>& vanishes = e.parameters.front().vanishes;
  out *= vanishes && std::isinf(*vanishes) ? 1e3 : 1e-3;
  return out;
}

/// Every amplitude with every shape.
std::vector<VectorX> every_shape(const std::vector<effects::EffectParameter>& all, const VectorX& start) {
  std::vector<VectorX> out = {start};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const effects::EffectParameter& p = all[i];
    if (!p.log || (p.vanishes && std::isinf(*p.vanishes))) continue;
    const std::vector<double> factors = p.vanishes ? std::vector{30.0, 900.0} : std::vector{1.0 / 30, 30.0};
    const std::size_t before = out.size();
    for (const double times : factors)
      for (std::size_t k = 0; k < before; ++k) {
        out.push_back(out[k]);
        double& value = out.back()(as_index(i));
        value = std::clamp(times * value, p.low, p.high);
      }
  }
  return out;
}

/// Of amplitudes together: the start and each of them a hundredth to a hundred times, which spans what they can do.
///
/// Where parameters shape the effect: the start, and what shapes it a thirtieth and thirty times, from never slipping
/// to slipping at once, from hardly bent to bent at every load; an amplitude that starts from nothing thirty times too,
/// since friction as large as the loads is no multiple of a little. Frames are of any size, from a bench to a bridge:
/// there each amplitude up to nine hundred times the start goes with each shape.
std::vector<VectorX> shapes(const std::vector<effects::EffectParameter>& all, const VectorX& start, bool shaped,
                            bool of_frame) {
  std::vector<VectorX> out = {start};
  if (all.size() == 1) return out;
  if (shaped && of_frame) return every_shape(all, start);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const effects::EffectParameter& p = all[i];
    std::vector<double> factors = {0.01, 0.1, 10, 100};
    if (shaped) factors = !p.vanishes ? std::vector{1.0 / 30, 30.0} : std::vector{30.0};
    if (!p.log || (shaped && p.vanishes && std::isinf(*p.vanishes))) continue;
    for (const double times : factors) {
      out.push_back(start);
      double& value = out.back()(as_index(i));
      value = std::clamp(times * value, p.low, p.high);
    }
  }
  return out;
}

/// The places inside a frame through which force passes.
std::vector<subject::InnerSite> loaded_sites(const compare::ResidualStudy& s) {
  std::vector<subject::InnerSite> out = s.inner.all;
  std::ranges::move(s.standing->joint_sites(*s.data), std::back_inserter(out));
  const auto force = [&](const subject::InnerSite& site) {
    return (s.loads.transpose() * site.per_load).cwiseAbs().maxCoeff() / (site.rotation ? s.standing->size() : 1);
  };
  double most = 0;
  for (const subject::InnerSite& site : out) most = std::max(most, force(site));
  std::erase_if(out, [&](const subject::InnerSite& site) { return !(force(site) > no_force * most); });
  return out;
}

/// `forces`: sizes of those that pass, in any order.
std::vector<Changes::Curve> curves_of(Curves kind, std::vector<double> forces) {
  std::vector<Changes::Curve> out;
  if (kind == Curves::powers) {
    for (const double p : {0.0, 0.5, 1.0, 2.0}) {
      const auto power = [p](double f) { return f == 0 ? 0 : std::pow(std::abs(f), p); };
      out.emplace_back(power);
      out.emplace_back([power](double f) { return std::copysign(power(f), f); });
    }
    return out;
  }
  std::sort(forces.begin(), forces.end());
  std::size_t parts = parts_of_a_line;
  if (kind == Curves::finer_lines) parts = std::min(parts_of_a_finer_line, forces.size() / forces_of_a_part);
  if (parts < parts_of_a_line || (kind == Curves::finer_lines && parts == parts_of_a_line)) return out;
  out.emplace_back([](double f) { return f == 0 ? 0 : std::copysign(1.0, f); });
  out.emplace_back([](double f) { return f; });
  for (std::size_t i = 1; i < parts && !forces.empty(); ++i)
    for (const double sense : {-1.0, 1.0})
      out.emplace_back(
          [sense, knee = forces[i * forces.size() / parts]](double f) { return std::max(0.0, sense * f - knee); });
  return out;
}

}  // namespace

Changes::Changes(const Observations& o, const std::vector<effects::PlacedEffect>& effects, int threads)
    : observations_(o),
      null_(o.residual(o.subject())),
      transmissions_(o.subject().stand(*o.comparison().study.data)->transmissions()),
      sites_(loaded_sites(o.comparison().study)) {
  const measurement::Measurements& data = *o.comparison().study.data;
  if (data.readings.front().sequence) node_motions_ = o.subject().stand(data)->node_motions(data);
  if (!transmissions_) return;
  std::vector<const effects::PlacedEffect*> first;
  for (const effects::PlacedEffect& e : effects)
    if (e.effect->place && effects::law_in_series(*e.effect) &&
        known_.emplace(subject::id_of(*e.effect->place), false).second)
      first.push_back(&e);
  std::vector<char> agree(first.size());
  parallel::for_each_case(first.size(), 1, threads, [&](std::size_t i) { agree[i] = agrees(*first[i]); });
  for (std::size_t i = 0; i < first.size(); ++i) known_.at(subject::id_of(*first[i]->effect->place)) = agree[i];
}

std::optional<subject::Transmissions::Change> Changes::by_force(const effects::PlacedEffect& e, const VectorX& values,
                                                                const measurement::Measurements& data) const {
  const std::optional<Law> law = effects::law_in_series(*e.effect, values);
  if (!law) return std::nullopt;
  return transmissions_->change(*e.effect->place, e.leg, *law, data);
}

bool Changes::agrees(const effects::PlacedEffect& e) const {
  const compare::ResidualStudy& study = observations_.comparison().study;
  const measurement::Measurements some = measurement::one_pose(*study.data, 0);
  const VectorX small = small_values(*e.effect);
  const auto told = by_force(e, small, some);
  if (!told) return false;
  prediction::PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const subject::Standing* drawn = study.standing.get();
  const std::vector<measurement::MeasuredValue> read = measurement::measured_values(some, drawn->sensor_forms(some));
  const VectorX by_statics = statistics::rows_of(read, told->readings);
  const auto off = outcome_of([&] {
    const auto predicted = [&](const subject::Subject& s) {
      return s.stand(some, drawn)->predict(some, linear, parallel::alone);
    };
    const VectorX before = statistics::rows_of(read, predicted(observations_.subject())),
                  after =
                      statistics::rows_of(read, predicted(effects::with_effect(observations_.subject(), {e, small})));
    return (after - before - by_statics).norm() - agreed * by_statics.norm() - rounding * before.norm();
  });
  return off && *off <= 0;
}

bool Changes::is_known_by_statics(const subject::Place& place) const {
  const auto known = known_.find(subject::id_of(place));
  return transmissions_ && known != known_.end() && known->second;
}

std::vector<const subject::InnerSite*> Changes::sites_at(const subject::Place& place) const {
  std::vector<const subject::InnerSite*> out;
  const auto is_there = [](const subject::Place& site, const std::string& path,
                           const std::vector<std::size_t>& freedoms) {
    return site.path == path && site.freedoms.empty() == freedoms.empty() &&
           std::ranges::includes(freedoms, site.freedoms);
  };
  for (const subject::InnerSite& site : sites_)
    if (is_there(site.place, place.path, place.freedoms) ||
        std::ranges::any_of(place.others, [&](const auto& o) { return is_there(site.place, o.path, o.freedoms); }))
      out.push_back(&site);
  return out;
}

bool Changes::knows_forces_at(const subject::Place& place) const {
  return is_known_by_statics(place) || !sites_at(place).empty();
}

std::optional<VectorX> Changes::by_curve(const effects::PlacedEffect& e, const Curve& curve) const {
  const compare::ResidualStudy& study = observations_.comparison().study;
  const subject::Place& place = *e.effect->place;
  std::optional<VectorX> out;
  if (is_known_by_statics(place)) {
    if (const auto told = transmissions_->change(place, e.leg, curve, *study.data))
      out = -statistics::rows_of(study.values, *told);
    return out;
  }
  for (const subject::InnerSite* site : sites_at(place)) {
    const VectorX own = compare::change_by_yielding(study, *site, curve);
    out = out ? VectorX(*out + own) : own;
  }
  return out;
}

MatrixX Changes::by_any_curve(const effects::PlacedEffect& e, Curves kind) const {
  std::vector<MatrixX> out;
  if (!e.effect->place) return MatrixX(null_.size(), 0);
  std::vector<double> forces;
  by_curve(e, [&](double f) {
    if (f != 0) forces.push_back(std::abs(f));
    return f;
  });
  for (const Curve& curve : curves_of(kind, std::move(forces))) {
    const std::optional<VectorX> change = by_curve(e, curve);
    if (const double length = change ? change->norm() : 0; length > 0)
      out.emplace_back(size_of_a_curve / length * *change);
  }
  return statistics::side_by_side(out, null_.size());
}

const subject::NodeMotion* Changes::node_motion(const subject::Place& place) const {
  const auto at = std::find_if(node_motions_.begin(), node_motions_.end(), [&](const subject::NodeMotion& m) {
    return m.place.path == place.path && m.place.freedoms == place.freedoms;
  });
  return at == node_motions_.end() ? nullptr : &*at;
}

bool Changes::may_be_held(const subject::Place& place) const {
  if (place.freedoms.size() != 1 || !place.others.empty() || place.hold == subject::Hold::rigid) return false;
  return node_motion(place) || (transmissions_ && observations_.comparison().study.data->readings.front().sequence);
}

/// What the readings change, up to a factor, by a force that holds the place.
std::optional<VectorX> Changes::by_holding(const subject::Place& place, std::optional<int> leg,
                                           const std::function<Curve()>& at_rest) const {
  const compare::ResidualStudy& study = observations_.comparison().study;
  if (const subject::NodeMotion* node = node_motion(place)) {
    VectorX held(node->by_reading.size()), out(null_.size());
    std::vector<Curve> begun(study.data->poses.size());
    for (const std::size_t i : measurement::in_sequence(*study.data, "friction")) {
      Curve& curve = begun[study.data->readings[i].pose];
      if (!curve) curve = at_rest();
      held(as_index(i)) = curve(node->by_reading(as_index(i)));
    }
    for (std::size_t i = 0; i < study.values.size(); ++i) {
      const measurement::MeasuredValue& v = study.values[i];
      out(as_index(i)) = node->moves(as_index(v.channel) - 6) * held(as_index(v.reading));
    }
    return out;
  }
  const auto told = transmissions_->change_beside(place, leg, at_rest, *study.data);
  return told ? std::optional(statistics::rows_of(study.values, *told)) : std::nullopt;
}

std::optional<VectorX> Changes::by_statics(const effects::PlacedEffect& e) const {
  if (!e.effect->place || !is_known_by_statics(*e.effect->place)) return std::nullopt;
  const compare::ResidualStudy& study = observations_.comparison().study;
  const VectorX start = effects::start_values(*e.effect);
  const auto told = by_force(e, start, *study.data);
  if (!told) return std::nullopt;
  VectorX change = -statistics::rows_of(study.values, told->readings);
  std::vector<bool> some(told->floats.size(), false), others = some;
  const auto all = static_cast<double>(std::count(told->floats.begin(), told->floats.end(), true));
  // Golden section: no period of a campaign is sampled in step.
  double floating = 0;
  for (std::size_t i = 0; i < some.size(); ++i)
    if (told->floats[i])
      (std::fmod(0.6180339887498949 * floating++, 1) < std::min(sampled, most_sampled / all) ? some : others)[i] = true;
  const auto moved = [&](const std::vector<bool>& readings) { return moved_by_play({e, start}, readings, change); };
  // Of play in one leg they count as in the middle: to predict them for every leg would take longer than all else.
  if (!e.leg && floating > 0 && moved(some) && floating > 1) moved(others);
  return change;
}

/// Puts in what play changes that these readings leave open; false where they show nothing of it.
bool Changes::moved_by_play(const effects::EffectInstance& play, const std::vector<bool>& readings,
                            VectorX& change) const {
  const auto residual = outcome_of(
      [&] { return observations_.residual_in_shape(effects::with_effect(observations_.subject(), play), readings); });
  if (!residual) return true;
  const std::vector<measurement::MeasuredValue>& values = observations_.comparison().study.values;
  VectorX there = VectorX::Zero(change.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    if (readings[values[k].reading]) there(as_index(k)) = (*residual)(as_index(k)) - null_(as_index(k));
  const bool shows = are_seen(there);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (readings[values[k].reading]) change(as_index(k)) = there(as_index(k));
  return shows;
}

/// Whether noise alone would let them be told from nothing, if it were a million times less.
bool Changes::are_seen(const VectorX& change) const {
  const std::vector<double>& sigma = observations_.comparison().sigma;
  return !(change.cwiseQuotient(Eigen::Map<const VectorX>(sigma.data(), std::ssize(sigma))).norm() <= unseen);
}

/// Parameter by parameter where each can vanish alone, else all at the start; parameters that only shape the effect
/// are tried at several values.
Change Changes::predicted(const effects::PlacedEffect& e) const {
  const effects::PreparedEffects prepared(observations_.subject(), {e});
  const std::vector<effects::EffectParameter>& all = e.effect->parameters;
  const VectorX start = effects::start_values(*e.effect);
  Change out;
  out.shaped = is_shaped(e);
  out.summed = all.size() > 1 && std::all_of(all.begin(), all.end(), [](const effects::EffectParameter& p) {
                 return p.vanishes && std::isfinite(*p.vanishes);
               });
  std::vector<VectorX> tried;
  if (out.summed)
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      VectorX alone = start;
      for (Eigen::Index k = 0; k < start.size(); ++k)
        if (k != i) alone(k) = *nth(all, k).vanishes;
      tried.push_back(std::move(alone));
    }
  else
    tried = shapes(all, start, out.shaped, observations_.subject().frame() != nullptr);
  // There are as many laws as legs: where it slips and where it sticks is enough.
  if (out.shaped && e.leg) tried.resize(std::min<std::size_t>(2, tried.size()));
  out.columns.resize(null_.size(), std::ssize(tried));
  for (std::size_t i = 0; i < tried.size(); ++i) {
    out.columns.col(as_index(i)) = observations_.residual(prepared(tried[i])) - null_;
    if (out.shaped && i == 0 && !are_seen(out.columns.col(0))) return {MatrixX::Zero(null_.size(), 1), true, false};
  }
  return out;
}

Change Changes::by(const effects::PlacedEffect& e) const {
  if (std::optional<VectorX> change = by_statics(e)) return {std::move(*change), false, false};
  return predicted(e);
}

}  // namespace deflect::diagnosis
