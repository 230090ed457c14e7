// The page without its data, bundled by the build from validation/page; the data take the place of @DEFLECT_DATA@.
#pragma once

#include <string_view>

namespace deflect::page {

/// Empty where the build found no bundler or no libraries.
std::string_view page_template();

}  // namespace deflect::page
