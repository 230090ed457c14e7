// A structure as rigid pieces: nodes connected by beams and welds move as one body in motions without strain. Each
// piece has six coordinates y, scaled by its connections so that its size and units do not matter.
#pragma once

#include <vector>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// A piece and its coordinates in motions without strain.
struct Piece {
  std::vector<int> nodes;
  Vector3 centre = Vector3::Zero();  ///< m
  double size = 1;                   ///< m: a rotation of 1 rad counts as this many metres
  /// [u; size · θ] at the centre = held y + loose z. Columns of `held` are scaled so that each y acts on the piece's
  /// connections with strength 1; motions along `loose` (orthonormal) do not act on any connection.
  Matrix6X held = Matrix6X(6, 0), loose = Matrix6X(6, 0);
  double weakest = 1;  ///< strength of the weakest held direction relative to the strongest, before scaling
  int first = 0;       ///< index of its first y among all
};

/// A condition on motions without strain: Σ coefficient · y = 0, scaled to a largest coefficient near 1.
using PieceRow = LinearForm;

struct Pieces {
  std::vector<Piece> pieces;
  std::vector<int> of_node;         ///< piece of each node
  std::vector<int> y_of_scalar;     ///< −1 where the scalar occurs nowhere
  std::vector<double> scalar_unit;  ///< scalar = unit · y
  std::vector<PieceRow> rows;
  int coordinates = 0;  ///< number of y
};

/// By node, the first node of its piece. Welds, and beams whose rigidities are all positive, connect nodes to pieces.
std::vector<int> first_nodes(const Model&);

/// Directions with strength below 1e-10 of the strongest are loose. `resists`, by spring: whether it counts.
Pieces pieces_of(const Model&, const std::vector<char>& resists);

/// A piece's motion x = [u; size · θ] at its centre as displacements of its nodes and their spins.
LinearForm motion_of(const Model&, const Piece&, const Vector6& x);

}  // namespace deflect::frame
