// How often memory was asked for in this program so far, by anyone.
#pragma once

#include <cstddef>

namespace deflect::test {

std::size_t allocation_count();

}  // namespace deflect::test
