// A mechanism under a load as lines with fields, for other programs: Gmsh and ParaView.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "meshes/line_mesh.h"
#include "msa/mechanism/configuration.h"
#include "validation/theories/theory.h"

namespace deflect::studies {

/// By the MSA. Groups are legs' parts ("leg 1 guideway", "rigid"), with leg (0: none) and part (0: a rigid arm) as
/// fields of cells; fields of points are displacements, load and reaction.
struct LoadedStructure {
  LineMesh mesh, deflected;  ///< unloaded; with displacements enlarged by `scale`
  FieldData fields;
  double scale = 1;
  Vector6 tool_mm_rad = Vector6::Zero();  ///< displacement of T
};

/// `load_N_Nmm` on T about T in base axes. `scale`: without one what makes displacements visible. InputError unless it
/// is above zero.
LoadedStructure loaded_structure(const std::string& name, const Configuration&, const frame::MemberDivision&,
                                 const Vector6& load_N_Nmm, const std::optional<double>& scale);

enum class StructureFormat { msh, vtk };
/// As a user writes it, and what its files end in.
inline constexpr const char *structure_format_names[] = {"msh", "vtk"}, *structure_suffixes[] = {".msh", ".vtu"};

/// InputError for another name; `what` begins the message.
StructureFormat structure_format(const std::string& name, const std::string& what);

/// Where write_structure() writes the deflected shape: loaded.vtu -> loaded-deflected.vtu.
std::filesystem::path deflected_path(const std::filesystem::path&, StructureFormat);

/// Two files. msh: Gmsh 4.1, and FILE.opt, by which Gmsh draws the deflected shape when it opens FILE. vtk: .vtu.
void write_structure(const LoadedStructure&, StructureFormat, const std::filesystem::path&);

}  // namespace deflect::studies
