#include "validation/matrix/mistakes.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "validation/matrix/mistake_fits.h"

namespace deflect::matrix {
namespace {

constexpr double per_degree = pi / 180;

Vector6 halves(double translation, double rotation) {
  Vector6 v;
  v << Vector3::Constant(translation), Vector3::Constant(rotation);
  return v;
}

/// K with rows and columns multiplied: of forces, moments; translations, rotations.
Undo scaling(const Vector6& rows, const Vector6& columns) {
  return [rows, columns](const Matrix6& K, const MistakeContext&) {
    return Undone{rows.asDiagonal() * K * columns.asDiagonal(), ""};
  };
}

Undo only_with_reference(const Undo& undo) {
  return [undo](const Matrix6& K, const MistakeContext& c) { return c.R ? undo(K, c) : std::nullopt; };
}

bool is_positive(const Matrix6& K) {
  const Matrix6 symmetric = (K + K.transpose()) / 2;
  return Eigen::SelfAdjointEigenSolver<Matrix6>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()(0) >= 0;
}

/// One block multiplied. Without a reference only a coupling too large for A and D shows that a block is wrong.
Undo block(double translation, double coupling, double rotation) {
  return [=](const Matrix6& K, const MistakeContext& c) -> std::optional<Undone> {
    if (!c.R && is_positive(K)) return {};
    Matrix6 out = coupling * K;
    out.topLeftCorner<3, 3>() = translation * K.topLeftCorner<3, 3>();
    out.bottomRightCorner<3, 3>() = rotation * K.bottomRightCorner<3, 3>();
    return Undone{out, ""};
  };
}

/// K⁻¹ has as many negative eigenvalues as K: by itself a matrix that is not positive is no compliance.
std::optional<Undone> inverted(const Matrix6& K, const MistakeContext& c) {
  return c.R || is_positive(K) ? inverse(K, c) : std::nullopt;
}

template <class F>
Undo matrix(F f) {
  return [f](const Matrix6& K, const MistakeContext&) { return Undone{f(K), ""}; };
}

Matrix6 rows_swapped(const Matrix6& K) {
  Matrix6 out;
  out << K.bottomRows<3>(), K.topRows<3>();
  return out;
}
Matrix6 columns_swapped(const Matrix6& K) { return rows_swapped(K.transpose()).transpose(); }
Matrix6 order_swapped(const Matrix6& K) { return rows_swapped(columns_swapped(K)); }

/// Two rows, two columns, or both exchanged, of any two axes; both leave K symmetric, which only a reference tells.
std::vector<Undo> any_two_exchanged() {
  constexpr const char *forces[] = {"fx", "fy", "fz", "mx", "my", "mz"},
                       *motions[] = {"ux", "uy", "uz", "thx", "thy", "thz"};
  std::vector<Undo> rows, columns, both;
  for (int i = 0; i < 6; ++i)
    for (int j = i + 1; j < 6; ++j) {
      const std::string of_rows = fmt::format(": rows {} and {}", forces[i], forces[j]),
                        of_columns = fmt::format(": columns {} and {}", motions[i], motions[j]);
      rows.push_back([=](const Matrix6& K, const MistakeContext&) {
        Undone out{K, of_rows};
        out.K.row(i).swap(out.K.row(j));
        return out;
      });
      columns.push_back([=](const Matrix6& K, const MistakeContext&) {
        Undone out{K, of_columns};
        out.K.col(i).swap(out.K.col(j));
        return out;
      });
      both.push_back(only_with_reference([=, row = rows.back(), column = columns.back()](
                                             const Matrix6& K, const MistakeContext& c) -> std::optional<Undone> {
        return Undone{column(row(K, c)->K, c)->K, of_rows + "," + of_columns.substr(1)};
      }));
    }
  rows.insert(rows.end(), columns.begin(), columns.end());
  rows.insert(rows.end(), both.begin(), both.end());
  return rows;
}

Matrix6 coupling_negated(const Matrix6& K) {
  Matrix6 out = K;
  out.topRightCorner<3, 3>() *= -1;
  return out;
}
Matrix6 coupling_transposed(const Matrix6& K) {
  Matrix6 out = K;
  out.topRightCorner<3, 3>().transposeInPlace();
  return out;
}

/// By the rule of a compliance, which is that of a stiffness with the halves exchanged.
Undo by_the_other_rule(const Undo& undo) {
  return [undo](const Matrix6& K, const MistakeContext& c) -> std::optional<Undone> {
    Matrix6 R;
    MistakeContext exchanged = c;
    if (c.R) R = order_swapped(*c.R), exchanged.R = &R;
    std::optional<Undone> undone = undo(order_swapped(K), exchanged);
    if (undone) undone->K = order_swapped(undone->K);
    return undone;
  };
}

std::vector<Mistake> table() {
  const Vector6 one = Vector6::Ones();
  return {
      {"negated",
       "its sign is reversed: it gives the forces of the device on the load, not of the load on the device",
       "take −K: a positive force moves the point its own way",
       {scaling(-one, one)}},
      {"triangle",
       "only one of its triangles is filled, the other is zero",
       "copy each entry to the other side of the diagonal",
       {mirrored_triangle, below_diagonal(mirrored_triangle)}},
      {"one_pair",
       "one entry differs from the one across the diagonal, all others agree",
       "correct that entry",
       {worst_pair_copied, below_diagonal(worst_pair_copied)}},
      {"coupling_not_transposed",
       "both coupling blocks are the same: one of them must be the transpose of the other",
       "transpose the coupling block that was copied",
       {below_diagonal(matrix(coupling_transposed)), matrix(coupling_transposed)}},
      {"coupling_sign",
       "its coupling of translation and rotation has the wrong sign: a lever was taken backwards (from "
       "the point instead of to it), or rotations count left-handed",
       "change the sign of the coupling block",
       {below_diagonal(matrix(coupling_negated)), matrix(coupling_negated),
        only_with_reference(scaling(halves(1, -1), halves(1, -1)))}},
      {"moment_sign",
       "the sign of its moments is reversed (or, by its columns, that of its rotations), but not that of the other",
       "change the sign of the rows of the moments, or of the columns of the rotations",
       {scaling(halves(1, -1), one), scaling(one, halves(1, -1))}},
      {"moments_in_Nm",
       "its moments are in Nm while its displacements are in mm",
       "multiply the rows of the moments by 1000, or divide the columns of the translations by 1000 and use --unit m",
       {scaling(halves(1, 1e3), one), scaling(one, halves(1e3, 1))}},
      {"moments_in_Nmm",
       "its moments are in Nmm while its displacements are in m",
       "divide the rows of the moments by 1000 and use --unit m, or divide the columns of the translations by 1000",
       {scaling(one, halves(1e-3, 1)), scaling(halves(1, 1e-3), one)}},
      {"degrees",
       "its rotations are in degrees",
       "multiply the columns of the rotations by 180/pi",
       {scaling(one, halves(1, 1 / per_degree)),
        only_with_reference(scaling(halves(1, 1 / per_degree), halves(1, 1 / per_degree)))}},
      {"mixed_order",
       "its rows and columns are ordered differently: forces come first and rotations come first, or "
       "the reverse",
       "exchange the upper and lower three rows",
       {matrix(rows_swapped), matrix(columns_swapped)}},
      {"two_exchanged", "two of its rows, or two of its columns, are exchanged (swapped)", "exchange them again",
       any_two_exchanged()},
      {"rotation_first",
       "it is ordered rotation first, [θ; δ] and [m; f]",
       "use --order rotation-first",
       {matrix(order_swapped)}},
      {"metres",
       "its unit of length is 1000 times longer than stated, metres where millimetres are stated",
       "use --unit m",
       {scaling(halves(1, 1e3), halves(1e-3, 1))}},
      {"millimetres",
       "its unit of length is 1000 times shorter than stated, millimetres where metres are stated",
       "use --unit mm",
       {scaling(halves(1, 1e-3), halves(1e3, 1))}},
      {"translation_block",
       "its translation block is in another unit of length than the other blocks",
       "write the translation block in N/mm (N/m with --unit m)",
       {block(1e-3, 1, 1), block(1e3, 1, 1)}},
      {"rotation_block",
       "its rotation block is in another unit of length than the other blocks",
       "write the rotation block in Nmm (Nm with --unit m)",
       {block(1, 1, 1e3), block(1, 1, 1e-3)}},
      {"coupling_block",
       "its coupling block was converted between units of length, but N per rad have none",
       "write the coupling block in N",
       {block(1, 1e3, 1), block(1, 1e-3, 1)}},
      {"compliance", "it is a compliance, displacement per force", "invert it", {inverted}},
      {"moved", "it is given at another point", "move it to the point of the reference: K' = Xᵀ K X", {moved_back}},
      {"moved_as_compliance",
       "it was moved to another point by the rule of a compliance (X C Xᵀ), which is not that of "
       "a stiffness",
       "undo it and move it with the transposed matrix: K' = Xᵀ K X",
       {by_the_other_rule(moved_back)}},
      {"moved_on_one_side",
       "it was moved to another point on one side only (K X without Xᵀ)",
       "multiply from both sides: K' = Xᵀ K X",
       {moved_on_one_side, below_diagonal(moved_on_one_side), by_the_other_rule(moved_on_one_side),
        by_the_other_rule(below_diagonal(moved_on_one_side))}},
      {"turned_on_one_side",
       "it was turned into other axes on one side only (R K without Rᵀ)",
       "multiply from both sides: R K Rᵀ, R in both halves",
       {turned_on_one_side, below_diagonal(turned_on_one_side)}},
      {"turned",
       "it is given in other axes",
       "turn it into the axes of the reference: R K Rᵀ, R in both halves",
       {turned_by_all_blocks, turned_by_translations}},
      {"scaled", "it is the reference times a factor", "look for a modulus, a thickness or a unit of force", {scaled}},
      {"stiffer",
       "it is stiffer than the reference in some directions and softer in none, as when passive joints are locked or a "
       "flexible part is taken as rigid",
       "release the passive joints, K − K J (Jᵀ K J)⁻¹ Jᵀ K for the twists J of a leg's, and look for missing parts",
       {surplus_taken_away},
       true},
      {"softer",
       "it is softer than the reference in some directions and stiffer in none, as when an actuated joint is free or a "
       "spring is missing",
       "hold the actuated joints and look for missing parts",
       {lack_filled},
       true},
  };
}

}  // namespace

const std::vector<Mistake>& mistakes() {
  static const std::vector<Mistake> rows = table();
  return rows;
}

}  // namespace deflect::matrix
