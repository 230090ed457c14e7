#include "tests/support/paths.h"

namespace deflect::test {

std::string source_dir() { return DEFLECT_SOURCE_DIR; }
std::string program() { return DEFLECT_PROGRAM; }

}  // namespace deflect::test
