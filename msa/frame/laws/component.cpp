#include "msa/frame/laws/component.h"

#include <cmath>
#include <limits>
#include <optional>

#include "msa/frame/structure/solver.h"
#include "msa/mechanism/table.h"

namespace deflect::frame {
namespace {

constexpr double rigid_in_shear = std::numeric_limits<double>::infinity();

BeamRigidity round_rod(const Material& m, double diameter) {
  const double A = pi * diameter * diameter / 4, I = A * diameter * diameter / 16;
  return {m.E * A, m.E * I, m.E * I, m.shear_modulus() * 2 * I, rigid_in_shear, rigid_in_shear};
}

/// Axial rigidity alone matters to a rope or belt; the rest only keeps its beam from being a mechanism.
BeamRigidity rope(double EA) { return {EA, EA, EA, EA, rigid_in_shear, rigid_in_shear}; }

double stiffness_at(const Model& m, int dof) {
  VectorX load = VectorX::Zero(m.dofs());
  load(dof) = 1;
  return 1 / Solver(m).solve(load).u(dof);
}

/// Contact modulus 1/E* = 2 (1 − ν²)/E of two bodies of one material.
double contact_modulus(const Material& m) { return m.E / (2 * (1 - m.poisson() * m.poisson())); }

SpringLaw spring(const LinearLaw& law) { return LinearSpring{law.stiffness}; }

SpringLaw spring(const HertzPointLaw& law) {
  return PowerSpring{4.0 / 3 * contact_modulus(law.solid) * std::sqrt(2 * law.radius), 1.5};
}

SpringLaw spring(const HertzLineLaw& law) { return LinearSpring{pi / 2 * contact_modulus(law.solid) * law.length}; }

SpringLaw spring(const HertzLineBulkLaw& law) {
  return BulkLineSpring{1 / (2 * pi * contact_modulus(law.solid)), law.radius_1, law.radius_2, law.length};
}

SpringLaw spring(const PinBendingLaw& law) {
  Model m;
  const double half = law.length / 2;
  for (int i = 0; i < 3; ++i) m.add_node("pin", {i * half, 0, 0});
  const BeamRigidity rod = round_rod(law.solid, law.diameter);
  m.add_beam(0, 1, Matrix3::Identity(), rod, "pin", "pin");
  m.add_beam(1, 2, Matrix3::Identity(), rod, "pin", "pin");
  for (const int dof : {0, 1, 2, 3, 12 + 1, 12 + 2}) m.constraints.push_back({{{dof, 1}}, 0, "simple support"});
  return LinearSpring{stiffness_at(m, 6 + 2)};
}

SpringLaw spring(const MotorShaftLaw& law) {
  Model m;
  m.add_node("held end", Vector3::Zero());
  m.add_node("pulley", {law.length, 0, 0});
  m.scalars.push_back("travel");
  m.add_beam(0, 1, Matrix3::Identity(), round_rod(law.solid, law.diameter), "shaft", "shaft");
  m.fix(0, "held end");
  const int travel = m.dofs() - 1;
  m.constraints.push_back({{{travel, 1}, {6 + 3, -law.pulley_radius}}, 0, "pulley"});
  return LinearSpring{stiffness_at(m, travel)};
}

/// Ropes side by side between the ground and one moving end, which is, where a radius is given, the rim of a pulley.
SpringLaw ropes(const std::vector<std::pair<double, double>>& EA_length, std::optional<double> radius = {}) {
  Model m;
  m.add_node("end", Vector3::Zero());
  for (const auto& [EA, length] : EA_length) {
    const int ground = m.add_node("ground", {-length, 0, 0});
    m.add_beam(ground, 0, Matrix3::Identity(), rope(EA), "rope", "rope");
    m.fix(ground, "ground");
  }
  if (!radius) return LinearSpring{stiffness_at(m, 0)};
  m.scalars.push_back("turn");
  const int turn = m.dofs() - 1;
  m.constraints.push_back({{{0, 1}, {turn, -*radius}}, 0, "pulley"});
  return LinearSpring{stiffness_at(m, turn)};
}

SpringLaw spring(const CableLaw& law) { return ropes({{law.EA.value_or(law.solid.E * law.area), *law.length}}); }

SpringLaw spring(const CablePairLaw& law) {
  return ropes({{law.solid.E * law.area_1, law.length_1}, {law.solid.E * law.area_2, law.length_2}});
}

SpringLaw spring(const BeltLaw& law) {
  const double EA = law.specific_stiffness * law.width;
  return ropes({{EA, law.tight_length}, {EA, law.slack_length}}, law.pulley_radius);
}

SpringLaw spring(const PowerLaw& law) { return PowerSpring{law.force, 1 / law.exponent, law.deflection}; }

SpringLaw spring(const HardeningLaw& law) { return HardeningSpring{law.stiffness, law.reference}; }

SpringLaw spring(const OneSidedLaw& law) { return OneSidedSpring{law.pull.value_or(0), law.push.value_or(0)}; }

SpringLaw spring(const ClearanceLaw& law) { return GapSpring{law.gap}; }

SpringLaw spring(const FrictionLaw& law) {
  FrictionSpring spring{law.stiffness, law.force, law.number};
  spring.share = law.share;
  return spring;
}

TableSpring::Corners corners_of(const TablePoints& points) {
  TableSpring::Corners out;
  for (const auto& [force, motion] : points) out.push_back({motion, force});
  return out;
}

SpringLaw spring(const TableLaw& law) {
  const TableCurves& t = curves_of(law);
  TableSpring spring;
  spring.corners = std::make_shared<const TableSpring::Corners>(corners_of(t.elastic));
  if (!law.remembers()) return spring;
  const auto& [force, motion] = t.elastic.back();
  spring.memory = std::make_shared<const TableSpring::Memory>(
      TableSpring::Memory{motion / force, corners_of(t.loading), corners_of(t.unloading), t.beyond});
  spring.number = law.number;
  spring.begin(law.left);
  return spring;
}

}  // namespace

SpringLaw spring_of(const Law& law) {
  return std::visit([](const auto& l) { return spring(l); }, law);
}

}  // namespace deflect::frame
