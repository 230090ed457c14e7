// Frame files: msa/frame/file/frame_file.h.
#include "msa/frame/file/frame_file.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deflect;
  return fuzz::round_trip(data, size,
                          [](const std::string& text) { return frame::write_frame(frame::parse_frame(text, "file")); });
}
