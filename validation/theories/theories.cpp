#include "validation/theories/theories.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analytic/constraint.h"
#include "analytic/model.h"
#include "meshes/structure.h"
#include "msa/base/error.h"
#include "msa/base/stiffness_checks.h"
#include "msa/mechanism/configuration.h"
#include "validation/theories/agreement.h"
#include "validation/theories/at_pose.h"
#include "validation/theories/solve_result.h"

namespace deflect {
namespace {

/// Both theories at one pose.
struct Pair {
  Pair(const Mechanism& m, const Stand& at, const frame::MemberDivision& division)
      : analytic(at.configuration, where(m, at)), msa(at.configuration, division, where(m, at)) {}

  static std::string where(const Mechanism& m, const Stand& at) {
    return fmt::format("{} at ({:.6g})", m.name, fmt::join(at.pose_mm_deg, ", "));
  }

  /// By how much rounding may be amplified in an answer.
  double rounding(const Answer& answer, double length) const {
    return std::max(msa.rounding(), rounding_of(answer, length));
  }
  /// How far the theories may be apart in linear geometry.
  double bound(const Answer& answer, double length) const {
    return agreement_bound(analytic.model().linear(), rounding(answer, length));
  }

  AnalyticAtPose analytic;
  MsaAtPose msa;
};

/// Equilibrium, or NumericalError where there is none to be found.
analytic::AnalyticSolution solved(const analytic::AnalyticModel& printed, const Vector6& F) {
  analytic::AnalyticSolution s = printed.solve(F);
  if (!s.converged)
    throw NumericalError(
        fmt::format("the analytic theory did not converge in {} steps (misfit {:.3g})", s.iterations, s.misfit));
  return s;
}

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

std::optional<Assembly> assembly_of(const Configuration& c, Pair& pair) {
  const auto fits = [](const PlacedLeg& leg) { return leg.misfit.isZero(0); };
  if (std::all_of(c.legs.begin(), c.legs.end(), fits)) return std::nullopt;
  const analytic::AnalyticSolution s = pair.analytic.model().assembled();
  Assembly out{twist_in_mm(s.displacement), twist_in_mm(pair.msa.offset()), {}};
  for (std::size_t i = 0; i < c.legs.size(); ++i)
    out.leg_wrenches_N_Nmm.emplace_back(c.legs[i].name, wrench_in_mm(s.leg_wrenches[i]));
  return out;
}

double from_linear(const Answer& deformed, const Answer& linear) {
  return relative_difference(twist_in_mm(deformed.displacement), twist_in_mm(linear.displacement));
}

/// What dividing members leaves of relative_difference(a, f), f in mm and rad.
double left_by_division(const Answer& a, const Answer& f, const Vector6& displacement) {
  const Eigen::Vector2d left = a.discretisation + f.discretisation;
  Vector6 moved = displacement;
  moved.head<3>() += 1e3 * left(0) * Vector3::UnitX();
  moved.tail<3>() += left(1) * Vector3::UnitX();
  return relative_difference(moved, displacement);
}

/// In the deformed shape theories may differ by what dividing members leaves, estimated by each; in second order by the
/// squares of the change and of the rotation, which both leave out in ways of their own; where laws jump by the change
/// itself, because the closed form takes their jumps in linear geometry.
void require_agreement_deformed(const Pair& pair, Geometry geometry, double discretisation, double from_linear,
                                double rotation, double apart, const std::string& where) {
  constexpr double solved_to = 1e-6, estimate_is_known_to = 10;
  double bound = solved_to + estimate_is_known_to * discretisation;
  if (geometry == Geometry::second_order) bound += from_linear * from_linear + rotation * rotation;
  if (pair.analytic.model().jumps()) bound += from_linear;
  if (apart > bound)
    throw NumericalError(fmt::format(
        "{}: the two theories disagree in the deformed shape: displacements differ by {:.1e}, bound {:.0e}. "
        "One of the two is wrong here: no answer is given",
        where, apart, bound));
}

/// No member in fewer than eight elements.
frame::MemberDivision refined(const Configuration& c, frame::MemberDivision division) {
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.section; }) {
      std::vector<double>& at = division[part.part];
      if (at.size() >= 9) return;
      at.clear();
      for (int i = 0; i <= 8; ++i) at.push_back(i / 8.0);
    }
  });
  return division;
}

/// m and rad of a device of this size, without what is the rounding of its coordinates.
Vector6 above_rounding(const Vector6& moved, double size) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  Vector6 out = moved;
  for (int i = 0; i < 6; ++i)
    if (std::abs(out(i)) < epsilon * (i < 3 ? size : 1)) out(i) = 0;
  return out;
}

Vector6 along(int axis, double force) { return force * Vector6::Unit(axis); }

}  // namespace

