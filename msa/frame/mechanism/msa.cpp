#include "msa/frame/mechanism/msa.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <stdexcept>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/elements/finite_rotation.h"
#include "msa/frame/elements/member_loads.h"

namespace deflect::frame {
namespace {

/// Springs linear at their tangents: rigid ones are constraints, those that have let go are none, and the solver
/// decides anew what stands.
Model at_tangents(Model m, const VectorX& tangents) {
  for (std::size_t i = 0; i < m.springs.size(); ++i) {
    const double k = tangents(as_index(i));
    Spring& spring = m.springs[i];
    if (is_linear(spring.law)) continue;
    if (std::isinf(k)) m.constraints.push_back({spring.elongation, 0, spring.name});
    SpringLaw linear = LinearSpring{std::isinf(k) ? 0 : k};
    linear.rotation = spring.law.rotation;
    spring.law = linear;
  }
  return m;
}

Vector6 weights(double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(length);
  return w;
}

/// Orthonormal motions of a node, rotations times `length`, that connections and rigid parts leave it.
MatrixX motions_of(const Model& m, int node, double length) {
  const Elimination e = eliminate(m);
  MatrixX rows = MatrixX::Zero(std::max(e.independent, 6), 6);  // a motion in each
  for (int i = 0; i < 6; ++i)
    for (const Term& t : nth(e.T, 6 * node + i)) rows(t.dof, i) += t.coefficient;
  rows = (rows * weights(length).asDiagonal()).eval();
  const Eigen::HouseholderQR<MatrixX> qr(rows);
  const MatrixX R = qr.matrixQR().topRows<6>().triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<MatrixX> svd(R, Eigen::ComputeFullV);
  const double least = 1e-9 * svd.singularValues()(0);
  Eigen::Index rank = 0;
  while (rank < 6 && svd.singularValues()(rank) > least) ++rank;
  return rank == 6 ? MatrixX(MatrixX::Identity(6, 6)) : MatrixX(svd.matrixV().leftCols(rank));
}

/// With the node held: in all its freedoms, or, where it has fewer motions, in these.
Model held(Model m, int node, const MatrixX& motions, double length) {
  if (motions.cols() == 6) {
    m.fix(node, "tool");
    return m;
  }
  for (const auto& motion : motions.colwise()) {
    Constraint hold{{}, 0, "tool"};
    for (int i = 0; i < 6; ++i) hold.form.push_back({6 * node + i, weights(length)(i) * motion(i)});
    m.constraints.push_back(std::move(hold));
  }
  return m;
}

/// Of tangents: what makes a structure of its own.
std::vector<int> kinds(const VectorX& tangents) {
  std::vector<int> out;
  for (const double k : tangents) out.push_back(std::isinf(k) ? 1 : k == 0 ? -1 : 0);
  return out;
}

VectorX where_finite(const VectorX& tangents) {
  return tangents.unaryExpr([](double k) { return std::isinf(k) ? 0.0 : k; });
}

/// The configuration itself, with its frictions numbered.
const Configuration& numbered(Configuration& c, int& frictions) {
  frictions = number_slips(c);
  return c;
}

/// Reactions are differences of forces as large as the stiffest member's: below their rounding K is zero, which is what
/// an unloaded contact leaves of a leg.
Matrix6 above_rounding(const Matrix6& K, const Model& m) {
  double stiffest = 0;
  for (const Beam& beam : m.beams) stiffest = std::max(stiffest, beam.rigidity.EA / beam.length);
  Vector6 per_length = Vector6::Ones();
  per_length.tail<3>().setConstant(1 / characteristic_length(m));
  const double size = (per_length.asDiagonal() * K * per_length.asDiagonal()).cwiseAbs().maxCoeff();
  return size < 1e-15 * stiffest ? Matrix6(Matrix6::Zero()) : K;
}

/// Of one node in free motions of all nodes, m and rad; zero where it is the rounding of what other nodes do.
MatrixX twists_of(const MatrixX& free, int node, double length) {
  MatrixX out = free.middleRows<6>(6 * node);
  for (Eigen::Index j = 0; j < free.cols(); ++j) {
    double most = 0;
    for (Eigen::Index i = 0; i + 6 <= free.rows(); i += 6)
      most = std::max(most, weights(length).cwiseProduct(free.col(j).segment<6>(i)).norm());
    if (weights(length).cwiseProduct(out.col(j)).norm() <= 1e-9 * most) out.col(j).setZero();
  }
  return out;
}

/// K where it resists nothing along twists, which it does but for rounding.
Matrix6 without(const MatrixX& twists, double length, const Matrix6& K) {
  const Vector6 weight = weights(length);
  Eigen::ColPivHouseholderQR<MatrixX> qr;
  qr.setThreshold(1e-9);
  qr.compute(MatrixX(weight.asDiagonal() * twists));
  const MatrixX Q = evaluated(qr.householderQ());
  const MatrixX others = Q.rightCols(6 - qr.rank()).unaryExpr([](double x) { return std::abs(x) < 1e-12 ? 0 : x; });
  const MatrixX moved = weight.cwiseInverse().asDiagonal() * others, resisting = weight.asDiagonal() * others;
  return resisting * (moved.transpose() * K * moved) * resisting.transpose();
}

}  // namespace

/// A node held at unit displacements of its motions in turn, springs linear at their tangents.
struct MsaModel::Held {
  Held(const MechanismModel& mechanism, int held_node, const VectorX& spring_tangents, double size)
      : Held(at_tangents(mechanism.model, spring_tangents), held_node, spring_tangents, size) {}

