#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "meshes/gmsh.h"
#include "meshes/structure.h"
#include "meshes/vtu.h"
#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/talk.h"
#include "validation/studies/solve.h"
#include "validation/theories/msa_theory.h"

namespace deflect::cli {
namespace {

struct ExportArguments {
  std::string device, to, pose, joints, load, scale = "auto", file, out, element_size = "5 mm";
};

struct Format {
  const char *name, *suffix;
};
constexpr Format formats[] = {{"msh", ".msh"}, {"vtk", ".vtu"}};

const Format& format_of(const std::string& name) {
  for (const Format& f : formats)
    if (f.name == name) return f;
  throw InputError(fmt::format("--to '{}': write msh (Gmsh) or vtk (ParaView)", name));
}

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

double scale_of(const ExportArguments& a, const LineMesh& mesh, const FieldData& fields) {
  if (a.scale == "auto") return automatic_scale(mesh, fields.points.front().values);
  const double scale = parse_list("--scale", a.scale, {1}, "auto or a factor").front();
  if (!(scale > 0)) throw InputError(fmt::format("--scale {}: give a factor greater than zero", a.scale));
  return scale;
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

std::filesystem::path path_of(const Mechanism& m, const Format& format, const ExportArguments& a) {
  if (a.file.empty() == a.out.empty()) throw InputError("give either -o FILE or --out DIR");
  if (a.file.empty()) return std::filesystem::path(a.out) / (safe_file_name(m.name) + format.suffix);
  if (std::filesystem::path(a.file).extension() != format.suffix)
    throw InputError(fmt::format("-o {}: --to {} writes a file that ends in {}", a.file, format.name, format.suffix));
  return a.file;
}

void run(const ExportArguments& a) {
  const Format& format = format_of(a.to);
  const Mechanism m = read_device(a.device);
  const std::filesystem::path path = path_of(m, format, a);
  std::filesystem::path deflected_path = path;
  deflected_path.replace_filename(path.stem().string() + "-deflected" + format.suffix);
  const Stand at = parse_stand(m, a.pose, a.joints, true);
  const Vector6 load = parse_load(a.load);
  theories::MsaAt msa(at.configuration, {m.name, divide(m, a.element_size)});
  const Vector6 d =
      timed("MSA: sparse Cholesky", [&] { return twist_in_mm(msa.answer(wrench_from_mm(load)).displacement); });
  LineMesh mesh = lines_of(msa.mechanism());
  FieldData fields = fields_of(msa.mechanism(), msa.displacements());
  group_by_leg(msa.mechanism(), mesh, fields);
  add_loads(msa.mechanism(), load, fields);
  const double scale = scale_of(a, mesh, fields);
  const LineMesh moved = deflected(mesh, fields, scale);
  say_new_folder(path);
  if (a.to == "msh") {
    gmsh::write_msh(path, mesh, fields);
    write_file(path.string() + ".opt", gmsh_options(fields, scale));
    gmsh::write_msh(deflected_path, moved, fields);
  } else {
    write_vtu(path, mesh, fields);
    write_vtu(deflected_path, moved, fields);
  }
  fmt::print("{} at ({:.6g}) mm, deg under ({:g}) N, Nmm, by MSA\n", m.name, fmt::join(at.pose_mm_deg, ", "),
             fmt::join(load, ", "));
  fmt::print("tool point moves by ({:.6g}) mm, ({:.6g}) rad\n", fmt::join(d.head<3>(), ", "),
             fmt::join(d.tail<3>(), ", "));
  fmt::print("{}: unloaded shape, with displacements and forces\n{}: deflected shape, enlarged {:g} times\n",
             path.string(), deflected_path.string(), scale);
}

}  // namespace

Command export_command() {
  auto a = std::make_shared<ExportArguments>();
  return {
      "export",
      "Write the mechanism at a pose for other programs: nodes and members in mm; displacements, load, reaction and "
      "member forces as fields; groups by leg and part. A second file holds the deflected shape, enlarged.\n"
      "msh: Gmsh "
      "4.1; FILE.msh.opt makes Gmsh draw the deflected shape when it opens FILE.msh. vtk: .vtu for ParaView.",
      "deflect export haptic-6psu --to vtk --pose 25,25,198.9,0,0,0 --load 50,0,0 -o loaded.vtu",
      {{"device", "DEVICE", "built-in device or device file", &a->device, true},
       {"--to", "msh|vtk", "file format", &a->to, true},
       {"--pose", "x,y,z,roll,pitch,yaw", "pose of the tool frame in mm and deg (default: the home pose)", &a->pose},
       {"--joints", "q1,...,qn", "joint coordinates instead of --pose: slides in mm, turns in rad, or with unit",
        &a->joints},
       {"--load", "fx,fy,fz,mx,my,mz", "wrench on the tool point in base axes, N and Nmm (default 0)", &a->load},
       {"--scale", "FACTOR", "factor on displacements in the deflected shape (default auto: makes them visible)",
        &a->scale},
       {"--element-size", "LENGTH", "size of the MSA's elements, with unit (default '5 mm')", &a->element_size},
       {"-o,--output", "FILE", "file to write", &a->file},
       {"--out", "DIR", "folder to write DEVICE.msh or DEVICE.vtu into, instead of -o", &a->out}},
      [a] { run(*a); }};
}

}  // namespace deflect::cli
