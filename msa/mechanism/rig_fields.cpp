// Fields of how a machine is loaded and read: load cell, sensors, points of load.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/field_lists.h"
#include "msa/mechanism/inside.h"
#include "msa/mechanism/rig_fields.h"

namespace deflect {
namespace {

constexpr const char* trusted_kinds[] = {"base", "tool", "load", "load cell", "sensor"};

const std::vector<std::string> bodies = {"platform", "tool"};

std::optional<double> number(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// "[0, 0.6, 0.8]".
std::optional<Vector3> vector(std::string_view text) {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  Vector3 out;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == text.npos) != (i == 2)) return std::nullopt;
    const auto each = number(text.substr(0, comma));
    if (!each) return std::nullopt;
    out(i) = *each;
    if (i < 2) text.remove_prefix(comma + 1);
  }
  return out;
}

/// False where the text is no direction.
bool read_direction(const std::string& text, Vector3& axis, bool& rotation) {
  constexpr std::string_view words[] = {"ux", "uy", "uz", "rx", "ry", "rz"};
  for (std::size_t i = 0; i < 6; ++i)
    if (text == words[i]) {
      axis = Vector3::Unit(as_index(i % 3));
      rotation = i >= 3;
      return true;
    }
  const std::optional<Vector3> along = vector(text);
  if (!along || !(along->norm() > 0)) return false;
  axis = along->normalized();
  rotation = false;
  return true;
}

/// "1", "0.98 ± 0.5 %", "1 +- 0.005".
bool read_gain(InstrumentErrors& s) {
  s.gain = 1, s.gain_sigma = 0;
  if (s.gain_text.empty()) return true;
  std::string_view text = s.gain_text, deviation;
  for (const std::string_view sign : {"±", "+-", "+/-"})
    if (const std::size_t at = text.find(sign); at != text.npos) {
      deviation = text.substr(at + sign.size());
      text = text.substr(0, at);
      break;
    }
  const auto gain = number(text);
  if (!gain || !(*gain > 0)) return false;
  s.gain = *gain;
  if (deviation.empty()) return true;
  const bool percent = deviation.ends_with('%');
  const auto sigma = number(percent ? deviation.substr(0, deviation.size() - 1) : deviation);
  if (!sigma || !(*sigma >= 0)) return false;
  s.gain_sigma = percent ? s.gain * *sigma / 100 : *sigma;
  return s.gain_sigma <= s.gain;
}

void describe_zero(FieldVisitor& v, bool& free_zero) {
  std::string zero = free_zero ? "free" : "unloaded";
  v.word("zero", zero, {"zero of the readings", {"unloaded", "free"}, "unloaded"},
         "where readings count from: the unloaded machine, or somewhere");
  free_zero = zero == "free";
}

}  // namespace

std::optional<Dimension> other_of(Dimension d) {
  switch (d) {
    case Dimension::length:
      return Dimension::angle;
    case Dimension::angle:
      return Dimension::length;
    case Dimension::force:
      return Dimension::moment;
    case Dimension::moment:
      return Dimension::force;
    default:
      return std::nullopt;
  }
}

void describe_direction(FieldVisitor& v, std::string& text, Vector3& axis, bool& rotation) {
  v.any("direction", text, "uz", "in base axes: ux, uy, uz, a vector, or rx, ry, rz for a rotation");
  v.require(read_direction(text, axis, rotation), "direction",
            "must be one of ux, uy, uz, rx, ry, rz, or a vector such as [0, 0.6, 0.8] in base axes");
}

void describe_errors(FieldVisitor& v, InstrumentErrors& e, Dimension d) {
  v.text("gain", e.gain_text, Need::optional, "recorded over true value, as in '1 ± 0.5 %'");
  v.require(read_gain(e), "gain",
            "must be a number above 0, or one with its standard deviation, at most its size, as in '1 ± 0.5 %'");
  Quantity sigma = optional(0, d, not_negative), offset = optional(0, d, {});
  sigma.or_dimension = offset.or_dimension = other_of(d);
  v.quantity("sigma", e.sigma, sigma, "standard deviation of one reading, in a unit of what is read");
  describe_zero(v, e.free_zero);
  v.quantity("offset", e.zero, offset, "reading where the true value is zero");
}

