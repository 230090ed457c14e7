#include "validation/diagnosis/signatures.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/diagnosis/changes.h"
#include "validation/diagnosis/whatever_columns.h"
#include "validation/effects/law_of_effect.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/tail.h"

namespace deflect::diagnosis {
namespace {

constexpr double unseen = 1e-6;  // of a whitened change at the start: nothing that these data show

/// Columns as basis · coordinates.
struct Spanned {
  MatrixX basis, coordinates;
};

/// Those that are not 0, at unit length.
Spanned unit_columns(const MatrixX& X) {
  std::vector<Eigen::Index> seen;
  for (Eigen::Index i = 0; i < X.cols(); ++i)
    if (X.col(i).norm() > unseen) seen.push_back(i);
  Spanned out{X(Eigen::all, seen), MatrixX::Zero(std::ssize(seen), X.cols())};
  for (Eigen::Index k = 0; k < out.basis.cols(); ++k) {
    out.coordinates(k, nth(seen, k)) = out.basis.col(k).norm();
    out.basis.col(k).normalize();
  }
  return out;
}

/// Nothing where all are 0.
Spanned orthonormal(const MatrixX& X) {
  if (X.norm() <= unseen) return {MatrixX(X.rows(), 0), MatrixX(0, X.cols())};
  if (X.cols() == 1) return unit_columns(X);
  Spanned out{statistics::orthonormal(X), {}};
  out.coordinates = out.basis.transpose() * X;
  return out;
}

/// Of a shaped effect: its amplitude vanishes at a bound.
bool amplitude_from_nothing(const effects::Effect& e) {
  return std::any_of(e.parameters.begin(), e.parameters.end(), [](const effects::EffectParameter& p) {
    return p.vanishes && (*p.vanishes <= p.low || *p.vanishes >= p.high);
  });
}

double cosine(const Signature& a, const Signature& b, const MatrixX& cross) {
  if (a.shaped && b.shaped) return cross.cwiseAbs().maxCoeff();
  if (a.shaped) return cross.rowwise().norm().maxCoeff();
  if (b.shaped) return cross.colwise().norm().maxCoeff();
  if (cross.size() == 1) return std::abs(cross(0, 0));
  return Eigen::JacobiSVD<MatrixX>(cross).singularValues()(0);
}

/// Of a law at a place, which is one of the subject's own.
std::vector<effects::PlacedEffect> every_leg(const effects::Effect& e, const subject::Subject& subject) {
  if (e.scope != effects::Scope::one_leg) return {{&e, {}}};
  std::vector<effects::PlacedEffect> out;
  for (int leg = 1; leg <= subject.legs(); ++leg) out.push_back({&e, leg});
  return out;
}

/// How many signatures each effect has: one for each leg where it is of one.
std::map<std::string, double> count_by_name(const std::vector<Signature>& all) {
  std::map<std::string, double> out;
  for (const Signature& s : all)
    if (s.effect.effect) out[s.effect.effect->name] += 1;
  return out;
}

/// The signature of a change, and the coordinates in its basis.
std::pair<Signature, MatrixX> weighed(const effects::PlacedEffect& e, const Change& change,
                                      const std::shared_ptr<const Observations>& o, const WhateverTheLaw& any) {
  const MatrixX white = (*o->uncertainty().whitening())(change.columns);
  Spanned spanned = change.shaped ? unit_columns(white) : orthonormal(white);
  Signature s;
  s.effect = e;
  s.basis = std::move(spanned.basis);
  s.shaped = change.shaped;
  s.start = change.summed ? VectorX(spanned.coordinates.rowwise().sum()) : VectorX(spanned.coordinates.col(0));
  s.lambda = s.start.norm();
  s.one_sided = s.shaped ? amplitude_from_nothing(*e.effect) : one_sided(e);
  if (const auto& place = e.effect->place) s.whatever_the_law = any.at(*place, e.leg, o);
  s.any_curve = any.curve_at(e, o);
  if (const auto& place = e.effect->place) s.any_friction = any.friction_at(*place, e.leg, o);
  return {std::move(s), std::move(spanned.coordinates)};
}

std::vector<PlaceWithoutLaw> places_without_law(const std::vector<Signature>& all,
                                                const std::shared_ptr<const Observations>& o,
                                                const WhateverTheLaw& any) {
  std::set<Spot> known;
  for (const Signature& s : all)
    if (const auto& place = s.effect.effect->place) known.insert(spot_of(*place, s.effect.leg));
  std::vector<PlaceWithoutLaw> out;
  const auto add = [&](const subject::Place& p, std::optional<int> leg) {
    PlaceWithoutLaw place{p, leg, any.at(p, leg, o), any.friction_at(p, leg, o)};
    if (known.contains(spot_of(p, leg)) || !place.shows()) return;
    known.insert(spot_of(p, leg));
    out.push_back(std::move(place));
  };
  for_each_place(o->subject(), add);
  for (const subject::NodeMotion& node : any.node_motions()) add(node.place, std::nullopt);
  return out;
}

}  // namespace

SignaturesAtPlaces::SignaturesAtPlaces(const Observations& o, const std::vector<effects::Effect>& effects,
                                       int threads) {
  std::vector<effects::PlacedEffect> placed;
  for (const effects::Effect& e : effects) {
    if (effects::is_geometry(e)) continue;
    const std::vector<effects::PlacedEffect> own =
        e.place ? every_leg(e, o.subject()) : effects::places_of(e, o.subject());
    placed.insert(placed.end(), own.begin(), own.end());
    if (own.empty()) {
      const auto leg = e.scope == effects::Scope::one_leg ? std::optional(1) : std::nullopt;
      left_out_.push_back({e.name, effects::why_not(e, o.subject(), leg).value_or("")});
    }
  }
  nowhere_ = left_out_.size();
  for (const effects::PlacedEffect& e : placed) places_.push_back({e});
  const auto changes = std::make_shared<const Changes>(o, placed, threads);
  whatever_.emplace(changes, whatever_columns(o, *changes));
  weigh(o, threads, [&](std::size_t i) {
    Place& p = places_[i];
    auto change = outcome_of([&] { return changes->by(p.effect); });
    // The subject cannot stand with it, or it wants what the file does not have: a sequence.
    if (!change) p.why = change.why;
    if (change && !change->columns.allFinite()) p.why = "the prediction with it is no number";
    return p.why.empty() ? std::move(change.value) : std::nullopt;
  });
  const auto failed = std::find_if(places_.begin(), places_.end(), [](const Place& p) { return !p.why.empty(); });
  if (all().empty() && failed != places_.end())
    throw ModelError(fmt::format("{}: of {} effects none can be tried, so that nothing can be said: with {}, {}",
                                 o.subject().name(), places_.size(), name_of(failed->effect), failed->why));
}

std::optional<Change> SignaturesAtPlaces::change_again(const Place& p, const MatrixX& basis,
                                                       const statistics::Whitening& before,
                                                       const std::vector<Eigen::Index>& aside) {
  if (!p.why.empty()) return std::nullopt;
  Change out{MatrixX::Zero(before.rows(), p.aside.cols()), is_shaped(p.effect), p.summed};
  if (basis.cols() > 0) out.columns = before.undo(basis) * p.coordinates;
  out.columns(aside, Eigen::all) = p.aside;
  return out;
}

void SignaturesAtPlaces::weigh_for(const Observations& o, int threads) {
  std::vector<MatrixX> bases(places_.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (places_[i].coordinates.rows() > 0) bases[i] = std::move(known_.laws[next++].basis);
  const std::shared_ptr<const statistics::Whitening> before = std::move(whitening_);
  const std::vector<Eigen::Index> aside = std::move(aside_);
  left_out_.resize(nowhere_);
  weigh(o, threads, [&](std::size_t i) {
    auto change = change_again(places_[i], bases[i], *before, aside);
    bases[i].resize(0, 0);
    return change;
  });
}

bool SignaturesAtPlaces::are_weighed_for(const Observations& o) const {
  return o.uncertainty().whitening() == whitening_;
}

Signature SignaturesAtPlaces::law_seen_by(const std::shared_ptr<const Observations>& o, std::size_t k) const {
  const Signature& s = known_.laws[k];
  const auto change = change_again(places_[place_of_law_[k]], s.basis, *whitening_, aside_);
  return weighed(s.effect, *change, o, *whatever_).first;
}

PlaceWithoutLaw SignaturesAtPlaces::seen_by(const std::shared_ptr<const Observations>& o,
                                            const PlaceWithoutLaw& p) const {
  return {p.place, p.leg, whatever_->at(p.place, p.leg, o), whatever_->friction_at(p.place, p.leg, o)};
}

std::vector<Signature> signatures(const Observations& o, const std::vector<effects::Effect>& effects, int threads,
                                  std::vector<LeftOut>* left_out) {
  SignaturesAtPlaces out(o, effects, threads);
  if (left_out) left_out->insert(left_out->end(), out.left_out().begin(), out.left_out().end());
  return std::move(out).all();
}

template <class ChangeOf>
void SignaturesAtPlaces::weigh(const Observations& o, int threads, const ChangeOf& change_of) {
  whitening_ = o.uncertainty().whitening();
  aside_.clear();
  const std::vector<measurement::MeasuredValue>& values = o.comparison().study.values;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (o.aside()[values[k].reading]) aside_.push_back(as_index(k));
  const auto observations = std::make_shared<const Observations>(o);
  std::vector<Signature>& all = known_.laws;
  all.assign(places_.size(), {});
  parallel::for_each_case(places_.size(), 1, threads, [&](std::size_t i) {
    Place& p = places_[i];
    Signature& s = all[i];
    const std::optional<Change> change = change_of(i);
    if (!change) return;
    std::tie(s, p.coordinates) = weighed(p.effect, *change, observations, *whatever_);
    p.aside = change->columns(aside_, Eigen::all);
    p.summed = change->summed;
  });
  place_of_law_.clear();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].basis.cols() > 0)
      place_of_law_.push_back(i);
    else if (!places_[i].effect.effect->place)
      left_out_.push_back(
          {name_of(places_[i].effect), places_[i].why.empty() ? "changes nothing that was measured" : places_[i].why});
  std::erase_if(all, [](const Signature& s) { return s.basis.cols() == 0; });
  known_.without_law = places_without_law(all, observations, *whatever_);
}

