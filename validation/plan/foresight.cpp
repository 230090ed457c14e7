#include "validation/plan/foresight.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/diagnosis/signatures.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/random.h"
#include "validation/parallel/cases.h"
#include "validation/plan/campaign_aims.h"
#include "validation/prediction/campaign.h"
#include "validation/subject/trials.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;
using measurement::Reading;

constexpr int test_poses = 12;
constexpr double seen = 1e-3;                // λ at the start, below which a campaign shows nothing of an effect
constexpr double as_large = 8;               // λ of an effect in the given campaign
constexpr std::size_t short_campaign = 100;  // readings, up to which one is chosen from nothing too

/// Where the machine will be used, if nobody says: the largest force of the campaign at poses of its workspace, or at
/// its own poses.
Measurements usual_use(const subject::Subject& s, const Measurements& plan, const Limits& limits, std::uint64_t seed) {
  Measurements out;
  out.origin = "use";
  if (s.frame()) {
    out = plan;
    return out;
  }
  measurement::Random random(seed + 17);
  const auto drawn = outcome_of([&] { return prediction::tilted_poses(*s.machine(), test_poses, random); });
  if (drawn)
    for (const Vector6& at : *drawn) out.poses.push_back({fmt::format("use {}", out.poses.size() + 1), at, {}, {}});
  else
    out.poses = plan.poses, out.joint_rotates = plan.joint_rotates;
  const double force = limits.force.value_or(subject::largest_loads(s, plan).force);
  for (std::size_t p = 0; p < out.poses.size(); ++p) {
    out.poses[p].readings.clear();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Reading r;
      r.pose = p;
      r.load = force * Vector6::Unit(axis);
      r.sequence = static_cast<double>(out.readings.size() + 1);
      r.line = out.readings.size() + 2;
      out.poses[p].readings.push_back(out.readings.size());
      out.readings.push_back(r);
    }
  }
  return out;
}

/// Tolerances but for the zeros of sensors, which say nothing of the machine.
std::vector<std::size_t> parameters_of(const std::vector<subject::Tolerance>& all) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!all[i].pose && !all[i].zero) out.push_back(i);
  return out;
}

/// The plan to be filled in.
Measurements empty_cells(Measurements plan) {
  for (Reading& r : plan.readings) {
    r.displacement.fill(std::nullopt);
    std::fill(r.sensors.begin(), r.sensors.end(), std::nullopt);
  }
  return plan;
}

class Seeing {
 public:
  Seeing(const subject::Subject& s, const std::vector<effects::Effect>& effects, const ForesightOptions& o,
         const Measurements& use, const Channels& read)
      : subject_(s), effects_(effects), o_(o), use_(use), read_(read) {}

  Insight insight(const Measurements& plan, const parallel::Work& work) const {
    Insight out;
    out.readings = empty_cells(plan);
    const Measurements data = filled_in(subject_, plan, o_, false, read_);
    compare::ComparisonOptions options;
    options.as_recorded = true;
    const diagnosis::Observations seen_data(subject_, data, options, work.part(0, 0.7));
    const std::vector<diagnosis::Signature> all =
        diagnosis::signatures(seen_data, effects_, work.threads, &out.left_out);
    out.cosines = diagnosis::cosines(all, diagnosis::inner_products(all, work.threads));
    out.detectable = diagnosis::detectable_sizes(all, out.cosines, true);
    for (const diagnosis::Signature& each : all) out.names.push_back(diagnosis::name_of(each.effect));
    if (work.progress) work.progress(0.9);

    const statistics::ToleranceModel& model = seen_data.comparison().tolerances;
    const std::vector<std::size_t> own = parameters_of(model.nuisances);
    MatrixX A(model.A.rows(), std::ssize(own));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < own.size(); ++i) {
      A.col(as_index(i)) = model.A.shared.col(as_index(own[i]));
      names.push_back(model.nuisances[own[i]].name);
    }
    const MatrixX J = seen_data.uncertainty().whitening()->within_groups(A);
    const MatrixX information = J.transpose() * J;
    out.parameters = own.size();
    out.numbers = as_size(J.rows());
    out.observability = observability(information, static_cast<double>(J.rows()));
    const MatrixX V = sensitivity_in_use(subject_, use_, names, o_, work.quiet());
    const MatrixX one = MatrixX::Identity(J.cols(), J.cols());
    out.error_before = test_pose_error(one, V);
    out.error_after = test_pose_error(Eigen::LLT<MatrixX>(one + information).solve(one), V);
    return out;
  }

 private:
  const subject::Subject& subject_;
  const std::vector<effects::Effect>& effects_;
  const ForesightOptions& o_;
  const Measurements& use_;
  const Channels& read_;
};