  Held(const Model& model, int held_node, const VectorX& spring_tangents, double size)
      : node(held_node),
        kind(kinds(spring_tangents)),
        length(size),
        motions(motions_of(model, held_node, size)),
        solver(held(model, held_node, motions, size)),
        first(std::ssize(model.constraints)),
        supports(solver.model(), solver.elimination()) {}

  /// For these tangents, of the same kinds; then the reactions below are known.
  void displace(const VectorX& spring_tangents) {
    const Model& m = solver.model();
    tangents = where_finite(spring_tangents);
    const Eigen::Index n = motions.cols();
    MatrixX values = MatrixX::Zero(std::ssize(m.constraints), n);
    values.middleRows(first, n).setIdentity();
    U = solver.linear(tangents, MatrixX::Zero(m.dofs(), n), values);
    MatrixX pulls(m.dofs(), n);
    for (Eigen::Index i = 0; i < n; ++i) pulls.col(i) = tangent_forces(m, ExtendedVector(U.col(i)), tangents);
    forces = supports.forces(pulls);
  }

  /// What the held node needs: its stiffness.
  Matrix6 reactions() const {
    const MatrixX by_motion = forces.middleRows(first, motions.cols());
    if (motions.cols() == 6) return above_rounding(by_motion, solver.model());
    const MatrixX wrenches = weights(length).asDiagonal() * motions;
    return above_rounding(wrenches * by_motion * wrenches.transpose(), solver.model());
  }

  /// Of a node with six motions the part by way of one attachment to its body: spring forces less constraint forces,
  /// Cᵀλ = f_int.
  Matrix6 reactions(const MechanismModel::Attachment& a) const {
    const Model& m = solver.model();
    Matrix6 K = Matrix6::Zero();
    const auto add = [&](const LinearForm& form, const Eigen::RowVectorXd& pull) {
      for (const Term& t : form)
        if (t.dof / 6 == node) K.row(t.dof % 6) += t.coefficient * pull;
    };
    for (std::size_t k = a.first_constraint; k < a.last_constraint; ++k)
      add(m.constraints[k].form, -forces.row(as_index(k)));
    for (std::size_t s = a.first_spring; s < a.last_spring; ++s) {
      const Spring& spring = m.springs[s];
      if (spring.defined_by >= 0) {  // its pull reaches the bodies through the constraint that defines its elongation
        const auto k = as_size(spring.defined_by);
        add(m.constraints[k].form, -forces.row(spring.defined_by));
        continue;
      }
      Eigen::RowVectorXd elongation(6);
      for (int i = 0; i < 6; ++i) elongation(i) = evaluate(spring.elongation, ExtendedVector(U.col(i)));
      add(spring.elongation, tangents(as_index(s)) * elongation);
    }
    return above_rounding(K, m);
  }

