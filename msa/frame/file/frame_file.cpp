#include "msa/frame/file/frame_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/outcome.h"
#include "msa/fields/field_reader.h"
#include "msa/fields/field_writer.h"
#include "msa/fields/file_kind.h"
#include "msa/fields/tree_edit.h"
#include "msa/frame/file/frame_fields.h"
#include "msa/frame/file/frame_part.h"
#include "msa/frame/file/frame_tolerances.h"
#include "msa/frame/file/plane_laws.h"
#include "msa/frame/file/short_forms.h"

namespace deflect::frame {

namespace {

/// Each value of a key must be a tolerance of some number.
void check_tolerances(const FrameDescription& f, const YamlNode& tree, const std::string& origin) {
  const YamlNode* given = tree.child("tolerances");
  for (const auto& number : f.tolerances.numbers) {
    const std::string& key = number.first;
    const YamlNode* node = given ? given->child(key) : nullptr;
    const auto place = [&] {
      return fmt::format("{}{}: tolerances.{}: ", origin, node && node->line > 0 ? fmt::format(":{}", node->line) : "",
                         key);
    };
    told_at<InputError>(place, [&] { require_tolerance(f, key, number.second); });
  }
}

DependentFrame frame_of(YamlNode file, const std::string& origin) {
  const YamlNode tree = spelled_out(std::move(file));
  if (tree.ours) throw InputError(origin + ": !ours marks single values, not a whole file");
  FrameDescription f;
  FieldReader reader(origin);
  reader.read(tree, [&] { describe(reader, f); });
  f.ours = reader.ours();
  check_tolerances(f, tree, origin);
  require_laws_in_plane(f, tree, origin);
  return {std::move(f), reader.depends()};
}

YamlNode tree_of(const FrameDescription& f, bool absent_ends) {
  FrameDescription copy = f;
  FieldWriter writer(f.ours);
  describe(writer, copy, absent_ends);
  return writer.tree();
}

DependentFrame edited_whole(const DependentFrame& before, const std::vector<TreeEdit>& edits) {
  // The laws of all ends of a large frame are many: only edits of members need them.
  const bool of_members = std::any_of(edits.begin(), edits.end(), [](const TreeEdit& edit) {
    const std::vector<std::string> at = segments_of(edit.path);
    return at.size() > 2 && at[0] == "members" && (at[2] == "start" || at[2] == "end" || at[2] == "*");
  });
  YamlNode tree = tree_of(before.frame, of_members || !before.depends.empty());
  attach(tree, before.depends);
  for (const TreeEdit& edit : edits) apply(tree, spelled_out(edit), origin_of(edit));
  return frame_of(stripped(tree), origin_of(edits.back()));
}

}  // namespace

YamlNode tree_of(const FrameDescription& f) { return tree_of(f, true); }

FrameDescription parse_frame(std::string_view yaml, const std::string& origin) {
  YamlNode tree = parse_yaml(yaml, origin);
  require_kind(tree, FileKind::frame, origin);
  return frame_of(std::move(tree), origin).frame;
}

FrameDescription read_frame(const std::filesystem::path& path) { return parse_frame(read_text(path), path.string()); }

std::string write_frame(const FrameDescription& f) { return block_yaml(shortened(stripped(tree_of(f, false)))); }

FrameDescription edited(const FrameDescription& f, const std::vector<Edit>& edits) {
  std::vector<TreeEdit> all;
  for (const Edit& edit : edits) all.push_back(parsed(edit));
  return edited_in_turn({f}, all).frame;
}

DependentFrame edited_in_turn(DependentFrame before, const std::vector<TreeEdit>& edits) {
  if (edits.empty()) return before;
  if (const auto entries = edited_entries(before.frame, edits)) {
    auto part = outcome_of<InputError>([&] { return edited_whole(part_of(before, *entries), edits); });
    if (part) return with_part(std::move(before), *entries, std::move(*part));
  }
  return edited_whole(before, edits);  // messages name what the whole frame has
}

void for_each_number(FrameDescription& f, const std::function<void(std::size_t, double&)>& call) {
  NumberCalls walk(call);
  describe(walk, f, false);  // absent ends have no numbers
}

std::vector<DescribedNumber> described_numbers(const FrameDescription& f) {
  FrameDescription copy = f;
  NumberList walk;
  describe(walk, copy, false);
  return std::move(walk.found);
}

}  // namespace deflect::frame
