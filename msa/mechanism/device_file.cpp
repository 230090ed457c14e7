#include "msa/mechanism/device_file.h"

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/mechanism/field_reader.h"
#include "msa/mechanism/field_writer.h"
#include "msa/mechanism/mechanism_tree.h"

namespace deflect {

Mechanism mechanism_of(const YamlNode& tree, const std::string& origin) {
  if (tree.ours) throw InputError(origin + ": !ours marks single values, not a whole file");
  Mechanism m;
  FieldReader reader(origin);
  reader.read(tree, [&] { describe(reader, m); });
  m.ours = reader.ours();
  varied_legs(m, tree.child("variations"), origin);  // throws where a variation does not fit
  return m;
}

Mechanism parse_mechanism(std::string_view yaml, const std::string& origin) {
  return mechanism_of(parse_yaml(yaml, origin), origin);
}

Mechanism read_mechanism(const std::filesystem::path& path) { return parse_mechanism(read_text(path), path.string()); }

std::string write_mechanism(const Mechanism& m) { return block_yaml(stripped(tree_of(m))); }

}  // namespace deflect
