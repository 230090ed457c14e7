// Device files: msa/mechanism/device_file.h.
#include "msa/mechanism/device_file.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deflect;
  return fuzz::round_trip(data, size,
                          [](const std::string& text) { return write_mechanism(parse_mechanism(text, "file")); });
}
