// Writes a description to a tree with every field that a file could contain. Defaults and absent fields are included
// and marked as implied, so that edits can find them; stripped() removes them.
#pragma once

#include <set>
#include <string>

#include "msa/fields/field_visitor.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {

class FieldWriter final : public FieldVisitor {
 public:
  /// `ours`: paths that get the tag !ours; `path`: of the tree in the file.
  explicit FieldWriter(const std::set<std::string>& ours, std::string path = "") : ours_(ours), path_(std::move(path)) {
    map_.kind = YamlNode::Kind::map;
  }

  /// The map filled so far by calls of describe().
  const YamlNode& tree() const { return map_; }

  void quantity(const char*, double&, const Quantity&, const char*) override;
  void quantity_if_given(const char*, std::optional<double>&, const Quantity&, const char*) override;
  void quantity_or_word(const char*, double&, const Quantity&, std::string&, const std::vector<std::string>&,
                        const char*) override;
  void integer(const char*, int&, int low, int high, const char*) override;
  void vector3(const char*, Vector3&, Dimension, const char*) override;
  void matrix(const char*, MatrixX&, Eigen::Index size, Need, const char*) override;
  void pairs(const char*, Pairs&, const std::array<Dimension, 2>&, Need, const char*) override;
  void text(const char*, std::string&, Need, const char*) override;
  void texts(const char*, std::vector<std::string>&, Need, const char*) override;
  void word(const char*, std::string&, const Words&, const char*) override;
  void any(const char*, std::string&, const char*, const char*) override;
  void word_or_object(const char*, std::string&, const Words&, bool, const std::function<void()>&,
                      const char*) override;
  void object(const char*, Need, bool absent, const std::function<void()>&, const char*) override;
  void entries(const char*, Elements&, Need, const char*) override;
  void list(const char*, Elements&, const char*) override;
  void one_or_list(const char*, Elements&, const char*) override;
  void others(Named<std::string>&, const char*) override;
  void keys(const std::vector<std::string>&) override {}
  std::size_t alternative(const std::vector<std::string>& keys, std::size_t current) override;
  void require(bool, const char*, const std::string&) override {}

 private:
  void add(const std::string& key, YamlNode, bool implied);
  YamlNode filled(const std::string& path, const std::function<void()>& fields);
  YamlNode sequence(const char* key, Elements&);
  void mark(YamlNode&, const std::string& path) const;

  const std::set<std::string>& ours_;
  std::string path_;
  std::string telling_;  // key of the map that selects its alternative; always written
  YamlNode map_;
};

}  // namespace deflect
