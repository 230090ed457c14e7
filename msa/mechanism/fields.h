// The one list of fields of every struct of the description. Reading, writing and editing all go through
// describe(visitor, struct): a field added there is known to all three.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "msa/base/units.h"
#include "msa/mechanism/description.h"

namespace deflect {

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

  /// The keys of this map, told beforehand where fields below refer to others: an unknown one is told first.
  virtual void keys(const std::vector<std::string>& all) = 0;

  /// The index of the key that is there; exactly one must be.
  virtual std::size_t alternative(const std::vector<std::string>& keys, std::size_t current) = 0;

  /// A condition across fields; `what` says what is wrong and the way out. Called after the fields it is about.
  virtual void require(bool holds, const char* key, const std::string& what) = 0;

  Surroundings surroundings;
};

/// `name`, required: one line that a report, a file's name and a picture can carry.
void describe_name(FieldVisitor&, std::string& name, const char* about);

void describe(FieldVisitor&, Mechanism&);
void describe(FieldVisitor&, Material&);
void describe(FieldVisitor&, Section&);
void describe(FieldVisitor&, Part&);
void describe(FieldVisitor&, Law&);
/// A joint beside the legs.
void describe(FieldVisitor&, Joint&);
void describe(FieldVisitor&, Variation&);
/// The part of that index of a chain.
void describe(FieldVisitor&, Named<Part>& chain, std::size_t);
void describe(FieldVisitor&, Mount&);
void describe(FieldVisitor&, Misfit&);
void describe(FieldVisitor&, LegDeviation&);
void describe(FieldVisitor&, Placement&);
void describe(FieldVisitor&, PolygonSpace::Corner&);

/// Only the field `leg` of a mechanism whose other parts are in `surroundings`.
void describe_leg(FieldVisitor&, Named<Part>&);
Surroundings surroundings_of(const Mechanism&);

template <class T>
class NamedElements final : public Elements {
 public:
  explicit NamedElements(Named<T>& list) : list_(list) {}
  std::size_t size() const override { return list_.size(); }
  std::string name(std::size_t i) const override { return list_[i].first; }
  void add(const std::string& name) override { list_.emplace_back(name, T()); }
  void describe_element(FieldVisitor& v, std::size_t i) override {
    if constexpr (std::is_same_v<T, Part>)
      describe(v, list_, i);
    else
      describe(v, list_[i].second);
  }

 private:
  Named<T>& list_;
};

template <class T>
class ListElements final : public Elements {
 public:
  explicit ListElements(std::vector<T>& list) : list_(list) {}
  std::size_t size() const override { return list_.size(); }
  std::string name(std::size_t) const override { return ""; }
  void add(const std::string&) override { list_.emplace_back(); }
  void describe_element(FieldVisitor& v, std::size_t i) override { describe(v, list_[i]); }

 private:
  std::vector<T>& list_;
};

}  // namespace deflect
