#include "tests/fuzz/targets.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "validation/diagnosis/found_effects.h"
#include "validation/effects/effect_file.h"
#include "validation/matrix/matrix_file.h"
#include "validation/measurement/measurements.h"
#include "validation/result_files/provenance.h"
#include "validation/result_files/result_file.h"

namespace deflect::fuzz {
namespace {

namespace fs = std::filesystem;

void require_same(const std::string& first, const std::string& second) {
  if (first != second) throw std::logic_error("written:\n" + first + "\nread and written again:\n" + second);
}

/// What the reader makes of the text; false where it refuses it.
template <class F>
bool read(const F& reader) {
  try {
    reader();
    return true;
  } catch (const InputError&) {
  } catch (const ModelError&) {
  }
  return false;
}

/// `read_and_write` of what it has written itself: no refusal is allowed any more.
template <class F>
std::string again(const std::string& once, const F& read_and_write) {
  try {
    return read_and_write(once);
  } catch (const std::exception& e) {
    throw std::logic_error(std::string("written, and refused: ") + e.what() + "\n" + once);
  }
}

template <class F>
void round_trip(const std::string& text, const F& read_and_write) {
  std::string once;
  if (read([&] { once = read_and_write(text); })) require_same(once, again(once, read_and_write));
}

std::string device_again(const std::string& text) { return write_mechanism(parse_mechanism(text, "file")); }
std::string frame_again(const std::string& text) { return frame::write_frame(frame::parse_frame(text, "file")); }

void device(const std::string& text) { round_trip(text, device_again); }
void frame_file(const std::string& text) { round_trip(text, frame_again); }
void effect(const std::string& text) {
  round_trip(text, [](const std::string& t) { return effects::write_effect(effects::parse_effect(t, "file")); });
}

/// Numbers in other units may change by one unit of their last place when they are written.
void measurement_file(const std::string& text) {
  const bool stationary = !text.empty() && static_cast<unsigned char>(text[0]) % 2 == 0;
  const measurement::Instruments known =
      stationary ? measurement::Instruments{{{"tip", measurement::Quantity::length, {}}}, {"node.B"}, {"snow"}, true}
                 : measurement::Instruments{{{"probe", measurement::Quantity::length, 1e-6}}, {"handle"}, {}, false};
  const auto read_and_write = [&](const std::string& t) {
    return measurement::measurements_text(measurement::parse_measurements(t, "file", known));
  };
  std::string once;
  if (read([&] { once = read_and_write(text); })) again(again(once, read_and_write), read_and_write);
}

void matrix_file(const std::string& text) {
  read([&] {
    const matrix::PrintedMatrix K = matrix::parse_matrix(text, "file");
    if (!K.values.allFinite() || !K.rounding.allFinite() || K.rounding.size() != K.values.size())
      throw std::logic_error("a matrix with numbers that are none");
  });
}

void result(const std::string& text) {
  read([&] { result_files::read_result(text, "file"); });
  read([&] { diagnosis::parse_found_effects(text, "file"); });
  read([&] {
    const Json json = json::parse_json(text, "file", "give a result");
    if (!result_files::differences(json, json, 0, 10).empty()) throw std::logic_error("differs from itself");
    result_files::read_provenance(json, "file");
  });
}

std::string source(const char* file) { return read_text(fs::path(DEFLECT_SOURCE_DIR) / "validation" / file); }

std::vector<Edit> edits_of(const std::string& text) {
  std::vector<Edit> out;
  std::istringstream in(text);
  for (std::string path, value; std::getline(in, path) && std::getline(in, value) && out.size() < 4;) {
    if (path.empty()) continue;
    const auto action = static_cast<Edit::Action>(static_cast<unsigned char>(path[0]) % 4);
    out.push_back({path.substr(1), value, action});
  }
  return out;
}

void edits(const std::string& text) {
  static const Mechanism machines[] = {parse_mechanism(source("devices/haptic-6psu.yaml"), "6-psu"),
                                       parse_mechanism(source("devices/delta.yaml"), "delta")};
  static const frame::FrameDescription portal = frame::parse_frame(source("frames/portal-semi-rigid.yaml"), "portal");
  if (text.empty()) return;
  const std::vector<Edit> all = edits_of(text.substr(1));
  const std::size_t which = static_cast<unsigned char>(text[0]) % 3;
  std::string once;
  if (which < 2) {
    if (read([&] { once = write_mechanism(edited_in_turn(machines[which], all)); }))
      require_same(once, again(once, device_again));
  } else if (read([&] { once = frame::write_frame(frame::edited(portal, all)); })) {
    require_same(once, again(once, frame_again));
  }
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"device", device, {"validation/devices", "tests/attack/cases"}},
      {"frame", frame_file, {"validation/cases", "validation/frames"}},
      {"effect", effect, {"validation/effects/catalogue"}},
      {"measurement", measurement_file, {"validation/measurements"}},
      {"matrix", matrix_file, {"tests/fuzz/seeds/matrices"}},
      {"result", result, {"tests/fuzz/seeds/results"}},
      {"edits", edits, {"tests/fuzz/seeds/edits"}},
  };
  return all;
}

std::vector<fs::path> seed_files(const Target& target) {
  const fs::path root = DEFLECT_SOURCE_DIR;
  std::vector<fs::path> folders = target.seeds, out;
  folders.push_back("tests/fuzz/found/" + target.name);
  for (const fs::path& folder : folders) {
    if (!fs::exists(root / folder)) continue;  // nothing was found in this reader
    for (const auto& entry : fs::directory_iterator(root / folder)) {
      // Other files of these folders are read by other readers.
      const bool wanted = target.name != "measurement" || entry.path().extension() == ".csv" ||
                          entry.path().parent_path().filename() == target.name;
      if (entry.is_regular_file() && wanted) out.push_back(entry.path());
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace deflect::fuzz
