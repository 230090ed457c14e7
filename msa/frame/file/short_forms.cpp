#include "msa/frame/file/short_forms.h"

#include <algorithm>
#include <utility>

#include "msa/frame/file/frame_description.h"

namespace deflect::frame {
namespace {

using Kind = YamlNode::Kind;

bool is_freedom(const std::string& key) {
  return std::find(node_freedoms.begin(), node_freedoms.end(), key) != node_freedoms.end();
}

/// Calls f(key, value) for the entries of a map of the file.
template <class F>
void for_each_entry(YamlNode& file, const char* map, const F& f) {
  YamlNode* entries = file.kind == Kind::map ? file.child(map) : nullptr;
  if (!entries || entries->kind != Kind::map) return;
  for (std::size_t i = 0; i < entries->children.size(); ++i) f(entries->children[i]);
}

/// The same for the freedoms of springs.
template <class F>
void for_each_freedom(YamlNode& file, const F& f) {
  for_each_entry(file, "springs", [&](YamlNode& spring) {
    for (std::size_t i = 0; spring.kind == Kind::map && i < spring.children.size(); ++i)
      if (is_freedom(spring.keys[i])) f(spring.children[i]);
  });
}

YamlNode map_at(const YamlNode& node) {
  YamlNode map;
  map.kind = Kind::map;
  map.line = node.line;
  map.key_line = node.key_line;
  return map;
}

void make_law(YamlNode& node) {
  if (node.kind != Kind::scalar && node.kind != Kind::null) return;
  YamlNode law = map_at(node), name;
  name.kind = Kind::scalar;
  name.text = "linear";
  name.line = node.line;
  law.add("law", std::move(name));
  law.add("stiffness", std::move(node));
  node = std::move(law);
}

bool is(const YamlNode& map, std::size_t i, const char* key) { return map.keys[i] == key; }

/// The value alone, with the mark of what stood around it.
void replace(YamlNode& node, YamlNode by) {
  by.ours = by.ours || node.ours;
  node = std::move(by);
}

}  // namespace

YamlNode spelled_out(YamlNode file) {
  for_each_entry(file, "supports", [](YamlNode& support) {
    if (support.kind == Kind::map) return;
    YamlNode map = map_at(support);
    map.add("holds", std::move(support));
    support = std::move(map);
  });
  for_each_freedom(file, [](YamlNode& laws) {
    if (laws.kind != Kind::list) return make_law(laws);
    for (YamlNode& law : laws.children) make_law(law);
  });
  return file;
}

YamlNode shortened(YamlNode file) {
  for_each_entry(file, "supports", [](YamlNode& support) {
    if (support.kind == Kind::map && support.children.size() == 1 && is(support, 0, "holds"))
      replace(support, YamlNode(support.children.front()));
  });
  for_each_freedom(file, [](YamlNode& laws) {
    if (laws.kind != Kind::list || laws.children.size() != 1) return;
    const YamlNode law = laws.children.front();
    if (law.kind != Kind::map || law.children.size() != 2 || law.ours) return;
    if (is(law, 0, "law") && law.children[0].text == "linear" && is(law, 1, "stiffness") && !law.children[0].ours)
      replace(laws, law.children[1]);
  });
  return file;
}

TreeEdit spelled_out(TreeEdit edit) {
  const std::vector<std::string> at = segments_of(edit.path);
  const bool number = edit.action == Edit::Action::multiply || edit.action == Edit::Action::add;
  if (number && at.size() == 3 && at[0] == "springs" && is_freedom(at[2])) edit.path += ".stiffness";
  const bool word = edit.action == Edit::Action::append && edit.value.kind == Kind::scalar;
  if (word && at.size() == 2 && at[0] == "supports") edit.path += ".holds";
  return edit;
}

}  // namespace deflect::frame
