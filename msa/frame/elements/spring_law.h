// Laws of scalar springs: force along a relative displacement δ, its tangent dF/dδ and the stored energy ∫F dδ.
// Every law passes through the origin; force and δ have the same sign. SI.
#pragma once

#include <cmath>
#include <variant>

#include "msa/base/index.h"
#include "msa/frame/elements/stepped_spring.h"
#include "msa/frame/elements/table_spring.h"

namespace deflect::frame {

/// F = k δ.
struct LinearSpring {
  double k = 0;
  double force(double d) const { return k * d; }
  double tangent(double) const { return k; }
  double energy(double d) const { return k * d * d / 2; }
  double at_force(double) const { return k; }
  double elongation(double f) const { return f / k; }
};

/// F = k sign(δ) (|δ|/unit)ⁿ, n ≥ 1; the tangent vanishes at δ = 0 where n > 1. Hertz point contact has n = 3/2.
struct PowerSpring {
  double k = 0, n = 1.5, unit = 1;
  double force(double d) const { return std::copysign(k * std::pow(std::abs(d) / unit, n), d); }
  double tangent(double d) const { return n * k / unit * std::pow(std::abs(d) / unit, n - 1); }
  double energy(double d) const { return k * unit * std::pow(std::abs(d) / unit, n + 1) / (n + 1); }
  double at_force(double f) const { return at_force(f, elongation(f)); }
  double at_force(double f, double d) const { return d == 0 ? tangent(0) : n * f / d; }
  double elongation(double f) const { return std::copysign(unit * std::pow(std::abs(f) / k, 1 / n), f); }
};

/// F = k δ (1 + (δ/reference)²).
struct HardeningSpring {
  double k = 0, reference = 0;
  double square(double d) const { return d * d / (reference * reference); }
  double force(double d) const { return k * d * (1 + square(d)); }
  double tangent(double d) const { return k * (1 + 3 * square(d)); }
  double energy(double d) const { return k * d * d / 2 * (1 + square(d) / 2); }
  double at_force(double f) const { return tangent(elongation(f)); }
  double at_force(double, double d) const { return tangent(d); }
  double elongation(double f) const {
    // Both starts lie beyond the root of a function that is convex there: Newton comes down on it.
    const double size = std::abs(f);
    double d = std::min(size / k, std::cbrt(size / k * reference * reference));
    for (int i = 0; i < 100 && d > 0; ++i) {
      const double step = (force(d) - size) / tangent(d);
      d -= step;
      if (std::abs(step) <= 1e-16 * d) break;
    }
    return std::copysign(d, f);
  }
};

/// Two cylinders in line contact, with the compression of the bulk of both: δ = p κ Σ (2 ln(4 R_i/a) − 1) at the half
/// width a of p = F/l, a² = 8 p κ R1 R2/(R1 + R2), κ = (1 − ν²)/(π E) (K. L. Johnson, Contact Mechanics, 1985, §5.6).
/// F(δ) by Newton's method; the tangent vanishes at δ = 0.
struct BulkLineSpring {
  double kappa = 0, R1 = 0, R2 = 0, length = 0;
  double half_width(double p) const { return std::sqrt(8 * p * kappa * R1 * R2 / (R1 + R2)); }
  double approach(double p) const {
    const double a = half_width(p);
    return p * kappa * (2 * std::log(4 * R1 / a) + 2 * std::log(4 * R2 / a) - 2);
  }
  double slope(double p) const {  // dδ/dp; ln a grows by half of ln p, twice
    const double a = half_width(p);
    return kappa * (2 * std::log(4 * R1 / a) + 2 * std::log(4 * R2 / a) - 4);
  }
  double line_load(double d) const {
    double p = 0;
    if (d == 0) return p;
    // The slope falls with p, so that from p = 0 upwards Newton on a concave function never overshoots the root.
    p = std::abs(d) / (kappa * 40);
    for (int i = 0; i < 100; ++i) {
      const double step = (std::abs(d) - approach(p)) / slope(p);
      p += step;
      if (std::abs(step) <= 1e-16 * p) break;
    }
    return p;
  }
  double force(double d) const { return std::copysign(length * line_load(d), d); }
  double tangent(double d) const { return d == 0 ? 0 : length / slope(line_load(d)); }
  double energy(double d) const {  // ∫F dδ = F δ − ∫δ dF, and ∫δ dp = p (δ + p κ)/2
    const double p = line_load(d);
    return length * (p * std::abs(d) - p * (std::abs(d) + p * kappa) / 2);
  }
  double at_force(double f) const { return f == 0 ? 0 : length / slope(std::abs(f) / length); }
  double elongation(double f) const { return f == 0 ? 0 : std::copysign(approach(std::abs(f) / length), f); }
};

/// at_force(f) is the tangent stiffness at the force |f|, elongation(f) the δ at the force f. A preloaded spring
/// carries the force P at rest: F = law(δ₀ + δ) − P with law(δ₀) = P; its energy is relative to the state at rest.
struct SpringLaw : std::variant<LinearSpring, PowerSpring, BulkLineSpring, HardeningSpring, GapSpring, OneSidedSpring,
                                FrictionSpring, TableSpring> {
  using variant::variant;
  double preload = 0, at_rest = 0;  ///< P, δ₀
  bool rotation = false;            ///< moment and angle in place of force and length
};

inline SpringLaw preloaded(SpringLaw law, double P) {
  law.preload = P;
  law.at_rest = std::visit([P](const auto& l) { return l.elongation(P); }, law);
  return law;
}

inline double force(const SpringLaw& law, double d) {
  return std::visit([&](const auto& l) { return l.force(law.at_rest + d) - law.preload; }, law);
}
inline double tangent(const SpringLaw& law, double d) {
  return std::visit([&](const auto& l) { return l.tangent(law.at_rest + d); }, law);
}
inline double energy(const SpringLaw& law, double d) {
  return std::visit([&](const auto& l) { return l.energy(law.at_rest + d) - l.energy(law.at_rest) - law.preload * d; },
                    law);
}
/// Start value for Newton's method: the tangent when a force of this size is added to the preload.
inline double tangent_at_force(const SpringLaw& law, double f) {
  return std::visit([&](const auto& l) { return l.at_force(std::abs(f) + std::abs(law.preload)); }, law);
}
/// δ when the force f is added to the preload.
inline double elongation(const SpringLaw& law, double f) {
  return std::visit([&](const auto& l) { return l.elongation(f + law.preload) - law.at_rest; }, law);
}
/// The same with the tangent stiffness there. A law that finds the stiffness from δ has at_force(f, δ).
struct Yielding {
  double elongation, stiffness;
};
inline Yielding yielding(const SpringLaw& law, double f) {
  return std::visit(
      [&](const auto& l) -> Yielding {
        const double whole = f + law.preload, d = l.elongation(whole);
        if constexpr (requires { l.at_force(whole, d); })
          return {d - law.at_rest, l.at_force(whole, d)};
        else
          return {d - law.at_rest, l.at_force(whole)};
      },
      law);
}
/// Whether the stiffness does not depend on the load.
inline bool is_linear(const SpringLaw& law) {
  const auto* power = std::get_if<PowerSpring>(&law);
  return std::holds_alternative<LinearSpring>(law) || (power && power->n == 1);
}
/// Whether the law is one of stepped_spring.h, or a table that remembers.
inline bool jumps(const SpringLaw& law) {
  if (const auto* table = std::get_if<TableSpring>(&law)) return table->memory != nullptr;
  return std::holds_alternative<GapSpring>(law) || std::holds_alternative<OneSidedSpring>(law) ||
         std::holds_alternative<FrictionSpring>(law);
}
/// Sets what earlier loads have left in a law, by their numbers; missing: nothing.
inline void begin(SpringLaw& law, const std::vector<double>& slips) {
  const auto at = [&](int number) {
    return number >= 0 && as_size(number) < slips.size() ? slips[as_size(number)] : 0;
  };
  if (auto* friction = std::get_if<FrictionSpring>(&law)) friction->before = at(friction->number);
  if (auto* table = std::get_if<TableSpring>(&law); table && table->memory)
    table->begin({at(table->number), at(table->number >= 0 ? table->number + 1 : -1)});
}
/// Sets the known force, in excess of the preload, of a spring that jumps (λ of stepped_spring.h).
inline void know_force(SpringLaw& law, double f) {
  if (auto* gap = std::get_if<GapSpring>(&law)) gap->known = f + law.preload;
  if (auto* one = std::get_if<OneSidedSpring>(&law)) one->known = f + law.preload;
}
/// Stored energy at an elongation, relative to the state at rest.
inline double stored_energy(const SpringLaw& law, double d) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (requires { l.stored(d); })
          return l.stored(l.force(law.at_rest + d)) - l.stored(law.preload) - law.preload * d;
        else
          return energy(law, d);
      },
      law);
}
/// The tangent of the law itself, infinite where it is rigid.
inline double true_tangent(const SpringLaw& law, double d) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (requires { l.true_tangent(d); })
          return l.true_tangent(law.at_rest + d);
        else
          return l.tangent(law.at_rest + d);
      },
      law);
}

}  // namespace deflect::frame