std::vector<double> weights_of(const std::vector<Signature>& all) {
  constexpr double share_of_places = 0.5;  // of the entries
  const auto is_place = [](const Signature& s) { return s.effect.effect && s.effect.effect->place; };
  const std::map<std::string, double> legs = count_by_name(all);
  const auto share = [&](const Signature& s) { return s.effect.leg ? 1 / legs.at(s.effect.effect->name) : 1; };
  double entries = 0, laws = 0;
  for (const Signature& s : all) (is_place(s) ? laws : entries) += is_place(s) ? share(s) : 1;
  const double each = entries > 0 ? std::min(1.0, share_of_places * entries / laws) : 1;
  std::vector<double> out;
  for (const Signature& s : all) out.push_back(is_place(s) ? each * share(s) : 1);
  return out;
}

std::optional<VectorX> guess(const Signature& s, const VectorX& residual) {
  const effects::Effect& e = *s.effect.effect;
  if (e.parameters.size() != 1) return std::nullopt;
  const effects::EffectParameter& p = e.parameters.front();
  if (!p.vanishes) return std::nullopt;
  // With s the change of the residual r at the start: to take r away the effect must be −⟨r, s⟩/⟨s, s⟩ times that
  // large.
  const double times = -s.start_along(residual) / s.start.squaredNorm();
  const bool infinite = std::isinf(*p.vanishes);
  double value = infinite ? p.start / times : *p.vanishes + times * (p.start - *p.vanishes);
  if (infinite && !(times > 0)) return std::nullopt;
  if (p.log && !(value > 0)) value = times > 0 ? p.high : p.low;
  value = std::clamp(value, p.low, p.high);
  return VectorX::Constant(1, value);
}

