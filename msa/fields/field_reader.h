// Reads a tree into a description: each describe() requests its fields by key. Strict: a key that is not requested is
// an error. Of several errors in one map an unknown key is reported first, because it explains a missing one.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <type_traits>

#include "msa/fields/field_visitor.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {

/// A text that is made only when an error needs it. Refers to a callable, or to a text, that must outlive it.
class LaterText {
 public:
  template <class Make, class = std::enable_if_t<!std::is_same_v<std::decay_t<Make>, LaterText>>>
  LaterText(const Make& make)  // NOLINT: for arguments
      : from_(&make), make_([](const void* from) -> std::string {
          if constexpr (std::is_invocable_v<const Make&>)
            return (*static_cast<const Make*>(from))();
          else
            return *static_cast<const Make*>(from);
        }) {}
  std::string operator()() const { return make_(from_); }

 private:
  const void* from_;
  std::string (*make_)(const void*);
};

class FieldReader final : public FieldVisitor {
 public:
  /// Messages begin "origin:line: path: ", without a line where the tree has none. `path`: of the tree in its file.
  explicit FieldReader(std::string origin, std::string path = "")
      : origin_(std::move(origin)), path_(std::move(path)) {}

  /// Calls `fields` (a describe()) on the map `root`. Throws InputError where the map does not match.
  void read(const YamlNode& root, const std::function<void()>& fields);

  /// Reads the children of `map` as named entries.
  void read_entries(const YamlNode& map, Elements&);

  /// Paths of values with the tag !ours.
  const std::set<std::string>& ours() const { return ours_; }

  /// The numbers met that depend on a parameter.
  const Dependences& depends() const { return depends_; }

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
  void object(const char*, Need, bool, const std::function<void()>&, const char*) override;
  void entries(const char*, Elements&, Need, const char*) override;
  void list(const char*, Elements&, const char*) override;
  void one_or_list(const char*, Elements&, const char*) override;
  void others(Named<std::string>&, const char*) override;
  void keys(const std::vector<std::string>& all) override;
  std::size_t alternative(const std::vector<std::string>& keys, std::size_t) override;
  void require(bool, const char*, const std::string&) override;

 private:
  /// The map whose fields are being read.
  struct Level {
    const YamlNode* map = nullptr;
    const YamlNode* only = nullptr;  ///< the value of an entry that is not a map, under the key ""
    std::vector<const char*> asked;
    std::string missing, broken;  ///< complete messages, the first of each kind
  };

  std::string message(const YamlNode&, const std::string& path, const std::string& what) const;
  [[noreturn]] void fail(const YamlNode&, const std::string& path, const std::string& what) const;
  [[noreturn]] void refuse_key(std::size_t i, const std::vector<std::string>& known) const;
  void refuse_misspelt(const std::vector<std::string>& keys) const;
  const YamlNode* child(std::string_view key) const;
  const YamlNode* find(const char* key, bool needed, LaterText example, const char* about);
  const std::string& scalar(const YamlNode&, LaterText path, LaterText example) const;
  double number(const YamlNode&, LaterText path, const Quantity&, LaterText example);
  void elements(const YamlNode& list, Elements&);
  void element(const YamlNode&, const std::string& path, Elements&, std::size_t);
  void note(const YamlNode&, const std::string& path);
  void note_all(const YamlNode&, const std::string& path);

  std::string origin_, path_;
  Level level_;
  std::set<std::string> ours_;
  Dependences depends_;
};

}  // namespace deflect
