#include "analytic/model.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "msa/base/error.h"

namespace deflect::analytic {
namespace {

/// One leg linearised about the force λ it carries: λ' = G⁻¹(Nᵀt − h) for a displacement t of the platform.
struct Linearised {
  MatrixX G_inverse;
  VectorX offset;  // λ − G⁻¹ h(λ)
};

Linearised linearise(const Chain& c, const VectorX& lambda, double least, const AsPrinted& p) {
  const Vector6 F = c.N * lambda;
  const MatrixX G = c.N.transpose() * c.tangent_compliance(F, least, p) * c.N;
  const Eigen::FullPivLU<MatrixX> lu(G);
  if (!lu.isInvertible())
    throw ModelError(
        fmt::format("{}: the chain is rigid in a direction that it carries: its stiffness is infinite; "
                    "give a member, joint or actuator of it some compliance",
                    c.name));
  Linearised out;
  out.G_inverse = lu.inverse();
  out.offset = lambda - out.G_inverse * (c.N.transpose() * c.deflection(F, p));
  return out;
}

/// Rotations weighed so that forces and moments of a desk-top device compare: 0.1 m.
Vector6 weights() {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(10);
  return w;
}

std::string free_motion(const Matrix6& scaled) {
  const Vector6 d = weights().cwiseProduct(Eigen::JacobiSVD<Matrix6>(scaled, Eigen::ComputeFullV).matrixV().col(5));
  const Vector3 v = d.head<3>(), w = d.tail<3>();
  if (w.norm() < 1e-6 * v.norm())
    return fmt::format("translation along ({:.3f}, {:.3f}, {:.3f})", v(0) / v.norm(), v(1) / v.norm(), v(2) / v.norm());
  const Vector3 through = 1e3 * w.cross(v) / w.squaredNorm();  // from T
  return fmt::format(
      "rotation about ({:.3f}, {:.3f}, {:.3f}) through the tool point + ({:.4g}, {:.4g}, {:.4g}) mm, advancing {:.4g} "
      "mm "
      "per rad",
      w(0) / w.norm(), w(1) / w.norm(), w(2) / w.norm(), through(0), through(1), through(2),
      1e3 * w.dot(v) / w.squaredNorm());
}

/// K t = F. A platform that can move freely is refused whatever the load; only an erratum that takes the moments' arms
/// away is solved for the smallest t, provided that the load does not drive the free motion.
Vector6 displaced(const Matrix6& K, const Vector6& F, const AsPrinted& p) {
  const Matrix6 scaled = weights().asDiagonal() * K * weights().asDiagonal();
  Eigen::CompleteOrthogonalDecomposition<Matrix6> cod;
  cod.setThreshold(1e-13);
  cod.compute(scaled);
  const Vector6 f = weights().cwiseProduct(F), x = cod.solve(f);
  const bool driven = (scaled * x - f).norm() > 1e-9 * f.norm();
  if (cod.rank() < 6 && (driven || !p.count(Erratum::tcp_transfer)))
    throw ModelError("the platform cannot stand: the legs do not resist its " + free_motion(scaled));
  return weights().cwiseProduct(x);
}

}  // namespace

AnalyticModel::AnalyticModel(const Configuration& c, const AsPrinted& as_printed) : as_printed_(as_printed) {
  for (const PlacedLeg& leg : c.legs) {
    Vector3 reference = c.pose.p_WT;
    if (as_printed.count(Erratum::tcp_transfer))  // the platform joint: where the last member ends
      for (const PlacedPart& part : leg.parts)
        if (const auto* m = std::get_if<PlacedMember>(&part)) reference = m->p_W_end;
    chains_.push_back(chain_of(leg, reference, as_printed));
  }
  PlacedLeg through{"base and tool", {c.base, c.tool}};
  through_ = chain_of(through, c.pose.p_WT, {});
}

AnalyticSolution AnalyticModel::solve(const Vector6& F) const {
  AnalyticSolution s;
  s.load = F;
  s.leg_wrenches.assign(chains_.size(), Vector6::Zero());
  if (F.isZero(0)) {
    s.converged = true;
    return s;
  }
  // Contacts have no stiffness at rest; a force far below the load stands for rest in the Newton matrix.
  const double least = 1e-9 * (F.head<3>().norm() + F.tail<3>().norm() / 0.1);
  std::vector<VectorX> lambda;
  for (const Chain& c : chains_) lambda.push_back(VectorX::Zero(c.N.cols()));
  Vector6 t = Vector6::Zero();
  for (s.iterations = 1; s.iterations <= 100; ++s.iterations) {
    const double floor = s.iterations == 1 ? F.head<3>().norm() + F.tail<3>().norm() / 0.1 : least;
    std::vector<Linearised> legs;
    Matrix6 K = Matrix6::Zero();
    Vector6 rest = F;
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      legs.push_back(linearise(chains_[i], lambda[i], floor, as_printed_));
      K += chains_[i].N * legs[i].G_inverse * chains_[i].N.transpose();
      rest -= chains_[i].N * legs[i].offset;
    }
    t = displaced(K, rest, as_printed_);
    double change = 0, size = 0;
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      const VectorX next = legs[i].G_inverse * (chains_[i].N.transpose() * t) + legs[i].offset;
      change = std::max(change, (next - lambda[i]).cwiseAbs().maxCoeff());
      size = std::max(size, next.cwiseAbs().maxCoeff());
      lambda[i] = next;
    }
    if (change <= 1e-13 * size || (s.iterations > 3 && change <= 1e-11 * size)) {
      s.converged = true;
      break;
    }
  }
  double misfit = 0, size = 0;
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    s.leg_wrenches[i] = chains_[i].N * lambda[i];
    const VectorX moved = chains_[i].N.transpose() * t;
    misfit = std::max(misfit, (moved - chains_[i].N.transpose() * chains_[i].deflection(s.leg_wrenches[i], as_printed_))
                                  .cwiseAbs()
                                  .maxCoeff());
    size = std::max(size, moved.cwiseAbs().maxCoeff());
  }
  s.misfit = size > 0 ? misfit / size : 0;
  s.converged = s.converged && s.misfit < 1e-9;
  s.displacement = t + through_.deflection(F, {});
  return s;
}

