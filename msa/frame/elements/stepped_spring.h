// Springs that jump. The force of a gap or of a rigid side is not a function of the displacement. Solvers find it from
// the set-valued law (set_valued.cpp). Other code uses the known force λ and a contact stiffness K:
//   w = δ + λ/K,   f(w),   which is λ where δ keeps its law.
#pragma once

#include <algorithm>
#include <cmath>

namespace deflect::frame {

/// Free travel ±gap.
struct GapSpring {
  double gap = 0;
  double contact = 0;  ///< K
  double known = 0;    ///< λ

  double beyond(double d) const {
    const double w = d + known / contact;
    return w - std::clamp(w, -gap, gap);
  }
  double force(double d) const { return contact * beyond(d); }
  double tangent(double d) const { return beyond(d) != 0 ? contact : 0; }
  double energy(double d) const { return contact * beyond(d) * beyond(d) / 2; }
  double at_force(double) const { return contact; }
  double elongation(double f) const { return f == 0 ? 0 : std::copysign(gap, f); }
  double stored(double) const { return 0; }
  double slip(double) const { return 0; }
  /// Of the law without its contact stiffness; infinite where it is rigid.
  double true_tangent(double d) const { return beyond(d) != 0 ? HUGE_VAL : 0; }
};

/// Compliances under pull and push, m/N or rad/Nm; zero is rigid. No contact stiffness is used for a side that is
/// softer than it.
struct OneSidedSpring {
  double pull = 0, push = 0;
  double contact = 0, known = 0;

  double compliance(double sign) const { return sign < 0 ? push : pull; }
  bool soft(double sign) const { return compliance(sign) * contact >= 1; }
  double beyond(double d) const { return soft(known) ? d : d + known / contact; }
  double force(double d) const { return at_force(beyond(d)) * beyond(d); }
  double tangent(double d) const { return at_force(beyond(d)); }
  double energy(double d) const { return force(d) * beyond(d) / 2; }
  double at_force(double f) const { return 1 / (compliance(f) + (soft(f) ? 0 : 1 / contact)); }
  double elongation(double f) const { return compliance(f) * f; }
  double stored(double f) const { return compliance(f) * f * f / 2; }
  double slip(double) const { return 0; }
  double true_tangent(double d) const { return 1 / compliance(force(d)); }
};

/// Elastic–Coulomb friction, by return mapping from the slip before the load. energy() is the potential of the step,
/// including the work dissipated by sliding; stored() is the elastic part. `most` is the limit under the present load;
/// it grows with what the spring `beside` carries.
struct FrictionSpring {
  double k = 0, most = 0;  ///< N/m and N, Nm/rad and Nm
  int number = -1;         ///< of the friction law, see number_slips()
  double before = 0;       ///< slip
  double own = most;       ///< the limit where nothing is carried beside it
  double share = 0;        ///< of the force in the spring number `beside` of the model
  int beside = -1;

  double force(double d) const { return std::clamp(k * (d - before), -most, most); }
  bool slides(double d) const { return k * std::abs(d - before) > most; }
  double tangent(double d) const { return slides(d) ? 0 : k; }
  double energy(double d) const {
    const double e = std::abs(d - before);
    return k * e > most ? most * (e - most / k / 2) : k * e * e / 2;
  }
  double at_force(double) const { return k; }
  double elongation(double f) const { return before + f / k; }
  double stored(double f) const { return f * f / (2 * k); }
  double slip(double d) const { return slides(d) ? d - std::copysign(most / k, d - before) : before; }
  double true_tangent(double d) const { return tangent(d); }
};

}  // namespace deflect::frame
