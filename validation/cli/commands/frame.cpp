#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "meshes/frame_lines.h"
#include "meshes/gmsh.h"
#include "meshes/vtu.h"
#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/frame_schema.h"
#include "msa/mechanism/questions.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/motions.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/report/frame_results.h"
#include "validation/report/schema_results.h"
#include "validation/scene/frame_scene.h"

namespace deflect::cli {
namespace fs = std::filesystem;
namespace {

struct FrameArguments {
  std::string file, element_size, solver = "auto", json, out, report;
  bool schema = false;
};

frame::FrameDivision divide_members(const frame::FrameDescription& f, const std::string& element_size) {
  if (element_size.empty()) return {};
  const double size = parse_length("--element-size", element_size);
  const frame::NameIndex nodes(f.nodes);
  const auto position = [&](const std::string& node) { return nth(f.nodes, nodes.find(node)).second; };
  std::vector<double> lengths;
  for (const auto& [name, member] : f.members) lengths.push_back((position(member.to) - position(member.from)).norm());
  return gmsh::subdivide(lengths, size);
}

frame::Equations solver_of(const std::string& name, const frame::FrameDescription& f) {
  const std::vector<std::string> names(std::begin(frame::equations_names), std::end(frame::equations_names));
  const auto at = std::find(names.begin(), names.end(), name) - names.begin();
  if (at == std::ssize(names))
    throw InputError(fmt::format("--solver: '{}' is none of {}", name, fmt::join(names, ", ")));
  const auto solver = static_cast<frame::Equations>(at);
  if (solver == frame::Equations::iterative && f.geometry != Geometry::linear)
    throw InputError("--solver iterative needs 'geometry: linear'");
  return solver;
}

void write_results(const fs::path& folder, const frame::FrameDescription& f, const frame::FrameResult& r) {
  const report::FrameTables tables = report::frame_tables(f, r);
  write_table(folder / "displacements.csv", tables.displacements);
  write_table(folder / "reactions.csv", tables.reactions);
  write_table(folder / "members.csv", tables.members);
  write_table(folder / "shares.csv", tables.shares);
  const LineMesh mesh = lines_of(r.structure);
  for (const frame::CaseResult& c : r.cases) {
    const FieldData fields = fields_of(r.structure, c);
    gmsh::write_msh(folder / (safe_file_name(c.name) + ".msh"), mesh, fields);
    write_vtu(folder / (safe_file_name(c.name) + ".vtu"), mesh, fields);
  }
}

void print_schema(const std::string& json) {
  const report::NamedSchema named{"frame files", frame::frame_schema()};
  if (!json.empty()) write_file(json, report::schema_json({named}, "deflect frame file"));
  fmt::print("{}", report::schema_table(named));
}

void run(const FrameArguments& a) {
  require_pages(a.report);
  if (a.schema) return print_schema(a.json);
  if (a.file.empty()) throw InputError("name a frame file or a built-in frame, or give --schema");
  const frame::FrameDescription f = timed("frame: reading", [&] { return frame::read_frame(frame_file(a.file)); });
  tell("frame {}: {}, {} nodes, {} members", f.name, frame_file(a.file).string(), f.nodes.size(), f.members.size());
  for (const auto& [name, material] : f.materials)
    if (const auto question = question_about(name, material.elastic))
      remark(fmt::format("{}: {}", frame_file(a.file).string(), *question));
  frame::FrameOptions options;
  options.division = divide_members(f, a.element_size);
  options.equations.solver = solver_of(a.solver, f);
  const frame::FrameResult r = timed_with_progress("frame: every load case", [&](const auto& told) {
    options.equations.progress = told;
    return frame::analyse(f, options);
  });
  if (const std::string failure = frame::failed_check(r); !failure.empty())
    throw NumericalError(fmt::format("{}: {}", f.name, failure));
  if (!a.out.empty()) write_results(a.out, f, r);
  if (!a.json.empty()) write_result(a.json, report::frame_json(f, r));
  fmt::print("{}", report::frame_report(f, r));
  if (!a.out.empty()) fmt::print("Tables and deflected shapes: {}/*.csv, *.msh, *.vtu\n", a.out);
  if (!a.report.empty())
    write_report_of_file(a.report, frame_file(a.file), {"frame", report::frame_json(f, r)},
                         timed("frame: its picture", [&] { return scene::frame_scene_json(f, r); }));
}

}  // namespace

Command frame_command() {
  auto a = std::make_shared<FrameArguments>();
  return {"frame",
          "Solve a frame of nodes and members under its load cases: displacements, reactions, member forces, shares of "
          "the strain energy, checks. The file sets the shape in which forces balance: undeformed ('geometry: "
          "linear'), or deformed ('second-order': P-delta, stress stiffening, buckling; 'finite': rotations of any "
          "size, 'load_steps: n'). 'elements: n' divides a member",
          "deflect frame logan-5-30 --json result.json --out result",
          {{"file", "FRAME", "frame file or built-in frame (in share/deflect/cases or frames)", &a->file},
           {"--element-size", "LENGTH",
            "size of elements, with unit (default: from the file, or one per member, exact at its nodes if linear)",
            &a->element_size},
           {"--solver", "auto|direct|iterative",
            "auto (default: by size and conditioning), direct (factorisation) or iterative (conjugate gradients; falls "
            "back to direct if it cannot verify its answer)",
            &a->solver},
           {"--schema", "", "list the keys of frame files: type, unit, default, meaning", &a->schema},
           {"--json", "FILE", "write the result; with --schema the keys as JSON Schema", &a->json},
           report_option(&a->report),
           {"--out", "DIR", "write displacements, reactions, members, shares (.csv) and each case as .msh and .vtu",
            &a->out}},
          [a] { drawing_motions(a->out, [a] { run(*a); }); }};
}

}  // namespace deflect::cli