/// By how much the change that an effect makes at its start is to be stretched.
double size_of(const diagnosis::Detectable& in_given) {
  return in_given.lambda_at_start > seen ? as_large / in_given.lambda_at_start : 1;
}

/// Insight::separations, from the signatures: λ at the start and cosines. Effects that one campaign does not show at
/// all are not in its rows; their λ is 0.
MatrixX separations(const Insight& of, const Insight& given) {
  const auto n = std::ssize(given.names);
  MatrixX out = MatrixX::Zero(n, n);
  std::vector<Eigen::Index> at;
  for (const std::string& name : given.names)
    at.push_back(std::find(of.names.begin(), of.names.end(), name) - of.names.begin());
  for (Eigen::Index i = 0; i < n; ++i) {
    if (nth(at, i) == std::ssize(of.names)) continue;
    const double lambda = size_of(nth(given.detectable, i)) * nth(of.detectable, nth(at, i)).lambda_at_start;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double c = nth(at, k) == std::ssize(of.names) ? 0 : of.cosines(nth(at, i), nth(at, k));
      out(i, k) = lambda * lambda * std::max(0.0, 1 - c * c);
    }
  }
  return out;
}

/// What every effect changes in the readings that could be taken, as large as it is λ = 8 in the campaign given.
MatrixX changes(const Prospect& prospect, const subject::Subject& s, const Insight& given, int threads) {
  const VectorX nominal = prospect.predicted(s);
  std::vector<std::optional<VectorX>> all(given.detectable.size());
  parallel::for_each_case(all.size(), 1, threads, [&](std::size_t i) {
    const diagnosis::Detectable& d = given.detectable[i];
    const auto changed = outcome_of([&]() -> std::optional<VectorX> {
      const subject::Subject with =
          effects::with_effect(s, effects::EffectInstance{d.effect, effects::start_values(*d.effect.effect)});
      if (with.stand(prospect.readings())->has_history()) return std::nullopt;
      return VectorX(prospect.predicted(with) - nominal);
    });
    if (!changed || !*changed || !(*changed)->allFinite()) return;
    all[i] = **changed * size_of(d);
  });
  MatrixX out(nominal.size(), 0);
  for (const std::optional<VectorX>& each : all) {
    if (!each) continue;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.rightCols<1>() = *each;
  }
  return prospect.white(out);
}

/// What is exchanged of the given campaign, or chosen from nothing where that is quick and better.
Choice better_choice(const Aim& aim, const Possible& possible, ChoiceOptions o, const parallel::Work& work) {
  o.begin = possible.given;
  const Choice exchanged = choose(aim, possible.blocks, o, work.part(0, 0.5));
  if (o.readings > short_campaign || exchanged.blocks.empty()) return exchanged;
  o.begin.clear();
  const Choice fresh = choose(aim, possible.blocks, o, work.part(0.5, 1));
  const bool as_long = fresh.readings.back() == exchanged.readings.back();
  return as_long && fresh.values.back() > exchanged.values.back() ? fresh : exchanged;
}

