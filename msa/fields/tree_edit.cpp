#include "msa/fields/tree_edit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"

namespace deflect {
namespace {

using Kind = YamlNode::Kind;

class Search {
 public:
  Search(const std::string& path, const std::string& where) : segments_(segments_of(path)), where_(where) {}

  std::vector<TreePlace> found;

  void from(const YamlNode& node, std::size_t depth, const std::string& walked) {
    if (depth == segments_.size()) {
      found.push_back(place_);
      return;
    }
    const std::string& segment = segments_[depth];
    if (node.kind == Kind::map) {
      if (segment == "*") return from_each(node, depth, walked);
      const YamlNode* child = node.child(segment);
      if (!child) fail(joined(walked, segment), unknown(segment, node));
      step(node, as_size(child - node.children.data()), depth + 1, walked);
    } else if (node.kind == Kind::list) {
      from_list(node, depth, walked);
    } else {
      fail(joined(walked, segment), fmt::format("'{}' has no fields", walked));
    }
  }

 private:
  static std::string unknown(const std::string& segment, const YamlNode& node) {
    const std::size_t bracket = segment.find('[');
    if (const std::string list = segment.substr(0, bracket); bracket != segment.npos && node.child(list))
      return fmt::format("entries of a list are numbered from 0, behind a dot: '{}.{}'", list,
                         segment.substr(bracket + 1, segment.find(']') - bracket - 1));
    return fmt::format("there is no '{}'{}", segment, suggestion(segment, node.keys));
  }

  [[noreturn]] void fail(const std::string& path, const std::string& what) const {
    throw InputError(fmt::format("{}{}: {}", where_, path, what));
  }

  void step(const YamlNode& node, std::size_t i, std::size_t depth, const std::string& walked) {
    place_.push_back(i);
    from(node.children[i], depth, joined(walked, node.kind == Kind::map ? node.keys[i] : std::to_string(i)));
    place_.pop_back();
  }

  void from_each(const YamlNode& node, std::size_t depth, const std::string& walked) {
    if (node.kind == Kind::map && !node.entries)
      fail(joined(walked, "*"),
           "'*' stands for named entries or for list elements, here are fields" + suggestion("*", node.keys));
    const std::size_t before = found.size();
    std::string first_error = fmt::format("{}{}: there are no entries", where_, joined(walked, "*"));
    bool failed = false;
    const TreePlace here = place_;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const auto went = outcome_of<InputError>([&] {
        step(node, i, depth + 1, walked);
        return true;
      });
      if (went) continue;
      place_ = here;
      if (!failed) first_error = went.why;
      failed = true;
    }
    if (found.size() == before) throw InputError(first_error);
  }

  void from_list(const YamlNode& node, std::size_t depth, const std::string& walked) {
    const std::string& segment = segments_[depth];
    if (segment == "*") return from_each(node, depth, walked);
    std::size_t i = 0;
    const auto [end, error] = std::from_chars(segment.data(), segment.data() + segment.size(), i);
    const bool index = error == std::errc() && end == segment.data() + segment.size() && !segment.empty();
    if (!index && node.collapses && node.children.size() == 1) return step(node, 0, depth, walked);
    if (!index || i >= node.children.size())
      fail(joined(walked, segment), node.empty() ? fmt::format("'{}' is empty", walked)
                                                 : fmt::format("an index from 0 to {} or '*' is wanted, not '{}'",
                                                               node.children.size() - 1, segment));
    step(node, i, depth + 1, walked);
  }

  std::vector<std::string> segments_;
  std::string where_;
  TreePlace place_;
};

/// An assumption about the whole becomes one about each of its parts.
void pass_down(YamlNode& node) {
  for (YamlNode& child : node.children) child.ours = child.ours || (node.ours && !child.implied);
  node.ours = false;
}

YamlNode& opened(YamlNode& root, const TreePlace& place) {
  YamlNode* node = &root;
  for (const std::size_t i : place) {
    pass_down(*node);
    node->implied = false;
    node = &node->children[i];
  }
  node->implied = false;
  return *node;
}

/// What to say of an append to what is neither a list nor a set of named entries. A law is appended to a list that may
/// be written as its only element.
std::string where_to_append(const YamlNode& node, const YamlNode& value, const std::string& path) {
  if (node.kind != Kind::map) return "is not a list but a single value: nothing can be appended to it, write set";
  std::vector<std::string> lists;
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const YamlNode& child = node.children[i];
    const bool takes = value.kind == Kind::map ? child.collapses || child.entries : child.kind == Kind::list;
    if (takes) lists.push_back(node.keys[i]);
  }
  if (lists.empty()) return "is not a list, and none of its fields is one: nothing can be appended to it, write set";
  return fmt::format("is not a list: append to one of its fields {}, as in '{}'", fmt::join(lists, ", "),
                     joined(path, lists.front()));
}

