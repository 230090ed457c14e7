// Stiffness over the workspace: the theories on a grid of poses.
//
// What is secant and what is tangent. By default every pose is loaded three times, with the force F along x, y and z.
// The compliance is then secant, C = u/F from the unloaded machine to F, and everything that is read from the 6×6
// stiffness K is tangent at that force. With one given wrench the only state is the one under it, and C is tangent too.
// Without nonlinear springs the two are equal and independent of the load.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"
#include "validation/parallel/work.h"
#include "validation/studies/workspace.h"
#include "validation/theories/theory.h"

namespace deflect::studies {

/// Poses at equal steps from `low` to `high`, both included, x fastest, all with one orientation. One value on an axis
/// stands in the middle.
struct MapGrid {
  Vector3 low_mm = Vector3::Zero(), high_mm = Vector3::Zero();
  std::array<int, 3> counts = {11, 11, 11};
  Vector3 tilt_deg = Vector3::Zero();  ///< roll pitch yaw

  std::size_t size() const;
  std::size_t index(int i, int j, int k) const;
  double coordinate(int axis, int i) const;  ///< mm
  Vector6 pose_mm_deg(std::size_t index) const;
};

/// The box around the device's workspace; along an axis in which that is flat there is one value.
MapGrid workspace_grid(const Mechanism&, const std::array<int, 3>& counts);

struct MapOptions {
  MapGrid grid;
  std::optional<Region> region;       ///< poses outside of it are left out
  double force_N = 50;                ///< along x, y, z in turn, without `load`
  std::optional<Vector6> load_N_Nmm;  ///< one wrench on T about T, base axes, instead of the three forces
  theories::Theories theories = theories::all_theories();  ///< asked for
  double length_mm = 0;                                    ///< L_c > 0 that weighs rotations in `isotropy`
};

/// What one theory says of T at one pose, base axes. Matrices row by row: ij is the response along i to the force along
/// j.
struct MapValues {
  Matrix3 compliance_mm_N = Matrix3::Zero();  ///< translation of T per force, signed
  Vector3 stiffness_N_mm = Vector3::Zero();   ///< 1/C_ii: along the force, rotations free
  /// K_ii, N/mm and Nmm/rad, all other displacements held. Translation and rotation i in the state under the force
  /// along i.
  Vector6 K_ii = Vector6::Zero();
  /// Eigenvalues of (C_δδ)⁻¹, the translational block of K⁻¹ inverted: N/mm over all directions of a force, rotations
  /// free. With three states the extremes over them.
  double smallest_N_mm = 0, largest_N_mm = 0;
  /// Smallest over largest eigenvalue of K with rotations times L_c as displacements: 1 isotropic, 0 singular; the
  /// reciprocal of the condition number. With three states the worst of them.
  double isotropy = 0;
};

struct MapPose {
  Vector6 pose_mm_deg = Vector6::Zero();
  std::string out_of_reach;  ///< why the kinematics refuse the pose, in their words; empty when it is reached
  std::string reason;        ///< the same without leg and numbers (Cause): equal for poses refused for one reason
  double slide_min_mm = 0, slide_mean_mm = 0, slide_max_mm = 0;  ///< coordinates of the driven slides
  std::vector<MapValues> values;                                 ///< by theory; empty when out of reach
  double relative_difference = 0;  ///< of the displacements, the largest of any two theories and over the loads

  bool reached() const { return out_of_reach.empty(); }
};

/// What a device calls the coordinates of its driven slides.
struct SlideWords {
  std::string key;    ///< of columns: "guide", "slide"; empty where nothing slides
  std::string words;  ///< "guideway length"
};

struct StiffnessMap {
  std::string device;
  SlideWords slides;
  MapOptions options;
  std::vector<MapPose> poses;  ///< in the grid's order
};

/// The default of L_c: the platform radius of the 6-psu, the extent at home of any other mechanism.
double weighing_length_mm(const Mechanism&);

/// Members are one element each, which is exact at its nodes. At every pose, under every load and by each theory asked
/// for the checks of answer.h apply. The result has the same bits for any number of threads and ranks; of these the
/// first has it whole, the others their own poses, nor on which of the poses a journal held. A pose that the
/// kinematics refuse is kept with the reason; every other failure ends the map with the error of the first pose in the
/// grid's order that has one: ModelError, NumericalError. InputError on options that no map can have.
StiffnessMap map_stiffness(const Mechanism&, const MapOptions&, const parallel::Work& = {});

}  // namespace deflect::studies
