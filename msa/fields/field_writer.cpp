#include "msa/fields/field_writer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace deflect {
namespace {

using Kind = YamlNode::Kind;

YamlNode scalar(std::string text, bool quoted = false) {
  YamlNode node;
  node.kind = Kind::scalar;
  node.text = std::move(text);
  node.quoted = quoted;
  return node;
}

YamlNode number(double value, Dimension d) {
  YamlNode node = scalar(format_quantity(value, d));
  node.number = value;
  node.dimension = d;
  return node;
}

void imply_all(YamlNode& node) {
  node.implied = true;
  for (YamlNode& child : node.children) imply_all(child);
}

bool all_implied(const YamlNode& node) {
  return std::all_of(node.children.begin(), node.children.end(), [](const YamlNode& c) { return c.implied; });
}

}  // namespace

void FieldWriter::add(const std::string& key, YamlNode node, bool implied) {
  node.ours = ours_.contains(joined(path_, key));
  node.implied = implied && !node.ours && key != telling_;
  map_.add(key, std::move(node));
}

void FieldWriter::quantity(const char* key, double& value, const Quantity& q, const char*) {
  add(key, number(value, q.dimension), q.otherwise == value);
}

void FieldWriter::quantity_or_word(const char* key, double& value, const Quantity& q, std::string& word,
                                   const std::vector<std::string>&, const char* about) {
  if (word.empty()) return quantity(key, value, q, about);
  add(key, scalar(word), false);
}

void FieldWriter::quantity_if_given(const char* key, std::optional<double>& value, const Quantity& q, const char*) {
  if (value) return add(key, number(*value, q.dimension), false);
  YamlNode absent;
  absent.implied = true;
  map_.add(key, absent);
}

void FieldWriter::integer(const char* key, int& value, int, int, const char*) {
  add(key, scalar(std::to_string(value)), false);
}

void FieldWriter::vector3(const char* key, Vector3& value, Dimension d, const char*) {
  YamlNode list;
  list.kind = Kind::list;
  bool tagged = false;
  for (int i = 0; i < 3; ++i) {
    list.children.push_back(number(value(i), d));
    list.children.back().ours = ours_.contains(joined(joined(path_, key), std::to_string(i)));
    tagged = tagged || list.children.back().ours;
  }
  add(key, std::move(list), value.isZero(0) && !tagged);
}

void FieldWriter::matrix(const char* key, MatrixX& value, Eigen::Index, Need, const char*) {
  YamlNode rows;
  rows.kind = Kind::list;
  for (Eigen::Index i = 0; i < value.rows(); ++i) {
    YamlNode row;
    row.kind = Kind::list;
    for (Eigen::Index j = 0; j < value.cols(); ++j) row.children.push_back(number(value(i, j), Dimension::none));
    rows.children.push_back(std::move(row));
  }
  mark(rows, joined(path_, key));
  add(key, std::move(rows), value.size() == 0);
}

void FieldWriter::pairs(const char* key, Pairs& values, const std::array<Dimension, 2>& dimensions, Need need,
                        const char*) {
  YamlNode list;
  list.kind = Kind::list;
  for (const std::array<double, 2>& value : values) {
    YamlNode pair;
    pair.kind = Kind::list;
    for (std::size_t k = 0; k < 2; ++k) pair.children.push_back(number(value[k], dimensions[k]));
    list.children.push_back(std::move(pair));
  }
  mark(list, joined(path_, key));
  add(key, std::move(list), need == Need::optional && values.empty());
}

void FieldWriter::text(const char* key, std::string& value, Need need, const char*) {
  add(key, scalar(value, true), need == Need::optional && value.empty());
}

void FieldWriter::texts(const char* key, std::vector<std::string>& values, Need, const char*) {
  YamlNode list;
  list.kind = Kind::list;
  for (const std::string& value : values) list.children.push_back(scalar(value));
  list.collapses = true;
  add(key, std::move(list), values.empty());
}

void FieldWriter::word(const char* key, std::string& value, const Words& w, const char*) {
  add(key, scalar(value), w.otherwise == value);
}

void FieldWriter::word_or_object(const char* key, std::string& value, const Words& w, bool more,
                                 const std::function<void()>& fields, const char* about) {
  if (more)
    object(key, Need::required, false, fields, about);
  else
    word(key, value, w, about);
}

void FieldWriter::mark(YamlNode& node, const std::string& path) const {
  node.ours = ours_.contains(path);
  for (std::size_t i = 0; i < node.children.size(); ++i)
    mark(node.children[i], joined(path, node.kind == Kind::map ? node.keys[i] : std::to_string(i)));
}

void FieldWriter::any(const char* key, std::string& yaml, const char*, const char*) {
  YamlNode node = parse_yaml(yaml, joined(path_, key));
  set_line(node, 0);
  mark(node, joined(path_, key));
  add(key, std::move(node), false);
}

YamlNode FieldWriter::filled(const std::string& path, const std::function<void()>& fields) {
  YamlNode fresh;
  fresh.kind = Kind::map;
  const std::string outer_path = std::exchange(path_, path), outer_telling = std::exchange(telling_, "");
  YamlNode outer = std::exchange(map_, std::move(fresh));
  fields();
  path_ = outer_path;
  telling_ = outer_telling;
  return std::exchange(map_, std::move(outer));
}

void FieldWriter::object(const char* key, Need need, bool absent, const std::function<void()>& fields, const char*) {
  YamlNode node = filled(joined(path_, key), fields);
  if (absent) imply_all(node);
  const bool implied = need == Need::optional ? all_implied(node) : need == Need::if_given && absent;
  add(key, std::move(node), implied);
}

void FieldWriter::entries(const char* key, Elements& all, Need need, const char*) {
  YamlNode node;
  node.kind = Kind::map;
  node.entries = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string path = joined(joined(path_, key), all.name(i));
    YamlNode entry = filled(path, [&] { all.describe_element(*this, i); });
    if (all.plain()) {
      YamlNode value = *entry.child("");
      value.implied = false;
      entry = std::move(value);
    }
    node.add(all.name(i), std::move(entry));
    node.children.back().ours = ours_.contains(path);
  }
  add(key, std::move(node), need == Need::optional && all.size() == 0);
}

YamlNode FieldWriter::sequence(const char* key, Elements& all) {
  YamlNode node;
  node.kind = Kind::list;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string path = joined(joined(path_, key), std::to_string(i));
    node.children.push_back(filled(path, [&] { all.describe_element(*this, i); }));
    node.children.back().ours = ours_.contains(path);
  }
  return node;
}

void FieldWriter::list(const char* key, Elements& all, const char*) { add(key, sequence(key, all), all.size() == 0); }

void FieldWriter::one_or_list(const char* key, Elements& all, const char*) {
  YamlNode node = sequence(key, all);
  node.collapses = true;
  add(key, std::move(node), all.size() == 0);
}

void FieldWriter::others(Named<std::string>& values, const char*) {
  for (const auto& [key, value] : values) add(key, scalar(value), false);
}

std::size_t FieldWriter::alternative(const std::vector<std::string>& keys, std::size_t current) {
  telling_ = keys[current];
  return current;
}

}  // namespace deflect
