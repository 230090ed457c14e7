#include "msa/mechanism/numbers.h"

#include <fmt/format.h>

#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/fields.h"

namespace deflect {
namespace {

/// Visits every number, in the order of the field lists.
class NumberWalk : public FieldVisitor {
 public:
  void quantity(const char* key, double& x, const Quantity& q, const char*) override {
    number(key, x, q.dimension);
    if (!q.range.holds(x)) throw InputError(fmt::format("{}: {} is out of its range", key, x));
  }
  void quantity_if_given(const char* key, std::optional<double>& x, const Quantity& q, const char* about) override {
    if (x) quantity(key, *x, q, about);
  }
  void quantity_or_word(const char* key, double& x, const Quantity& q, std::string& word,
                        const std::vector<std::string>&, const char* about) override {
    if (word.empty()) quantity(key, x, q, about);
  }
  void vector3(const char* key, Vector3& x, Dimension d, const char*) override { all_of(key, x, d); }
  void matrix(const char* key, MatrixX& x, Eigen::Index, Need, const char*) override {
    const auto rows = [&] {
      for (Eigen::Index i = 0; i < x.rows(); ++i) row(i, x);
    };
    inside(key, rows);
  }
  void integer(const char*, int&, int, int, const char*) override {}
  void text(const char*, std::string&, Need, const char*) override {}
  void texts(const char*, std::vector<std::string>&, Need, const char*) override {}
  void word(const char*, std::string&, const Words&, const char*) override {}
  void any(const char*, std::string&, const char*, const char*) override {}
  void word_or_object(const char* key, std::string&, const Words&, bool more, const std::function<void()>& fields,
                      const char*) override {
    if (more) inside(key, fields);
  }
  void object(const char* key, Need, bool absent, const std::function<void()>& fields, const char*) override {
    if (!absent) inside(key, fields);
  }
  void entries(const char* key, Elements& all, Need, const char*) override { each(key, all, true); }
  void list(const char* key, Elements& all, const char*) override { each(key, all, false); }
  void one_or_list(const char* key, Elements& all, const char*) override { each(key, all, false); }
  void others(Named<std::string>&, const char*) override {}
  void keys(const std::vector<std::string>&) override {}
  std::size_t alternative(const std::vector<std::string>&, std::size_t current) override { return current; }
  void require(bool holds, const char* key, const std::string& what) override {
    if (!holds) throw InputError(fmt::format("{}: {}", key, what));
  }

 protected:
  virtual void number(const char* key, double&, Dimension) = 0;
  /// fields(), which describe what stands under the key or at the index.
  virtual void inside(const char*, const std::function<void()>& fields) { fields(); }
  virtual void at_index(std::size_t, const std::function<void()>& fields) { fields(); }

 private:
  void each(const char* key, Elements& all, bool named) {
    inside(key, [&] {
      for (std::size_t i = 0; i < all.size(); ++i) {
        const auto element = [&] { all.describe_element(*this, i); };
        named ? inside(all.name(i).c_str(), element) : at_index(i, element);
      }
    });
  }
  void all_of(const char* key, Vector3& x, Dimension d) {
    inside(key, [&] {
      for (Eigen::Index i = 0; i < 3; ++i) at_index(as_size(i), [&] { number("", x(i), d); });
    });
  }
  void row(Eigen::Index i, MatrixX& x) {
    at_index(as_size(i), [&] {
      for (Eigen::Index j = 0; j < x.cols(); ++j) at_index(as_size(j), [&] { number("", x(i, j), Dimension::none); });
    });
  }
};

class Calls final : public NumberWalk {
 public:
  explicit Calls(const std::function<void(std::size_t, double&)>& f) : f_(f) {}

 private:
  void number(const char*, double& x, Dimension) override { f_(index_++, x); }

  const std::function<void(std::size_t, double&)>& f_;
  std::size_t index_ = 0;
};

class Describes final : public NumberWalk {
 public:
  std::vector<DescribedNumber> found;
  std::string leg;  ///< "leg[3]" while the key "leg" stands for it

 private:
  void number(const char* key, double& x, Dimension d) override { found.push_back({joined(path_, key), d, x}); }
  void inside(const char* key, const std::function<void()>& fields) override {
    const bool resolved = path_.empty() && !leg.empty();
    under(joined(path_, resolved ? leg : key), fields);
  }
  void at_index(std::size_t i, const std::function<void()>& fields) override {
    under(joined(path_, std::to_string(i)), fields);
  }
  void under(std::string path, const std::function<void()>& fields) {
    const std::string outer = std::exchange(path_, std::move(path));
    fields();
    path_ = outer;
  }

  std::string path_;
};

}  // namespace

void for_each_number(Mechanism& m, const std::function<void(std::size_t, double&)>& f) {
  Calls walk(f);
  describe(walk, m);
  walk.surroundings = surroundings_of(m);
  for (Named<Part>& leg : m.legs) describe_leg(walk, leg);
}

std::vector<double> numbers_of(const Mechanism& m) {
  Mechanism copy = m;
  std::vector<double> out;
  for_each_number(copy, [&](std::size_t, double& x) { out.push_back(x); });
  return out;
}

std::vector<DescribedNumber> described_numbers(const Mechanism& m) {
  Mechanism copy = m;
  Describes walk;
  describe(walk, copy);
  walk.surroundings = surroundings_of(copy);
  for (std::size_t i = 0; i < copy.legs.size(); ++i) {
    walk.leg = fmt::format("leg[{}]", i + 1);
    describe_leg(walk, copy.legs[i]);
  }
  return std::move(walk.found);
}

}  // namespace deflect