void describe_rig(FieldVisitor& v, LoadCell& cell, Sensor& sensor, std::vector<std::string>& trusted) {
  const auto cell_fields = [&] {
    v.quantity("gain", cell.gain, optional(1, Dimension::ratio, positive), "true load over recorded load");
    v.vector3("rotation", cell.rotation, Dimension::angle, "rotation vector from recorded to true load");
    v.vector3("point", cell.point, Dimension::length,
              "from T, in platform axes: where the loads act that are recorded at T");
  };
  const auto sensor_fields = [&] {
    v.vector3("rotation", sensor.rotation, Dimension::angle, "rotation vector from true to recorded displacement");
    v.vector3("point", sensor.point, Dimension::length,
              "from T, in platform axes: the point whose displacement is recorded as that of T");
    v.vector3("drift", sensor.drift, Dimension::length, "drift of the reading over a sequence");
    describe_zero(v, sensor.free_zero);
  };
  const auto both = [&] {
    v.object("load_cell", Need::optional, false, cell_fields, "how loads are recorded");
    v.object("sensor", Need::optional, false, sensor_fields, "how displacements are recorded");
    v.texts("trusted", trusted, Need::optional, "where nothing is missing: base, tool, load, load cell, sensor");
    const std::vector<std::string> known{std::begin(trusted_kinds), std::end(trusted_kinds)};
    for (const std::string& kind : trusted)
      v.require(std::find(known.begin(), known.end(), kind) != known.end(), "trusted",
                fmt::format("there is no '{}' to trust{}", kind, suggestion(kind, known)));
  };
  v.object("rig", Need::optional, false, both, "how loads and displacements are recorded");
}

void describe(FieldVisitor& v, PointSensor& s, const Mechanism& m) {
  v.text("drive", s.drive, Need::optional, "drive whose force the sensor reads, as in 'leg.2.actuator'");
  std::string force = s.drive.empty() ? "false" : "true";
  v.word("force", force, {"force", {"false", "true"}, "false"}, "with a drive: that its force or moment is read");
  v.require((force == "true") == !s.drive.empty(), "force",
            s.drive.empty() ? "is that of a drive: name it, as in 'drive: leg.2.actuator'"
                            : "must be true: it is what a sensor reads of a drive");
  if (s.drive.empty()) {
    std::string body = s.body == bodies.front() ? "" : s.body;
    v.text("body", body, Need::optional,
           "what the sensor reads: platform (where absent), tool beyond its joint, or a part in a leg: 'leg.2.link'");
    s.body = body.empty() ? bodies.front() : body;
    v.require(s.body.starts_with("leg.") || std::find(bodies.begin(), bodies.end(), s.body) != bodies.end(), "body",
              fmt::format("must be platform, tool, or a part in a leg, as in 'leg.2.link': there is no '{}'{}", s.body,
                          suggestion(s.body, bodies)));
    v.vector3("point", s.point, Dimension::length,
              "the point, from the tool point, in platform axes; in a leg from the part's end, in its axes");
    describe_direction(v, s.direction, s.axis, s.rotation);
    describe_errors(v, s, s.rotation ? Dimension::angle : Dimension::length);
  } else {
    if (s.direction.empty()) {  // read, and not yet complete
      const auto complete = outcome_of<InputError>([&] {
        complete_sensor(m, s);
        return true;
      });
      v.require(complete.value.has_value(), "drive", complete.why);
    }
    describe_errors(v, s, s.rotation ? Dimension::moment : Dimension::force);
  }
}

void describe(FieldVisitor& v, LoadPoint& p) {
  v.word("body", p.body, {"body", bodies, bodies.front()}, "what the load acts on: platform, or tool beyond its joint");
  v.vector3("point", p.point, Dimension::length, "the point, from the tool point, in platform axes");
}

}  // namespace deflect
