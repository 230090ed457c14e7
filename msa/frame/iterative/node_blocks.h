// The reduced stiffness as a symmetric matrix of 6×6 blocks, one row of blocks for each node that is free to move, for
// the iterative solver (incomplete_cholesky.h). Scaled to a diagonal of ones, S K S with S = diag(K)^-½; freedoms that
// a node does not have are a one on the diagonal.
//
// Rows follow the levels of a breadth-first search from a peripheral node (Cuthill and McKee, 1969). They are divided
// into three parts: the levels before a middle level, the levels after it in reverse order, and the middle level. No
// block connects the first two, so that sweeps over them are independent. Along every line of nodes this order causes
// no fill.
#pragma once

#include <vector>

#include "msa/base/spatial.h"
#include "msa/frame/structure/elimination.h"
#include "msa/frame/structure/sparse_cholesky.h"

namespace deflect::frame {

struct NodeBlocks {
  std::vector<int> start;         ///< by row, and one past the last: index of its first block left of the diagonal
  std::vector<int> column;        ///< of a block, ascending within a row
  std::vector<Matrix6> lower;     ///< blocks left of the diagonal
  std::vector<Matrix6> diagonal;  ///< by row
  int first_end = 0, ends = 0;    ///< rows of the two parts: [0, first_end), [first_end, ends); the rest joins them
  int widest_level = 0;           ///< number of nodes of the largest level; 1 for a chain
  std::vector<int> place;         ///< by q: 6 · row + freedom
  VectorX scale;                  ///< by q: S

  int rows() const { return static_cast<int>(diagonal.size()); }
  /// From freedoms q to places, scaled by S, and back.
  VectorX gathered(const VectorX& by_q) const;
  VectorX scattered(const VectorX& by_place) const;
};

/// `values` in the order of the pattern. The diagonal must be positive.
NodeBlocks node_blocks(const Elimination&, const SparsePattern&, const std::vector<double>& values);

}  // namespace deflect::frame
