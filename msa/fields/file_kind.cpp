#include "msa/fields/file_kind.h"

#include <fmt/format.h>

#include "msa/base/error.h"

namespace deflect {
namespace {

struct KindOfFile {
  FileKind kind;
  const char *words, *key;  // the key that only this kind has
};
constexpr KindOfFile kinds_of_files[] = {{FileKind::device, "a device", "kinematics"},
                                         {FileKind::frame, "a frame", "nodes"},
                                         {FileKind::effect, "an effect", "edits"}};

const KindOfFile* row_of(FileKind kind) {
  for (const KindOfFile& row : kinds_of_files)
    if (row.kind == kind) return &row;
  return nullptr;
}

std::string remedy(FileKind kind, const std::string& file) {
  switch (kind) {
    case FileKind::device:
      return fmt::format("'deflect solve {}' and the other commands for devices take it", file);
    case FileKind::frame:
      return fmt::format("'deflect frame {}' solves it", file);
    default:
      return fmt::format("name it with --effects {}", file);
  }
}

}  // namespace

FileKind kind_of(const YamlNode& tree) {
  FileKind found = FileKind::unknown;
  for (const KindOfFile& row : kinds_of_files) {
    if (!tree.child(row.key)) continue;
    if (found != FileKind::unknown) return FileKind::unknown;
    found = row.kind;
  }
  return found;
}

void require_kind(const YamlNode& tree, FileKind wanted, const std::string& origin) {
  const FileKind kind = kind_of(tree);
  const KindOfFile *is = row_of(kind), *should = row_of(wanted);
  if (!is || !should || is == should) return;
  throw InputError(fmt::format("{}:{}: this file describes {} (it has '{}'), not {}: {}", origin,
                               tree.child(is->key)->key_line, is->words, is->key, should->words, remedy(kind, origin)));
}

}  // namespace deflect
