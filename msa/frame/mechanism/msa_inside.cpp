#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/elements/finite_rotation.h"
#include "msa/frame/mechanism/msa.h"

namespace deflect::frame {

/// What constraints and springs do to the freedoms of nodes, in one state: constraint k exerts λ_k C_k, spring s exerts
/// −f_s S_s.
struct MsaModel::Forces {
  VectorX constraints, springs;
  const std::vector<LinearForm>*constraint_forms = nullptr, *spring_forms = nullptr;  ///< null: those of the model
};

MsaModel::Forces MsaModel::forces_in(const Solution& state, const Vector6& load_T_W) {
  if (state.geometric)
    return {state.geometric->constraint_forces, state.geometric->spring_forces, &state.geometric->forms,
            &state.geometric->spring_forms};
  if (!supports_) supports_ = std::make_unique<Reactions>(solver_.model(), solver_.elimination());
  VectorX unbalanced = forces_with(solver_.model(), state.fine, state.spring_forces) - state.heat;
  unbalanced.segment<6>(6 * built_.tool) -= load_T_W;
  return {supports_->forces(unbalanced), state.spring_forces};
}

/// Tension positive: what pulls the far side back to the near one.
double MsaModel::drive_force(const Inside& at, const Forces& forces, const Solution& state) const {
  const std::size_t freedom = *at.freedom;
  const PlacedPart& part = part_at(at, configuration_);
  if (const auto* group = std::get_if<PlacedParallel>(&part)) {  // laws side by side with the joint's
    double sum = 0;
    for (std::size_t b = 0; b < group->branches.size(); ++b) {
      Inside branch = at;
      branch.parts.insert(branch.parts.end(), {b, 0});
      if (!std::get<PlacedJoint>(group->branches[b].parts.front()).free(freedom))
        sum += drive_force(branch, forces, state);
    }
    return sum;
  }
  const Model& m = state.geometric ? geometric_->model() : solver_.model();
  const MechanismModel::Cut& cut = built_.cuts.at({at.leg, at.parts});
  if (cut.own && cut.connection >= 0) {
    const Connection& own = nth(m.connections, cut.connection);
    // Three rigid freedoms are constrained in base axes.
    if (own.spring[freedom] >= 0) return forces.springs(own.spring[freedom]);
    const auto& joint = std::get<PlacedJoint>(part);
    if (own.axes[freedom / 3].isApprox(joint.R_WJ, 1e-12)) return -forces.constraints(own.constraint[freedom]);
  }
  Vector6 wrench = Vector6::Zero();  // on the far body, about its node
  const auto add = [&](const LinearForm& form, double force) {
    for (const Term& t : form)
      if (t.dof / 6 == cut.far) wrench(t.dof % 6) += force * t.coefficient;
  };
  const auto constraint = [&](std::size_t k) {
    add(forces.constraint_forms ? (*forces.constraint_forms)[k] : m.constraints[k].form,
        forces.constraints(as_index(k)));
  };
  for (std::size_t k = cut.first_constraint; k < cut.last_constraint; ++k) constraint(k);
  for (std::size_t s = cut.first_spring; s < cut.last_spring; ++s)
    if (m.springs[s].defined_by >= 0)
      constraint(as_size(m.springs[s].defined_by));
    else
      add(forces.spring_forms ? (*forces.spring_forms)[s] : m.springs[s].elongation, -forces.springs(as_index(s)));
  const auto& joint = std::get<PlacedJoint>(part);
  const auto u = [&](int node) { return Vector6(state.u.segment<6>(6 * node)); };
  const bool moved = state.geometric && state.geometric->geometry == Geometry::finite;
  const Matrix3 R = moved ? rotation_from_vector(u(cut.side).tail<3>()) : Matrix3(Matrix3::Identity());
  const Vector3 near = nth(m.nodes, cut.side).position, far = nth(m.nodes, cut.far).position;
  Vector3 p = joint.p_W, end = far;
  if (moved) {
    p = near + u(cut.side).head<3>() + R * (joint.p_W - near);
    end = far + u(cut.far).head<3>();
  }
  const Vector3 f = wrench.head<3>(), axis = R * joint.R_WJ.col(as_index(freedom % 3));
  if (freedom < 3) return -axis.dot(f);
  return -axis.dot(wrench.tail<3>() + (end - p).cross(f));
}

/// [δ; θ] of the body behind a part, δ at T.
Vector6 MsaModel::motion(const Inside& at, const Solution& state) const {
  const MechanismModel::Cut& cut = built_.cuts.at({at.leg, at.parts});
  const Vector6 u = state.fine.segment<6>(6 * cut.behind).cast<double>();
  const Vector3 arm = configuration_.pose.p_WT - nth(built_.model.nodes, cut.behind).position, theta = u.tail<3>();
  Vector6 out;
  const bool moved = state.geometric && state.geometric->geometry == Geometry::finite;
  out << u.head<3>() + (moved ? Vector3(rotation_from_vector(theta) * arm - arm) : Vector3(theta.cross(arm))), theta;
  return out;
}

std::vector<Vector6> MsaModel::inside(const std::vector<Inside>& places, const MsaSolution& s) {
  std::vector<Vector6> out(places.size(), Vector6::Zero());
  const auto add = [&](const Solution& state, const Vector6& load, double sign) {
    const Forces forces = forces_in(state, load);
    for (std::size_t i = 0; i < places.size(); ++i)
      if (places[i].freedom)
        out[i](0) += sign * drive_force(places[i], forces, state);
      else
        out[i] += sign * motion(places[i], state);
  };
  add(s.state, s.load, 1);
  if (s.rest) add(*s.rest, Vector6::Zero(), -1);
  return out;
}

}  // namespace deflect::frame
