#include "validation/theories/theory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "msa/base/error.h"
#include "validation/theories/analytic_theory.h"
#include "validation/theories/msa_theory.h"

namespace deflect::theories {
namespace {

std::vector<std::string> names_of(const Theories& theories) {
  std::vector<std::string> names;
  for (const Theory* t : theories) names.push_back(t->name);
  return names;
}

}  // namespace

/// To add a theory: its file defines a function as analytic_theory() does; declare it here and give it a place in the
/// table.
const Theories& all_theories() {
  static const Theories table = {&analytic_theory(), &msa_theory()};
  return table;
}

const Theory& theory(const std::string& name) { return *all_theories()[place_of(all_theories(), name)]; }

Theories theories_named(const std::string& list) {
  if (list.empty()) return all_theories();
  std::vector<bool> wanted(all_theories().size(), false);
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t to = std::min(list.find(',', from), list.size());
    wanted[place_of(all_theories(), list.substr(from, to - from))] = true;
    from = to + 1;
  }
  Theories out;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) out.push_back(all_theories()[i]);
  return out;
}

std::size_t reference_of(const Theories& theories) {
  for (std::size_t i = theories.size(); i-- > 0;)
    if (theories[i]->known_to == 0) return i;
  return 0;
}

std::size_t place_of(const Theories& theories, const std::string& name) {
  for (std::size_t i = 0; i < theories.size(); ++i)
    if (theories[i]->name == name) return i;
  throw InputError(fmt::format("'{}' is no theory here: write {}", name, fmt::join(names_of(theories), " or ")));
}

std::string titles_of(const Theories& theories) {
  std::vector<std::string> titles;
  for (const Theory* t : theories) titles.push_back(t->title);
  if (titles.size() == 1) return titles.front();
  const std::string last = titles.back();
  titles.pop_back();
  return fmt::format("{} and {}", fmt::join(titles, ", "), last);
}

}  // namespace deflect::theories
