#include "tests/benchmark/record.h"

#include <chrono>
#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "tests/benchmark/baselines.h"
#include "tests/benchmark/gaussian_process.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/interval.h"
#include "validation/parallel/pack.h"

namespace deflect::benchmark {

using namespace diagnosis;
using namespace effects;
using namespace parallel;
using namespace theories;

template <class Archive>
void serialize(Archive& a, Truth& t) {
  a(t.effects, t.unknown, t.tied);
}

template <class Archive>
void serialize(Archive& a, HiddenEffect& h) {
  a(h.effect, h.site, h.values);
}

template <class Archive>
void serialize(Archive& a, Record& r) {
  a(r.truth, r.hidden, r.lambda, r.separation, r.lambda_left, r.skipped, r.answers, r.new_poses, r.intervals,
    r.covering, r.seconds);
}

namespace {

constexpr const char* everywhere = "geometric_nonlinearity";  // in all data: neither right nor wrong

Answer answer_of(const Diagnosis& d) {
  Answer out;
  out.verdict = verdict_names[static_cast<int>(d.verdict)];
  for (const PlacedEffect& e : d.missing)
    if (e.effect->name != everywhere) out.missing.push_back(e.effect->name);
  if (d.verdict == Verdict::effect && out.missing.empty()) out.verdict = "nothing_missing";
  out.groups = d.indistinguishable;
  for (const Candidate& c : d.candidates) {
    if (c.added().effect->name == everywhere) continue;
    out.first = c.added().effect->name;
    out.probability = c.probability;
    break;
  }
  return out;
}

/// Intervals of effects that are hidden and found, in the same place.
void count_intervals(const Diagnosis& d, const std::vector<EffectInstance>& all, Record& record) {
  std::size_t at = 0;
  for (const PlacedEffect& found : d.missing) {
    for (const EffectInstance& hidden : all) {
      if (hidden.effect->name != found.effect->name || hidden.leg != found.leg) continue;
      for (std::size_t i = 0; i < found.effect->parameters.size(); ++i) {
        const auto [low, high] = interval95(d.missing, d.fit, at + i);
        const double truth = hidden.values(static_cast<Eigen::Index>(i));
        ++record.intervals;
        record.covering += low <= truth && truth <= high;
      }
    }
    at += found.effect->parameters.size();
  }
}

double error(const VectorX& prediction, const VectorX& truth) {
  return std::sqrt((prediction - truth).squaredNorm() / static_cast<double>(truth.size())) / sigma_u;
}

VectorX predicted_by(const Diagnosis& d, const Mechanism& m, const Plan& plan) {
  if (d.missing.empty()) return plan.nominal_elsewhere;
  try {
    return predict_elsewhere(plan, PreparedEffects(m, d.missing).machine(d.fit.values), theory("analytic"));
  } catch (const NumericalError&) {
    return VectorX::Constant(plan.nominal_elsewhere.size(), std::numeric_limits<double>::quiet_NaN());
  }
}

HiddenEffect names_of(const EffectInstance& e) {
  HiddenEffect out{e.effect->name, site_of(e), {}};
  for (std::size_t i = 0; i < e.effect->parameters.size(); ++i)
    out.values.emplace_back(e.effect->parameters[i].name, e.values(static_cast<Eigen::Index>(i)));
  return out;
}

void diagnose_all(const MeasuredSet& set, const Mechanism& m, Record& record) {
  const Plan& plan = *set.plan;
  const auto start = std::chrono::steady_clock::now();
  const Diagnosis d = diagnose(m, set.data, set.known, {}, alone);
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.answers.push_back(answer_of(d));
  count_intervals(d, set.hidden, record);

  const VectorX residual = plan.residual(set.data);
  const std::string left_out = record.order.group == "left-out" ? record.order.effect : "";
  const std::vector<BaselineAnswer> others = baselines(plan, residual, left_out);
  for (const BaselineAnswer& b : others) record.answers.push_back(b.answer);
  if (set.hidden.empty() || set.truth.unknown) return;
  VectorX truth;
  try {
    truth = predict_elsewhere(plan, set.machine, theory("msa"));
  } catch (const NumericalError&) {  // no equilibrium at one of the new poses
    return;
  }
  record.new_poses.push_back(error(predicted_by(d, m, plan), truth));
  for (const BaselineAnswer& b : others) record.new_poses.push_back(error(plan.nominal_elsewhere + b.elsewhere, truth));
  record.new_poses.push_back(error(plan.nominal_elsewhere + gaussian_process(plan, residual), truth));
  record.new_poses.push_back(error(plan.nominal_elsewhere, truth));
}

}  // namespace

std::string packed(const Record& r) { return pack(r); }

Record unpacked(const std::string& bytes, const Case& order) {
  Record out = unpack<Record>(bytes);
  out.order = order;
  return out;
}

Record run(const Case& c, const Mechanism& m, const std::vector<Effect>& effects, Plans& plans) {
  Record out;
  out.order = c;
  try {
    const MeasuredSet set = measured_set(c, m, effects, plans);
    out.truth = set.truth;
    for (const EffectInstance& hidden : set.hidden) out.hidden.push_back(names_of(hidden));
    out.lambda = set.lambda;
    out.separation = set.separation;
    out.lambda_left = set.lambda_left;
    out.skipped = set.skipped;
    if (out.skipped.empty()) diagnose_all(set, m, out);
  } catch (const std::runtime_error& e) {
    out.skipped = e.what();
  }
  return out;
}

}  // namespace deflect::benchmark