void append(YamlNode& node, const YamlNode& value, const std::string& path, const std::string& here) {
  pass_down(node);
  if (node.kind == Kind::list) {
    node.children.push_back(value);
    return;
  }
  if (!node.entries) throw InputError(here + where_to_append(node, value, path));
  if (value.kind != Kind::map) throw InputError(here + "a map of new entries 'name: {...}' is wanted");
  for (std::size_t i = 0; i < value.keys.size(); ++i) {
    if (node.child(value.keys[i])) throw InputError(fmt::format("{}'{}' is there already", here, value.keys[i]));
    node.add(value.keys[i], value.children[i]);
  }
}

/// Of a number that an edit moves with a parameter; it had one before where it depended already.
Dependence dependence(const YamlNode& node, Dependence on, double offset) {
  on.offset = offset;
  on.alone = !node.depends;
  return on;
}
std::optional<Dependence> scaled(std::optional<Dependence> on, double factor) {
  if (on) on->offset *= factor;
  return on;
}
std::optional<Dependence> shifted(std::optional<Dependence> on, double by) {
  if (on) on->offset += by;
  return on;
}

void multiply(YamlNode& node, const YamlNode& value, const std::string& here) {
  if (!node.number) throw InputError(here + "is not a number that is there to be multiplied");
  if (value.kind != Kind::scalar) throw InputError(here + "a plain number is wanted as factor");
  const double factor = told_at<InputError>([&] { return here; }, [&] { return parse_number(value.text); });
  node.depends = value.depends ? dependence(node, *value.depends, 0) : scaled(node.depends, factor);
  node.number = *node.number * factor;
  if (!std::isfinite(*node.number)) throw InputError(here + "the product is not finite");
  node.text = format_quantity(*node.number, node.dimension);
  node.ours = false;
}

void add(YamlNode& node, const YamlNode& value, const std::string& here) {
  if (!node.number) throw InputError(here + "is not a number that is there to be added to");
  if (value.kind != Kind::scalar) throw InputError(here + "a single value is wanted as summand");
  const double added =
      told_at<InputError>([&] { return here; }, [&] { return parse_quantity(value.text, node.dimension); });
  node.depends = value.depends ? dependence(node, *value.depends, *node.number) : shifted(node.depends, added);
  *node.number += added;
  if (!std::isfinite(*node.number)) throw InputError(here + "the sum is not finite");
  node.text = format_quantity(*node.number, node.dimension);
  node.ours = false;
}

const char* sign(Edit::Action action) {
  switch (action) {
    case Edit::Action::set:
      return "=";
    case Edit::Action::append:
      return "+=";
    case Edit::Action::multiply:
      return "*=";
    case Edit::Action::add:
      return "+";
  }
  return "";
}

}  // namespace

std::vector<std::string> segments_of(const std::string& path) {
  std::vector<std::string> out(1);
  for (const char c : path)
    if (c == '.')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

std::vector<TreePlace> places(const YamlNode& root, const std::string& path, const std::string& where) {
  if (path.empty()) throw InputError(where + "the path is empty");
  Search search(path, where);
  search.from(root, 0, "");
  return std::move(search.found);
}

const YamlNode& at(const YamlNode& root, const TreePlace& place) {
  const YamlNode* node = &root;
  for (const std::size_t i : place) node = &node->children[i];
  return *node;
}

std::string path_of(const YamlNode& root, const TreePlace& place) {
  std::string path;
  const YamlNode* node = &root;
  for (const std::size_t i : place) {
    path = joined(path, node->kind == Kind::map ? node->keys[i] : std::to_string(i));
    node = &node->children[i];
  }
  return path;
}

void change(YamlNode& root, const TreePlace& place, Edit::Action action, const YamlNode& value,
            const std::string& where) {
  const std::string path = path_of(root, place), here = fmt::format("{}{}: ", where, path);
  YamlNode& node = opened(root, place);
  switch (action) {
    case Edit::Action::set:
      node = value;
      break;
    case Edit::Action::append:
      append(node, value, path, here);
      break;
    case Edit::Action::multiply:
      multiply(node, value, here);
      break;
    case Edit::Action::add:
      add(node, value, here);
      break;
  }
}

std::string origin_of(const Edit& edit) {
  return fmt::format("edit '{} {} {}'", edit.path, sign(edit.action), edit.value);
}

std::string origin_of(const TreeEdit& edit) { return origin_of(Edit{edit.path, flow_yaml(edit.value), edit.action}); }

TreeEdit parsed(const Edit& edit) {
  YamlNode value = parse_yaml(edit.value, origin_of(edit));
  set_line(value, 0);
  return {edit.path, std::move(value), edit.action};
}

void apply(YamlNode& root, const TreeEdit& edit, const std::string& origin) {
  const std::string where = origin + ": ";
  for (const TreePlace& place : places(root, edit.path, where)) change(root, place, edit.action, edit.value, where);
}

}  // namespace deflect
