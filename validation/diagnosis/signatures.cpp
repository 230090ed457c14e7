#include "validation/diagnosis/signatures.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/compare/channel_shapes.h"
#include "validation/diagnosis/by_statics.h"
#include "validation/effects/law_of_effect.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/tail.h"

namespace deflect::diagnosis {
namespace {

constexpr double unseen = 1e-6;  // of a whitened change at the start: nothing that these data show

/// Of amplitudes together: the start and each of them a hundredth to a hundred times, which spans what they can do.
///
/// Where parameters shape the effect: the start, and what shapes it a thirtieth and thirty times, from never slipping
/// to slipping at once, from hardly bent to bent at every load; an amplitude that starts from nothing thirty times too,
/// since friction as large as the loads is no multiple of a little.
std::vector<VectorX> shapes(const std::vector<effects::EffectParameter>& all, const VectorX& start, bool shaped) {
  std::vector<VectorX> out = {start};
  if (all.size() == 1) return out;
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

/// Parameter by parameter where each can vanish alone, else all at the start; parameters that only shape the effect
/// are tried at several values.
MatrixX directions(const Observations& o, const effects::PlacedEffect& e, const VectorX& start, bool& shaped) {
  const effects::PreparedEffects prepared(o.subject(), {e});
  const std::vector<effects::EffectParameter>& all = e.effect->parameters;
  const auto change = [&](const VectorX& values) {
    return VectorX(o.whitened_residual(prepared(values)) - o.null_residual());
  };
  std::vector<VectorX> columns;
  shaped = is_shaped(e);
  bool separate = all.size() > 1;
  for (const effects::EffectParameter& p : all) separate = separate && p.vanishes && std::isfinite(*p.vanishes);
  if (separate)
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      VectorX values = start;
      for (Eigen::Index k = 0; k < start.size(); ++k)
        if (k != i) values(k) = *nth(all, k).vanishes;
      columns.push_back(change(values));
    }
  else
    for (const VectorX& values : shapes(all, start, shaped)) columns.push_back(change(values));
  MatrixX out(o.null_residual().size(), std::ssize(columns));
  for (std::size_t i = 0; i < columns.size(); ++i) out.col(as_index(i)) = columns[i];
  return out;
}

/// Those that are not 0.
MatrixX unit_columns(const MatrixX& X) {
  MatrixX out(X.rows(), 0);
  for (const auto column : X.colwise())
    if (column.norm() > unseen) {
      out.conservativeResize(Eigen::NoChange, out.cols() + 1);
      out.rightCols<1>() = column.normalized();
    }
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

double tail(int freedoms, bool one_sided, double gain) {
  if (!(gain > 0)) return 1;
  const double p = statistics::chi_squared_tail(freedoms, gain);
  return one_sided ? p / 2 : p;
}

/// Of a law at a place, which is one of the subject's own.
std::vector<effects::PlacedEffect> every_leg(const effects::Effect& e, const subject::Subject& subject) {
  if (e.scope != effects::Scope::one_leg) return {{&e, {}}};
  std::vector<effects::PlacedEffect> out;
  for (int leg = 1; leg <= subject.legs(); ++leg) out.push_back({&e, leg});
  return out;
}

/// What may be wrong with a sensor's channel, as unit columns. What tolerances hide, as a free zero does a constant, is
/// left out.
class ChannelFaults {
 public:
  explicit ChannelFaults(const Observations& o) {
    constexpr double hidden = 1e-3;  // of the length that it has beside noise alone
    const std::vector<double>& sigma = o.comparison().sigma;
    const VectorX noise = Eigen::Map<const VectorX>(sigma.data(), std::ssize(sigma));
    for (const auto& [sensor, shapes] : compare::channel_shapes(o.comparison().study)) {
      MatrixX columns = o.uncertainty().whitened(shapes);
      for (Eigen::Index k = 0; k < columns.cols(); ++k)
        if (columns.col(k).norm() < hidden * shapes.col(k).cwiseQuotient(noise).norm()) columns.col(k).setZero();
      all_[sensor] = std::make_shared<const MatrixX>(unit_columns(columns));
    }
  }

  /// Null for an effect that is not at a sensor.
  std::shared_ptr<const MatrixX> at(const effects::PlacedEffect& e) const {
    const auto found = e.effect->place ? all_.find(subject::sensor_of(*e.effect->place)) : all_.end();
    return found == all_.end() ? nullptr : found->second;
  }

 private:
  std::map<std::string, std::shared_ptr<const MatrixX>> all_;
};

}  // namespace

std::vector<Signature> signatures(const Observations& o, const std::vector<effects::Effect>& effects, int threads,
                                  std::vector<LeftOut>* left_out) {
  std::vector<effects::PlacedEffect> places;
  for (const effects::Effect& e : effects) {
    if (effects::is_geometry(e)) continue;
    const std::vector<effects::PlacedEffect> own =
        e.place ? every_leg(e, o.subject()) : effects::places_of(e, o.subject());
    places.insert(places.end(), own.begin(), own.end());
    if (left_out && own.empty()) {
      const auto leg = e.scope == effects::Scope::one_leg ? std::optional(1) : std::nullopt;
      left_out->push_back({e.name, effects::why_not(e, o.subject(), leg).value_or("")});
    }
  }
  std::vector<Signature> all(places.size());
  std::vector<std::string> why(places.size());
  const ByStatics statics(o, places, threads);
  const ChannelFaults channels(o);
  parallel::for_each_case(places.size(), 1, threads, [&](std::size_t i) {
    Signature& s = all[i];
    s.effect = places[i];
    s.whatever_the_law = channels.at(places[i]);
    const auto looked_at = outcome_of([&] {
      if (std::optional<VectorX> change = statics.change(places[i])) {
        s.one_sided = one_sided(places[i]);
        s.lambda = change->norm();
        s.start = VectorX::Constant(1, s.lambda);
        if (s.lambda > unseen)
          s.basis = *change / s.lambda;
        else
          why[i] = "changes nothing that was measured";
        return true;
      }
      const VectorX start = effects::start_values(*places[i].effect);
      const MatrixX columns = directions(o, places[i], start, s.shaped);
      const VectorX at_start =
          !s.shaped && columns.cols() == start.size() ? VectorX(columns.rowwise().sum()) : VectorX(columns.col(0));
      s.lambda = at_start.norm();
      s.one_sided = s.shaped ? amplitude_from_nothing(*places[i].effect) : one_sided(places[i]);
      if (!columns.allFinite())
        why[i] = "the prediction with it is no number";
      else if (columns.norm() > unseen)
        s.basis = s.shaped ? unit_columns(columns) : statistics::orthonormal(columns);
      else
        why[i] = "changes nothing that was measured";
      if (s.basis.cols() == 0) return true;
      if (!s.shaped)
        s.start = s.basis.transpose() * at_start;
      else if (s.start = VectorX::Zero(s.basis.cols()); s.lambda > unseen)
        s.start(0) = s.lambda;  // its first column
      return true;
    });
    // The subject cannot stand with it, or it wants what the file does not have: a sequence.
    if (!looked_at) why[i] = looked_at.why;
  });
  for (std::size_t i = 0; left_out && i < all.size(); ++i)
    if (all[i].basis.cols() == 0 && !places[i].effect->place) left_out->push_back({name_of(places[i]), why[i]});
  std::erase_if(all, [](const Signature& s) { return s.basis.cols() == 0; });
  return all;
}

std::vector<double> weights_of(const std::vector<Signature>& all) {
  constexpr double share_of_places = 0.15;
  const auto is_place = [](const Signature& s) { return s.effect.effect && s.effect.effect->place; };
  const auto places = static_cast<double>(std::count_if(all.begin(), all.end(), is_place));
  const double entries = static_cast<double>(all.size()) - places;
  const double each = entries > 0 ? std::min(1.0, share_of_places * entries / places) : 1;
  std::vector<double> out;
  for (const Signature& s : all) out.push_back(is_place(s) ? each : 1);
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

MatrixX inner_products(const std::vector<Signature>& all) {
  Eigen::Index columns = 0;
  for (const Signature& s : all) columns += s.basis.cols();
  MatrixX out = MatrixX::Zero(columns, columns);
  if (all.empty()) return out;
  constexpr Eigen::Index some = 2048;  // rows side by side at a time
  const Eigen::Index rows = all.front().basis.rows();
  MatrixX part;
  for (Eigen::Index first = 0; first < rows; first += some) {
    part.resize(std::min(some, rows - first), columns);
    Eigen::Index at = 0;
    for (const Signature& s : all) {
      part.middleCols(at, s.basis.cols()) = s.basis.middleRows(first, part.rows());
      at += s.basis.cols();
    }
    out.noalias() += part.transpose() * part;
  }
  return out;
}

MatrixX cosines(const std::vector<Signature>& all) { return cosines(all, inner_products(all)); }

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
  const std::optional<Law> law = effects::law_in_series(e, effects::start_values(e));
  return law && (std::holds_alternative<LinearLaw>(*law) || std::holds_alternative<ClearanceLaw>(*law) ||
                 std::holds_alternative<OneSidedLaw>(*law));
}

std::vector<char> those_that_let_go(const std::vector<Signature>& all) {
  std::vector<char> out;
  for (const Signature& s : all) out.push_back(lets_go(*s.effect.effect));
  return out;
}

bool at_one_place(const effects::PlacedEffect& a, const effects::PlacedEffect& b) {
  const std::optional<subject::Place>&at = a.effect->place, &other = b.effect->place;
  return at && other && a.leg == b.leg && a.effect->scope == b.effect->scope &&
         subject::id_of(*at) == subject::id_of(*other);
}

double single_p_value(const Signature& s, double gain) { return tail(s.amplitudes(), s.one_sided, gain); }

double gain_at_p_value(const Signature& s, double p) {
  const double own = s.one_sided ? 2 * p : p;
  return own < 1 ? statistics::chi_squared_at_tail(s.amplitudes(), own) : 0;
}

std::vector<double> summed(const std::vector<double>& x, const std::vector<std::size_t>& classes) {
  std::vector<double> sum(x.size(), 0), out;
  for (std::size_t i = 0; i < x.size(); ++i) sum[classes[i]] += x[i];
  for (const std::size_t c : classes) out.push_back(sum[c]);
  return out;
}

std::vector<double> shared_priors(const std::vector<Signature>& all, const std::vector<std::size_t>& classes,
                                  double all_together) {
  std::map<std::string, double> places;
  for (const Signature& s : all) places[s.effect.effect->name] += 1;
  const std::vector<double> looks = weights_of(all);
  std::vector<double> weight, largest(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    weight.push_back(looks[i] / places[all[i].effect.effect->name]);
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
