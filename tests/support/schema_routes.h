// Every map of a kind of file, as a document with one key in it that nobody knows: the reader's refusal lists the keys
// that it does know there, which are to be those of the schema.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "msa/base/error.h"
#include "msa/base/units.h"
#include "msa/fields/schema.h"

namespace deflect::test {

class SchemaRoutes {
 public:
  /// `prefix`: what stands at the top of every document, by key. `read` throws the reader's refusal. `examples`: values
  /// by key, where an empty map or list would be refused for another reason.
  SchemaRoutes(Schema schema, std::map<std::string, std::string> prefix, std::function<void(const std::string&)> read,
               std::map<std::string, std::string> examples = {})
      : schema_(std::move(schema)),
        prefix_(std::move(prefix)),
        read_(std::move(read)),
        examples_(std::move(examples)) {}

  /// Of how many maps the keys were compared.
  int compared() {
    follow(0, [](const std::string& inner) { return "{" + inner + "}"; });
    return compared_;
  }

 private:
  using Around = std::function<std::string(const std::string& inner)>;

  std::string example(const SchemaField& f) const {
    if (const auto given = examples_.find(f.key); given != examples_.end()) return given->second;
    const std::vector<std::string> units = units_of(f.dimension);
    const std::string number = units.empty() || f.dimension == Dimension::ratio ? "0.5" : "1 " + units.front();
    switch (f.kind) {
      case FieldKind::quantity:
        return number;
      case FieldKind::vector3:
        return "[" + number + ", " + number + ", " + number + "]";
      case FieldKind::word:
        return f.words.empty() ? schema_name : f.words.front();
      case FieldKind::object:
        return f.or_word ? schema_name : "{}";
      case FieldKind::list:
        return "[]";
      default:
        return "1";
    }
  }

  /// The keys that decide which case it is.
  std::map<std::string, std::string> chosen(const SchemaCase& c) const {
    std::map<std::string, std::string> out;
    for (const auto& [key, words] : c.choices)
      if (key.find('|') != key.npos)
        for (const SchemaField& f : c.fields)
          if (f.key == words.front()) out[f.key] = example(f);
    for (const SchemaField& f : c.fields)
      if (f.kind == FieldKind::word && f.required && !f.words.empty()) out[f.key] = f.words.front();
    for (const auto& [key, words] : c.choices)
      if (key.find('|') == key.npos) out[key] = words.front();
    return out;
  }

  static std::string text(const std::map<std::string, std::string>& fields) {
    std::string out;
    for (const auto& [key, value] : fields) out += key + ": " + value + ", ";
    return out;
  }

  void follow(std::size_t level, const Around& around) {
    for (const SchemaCase& c : schema_.levels[level].cases) {
      std::map<std::string, std::string> fields = chosen(c);
      if (level == 0) fields.insert(prefix_.begin(), prefix_.end());
      compare(c, around(text(fields) + "qqqq: 1"));
      for (const SchemaField& f : c.fields) {
        if (f.level == SchemaField::no_level || f.plain || !seen_.insert({f.level, f.key}).second) continue;
        follow(f.level, [&](const std::string& inner) {
          std::map<std::string, std::string> with = fields;
          with[f.key] = nested(f, inner);
          return around(text(with));
        });
      }
    }
  }

  /// Whether the same stands at the top of a document.
  bool at_top(const SchemaField& f) const {
    for (const SchemaCase& c : schema_.levels[0].cases)
      for (const SchemaField& top : c.fields)
        if (top.key == f.key && top.level == f.level) return true;
    return false;
  }

  std::string nested(const SchemaField& f, const std::string& inner) const {
    const std::string map = "{" + inner + "}";
    if (f.kind == FieldKind::list) return "[" + map + "]";
    if (f.kind != FieldKind::entries) return map;
    const auto there = at_top(f) ? prefix_.find(f.key) : prefix_.end();  // others refer to the entry that is there
    const std::string first = there == prefix_.end() ? "{" : there->second.substr(0, there->second.size() - 1) + ", ";
    return first + (there == prefix_.end() ? schema_name : "OTHER") + ": " + map + "}";
  }

  void compare(const SchemaCase& c, const std::string& document) {
    std::string refusal;
    try {
      read_(document);
    } catch (const InputError& e) {
      refusal = e.what();
    }
    const std::size_t known = refusal.find("(known: "), end = refusal.rfind(')');
    ASSERT_NE(refusal.find("qqqq: unknown key"), refusal.npos) << refusal << "\n" << document;
    ASSERT_NE(known, refusal.npos) << refusal;
    std::set<std::string> reader, schema;
    std::istringstream list(refusal.substr(known + 8, end - known - 8));
    for (std::string key; std::getline(list, key, ',');) reader.insert(key.substr(key.find_first_not_of(' ')));
    for (const SchemaField& f : c.fields)
      if (f.kind != FieldKind::others) schema.insert(f.key);  // a path is no word
    EXPECT_EQ(reader, schema) << document;
    ++compared_;
  }

  Schema schema_;
  std::map<std::string, std::string> prefix_;
  std::function<void(const std::string&)> read_;
  std::map<std::string, std::string> examples_;
  std::set<std::pair<std::size_t, std::string>> seen_;
  int compared_ = 0;
};

}  // namespace deflect::test
