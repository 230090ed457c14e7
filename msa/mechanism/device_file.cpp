#include "msa/mechanism/device_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/fields/field_reader.h"
#include "msa/fields/field_writer.h"
#include "msa/fields/file_kind.h"
#include "msa/mechanism/chain_kinematics.h"
#include "msa/mechanism/fields.h"
#include "msa/mechanism/inside.h"
#include "msa/mechanism/mechanism_tree.h"
#include "msa/mechanism/tolerances.h"

namespace deflect {
namespace {

/// The controller has a row for each actuated coordinate, which only the whole description knows.
void check_controller(const Mechanism& m, const YamlNode& tree, const std::string& origin) {
  const auto* chains = std::get_if<Chains>(&m.kinematics);
  if (!chains || chains->controller.size() == 0) return;
  const std::vector<std::string> names = actuated_at_home(m).names;
  const auto rows = as_size(chains->controller.rows());
  if (rows == names.size()) return;
  const int line = tree.child("kinematics")->child("controller")->line;
  const std::string place = line > 0 ? fmt::format("{}:{}: ", origin, line) : origin + ": ";
  const std::string have =
      fmt::format("{}kinematics.controller: has {} row{}, and the mechanism ", place, rows, rows == 1 ? "" : "s");
  if (names.empty()) throw InputError(have + "no actuated coordinate: leave the controller out");
  throw InputError(
      fmt::format("{}{} actuated coordinate{} ({}): write as many rows of as many numbers, or leave the controller out "
                  "where users give these coordinates themselves",
                  have, names.size(), names.size() == 1 ? "" : "s", fmt::join(names, ", ")));
}

/// Keys that name numbers can be judged only with the whole description. Not after edits: an effect may take away the
/// number of a tolerance.
void check_tolerances(const Mechanism& m, const YamlNode& tree, const std::string& origin) {
  if (m.tolerances.numbers.empty()) return;
  const Mechanism each_leg = resolved(m);
  for (const auto& number : m.tolerances.numbers) {
    const std::string& key = number.first;
    const int line = tree.child("tolerances")->child(key)->line;
    told_at<InputError>([&] { return fmt::format("{}:{}: tolerances.{}: ", origin, line, key); },
                        [&] {
                          check_tolerance(each_leg, key, number.second);
                          return true;
                        });
  }
}

/// Sensors in legs name parts, which only the whole description knows.
void complete_sensors(Mechanism& m, const YamlNode& tree, const std::string& origin) {
  for (auto& named : m.sensors) {
    const std::string& name = named.first;
    auto& sensor = named.second;
    const YamlNode* at = tree.child("sensors") ? tree.child("sensors")->child(name) : nullptr;
    const int line = at ? at->line : 0;
    told_at<InputError>(
        [&] {
          return fmt::format("{}{}: sensors.{}.{}: ", origin, line > 0 ? fmt::format(":{}", line) : "", name,
                             sensor.drive.empty() ? "body" : "drive");
        },
        [&] {
          complete_sensor(m, sensor);
          return true;
        });
  }
}

}  // namespace

DependentMechanism mechanism_of(const YamlNode& tree, const std::string& origin) {
  if (tree.ours) throw InputError(origin + ": !ours marks single values, not a whole file");
  Mechanism m;
  FieldReader reader(origin);
  reader.read(tree, [&] { describe(reader, m); });
  m.ours = reader.ours();
  varied_legs(m, tree.child("variations"), origin);  // throws where a variation does not fit
  check_controller(m, tree, origin);
  complete_sensors(m, tree, origin);
  return {std::move(m), reader.depends()};
}

Mechanism parse_mechanism(std::string_view yaml, const std::string& origin) {
  const YamlNode tree = parse_yaml(yaml, origin);
  require_kind(tree, FileKind::device, origin);
  Mechanism m = mechanism_of(tree, origin).mechanism;
  check_tolerances(m, tree, origin);
  return m;
}

Mechanism read_mechanism(const std::filesystem::path& path) { return parse_mechanism(read_text(path), path.string()); }

std::string write_mechanism(const Mechanism& m) { return block_yaml(stripped(tree_of(m))); }

}  // namespace deflect