double most_gain(const Signature& s, const VectorX& residual, const MatrixX& beside) {
  MatrixX columns = s.basis;
  if (beside.cols() > 0) columns -= beside * (beside.transpose() * columns);
  if (s.shaped) {
    double most = 0;
    for (const auto column : columns.colwise()) {
      const double along = column.dot(residual);  // against the effect's own change of the residual
      if (column.norm() > 1e-3 && !(s.one_sided && along > 0))
        most = std::max(most, along * along / column.squaredNorm());
    }
    return most;
  }
  return (statistics::orthonormal(columns, 1e-3).transpose() * residual).squaredNorm();
}

double own_share(const Signature& s, const MatrixX& beside) {
  if (beside.cols() == 0) return 1;
  return (s.basis - beside * (beside.transpose() * s.basis)).norm() / std::sqrt(static_cast<double>(s.basis.cols()));
}

double cosine(const Signature& a, const Signature& b) { return cosine(a, b, a.basis.transpose() * b.basis); }

MatrixX inner_products(const std::vector<Signature>& all, int threads) {
  Eigen::Index columns = 0;
  for (const Signature& s : all) columns += s.basis.cols();
  MatrixX out = MatrixX::Zero(columns, columns);
  if (all.empty()) return out;
  constexpr Eigen::Index some = 2048,
                         wide = 64;  // rows side by side at a time; columns of a case, whatever the threads
  const Eigen::Index rows = all.front().basis.rows();
  MatrixX part;
  for (Eigen::Index first = 0; first < rows; first += some) {
    part.resize(std::min(some, rows - first), columns);
    Eigen::Index at = 0;
    for (const Signature& s : all) {
      part.middleCols(at, s.basis.cols()) = s.basis.middleRows(first, part.rows());
      at += s.basis.cols();
    }
    parallel::for_each_case(as_size((columns + wide - 1) / wide), 1, threads, [&](std::size_t k) {
      const Eigen::Index from = as_index(k) * wide, count = std::min(wide, columns - from), below = columns - from;
      out.block(from, from, below, count).noalias() += part.rightCols(below).transpose() * part.middleCols(from, count);
    });
  }
  return out.selfadjointView<Eigen::Lower>();
}

