// The fields of a frame file, for reading and writing (see msa/mechanism/fields.h), and helpers that its parts share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "msa/frame/file/frame_description.h"
#include "msa/frame/file/name_index.h"
#include "msa/mechanism/fields.h"

namespace deflect::frame {

/// `absent_ends`: a writer also visits the laws of members' ends where there are none, as edits of them need.
void describe(FieldVisitor&, FrameDescription&, bool absent_ends = true);

/// Names that later parts of the file refer to.
struct FrameNames {
  const FrameDescription& frame;
  NameIndex nodes, members, materials, sections, supports;
  double extent = 0;  ///< diagonal of the nodes' bounding box, m
  bool absent_ends = true;
};

void describe(FieldVisitor&, LoadCase&, const FrameNames&);
void describe(FieldVisitor&, const std::string& node, FrameSupport&, const FrameNames&);
void describe(FieldVisitor&, FrameSpring&, const FrameNames&);
/// The freedoms that a support holds: a word or a list.
void describe_held(FieldVisitor&, const char* key, Freedoms&);
/// The laws of one end of a member, in the field `key`.
void describe_end(FieldVisitor&, const char* key, FreedomLaws&, const Freedoms& released, const FrameNames&,
                  const char* about);

/// Sensors and how loads are recorded.
void describe_rig(FieldVisitor&, FrameDescription&, const FrameNames&);

/// Named entries, described by a function. `is_plain`: an entry is one value under the key "".
template <class T>
class FrameEntries final : public Elements {
 public:
  using Describe = std::function<void(FieldVisitor&, const std::string& name, T&)>;
  FrameEntries(Named<T>& list, Describe describe, bool is_plain = false)
      : list_(list), describe_(std::move(describe)), plain_(is_plain) {}
  std::size_t size() const override { return list_.size(); }
  std::string name(std::size_t i) const override { return list_[i].first; }
  void add(const std::string& name) override {
    if constexpr (requires { T::Zero(); })
      list_.emplace_back(name, T::Zero());
    else
      list_.emplace_back(name, T());
  }
  void describe_element(FieldVisitor& v, std::size_t i) override { describe_(v, list_[i].first, list_[i].second); }
  bool plain() const override { return plain_; }
  bool loose_names() const override { return true; }

 private:
  Named<T>& list_;
  Describe describe_;
  bool plain_;
};

/// "unknown node 'N9', did you mean 'N8'?" with the known names where they are few.
std::string unknown_name(const char* what, const std::string& name, const std::vector<std::string>& known);

/// Requires that `name`, the value of `key`, is in the list. Returns its index, or −1 where it is not.
template <class T>
int require_known(FieldVisitor& v, const char* key, const char* what, const std::string& name, const NameIndex& index,
                  const Named<T>& list) {
  const int at = index.find(name);
  if (at >= 0) return at;
  std::vector<std::string> known;
  for (const auto& [each, value] : list) known.push_back(each);
  v.require(false, key, unknown_name(what, name, known));
  return -1;
}

/// Six optional quantities under the keys ux … rz.
void describe_freedom_values(FieldVisitor&, FreedomValues&, Dimension translation, Dimension rotation, Range,
                             const char* about);

}  // namespace deflect::frame
