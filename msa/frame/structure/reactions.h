// Constraint forces.
#pragma once

#include <memory>

#include "msa/frame/structure/elimination.h"

namespace deflect::frame {

/// λ with f_int(u) − f = Cᵀ λ: the force of a support or joint along its constraint's form, N or Nm; zero for redundant
/// constraints. Factorised once for a structure, used for all its states and loads.
class Reactions {
 public:
  Reactions(const Model&, const Elimination&);
  ~Reactions();
  Reactions(Reactions&&) noexcept;
  Reactions& operator=(Reactions&&) noexcept;

  /// By constraint, for columns f_int − f by freedom.
  MatrixX forces(const MatrixX& unbalanced) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same for one state of a structure under one load.
VectorX constraint_forces(const Model&, const Elimination&, const ExtendedVector& u, const VectorX& load);

}  // namespace deflect::frame
