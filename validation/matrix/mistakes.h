// The usual mistakes in a 6×6 stiffness, one row each: what is said of it, and how it is undone.
//
// A mistake explains a matrix K when undoing it leaves a matrix that is right: equal to a reference R where there is
// one, symmetric, positive and of a plausible size otherwise. What a mistake needs to know (a lever, a rotation, a
// factor) is fitted to R, or to the asymmetry that it left in K. K = [A B; Bᵀ D], translation first, N, rad and a unit
// of length; X(p) = [I −[p]×; 0 I] moves twists (spatial.h), so a stiffness moves as Xᵀ K X and a compliance as
// X⁻¹ C X⁻ᵀ.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect::matrix {

/// What an undoing may look at.
struct MistakeContext {
  const Matrix6* R = nullptr;  ///< reference, in the units of K
  double unit_m = 1e-3;        ///< K's unit of length, for words
};

struct Undone {
  Matrix6 K;
  std::string found;  ///< what was fitted: ", to T + (10, 0, 0) mm"; may be empty
};

/// Nothing where K cannot have come from this mistake, or where only a reference would tell.
using Undo = std::function<std::optional<Undone>(const Matrix6& K, const MistakeContext&)>;

struct Mistake {
  const char* id;
  const char* sentence;  ///< "it" is the matrix; what was found follows
  const char* remedy;
  std::vector<Undo> undo;    ///< ways in which the mistake is made; the first that leaves a right matrix counts
  bool last_resort = false;  ///< fits much: asked only where no other mistake explains K
};

const std::vector<Mistake>& mistakes();

}  // namespace deflect::matrix
