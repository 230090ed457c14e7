#include "validation/studies/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analytic/constraint.h"
#include "validation/theories/agreement.h"

namespace deflect::studies {
namespace {

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

/// What dividing members leaves of relative_difference() to the reference.
double left_by_division(const std::vector<theories::Answer>& answers, const Vector6& displacement_mm) {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();
  for (const theories::Answer& answer : answers) left += answer.discretisation;
  Vector6 moved = displacement_mm;
  moved.head<3>() += 1e3 * left(0) * Vector3::UnitX();
  moved.tail<3>() += left(1) * Vector3::UnitX();
  return theories::relative_difference(moved, displacement_mm);
}

std::optional<Assembly> assembly_of(const Configuration& c,
                                    const std::vector<std::unique_ptr<theories::TheoryAt>>& at) {
  const auto fits = [](const PlacedLeg& leg) { return leg.misfit.isZero(0); };
  if (std::all_of(c.legs.begin(), c.legs.end(), fits)) return std::nullopt;
  Assembly out;
  for (const auto& theory : at) {
    const theories::Assembled assembled = theory->assembled();
    out.offsets_mm_rad.push_back(twist_in_mm(assembled.offset));
    if (!out.leg_wrenches_N_Nmm.empty()) continue;
    for (const auto& [leg, wrench] : assembled.leg_wrenches)
      out.leg_wrenches_N_Nmm.emplace_back(leg, wrench_in_mm(wrench));
  }
  return out;
}

/// Checks, shares, play and notes: what the answers say beside displacement and stiffness.
void tell(SolveResult& r, const std::vector<theories::Answer>& answers,
          const std::vector<std::unique_ptr<theories::TheoryAt>>& at, double size, double turned) {
  const theories::Answer& reference = answers[theories::reference_of(r.theories)];
  for (std::size_t t = 0; t < answers.size(); ++t) {
    const theories::Answer& a = answers[t];
    r.symmetric = r.symmetric && a.checks.symmetric;
    r.positive = r.positive && a.checks.positive;
    r.passive_joints_free = r.passive_joints_free && a.checks.passive_joints_free;
    if (r.rigid_motions.empty()) r.rigid_motions = a.rigid_motions;
    for (const std::string& note : at[t]->notes()) r.notes.push_back(note);
    if (!r.mesh.points.empty()) continue;
    if (std::optional<theories::Structure> s = at[t]->structure())
      r.mesh = std::move(s->mesh), r.fields = std::move(s->fields);
  }
  const double stored = theories::total(reference.energies);
  if (stored > 0)
    for (const auto& [part, energy] : reference.energies) r.shares.emplace_back(part, energy / stored);
  if (const theories::Floating& f = reference.floating; !f.loose.empty())
    r.floating = {f.loose, twist_in_mm(above_rounding(f.least, size)), twist_in_mm(above_rounding(f.most, size))};
  if (r.geometry != Geometry::linear) return;
  if (const double known = std::max(turned, theories::bound_with(0, theories::rounding_of(r.theories, answers, size)));
      known > 1e-9)
    r.notes.push_back(fmt::format(
        "the device amplifies the rounding of its own numbers: the answer is known to about {:.0e} of its size",
        known));
}

}  // namespace

SolveResult solve(const Mechanism& m, const Stand& stand, const Vector6& load, const frame::MemberDivision& division,
                  Geometry geometry, const theories::Theories& theories) {
  const bool linear = geometry == Geometry::linear;
  const Configuration& c = stand.configuration;
  const Vector6 F = wrench_from_mm(load);
  SolveResult r;
  r.pose_mm_deg = stand.pose_mm_deg;
  r.load_N_Nmm = load;
  r.geometry = geometry;
  r.theories = theories;
  std::vector<std::unique_ptr<theories::TheoryAt>> at;
  theories::DeformedAnswers deformed{geometry, {}, {}};
  std::vector<theories::Answer>& answers = deformed.answers;
  std::vector<Vector6> displacements;
  for (const theories::Theory* theory : theories)
    at.push_back(theory->at(c, {m.name, linear ? division : refined(c, division)}));
  for (const auto& theory : at) {
    std::optional<theories::Answer> undeformed;
    if (!linear) undeformed = theory->answer(F);
    const theories::Answer& a = answers.emplace_back(theory->answer(F, geometry));
    if (undeformed) {
      deformed.from_linear.push_back(
          theories::relative_difference(twist_in_mm(a.displacement), twist_in_mm(undeformed->displacement)));
      const Vector6 room = undeformed->floating.most - undeformed->floating.least;
      if (room.allFinite())  // a motion without end has no end at which theories may stand
        deformed.play = std::max(deformed.play, theories::relative_difference(twist_in_mm(a.displacement + room),
                                                                              twist_in_mm(a.displacement)));
    }
    // Of a device that is held rigidly but for some motions, displacements may be the rounding of coordinates.
    displacements.push_back(twist_in_mm(a.rigid > 0 ? above_rounding(a.displacement, c.size) : a.displacement));
    r.solutions.push_back(
        {displacements.back(), stiffness_in_mm(a.stiffness), linear ? 0 : deformed.from_linear.back()});
  }
  double turned = 0;  // what turning the machine shows of rounding
  if (linear) {
    turned = theories::require_agreement(theories, answers, F, c, m.name);
  } else {
    r.discretisation = deformed.discretisation =
        left_by_division(answers, twist_in_mm(answers[theories::reference_of(theories)].displacement));
    if (theories::require_agreement_deformed(theories, deformed, c, m.name))
      r.notes.push_back(
          "the load leaves play open that the deformed shape holds at either end: the theories stand at different "
          "ends");
  }
  r.relative_difference = theories::largest_difference(displacements);
  tell(r, answers, at, c.size, turned);
  for (const Actuator& joint : c.actuators)
    r.joints.push_back({joint.name, joint.rotation ? joint.value : 1e3 * joint.value, joint.rotation});
  r.redundant_constraints = analytic::redundant_constraints(c);
  r.assembly = assembly_of(c, at);
  return r;
}

}  // namespace deflect::studies
