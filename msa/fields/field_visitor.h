// Visitor of the fields of a struct: a reader, a writer or a schema. Reading, writing and editing all use
// describe(visitor, struct), one list of fields for each struct, so that a field needs to be added only there.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "msa/base/index.h"
#include "msa/base/spatial.h"
#include "msa/base/units.h"
#include "msa/fields/named.h"

namespace deflect {

struct Material;
struct Section;

using Pairs = std::vector<std::array<double, 2>>;

/// Allowed range of a number; the bounds are included unless `open`.
struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool open = false;

  bool holds(double x) const { return open ? low < x && x < high : low <= x && x <= high; }
};
inline constexpr Range not_negative{0}, positive{0, std::numeric_limits<double>::infinity(), true};

struct Quantity {
  Dimension dimension = Dimension::none;
  Range range;
  std::optional<double> otherwise;  ///< SI value where the field is absent; a field without it is required
  std::optional<Dimension> or_dimension = std::nullopt;  ///< that it has instead by another field: for schemas
};

struct Words {
  const char* what;  ///< "material", "joint type": for messages
  std::vector<std::string> allowed;
  std::optional<std::string> otherwise;
  bool decides = false;  ///< the fields that follow depend on this word
};

/// if_given: that it is there counts, even where all in it is left out.
enum class Need { required, optional, if_given };

/// A list, or a map of named entries, accessed element by element.
class Elements {
 public:
  virtual ~Elements() = default;
  virtual std::size_t size() const = 0;
  virtual std::string name(std::size_t) const = 0;  ///< "" in a list
  virtual void add(const std::string& name) = 0;
  virtual void describe_element(class FieldVisitor&, std::size_t) = 0;
  virtual bool plain() const { return false; }        ///< each entry is one value, described under the key ""
  virtual bool loose_names() const { return false; }  ///< names may begin with a digit and contain spaces
};

/// Data from other places of the description that fields depend on.
struct Surroundings {
  const Named<Material>* materials = nullptr;
  const Named<Section>* sections = nullptr;
  bool chains = false;                     ///< parts are placed one after the other, not at named points
  std::vector<std::string> points, axes;   ///< the named points and axes
  std::vector<std::string> earlier_parts;  ///< of the chain, before the part described
  int legs = 0;
  bool rotation = false;      ///< the laws described act on a rotation
  bool on_actuator = true;    ///< they are in a leg whose actuator has an extension
  bool beside = false;        ///< the joint is in parallel with a leg
  bool side_by_side = false;  ///< the laws described stand side by side with laws of the same freedom
};

/// Keys are those of the file; `about` is one phrase for messages and documentation.
class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;

  virtual void quantity(const char* key, double&, const Quantity&, const char* about) = 0;
  virtual void quantity_if_given(const char* key, std::optional<double>&, const Quantity&, const char* about) = 0;
  /// A number or a word, which is empty where a number stands. `of`: the words.
  virtual void quantity_or_word(const char* key, double&, const Quantity&, std::string& word,
                                const std::vector<std::string>& of, const char* about) = 0;
  virtual void integer(const char* key, int&, int low, int high, const char* about) = 0;
  /// Zero where absent. Without a dimension it is a direction, which must not be zero where given.
  virtual void vector3(const char* key, Vector3&, Dimension, const char* about) = 0;
  /// A square matrix of plain numbers with `size` rows, or any number of rows where `size` is 0. Empty where absent.
  virtual void matrix(const char* key, MatrixX&, Eigen::Index size, Need, const char* about) = 0;
  /// A list of pairs, [[0 N, 0 mm], [50 N, 0.02 mm]], each number of its dimension. Empty where absent.
  virtual void pairs(const char* key, Pairs&, const std::array<Dimension, 2>&, Need, const char* about) = 0;
  virtual void text(const char* key, std::string&, Need, const char* about) = 0;
  virtual void texts(const char* key, std::vector<std::string>&, Need, const char* about) = 0;  ///< one text or a list
  virtual void word(const char* key, std::string&, const Words&, const char* about) = 0;
  /// YAML, kept in flow style. `example`: what may stand there, for messages.
  virtual void any(const char* key, std::string& yaml, const char* example, const char* about) = 0;
  /// A word, or a map of fields that contains the word. `more`: the writer must write the map.
  virtual void word_or_object(const char* key, std::string&, const Words&, bool more,
                              const std::function<void()>& fields, const char* about) = 0;

  /// A map of fields. `absent`: the struct has the values that it has where the file omits the map.
  virtual void object(const char* key, Need, bool absent, const std::function<void()>& fields, const char* about) = 0;
  virtual void entries(const char* key, Elements&, Need, const char* about) = 0;
  virtual void list(const char* key, Elements&, const char* about) = 0;
  virtual void one_or_list(const char* key, Elements&, const char* about) = 0;

  /// Every key of this map that is a path (contains a dot), each with a single value, kept as text. Called last.
  virtual void others(Named<std::string>&, const char* about) = 0;

  /// Announces all keys of this map where fields further down refer to others, so that an unknown key is reported
  /// first.
  virtual void keys(const std::vector<std::string>& all) = 0;

  /// Index of the key that is present; exactly one must be.
  virtual std::size_t alternative(const std::vector<std::string>& keys, std::size_t current) = 0;

  /// A condition on several fields; `what` is the error with its remedy. Called after the fields concerned.
  virtual void require(bool holds, const char* key, const std::string& what) = 0;

  Surroundings surroundings;
};

/// A value of an enumeration by its name; the first where absent. `names`: in the order of the enumeration.
template <class Enum>
void choice(FieldVisitor& v, const char* key, Enum& value, const char* what, std::span<const char* const> names,
            const char* about) {
  std::string name = nth(names, value);
  v.word(key, name, {what, {names.begin(), names.end()}, names[0]}, about);
  value = static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The required field `name`: one line, usable in reports, file names and figures.
void describe_name(FieldVisitor&, std::string& name, const char* about);

}  // namespace deflect
