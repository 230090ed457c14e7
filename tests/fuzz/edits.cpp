// Edits of a device or a frame: the input is lines, by turns a path and a value. The first byte of a path chooses the
// action. What an edit has left reads back.
#include <sstream>
#include <vector>

#include "msa/base/files.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "tests/fuzz/reader.h"

namespace {

using namespace deflect;

std::string source(const char* file) { return read_text(std::string(DEFLECT_SOURCE_DIR) + "/validation/" + file); }

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Mechanism machines[] = {parse_mechanism(source("devices/haptic-6psu.yaml"), "6-psu"),
                                       parse_mechanism(source("devices/delta.yaml"), "delta")};
  static const frame::FrameDescription portal = frame::parse_frame(source("frames/portal-semi-rigid.yaml"), "portal");
  if (size == 0) return 0;
  const std::vector<Edit> edits = edits_of(std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  const std::size_t which = data[0] % 3;
  try {
    if (which < 2) {
      const std::string once = write_mechanism(edited_in_turn(machines[which], edits));
      fuzz::require_same(once, write_mechanism(parse_mechanism(once, "edited")));
    } else {
      const std::string once = frame::write_frame(frame::edited(portal, edits));
      fuzz::require_same(once, frame::write_frame(frame::parse_frame(once, "edited")));
    }
  } catch (const InputError& e) {
    if (std::string(e.what()).starts_with("edited:")) std::abort();  // written, and refused
  } catch (const ModelError&) {
  }
  return 0;
}
