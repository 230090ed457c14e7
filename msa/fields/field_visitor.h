// What sees the fields of a struct, one after the other: a reader, a writer, a schema. Reading, writing and editing all
// go through describe(visitor, struct), one list of fields for every struct: a field added there is known to all.
#pragma once

#include <algorithm>
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

/// What a number may be: between the bounds, which are included unless `open`.
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
};

struct Words {
  const char* what;  ///< "material", "joint type": for messages
  std::vector<std::string> allowed;
  std::optional<std::string> otherwise;
  bool decides = false;  ///< which fields follow depends on this word
};

enum class Need { required, optional };

/// A list or a map of named entries, seen element by element.
class Elements {
 public:
  virtual ~Elements() = default;
  virtual std::size_t size() const = 0;
  virtual std::string name(std::size_t) const = 0;  ///< "" in a list
  virtual void add(const std::string& name) = 0;
  virtual void describe_element(class FieldVisitor&, std::size_t) = 0;
  virtual bool plain() const { return false; }        ///< an entry is one value, which is described under the key ""
  virtual bool loose_names() const { return false; }  ///< a name may begin with a digit and hold spaces
};

/// What the description says elsewhere and a field depends on.
struct Surroundings {
  const Named<Material>* materials = nullptr;
  const Named<Section>* sections = nullptr;
  bool chains = false;                     ///< parts are placed by walking, not at named places
  std::vector<std::string> points, axes;   ///< the named places
  std::vector<std::string> earlier_parts;  ///< of the chain, before the part described
  int legs = 0;
  bool rotation = false;    ///< the laws described act on a rotation
  bool on_actuator = true;  ///< they stand in a leg, whose actuator has an extension
  bool beside = false;      ///< the joint stands beside a leg
};

/// Keys are those of the file; `about` is one phrase for messages and documentation.
class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;

  virtual void quantity(const char* key, double&, const Quantity&, const char* about) = 0;
  virtual void quantity_if_given(const char* key, std::optional<double>&, const Quantity&, const char* about) = 0;
  virtual void integer(const char* key, int&, int low, int high, const char* about) = 0;
  /// Zero where absent; without a dimension it is a direction, which is not zero where it is given.
  virtual void vector3(const char* key, Vector3&, Dimension, const char* about) = 0;
  /// Plain numbers, as many rows as columns; `size` of them, or any number where it is 0. Empty where absent.
  virtual void matrix(const char* key, MatrixX&, Eigen::Index size, Need, const char* about) = 0;
  virtual void text(const char* key, std::string&, Need, const char* about) = 0;
  virtual void texts(const char* key, std::vector<std::string>&, Need, const char* about) = 0;  ///< one or a list
  virtual void word(const char* key, std::string&, const Words&, const char* about) = 0;
  virtual void any(const char* key, std::string& yaml, const char* about) = 0;  ///< YAML, kept in flow style
  /// A word, or where more is to be said (`more`, when it is written) fields one level down, the word among them.
  virtual void word_or_object(const char* key, std::string&, const Words&, bool more,
                              const std::function<void()>& fields, const char* about) = 0;

  /// Fields one level down. `absent`: the struct holds what it holds when the file says nothing.
  virtual void object(const char* key, Need, bool absent, const std::function<void()>& fields, const char* about) = 0;
  virtual void entries(const char* key, Elements&, Need, const char* about) = 0;
  virtual void list(const char* key, Elements&, const char* about) = 0;
  virtual void one_or_list(const char* key, Elements&, const char* about) = 0;

  /// Every key of this map that no field above asked for, each with a single value, kept as text. Called last.
  virtual void others(Named<std::string>&, const char* about) = 0;

  /// The keys of this map, told beforehand where fields below refer to others: an unknown one is told first.
  virtual void keys(const std::vector<std::string>& all) = 0;

  /// The index of the key that is there; exactly one must be.
  virtual std::size_t alternative(const std::vector<std::string>& keys, std::size_t current) = 0;

  /// A condition across fields; `what` says what is wrong and the way out. Called after the fields it is about.
  virtual void require(bool holds, const char* key, const std::string& what) = 0;

  Surroundings surroundings;
};

/// One of an enumeration by its name, the first where absent. `names` in the order of the enumeration.
template <class Enum>
void choice(FieldVisitor& v, const char* key, Enum& value, const char* what, std::span<const char* const> names,
            const char* about) {
  std::string name = nth(names, value);
  v.word(key, name, {what, {names.begin(), names.end()}, names[0]}, about);
  value = static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// `name`, required: one line that a report, a file's name and a picture can carry.
void describe_name(FieldVisitor&, std::string& name, const char* about);

}  // namespace deflect
