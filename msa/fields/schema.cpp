#include "msa/fields/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <set>
#include <typeindex>
#include <utility>

#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {
namespace {

/// Key or keys → word or key.
using Chosen = std::map<std::string, std::string>;

/// One way through the fields of a level.
struct Walk {
  Chosen forced, chosen;
  std::vector<std::pair<std::string, std::vector<std::string>>> decisions;  // in order, with all that could be chosen
  std::vector<SchemaField> fields;
  bool refused = false;
};

bool same(const SchemaField& a, const SchemaField& b) {
  return a.key == b.key && a.kind == b.kind && a.dimension == b.dimension && a.second == b.second &&
         a.required == b.required && a.level == b.level && a.words == b.words && a.about == b.about;
}
bool same(const std::vector<SchemaField>& a, const std::vector<SchemaField>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SchemaField& x, const SchemaField& y) { return same(x, y); });
}

/// Whether the walks made the same choices but for this key, where both made them.
bool differ_only_in(const std::string& key, const Chosen& a, const Chosen& b) {
  return std::all_of(a.begin(), a.end(), [&](const auto& choice) {
    const auto other = b.find(choice.first);
    return other == b.end() || (choice.first == key) == (choice.second != other->second);
  });
}

/// Walks with the same fields become one case with several words; what nothing depends on is left out.
std::vector<SchemaCase> cases_of(const std::vector<Walk>& walks) {
  std::set<std::string> deciding;
  for (const Walk& a : walks)
    for (const Walk& b : walks)
      for (const auto& [key, word] : a.chosen)
        if (b.chosen.contains(key) && differ_only_in(key, a.chosen, b.chosen) && !same(a.fields, b.fields))
          deciding.insert(key);
  std::vector<SchemaCase> out;
  for (const Walk& walk : walks) {
    std::map<std::string, std::string> words;
    for (const auto& [key, word] : walk.chosen)
      if (deciding.contains(key)) words.insert({key, word});
    const auto found = std::find_if(out.begin(), out.end(), [&](const SchemaCase& c) {
      return same(c.fields, walk.fields) && c.choices.size() == words.size() &&
             std::all_of(words.begin(), words.end(), [&](const auto& w) { return c.choices.contains(w.first); });
    });
    SchemaCase& into = found == out.end() ? out.emplace_back(SchemaCase{{}, walk.fields}) : *found;
    for (const auto& [key, word] : words) {
      std::vector<std::string>& list = into.choices[key];
      if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
    }
  }
  return out;
}

class SchemaVisitor final : public FieldVisitor {
 public:
  explicit SchemaVisitor(Chosen fixed) : fixed_(std::move(fixed)) {}

  Schema schema;

  /// Describes a level in every way that its words allow; returns its index.
  std::size_t level(const std::string& path, const std::function<void()>& describe) {
    const std::size_t index = schema.levels.size();
    schema.levels.push_back({path, {}});
    fill(index, path, describe);
    return index;
  }

  void quantity(const char* key, double&, const Quantity& q, const char* about) override {
    SchemaField& f = add(key, FieldKind::quantity, !q.otherwise, about);
    f.dimension = q.dimension;
    f.or_dimension = q.or_dimension;
    f.range = q.range;
    if (q.otherwise) f.otherwise = format_quantity(*q.otherwise, q.dimension);
  }
  void quantity_if_given(const char* key, std::optional<double>&, const Quantity& q, const char* about) override {
    SchemaField& f = add(key, FieldKind::quantity, false, about);
    f.dimension = q.dimension;
    f.range = q.range;
  }
  void quantity_or_word(const char* key, double& value, const Quantity& q, std::string&,
                        const std::vector<std::string>& of, const char* about) override {
    quantity(key, value, q, about);
    walk_.fields.back().words = of;
  }
  void integer(const char* key, int&, int low, int, const char* about) override {
    add(key, FieldKind::integer, true, about).range.low = low;
  }
  void vector3(const char* key, Vector3&, Dimension d, const char* about) override {
    add(key, FieldKind::vector3, false, about).dimension = d;
  }
  void matrix(const char* key, MatrixX&, Eigen::Index size, Need need, const char* about) override {
    add(key, FieldKind::matrix, need == Need::required, about).size = as_size(size);
  }
  void pairs(const char* key, Pairs&, const std::array<Dimension, 2>& d, Need need, const char* about) override {
    SchemaField& f = add(key, FieldKind::pairs, need == Need::required, about);
    f.dimension = d[0];
    f.second = d[1];
  }
  void text(const char* key, std::string&, Need need, const char* about) override {
    add(key, FieldKind::text, need == Need::required, about);
  }
  void texts(const char* key, std::vector<std::string>&, Need need, const char* about) override {
    add(key, FieldKind::texts, need == Need::required, about);
  }
  void word(const char* key, std::string& value, const Words& w, const char* about) override {
    SchemaField& f = add(key, FieldKind::word, !w.otherwise, about);
    set_words(f, w);
    f.otherwise = w.otherwise.value_or("");
    if (f.words.empty()) return;
    value = choose(key, f.words, f.otherwise.empty() ? f.words.front() : f.otherwise);
  }
  void any(const char* key, std::string&, const char*, const char* about) override {
    add(key, FieldKind::any, true, about);
  }
  void word_or_object(const char* key, std::string&, const Words& w, bool, const std::function<void()>& fields,
                      const char* about) override {
    SchemaField& f = add(key, FieldKind::object, !w.otherwise, about);
    set_words(f, w);
    f.or_word = true;
    const std::size_t i = walk_.fields.size() - 1, index = level(joined(path_, key), fields);
    walk_.fields[i].level = index;
  }
  void object(const char* key, Need need, bool, const std::function<void()>& fields, const char* about) override {
    add(key, FieldKind::object, need == Need::required, about);
    const std::size_t i = walk_.fields.size() - 1, index = level_of_object(joined(path_, key), fields);
    walk_.fields[i].level = index;
  }
  void entries(const char* key, Elements& all, Need need, const char* about) override {
    elements(key, FieldKind::entries, all, need, about, schema_name);
  }
  void list(const char* key, Elements& all, const char* about) override {
    elements(key, FieldKind::list, all, Need::optional, about, "");
  }
  void one_or_list(const char* key, Elements& all, const char* about) override {
    elements(key, FieldKind::one_or_list, all, Need::optional, about, "");
  }
  void others(Named<std::string>&, const char* about) override { add("...", FieldKind::others, false, about); }
  void keys(const std::vector<std::string>&) override {}
  std::size_t alternative(const std::vector<std::string>& keys, std::size_t) override {
    const std::string chosen = choose(fmt::format("{}", fmt::join(keys, "|")), keys, keys.front());
    return as_size(std::find(keys.begin(), keys.end(), chosen) - keys.begin());
  }
  /// Of the conditions only those on words are known here: `law: cable` is refused on a rotation.
  void require(bool holds, const char* key, const std::string&) override {
    if (!holds && walk_.chosen.contains(key)) walk_.refused = true;
  }

