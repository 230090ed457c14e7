#include "validation/compare/history.h"

#include "validation/compare/placebo.h"

namespace deflect::compare {

History history(const std::vector<Comparison>& versions) {
  History h{versions, {std::nullopt}};
  for (std::size_t i = 1; i < versions.size(); ++i) h.placebo.emplace_back(placebo_rmse(versions[i - 1], versions[i]));
  return h;
}

}  // namespace deflect::compare
