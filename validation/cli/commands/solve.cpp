#include <fmt/format.h>

#include <algorithm>

#include "meshes/gmsh.h"
#include "meshes/vtu.h"
#include "msa/base/error.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/motions.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/report/solve_results.h"
#include "validation/studies/solve.h"

namespace deflect::cli {
namespace {

struct SolveArguments {
  std::string device, pose, joints, load, json, out, report, element_size, theories, geometry = "linear";
};

void write_structure(const std::filesystem::path& folder, const studies::SolveResult& r) {
  gmsh::write_msh(folder / "deflected.msh", r.mesh, r.fields);
  write_vtu(folder / "deflected.vtu", r.mesh, r.fields);
}

/// Whether the description says more of how loads and displacements are recorded than that they are.
bool has_rig(const Mechanism& m) {
  return m.load_cell.gain != 1 || !m.load_cell.rotation.isZero(0) || !m.load_cell.point.isZero(0) ||
         !m.sensor.rotation.isZero(0) || !m.sensor.point.isZero(0);
}

void run(const SolveArguments& a) {
  require_pages(a.report);
  const Mechanism m = read_device(a.device);
  const Vector6 load = parse_load(a.load);
  const theories::Theories theories = parse_theories(a.theories);
  if (!a.out.empty() &&
      std::none_of(theories.begin(), theories.end(), [](const theories::Theory* t) { return t->divides; }))
    throw InputError(
        fmt::format("--out {}: the closed form has no structure to draw: put msa among --theories", a.out));
  const Geometry geometry = parse_geometry(a.geometry);
  const Stand at = parse_stand(m, a.pose, a.joints, false);
  const studies::SolveResult r = timed(fmt::format("{}, geometry {}", theories::titles_of(theories), a.geometry), [&] {
    return studies::solve(m, at, load, divide(m, a.element_size), geometry, theories);
  });
  // One element a member is exact at its ends; a drawing wants more. The result is that of the first.
  if (!a.out.empty() && a.element_size.empty())
    write_structure(a.out,
                    studies::solve(m, at, load, frame::equal_division(at.configuration, 20), geometry, theories));
  else if (!a.out.empty())
    write_structure(a.out, r);
  if (!a.json.empty()) write_result(a.json, report::solve_json(r));
  fmt::print("{}\n{}", m.name, report::solve_report(r));
  if (load.isZero(0) && r.reference().stiffness_mm.isZero(1e-9))
    fmt::print("Without load the contacts have no stiffness; give --load to get the stiffness under that load.\n");
  if (has_rig(m))
    fmt::print(
        "Load and displacement are the true ones of T. The rig of the description, through which they are recorded, is "
        "not part of this; predict counts it.\n");
  if (!a.out.empty()) fmt::print("Deflected structure: {0}/deflected.msh, {0}/deflected.vtu\n", a.out);
  if (!a.report.empty())
    write_report_of_stands(a.report, a.device, m, {{"", at.pose_mm_deg, at.configuration}}, {load},
                           {"solve", report::solve_json(r)}, geometry);
}

}  // namespace

Command solve_command() {
  auto a = std::make_shared<SolveArguments>();
  return {"solve",
          "Solve one pose under one load: displacement and 6x6 stiffness of the tool point by both theories, each "
          "part's share of the compliance, the checks. If a play is unloaded, the report says how far the device can "
          "move in it; the displacement is then the middle of the play",
          "deflect solve haptic-6psu --pose 25,25,198.9,0,0,0 --load 50,0,0,0,0,0 --json result.json --out result",
          {{"device", "DEVICE", "built-in device or device file", &a->device, true},
           {"--pose", "x,y,z,roll,pitch,yaw", "pose of the tool frame in the base frame, mm and deg", &a->pose},
           {"--joints", "q1,...,qn", "joint coordinates instead of --pose: slides in mm, turns in rad, or with unit",
            &a->joints},
           {"--load", "fx,fy,fz,mx,my,mz", "wrench on the tool point in base axes, N and Nmm (default 0)", &a->load},
           theories_option(&a->theories),
           {"--geometry", "linear|second-order|finite",
            "shape in which forces balance: undeformed (linear, default) or deformed (second-order; finite: rotations "
            "of any size). In the deformed shape K is the tangent, and loads past buckling are refused",
            &a->geometry},
           {"--element-size", "LENGTH",
            "size of the MSA's elements, with unit (default: one per member, exact at its ends; at least eight in the "
            "deformed shape; --out draws twenty)",
            &a->element_size},
           {"--json", "FILE", "write the result", &a->json},
           report_option(&a->report),
           {"--out", "DIR", "write the deflected structure as .msh (Gmsh) and .vtu (ParaView)", &a->out}},
          [a] { drawing_motions(a->out, [a] { run(*a); }); }};
}

}  // namespace deflect::cli
