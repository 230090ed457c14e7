#include "validation/studies/errata_prices.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/base/stiffness_checks.h"

namespace deflect::studies {
namespace {

/// The checks of a theory as printed, which are told but not enforced.
std::string failed_checks(const analytic::AnalyticModel& model, const analytic::AnalyticSolution& s) {
  std::vector<LegStiffness> legs;
  for (std::size_t i = 0; i < model.chains().size(); ++i)
    legs.push_back({model.chains()[i].name, model.leg_stiffness(i, s), model.chains()[i].J_q});
  return check_stiffness(model.stiffness(s), legs).failure;
}

/// The configuration with line contacts that know the bulk of two equal cylinders: what (30) leaves out.
Configuration with_bulk(Configuration c) {
  for_each_part(c.legs, [](auto& part) {
    if constexpr (requires { part.laws; })
      for (std::vector<Law>& laws : part.laws)
        for (Law& law : laws)
          if (const auto* l = std::get_if<HertzLineLaw>(&law))
            law = HertzLineBulkLaw{l->material, 2 * l->radius, 2 * l->radius, l->length, l->solid};
  });
  return c;
}

}  // namespace

analytic::AnalyticSolution solved_as_printed(const analytic::AnalyticModel& printed, const Vector6& F) {
  analytic::AnalyticSolution s = printed.solve(F);
  if (!s.converged)
    throw NumericalError(
        fmt::format("the analytic theory did not converge in {} steps (misfit {:.3g})", s.iterations, s.misfit));
  return s;
}

std::vector<ErratumPrice> price_errata(const Mechanism& m, const std::vector<ValidationPoint>& points, double load_N) {
  std::vector<ErratumPrice> prices;
  for (const ErratumInfo& erratum : errata()) {
    ErratumPrice price{erratum.erratum, Vector3::Constant(std::numeric_limits<double>::infinity()),
                       Vector3::Constant(-std::numeric_limits<double>::infinity()), "", ""};
    const auto priced = outcome_of([&] {
      for (const ValidationPoint& point : points) {
        const Configuration c = configure(m, pose_from(point.pose_mm_deg));
        const analytic::AnalyticModel corrected(erratum.erratum == Erratum::line_contact ? with_bulk(c) : c);
        const analytic::AnalyticModel printed(c, {erratum.erratum});
        for (int axis = 0; axis < 3; ++axis) {
          const Vector6 F = load_N * Vector6::Unit(axis);
          const analytic::AnalyticSolution s = solved_as_printed(printed, F);
          const double ratio = s.displacement(axis) / solved_as_printed(corrected, F).displacement(axis);
          price.smallest(axis) = std::min(price.smallest(axis), ratio);
          price.largest(axis) = std::max(price.largest(axis), ratio);
          if (price.failed_check.empty()) price.failed_check = failed_checks(printed, s);
        }
      }
      return true;
    });
    price.refused = priced.why;
    prices.push_back(std::move(price));
  }
  return prices;
}

}  // namespace deflect::studies
