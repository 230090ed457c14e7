// The keys of device files as data, for people and for editors: asked from the same field lists as the reader asks
// (fields.h), so that there is nothing to keep in step.
//
// A level is the map that a struct is written as. Which fields it has can depend on a word in it (`law: belt`,
// `joint: custom`) or on which one of several keys is there (`along` or `from`): these are its cases.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "msa/base/index.h"
#include "msa/fields/field_visitor.h"

namespace deflect {

enum class FieldKind {
  quantity,
  integer,
  vector3,
  matrix,
  text,
  texts,
  word,
  any,
  object,
  entries,
  list,
  one_or_list,
  others
};

struct SchemaField {
  std::string key, about;
  FieldKind kind = FieldKind::quantity;
  Dimension dimension = Dimension::none;
  Range range;
  bool required = false;
  std::string otherwise;           ///< as it would stand in the file; "" where there is no default
  std::string what;                ///< of a word: "material", "joint type"
  std::vector<std::string> words;  ///< those allowed; none where they are names that the file gives
  std::size_t size = 0;            ///< rows of a matrix, 0: any
  std::size_t level = no_level;    ///< of what holds fields: index among Schema::levels
  bool plain = false;              ///< entries of one value each, which is the field "" of the level
  bool or_word = false;            ///< an object that can be written as one of the words too

  static constexpr std::size_t no_level = as_size(-1);
};

/// Fields that go with these words, by key: {"law": {"belt"}}. Of several keys of which one is there the name is both,
/// and the word the one that is: {"along|from": {"along"}}. Keys on which nothing depends are left out.
struct SchemaCase {
  std::map<std::string, std::vector<std::string>> choices;
  std::vector<SchemaField> fields;  ///< in the order in which they are asked for
};

struct SchemaLevel {
  std::string path;  ///< where it comes first: "leg.NAME.tx"
  std::vector<SchemaCase> cases;
};

struct Schema {
  std::vector<SchemaLevel> levels;  ///< the first is the file
};

/// What a name of the user's stands as in paths.
inline constexpr const char* schema_name = "NAME";

/// The fields that `describe` asks for. `fixed`: words by key that are taken as they are, others are tried in turn.
Schema schema_of(const std::function<void(FieldVisitor&)>& describe, const std::map<std::string, std::string>& fixed);

}  // namespace deflect
