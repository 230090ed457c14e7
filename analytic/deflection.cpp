#include "analytic/deflection.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "analytic/table.h"
#include "msa/base/spatial.h"
#include "msa/mechanism/table.h"

namespace deflect::analytic {
namespace {

double stiffness(const LinearLaw& l, const AsPrinted&) { return l.stiffness; }
double stiffness(const HertzLineLaw& l, const AsPrinted& p) {
  return line_contact_stiffness(l.length, effective_modulus(l.solid, p));
}
double stiffness(const PinBendingLaw& l, const AsPrinted&) {
  return pin_bending_stiffness(l.solid, l.diameter, l.length);
}
double stiffness(const MotorShaftLaw& l, const AsPrinted&) { return motor_shaft_stiffness(l); }
double stiffness(const CableLaw& l, const AsPrinted&) {
  return l.EA ? *l.EA / *l.length : cable_stiffness(l.solid, l.area, *l.length);
}
double stiffness(const CablePairLaw& l, const AsPrinted&) {
  return cable_stiffness(l.solid, l.area_1, l.length_1) + cable_stiffness(l.solid, l.area_2, l.length_2);
}
double stiffness(const BeltLaw& l, const AsPrinted&) { return belt_stiffness(l); }

/// p κ and ln(2 (R1 + R2)/(p κ)) of a line contact with bulk; the logarithm is infinite without load.
struct BulkLine {
  double kappa, p_kappa, logarithm;
};

BulkLine bulk_line(const HertzLineBulkLaw& l, double force) {
  const double nu = l.solid.poisson(), kappa = (1 - nu * nu) / (pi * l.solid.E);
  const double p_kappa = kappa * std::abs(force) / l.length;
  return {kappa, p_kappa, std::log(2 * (l.radius_1 + l.radius_2) / p_kappa)};
}

/// The stiffness of contact and pin side by side, where (33) is taken as printed and the laws are those two.
std::optional<double> printed_universal_joint(const std::vector<Law>& laws, const AsPrinted& p) {
  if (!p.count(Erratum::ujoint_parallel)) return {};
  const HertzLineLaw* contact = nullptr;
  const PinBendingLaw* pin = nullptr;
  for (const Law& law : laws) {
    if (const auto* l = std::get_if<HertzLineLaw>(&law)) contact = l;
    if (const auto* l = std::get_if<PinBendingLaw>(&law)) pin = l;
  }
  if (!contact || !pin) return {};
  return stiffness(*contact, p) + stiffness(*pin, p);
}

/// Tables, whose curves have corners, and the other laws of a freedom.
struct Split {
  std::vector<const TableLaw*> tables;
  std::vector<Law> others;
};
Split split(const std::vector<Law>& laws) {
  Split out;
  for (const Law& law : laws)
    if (const auto* table = std::get_if<TableLaw>(&law))
      out.tables.push_back(table);
    else
      out.others.push_back(law);
  return out;
}

/// Integral over [0, f] by the three points of Gauss: exact to rounding where the integrand hardly changes.
template <class Integrand>
double integral(double f, Integrand integrand) {
  const double offset = std::sqrt(0.6);
  return f * (5 * integrand(f * (1 - offset) / 2) + 8 * integrand(f / 2) + 5 * integrand(f * (1 + offset) / 2)) / 18;
}

/// Differences between the states f + P and P lose their digits below this ratio; compliance hardly changes there.
bool small(double force, double preload) { return std::abs(force) < 1e-2 * std::abs(preload); }

bool part_of_universal_joint(const Law& law) {
  return std::holds_alternative<HertzLineLaw>(law) || std::holds_alternative<PinBendingLaw>(law);
}

/// Sum over laws in series of `one(law)`, with `both(k)` for a universal joint's two laws taken together.
template <class One, class Both>
double in_series(const std::vector<Law>& laws, const AsPrinted& p, One one, Both both) {
  const std::optional<double> k = printed_universal_joint(laws, p);
  double sum = k ? both(*k) : 0;
  for (const Law& law : laws)
    if (!k || !part_of_universal_joint(law)) sum += one(law);
  return sum;
}

}  // namespace

double effective_modulus(const Material& m, const AsPrinted& p) {
  const double sum = 2 * (1 - m.poisson() * m.poisson()) / m.E;
  return (p.count(Erratum::contact_modulus) ? 1 : 2) / sum;
}

double point_contact_deflection(double R, double E, double force) {
  const double root = std::cbrt(std::abs(force) / (E * std::sqrt(8 * R / 9)));
  return std::copysign(root * root, force);
}

double point_contact_compliance(double R, double E, double force) {
  return 1 / (E * std::sqrt(2 * R * std::abs(point_contact_deflection(R, E, force))));
}

double point_contact_radius(double R, double E, double force) { return std::cbrt(3 * std::abs(force) * R / E); }

double line_contact_stiffness(double length, double E) { return pi * length * E / 4; }

double line_contact_half_width(double R, double length, double E, double force) {
  return 2 * std::sqrt(2 * std::abs(force) * R / (pi * length * E));
}

double bulk_line_deflection(const HertzLineBulkLaw& l, double force) {
  if (force == 0) return 0;
  const BulkLine b = bulk_line(l, force);
  return std::copysign(2 * b.p_kappa * (b.logarithm - 1), force);
}

double bulk_line_compliance(const HertzLineBulkLaw& l, double force) {
  const BulkLine b = bulk_line(l, force);
  return 2 * b.kappa / l.length * (b.logarithm - 2);
}

double pin_bending_stiffness(const Material& m, double diameter, double length) {
  return 48 * m.E * pi * std::pow(diameter, 4) / 64 / std::pow(length, 3);
}

double motor_shaft_stiffness(const MotorShaftLaw& l) {
  const double J = pi * std::pow(l.diameter, 4) / 32;
  return J * l.solid.shear_modulus() / l.length / (l.pulley_radius * l.pulley_radius);
}

double cable_stiffness(const Material& m, double area, double length) { return area * m.E / length; }

double belt_stiffness(const BeltLaw& l) {
  const double k =
      l.width * l.specific_stiffness * (l.tight_length + l.slack_length) / (l.tight_length * l.slack_length);
  return l.pulley_radius ? k * *l.pulley_radius * *l.pulley_radius : k;
}

double power_deflection(const PowerLaw& l, double force) {
  return std::copysign(l.deflection * std::pow(std::abs(force) / l.force, l.exponent), force);
}

double power_compliance(const PowerLaw& l, double force) {
  return l.exponent * l.deflection / l.force * std::pow(std::abs(force) / l.force, l.exponent - 1);
}

double hardening_deflection(const HardeningLaw& l, double force) {
  const double q = force / (l.stiffness * l.reference);
  return l.reference * 2 / std::sqrt(3) * std::sinh(std::asinh(1.5 * std::sqrt(3) * q) / 3);
}

double hardening_compliance(const HardeningLaw& l, double force) {
  const double x = hardening_deflection(l, force) / l.reference;
  return 1 / (l.stiffness * (1 + 3 * x * x));
}

double deflection(const Law& law, double force, const AsPrinted& p) {
  if (const auto* l = std::get_if<HertzPointLaw>(&law))
    return point_contact_deflection(l->radius, effective_modulus(l->solid, p), force);
  if (const auto* l = std::get_if<HertzLineBulkLaw>(&law)) return bulk_line_deflection(*l, force);
  if (const auto* l = std::get_if<PowerLaw>(&law)) return power_deflection(*l, force);
  if (const auto* l = std::get_if<HardeningLaw>(&law)) return hardening_deflection(*l, force);
  if (const auto* l = std::get_if<TableLaw>(&law)) return table_deflection(*l, force);
  return force * compliance(law, force, p);
}

double compliance(const Law& law, double force, const AsPrinted& p) {
  return std::visit(
      [&](const auto& l) -> double {
        using L = std::decay_t<decltype(l)>;
        if constexpr (std::is_same_v<L, HertzPointLaw>)
          return point_contact_compliance(l.radius, effective_modulus(l.solid, p), force);
        else if constexpr (std::is_same_v<L, HertzLineBulkLaw>)
          return bulk_line_compliance(l, force);
        else if constexpr (std::is_same_v<L, PowerLaw>)
          return power_compliance(l, force);
        else if constexpr (std::is_same_v<L, HardeningLaw>)
          return hardening_compliance(l, force);
        else if constexpr (std::is_same_v<L, TableLaw>)
          return table_compliance(l, force);
        else if constexpr (std::is_same_v<L, OneSidedLaw> || std::is_same_v<L, ClearanceLaw> ||
                           std::is_same_v<L, FrictionLaw>)
          throw std::logic_error("a law that jumps has no deflection of its own: steps.h");
        else
          return 1 / stiffness(l, p);
      },
      law);
}

double force_of(const Law& law, double deflection) {
  const double size = std::abs(deflection);
  if (size == 0) return 0;
  if (const auto* l = std::get_if<PowerLaw>(&law))
    return std::copysign(l->force * std::pow(size / l->deflection, 1 / l->exponent), deflection);
  if (const auto* l = std::get_if<HardeningLaw>(&law))
    return l->stiffness * deflection * (1 + deflection * deflection / (l->reference * l->reference));
  if (std::holds_alternative<HertzPointLaw>(law))
    return std::copysign(std::pow(size / analytic::deflection(law, 1), 1.5), deflection);
  double low = 0, high = 1;
  while (analytic::deflection(law, high) < size) low = high, high *= 4;
  double force = low > 0 ? low : high;  // Newton's method between the two
  for (int i = 0; i < 200 && high - low > 1e-16 * high; ++i) {
    const double lacking = size - analytic::deflection(law, force);
    (lacking > 0 ? low : high) = force;
    double next = force + lacking / analytic::compliance(law, force);
    if (!(next >= low && next <= high)) next = low + (high - low) / 2;
    if (std::abs(next - force) <= 1e-16 * force) break;
    force = next;
  }
  return std::copysign(force, deflection);
}

double stored_energy(const Law& law, double force, const AsPrinted& p) {
  if (const auto* l = std::get_if<HertzLineBulkLaw>(&law)) {
    if (force == 0) return 0;
    const BulkLine b = bulk_line(*l, force);
    return std::abs(force) * b.p_kappa * (b.logarithm - 1.5);
  }
  if (const auto* l = std::get_if<HardeningLaw>(&law)) {
    const double d = hardening_deflection(*l, force), x = d / l->reference;
    return l->stiffness * d * d * (2 + x * x) / 4;
  }
  if (const auto* l = std::get_if<TableLaw>(&law)) return table_stored_energy(*l, force);
  // δ ∝ fⁿ stores n/(1 + n) of f δ: two fifths of it for n = 2/3, one half for n = 1.
  const auto* power = std::get_if<PowerLaw>(&law);
  const double n = power ? power->exponent : std::holds_alternative<HertzPointLaw>(law) ? 2.0 / 3 : 1;
  return n / (1 + n) * force * deflection(law, force, p);
}

double deflection(const std::vector<Law>& laws, double force, const AsPrinted& p) {
  return in_series(
      laws, p, [&](const Law& l) { return deflection(l, force, p); }, [&](double k) { return force / k; });
}

double compliance(const std::vector<Law>& laws, double force, const AsPrinted& p) {
  return in_series(
      laws, p, [&](const Law& l) { return compliance(l, force, p); }, [](double k) { return 1 / k; });
}

double stored_energy(const std::vector<Law>& laws, double force, const AsPrinted& p) {
  return in_series(
      laws, p, [&](const Law& l) { return stored_energy(l, force, p); },
      [&](double k) { return force * force / (2 * k); });
}

double deflection(const Spring& s, double force, const AsPrinted& p) {
  if (s.preload == 0) return deflection(s.laws, force, p);
  if (small(force, s.preload)) {
    const Split laws = split(s.laws);
    double sum = integral(force, [&](double f) { return compliance(laws.others, f + s.preload, p); });
    for (const TableLaw* table : laws.tables) sum += table_change(*table, s.preload, force);
    return sum;
  }
  return deflection(s.laws, force + s.preload, p) - deflection(s.laws, s.preload, p);
}

double compliance(const Spring& s, double force, double least, const AsPrinted& p) {
  return compliance(s.laws, std::copysign(std::max(std::abs(force + s.preload), least), force + s.preload), p);
}

double stored_energy(const Spring& s, double force, const AsPrinted& p) {
  if (s.preload == 0) return stored_energy(s.laws, force, p);
  if (small(force, s.preload)) {
    const Split laws = split(s.laws);
    double sum = integral(force, [&](double f) { return f * compliance(laws.others, f + s.preload, p); });
    for (const TableLaw* table : laws.tables) sum += table_change_energy(*table, s.preload, force);
    return sum;
  }
  return stored_energy(s.laws, force + s.preload, p) - stored_energy(s.laws, s.preload, p) -
         s.preload * deflection(s, force, p);
}

namespace {

ScalarLaw bent(const Law& law, double P) {
  const double rest = at_rest(law, P);
  if (const auto* table = std::get_if<TableLaw>(&law)) return table_by_corners(*table, rest, P);
  if (std::holds_alternative<HertzPointLaw>(law)) {  // d = unit · f²ᐟ³
    const double unit = analytic::deflection(law, 1);
    const auto root = [=](double d) { return std::sqrt(std::abs(d + rest) / unit); };
    return {-HUGE_VAL, HUGE_VAL, [=](double d) { return std::copysign(root(d) * root(d) * root(d), d + rest) - P; },
            [=](double d) { return 1.5 * root(d) / unit; }};
  }
  return {-HUGE_VAL, HUGE_VAL, [&law, P, rest](double d) { return force_of(law, d + rest) - P; },
          [&law, rest](double d) { return 1 / analytic::compliance(law, force_of(law, d + rest)); }};
}

}  // namespace

double compliance(const OneSidedLaw& l, double f) { return (f < 0 ? l.push : l.pull).value_or(0); }

double at_rest(const Law& law, double P) { return P == 0 ? 0 : analytic::deflection(law, P); }

ScalarLaw scalar_law(const Law& law, double P, double slip, double limit) {
  const auto sign = [](double f) { return f > 0 ? 1.0 : f < 0 ? -1.0 : 0.0; };
  if (const auto* l = std::get_if<ClearanceLaw>(&law)) {
    const double rest = l->gap * sign(P);
    return {-l->gap - rest, l->gap - rest, [P](double) { return -P; }, [](double) { return 0.0; }, -rest, l->gap};
  }
  if (const auto* l = std::get_if<FrictionLaw>(&law)) {
    const double k = l->stiffness, F = limit;
    return {-HUGE_VAL,
            HUGE_VAL,
            [=](double d) { return std::clamp(k * (d - slip) + P, -F, F) - P; },
            [=](double d) { return std::abs(k * (d - slip) + P) > F ? 0.0 : k; },
            slip - P / k,
            std::max(F / k, 1e-15)};
  }
  if (!std::holds_alternative<OneSidedLaw>(law)) return bent(law, P);
  const OneSidedLaw one = std::get<OneSidedLaw>(law);
  const double rest = compliance(one, P) * P;
  const auto slope = [one, rest](double d) {
    const double c = compliance(one, d + rest);
    return c > 0 ? 1 / c : 0;
  };
  return {compliance(one, -1) > 0 ? -HUGE_VAL : -rest, compliance(one, 1) > 0 ? HUGE_VAL : -rest,
          [=](double d) { return slope(d) * (d + rest) - P; }, slope};
}

}  // namespace deflect::analytic
