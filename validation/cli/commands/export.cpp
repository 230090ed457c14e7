#include <fmt/format.h>

#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/talk.h"
#include "validation/studies/loaded_structure.h"

namespace deflect::cli {
namespace {

struct ExportArguments {
  std::string device, to, pose, joints, load, scale = "auto", file, out, element_size = "5 mm";
};

using studies::StructureFormat;

std::optional<double> scale_of(const ExportArguments& a) {
  if (a.scale == "auto") return std::nullopt;
  const double scale = parse_list("--scale", a.scale, {1}, "auto or a factor").front();
  if (!(scale > 0)) throw InputError(fmt::format("--scale {}: give a factor greater than zero", a.scale));
  return scale;
}

std::filesystem::path path_of(const Mechanism& m, StructureFormat format, const ExportArguments& a) {
  const char* suffix = nth(studies::structure_suffixes, format);
  if (a.file.empty() == a.out.empty()) throw InputError("give either -o FILE or --out DIR");
  if (a.file.empty()) return std::filesystem::path(a.out) / (safe_file_name(m.name) + suffix);
  if (std::filesystem::path(a.file).extension() != suffix)
    throw InputError(fmt::format("-o {}: --to {} writes a file that ends in {}", a.file, a.to, suffix));
  return a.file;
}

void run(const ExportArguments& a) {
  const StructureFormat format = studies::structure_format(a.to, "--to");
  const Mechanism m = read_device(a.device);
  const std::filesystem::path path = path_of(m, format, a);
  const Stand at = parse_stand(m, a.pose, a.joints, true);
  const Vector6 load = parse_load(a.load);
  const std::optional<double> scale = scale_of(a);
  const studies::LoadedStructure s = timed("MSA: sparse Cholesky", [&] {
    return studies::loaded_structure(m.name, at.configuration, divide(m, a.element_size), load, scale);
  });
  say_new_folder(path);
  studies::write_structure(s, format, path);
  fmt::print("{} at ({:.6g}) mm, deg under ({:g}) N, Nmm, by MSA\n", m.name, fmt::join(at.pose_mm_deg, ", "),
             fmt::join(load, ", "));
  fmt::print("tool point moves by ({:.6g}) mm, ({:.6g}) rad\n", fmt::join(s.tool_mm_rad.head<3>(), ", "),
             fmt::join(s.tool_mm_rad.tail<3>(), ", "));
  fmt::print("{}: unloaded shape, with displacements and forces\n{}: deflected shape, enlarged {:g} times\n",
             path.string(), studies::deflected_path(path, format).string(), s.scale);
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
