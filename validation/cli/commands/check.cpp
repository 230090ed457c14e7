#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/report.h"
#include "validation/cli/talk.h"
#include "validation/json/json_text.h"
#include "validation/report/check_results.h"
#include "validation/studies/solve.h"
#include "validation/theories/theory.h"

namespace deflect::cli {
namespace {

struct CheckArguments {
  std::string matrix, passive, reference, device, pose, joints, load, size, json, out, report;
  std::string unit = "mm", order = "translation-first", key = "analytic.stiffness";
  double tolerance = 0;
};

matrix::MatrixConvention convention_of(const CheckArguments& a) {
  matrix::MatrixConvention c;
  if (a.unit != "mm" && a.unit != "m") throw InputError(fmt::format("--unit '{}': write mm or m", a.unit));
  c.unit_m = a.unit == "m" ? 1 : 1e-3;
  if (a.order != "translation-first" && a.order != "rotation-first")
    throw InputError(fmt::format("--order '{}': write translation-first or rotation-first", a.order));
  c.rotation_first = a.order == "rotation-first";
  return c;
}

/// The load under which 'deflect solve' computed the matrix, as of --load; "" where the file does not say it.
std::string load_of_result(const std::string& file) {
  const std::string text = read_text(file);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos || text[first] != '{') return "";
  const Json result = json::parse_json(text, file, "JSON has no NaN and no infinity");
  const auto load = result.find("load");
  if (result.value("kind", Json()) != "solve" || load == result.end() || !load->is_array() || load->size() != 6)
    return "";
  std::vector<double> components;
  for (const Json& each : *load) {
    if (!each.is_number()) return "";
    components.push_back(each.get<double>());
  }
  return fmt::format("{}", fmt::join(components, ","));
}

/// The closed form's stiffness, which has passed its checks, in N and the unit of length.
matrix::PrintedMatrix stiffness_of(const CheckArguments& a, double unit_m) {
  const Mechanism m = read_device(a.device);
  const Vector6 load = parse_load(a.load);
  const Stand at = parse_stand(m, a.pose, a.joints, false);
  Matrix6 K = theories::theory("analytic").at(at.configuration, {m.name})->answer(wrench_from_mm(load)).stiffness;
  if (load.isZero(0) && stiffness_in_mm(K).isZero(1e-9))
    throw InputError("--device " + a.device + ": without load its contacts have no stiffness; give --load");
  K.topLeftCorner<3, 3>() *= unit_m;
  K.bottomRightCorner<3, 3>() /= unit_m;
  return {K, Matrix6::Zero()};
}

matrix::MatrixCheckOptions options_of(const CheckArguments& a) {
  const matrix::MatrixConvention convention = convention_of(a);
  matrix::MatrixCheckOptions o;
  o.unit_m = convention.unit_m;
  o.K = matrix::read_stiffness(a.matrix, convention, a.key);
  if (!a.passive.empty()) o.passive_twists = matrix::read_twists(a.passive, convention);
  if (!a.reference.empty() && !a.device.empty()) throw InputError("give either --reference or --device");
  if (a.device.empty() && !(a.pose + a.joints + a.load).empty())
    throw InputError("--pose, --joints and --load belong to --device");
  if (!a.reference.empty()) o.reference = matrix::read_stiffness(a.reference, convention, a.key);
  if (!a.device.empty()) o.reference = stiffness_of(a, o.unit_m);
  if (!(a.tolerance >= 0 && a.tolerance < 1))
    throw InputError(fmt::format("--tolerance {}: give a relative difference between 0 and 1", a.tolerance));
  if (a.tolerance > 0) o.tolerance = a.tolerance;
  if (!a.size.empty()) {
    const double size = parse_length("--size", a.size);
    o.plausible = {size / 10, size * 10};
  }
  return o;
}

void run(CheckArguments a) {
  require_pages(a.report);
  if (!a.device.empty() && a.load.empty()) a.load = load_of_result(a.matrix);
  const matrix::MatrixCheck m = timed("checks of " + a.matrix, [&] { return matrix::check_matrix(options_of(a)); });
  const std::string under = a.load.empty() ? "" : " under the load " + a.load;
  const report::CheckedFiles files{a.matrix,
                                   a.device.empty() ? a.reference : a.device + " at " + (a.pose + a.joints) + under};
  const std::string report = report::check_report(m, files);
  if (!a.json.empty()) write_result(a.json, report::check_json(m, files));
  if (!a.out.empty()) {
    const std::filesystem::path folder = a.out;
    write_table(folder / "check.txt", report);
    write_table(folder / "checks.csv", report::checks_csv(m));
    write_table(folder / "structure.csv", report::structure_csv(m));
  }
  fmt::print("{}", report);
  if (!a.report.empty()) write_report_of_file(a.report, a.matrix, {"check", report::check_json(m, files)});
  if (!m.passes()) throw NumericalError(a.matrix + " fails its checks");
}

}  // namespace

Command check_command() {
  auto a = std::make_shared<CheckArguments>();
  return {
      "check",
      "Check your own 6x6 stiffness of a point, from MATLAB, Python, Ansys or elsewhere: K = K^T, K >= 0, no free "
      "direction, a plausible size, free passive joints, agreement with a reference. If a check fails, the report "
      "names the usual mistakes that explain it. Exit code 0 when all checks pass, 4 when one fails, 2 when a file "
      "cannot be read",
      "deflect check K.csv --unit m --device haptic-6psu-ideal-joints --pose 25,25,198.9 --json check.json",
      {{"matrix", "K", "six rows of six numbers: CSV, blanks, MATLAB or NumPy text, or JSON of 'deflect solve'",
        &a->matrix, true},
       {"--unit", "mm|m", "unit of length of the matrices: N/mm, N, Nmm (default) or N/m, N, Nm; angles in rad",
        &a->unit},
       {"--order", "translation-first|rotation-first", "translation-first (default): [f; m] = K [d; theta]", &a->order},
       {"--passive", "J",
        "if K is of one leg: twists of its passive joints at K's point, as rows or columns, to check K J = 0",
        &a->passive},
       {"--reference", "R", "stiffness that K should equal, in the same unit and order", &a->reference},
       {"--device", "DEVICE", "instead of --reference: this device at --pose, by the closed form", &a->device},
       {"--pose", "x,y,z,roll,pitch,yaw", "pose of --device in mm and deg", &a->pose},
       {"--joints", "q1,...,qn", "joint coordinates instead of --pose: slides in mm, turns in rad, or with unit",
        &a->joints},
       {"--load", "fx,fy,fz,mx,my,mz",
        "load on --device, N and Nmm; contacts are stiff only under load (default: that of K, where 'deflect solve' "
        "wrote it)",
        &a->load},
       {"--tolerance", "X", "relative difference to ignore (default: the digits printed)", &a->tolerance},
       {"--size", "LENGTH",
        "size of the device, with unit: K's characteristic length must be a tenth to ten times this (default: 1 mm to "
        "30 m)",
        &a->size},
       {"--key", "NAME", "JSON member that holds the matrix (default analytic.stiffness)", &a->key},
       {"--json", "FILE", "write the result", &a->json},
       report_option(&a->report),
       {"--out", "DIR", "write report and tables: check.txt, checks.csv, structure.csv", &a->out}},
      [a] { run(*a); }};
}

}  // namespace deflect::cli