  int node;
  std::vector<int> kind;  // of springs
  double length;
  MatrixX motions;  // orthonormal, rotations times the length
  Solver solver;
  Eigen::Index first;  // of the constraints that hold the node
  Reactions supports;
  VectorX tangents;
  ExtendedMatrix U;
  MatrixX forces;
};

MsaModel::MsaModel(const Configuration& c, const MemberDivision& division)
    : configuration_(c),
      division_(division),
      built_(build(numbered(configuration_, frictions_), division_)),
      solver_(built_.model) {
  built_.model = solver_.model();  // with what the solver added to it
}

MsaModel::~MsaModel() = default;

double MsaModel::rounding() const {
  return std::max(solver_.rounding(), tool_held_ ? tool_held_->solver.rounding() : 0);
}

MsaSolution MsaModel::solve(const Vector6& F_T_W, const Conditions& conditions) {
  if (!conditions.slips.empty() && static_cast<int>(conditions.slips.size()) != frictions_)
    throw InputError(
        fmt::format("{} slips are given, the laws of the mechanism have {}", conditions.slips.size(), frictions_));
  MsaSolution out;
  out.load = F_T_W;
  out.load.head<3>() += configuration_.weight;
  VectorX load = VectorX::Zero(built_.model.dofs());
  load.segment<6>(6 * built_.tool) = out.load;
  const Solution& rest = assembled();
  const bool strained = !rest.u.isZero(0), warm = conditions.warmer != 0;
  ExtendedVector u0 = rest.fine;
  std::vector<std::pair<std::string, double>> energies0;
  if (strained) out.rest = std::make_shared<const Solution>(rest);
  if (conditions.geometry == Geometry::linear || (out.load.isZero(0) && !strained && !warm)) {
    if (strained && (warm || !linear())) energies0 = rest_energies_;
    out.state = solve_linear(load, conditions);
    // Where everything is linear, what the load adds has an energy of its own.
    const bool added = linear() && !warm;
    out.energies = frame::energies(solver_.model(), added ? ExtendedVector(out.state.fine - u0) : out.state.fine,
                                   strains(conditions.warmer));
  } else {
    if (strained) {
      const Solution at_rest = solve_geometric(VectorX::Zero(load.size()), conditions.geometry);
      u0 = at_rest.fine;
      energies0 = frame::energies(geometric_->model(), *at_rest.geometric);
      out.rest = std::make_shared<const Solution>(at_rest);
    }
    out.state = solve_geometric(load, conditions);
    out.energies = frame::energies(geometric_->model(), *out.state.geometric);
  }
  for (std::size_t i = 0; i < energies0.size(); ++i) out.energies[i].second -= energies0[i].second;
  out.displacement = (out.state.fine - u0).segment<6>(6 * built_.tool).cast<double>();
  if (strained && out.state.geometric && conditions.geometry == Geometry::finite) {
    const auto turned = [&](const ExtendedVector& u) {
      return rotation_by(u.segment<3>(6 * built_.tool + 3).cast<double>());
    };
    out.displacement.tail<3>() = rotation_vector(turned(out.state.fine) * turned(u0).conjugate());
  }
  out.slips = out.state.slips;
  std::stable_sort(out.energies.begin(), out.energies.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

const Solution& MsaModel::assembled() {
  if (!assembled_) {
    assembled_ = std::make_unique<Solution>(solve_linear(VectorX::Zero(built_.model.dofs()), Conditions()));
    rest_energies_ = frame::energies(solver_.model(), assembled_->fine);
  }
  return *assembled_;
}

std::vector<double> MsaModel::strains(double warmer) const {
  if (warmer == 0) return {};
  std::vector<double> out;
  for (const Beam& beam : built_.model.beams) out.push_back(warmer * beam.expansion);
  return out;
}

Solution MsaModel::solve_linear(const VectorX& load, const Conditions& conditions) {
  const Model& m = solver_.model();
  VectorX heat = VectorX::Zero(m.dofs());
  for (const Beam& beam : m.beams) {
    const Vector12 f =
        equivalent_forces(beam.rigidity, beam.length, {Vector3::Zero(), conditions.warmer * beam.expansion});
    const Vector3 at_a = beam.R_WM * f.head<3>(), at_b = beam.R_WM * f.segment<3>(6);
    if (beam.relative < 0) {
      heat.segment<3>(6 * beam.a) += at_a;
      heat.segment<3>(6 * beam.b) += at_b;
    } else {
      heat.segment<3>(beam.relative) += at_b;
    }
  }
  solver_.begin_slips(conditions.slips);
  VectorX all = heat;
  all.head(load.size()) += load;
  NewtonOptions options;
  for (int i = 0; i < 6; ++i) options.watched.push_back(6 * built_.tool + i);
  Solution out = solver_.solve(all, options);
  out.heat = heat;
  return out;
}

Solution MsaModel::solve_geometric(const VectorX& load, const Conditions& conditions) {
  if (!geometric_) geometric_ = std::make_unique<GeometricSolver>(build(configuration_, division_).model);
  GeometricOptions options;
  options.geometry = conditions.geometry;
  options.slips = conditions.slips;
  std::vector<double> strains;
  for (const Beam& beam : geometric_->model().beams) strains.push_back(conditions.warmer * beam.expansion);
  auto state = std::make_shared<const GeometricState>(
      solve_settled(*geometric_, {load.head(geometric_->model().dofs()), {}, std::move(strains)}, options));
  Solution out;
  out.u = VectorX::Zero(built_.model.dofs());  // the coordinates of very stiff parts, which come last, are not used
  out.u.head(state->u.size()) = state->u;
  out.fine = out.u.cast<Extended>();
  out.spring_tangents = state->spring_tangents;
  out.spring_forces = state->spring_forces;
  out.slips = state->slips;
  out.message = state->message;
  // A mechanism that has snapped through is not at the pose that was asked for.
  out.converged = state->converged && state->stable && state->snaps_at == 0;
  out.iterations = state->iterations;
  out.residual = state->residual;
  out.geometric = std::move(state);
  return out;
}

MsaModel::Stiffness MsaModel::stiffness(const Solution& state) {
  if (state.geometric) {
    if (!geometric_) throw std::logic_error("a state of another mechanism");
    const NodeStiffness found = geometric_->stiffness(*state.geometric, built_.tool);
    return {above_rounding(found.K, geometric_->model()), {}, MatrixX::Identity(6, 6), found.rounding};
  }
  if (!tool_held_ || tool_held_->kind != kinds(state.spring_tangents))
    tool_held_ = std::make_unique<Held>(built_, built_.tool, state.spring_tangents, configuration_.size);
  tool_held_->displace(state.spring_tangents);
  Stiffness out{tool_held_->reactions(), {}, tool_held_->motions};
  if (state.free.cols() > 0)
    out.K = without(twists_of(state.free, built_.tool, characteristic_length(built_.model)),
                    characteristic_length(built_.model), out.K);
  const bool legs_stand_alone =
      built_.base == built_.ground && built_.tool == built_.platform && out.motions.cols() == 6;
  Vector6 per_length = Vector6::Ones();
  per_length.tail<3>().setConstant(1 / characteristic_length(built_.model));
  const auto size = [&](const Matrix6& K) { return (per_length.asDiagonal() * K * per_length.asDiagonal()).norm(); };
  const auto alone = [&](std::size_t leg) {
    const MechanismModel one = build_leg(configuration_, leg, division_);
    const VectorX tangents = tangents_of(one.model, state);
    Held leg_held(one, one.tool, tangents, configuration_.size);
    leg_held.displace(tangents);
    return leg_held.reactions();
  };
  for (std::size_t leg = 0; leg < configuration_.legs.size(); ++leg) {
    // Where nothing but the legs, side by side, is between the ground and the tool, each has its part of the reactions.
    // The part of a leg far softer than the others would drown in the rounding of theirs.
    const Matrix6 part = legs_stand_alone ? tool_held_->reactions(built_.attachments[leg]) : Matrix6::Zero();
    out.legs.push_back(size(part) > 1e-3 * size(out.K) ? part : alone(leg));
  }
  return out;
}

VectorX MsaModel::tangents_of(const Model& leg, const Solution& state) const {
  // The leg's springs keep their names, so their state is found in the whole mechanism by name.
  VectorX tangents(std::ssize(leg.springs));
  for (std::size_t i = 0; i < leg.springs.size(); ++i) {
    const auto& springs = built_.model.springs;
    const auto found =
        std::find_if(springs.begin(), springs.end(), [&](const Spring& s) { return s.name == leg.springs[i].name; });
    if (found == springs.end()) throw std::logic_error("a leg has a spring that its mechanism lacks");
    tangents(as_index(i)) = state.spring_tangents(found - springs.begin());
  }
  return tangents;
}

Matrix6X MsaModel::passive_twists(std::size_t leg) const {
  std::vector<Vector6> twists;
  for (const PlacedPart& part : configuration_.legs[leg].parts)
    if (const auto* j = std::get_if<PlacedJoint>(&part))
      for (std::size_t i = 0; i < 6; ++i)
        if (j->free(i)) {
          const Vector3 axis = j->R_WJ.col(as_index(i % 3));
          Vector6 twist;
          if (i < 3)
            twist << axis, Vector3::Zero();
          else
            twist << axis.cross(configuration_.pose.p_WT - j->p_W), axis;
          twists.push_back(twist);
        }
  Matrix6X J(6, std::ssize(twists));
  for (std::size_t k = 0; k < twists.size(); ++k) J.col(as_index(k)) = twists[k];
  return J;
}

Vector6 MsaModel::base_reaction(const Vector6& load_T_W, const Solution& state) {
  if (state.geometric) return state.geometric->constraint_forces.head<6>();  // the ground's six come first
  if (!supports_) supports_ = std::make_unique<Reactions>(solver_.model(), solver_.elimination());
  VectorX unbalanced = forces_with(solver_.model(), state.fine, state.spring_forces) - state.heat;
  unbalanced.segment<6>(6 * built_.tool) -= load_T_W;
  return supports_->forces(unbalanced).topRows<6>();  // the ground's six constraints come first
}

}  // namespace deflect::frame
