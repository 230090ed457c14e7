// The border between deflect and the module deflect_mpi, which alone is linked with MPI and loaded under mpirun only.
#pragma once

#include <memory>
#include <string>

#include "msa/base/module.h"
#include "validation/parallel/ranks.h"

namespace deflect::parallel::mpi {

struct Module : ModuleHead {
  /// All processes of the run; MPI ends with the object. Null, and why, where MPI does not start.
  std::unique_ptr<Ranks> (*start)(std::string& failure) noexcept;
  std::string (*library)() noexcept;  ///< "Open MPI v4.1.4"
};

/// Its interface is to be raised when Module or Ranks changes.
inline constexpr ModuleKind module_kind = {"deflect_mpi.so", "deflect_mpi_module", 1};

}  // namespace deflect::parallel::mpi