std::vector<Gain> gains_of(const Choice& c, Toward toward) {
  std::vector<Gain> out;
  for (std::size_t i = 0; i < c.values.size(); ++i)
    out.push_back({c.readings[i], toward == Toward::effects ? std::exp(-c.values[i] / 8) / 2
                                                            : std::sqrt(std::max(0.0, -c.values[i]))});
  return out;
}

bool is_better(const Foresight& f) {
  constexpr double less = 1 - 1e-6;  // more than rounding
  if (f.toward == Toward::precision) return f.better.error_after < less * f.given.error_after;
  const Confusion here = confusion(f.given, f.given), there = confusion(f.better, f.given);
  return there.told >= here.told && there.mean < less * here.mean;
}

}  // namespace

double chance_of_confusion(double separation) { return std::erfc(std::sqrt(std::max(0.0, separation) / 8)) / 2; }

Confusion confusion(const Insight& i, const Insight& given) {
  Confusion out;
  const MatrixX& s = i.separations;
  for (Eigen::Index a = 0; a < s.rows(); ++a)
    for (Eigen::Index b = a + 1; b < s.rows(); ++b) {
      if (nth(given.detectable, a).effect.effect == nth(given.detectable, b).effect.effect) continue;
      const double one = chance_of_confusion(s(a, b)), other = chance_of_confusion(s(b, a));
      ++out.pairs;
      out.told += std::max(one, other) < 0.05 ? 1 : 0;
      out.mean += (one + other) / 2;
    }
  if (out.pairs > 0) out.mean /= static_cast<double>(out.pairs);
  return out;
}

Channels channels_of(const subject::Subject& s, const Measurements& plan, const ForesightOptions& o) {
  Channels out;
  out.sensors = plan.instruments.sensors;
  for (const Reading& r : plan.readings)
    for (std::size_t i = 0; i < 6; ++i) out.displacement[i] = out.displacement[i] || r.displacement[i];
  const auto any = [&](std::size_t first) {
    return std::any_of(out.displacement.begin() + as_index(first), out.displacement.end(), [](bool b) { return b; });
  };
  if (out.sensors.empty() && !any(0)) {
    out.sensors = s.instruments().sensors;
    for (std::size_t i = 0; i < 6 && out.sensors.empty(); ++i) out.displacement[i] = i < 3 || o.sigma_th;
  }
  if (any(3) && !o.sigma_th &&
      std::any_of(plan.readings.begin(), plan.readings.end(), [](const Reading& r) { return !r.sigma_th; }))
    throw InputError(
        fmt::format("{}: a rotation is read, and its standard deviation is not told: give a column "
                    "sigma_th_rad, or --sigma-rotation",
                    plan.origin));
  return out;
}

Measurements filled_in(const subject::Subject& s, Measurements plan, const ForesightOptions& o, bool linear,
                       const std::optional<Channels>& channels) {
  const Channels read = channels ? *channels : channels_of(s, plan, o);
  plan.instruments.sensors = read.sensors;
  const std::size_t sensors = read.sensors.size();
  for (Reading& r : plan.readings) {
    r.sensors.assign(sensors, 0.0);
    for (std::size_t i = 0; i < 6; ++i) r.displacement[i] = read.displacement[i] ? std::optional(0.0) : std::nullopt;
    if (!r.sigma_u) r.sigma_u = o.sigma_u;
    if (!r.sigma_th && o.sigma_th) r.sigma_th = o.sigma_th;
  }
  if (sensors > 0 && s.frame() &&
      std::none_of(plan.readings.begin(), plan.readings.end(), [](const Reading& r) { return r.sequence.has_value(); }))
    for (std::size_t i = 0; i < plan.readings.size(); ++i) plan.readings[i].sequence = static_cast<double>(i + 1);
  prediction::PredictionOptions options;
  options.geometry = linear ? Geometry::linear : s.true_geometry();
  const std::vector<VectorX> predicted = s.stand(plan)->predict(plan, options, parallel::alone);
  for (std::size_t i = 0; i < plan.readings.size(); ++i) {
    Reading& r = plan.readings[i];
    for (std::size_t k = 0; k < 6; ++k)
      if (r.displacement[k]) r.displacement[k] = predicted[i](as_index(k));
    for (std::size_t k = 0; k < sensors; ++k) r.sensors[k] = predicted[i](as_index(6 + k));
  }
  return plan;
}

