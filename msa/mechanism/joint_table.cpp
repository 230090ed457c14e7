#include "msa/mechanism/joint_table.h"

namespace deflect {

const JointType* find_joint_type(std::string_view name) {
  for (const JointType& t : joint_table)
    if (name == t.name) return &t;
  return nullptr;
}

std::vector<std::string> joint_type_names() {
  std::vector<std::string> names;
  for (const JointType& t : joint_table) names.emplace_back(t.name);
  return names;
}

std::array<Freedom, 6> freedoms_of(std::string_view letters) {
  std::array<Freedom, 6> f{};
  for (std::size_t i = 0; i < 6; ++i)
    f[i] = letters[i] == 'f' ? Freedom::free : letters[i] == 'a' ? Freedom::actuated : Freedom::rigid;
  return f;
}

}  // namespace deflect
