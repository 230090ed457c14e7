#include <fmt/format.h>

#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/fields/file_kind.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/figures.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/figures/drawing_results.h"

namespace deflect::cli {
namespace {

struct ShowArguments {
  std::string file, pose, joints, json, out, report;
  FigureArguments figures;
};

/// A device or a frame: a name that is built in, or what the file says.
bool is_frame(const std::string& name) {
  for (const std::string& each : frame_names())
    if (each == name) return true;
  for (const std::string& each : device_names())
    if (each == name) return false;
  const std::filesystem::path file = device_file(name);
  return kind_of(parse_yaml(read_text(file), file.string())) == FileKind::frame;
}

figures::MachineDrawing drawing(const ShowArguments& a, bool frame) {
  if (frame) {
    if (!a.pose.empty() || !a.joints.empty()) throw InputError("--pose and --joints apply to devices, not to frames");
    return figures::drawing_of(frame::read_frame(frame_file(a.file)));
  }
  const Mechanism m = read_device(a.file);
  if (a.pose.empty() && a.joints.empty()) return figures::drawing_of(m);
  return figures::drawing_of(m, parse_stand(m, a.pose, a.joints, false).configuration);
}

void run(const ShowArguments& a) {
  require_pages(a.report);
  const figures::FigureStyle style = figure_style(a.figures, a.out);
  const bool frame = is_frame(a.file);
  const figures::MachineDrawing d = timed("the machine as drawn", [&] { return drawing(a, frame); });
  const std::filesystem::path folder = a.out;
  if (!a.out.empty()) draw({figures::drawing_figure(d, style)}, folder);
  if (!a.json.empty()) write_result(a.json, figures::drawing_json(d));
  fmt::print("{}", figures::drawing_report(d));
  if (!a.out.empty())
    fmt::print("\nFigure drawing.svg, .pdf, .png in {}\n", std::filesystem::absolute(folder).string());
  if (!a.report.empty())
    write_report_of_file(a.report, frame ? frame_file(a.file) : device_file(a.file),
                         {"show", figures::drawing_json(d)});
}

}  // namespace

Command show_command() {
  auto a = std::make_shared<ShowArguments>();
  return {
      "show",
      "Draw the machine or frame of a file, unloaded and before any solution: members with their sections and lengths, "
      "joints with their axes, actuators. The result is a table, a picture (--out) and a 3D page (--report). If the "
      "structure cannot stand, every motion that nothing resists is drawn too, and moves on the page. If its loops do "
      "not close, each leg is drawn alone",
      "deflect show mine.yaml --report drawing.html",
      with_figures({{"file", "FILE", "device or frame: a file, or a built-in name", &a->file, true},
                    {"--pose", "x,y,z,roll,pitch,yaw", "pose of a device in mm and deg (default: home pose)", &a->pose},
                    {"--joints", "q1,...,qn",
                     "joint coordinates instead of --pose: slides in mm, turns in rad, or "
                     "with unit",
                     &a->joints},
                    {"--json", "FILE", "write the contents of the drawing", &a->json},
                    report_option(&a->report),
                    {"--out", "DIR", "write the picture as SVG, PDF and PNG with its caption", &a->out}},
                   &a->figures),
      [a] { run(*a); }};
}

}  // namespace deflect::cli
