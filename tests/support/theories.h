// What the two theories of the table say in a result of both.
#pragma once

#include "validation/studies/map.h"
#include "validation/studies/solve.h"
#include "validation/studies/validate.h"

namespace deflect::test {

template <class Result>
decltype(auto) by(std::size_t theory, Result& r) {
  if constexpr (requires { r.solutions; })
    return (r.solutions.at(theory));
  else if constexpr (requires { r.displacements; })
    return (r.displacements.at(theory));
  else if constexpr (requires { r.offsets_mm_rad; })
    return (r.offsets_mm_rad.at(theory));
  else
    return (r.values.at(theory));
}

template <class Result>
decltype(auto) analytic(Result& r) {
  return by(0, r);
}
template <class Result>
decltype(auto) msa(Result& r) {
  return by(1, r);
}

}  // namespace deflect::test
