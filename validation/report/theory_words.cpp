#include "validation/report/theory_words.h"

#include <fmt/format.h>

namespace deflect::report {

Json json_theories(const theories::Theories& theories) {
  Json list = Json::array();
  for (const theories::Theory* theory : theories)
    list.push_back({{"name", theory->name}, {"title", theory->title}, {"spoken", theory->spoken}});
  return list;
}

std::string against_text(const theories::Theories& theories) {
  if (theories.size() < 2) return "";
  if (theories.size() == 2) return fmt::format("{} against {}", theories[0]->title, theories[1]->title);
  return theories::titles_of(theories) + " against each other";
}

}  // namespace deflect::report
