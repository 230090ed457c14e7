// Third-party libraries and the files that may include them.
#pragma once

#include <cstddef>

namespace deflect::house {

/// Where a third-party library may be included: in files whose path matches `where`, and in no more than
/// `files`; `beside` them a program may that measures it alone.
struct Confinement {
  const char* what;
  const char* includes;
  const char* where;
  const char* rule;
  std::size_t files;
  const char* beside = "";
};
inline constexpr std::size_t any_number = 1000000;

inline constexpr Confinement confinements[] = {
    {"CHOLMOD", "(suitesparse/)?cholmod.*|Eigen/CholmodSupport", "msa/frame/structure/[^/]+\\.cpp",
     "one .cpp file of msa/frame/structure", 1, "tests/benchmark/frames/bare_cholmod\\.cpp"},
    {"SPQR", "(suitesparse/)?(SuiteSparseQR.*|spqr.*)|Eigen/SPQRSupport", "msa/frame/structure/[^/]+\\.cpp",
     "one .cpp file of msa/frame/structure", 1},
    {"Gmsh", "gmsh\\.h.*", "meshes/gmsh_[^/]+\\.cpp", "meshes/gmsh_*.cpp", any_number},
    {"MPI", "mpi\\.h", "validation/parallel/mpi_[^/]+\\.cpp", "validation/parallel/mpi_*.cpp", any_number},
    {"cereal", "cereal/.*", "validation/parallel/pack\\.h", "validation/parallel/pack.h", 1},
    {"yaml-cpp", "yaml-cpp/.*", "msa/fields/[^/]*(reader|writer)[^/]*\\.cpp", "the reader and the writer of msa/fields",
     any_number},
    {"pybind11", "pybind11/.*", "validation/python/.*", "validation/python", any_number},
    {"CLI11", "CLI/.*", "validation/cli/[^/]+\\.cpp", "one .cpp file of validation/cli", 1},
    {"nlohmann json", "nlohmann/.*", "(validation|tests)/.*", "validation and tests", any_number},
    {"libmd", "sha2\\.h", "validation/result_files/[^/]+\\.cpp", "one .cpp file of validation/result_files", 1},
    {"GoogleTest", "g(test|mock)/.*", "tests/.*", "tests", any_number},
};

}  // namespace deflect::house