MatrixX cosines(const std::vector<Signature>& all, const MatrixX& inner) {
  MatrixX out(std::ssize(all), std::ssize(all));
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Eigen::Index column = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      out(as_index(i), as_index(k)) =
          cosine(all[i], all[k], inner.block(row, column, all[i].basis.cols(), all[k].basis.cols()));
      column += all[k].basis.cols();
    }
    row += all[i].basis.cols();
  }
  return out;
}

std::vector<std::size_t> classes_of(const std::vector<Signature>& all, const MatrixX& inner_products) {
  constexpr double alike = 0.999;  // cosine from which signatures are one
  std::vector<std::size_t> out(all.size());
  const MatrixX between = cosines(all, inner_products);
  for (std::size_t i = 0; i < all.size(); ++i) {
    out[i] = i;
    for (std::size_t k = 0; k < i; ++k)
      if (all[i].amplitudes() == all[k].amplitudes() && all[i].shaped == all[k].shaped &&
          between(as_index(i), as_index(k)) > alike) {
        out[i] = out[k];
        break;
      }
  }
  return out;
}

bool lets_go(const effects::Effect& e) {
  if (!e.place || e.place->freedoms.size() != 1 || e.parameters.size() != 1) return false;
  const effects::EffectParameter& p = e.parameters.front();
  if (!p.log || !p.vanishes) return false;
  if (e.place->one_stiffness && *p.vanishes == 1)
    return std::all_of(e.edits.begin(), e.edits.end(), [](const effects::EffectEdit& edit) {
      return edit.action == effects::EffectEdit::Action::multiply && edit.paths.front().ends_with(".stiffness");
    });
  const std::optional<Law> law = effects::law_in_series(e);
  return law && (std::holds_alternative<LinearLaw>(*law) || std::holds_alternative<ClearanceLaw>(*law) ||
                 std::holds_alternative<OneSidedLaw>(*law));
}

std::vector<char> those_that_let_go(const std::vector<Signature>& all) {
  std::vector<char> out;
  for (const Signature& s : all) out.push_back(lets_go(*s.effect.effect));
  return out;
}

std::vector<double> summed(const std::vector<double>& x, const std::vector<std::size_t>& classes) {
  std::vector<double> sum(x.size(), 0), out;
  for (std::size_t i = 0; i < x.size(); ++i) sum[classes[i]] += x[i];
  for (const std::size_t c : classes) out.push_back(sum[c]);
  return out;
}

std::vector<double> shared_priors(const std::vector<Signature>& all, const std::vector<std::size_t>& classes,
                                  double all_together) {
  const std::map<std::string, double> places = count_by_name(all);
  const std::vector<double> looks = weights_of(all);
  std::vector<double> weight, largest(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const effects::Effect& e = *all[i].effect.effect;
    weight.push_back(e.place ? looks[i] : looks[i] / places.at(e.name));
    largest[classes[i]] = std::max(largest[classes[i]], weight[i]);
  }
  const std::vector<double> together = summed(weight, classes);
  double total = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    weight[i] *= largest[classes[i]] / together[i];
    total += weight[i];
  }
  for (double& w : weight) w *= all_together / total;
  return weight;
}

}  // namespace deflect::diagnosis
