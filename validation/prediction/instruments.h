// What named sensors read, and what loads at named points do, at one pose of a machine.
//
// A sensor at the point P of a body that moves by d = [δ; θ] at T reads gain · n · (δ + (R(θ) − 1) r) + zero, n its
// direction and r = P − T; to the first order gain · [n; r × n] · d. A load at P moves with the body: its moment about
// T is (R(θ) r) × f in the deformed shape.
//
// Where the tool joint yields, T moves by more than the platform. The platform's motion is then that of the machine
// with a rigid tool joint under all loads; the tool's own deflection is that under the load at T alone, where there are
// loads on the platform on the undeformed machine.
//
// A sensor inside a leg reads gain · f + zero of the force of a drive, or n · (δ + (R(θ) − 1) r) of a point of a body
// there, as the theory finds them; nothing of it follows from the motion of T.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "msa/mechanism/inside.h"
#include "validation/measurement/measurements.h"
#include "validation/prediction/rig.h"
#include "validation/theories/theory.h"

namespace deflect::prediction {

/// Displacements at T of what is beyond the tool joint, and of the platform; m, rad.
struct Motion {
  Vector6 tool = Vector6::Zero(), platform = Vector6::Zero();
  bool converged = true;
  std::vector<double> slips = {};
  std::string reason = {};                 ///< why it did not converge, where known
  std::vector<Vector6> inside = {};        ///< by Instruments::inside()
  std::vector<std::string> floating = {};  ///< play that the load leaves open (theories::Prediction)
};

/// The sensors and points of load that a file has columns for, in its order.
class Instruments {
 public:
  /// Throws InputError where the mechanism lacks one. The mechanism must outlive this.
  Instruments(const Mechanism&, const measurement::Measurements&);

  /// By number in Reading::at_points.
  const std::vector<const LoadPoint*>& load_points() const { return points_; }
  /// Whether a sensor or a load is on the platform, rather than beyond the tool joint.
  bool on_platform() const;

  /// What its sensors read inside legs, in their order (inside.h).
  std::vector<Inside> inside(const Configuration&) const;

  /// First-order reading of a displacement of T by sensor k, gain included. 0 of a sensor inside a leg.
  Vector6 form(const Configuration&, std::size_t k) const;
  /// What the sensors read, in the deformed shape or to the first order.
  VectorX readings(const Configuration&, const Motion&, Geometry) const;

 private:
  std::vector<const PointSensor*> sensors_;
  std::vector<std::optional<NamedPart>> parts_;  // that they read, inside legs
  std::vector<const LoadPoint*> points_;
};

/// A machine at one pose by one theory, under the loads of readings.
class LoadedMachine {
 public:
  /// `loads`: those at this pose. All but the theory and the loads must outlive this. Throws InputError where the
  /// tool joint has friction and something is on the platform: its loops are not told apart.
  LoadedMachine(const theories::Theory&, const theories::TheoryOptions&, const Configuration&, const Instruments&,
                const TrueLoads& loads);

  theories::TheoryAt& theory() { return *machine_; }
  /// Whether the same load at T has the same answer, whatever points it acts at.
  bool by_load_at_T(Geometry g) const {
    return !rigid_tool_ && !loads_.any_named() && !(loads_.any_turns() && g == Geometry::finite);
  }
  Motion move(const measurement::Reading&, const Conditions&);

 private:
  theories::Prediction predict(theories::TheoryAt&, const measurement::Reading&, const Conditions&);

  TrueLoads loads_;
  std::optional<Configuration> rigid_tool_;
  std::unique_ptr<theories::TheoryAt> machine_, locked_;  // as it is; with a rigid tool joint, where that differs
                                                          // and something still yields
};

}  // namespace deflect::prediction
