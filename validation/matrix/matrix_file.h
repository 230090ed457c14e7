// Stiffness matrices and twists as other programs print them.
//
// Accepted: CSV with commas, semicolons or tabs, or columns between blanks; decimal points, or decimal commas where the
// separator is no comma; one header row and a first column of names or row numbers; MATLAB ("K = [1 2; 3 4];", the
// display with its common factor "1.0e+05 *"), NumPy ("array([[1. 2.] [3. 4.]])"), Fortran exponents (1.5D+03);
// comments from # or % to the end of the line; JSON objects, of which one member is the matrix. Refusals are
// InputErrors "file:line: …" with column, value and remedy; nothing is skipped in silence.
#pragma once

#include <filesystem>
#include <string>

#include "msa/base/spatial.h"

namespace deflect::matrix {

/// Numbers and how well they are known from their text. A program prints either with a number of significant digits or
/// with a number of decimals; the file shows the largest of both, and trailing zeros that were left out are not lost.
struct PrintedMatrix {
  MatrixX values;
  MatrixX rounding;  ///< half a unit of the last digit printed, the shape of `values`
};

/// What a file does not say of itself: its unit of length (forces are N, angles rad) and whether [θ; δ] is its order.
struct MatrixConvention {
  double unit_m = 1e-3;
  bool rotation_first = false;
};

/// A matrix of any shape; `file` is for messages.
PrintedMatrix parse_matrix(std::string text, const std::string& file);

/// A 6×6 stiffness, translation first, in N and the convention's unit of length. `key` names the matrix in a JSON
/// object
/// ("analytic.stiffness"); the stiffness of `deflect solve --json` is known to be in N, mm, Nmm and translation first.
PrintedMatrix read_stiffness(const std::filesystem::path&, const MatrixConvention&, const std::string& key);

/// Twists as columns, translation first, 6×m with 1 ≤ m ≤ 5; the file may have them as rows.
PrintedMatrix read_twists(const std::filesystem::path&, const MatrixConvention&);

}  // namespace deflect::matrix
