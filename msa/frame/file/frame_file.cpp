#include "msa/frame/file/frame_file.h"

#include <algorithm>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/fields/field_reader.h"
#include "msa/fields/field_writer.h"
#include "msa/fields/file_kind.h"
#include "msa/fields/tree_edit.h"
#include "msa/frame/file/frame_fields.h"
#include "msa/frame/file/short_forms.h"

namespace deflect::frame {

namespace {

FrameDescription frame_of(YamlNode file, const std::string& origin) {
  const YamlNode tree = spelled_out(std::move(file));
  if (tree.ours) throw InputError(origin + ": !ours marks single values, not a whole file");
  FrameDescription f;
  FieldReader reader(origin);
  reader.read(tree, [&] { describe(reader, f); });
  f.ours = reader.ours();
  return f;
}

YamlNode tree_of(const FrameDescription& f, bool absent_ends) {
  FrameDescription copy = f;
  FieldWriter writer(f.ours);
  describe(writer, copy, absent_ends);
  return writer.tree();
}

}  // namespace

FrameDescription parse_frame(std::string_view yaml, const std::string& origin) {
  YamlNode tree = parse_yaml(yaml, origin);
  require_kind(tree, FileKind::frame, origin);
  return frame_of(std::move(tree), origin);
}

FrameDescription read_frame(const std::filesystem::path& path) { return parse_frame(read_text(path), path.string()); }

std::string write_frame(const FrameDescription& f) { return block_yaml(shortened(stripped(tree_of(f, false)))); }

FrameDescription edited(const FrameDescription& f, const std::vector<Edit>& edits) {
  if (edits.empty()) return f;
  // The laws of all ends of a large frame are many: only edits of members need them.
  const bool of_members = std::any_of(edits.begin(), edits.end(), [](const Edit& edit) {
    const std::vector<std::string> at = segments_of(edit.path);
    return at.size() > 2 && at[0] == "members" && (at[2] == "start" || at[2] == "end" || at[2] == "*");
  });
  YamlNode tree = tree_of(f, of_members);
  for (const Edit& edit : edits) apply(tree, spelled_out(parsed(edit)), origin_of(edit));
  return frame_of(stripped(tree), origin_of(edits.back()));
}

}  // namespace deflect::frame