bool AnalyticModel::linear() const {
  const auto linear_chain = [](const Chain& c) {
    return std::all_of(c.freedoms.begin(), c.freedoms.end(), [](const ElasticFreedom& f) {
      return std::all_of(f.laws.begin(), f.laws.end(), [](const Law& law) { return is_linear(law); });
    });
  };
  return linear_chain(through_) && std::all_of(chains_.begin(), chains_.end(), linear_chain);
}

Matrix6 AnalyticModel::leg_stiffness(std::size_t leg, const AnalyticSolution& s) const {
  return chains_[leg].tangent_stiffness(s.leg_wrenches[leg], as_printed_);
}

Matrix6 AnalyticModel::stiffness(const AnalyticSolution& s) const {
  Matrix6 K = Matrix6::Zero();
  for (std::size_t i = 0; i < chains_.size(); ++i) K += leg_stiffness(i, s);
  if (through_.freedoms.empty()) return K;
  // In series with base and tool: (K⁻¹ + C)⁻¹ without inverting a K that may be singular.
  const Matrix6 C = through_.tangent_compliance(s.load, 0, {});
  return (Matrix6::Identity() + K * C).partialPivLu().solve(K);
}

std::vector<std::pair<std::string, double>> AnalyticModel::energies(const AnalyticSolution& s) const {
  std::vector<std::pair<std::string, double>> sums;
  const auto add = [&sums](const std::string& part, double energy) {
    const auto found = std::find_if(sums.begin(), sums.end(), [&](const auto& e) { return e.first == part; });
    if (found == sums.end())
      sums.emplace_back(part, energy);
    else
      found->second += energy;
  };
  const auto add_chain = [&](const Chain& c, const Vector6& F, const AsPrinted& p) {
    for (const FlexibleMember& m : c.members) add(m.part, 0.5 * F.dot(m.C * F));
    for (const ElasticFreedom& f : c.freedoms) add(f.part, stored_energy(f.laws, f.twist.dot(F), p));
  };
  for (std::size_t i = 0; i < chains_.size(); ++i) add_chain(chains_[i], s.leg_wrenches[i], as_printed_);
  add_chain(through_, s.load, {});
  std::stable_sort(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return sums;
}

}  // namespace deflect::analytic
