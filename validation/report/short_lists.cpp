#include "validation/report/short_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/number_words.h"
#include "validation/report/text.h"
#include "validation/report/verdict_words.h"

namespace deflect::report {
namespace {

constexpr std::size_t most_shown = 6;

std::string and_more(std::size_t all) {
  return all > most_shown ? fmt::format(", … and {} more: --json has all", all - most_shown) : "";
}

}  // namespace

std::string sizes_of(const diagnosis::Detectable& e) {
  if (e.smallest.empty()) return "none within bounds";
  std::string out;
  for (std::size_t i = 0; i < e.smallest.size(); ++i)
    out += fmt::format("{}{} {}", i ? ", " : "", e.effect.effect->parameters[i].name, digits_of(e.smallest[i], 3));
  return out;
}

std::string strained_words(std::vector<std::pair<std::string, double>> strained) {
  std::stable_sort(strained.begin(), strained.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
  std::string out;
  for (std::size_t i = 0; i < std::min(most_shown, strained.size()); ++i)
    out += fmt::format("{}{} {}{:.1f}", i ? ", " : "", strained[i].first, strained[i].second < 0 ? "−" : "+",
                       std::abs(strained[i].second));
  return out + and_more(strained.size());
}

Json strained_json(const std::vector<std::pair<std::string, double>>& strained) {
  Json out = Json::array();
  for (const auto& [name, eta] : strained) out.push_back({{"name", name}, {"sigmas", eta}});
  return out;
}

std::string left_out_words(const std::vector<diagnosis::LeftOut>& all) {
  if (all.empty()) return "";
  std::string out = "not looked at: ";
  for (std::size_t i = 0; i < std::min(most_shown, all.size()); ++i)
    out += fmt::format("{}{}", i ? ", " : "", all[i].effect);
  return out + (all.size() > most_shown ? and_more(all.size()) + ", with the reasons\n" : " (why: --json)\n");
}

Json left_out_json(const std::vector<diagnosis::LeftOut>& all) {
  Json out = Json::array();
  for (const diagnosis::LeftOut& e : all) out.push_back({{"effect", e.effect}, {"why", e.why}});
  return out;
}

Json rows_json(const MatrixX& m, const std::string& what) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < m.cols(); ++k) row.push_back(json::json_number(m(i, k), what));
    out.push_back(std::move(row));
  }
  return out;
}

std::string detectable_table(const std::vector<diagnosis::Detectable>& all) {
  std::vector<const diagnosis::Detectable*> order;
  for (const diagnosis::Detectable& e : all) order.push_back(&e);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->lambda_at_start < b->lambda_at_start; });
  std::set<const effects::Effect*> seen;
  std::vector<std::vector<std::string>> rows = {
      {"hardest to see with this plan", "smallest size that shows (λ = 4)", "would be mistaken for"}};
  for (const diagnosis::Detectable* e : order) {
    if (!seen.insert(e->effect.effect).second || seen.size() > most_shown) continue;
    rows.push_back({"  " + placed_words(e->effect), sizes_of(*e),
                    e->mistaken_for.empty() ? "" : fmt::format("{} (cosine {:.3f})", e->mistaken_for, e->cosine)});
  }
  std::string out = aligned(rows);
  if (seen.size() > most_shown)
    out += fmt::format("  and {} more that show better: --json and the page have all\n", seen.size() - most_shown);
  return out;
}

}  // namespace deflect::report
