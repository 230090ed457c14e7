// The schema of files as data, for users and editors. It is made from the same lists of fields as the reader
// (fields.h), so that both always agree.
//
// A level is the map that a struct is written as. Its fields can depend on a word in it (`law: belt`, `joint: custom`)
// or on which of several keys is present (`along` or `from`): these are its cases.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
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
  pairs,
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
  std::optional<Dimension> or_dimension;  ///< that a number has instead, by another field
  std::optional<Dimension> second;        ///< of pairs: that of the second number
  Range range;
  bool required = false;
  std::string otherwise;  ///< the default as written in a file; "" where there is none
  std::string what;       ///< kind of a word: "material", "joint type"
  std::vector<std::string>
      words;  ///< those allowed; empty where they are names defined in the file; of a quantity: instead of a number
  std::size_t size = 0;          ///< rows of a matrix, 0: any
  std::size_t level = no_level;  ///< level of its own fields, if any: index in Schema::levels
  bool plain = false;            ///< its entries are one value each, the field "" of the level
  bool or_word = false;          ///< an object that can also be written as one of the words
  std::string alone;             ///< its maps can also be written as the value of this key of theirs

  static constexpr std::size_t no_level = as_size(-1);
};

/// The fields for certain words, by key: {"law": {"belt"}}. For alternative keys the name contains all of them and the
/// word is the one present: {"along|from": {"along"}}. Keys on which nothing depends are left out.
struct SchemaCase {
  std::map<std::string, std::vector<std::string>> choices;
  std::vector<SchemaField> fields;  ///< in the order of the reader
};

struct SchemaLevel {
  std::string path;  ///< of its first occurrence: "leg.NAME.tx"
  std::vector<SchemaCase> cases;
};

struct Schema {
  std::vector<SchemaLevel> levels;  ///< the first is the file
};

/// Placeholder in paths for a name that the user chooses.
inline constexpr const char* schema_name = "NAME";

/// The schema of the fields that `describe` visits. `fixed`: words by key with a fixed value; for other words all
/// values are tried.
Schema schema_of(const std::function<void(FieldVisitor&)>& describe, const std::map<std::string, std::string>& fixed);

}  // namespace deflect
