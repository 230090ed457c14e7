// Laws of scalar springs: force along a relative displacement δ, its tangent dF/dδ and the stored energy ∫F dδ.
// Every law passes through the origin; force and δ have the same sign. SI.
#pragma once

#include <cmath>
#include <variant>

namespace deflect::frame {

/// F = k δ.
struct LinearSpring {
  double k = 0;
  double force(double d) const { return k * d; }
  double tangent(double) const { return k; }
  double energy(double d) const { return k * d * d / 2; }
  double at_force(double) const { return k; }
};

/// F = k sign(δ) |δ|ⁿ, n > 1; the tangent vanishes at δ = 0. Hertz point contact has n = 3/2.
struct PowerSpring {
  double k = 0, n = 1.5;
  double force(double d) const { return std::copysign(k * std::pow(std::abs(d), n), d); }
  double tangent(double d) const { return n * k * std::pow(std::abs(d), n - 1); }
  double energy(double d) const { return k * std::pow(std::abs(d), n + 1) / (n + 1); }
  double at_force(double f) const { return tangent(std::pow(std::abs(f) / k, 1 / n)); }
};

/// at_force(f) is the tangent stiffness once the force |f| is reached: where Newton starts.
using SpringLaw = std::variant<LinearSpring, PowerSpring>;

inline double force(const SpringLaw& law, double d) {
  return std::visit([d](const auto& l) { return l.force(d); }, law);
}
inline double tangent(const SpringLaw& law, double d) {
  return std::visit([d](const auto& l) { return l.tangent(d); }, law);
}
inline double energy(const SpringLaw& law, double d) {
  return std::visit([d](const auto& l) { return l.energy(d); }, law);
}
inline double tangent_at_force(const SpringLaw& law, double f) {
  return std::visit([f](const auto& l) { return l.at_force(f); }, law);
}
inline bool is_linear(const SpringLaw& law) { return std::holds_alternative<LinearSpring>(law); }

}  // namespace deflect::frame