MatrixX sensitivity_in_use(const subject::Subject& s, const Measurements& use, const std::vector<std::string>& names,
                           const ForesightOptions& o, const parallel::Work& work) {
  const Measurements filled = filled_in(s, use, o, true);
  const auto standing = s.stand(filled);
  std::vector<measurement::MeasuredValue> values;
  for (const measurement::MeasuredValue& v : measurement::measured_values(filled, standing->sensor_forms(filled)))
    if (v.quantity == measurement::Quantity::length) values.push_back(v);
  const statistics::ToleranceModel model = statistics::tolerance_model(*standing, filled, values, work);
  MatrixX V = MatrixX::Zero(std::ssize(values), std::ssize(names));
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t k = 0; k < as_size(model.A.shared.cols()); ++k)
      if (model.nuisances[k].name == names[i]) V.col(as_index(i)) = model.A.shared.col(as_index(k));
  return V;
}

Foresight foresight(const subject::Subject& s, const Measurements& plan, const std::vector<effects::Effect>& effects,
                    const ForesightOptions& o, const parallel::Work& work) {
  Foresight out;
  out.subject = s.name();
  out.campaign = plan.origin;
  out.toward = o.toward;
  const Measurements use = o.use ? *o.use : usual_use(s, plan, o.limits, o.seed);
  const Channels read = channels_of(s, plan, o);
  const Seeing seeing(s, effects, o, use, read);
  out.given = seeing.insight(plan, work.part(0, 0.4));
  out.given.separations = separations(out.given, out.given);

  out.read = read.displacement;
  const Measurements data = filled_in(s, plan, o, true, read);
  Possible possible = possible_campaign(s, data, o.limits, o.seed);
  possible.all.readings = filled_in(s, possible.all, o, true, read).readings;
  const Prospect prospect(s, std::move(possible), {o.sigma_u, o.sigma_th}, work.part(0.4, 0.5));
  std::unique_ptr<Aim> aim;
  if (o.toward == Toward::effects) {
    aim = std::make_unique<EffectsAim>(prospect, changes(prospect, s, out.given, work.threads));
  } else {
    MatrixX V = sensitivity_in_use(s, use, prospect.names(), o, work.quiet());
    if (V.rows() == 0)
      throw InputError(
          fmt::format("{}: nothing reads a displacement, whose precision could be planned: take --aim "
                      "effects",
                      s.name()));
    aim = std::make_unique<PrecisionAim>(prospect, std::move(V));
  }
  const std::size_t poses = o.most_poses > 0 ? o.most_poses : plan.poses.size();
  const Choice choice = better_choice(*aim, prospect.possible(),
                                      {plan.readings.size(), s.frame() ? 0 : poses, true, {}}, work.part(0.5, 0.7));
  const ChoiceOptions as_given{plan.readings.size(), 0, false, prospect.possible().given};
  out.given.gain = gains_of(choose(*aim, prospect.possible().blocks, as_given, work.quiet()), o.toward);
  Measurements better = as_plan(prospect.possible(), choice.blocks);
  better.origin = "better campaign";
  out.better = seeing.insight(s.placed(better), work.part(0.7, 1));
  out.better.separations = separations(out.better, out.given);
  out.better.gain = gains_of(choice, o.toward);
  out.tells_more = is_better(out);
  out.allowed = prospect.possible().given.size() == plan.readings.size();
  out.found = out.tells_more || !out.allowed;
  if (!out.found) out.better = out.given;
  return out;
}

}  // namespace deflect::plan
