#include "msa/fields/field_visitor.h"

#include <fmt/format.h>

#include <algorithm>

namespace deflect {

void describe_name(FieldVisitor& v, std::string& name, const char* about) {
  constexpr std::size_t most = 200;  // bytes
  v.text("name", name, Need::required, about);
  const bool one_line = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  v.require(one_line, "name", "has a line break or a tab in it: write one line");
  v.require(name.size() <= most, "name",
            fmt::format("is {} characters long: write at most {}, and the rest as 'about'", name.size(), most));
}

}  // namespace deflect
