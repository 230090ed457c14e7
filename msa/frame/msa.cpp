#include "msa/frame/msa.h"

#include <algorithm>
#include <stdexcept>

namespace deflect::frame {
namespace {

/// Reactions of a node whose six displacements are prescribed, to unit values of each: its tangent stiffness.
Matrix6 stiffness_at(const Model& free_model, int node, const VectorX& spring_tangents) {
  Model held = free_model;
  const auto first = static_cast<Eigen::Index>(held.constraints.size());
  held.fix(node, "tool");
  Solver solver(held);
  MatrixX values = MatrixX::Zero(first + 6, 6);
  values.bottomRows<6>().setIdentity();
  const MatrixX loads = MatrixX::Zero(solver.model().dofs(), 6);
  const MatrixX U = solver.linear(spring_tangents, loads, values);
  Model tangent = solver.model();
  for (std::size_t i = 0; i < tangent.springs.size(); ++i)
    tangent.springs[i].law = LinearSpring{spring_tangents(static_cast<Eigen::Index>(i))};
  Matrix6 K;
  for (int i = 0; i < 6; ++i)
    K.col(i) = constraint_forces(tangent, solver.elimination(), U.col(i), loads.col(i)).segment<6>(first);
  // Reactions are differences of forces as large as the stiffest member's: below their rounding K is zero, which is
  // what an unloaded contact leaves of a leg.
  double stiffest = 0;
  for (const Beam& beam : held.beams) stiffest = std::max(stiffest, beam.rigidity.EA / beam.length);
  Vector6 per_length = Vector6::Ones();
  per_length.tail<3>().setConstant(1 / characteristic_length(held));
  const double size = (per_length.asDiagonal() * K * per_length.asDiagonal()).cwiseAbs().maxCoeff();
  return size < 1e-13 * stiffest ? Matrix6(Matrix6::Zero()) : K;
}

}  // namespace

MsaModel::MsaModel(const Configuration& c, const MemberDivision& division)
    : configuration_(c), division_(division), built_(build(configuration_, division_)), solver_(built_.model) {
  built_.model = solver_.model();  // with what the solver added to it
}

MsaSolution MsaModel::solve(const Vector6& F_T_W) {
  VectorX load = VectorX::Zero(built_.model.dofs());
  load.segment<6>(6 * built_.tool) = F_T_W;
  MsaSolution out;
  out.state = solver_.solve(load);
  out.displacement = out.state.u.segment<6>(6 * built_.tool);
  out.energies = frame::energies(solver_.model(), out.state.u);
  std::stable_sort(out.energies.begin(), out.energies.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

Matrix6 MsaModel::stiffness(const Solution& state) {
  return stiffness_at(built_.model, built_.tool, state.spring_tangents);
}

Matrix6 MsaModel::leg_stiffness(std::size_t leg, const Solution& state) const {
  const MechanismModel one = build_leg(configuration_, leg, division_);
  // The leg's springs keep their names, so their state is found in the whole mechanism by name.
  VectorX tangents(static_cast<Eigen::Index>(one.model.springs.size()));
  for (std::size_t i = 0; i < one.model.springs.size(); ++i) {
    const auto& springs = built_.model.springs;
    const auto found = std::find_if(springs.begin(), springs.end(),
                                    [&](const Spring& s) { return s.name == one.model.springs[i].name; });
    if (found == springs.end()) throw std::logic_error("a leg has a spring that its mechanism lacks");
    tangents(static_cast<Eigen::Index>(i)) = state.spring_tangents(found - springs.begin());
  }
  return stiffness_at(one.model, one.tool, tangents);
}

Matrix6X MsaModel::passive_twists(std::size_t leg) const {
  std::vector<Vector6> twists;
  for (const PlacedPart& part : configuration_.legs[leg].parts)
    if (const auto* j = std::get_if<PlacedJoint>(&part))
      for (std::size_t i = 0; i < 6; ++i)
        if (j->free(i)) {
          const Vector3 axis = j->R_WJ.col(static_cast<Eigen::Index>(i % 3));
          Vector6 twist;
          if (i < 3)
            twist << axis, Vector3::Zero();
          else
            twist << axis.cross(configuration_.pose.p_WT - j->p_W), axis;
          twists.push_back(twist);
        }
  Matrix6X J(6, static_cast<Eigen::Index>(twists.size()));
  for (std::size_t k = 0; k < twists.size(); ++k) J.col(static_cast<Eigen::Index>(k)) = twists[k];
  return J;
}

Vector6 MsaModel::base_reaction(const Vector6& F_T_W, const Solution& state) const {
  VectorX load = VectorX::Zero(solver_.model().dofs());
  load.segment<6>(6 * built_.tool) = F_T_W;
  return constraint_forces(solver_.model(), solver_.elimination(), state.u, load).head<6>();
}

}  // namespace deflect::frame
