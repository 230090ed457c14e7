// Values as bytes and back, for processes of one program: cereal, with Eigen's matrices of fixed size. A type takes
// part by a serialize() that lists its fields.
#pragma once

#include <Eigen/Core>
#include <cereal/archives/binary.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>
#include <string>

#include "msa/base/index.h"

namespace Eigen {

template <class Archive, int rows, int cols>
void serialize(Archive& a, Matrix<double, rows, cols>& x) {
  static_assert(rows > 0 && cols > 0);
  a(cereal::binary_data(x.data(), deflect::as_size(x.size()) * sizeof(double)));
}

}  // namespace Eigen

namespace deflect::parallel {

template <class T>
std::string pack(const T& value) {
  std::ostringstream out(std::ios::binary);
  cereal::BinaryOutputArchive{out}(value);
  return out.str();
}

template <class T>
T unpack(const std::string& bytes) {
  T value;
  std::istringstream in(bytes, std::ios::binary);
  cereal::BinaryInputArchive{in}(value);
  return value;
}

}  // namespace deflect::parallel
