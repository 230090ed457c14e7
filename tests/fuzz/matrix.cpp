// Matrices of other programs: validation/matrix/matrix_file.h.
#include "tests/fuzz/reader.h"
#include "validation/matrix/matrix_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deflect;
  try {
    const matrix::PrintedMatrix K =
        matrix::parse_matrix(std::string(reinterpret_cast<const char*>(data), size), "file");
    if (!K.values.allFinite() || !K.rounding.allFinite() || K.rounding.size() != K.values.size()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
