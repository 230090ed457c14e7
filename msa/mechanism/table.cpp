#include "msa/mechanism/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "msa/base/error.h"

namespace deflect {
namespace {

constexpr double rounding = 1e-12;  // of slopes, and of deflections that should agree

using Point = std::array<double, 2>;

double slope(const Point& a, const Point& b) { return (b[1] - a[1]) / (b[0] - a[0]); }

/// δ at f of points whose forces rise, within them.
double between(const TablePoints& points, double f) {
  const auto after = std::find_if(points.begin() + 1, points.end() - 1, [f](const Point& p) { return f <= p[0]; });
  const Point &a = *(after - 1), &b = *after;
  return f == b[0] ? b[1] : a[1] + slope(a, b) * (f - a[0]);
}

/// Of both branches.
double stiffest_piece(const TablePoints& a, const TablePoints& b) {
  double least = slope(a[0], a[1]);
  for (const TablePoints* points : {&a, &b})
    for (std::size_t i = 1; i < points->size(); ++i) least = std::min(least, slope((*points)[i - 1], (*points)[i]));
  return least;
}

/// What a piece has beyond c, which rounding makes of equal slopes too.
double beyond(double slope, double c) { return slope - c > rounding * c ? slope - c : 0; }

TablePoints mirrored(const TablePoints& points) {
  TablePoints out;
  for (auto p = points.rbegin(); p != points.rend() && (*p)[0] > 0; ++p) out.push_back({-(*p)[0], -(*p)[1]});
  out.insert(out.end(), points.begin(), points.end());
  return out;
}

TableCurves remembering(const TablePoints& points, const TablePoints& back) {
  const TablePoints unloading(back.rbegin(), back.rend());
  const double F = points.back()[0], c = stiffest_piece(points, unloading);
  TableCurves out;
  out.elastic = {{-F, -c * F}, {F, c * F}};
  out.loading = {{0, 0}};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double more = beyond(slope(points[i - 1], points[i]), c) * (points[i][0] - points[i - 1][0]);
    if (out.loading.back()[1] + more == 0)
      out.loading.back()[0] = points[i][0];  // nothing yet
    else
      out.loading.push_back({points[i][0], out.loading.back()[1] + more});
  }
  out.beyond = beyond(slope(points[points.size() - 2], points.back()), c);
  TablePoints& B = out.unloading;
  B = {out.loading.back()};
  for (std::size_t i = 1; i < back.size(); ++i) {
    const double less = beyond(slope(back[i], back[i - 1]), c) * (back[i - 1][0] - back[i][0]);
    B.push_back({back[i][0], std::max(B.back()[1] - less, 0.0)});
  }
  if (const double left = B.back()[1]; left > 0) {
    const double at_rest = beyond(slope(back.back(), back[back.size() - 2]), c), to_the_end = left / F;
    B.push_back({-left / std::max(at_rest, to_the_end), 0});
  }
  std::reverse(B.begin(), B.end());
  return out;
}

class Judge {
 public:
  Judge(const TableLaw& law, Dimension force, Dimension motion) : law_(law), force_(force), motion_(motion) {}

  std::optional<TableMistake> mistake() const {
    if (const std::string what = of_points(); !what.empty()) return TableMistake{"points", what};
    if (!law_.remembers()) return std::nullopt;
    if (const std::string what = of_unloading(); !what.empty()) return TableMistake{"unloading", what};
    return std::nullopt;
  }

 private:
  std::string at(const Point& p) const {
    return fmt::format("[{}, {}]", format_quantity(p[0], force_), format_quantity(p[1], motion_));
  }

  std::string too_few(const TablePoints& points) const {
    return fmt::format("has {} point{}: a curve needs at least two, each of a load and its deflection", points.size(),
                       points.size() == 1 ? "" : "s");
  }

  /// `sign`: 1 where the points should rise.
  std::string not_steady(const TablePoints& points, double sign) const {
    const char* way = sign > 0 ? "rise" : "fall";
    for (std::size_t i = 1; i < points.size(); ++i)
      for (const std::size_t k : {0u, 1u})
        if (!(sign * points[i][k] > sign * points[i - 1][k]))
          return fmt::format("{} must {} from point to point, and {} follows {}: {}",
                             k == 0 ? "the load" : "the deflection", way, at(points[i]), at(points[i - 1]),
                             k == 0 ? "sort the points, and keep one of those at one load"
                                    : "a law that gives way is no law at rest; a free travel is 'law: clearance'");
    return "";
  }

  std::string of_points() const {
    const TablePoints& points = law_.points;
    if (points.size() < 2) return too_few(points);
    if (const std::string what = not_steady(points, 1); !what.empty()) return what;
    if (std::find(points.begin(), points.end(), Point{0, 0}) == points.end())
      return fmt::format("must pass through {}: add that point, or count loads and deflections from it", at({0, 0}));
    if (law_.remembers() && points.front()[0] != 0)
      return fmt::format("must begin at {} where 'unloading' is given: the branch holds under pull and push alike",
                         at({0, 0}));
    if (points.back()[0] <= 0) return "has no load under pull (positive): turn the signs of all points";
    return "";
  }

  std::string of_unloading() const {
    const TablePoints &points = law_.points, &back = law_.unloading;
    if (back.size() < 2) return too_few(back);
    if (back.front() != points.back())
      return fmt::format("must begin at the last of 'points', {}, and begins at {}", at(points.back()),
                         at(back.front()));
    if (const std::string what = not_steady(back, -1); !what.empty()) return what;
    if (back.back()[0] != 0)
      return fmt::format("must end at no load, and ends at {}: add the deflection that is left there", at(back.back()));
    TablePoints up(back.rbegin(), back.rend());
    for (const TablePoints* at_points : {&points, &back})
      for (const Point& p : *at_points) {
        const double unloads = between(up, p[0]), loads = between(points, p[0]);
        if (unloads < loads - rounding * points.back()[1])
          return fmt::format("at {} is at {}, below loading at {}: the loop would give back more work than it took",
                             format_quantity(p[0], force_), format_quantity(unloads, motion_),
                             format_quantity(loads, motion_));
      }
    return "";
  }

  const TableLaw& law_;
  Dimension force_, motion_;
};

}  // namespace

std::optional<TableMistake> mistake_in(const TableLaw& law, Dimension force, Dimension motion) {
  return Judge(law, force, motion).mistake();
}

TableLaw identified(TableLaw law) {
  if (const auto mistake = mistake_in(law)) throw InputError(fmt::format("{}: {}", mistake->key, mistake->what));
  TableCurves curves;
  if (law.remembers())
    curves = remembering(law.points, law.unloading);
  else
    curves.elastic = law.points.front()[0] < 0 ? law.points : mirrored(law.points);
  law.curves = std::make_shared<const TableCurves>(std::move(curves));
  return law;
}

const TableCurves& curves_of(const TableLaw& law) {
  if (!law.curves) throw std::logic_error("a table whose points are not identified");
  return *law.curves;
}

}  // namespace deflect
