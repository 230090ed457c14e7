#include "msa/frame/file/frame_file.h"

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/fields/field_reader.h"
#include "msa/fields/field_writer.h"
#include "msa/fields/file_kind.h"
#include "msa/fields/tree_edit.h"
#include "msa/frame/file/frame_fields.h"

namespace deflect::frame {

namespace {

FrameDescription frame_of(const YamlNode& tree, const std::string& origin) {
  if (tree.ours) throw InputError(origin + ": !ours marks single values, not a whole file");
  FrameDescription f;
  FieldReader reader(origin);
  reader.read(tree, [&] { describe(reader, f); });
  f.ours = reader.ours();
  return f;
}

YamlNode tree_of(const FrameDescription& f) {
  FrameDescription copy = f;
  FieldWriter writer(f.ours);
  describe(writer, copy);
  return writer.tree();
}

}  // namespace

FrameDescription parse_frame(std::string_view yaml, const std::string& origin) {
  const YamlNode tree = parse_yaml(yaml, origin);
  require_kind(tree, FileKind::frame, origin);
  return frame_of(tree, origin);
}

FrameDescription read_frame(const std::filesystem::path& path) { return parse_frame(read_text(path), path.string()); }

std::string write_frame(const FrameDescription& f) { return block_yaml(stripped(tree_of(f))); }

FrameDescription edited(const FrameDescription& f, const std::vector<Edit>& edits) {
  if (edits.empty()) return f;
  YamlNode tree = tree_of(f);
  for (const Edit& edit : edits) apply(tree, parsed(edit), origin_of(edit));
  return frame_of(stripped(tree), origin_of(edits.back()));
}

}  // namespace deflect::frame
