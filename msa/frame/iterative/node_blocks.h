// The reduced stiffness as a symmetric matrix of 6×6 blocks, one row of blocks for each node that is free to move, for
// the iterative solver (incomplete_cholesky.h). Scaled to a diagonal of ones, S K S with S = diag(K)^-½; freedoms that
// a node lacks have a one on the diagonal and nothing else.
//
// Rows follow the levels of a breadth-first search from a node far out (Cuthill and McKee, 1969), and are divided into
// three: what comes before a level in the middle, what comes behind it from the far end towards it, and that level. No
// block joins the first two, so that sweeps over them are independent of each other; and along every line of nodes the
// order is one without fill.
#pragma once

#include <vector>

#include "msa/base/spatial.h"
#include "msa/frame/structure/elimination.h"
#include "msa/frame/structure/sparse_cholesky.h"

namespace deflect::frame {

struct NodeBlocks {
  std::vector<int> start;         ///< by row, and one behind the last: its blocks left of the diagonal
  std::vector<int> column;        ///< of a block, ascending within a row
  std::vector<Matrix6> lower;     ///< blocks left of the diagonal
  std::vector<Matrix6> diagonal;  ///< by row
  int first_end = 0, ends = 0;    ///< rows of the two parts: [0, first_end), [first_end, ends); the rest joins them
  int widest_level = 0;           ///< nodes of the largest level: how far the structure is from a chain
  std::vector<int> place;         ///< by q: 6 · row + freedom
  VectorX scale;                  ///< by q: S

  int rows() const { return static_cast<int>(diagonal.size()); }
  /// From freedoms q to places, scaled by S or S⁻¹, and back.
  VectorX gathered(const VectorX& by_q) const;
  VectorX scattered(const VectorX& by_place) const;
};

/// `values` in the order of the pattern. The diagonal must be positive.
NodeBlocks node_blocks(const Elimination&, const SparsePattern&, const std::vector<double>& values);

}  // namespace deflect::frame
