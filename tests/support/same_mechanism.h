// Equality of descriptions in tests: through the written text, which holds every field to the last bit.
#pragma once

#include <ostream>

#include "msa/mechanism/device_file.h"

namespace deflect {

inline bool operator==(const Mechanism& a, const Mechanism& b) { return write_mechanism(a) == write_mechanism(b); }
inline void PrintTo(const Mechanism& m, std::ostream* out) { *out << "\n" << write_mechanism(m); }

}  // namespace deflect
