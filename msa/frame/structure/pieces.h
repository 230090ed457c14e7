// A structure as rigid pieces: what its beams and welds hold together moves as one body as long as nothing is strained.
// On each piece six coordinates y that its connections see alike, whatever its size and units.
#pragma once

#include <vector>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// Coordinates of a motion without strain: an orthonormal one per direction in which a connection holds the piece.
struct Piece {
  std::vector<int> nodes;
  Vector3 centre = Vector3::Zero();  ///< m
  double size = 1;                   ///< m: a rotation of 1 rad counts as this many metres
  /// [u; size · θ] at the centre = held y + loose z. Columns of `held` are scaled so that the piece's connections see
  /// each y with strength 1; what `loose` (orthonormal) does no connection sees.
  Matrix6X held = Matrix6X(6, 0), loose = Matrix6X(6, 0);
  double weakest = 1;  ///< strength of the weakest held direction against the strongest, before scaling
  int first = 0;       ///< of its y among all
};

/// A condition that a motion without strain fulfils: Σ coefficient · y = 0, scaled to a largest coefficient near 1.
using PieceRow = LinearForm;

struct Pieces {
  std::vector<Piece> pieces;
  std::vector<int> of_node;         ///< piece of each node
  std::vector<int> y_of_scalar;     ///< −1 where nothing sees the scalar
  std::vector<double> scalar_unit;  ///< scalar = unit · y
  std::vector<PieceRow> rows;
  int coordinates = 0;  ///< number of y
};

/// By node, the first node of its piece: beams whose rigidities are all positive, and welds, hold pieces together.
std::vector<int> first_nodes(const Model&);

/// Directions that no connection sees to 1e-10 of the strongest are loose. `resists`, by spring: whether it counts.
Pieces pieces_of(const Model&, const std::vector<char>& resists);

/// A piece's motion x = [u; size · θ] at its centre as displacements of its nodes and their spins.
LinearForm motion_of(const Model&, const Piece&, const Vector6& x);

}  // namespace deflect::frame
