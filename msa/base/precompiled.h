// What nearly every file includes, read by the compiler once for all rooms (CMake's precompiled header). Files include
// what they use all the same: they compile without it, with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "msa/base/spatial.h"
