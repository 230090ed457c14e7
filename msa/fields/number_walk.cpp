#include "msa/fields/number_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {

void NumberMove::add(std::size_t index, double value, double shift) {
  shifts.emplace_back(index, shift);
  if (value != 0) relative = std::max(relative, std::abs(shift / value));
}

void NumberWalk::quantity(const char* key, double& x, const Quantity& q, const char*) {
  number(key, x, q.dimension);
  if (!q.range.holds(x)) throw InputError(fmt::format("{}: {} is out of its range", key, x));
}

void NumberWalk::quantity_if_given(const char* key, std::optional<double>& x, const Quantity& q, const char* about) {
  if (x) quantity(key, *x, q, about);
}

void NumberWalk::quantity_or_word(const char* key, double& x, const Quantity& q, std::string& word,
                                  const std::vector<std::string>&, const char* about) {
  if (word.empty()) quantity(key, x, q, about);
}

void NumberWalk::vector3(const char* key, Vector3& x, Dimension d, const char*) {
  inside(key, [&] {
    for (Eigen::Index i = 0; i < 3; ++i) at_index(as_size(i), [&] { number("", x(i), d); });
  });
}

void NumberWalk::matrix(const char* key, MatrixX& x, Eigen::Index, Need, const char*) {
  const auto rows = [&] {
    for (Eigen::Index i = 0; i < x.rows(); ++i) row(i, x);
  };
  inside(key, rows);
}

void NumberWalk::pairs(const char* key, Pairs& values, const std::array<Dimension, 2>& dimensions, Need, const char*) {
  inside(key, [&] {
    for (std::size_t i = 0; i < values.size(); ++i)
      at_index(i, [&] {
        for (std::size_t k = 0; k < 2; ++k) at_index(k, [&] { number("", values[i][k], dimensions[k]); });
      });
  });
}

void NumberWalk::word_or_object(const char* key, std::string&, const Words&, bool more,
                                const std::function<void()>& fields, const char*) {
  if (more) inside(key, fields);
}

void NumberWalk::object(const char* key, Need, bool absent, const std::function<void()>& fields, const char*) {
  if (!absent) inside(key, fields);
}

void NumberWalk::require(bool holds, const char* key, const std::string& what) {
  if (!holds) throw InputError(fmt::format("{}: {}", key, what));
}

void NumberWalk::each(const char* key, Elements& all, bool named) {
  inside(key, [&] {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto element = [&] { all.describe_element(*this, i); };
      named ? inside(all.name(i).c_str(), element) : at_index(i, element);
    }
  });
}

void NumberWalk::row(Eigen::Index i, MatrixX& x) {
  at_index(as_size(i), [&] {
    for (Eigen::Index j = 0; j < x.cols(); ++j) at_index(as_size(j), [&] { number("", x(i, j), Dimension::none); });
  });
}

void NumberList::number(const char* key, double& x, Dimension d) { found.push_back({joined(path_, key), d, x}); }

void NumberList::inside(const char* key, const std::function<void()>& fields) {
  const bool resolved = path_.empty() && !leg.empty();
  under(joined(path_, resolved ? leg : key), fields);
}

void NumberList::at_index(std::size_t i, const std::function<void()>& fields) {
  under(joined(path_, std::to_string(i)), fields);
}

void NumberList::under(std::string path, const std::function<void()>& fields) {
  const std::string outer = std::exchange(path_, std::move(path));
  fields();
  path_ = outer;
}

}  // namespace deflect
