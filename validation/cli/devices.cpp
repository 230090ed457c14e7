#include "validation/cli/devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "meshes/structure.h"
#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "msa/fields/file_kind.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/device_schema.h"
#include "msa/mechanism/questions.h"
#include "validation/cli/command.h"
#include "validation/cli/made_by.h"
#include "validation/cli/talk.h"
#include "validation/measurement/joined.h"
#include "validation/measurement/number_limits.h"
#include "validation/report/schema_results.h"

namespace deflect::cli {
namespace fs = std::filesystem;

fs::path data_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / DEFLECT_INSTALL_DATA;
  if (!error && fs::is_directory(installed / "devices", error)) return installed;
  return program.parent_path() / DEFLECT_INSTALL_DATA;  // the build tree
}

namespace {

/// Folders of the program's data by kind of description.
const std::vector<std::string> device_folders = {"devices"}, frame_folders = {"cases", "frames"};

std::vector<std::string> names_in(const std::vector<std::string>& folders) {
  std::vector<std::string> names;
  std::error_code error;
  for (const std::string& folder : folders)
    for (const fs::directory_entry& entry : fs::directory_iterator(data_folder() / folder, error))
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool is_among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What built-in descriptions of one kind are called, where they are, and what a name of the other kind is.
struct BuiltIn {
  const char* what;
  const std::vector<std::string>& folders;
  std::string other;
};

fs::path built_in(const std::string& name, const BuiltIn& kind, const std::vector<std::string>& others) {
  const std::vector<std::string> names = names_in(kind.folders);
  for (const std::string& folder : kind.folders)
    if (const fs::path file = data_folder() / folder / (name + ".yaml"); is_among(name, names) && fs::exists(file))
      return file;
  if (name.find('/') != name.npos || name.ends_with(".yaml") || fs::exists(name)) return name;
  if (is_among(name, others)) throw InputError(fmt::format("'{}' is {}", name, kind.other));
  std::string hint = nearest(name, names);
  if (hint.empty()) hint = nearest(name, others);
  throw InputError(fmt::format("there is no {} '{}'{}: name a built-in one ({}) or a file", kind.what, name,
                               hint.empty() ? "" : fmt::format(", did you mean '{}'?", hint), fmt::join(names, ", ")));
}

}  // namespace

std::vector<std::string> device_names() { return names_in(device_folders); }
std::vector<std::string> frame_names() { return names_in(frame_folders); }

fs::path device_file(const std::string& name) {
  const std::string other = fmt::format("a frame, not a device: 'deflect frame {}' solves it", name);
  return built_in(name, {"device", device_folders, other}, frame_names());
}

fs::path frame_file(const std::string& name) {
  const std::string other =
      fmt::format("a device, not a frame: 'deflect solve {}' and the other device commands read it", name);
  return built_in(name, {"frame", frame_folders, other}, device_names());
}

Mechanism read_device(const std::string& name) {
  const fs::path file = device_file(name);
  Mechanism m = read_mechanism(file);
  tell("device {}: {}, geometry {}", m.name, file.string(), nth(geometry_names, m.geometry));
  for (const auto& [each, material] : m.materials)
    if (const auto question = question_about(each, material)) remark(fmt::format("{}: {}", file.string(), *question));
  return m;
}

frame::FrameDescription read_frame(const std::string& name) {
  const fs::path file = frame_file(name);
  frame::FrameDescription f = timed("frame: reading", [&] { return frame::read_frame(file); });
  tell("frame {}: {}, {} nodes, {} members, {} sensors", f.name, file.string(), f.nodes.size(), f.members.size(),
       f.sensors.size());
  for (const auto& [each, material] : f.materials)
    if (const auto question = question_about(each, material.elastic))
      remark(fmt::format("{}: {}", file.string(), *question));
  return f;
}

namespace {

bool is_frame(const std::string& name) {
  if (is_among(name, device_names())) return false;
  if (is_among(name, frame_names())) return true;
  if (!fs::exists(name)) return false;
  return kind_of(parse_yaml(read_text(name), name)) == FileKind::frame;
}

}  // namespace

fs::path subject_file(const std::string& name) { return is_frame(name) ? frame_file(name) : device_file(name); }

subject::Subject read_subject(const std::string& name) {
  if (is_frame(name)) return read_frame(name);
  return read_device(name);
}

measurement::Measurements read_data(const std::string& file, const subject::Subject& subject) {
  keep_as_it_is(file);
  measurement::Measurements data = subject.placed(measurement::read_measurements(file, subject.instruments()));
  const auto count = [&](auto has) { return std::count_if(data.readings.begin(), data.readings.end(), has); };
  for (const auto& s : data.instruments.sensors) tell("sensor {} is read", s.name);
  for (const auto& p : data.instruments.load_points) tell("loads at {} are read", p);
  tell(
      "measurements {}: {} readings at {} poses, {} with translations, {} with rotations, {} with their own standard "
      "deviation, {}",
      file, data.readings.size(), data.poses.size(),
      count([](const measurement::Reading& r) { return r.displacement[0] || r.displacement[1] || r.displacement[2]; }),
      count([](const measurement::Reading& r) { return r.displacement[3] || r.displacement[4] || r.displacement[5]; }),
      count([](const measurement::Reading& r) { return r.sigma_u || r.sigma_th; }),
      data.readings.front().sequence ? "in a known order" : "in an unknown order");
  return data;
}

measurement::Measurements read_sessions(const std::vector<std::string>& files, const subject::Subject& subject) {
  std::vector<measurement::Measurements> sessions;
  std::vector<std::pair<std::string, std::string>> texts;
  for (const std::string& file : files) {
    sessions.push_back(read_data(file, subject));
    texts.emplace_back(read_text(file), file);
  }
  measurement::require_different(texts);
  return subject.placed(measurement::joined(sessions));
}

measurement::Measurements read_plan(const std::string& file, const subject::Subject& subject) {
  keep_as_it_is(file);
  return subject.placed(measurement::read_plan(file, subject.instruments()));
}

void tell_size(const measurement::Measurements& data, double numbers_kept) {
  constexpr std::size_t large = 20'000;
  if (data.readings.size() < large) return;
  double numbers = 0;
  for (const measurement::Reading& r : data.readings)
    numbers += static_cast<double>(
        std::count_if(r.displacement.begin(), r.displacement.end(), [](const auto& d) { return d.has_value(); }) +
        std::ssize(r.sensors));
  const std::string text = fmt::format("{} readings at {} poses: about {:.1f} GB of memory", data.readings.size(),
                                       data.poses.size(), 8e-9 * numbers * numbers_kept);
  if (const parallel::ProgressStream stream = progress_stream(); stream.out && !verbose())
    *stream.out << text << std::endl;
  tell("{}", text);
}

int parse_threads(double value, const parallel::Ranks* ranks) {
  int threads = whole("--threads", value, 0, 1024);
  if (ranks && threads == 0) threads = ranks->threads();
  tell("threads: {}", threads > 0 ? std::to_string(threads)
                                  : fmt::format("all {} of the machine", std::thread::hardware_concurrency()));
  return threads;
}

void say_new_folder(const fs::path& file) {
  std::error_code error;
  const fs::path folder = file.parent_path();
  if (!folder.empty() && !fs::exists(folder, error)) remark(fmt::format("creating the folder {}", folder.string()));
}

void write_table(const fs::path& path, const std::string& text) {
  write_text(path, text);
  tell("wrote {}, {} bytes", path.string(), text.size());
}

void write_file(const fs::path& path, const std::string& text) {
  say_new_folder(path);
  write_table(path, text);
}

std::vector<double> parse_list(const std::string& option, const std::string& text,
                               const std::vector<std::size_t>& counts, const std::string& wanted) {
  std::vector<double> values;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const auto number =
        outcome_of<InputError>([&] { return parse_number(std::string_view(text).substr(from, to - from)); });
    if (!number)
      throw InputError(
          fmt::format("{} '{}': number {}: {}; write {}", option, text, values.size() + 1, number.why, wanted));
    values.push_back(*number);
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

namespace {

/// Joint coordinates in SI: a bare number in mm or rad, or with its unit, as in "30 deg".
VectorX parse_joints(const Mechanism& m, const std::string& text) {
  const std::vector<Actuator> actuators = actuators_of(m);
  std::vector<std::string> names, items;
  for (const Actuator& a : actuators) names.push_back(fmt::format("{} ({})", a.name, a.rotation ? "rad" : "mm"));
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    items.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  if (actuators.empty())
    throw InputError(fmt::format("--joints '{}': {} has no actuator: omit --joints", text, m.name));
  if (items.size() != actuators.size())
    throw InputError(fmt::format("--joints '{}': {} coordinate{}; write {}: {}", text, items.size(),
                                 items.size() == 1 ? "" : "s", actuators.size(), fmt::join(names, ", ")));
  VectorX q(std::ssize(items));
  for (std::size_t i = 0; i < items.size(); ++i)
    q(as_index(i)) = told_at<InputError>(
        [&] { return fmt::format("--joints '{}': {}: ", text, names[i]); },
        [&] {
          const bool rotation = actuators[i].rotation, unit = items[i].find_first_of("dmr") != std::string::npos;
          const double value = unit ? parse_quantity(items[i], rotation ? Dimension::angle : Dimension::length)
                                    : parse_number(items[i]) / (rotation ? 1 : 1e3);
          if (rotation) require_digits_of_angle(value, items[i]);
          return value;
        });
  return q;
}

}  // namespace

Geometry parse_geometry(const std::string& text) {
  for (std::size_t i = 0; i < std::size(geometry_names); ++i)
    if (text == geometry_names[i]) return static_cast<Geometry>(i);
  throw InputError(fmt::format("--geometry '{}': write {}", text, fmt::join(geometry_names, ", ")));
}

theories::Theories parse_theories(const std::string& list) {
  return told_at<InputError>([&] { return fmt::format("--theories {}: ", list); },
                             [&] { return theories::theories_named(list); });
}

Option theories_option(std::string* list) {
  std::vector<std::string> names;
  for (const theories::Theory* theory : theories::all_theories()) names.push_back(theory->name);
  return {"--theories", "THEORIES", fmt::format("theories, separated by commas (default {})", fmt::join(names, ",")),
          list};
}

Stand parse_stand(const Mechanism& m, const std::string& pose, const std::string& joints, bool or_home) {
  if (pose.empty() && joints.empty() && (or_home || actuators_of(m).empty()))
    return stand(m, mm_deg_from(home_pose(m)));
  if (pose.empty() == joints.empty())
    throw InputError(
        "give either --pose x,y,z,roll,pitch,yaw (mm, deg) or --joints q1,...,qn (slides in mm, turns in rad)");
  if (!pose.empty()) {
    const Vector6 mm_deg = parse_six("--pose", pose, {3, 6}, "x,y,z in mm, or x,y,z,roll,pitch,yaw in mm and deg");
    for (const double deg : mm_deg.tail<3>())
      told_at<InputError>([&] { return fmt::format("--pose '{}': ", pose); },
                          [&] { require_digits_of_angle(deg * pi / 180, fmt::format("{:g} deg", deg)); });
    return stand(m, mm_deg);
  }
  Configuration c = configure_joints(m, parse_joints(m, joints));
  const Vector6 reached = mm_deg_from(c.pose);
  return {reached, std::move(c)};
}

Vector6 parse_load(const std::string& load) {
  if (load.empty()) return Vector6::Zero();
  const Vector6 F = parse_six("--load", load, {3, 6}, "fx,fy,fz in N, or fx,fy,fz,mx,my,mz in N and Nmm");
  for (Eigen::Index i = 0; i < 6; ++i)
    if (const double most = i < 3 ? largest_force : 1e3 * largest_moment; std::abs(F(i)) > most)
      throw InputError(
          fmt::format("--load '{}': {:g} {} is too large: at most {:g}", load, F(i), i < 3 ? "N" : "Nmm", most));
  return F;
}

double parse_length(const std::string& option, const std::string& text) {
  const double length =
      told_at<InputError>([&] { return option + ": "; }, [&] { return parse_quantity(text, Dimension::length); });
  if (!(length > 0)) throw InputError(fmt::format("{}: '{}' must be greater than zero", option, text));
  return length;
}

frame::MemberDivision divide(const Mechanism& m, const std::string& element_size) {
  if (element_size.empty()) return {};
  return divide_members(configure(m, home_pose(m)), parse_length("--element-size", element_size));
}

namespace {

struct DevicesArguments {
  std::string name, json;
  bool schema = false;
};

void list_or_print(const DevicesArguments& a) {
  if (a.schema && !a.name.empty()) throw InputError("--schema covers all devices: omit the name");
  if (!a.json.empty() && !a.schema) throw InputError("--json needs --schema");
  if (a.schema) {
    std::vector<report::NamedSchema> all;
    for (const char* family : family_names)
      all.push_back({fmt::format("device files, family {}", family), device_schema(family)});
    if (!a.json.empty()) write_file(a.json, report::schema_json(all, "deflect device file"));
    for (const report::NamedSchema& each : all)
      fmt::print("{}{}", &each == &all.front() ? "" : "\n", report::schema_table(each));
  } else if (!a.name.empty()) {
    fmt::print("{}", read_text(device_file(a.name)));
  } else {
    for (const std::string& each : device_names())
      fmt::print("{:<26} {}\n", each, read_mechanism(device_file(each)).about);
  }
}

}  // namespace

Command devices_command() {
  auto a = std::make_shared<DevicesArguments>();
  return {
      "devices",
      "List the built-in devices, or print one as a file to start your own from ('deflect new' writes one with "
      "comments).\n"
      "A section lies in its member's local y and z. Local x runs along the member, and z = x cross y. In a chain, "
      "local y is the chain's y without its component along x. If x lies within 2.6 deg of the chain's y, local y "
      "comes from the chain's z instead. 'y_axis: [x, y, z]' sets another direction, in the chain's axes at that line. "
      "'from: PART' starts at the end of a member or offset, or at the position of a joint; 'from: {part: PART, at: "
      "start}' or 'at: end' chooses the end.\n"
      "A joint has the freedoms tx ty tz (along its axes) and rx ry rz (about them). In 'joint: custom' six letters "
      "set them: r rigid, f free, a actuated. They move in this order: along x, y and z, then about x, then about y as "
      "turned by rx, then about z as turned by rx and ry. For another order, write several joints in series. "
      "Laws of freedoms that a joint holds act in its axes before it moves, with 'axes: after' in those that have "
      "turned.\n"
      "Laws of a freedom, with their fields; several laws in a list act in series:" +
          report::law_lines(),
      "deflect devices haptic-6psu > my-device.yaml",
      {{"name", "DEVICE", "device to print (default: list all)", &a->name, false},
       {"--schema", "", "list the keys of device files: type, unit, default, meaning", &a->schema},
       {"--json", "FILE", "with --schema: write the keys as JSON Schema, for editors that complete and check",
        &a->json}},
      [a] { list_or_print(*a); }};
}

std::optional<double> parse_sigma(const std::string& option, const std::string& text, const std::string& unit,
                                  double per_SI) {
  if (text.empty()) return {};
  const double value = parse_list(option, text, {1}, "a standard deviation in " + unit)[0];
  if (!(value > 0))
    throw InputError(fmt::format("{} {}: give a standard deviation above zero, in {}", option, text, unit));
  if (!(value / per_SI > measurement::least_sigma))
    throw InputError(fmt::format("{} {}: is too small for a standard deviation, no reading is exact", option, text));
  if (value / per_SI < measurement::finest_sigma)
    remark(fmt::format("{} {}: finer than instruments read (below {:g} {}): is the unit another?", option, text,
                       measurement::finest_sigma * per_SI, unit));
  return value / per_SI;
}

int whole(const std::string& option, double value, double low, double high) {
  if (!(value >= low && value <= high) || value != std::floor(value))
    throw InputError(fmt::format("{} {:g}: give a whole number from {:g} to {:g}", option, value, low, high));
  return static_cast<int>(value);
}

}  // namespace deflect::cli
