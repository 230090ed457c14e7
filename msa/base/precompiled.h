// Headers that nearly every file includes, compiled once for all libraries (CMake's precompiled header). Files still
// include what they use: they compile without it, with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON.
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
