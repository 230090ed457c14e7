// Measurement files: validation/measurement/measurements.h. Numbers in other units may change by one unit of their last
// place when they are written; the second time they stay.
#include "tests/fuzz/reader.h"
#include "validation/measurement/measurements.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deflect;
  const bool frame = size > 0 && data[0] % 2 == 0;
  const measurement::Instruments known =
      frame ? measurement::Instruments{{{"tip", measurement::Quantity::length, {}}}, {"node.B"}, {"snow"}, true}
            : measurement::Instruments{{{"probe", measurement::Quantity::length, 1e-6}}, {"handle"}, {}, false};
  const auto write_read = [&](const std::string& text) {
    return measurement::measurements_text(measurement::parse_measurements(text, "file", known));
  };
  try {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const std::string once = write_read(text);
    try {
      write_read(write_read(once));
    } catch (const InputError& e) {
      std::fprintf(stderr, "written, and refused: %s\n%s\n", e.what(), once.c_str());
      std::abort();
    }
  } catch (const InputError&) {
  }
  return 0;
}
