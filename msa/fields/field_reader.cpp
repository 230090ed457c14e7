#include "msa/fields/field_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/fields/field_examples.h"

namespace deflect {
namespace {

using Kind = YamlNode::Kind;

std::string words(const Range& r, Dimension d) {
  const bool low = r.low > -std::numeric_limits<double>::infinity(),
             high = r.high < std::numeric_limits<double>::infinity();
  const std::string from = low ? format_quantity(r.low, d) : "", to = high ? format_quantity(r.high, d) : "";
  if (low && high) return fmt::format("{} {} and {}", r.open ? "strictly between" : "between", from, to);
  return fmt::format("{} {}", r.open ? "above" : "at least", from);
}

/// A name can be a segment of a path; a loose one need not, but can be a part of a file's name.
bool is_name(const std::string& s, bool loose) {
  const auto letter = [](unsigned char c) { return std::isalpha(c) || c == '_' || c >= 0x80; };
  const auto first = [&](unsigned char c) { return letter(c) || (loose && std::isdigit(c)); };
  return !s.empty() && first(static_cast<unsigned char>(s.front())) && s.back() != ' ' &&
         std::all_of(s.begin(), s.end(),
                     [&](unsigned char c) { return letter(c) || std::isdigit(c) || c == '-' || (loose && c == ' '); });
}

YamlNode untagged(YamlNode node) {
  node.ours = false;
  for (YamlNode& child : node.children) child = untagged(std::move(child));
  return node;
}

}  // namespace

std::string FieldReader::message(const YamlNode& at, const std::string& path, const std::string& what) const {
  // An empty value has no place of its own; its key has.
  const int number = at.kind == Kind::null && at.key_line > 0 ? at.key_line : at.line;
  const std::string line = number > 0 ? fmt::format("{}:", number) : "";
  return fmt::format("{}:{} {}{}{}", origin_, line, path, path.empty() ? "" : ": ", what);
}

void FieldReader::fail(const YamlNode& at, const std::string& path, const std::string& what) const {
  throw InputError(message(at, path, what));
}

void FieldReader::note(const YamlNode& node, const std::string& path) {
  if (node.ours) ours_.insert(path);
}

void FieldReader::note_all(const YamlNode& node, const std::string& path) {
  note(node, path);
  if (node.depends) depends_[path] = *node.depends;
  for (std::size_t i = 0; i < node.children.size(); ++i)
    note_all(node.children[i], joined(path, node.kind == Kind::map ? node.keys[i] : std::to_string(i)));
}

void FieldReader::refuse_key(std::size_t i, const std::vector<std::string>& known) const {
  YamlNode at;
  at.line = level_.map->children[i].key_line;
  const std::string& key = level_.map->keys[i];
  fail(at, joined(path_, key), "unknown key" + suggestion(key, known));
}

void FieldReader::refuse_misspelt(const std::vector<std::string>& keys) const {
  for (std::size_t i = 0; i < level_.map->keys.size(); ++i)
    if (!nearest(level_.map->keys[i], keys).empty()) refuse_key(i, keys);
}

void FieldReader::read(const YamlNode& map, const std::function<void()>& fields) {
  if (map.kind != Kind::map)
    fail(map, path_,
         map.kind == Kind::null ? "is empty: a map of fields 'key: value' is wanted"
                                : "a map of fields 'key: value' is wanted");
  const Level outer = std::exchange(level_, Level{&map, nullptr, {}, "", ""});
  fields();
  for (std::size_t i = 0; i < map.keys.size(); ++i)
    if (std::find(level_.asked.begin(), level_.asked.end(), map.keys[i]) == level_.asked.end())
      refuse_key(i, {level_.asked.begin(), level_.asked.end()});
  for (const std::string& error : {level_.missing, level_.broken})
    if (!error.empty()) throw InputError(error);
  level_ = outer;
}

const YamlNode* FieldReader::child(std::string_view key) const {
  if (level_.only) return key.empty() ? level_.only : nullptr;
  return level_.map->child(key);
}

const YamlNode* FieldReader::find(const char* key, bool needed, LaterText sample, const char* about) {
  level_.asked.emplace_back(key);
  const YamlNode* node = child(key);
  if (node && node->ours) note(*node, joined(path_, key));
  if (node || !needed || !level_.missing.empty()) return node;
  YamlNode at;
  at.line = level_.map->key_line > 0 ? level_.map->key_line : level_.map->line;
  level_.missing =
      message(at, path_, fmt::format("'{}' is missing ({}): write for example '{}'", key, about, sample()));
  return nullptr;
}

const std::string& FieldReader::scalar(const YamlNode& node, LaterText path, LaterText sample) const {
  if (node.kind == Kind::null) fail(node, path(), fmt::format("has no value: write for example '{}'", sample()));
  if (node.kind != Kind::scalar)
    fail(node, path(),
         fmt::format("a single value is wanted, not a {}: write for example '{}'",
                     node.kind == Kind::map ? "map" : "list", sample()));
  return node.text;
}

double FieldReader::number(const YamlNode& node, LaterText path, const Quantity& q, LaterText sample) {
  const std::string& text = scalar(node, path, sample);
  const auto parsed = outcome_of<InputError>([&] {
    const double found = parse_quantity(text, q.dimension);
    require_usable_size(found, q.dimension, text);
    return found;
  });
  if (!parsed) fail(node, path(), parsed.why);
  const double value = *parsed;
  if (!q.range.holds(value)) fail(node, path(), fmt::format("'{}' must be {}", text, words(q.range, q.dimension)));
  if (node.depends) {
    Dependence& seen = depends_[path()] = *node.depends;
    seen.factor = (value - seen.offset) / seen.x;
  }
  return value;
}

void FieldReader::quantity(const char* key, double& value, const Quantity& q, const char* about) {
  const auto sample = [&] { return example_of(key, example_of(q.dimension)); };
  const auto path = [&] { return joined(path_, key); };
  if (const YamlNode* node = find(key, !q.otherwise, sample, about))
    value = number(*node, path, q, sample);
  else if (q.otherwise)
    value = *q.otherwise;
}

void FieldReader::quantity_if_given(const char* key, std::optional<double>& value, const Quantity& q,
                                    const char* about) {
  const auto sample = [&] { return example_of(key, example_of(q.dimension)); };
  const auto path = [&] { return joined(path_, key); };
  value.reset();
  if (const YamlNode* node = find(key, false, sample, about)) value = number(*node, path, q, sample);
}

void FieldReader::quantity_or_word(const char* key, double& value, const Quantity& q, std::string& word,
                                   const std::vector<std::string>& of, const char* about) {
  word.clear();
  const YamlNode* node = child(key);
  const bool text = node && node->kind == Kind::scalar && !node->text.empty();
  if (!text || std::find(of.begin(), of.end(), node->text) == of.end()) {
    if (text && std::isalpha(static_cast<unsigned char>(node->text.front())))
      fail(*node, joined(path_, key), "is neither a number nor a known word" + suggestion(node->text, of));
    return quantity(key, value, q, about);
  }
  find(key, false, std::string(), about);
  word = node->text;
}

void FieldReader::integer(const char* key, int& value, int low, int high, const char* about) {
  const std::string sample = fmt::format("{}: {}", key, low);
  const YamlNode* node = find(key, true, sample, about);
  if (!node) return;
  const std::string path = joined(path_, key), text = scalar(*node, path, sample);
  for (value = low; value <= high; ++value)
    if (text == std::to_string(value)) return;
  fail(*node, path, fmt::format("'{}' must be a whole number from {} to {}", text, low, high));
}

void FieldReader::vector3(const char* key, Vector3& value, Dimension d, const char* about) {
  const auto sample = [&] {
    return example_of(key, d == Dimension::none ? "[0, 0, 1]" : fmt::format("[{0}, {0}, {0}]", example_of(d)));
  };
  const auto path = [&] { return joined(path_, key); };
  value.setZero();
  const YamlNode* node = find(key, false, sample, about);
  if (!node) return;
  if (node->kind != Kind::list || node->children.size() != 3)
    fail(*node, path(), fmt::format("a list of three values is wanted: write for example '{}'", sample()));
  for (int i = 0; i < 3; ++i) {
    const YamlNode& item = nth(node->children, i);
    const auto item_path = [&] { return joined(path(), std::to_string(i)); };
    if (item.ours) note(item, item_path());
    value(i) = number(item, item_path, {d, {}, std::nullopt}, sample);
  }
  if (d == Dimension::none && value.isZero(0))
    fail(*node, path(), fmt::format("is no direction: write for example '{}'", sample()));
}

void FieldReader::text(const char* key, std::string& value, Need need, const char* about) {
  const auto sample = [&] { return fmt::format("{}: \"text\"", key); };
  const auto path = [&] { return joined(path_, key); };
  value.clear();
  const YamlNode* node = find(key, need == Need::required, sample, about);
  if (!node) return;
  value = scalar(*node, path, sample);
  if (value.empty() && need == Need::required)
    fail(*node, path(), fmt::format("is empty: write for example '{}'", sample()));
}

void FieldReader::texts(const char* key, std::vector<std::string>& values, Need need, const char* about) {
  const auto sample = [&] { return example_of(key, "[name, name]"); };
  values.clear();
  const YamlNode* node = find(key, need == Need::required, sample, about);
  if (!node) return;
  const std::string path = joined(path_, key);
  if (node->kind != Kind::list) return values.push_back(scalar(*node, path, sample));
  for (std::size_t i = 0; i < node->children.size(); ++i)
    values.push_back(scalar(node->children[i], joined(path, std::to_string(i)), sample));
  if (values.empty()) fail(*node, path, fmt::format("is empty: write for example '{}'", sample()));
}

void FieldReader::word(const char* key, std::string& value, const Words& w, const char* about) {
  const auto sample = [&] { return fmt::format("{}: {}", key, w.allowed.empty() ? "name" : w.allowed.front()); };
  const YamlNode* node = find(key, !w.otherwise, sample, about);
  if (!node && w.decides) {  // the other keys cannot be judged without it
    refuse_misspelt({key});
    throw InputError(level_.missing);
  }
  if (!node) {
    value = w.otherwise.value_or("");
    return;
  }
  value = scalar(*node, joined(path_, key), sample);
  if (std::find(w.allowed.begin(), w.allowed.end(), value) == w.allowed.end())
    fail(*node, joined(path_, key), fmt::format("unknown {} '{}'{}", w.what, value, suggestion(value, w.allowed)));
}

void FieldReader::any(const char* key, std::string& yaml, const char* example, const char* about) {
  const std::string sample = fmt::format("{}: {}", key, example);
  const YamlNode* node = find(key, true, sample, about);
  if (!node) return;
  if (node->kind == Kind::null) scalar(*node, joined(path_, key), sample);
  note_all(*node, joined(path_, key));
  yaml = flow_yaml(untagged(*node));
}

void FieldReader::word_or_object(const char* key, std::string& value, const Words& w, bool,
                                 const std::function<void()>& fields, const char* about) {
  const YamlNode* node = child(key);
  if (node && node->kind == Kind::map)
    object(key, Need::required, false, fields, about);
  else
    word(key, value, w, about);
}

void FieldReader::object(const char* key, Need need, bool, const std::function<void()>& fields, const char* about) {
  const YamlNode* node = find(key, need == Need::required, fmt::format("{}: {{...}}", key), about);
  if (!node) return;
  const std::string outer = std::exchange(path_, joined(path_, key));
  read(*node, fields);
  path_ = outer;
}

void FieldReader::element(const YamlNode& node, const std::string& path, Elements& all, std::size_t i) {
  note(node, path);
  const std::string outer = std::exchange(path_, path);
  if (all.plain()) {
    YamlNode map;  // of the one value under the key ""
    map.kind = Kind::map;
    map.line = map.key_line = node.key_line;
    read(map, [&] {
      level_.only = &node;
      all.describe_element(*this, i);
    });
  } else {
    read(node, [&] { all.describe_element(*this, i); });
  }
  path_ = outer;
}

void FieldReader::read_entries(const YamlNode& map, Elements& all) {
  if (map.kind != Kind::map) fail(map, path_, "named entries 'name: {...}' are wanted");
  for (std::size_t i = 0; i < map.children.size(); ++i) {
    const YamlNode& child = map.children[i];
    const std::string path = joined(path_, map.keys[i]);
    if (!is_name(map.keys[i], all.loose_names()))
      fail(child, path,
           all.loose_names()
               ? "a name begins with a letter or a digit and consists of letters, digits, '_', '-' and spaces"
               : "a name begins with a letter and consists of letters, digits, '_' and '-'");
    all.add(map.keys[i]);
    element(child, path, all, all.size() - 1);
  }
}

void FieldReader::entries(const char* key, Elements& all, Need need, const char* about) {
  const YamlNode* node = find(key, need == Need::required, fmt::format("{}: {{name: {{...}}}}", key), about);
  if (!node) return;
  const std::string outer = std::exchange(path_, joined(path_, key));
  read_entries(*node, all);
  if (need == Need::required && all.size() == 0) fail(*node, path_, "has no entries, at least one is needed");
  path_ = outer;
}

void FieldReader::elements(const YamlNode& list, Elements& all) {
  for (const YamlNode& item : list.children) {
    const std::size_t i = all.size();
    all.add("");
    element(item, joined(path_, std::to_string(i)), all, i);
  }
}

void FieldReader::list(const char* key, Elements& all, const char* about) {
  const YamlNode* node = find(key, false, "", about);
  if (!node) return;
  if (node->kind != Kind::list) fail(*node, joined(path_, key), "a list '- {...}' is wanted");
  const std::string outer = std::exchange(path_, joined(path_, key));
  elements(*node, all);
  path_ = outer;
}

void FieldReader::one_or_list(const char* key, Elements& all, const char* about) {
  const YamlNode* node = child(key);
  if (!node || node->kind == Kind::list) return list(key, all, about);
  level_.asked.emplace_back(key);
  all.add("");
  element(*node, joined(joined(path_, key), "0"), all, all.size() - 1);
}

void FieldReader::others(Named<std::string>& values, const char*) {
  values.clear();
  for (std::size_t i = 0; i < level_.map->keys.size(); ++i) {
    const std::string& key = level_.map->keys[i];
    if (key.find('.') == key.npos) continue;  // unknown, which is told at the end of the map
    const YamlNode& node = level_.map->children[i];
    const std::string sample = key + ": 10 %", path = joined(path_, key);
    values.emplace_back(key, scalar(node, path, sample));
    note(node, path);
    level_.asked.push_back(key.c_str());
  }
}

void FieldReader::keys(const std::vector<std::string>& all) {
  for (std::size_t i = 0; i < level_.map->keys.size(); ++i)
    if (std::find(all.begin(), all.end(), level_.map->keys[i]) == all.end()) refuse_key(i, all);
}

std::size_t FieldReader::alternative(const std::vector<std::string>& keys, std::size_t) {
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (level_.map->child(keys[i])) there.push_back(i);
  if (there.size() == 1) return there.front();
  if (there.empty()) refuse_misspelt(keys);
  YamlNode at;
  at.line = level_.map->key_line > 0 ? level_.map->key_line : level_.map->line;
  fail(at, path_, fmt::format("{} of '{}' is wanted", there.empty() ? "one" : "only one", fmt::join(keys, "', '")));
}

void FieldReader::require(bool holds, const char* key, const std::string& what) {
  if (holds || !level_.broken.empty()) return;
  YamlNode at;  // the field, or the key of the map that lacks it
  at.line = level_.map->key_line > 0 ? level_.map->key_line : level_.map->line;
  const YamlNode* node = child(key);
  level_.broken = message(node ? *node : at, joined(path_, key), what);
}

}  // namespace deflect
