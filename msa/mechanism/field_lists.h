// Helpers shared by the field lists of fields.cpp and part_fields.cpp.
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "msa/base/index.h"
#include "msa/mechanism/fields.h"

namespace deflect {

inline Quantity required(Dimension d, Range range = positive) { return {d, range, std::nullopt, std::nullopt}; }
inline Quantity optional(double otherwise, Dimension d, Range range) { return {d, range, otherwise, std::nullopt}; }
inline Quantity length() { return required(Dimension::length); }
inline Quantity area() { return required(Dimension::area); }

template <class T>
std::vector<std::string> names(const Named<T>* list) {
  std::vector<std::string> out;
  if (list)
    for (const auto& [name, value] : *list) out.push_back(name);
  return out;
}

inline std::size_t index_of(std::span<const char* const> all, const std::string& name) {
  return as_size(std::find(all.begin(), all.end(), name) - all.begin());
}

/// Switches the variant to the alternative `index`, default-constructed unless it holds that already.
template <class... Ts>
void become(std::variant<Ts...>& variant, std::size_t index) {
  if (index == variant.index()) return;
  const auto make = [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((index == I ? static_cast<void>(variant.template emplace<I>()) : void()), ...);
  };
  make(std::index_sequence_for<Ts...>());
}

inline void describe_placement(FieldVisitor& v, const char* key, Placement& p, const char* about) {
  v.object(
      key, Need::optional, false, [&] { describe(v, p); }, about);
}

/// An optional object.
template <class T>
void describe_if_given(FieldVisitor& v, const char* key, std::optional<T>& value, const char* about,
                       const auto& fields_of) {
  T given = value.value_or(T());
  const bool absent = !value;
  value.reset();
  const auto body = [&] {
    fields_of(given);
    value = given;
  };
  v.object(key, Need::if_given, absent, body, about);
}

/// `key: name` selects the alternative of the variant; its fields follow.
template <class V>
void tagged(FieldVisitor& v, V& variant, const char* key, const char* what, std::span<const char* const> all,
            const char* about, const auto& fields_of) {
  std::string name = all[variant.index()];
  v.word(key, name, {what, {all.begin(), all.end()}, std::nullopt, true}, about);
  become(variant, index_of(all, name));
  std::visit(fields_of, variant);
}

inline void material_of(FieldVisitor& v, std::string& material) {
  v.word("material", material, {"material", names(v.surroundings.materials), std::nullopt}, "name of a material");
}

void describe_workspace(FieldVisitor&, Workspace&);
void describe_rig(FieldVisitor&, LoadCell&, Sensor&, std::vector<std::string>& trusted);

/// base and tool: joints at a given place, rigid except where they have a law.
void describe_fixture(FieldVisitor&, const char* key, Joint&, const char* at, const char* axes, const char* about);

}  // namespace deflect
