#include "validation/validity/numerical.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/index.h"
#include "msa/frame/file/frame_description.h"
#include "msa/frame/mechanism/build.h"
#include "validation/measurement/configure_all.h"

namespace deflect::validity {
namespace {

constexpr double safety = 1.25, safety_without_order = 3, coverage = 1.15;
constexpr double most_order = 4, least_order = 0.5;
constexpr double rounding = 1e-9;  // relative difference of predictions

/// By the MSA with every element halved so many times.
VectorX by_halved_elements(const subject::Subject& s, const fit::PredictedPlan& plan, int halvings,
                           const parallel::Work& work) {
  prediction::PredictionOptions o;
  o.theory = &theories::theory("msa");
  o.geometry = s.true_geometry();
  std::shared_ptr<const subject::Standing> standing;
  if (s.frame()) {
    frame::FrameDescription finer = *s.frame();
    for (auto& [name, member] : finer.members) member.elements <<= halvings;
    standing = subject::Subject(std::move(finer)).stand(plan.plan);
  } else {
    const std::vector<Configuration> at = measurement::configure_all(*s.machine(), plan.plan);
    for (int i = 0; i < halvings && !at.empty(); ++i) o.division = frame::halved(at.front(), o.division);
    standing = s.stand(plan.plan);
  }
  const std::vector<VectorX> all = standing->predict(plan.plan, o, work);
  VectorX out(std::ssize(plan.numbers));
  for (std::size_t i = 0; i < plan.numbers.size(); ++i)
    out(as_index(i)) = all[plan.numbers[i].reading](as_index(plan.numbers[i].channel));
  return out;
}

double rms_of_rows(const VectorX& x, const std::vector<Eigen::Index>& rows) {
  return std::sqrt(x(rows).squaredNorm() / static_cast<double>(rows.size()));
}

/// The rows of one quantity.
void judge(NumericalStudy& out, const std::vector<VectorX>& f, const VectorX& S, measurement::Quantity quantity,
           const std::vector<Eigen::Index>& rows) {
  MeshOrder found{quantity, rms_of_rows(f[0] - f[1], rows), rms_of_rows(f[1] - f[2], rows), {}};
  double order = most_order, factor = safety;
  if (std::max(found.first, found.second) > rounding * rms_of_rows(S, rows)) {
    const double observed = std::log2(found.first / found.second);
    if (!(observed >= least_order)) factor = safety_without_order;
    order = std::clamp(observed, least_order, most_order);
    found.order = observed;
  }
  const VectorX extrapolated = f[2] + (f[2] - f[1]) / (std::exp2(order) - 1);
  for (const Eigen::Index i : rows) out.u[as_size(i)] = factor * std::abs(S(i) - extrapolated(i)) / coverage;
  out.orders.push_back(found);
}

}  // namespace

NumericalStudy numerical_study(const subject::Subject& s, const fit::PredictedPlan& plan, const parallel::Work& work) {
  NumericalStudy out;
  out.u.assign(plan.numbers.size(), 0);
  const std::size_t msa = theories::place_of(plan.theories, "msa");
  std::vector<VectorX> f(1, VectorX(std::ssize(plan.numbers)));
  VectorX S(std::ssize(plan.numbers));
  std::set<measurement::Quantity> quantities;
  for (std::size_t i = 0; i < plan.numbers.size(); ++i) {
    f[0](as_index(i)) = plan.numbers[i].by_theory[msa];
    S(as_index(i)) = plan.numbers[i].by_theory.front();
    quantities.insert(plan.numbers[i].quantity);
  }
  f.push_back(by_halved_elements(s, plan, 1, work.part(0, 0.3)));
  f.push_back(by_halved_elements(s, plan, 2, work.part(0.3, 1)));
  for (const measurement::Quantity quantity : quantities) {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < plan.numbers.size(); ++i)
      if (plan.numbers[i].quantity == quantity) rows.push_back(as_index(i));
    judge(out, f, S, quantity, rows);
  }
  return out;
}

}  // namespace deflect::validity
