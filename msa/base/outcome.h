// Work whose refusal is one of its answers, not the end: a pose that is out of reach, an effect that has no place, a
// trial value with which a machine does not stand. Errors become values, are told with their place, and change threads
// here and nowhere else.
#pragma once

#include <exception>
#include <optional>
#include <string>
#include <type_traits>

#include "msa/base/error.h"

namespace deflect {

/// What some work gave, or why it was refused.
template <class T>
struct Outcome {
  std::optional<T> value;
  std::string why;  ///< refused: in words, and as data where the model is impossible
  Cause cause = {};

  explicit operator bool() const { return value.has_value(); }
  const T& operator*() const { return *value; }
  T& operator*() { return *value; }
  const T* operator->() const { return &*value; }
};

/// The outcome of work(). Errors of another kind than `Error` are thrown on.
template <class Error = Refusal, class F>
auto outcome_of(const F& work) -> Outcome<std::decay_t<decltype(work())>> {
  try {
    return {work(), ""};
  } catch (const Error& e) {
    const auto* model = dynamic_cast<const ModelError*>(&e);
    return {std::nullopt, e.what(), model ? model->cause : Cause()};
  }
}

/// work(); its refusals of the kind `Error` begin with what place() says, "leg 3: ". Their cause stays.
template <class Error, class Place, class F>
decltype(auto) told_at(const Place& place, const F& work) {
  try {
    return work();
  } catch (const Error& e) {
    if constexpr (std::is_same_v<Error, ModelError>)
      throw ModelError(place() + e.what(), e.cause);
    else
      throw Error(place() + e.what());
  }
}

/// What work() threw, whatever it was, to be thrown on in another thread or process; null: nothing.
template <class F>
std::exception_ptr thrown_by(const F& work) noexcept {
  try {
    work();
    return nullptr;
  } catch (...) {
    return std::current_exception();
  }
}

}  // namespace deflect