 private:
  SchemaField& add(const char* key, FieldKind kind, bool required, const char* about) {
    SchemaField f;
    f.key = key;
    f.about = about;
    f.kind = kind;
    f.required = required;
    return walk_.fields.emplace_back(std::move(f));
  }

  /// Names that the file gives are none.
  void set_words(SchemaField& f, const Words& w) const {
    f.what = w.what;
    const auto fixed = fixed_.find(f.key);
    if (fixed != fixed_.end())
      f.words = {fixed->second};
    else if (std::find(w.allowed.begin(), w.allowed.end(), schema_name) == w.allowed.end())
      f.words = w.allowed;
  }

  std::string choose(const std::string& key, const std::vector<std::string>& all, const std::string& usual) {
    const auto forced = walk_.forced.find(key);
    const std::string word = forced == walk_.forced.end() ? usual : forced->second;
    walk_.chosen[key] = word;
    walk_.decisions.emplace_back(key, all);
    return word;
  }

  /// Every decision is tried with each of its words where it is first met, beside the usual words of the others.
  void fill(std::size_t index, const std::string& path, const std::function<void()>& describe) {
    std::vector<Walk> walks;
    std::set<std::string> met;
    for (std::deque<Chosen> queued = {{}}; !queued.empty(); queued.pop_front()) {
      Walk outer = std::exchange(walk_, Walk());
      const std::string outer_path = std::exchange(path_, path);
      const Surroundings surroundings_before = surroundings;
      walk_.forced = queued.front();
      describe();
      if (index > 0) surroundings = surroundings_before;
      path_ = outer_path;
      walks.push_back(std::exchange(walk_, std::move(outer)));
      const Walk& walk = walks.back();
      Chosen before = queued.front();
      for (const auto& [key, all] : walk.decisions) {
        before[key] = walk.chosen.at(key);
        if (!met.insert(key).second) continue;
        for (const std::string& word : all)
          if (word != walk.chosen.at(key)) {
            Chosen next = queued.front();
            next[key] = word;
            queued.push_back(std::move(next));
          }
      }
    }
    std::erase_if(walks, [](const Walk& walk) { return walk.refused; });
    schema.levels[index].cases = cases_of(walks);
  }

  /// Walks of the level above come here again: it is described once.
  std::size_t level_of_object(const std::string& path, const std::function<void()>& describe) {
    const auto known = objects_.find({path, surroundings.rotation});
    if (known != objects_.end()) return known->second;
    const std::size_t index = level(path, describe);
    objects_[{path, surroundings.rotation}] = index;
    return index;
  }

  /// What the elements are decides what they hold: each kind is described once, where it comes first.
  void elements(const char* key, FieldKind kind, Elements& all, Need need, const char* about, const char* name) {
    SchemaField& f = add(key, kind, need == Need::required, about);
    f.plain = all.plain();
    const std::size_t i = walk_.fields.size() - 1;
    const ElementsKey id{typeid(all), surroundings.rotation, surroundings.beside};
    auto known = elements_.find(id);
    if (known == elements_.end()) {
      const std::string path = *name ? joined(joined(path_, key), name) : joined(path_, key);
      known = elements_.emplace(id, schema.levels.size()).first;
      const std::size_t index = known->second;
      level(path, [&] {
        all.add(name);
        all.describe_element(*this, all.size() - 1);
      });
      walk_.fields[i].level = index;
      return;
    }
    walk_.fields[i].level = known->second;
    if (all.size() == 0) all.add(name);  // what refers to its names finds one
  }

  struct ElementsKey {
    std::type_index type;
    bool rotation, beside;
    auto operator<=>(const ElementsKey&) const = default;
  };

  Chosen fixed_;
  Walk walk_;
  std::string path_;
  std::map<std::pair<std::string, bool>, std::size_t> objects_;
  std::map<ElementsKey, std::size_t> elements_;
};

}  // namespace

Schema schema_of(const std::function<void(FieldVisitor&)>& describe, const std::map<std::string, std::string>& fixed) {
  SchemaVisitor visitor(fixed);
  visitor.level("", [&] { describe(visitor); });
  return std::move(visitor.schema);
}

}  // namespace deflect