double relative_difference(const Vector6& a, const Vector6& b) {
  const auto relative = [](double difference, double size) {
    return size > 0 ? difference / size : difference > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  const double translation = b.head<3>().norm(), rotation = b.tail<3>().norm();  // mm, rad
  return std::max(relative((a - b).head<3>().norm(), std::max(translation, rotation * 1.0)),
                  relative((a - b).tail<3>().norm(), std::max(rotation, translation / 1000.0)));
}

SolveResult solve(const Mechanism& m, const Stand& at, const Vector6& load, const frame::MemberDivision& division,
                  Geometry geometry) {
  const bool linear = geometry == Geometry::linear;
  Pair pair(m, at, linear ? division : refined(at.configuration, division));
  const Vector6 F = wrench_from_mm(load);
  const double size = at.configuration.size;
  SolveResult r;
  r.geometry = geometry;
  std::optional<Answer> linear_a, linear_f;
  if (!linear) {
    linear_a = pair.analytic.solve(F);
    linear_f = pair.msa.solve(F);
  }
  const Answer a = pair.analytic.solve(F, geometry), f = pair.msa.solve(F, geometry);
  if (linear) require_agreement(a, f, size, pair.bound(f, size), Pair::where(m, at));
  if (!linear) {
    r.analytic_from_linear = from_linear(a, *linear_a);
    r.msa_from_linear = from_linear(f, *linear_f);
    r.discretisation = left_by_division(a, f, twist_in_mm(f.displacement));
    require_agreement_deformed(pair, geometry, r.discretisation, r.msa_from_linear, f.displacement.tail<3>().norm(),
                               relative_difference(twist_in_mm(a.displacement), twist_in_mm(f.displacement)),
                               Pair::where(m, at));
  }
  r.pose_mm_deg = at.pose_mm_deg;
  r.load_N_Nmm = load;
  // Of a device that is held rigidly but for some motions, displacements may be the rounding of coordinates.
  const auto moved = [&](const Answer& x) {
    return x.rigid > 0 ? above_rounding(x.displacement, size) : x.displacement;
  };
  r.analytic = {twist_in_mm(moved(a)), stiffness_in_mm(a.stiffness)};
  r.msa = {twist_in_mm(moved(f)), stiffness_in_mm(f.stiffness)};
  r.relative_difference = relative_difference(r.analytic.displacement_mm_rad, r.msa.displacement_mm_rad);
  r.symmetric = a.checks.symmetric && f.checks.symmetric;
  r.positive = a.checks.positive && f.checks.positive;
  r.passive_joints_free = a.checks.passive_joints_free && f.checks.passive_joints_free;
  double total = 0;
  for (const auto& [part, energy] : f.energies) total += energy;
  if (total > 0)
    for (const auto& [part, energy] : f.energies) r.shares.emplace_back(part, energy / total);
  r.notes = pair.msa.notes();
  r.rigid_motions = a.rigid_motions;
  if (const double known = bound_with(0, pair.rounding(f, size)); linear && known > 1e-9)
    r.notes.push_back(fmt::format(
        "the device amplifies the rounding of its own numbers: the answer is known to about {:.0e} of its size",
        known));
  for (const Actuator& joint : at.configuration.actuators)
    r.joints.push_back({joint.name, joint.rotation ? joint.value : 1e3 * joint.value, joint.rotation});
  r.redundant_constraints = analytic::redundant_constraints(at.configuration);
  r.assembly = assembly_of(at.configuration, pair);
  if (!f.floating.loose.empty())
    r.floating = {f.floating.loose, twist_in_mm(above_rounding(f.floating.least, size)),
                  twist_in_mm(above_rounding(f.floating.most, size))};
  r.mesh = lines_of(pair.msa.mechanism());
  r.fields = fields_of(pair.msa.mechanism(), pair.msa.displacements(), pair.msa.deformed());
  return r;
}

Validation validate(const Mechanism& m, const std::vector<ValidationPoint>& points, double load_N,
                    const std::set<Erratum>& as_printed, const frame::MemberDivision& division) {
  Validation v;
  v.device = m.name;
  v.as_printed = as_printed;
  double squares = 0;
  for (const ValidationPoint& point : points) {
    const Stand at = stand(m, point.pose_mm_deg);
    Pair pair(m, at, division);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector6 F = along(axis, load_N);
      ValidationRow row;
      row.point = point;
      row.axis = axis;
      row.load_N = load_N;
      const Answer a = pair.analytic.solve(F), f = pair.msa.solve(F);
      require_agreement(a, f, at.configuration.size, pair.bound(f, at.configuration.size), Pair::where(m, at));
      row.analytic = twist_in_mm(a.displacement);
      row.msa = twist_in_mm(f.displacement);
      if (!as_printed.empty())
        row.as_printed = twist_in_mm(solved(analytic::AnalyticModel(at.configuration, as_printed), F).displacement);
      row.relative_difference = relative_difference(row.analytic, row.msa);
      v.max_relative_difference = std::max(v.max_relative_difference, row.relative_difference);
      squares += row.relative_difference * row.relative_difference;
      v.rows.push_back(row);
    }
  }
  v.rms_relative_difference = v.rows.empty() ? 0 : std::sqrt(squares / static_cast<double>(v.rows.size()));
  return v;
}

std::vector<ErratumPrice> price_errata(const Mechanism& m, const std::vector<ValidationPoint>& points, double load_N) {
  std::vector<ErratumPrice> prices;
  for (const ErratumInfo& erratum : errata()) {
    ErratumPrice price{erratum.erratum, Vector3::Constant(std::numeric_limits<double>::infinity()),
                       Vector3::Constant(-std::numeric_limits<double>::infinity()), "", ""};
    try {
      for (const ValidationPoint& point : points) {
        const Configuration c = configure(m, pose_from(point.pose_mm_deg));
        const analytic::AnalyticModel corrected(erratum.erratum == Erratum::line_contact ? with_bulk(c) : c);
        const analytic::AnalyticModel printed(c, {erratum.erratum});
        for (int axis = 0; axis < 3; ++axis) {
          const Vector6 F = along(axis, load_N);
          const analytic::AnalyticSolution s = solved(printed, F);
          const double ratio = s.displacement(axis) / solved(corrected, F).displacement(axis);
          price.smallest(axis) = std::min(price.smallest(axis), ratio);
          price.largest(axis) = std::max(price.largest(axis), ratio);
          if (price.failed_check.empty()) price.failed_check = failed_checks(printed, s);
        }
      }
    } catch (const ModelError& e) {
      price.refused = e.what();
    } catch (const NumericalError& e) {
      price.refused = e.what();
    }
    prices.push_back(std::move(price));
  }
  return prices;
}

}  // namespace deflect
