// Describes free motions (mobility.h) in words: which bodies move, how, and what would hold them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "msa/base/error.h"
#include "msa/frame/structure/mobility.h"

namespace deflect::frame {

/// A small rigid motion: rotation by 1 rad about the axis through `point`, with `pitch` metres of travel along it per
/// radian; or a pure translation along the axis.
struct Screw {
  bool translation = false;
  Vector3 axis = Vector3::Zero(), point = Vector3::Zero();  ///< unit vector; m
  double pitch = 0;
};

/// Nodes that beams and rigid joints connect to one moving body.
struct MovingBody {
  std::string name;  ///< its members ("leg 1 link"), or its nodes
  std::vector<int> nodes;
  Screw screw;
};

/// One way in which a structure can move without strain.
struct FreeMotion {
  VectorX u;  ///< by freedom; largest translation or rotation times the structure's size is 1
  std::vector<MovingBody> bodies;
  std::vector<std::string> joints;  ///< free freedoms of joints that move; locking any one of them holds the motion
};

/// Thrown for a structure that cannot stand. what() says which bodies move and what would hold them; the members are
/// for drawing it.
struct CannotStand : ModelError {
  /// `head` is the start of the message; each motion follows.
  CannotStand(const std::string& head, const Model&, const MatrixX& free);

  std::shared_ptr<const Model> model;
  std::vector<FreeMotion> motions;

 private:
  CannotStand(const std::string& head, const Model&, std::vector<FreeMotion>);
};

/// Free motions (columns) separated so that each moves as few bodies as possible.
std::vector<FreeMotion> free_motions_of(const Model&, const MatrixX& free);

/// "leg 1 link turns about the axis (0, 0.6, 0.8) through (…) mm; held by locking … or by a support at node …".
std::string describe(const Model&, const FreeMotion&);

/// Name of an idle motion: "leg 1 link spins idly about its own axis", "node 'a' idly turns about (1, 0, 0) through …".
std::string name_of(const Model&, const IdleMotion&);

/// A sentence for each idle motion that is held, or one for all of a kind where they are many.
std::vector<std::string> idle_notes(const Model&, const std::vector<IdleMotion>&);

/// The screw of a body whose point p moves by v (m) while it turns by w (rad).
Screw screw_of(const Vector3& p, const Vector3& v, const Vector3& w);

/// u divided by its size: the largest translation, or rotation times the structure's size, becomes 1.
VectorX normalised(const Model&, VectorX u);

/// A sentence for a structure that can stand but is too ill-conditioned: names the part that its softest motion strains
/// most, compared with the stiffest.
std::string explain_condition(const Model&, const VectorX& softest, double reciprocal_condition);

}  // namespace deflect::frame
