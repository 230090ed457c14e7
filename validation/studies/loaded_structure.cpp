#include "validation/studies/loaded_structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "meshes/gmsh.h"
#include "meshes/structure.h"
#include "meshes/vtu.h"
#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "validation/theories/msa_theory.h"

namespace deflect::studies {
namespace {

/// 1, 2 or 5 times a power of ten that shows the largest displacement as some 8 % of the structure's size.
double automatic_scale(const LineMesh& mesh, const std::vector<Vector3>& displacements_mm) {
  Vector3 low = mesh.points.front(), high = low;
  double largest = 0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    low = low.cwiseMin(mesh.points[i]);
    high = high.cwiseMax(mesh.points[i]);
    largest = std::max(largest, displacements_mm[i].norm());
  }
  if (!(largest > 0)) return 1;
  const double wanted = 0.08 * 1e3 * (high - low).norm() / largest;
  const double power = std::pow(10, std::floor(std::log10(wanted))), lead = wanted / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

/// 3 for "leg 3 link [2]", 0 for what belongs to no leg.
int leg_of(const std::string& name) { return name.starts_with("leg ") ? std::atoi(name.c_str() + 4) : 0; }

/// Groups by leg and part ("leg 1 guideway", "rigid"), with both as cell fields: leg 0 is none; parts are numbered from
/// 1 as they come, 0 is a rigid arm.
void group_by_leg(const frame::MechanismModel& m, LineMesh& mesh, FieldData& fields) {
  const std::vector<std::string> parts = mesh.groups;
  const std::size_t beams = m.model.beams.size();
  mesh.groups.clear();
  CellField leg{"leg", {}}, part{"part", {}};
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    LineCell& cell = mesh.cells[i];
    const auto node_leg = [&](int node) { return leg_of(nth(m.model.nodes, node).name); };
    const int number = i < beams ? leg_of(m.model.beams[i].name) : std::max(node_leg(cell.a), node_leg(cell.b));
    leg.values.push_back(number);
    part.values.push_back(i < beams ? cell.group + 1 : 0);
    const std::string& name = nth(parts, cell.group);
    const std::string group = number ? fmt::format("leg {} {}", number, name) : name;
    const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), group);
    cell.group = static_cast<int>(found - mesh.groups.begin());
    if (found == mesh.groups.end()) mesh.groups.push_back(group);
  }
  fields.cells.push_back(std::move(leg));
  fields.cells.push_back(std::move(part));
}

/// What acts on the structure from outside: the load at the tool point, the world's reaction at the ground.
void add_loads(const frame::MechanismModel& m, const Vector6& load_N_Nmm, FieldData& fields) {
  const std::vector<Vector3> zero(m.model.nodes.size(), Vector3::Zero());
  const auto tool = as_size(m.tool), ground = as_size(m.ground);
  const Vector3 force = load_N_Nmm.head<3>(), moment = load_N_Nmm.tail<3>();
  const Vector3 arm_mm = 1e3 * (m.model.nodes[tool].position - m.model.nodes[ground].position);
  const auto field = [&](const char* name, std::size_t node, const Vector3& value) {
    fields.points.push_back({name, zero});
    fields.points.back().values[node] = value;
  };
  field("applied_force_N", tool, force);
  field("applied_moment_Nmm", tool, moment);
  field("reaction_force_N", ground, -force);
  field("reaction_moment_Nmm", ground, -(moment + arm_mm.cross(force)));
}

LineMesh deflected(LineMesh mesh, const FieldData& fields, double scale) {
  for (std::size_t i = 0; i < mesh.points.size(); ++i) mesh.points[i] += scale * fields.points.front().values[i] / 1e3;
  return mesh;
}

/// Gmsh reads FILE.opt after FILE: the first view is drawn as the deflected shape, the mesh as it stands unloaded.
std::string gmsh_options(const FieldData& fields, double scale) {
  std::string text = "Mesh.Lines = 1;\nMesh.LineWidth = 1;\nMesh.ColorCarousel = 2;\n";
  for (std::size_t view = 1; view < fields.points.size() + fields.cells.size(); ++view)
    text += fmt::format("View[{}].Visible = 0;\n", view);
  return text + fmt::format(
                    "View[0].Visible = 1;\nView[0].VectorType = 5;\nView[0].DisplacementFactor = {};\n"
                    "View[0].LineWidth = 4;\n",
                    scale);
}

}  // namespace

LoadedStructure loaded_structure(const std::string& name, const Configuration& at,
                                 const frame::MemberDivision& division, const Vector6& load_N_Nmm,
                                 const std::optional<double>& scale) {
  if (scale && !(*scale > 0)) throw InputError(fmt::format("scale {}: give a factor greater than zero", *scale));
  theories::MsaAt msa(at, {name, division});
  LoadedStructure out;
  out.tool_mm_rad = twist_in_mm(msa.answer(wrench_from_mm(load_N_Nmm)).displacement);
  out.mesh = lines_of(msa.mechanism());
  out.fields = fields_of(msa.mechanism(), msa.displacements());
  group_by_leg(msa.mechanism(), out.mesh, out.fields);
  add_loads(msa.mechanism(), load_N_Nmm, out.fields);
  out.scale = scale ? *scale : automatic_scale(out.mesh, out.fields.points.front().values);
  out.deflected = deflected(out.mesh, out.fields, out.scale);
  return out;
}

StructureFormat structure_format(const std::string& name, const std::string& what) {
  for (std::size_t i = 0; i < std::size(structure_format_names); ++i)
    if (structure_format_names[i] == name) return static_cast<StructureFormat>(i);
  throw InputError(fmt::format("{} '{}': write msh (Gmsh) or vtk (ParaView)", what, name));
}

std::filesystem::path deflected_path(const std::filesystem::path& path, StructureFormat format) {
  return path.parent_path() / (path.stem().string() + "-deflected" + nth(structure_suffixes, format));
}

void write_structure(const LoadedStructure& s, StructureFormat format, const std::filesystem::path& path) {
  if (format == StructureFormat::msh) {
    gmsh::write_msh(path, s.mesh, s.fields);
    write_text(path.string() + ".opt", gmsh_options(s.fields, s.scale));
    gmsh::write_msh(deflected_path(path, format), s.deflected, s.fields);
  } else {
    write_vtu(path, s.mesh, s.fields);
    write_vtu(deflected_path(path, format), s.deflected, s.fields);
  }
}

}  // namespace deflect::studies
