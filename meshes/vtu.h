// VTK XML unstructured grids (.vtu) for ParaView.
#pragma once

#include <filesystem>

#include "meshes/line_mesh.h"

namespace deflect {

/// Writes mesh and fields as ASCII VTU, lengths in mm, groups as the cell array "group" with their names in
/// the field array "group_names". Numbers round-trip. The file is written whole or not at all; throws
/// InputError when it cannot be written and std::invalid_argument as check(mesh, fields) does.
void write_vtu(const std::filesystem::path&, const LineMesh&, const FieldData&);

}  // namespace deflect
