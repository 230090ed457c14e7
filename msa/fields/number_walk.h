// Walks over every number of a description in the order of its field lists, to read or replace them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "msa/fields/field_visitor.h"

namespace deflect {

struct DescribedNumber {
  /// As fields nest in the file: "materials.steel.E", "leg.elbow.rz.0.stiffness", "mounts.2.base.shift.0"; in a leg of
  /// a resolved mechanism "leg[3].elbow.rz.0.stiffness".
  std::string path;
  Dimension dimension = Dimension::none;
  double value = 0;  ///< SI
};

/// One standard deviation of one tolerance, as changes of numbers.
struct NumberMove {
  std::string name;  ///< "leg 2 elbow rz stiffness", "steel E", "leg 1 forearm length"
  double sigma = 0;  ///< as declared: relative, or SI
  std::vector<std::pair<std::size_t, double>> shifts = {};  ///< index of the number, what is added to it
  double relative = 0;  ///< the largest of these relative to its number; 0 for numbers that are 0

  /// Adds `shift` to a number of this value.
  void add(std::size_t index, double value, double shift);
};

/// Visits every number. Throws InputError "KEY: …" where one lies outside its range, or numbers contradict each other.
class NumberWalk : public FieldVisitor {
 public:
  void quantity(const char* key, double&, const Quantity&, const char*) override;
  void quantity_if_given(const char* key, std::optional<double>&, const Quantity&, const char*) override;
  void quantity_or_word(const char* key, double&, const Quantity&, std::string& word, const std::vector<std::string>&,
                        const char*) override;
  void vector3(const char* key, Vector3&, Dimension, const char*) override;
  void matrix(const char* key, MatrixX&, Eigen::Index, Need, const char*) override;
  void pairs(const char* key, Pairs&, const std::array<Dimension, 2>&, Need, const char*) override;
  void integer(const char*, int&, int, int, const char*) override {}
  void text(const char*, std::string&, Need, const char*) override {}
  void texts(const char*, std::vector<std::string>&, Need, const char*) override {}
  void word(const char*, std::string&, const Words&, const char*) override {}
  void any(const char*, std::string&, const char*, const char*) override {}
  void word_or_object(const char* key, std::string&, const Words&, bool more, const std::function<void()>& fields,
                      const char*) override;
  void object(const char* key, Need, bool absent, const std::function<void()>& fields, const char*) override;
  void entries(const char* key, Elements& all, Need, const char*) override { each(key, all, true); }
  void list(const char* key, Elements& all, const char*) override { each(key, all, false); }
  void one_or_list(const char* key, Elements& all, const char*) override { each(key, all, false); }
  void others(Named<std::string>&, const char*) override {}
  void keys(const std::vector<std::string>&) override {}
  std::size_t alternative(const std::vector<std::string>&, std::size_t current) override { return current; }
  void require(bool holds, const char* key, const std::string& what) override;

 protected:
  virtual void number(const char* key, double&, Dimension) = 0;
  /// fields(), which describe what stands under the key or at the index.
  virtual void inside(const char*, const std::function<void()>& fields) { fields(); }
  virtual void at_index(std::size_t, const std::function<void()>& fields) { fields(); }

 private:
  void each(const char* key, Elements&, bool named);
  void row(Eigen::Index, MatrixX&);
};

/// Calls f(index, number) for each; f may change it.
class NumberCalls final : public NumberWalk {
 public:
  explicit NumberCalls(const std::function<void(std::size_t, double&)>& f) : f_(f) {}

 private:
  void number(const char*, double& x, Dimension) override { f_(index_++, x); }

  const std::function<void(std::size_t, double&)>& f_;
  std::size_t index_ = 0;
};

/// Lists them, in the same order.
class NumberList final : public NumberWalk {
 public:
  std::vector<DescribedNumber> found;
  std::string leg;  ///< "leg[3]" while the key "leg" stands for it

 private:
  void number(const char* key, double&, Dimension) override;
  void inside(const char* key, const std::function<void()>& fields) override;
  void at_index(std::size_t, const std::function<void()>& fields) override;
  void under(std::string path, const std::function<void()>& fields);

  std::string path_;
};

}  // namespace deflect
