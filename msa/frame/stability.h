// Why a structure cannot stand: which bodies move, and how, with nothing to resist; and which of such motions are
// harmless.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "msa/base/error.h"
#include "msa/frame/free_motions.h"

namespace deflect::frame {

/// A small rigid motion: rotation by 1 rad about the axis through `point`, with `pitch` metres of travel along it per
/// radian; or a pure translation along the axis.
struct Screw {
  bool translation = false;
  Vector3 axis = Vector3::Zero(), point = Vector3::Zero();  ///< unit vector; m
  double pitch = 0;
};

/// Nodes that beams and rigid joints hold together, moving as one.
struct MovingBody {
  std::string name;  ///< its members ("leg 1 link"), or its nodes
  std::vector<int> nodes;
  Screw screw;
};

/// One way in which a structure can move without strain.
struct FreeMotion {
  VectorX u;  ///< by freedom; largest translation or rotation times the structure's size is 1
  std::vector<MovingBody> bodies;
  std::vector<std::string> joints;  ///< free freedoms of joints that move: locking any one of them would hold it
  bool idle = false;                ///< one straight member turning about its own axis: it moves nothing else
};

/// A structure that cannot stand: what() says which bodies move and what would hold them; the rest is for drawing it.
struct CannotStand : ModelError {
  CannotStand(const std::string& what, const Model&, std::vector<FreeMotion>);

  std::shared_ptr<const Model> model;
  std::vector<FreeMotion> motions;
};

/// Motions that no element resists, taken apart so that each moves as little as possible. Independent of any load.
std::vector<FreeMotion> free_motions_of(const Model&, const Elimination&, const SparsePattern&,
                                        const std::vector<double>& values);

/// "leg 1 link turns about the axis (0, 0.6, 0.8) through (…) mm; held by locking … or by a support at node …".
std::string describe(const Model&, const FreeMotion&);

/// The screw of a body whose point p moves by v (m) while it turns by w (rad).
Screw screw_of(const Vector3& p, const Vector3& v, const Vector3& w);

/// Constraints that hold idle motions, one each: the rotation of one node about the member's axis.
void hold(Model&, const FreeMotion& idle);

/// Of a structure without free motion but with a condition too poor for its digits: the softest and the stiffest part
/// along the worst motion, as a sentence.
std::string explain_condition(const Model&, const Elimination&, const SparsePattern&, const std::vector<double>& values,
                              double reciprocal_condition);

}  // namespace deflect::frame
