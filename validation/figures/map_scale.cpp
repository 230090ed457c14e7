#include "validation/figures/map_scale.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "validation/report/map_results.h"

namespace deflect::figures {

StiffnessRange range_of_stiffness(const studies::StiffnessMap& map) {
  StiffnessRange e;
  for (const studies::MapPose& p : map.poses)
    if (const studies::MapValues* v = report::shown(p)) {
      e.low = std::min(e.low, v->stiffness_N_mm.minCoeff());
      e.high = std::max(e.high, v->stiffness_N_mm.maxCoeff());
    }
  return e;
}

std::string inner_tics(const Sheet& s, double low, double high, double room_mm) {
  const double margin = 0.07 * (high - low);
  const Tics t = s.tics(low + margin, high - margin, room_mm);
  std::vector<double> numbers;
  for (double k = std::ceil((low + margin) / t.step); k * t.step <= high - margin; ++k)
    numbers.push_back(k * t.step + 0.0);
  if (numbers.size() > 2 && static_cast<double>(numbers.size()) * s.text_mm(t.letters + 1) > room_mm)
    numbers = {numbers.front(), numbers.back()};
  return fmt::format("{:.10g}", fmt::join(numbers, ", "));
}

std::vector<double> levels_in(const StiffnessRange& e, std::size_t wanted) {
  static const std::vector<std::vector<double>> series = {
      {1, 2, 5}, {1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8}, {1,    1.12, 1.25, 1.4, 1.6, 1.8, 2,   2.24, 2.5, 2.8,
                                                              3.15, 3.55, 4,    4.5, 5,   5.6, 6.3, 7.1,  8,   9}};
  std::vector<double> list;
  for (const std::vector<double>& numbers : series) {
    list.clear();
    for (double power = std::pow(10, std::floor(std::log10(e.low))); power <= e.high; power *= 10)
      for (const double number : numbers)
        if (number * power > e.low && number * power < e.high) list.push_back(number * power);
    if (list.size() >= wanted) return list;
  }
  // Too narrow for preferred numbers: round values at even distance, the coarsest that are enough.
  for (double power = std::pow(10, std::floor(std::log10(e.high - e.low))); e.high > e.low && list.size() < wanted;
       power /= 10)
    for (const double step : {5 * power, 2 * power, power}) {
      list.clear();
      for (double n = std::floor(e.low / step) + 1; n * step < e.high; ++n) list.push_back(n * step);
      if (list.size() >= wanted) break;
    }
  return list;
}

std::string tics_in(const StiffnessRange& e, bool named) {
  std::string list;
  for (const double level : levels_in(e, 4))
    list += fmt::format("{}'{}' {:g}", list.empty() ? "" : ", ", named ? fmt::format("{:g}", level) : "", level);
  return list;
}

}  // namespace deflect::figures
