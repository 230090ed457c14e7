#include "msa/frame/deformed/linearisation.h"

#include <algorithm>
#include <deque>
#include <iterator>

#include "msa/base/index.h"
#include "msa/frame/elements/joint_motion.h"
#include "msa/frame/structure/assembly.h"

namespace deflect::frame {
namespace {

using Pair = std::array<int, 2>;

Vector12 gather(const Pair& nodes, const VectorX& u) {
  Vector12 out = Vector12::Zero();
  for (int i = 0; i < 2; ++i)
    if (const int node = nth(nodes, i); node >= 0) out.segment<6>(6 * i) = u.segment<6>(6 * node);
  return out;
}

void scatter(const Pair& nodes, const Vector12& f, VectorX& to) {
  for (int i = 0; i < 2; ++i)
    if (const int node = nth(nodes, i); node >= 0) to.segment<6>(6 * node) += f.segment<6>(6 * i);
}

void scatter(const Pair& nodes, const Matrix12& K, std::vector<Eigen::Triplet<double>>& to) {
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) {
      const int a = nth(nodes, i / 6), b = nth(nodes, j / 6);
      if (a >= 0 && b >= 0 && K(i, j) != 0) to.emplace_back(6 * a + i % 6, 6 * b + j % 6, K(i, j));
    }
}

/// The displacements of the ends [0; θ_a; δ_b; θ_b] less the motion of end a as that of a rigid body.
Vector12 without_rigid_motion(const Beam& beam, const Vector12& d) {
  Vector12 out = Vector12::Zero();
  const Vector3 turn = d.segment<3>(3);
  out.segment<3>(6) = d.segment<3>(6) - turn.cross(beam.length * beam.R_WM.col(0));
  out.tail<3>() = d.tail<3>() - turn;
  return out;
}

/// A component of a connection in the place of the terms on nodes of its linear form; scalars stay.
LinearForm with_gradient(const Model& m, const LinearForm& form, const Pair& nodes, const Vector12& gradient) {
  LinearForm out;
  const auto nodal = static_cast<int>(6 * m.nodes.size());
  for (int i = 0; i < 12; ++i)
    if (const int node = nth(nodes, i / 6); node >= 0 && gradient(i) != 0)
      out.push_back({6 * node + i % 6, gradient(i)});
  std::copy_if(form.begin(), form.end(), std::back_inserter(out), [&](const Term& t) { return t.dof >= nodal; });
  return out;
}

double on_scalars(const Model& m, const LinearForm& form, const VectorX& path) {
  const auto nodal = static_cast<int>(6 * m.nodes.size());
  double sum = 0;
  for (const Term& t : form)
    if (t.dof >= nodal) sum += t.coefficient * path(t.dof);
  return sum;
}

/// Whether a form is a rotation of one node.
bool spins(const LinearForm& form, int node, const Model& m) {
  return std::all_of(form.begin(), form.end(), [&](const Term& t) {
    return t.dof < static_cast<int>(6 * m.nodes.size()) && t.dof / 6 == node && t.dof % 6 >= 3;
  });
}

/// How the elongation of a spring turns with the bodies that a connection puts it between.
struct Curved {
  const Matrix12* hessian = nullptr;
  Pair nodes{};
};

class Linearising {
 public:
  Linearising(const Model& model, const Shape& shape, const StructureConditions& circumstances)
      : m(model), s(shape), c(circumstances) {
    out.forces = VectorX::Zero(m.dofs());
    out.nodal = 6 * m.nodes.size();
    out.values.resize(std::ssize(m.constraints));
    const auto springs = std::ssize(m.springs);
    out.elongations.resize(springs), out.spring_forces.resize(springs), out.spring_tangents.resize(springs);
    curved.resize(m.springs.size());
    for (std::size_t i = 0; i < m.springs.size(); ++i) {
      out.spring_forms.push_back(m.springs[i].elongation);
      out.elongations(as_index(i)) = evaluate(out.spring_forms[i], s.path);
    }
    for (std::size_t k = 0; k < m.constraints.size(); ++k) {
      out.forms.push_back(m.constraints[k].form);
      out.values(as_index(k)) = evaluate(out.forms[k], s.path);
    }
  }

  /// The motion of a connection at given motions of the nodes.
  const JointMotion& motion(const Connection& joint, const BodyMotion& a, const BodyMotion& b) {
    std::array<bool, 6> wanted{};
    for (std::size_t i = 0; i < 6; ++i) wanted[i] = joint.constraint[i] >= 0 || joint.spring[i] >= 0;
    const auto position = [&](int node) { return nth(m.nodes, node).position; };
    motions.push_back(
        joint_motion(joint.a < 0 ? joint.p : position(joint.a), a, position(joint.b), b, joint.p, joint.axes, wanted));
    return motions.back();
  }

  void add_spring_forces() {
    for (std::size_t i = 0; i < m.springs.size(); ++i) {
      const auto at = as_index(i);
      const double force = frame::force(m.springs[i].law, out.elongations(at));
      const double tangent = std::max(frame::tangent(m.springs[i].law, out.elongations(at)), c.least_tangents(at));
      out.spring_forces(at) = force;
      out.spring_tangents(at) = tangent;
      for (const Term& t : out.spring_forms[i]) {
        out.forces(t.dof) += t.coefficient * force;
        for (const Term& u : out.spring_forms[i])
          out.stiffness.emplace_back(t.dof, u.dof, t.coefficient * tangent * u.coefficient);
      }
      if (curved[i].hessian) scatter(curved[i].nodes, force * *curved[i].hessian, out.stiffness);
    }
  }

