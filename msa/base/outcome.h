// Errors as values, for work whose failure is a normal result: an unreachable pose, an effect without a place, a trial
// value with which a machine cannot stand. Only this header catches errors, prefixes them with a place, and passes them
// between threads.
#pragma once

#include <exception>
#include <optional>
#include <string>
#include <type_traits>

#include "msa/base/error.h"

namespace deflect {

/// The result of some work, or why it failed.
template <class T>
struct Outcome {
  std::optional<T> value;
  std::string why;  ///< without a value: the message, and the cause where the model is impossible
  Cause cause = {};

  explicit operator bool() const { return value.has_value(); }
  const T& operator*() const { return *value; }
  T& operator*() { return *value; }
  const T* operator->() const { return &*value; }
};

/// The outcome of work(). Exceptions that are not of type `Error` pass through.
template <class Error = Refusal, class F>
auto outcome_of(const F& work) -> Outcome<std::decay_t<decltype(work())>> {
  try {
    return {work(), ""};
  } catch (const Error& e) {
    const auto* model = dynamic_cast<const ModelError*>(&e);
    return {std::nullopt, e.what(), model ? model->cause : Cause()};
  }
}

/// Returns work(). Messages of its exceptions of type `Error` get the prefix place(), such as "leg 3: "; the cause is
/// kept.
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

/// The exception that work() threw, to be rethrown in another thread or process; null: none.
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
