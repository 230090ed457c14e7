// A matrix in which most columns are nonzero in only a few rows.
#pragma once

#include <vector>

#include "msa/base/spatial.h"

namespace deflect::statistics {

/// Columns that are 0 outside the rows of a group.
struct GroupColumns {
  std::vector<Eigen::Index> rows;  ///< ascending
  MatrixX columns;                 ///< over these rows
};

/// Columns over all rows, then the columns of each group; no row is in two groups. Memory grows linearly with the rows.
struct PartedColumns {
  MatrixX shared;
  std::vector<GroupColumns> groups;

  PartedColumns() = default;
  PartedColumns(MatrixX all) : shared(std::move(all)) {}

  Eigen::Index rows() const { return shared.rows(); }
  Eigen::Index cols() const;
  VectorX operator*(const VectorX&) const;
  PartedColumns& operator*=(double);
  VectorX squared_row_norms() const;
  MatrixX dense() const;
};

/// Applies change(group, part) in place to the rows of each group.
template <class Groups, class Change>
void change_groups(const Groups& groups, MatrixX& X, const Change& change) {
  for (const auto& group : groups) {
    if (group.rows.empty()) continue;
    const auto first = group.rows.front(), size = std::ssize(group.rows);
    if (group.rows.back() - first + 1 == size) {
      MatrixX part = X.middleRows(first, size);
      change(group, part);
      X.middleRows(first, size) = part;
    } else {
      MatrixX part = X(group.rows, Eigen::all);
      change(group, part);
      X(group.rows, Eigen::all) = part;
    }
  }
}

}  // namespace deflect::statistics
