// The switch of mutation testing: all faults are compiled in, the environment variable DEFLECT_MUTANT chooses one of
// them by its number (0: none). Put in front of mutated copies of sources by tests/mutation/run; no part of the
// program.
//
// Without a chosen fault every expression has the value that it has in the source, to the bit: factors are 1.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <type_traits>

namespace deflect::mutation {

inline constexpr int most = 20'000;
inline const int chosen = [] {
  const char* text = std::getenv("DEFLECT_MUTANT");
  return text ? std::atoi(text) : 0;
}();
/// Faults whose place was passed since it was cleared; by number.
inline unsigned char reached[most];

inline bool is(int number) {
  reached[number] = 1;
  return chosen == number;
}

/// A factor on what stands behind it: `by` where the fault is chosen, else 1.
struct Factor {
  double value;
};
inline Factor factor(int number, double by) { return {is(number) ? by : 1.0}; }

template <class T>
auto operator*(Factor f, const T& x) {
  if constexpr (std::is_integral_v<T>)
    return f.value == 1
               ? x
               : static_cast<T>(static_cast<long long>(f.value * static_cast<double>(static_cast<long long>(x))));
  else
    return f.value * x;
}

template <class T>
auto operator*(const T& x, Factor f) {
  return f * x;
}

/// 1 where the fault is chosen, else 0.
inline int one(int number) { return is(number) ? 1 : 0; }

/// The smaller where the fault is chosen, else the larger; `smallest` the other way round.
template <class T>
T largest(int number, const T& a, const T& b) {
  return is(number) ? std::min(a, b) : std::max(a, b);
}
template <class T>
T smallest(int number, const T& a, const T& b) {
  return is(number) ? std::max(a, b) : std::min(a, b);
}

}  // namespace deflect::mutation
