// How the mistakes are undone that have something to be found out: an entry, a lever, a rotation, a factor, a
// stiffness. All are of the type Undo (mistakes.h).
#pragma once

#include "validation/matrix/mistakes.h"

namespace deflect::matrix {

/// The upper triangle copied down, where the lower is zero.
std::optional<Undone> mirrored_triangle(const Matrix6& K, const MistakeContext&);

/// Of the pair that differs most, the upper entry copied down.
std::optional<Undone> worst_pair_copied(const Matrix6& K, const MistakeContext&);

/// The same done to Kᵀ.
Undo below_diagonal(const Undo&);

std::optional<Undone> inverse(const Matrix6& K, const MistakeContext&);

/// K = X(p)ᵀ R X(p): p by least squares from A [p]× = B_R − B, which is linear.
std::optional<Undone> moved_back(const Matrix6& K, const MistakeContext&);

/// K = K₀ X(p), K₀ symmetric: p by least squares from A [p]× = K_θδᵀ − K_δθ.
std::optional<Undone> moved_on_one_side(const Matrix6& K, const MistakeContext&);

/// K = diag(Q, Q) K₀, K₀ ≻ 0: Q is the rotation of the polar decomposition of A.
std::optional<Undone> turned_on_one_side(const Matrix6& K, const MistakeContext&);

/// K = diag(Q, Q) R diag(Q, Q)ᵀ: Q takes the eigenframe of a matrix that turns with K to that of R; of the four such
/// rotations the one that comes nearest to R. That matrix is a sum of all blocks, or A, which other points share.
std::optional<Undone> turned_by_all_blocks(const Matrix6& K, const MistakeContext&);
std::optional<Undone> turned_by_translations(const Matrix6& K, const MistakeContext&);

/// K = s R, s > 0.
std::optional<Undone> scaled(const Matrix6& K, const MistakeContext&);

/// K − R ⪰ 0 and R − K ⪰ 0: the positive part of the difference taken away, and added.
std::optional<Undone> surplus_taken_away(const Matrix6& K, const MistakeContext&);
std::optional<Undone> lack_filled(const Matrix6& K, const MistakeContext&);

}  // namespace deflect::matrix
