#include "msa/frame/file/frame_file.h"

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/fields/field_reader.h"
#include "msa/fields/field_writer.h"
#include "msa/fields/file_kind.h"
#include "msa/frame/file/frame_fields.h"

namespace deflect::frame {

FrameDescription parse_frame(std::string_view yaml, const std::string& origin) {
  const YamlNode tree = parse_yaml(yaml, origin);
  require_kind(tree, FileKind::frame, origin);
  if (tree.ours) throw InputError(origin + ": !ours marks single values, not a whole file");
  FrameDescription f;
  FieldReader reader(origin);
  reader.read(tree, [&] { describe(reader, f); });
  f.ours = reader.ours();
  return f;
}

FrameDescription read_frame(const std::filesystem::path& path) { return parse_frame(read_text(path), path.string()); }

std::string write_frame(const FrameDescription& f) {
  FrameDescription copy = f;
  FieldWriter writer(f.ours);
  describe(writer, copy);
  return block_yaml(stripped(writer.tree()));
}

}  // namespace deflect::frame