  const Model& m;
  const Shape& s;
  const StructureConditions& c;
  Linearisation out;
  std::vector<Curved> curved;
  std::deque<JointMotion> motions;  // whose Hessians the forms point to
};

}  // namespace

Shape::Shape(const Model& m) : nodes(m.nodes.size()), path(VectorX::Zero(m.dofs())) {}

void Shape::move(const VectorX& increment) {
  path += increment;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto at = as_index(6 * i);
    nodes[i].u += increment.segment<3>(at);
    nodes[i].Q = (rotation_by(increment.segment<3>(at + 3)) * nodes[i].Q).normalized();
  }
}

VectorX Shape::displacements() const {
  VectorX u = path;
  for (std::size_t i = 0; i < nodes.size(); ++i) u.segment<3>(as_index(6 * i + 3)) = rotation_vector(nodes[i].Q);
  return u;
}

Linearisation linearise_finite(const Model& m, const Shape& shape, const StructureConditions& c) {
  Linearising work(m, shape, c);
  Linearisation& out = work.out;
  for (std::size_t e = 0; e < m.beams.size(); ++e) {
    const Beam& beam = m.beams[e];
    const DeformedBeam d = deformed(beam, nth(shape.nodes, beam.a), nth(shape.nodes, beam.b), c.strains[e]);
    scatter({beam.a, beam.b}, d.forces, out.forces);
    scatter({beam.a, beam.b}, d.K, out.stiffness);
    out.beams.push_back({d.forces, d.A, d.B, d.energy});
  }
  for (const Connection& joint : m.connections) {
    const BodyMotion a = joint.a < 0 ? BodyMotion{} : nth(shape.nodes, joint.a);
    const JointMotion& motion = work.motion(joint, a, nth(shape.nodes, joint.b));
    const Pair nodes{joint.a, joint.b};
    for (std::size_t i = 0; i < 6; ++i) {
      const double component = motion.components(as_index(i));
      if (const int k = joint.constraint[i]; k >= 0) {
        LinearForm& form = nth(out.forms, k);
        out.values(k) = component + on_scalars(m, form, shape.path);
        form = with_gradient(m, form, nodes, motion.gradient[i]);
        out.curvatures.push_back({k, nodes, motion.hessian[i]});
      }
      if (const int k = joint.spring[i]; k >= 0) {
        LinearForm& form = nth(out.spring_forms, k);
        out.elongations(k) = component + on_scalars(m, form, shape.path);
        form = with_gradient(m, form, nodes, motion.gradient[i]);
        nth(work.curved, k) = {&motion.hessian[i], nodes};
      }
    }
  }
  for (std::size_t k = c.first_hold; k < m.constraints.size(); ++k) {
    LinearForm& form = out.forms[k];
    const int node = form.front().dof / 6;
    if (!spins(form, node, m)) continue;  // an idle motion of bodies keeps the form in which it is held
    Vector3 axis = Vector3::Zero();
    for (const Term& t : form) axis(t.dof % 6 - 3) = t.coefficient;
    form = rotation_of(node, nth(shape.nodes, node).Q * axis);
    out.values(as_index(k)) = 0;
  }
  work.add_spring_forces();
  return std::move(out);
}

Linearisation linearise_second_order(const Model& m, const Shape& shape, const VectorX& lambda,
                                     const StructureConditions& c) {
  Linearising work(m, shape, c);
  Linearisation& out = work.out;
  for (std::size_t e = 0; e < m.beams.size(); ++e) {
    const Beam& beam = m.beams[e];
    const Pair nodes{beam.a, beam.b};
    // From end a on, so that a short piece that moves far keeps its digits; what is then rounding cancels between ends.
    Vector12 d = gather(nodes, shape.path);
    d.segment<3>(6) -= d.head<3>();
    d.head<3>().setZero();
    const Vector12 strained = without_rigid_motion(beam, d);
    const double heat = beam.rigidity.EA * c.strains[e];
    Vector12 ends = end_forces(beam, strained), pushed = Vector12::Zero();  // local axes, base axes
    ends(0) += heat, ends(6) -= heat;
    pushed.head<3>() = heat * beam.R_WM.col(0), pushed.segment<3>(6) = -pushed.head<3>();
    const Matrix12 K_G = geometric_stiffness(beam, ends);
    const Vector12 elastic = pull(beam, strained), forces = elastic + K_G * d + pushed;
    scatter(nodes, forces, out.forces);
    scatter(nodes, stiffness(beam) + K_G, out.stiffness);
    const double energy = strained.dot(elastic) / 2 + strained.dot(pushed) + heat * c.strains[e] * beam.length / 2;
    out.beams.push_back({forces, beam.R_WM, beam.R_WM, energy});
  }
  VectorX turned = VectorX::Zero(m.dofs());  // what the forces of connections gain by turning
  for (const Connection& joint : m.connections) {
    const JointMotion& motion = work.motion(joint, {}, {});
    const Pair nodes{joint.a, joint.b};
    const Vector12 d = gather(nodes, shape.path);
    for (std::size_t i = 0; i < 6; ++i) {
      if (const int k = joint.constraint[i]; k >= 0) {
        out.curvatures.push_back({k, nodes, motion.hessian[i]});
        scatter(nodes, -lambda(k) * motion.hessian[i] * d, turned);
      }
      if (const int k = joint.spring[i]; k >= 0) {
        nth(work.curved, k) = {&motion.hessian[i], nodes};
        scatter(nodes, force(nth(m.springs, k).law, out.elongations(k)) * motion.hessian[i] * d, turned);
      }
    }
  }
  work.add_spring_forces();
  out.forces += turned;
  return std::move(out);
}

}  // namespace deflect::frame
