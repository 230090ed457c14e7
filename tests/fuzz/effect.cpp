// Effect files: validation/effects/effect_file.h.
#include "tests/fuzz/reader.h"
#include "validation/effects/effect_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deflect;
  return fuzz::round_trip(
      data, size, [](const std::string& text) { return effects::write_effect(effects::parse_effect(text, "file")); });
}
