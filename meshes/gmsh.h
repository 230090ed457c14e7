// What deflect asks of Gmsh. The Gmsh library (92 shared libraries, 70 ms to start) is loaded at the first call, from
// the module deflect_gmsh beside the program or the library; a program that never calls does not pay.
//
// Calls may come from several threads and wait for each other. Each opens and closes a Gmsh session of its own: a
// program that keeps one open itself must not call from within it.
#pragma once

#include <filesystem>
#include <vector>

#include "meshes/line_mesh.h"

namespace deflect::gmsh {

/// Subdivides straight members of the given lengths (m) with Gmsh's 1D mesher at the given element size (m).
/// Returns for every member the positions of its nodes as fractions of its length, 0 first and 1 last, ascending: equal
/// elements that are at most 1 % longer than the size. A member's nodes do not depend on the other members. Throws
/// InputError on a length or a size that is not positive and finite or that asks for more than a million elements in a
/// member, ModelError naming Gmsh's message when meshing fails or the module cannot be loaded.
std::vector<std::vector<double>> subdivide(const std::vector<double>& lengths, double element_size);

/// Writes mesh and fields as MSH 4.1 (ASCII, 16 digits), lengths in mm, one physical group per group, one view per
/// field. Gmsh's format changes some names: double quotes become single ones, what is longer than 120 bytes is cut,
/// and groups of one name are numbered. The file is written whole or not at all; throws InputError when it cannot be
/// written, std::invalid_argument as check(mesh, fields) does, ModelError when the module cannot be loaded.
void write_msh(const std::filesystem::path&, const LineMesh&, const FieldData&);

}  // namespace deflect::gmsh
