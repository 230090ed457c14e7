#include "validation/cli/devices.h"

#include <fmt/format.h>

#include <algorithm>

#include "meshes/structure.h"
#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/units.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/six_psu.h"
#include "validation/cli/command.h"
#include "validation/compare/theories.h"

namespace deflect::cli {
namespace fs = std::filesystem;

fs::path data_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / DEFLECT_INSTALL_DATA;
  if (!error && fs::is_directory(installed / "devices", error)) return installed;
  return program.parent_path() / DEFLECT_INSTALL_DATA;  // the build tree
}

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(data_folder() / "devices", error))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

fs::path device_file(const std::string& name) {
  const std::vector<std::string> names = device_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return data_folder() / "devices" / (name + ".yaml");
  if (name.find('/') != name.npos || name.ends_with(".yaml") || fs::exists(name)) return name;
  const std::string hint = nearest(name, names);
  throw InputError(fmt::format("there is no device '{}'{}: name a built-in one ({}) or a file", name,
                               hint.empty() ? "" : fmt::format(", did you mean '{}'?", hint), fmt::join(names, ", ")));
}

std::vector<double> parse_list(const std::string& option, const std::string& text,
                               const std::vector<std::size_t>& counts, const std::string& wanted) {
  std::vector<double> values;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    try {
      values.push_back(parse_number(std::string_view(text).substr(from, to - from)));
    } catch (const InputError& e) {
      throw InputError(
          fmt::format("{} '{}': number {}: {}; write {}", option, text, values.size() + 1, e.what(), wanted));
    }
    from = to + 1;
  }
  if (std::find(counts.begin(), counts.end(), values.size()) == counts.end())
    throw InputError(fmt::format("{} '{}': {} number{}; write {}", option, text, values.size(),
                                 values.size() == 1 ? "" : "s", wanted));
  return values;
}

Vector6 parse_six(const std::string& option, const std::string& text, const std::vector<std::size_t>& counts,
                  const std::string& wanted) {
  Vector6 v = Vector6::Zero();
  Eigen::Index i = 0;
  for (const double value : parse_list(option, text, counts, wanted)) v(i++) = value;
  return v;
}

Vector6 parse_pose(const Mechanism& m, const std::string& pose, const std::string& joints, bool or_home) {
  if (or_home && pose.empty() && joints.empty()) return mm_deg_from(home_pose(m));
  if (pose.empty() == joints.empty())
    throw InputError("give either --pose x,y,z,roll,pitch,yaw (mm, deg) or --joints q1,…,q6 (mm)");
  if (!pose.empty()) return parse_six("--pose", pose, {3, 6}, "x,y,z in mm, or x,y,z,roll,pitch,yaw in mm and deg");
  const Vector6 q = parse_six("--joints", joints, {6}, "the six sliders in mm") / 1e3;
  const SixPsu& k = std::get<SixPsu>(m.kinematics);
  std::array<double, 6> sliders{};
  std::copy(q.begin(), q.end(), sliders.begin());
  const ForwardKinematics found = forward_kinematics(k, sliders, centred_pose(k, q.mean()));
  if (!found.converged)
    throw ModelError(
        fmt::format("--joints {}: the sliders fit no assembly of the device near the untilted one "
                    "(closure error {:.3g} mm after {} steps)",
                    joints, 1e3 * found.closure_error, found.iterations));
  return mm_deg_from(found.pose);
}

Vector6 parse_load(const std::string& load) {
  if (load.empty()) return Vector6::Zero();
  return parse_six("--load", load, {3, 6}, "fx,fy,fz in N, or fx,fy,fz,mx,my,mz in N and Nmm");
}

double parse_length(const std::string& option, const std::string& text) {
  double length = 0;
  try {
    length = parse_quantity(text, Dimension::length);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", option, e.what()));
  }
  if (!(length > 0)) throw InputError(fmt::format("{}: '{}' must be greater than zero", option, text));
  return length;
}

frame::MemberDivision divide(const Mechanism& m, const std::string& element_size) {
  return divide_members(configure(m, home_pose(m)), parse_length("--element-size", element_size));
}

Command devices_command() {
  auto name = std::make_shared<std::string>();
  return {"devices",
          "List the built-in devices, or print one as a file to start one's own from",
          "deflect devices haptic-6psu > my-device.yaml",
          {{"name", "NAME", "device to print; without it all are listed", name.get(), false}},
          [name] {
            if (!name->empty()) {
              fmt::print("{}", read_text(device_file(*name)));
              return;
            }
            for (const std::string& each : device_names())
              fmt::print("{:<26} {}\n", each, read_mechanism(device_file(each)).about);
          }};
}

}  // namespace deflect::cli
