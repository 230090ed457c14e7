#include "analytic/table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "msa/base/index.h"
#include "msa/mechanism/table.h"

namespace deflect::analytic {
namespace {

double slope(const TablePoints& c, std::size_t i) { return (c[i + 1][1] - c[i][1]) / (c[i + 1][0] - c[i][0]); }

/// The largest force of the points: what is little beside it is none.
double range(const TableCurves& t) { return t.elastic.back()[0]; }

/// A force a little farther from none: at a corner on the piece behind it.
double farther(const TableCurves& t, double f) {
  const double more = 1e-9 * std::abs(f) + 1e-12 * range(t);
  return f > -1e-12 * range(t) ? f + more : f - more;
}

/// The piece of the elastic curve on which a force lies.
std::size_t piece(const TablePoints& c, double f) {
  const auto above = std::upper_bound(c.begin() + 1, c.end() - 1, f, [](double x, const auto& p) { return x < p[0]; });
  return as_size(above - c.begin()) - 1;
}

/// Counted from the end of the piece that is nearer to no force, so that digits are kept there and an odd curve is odd.
double elastic(const TableCurves& t, double f) {
  const std::size_t i = piece(t.elastic, f);
  const auto& from = t.elastic[std::abs(t.elastic[i + 1][0]) < std::abs(t.elastic[i][0]) ? i + 1 : i];
  return from[1] + slope(t.elastic, i) * (f - from[0]);
}

/// A bound of a play: A or B.
double bound(const TablePoints& c, double beyond, double f) {
  if (f <= c.front()[0]) return 0;
  if (f >= c.back()[0]) return c.back()[1] + beyond * (f - c.back()[0]);
  const std::size_t i = piece(c, f);
  return c[i][1] + slope(c, i) * (f - c[i][0]);
}

double slope_of_bound(const TablePoints& c, double beyond, double f) {
  if (f < c.front()[0] || c.size() == 1) return f < c.back()[0] ? 0 : beyond;
  return f >= c.back()[0] ? beyond : slope(c, piece(c, f));
}

double played(const TableCurves& t, double f, double left) {
  return std::max(bound(t.loading, t.beyond, f), std::min(bound(t.unloading, t.beyond, f), left));
}

/// The force at which a bound has a value above none.
double force_of(const TablePoints& c, double beyond, double value) {
  if (value >= c.back()[1]) return c.back()[0] + (beyond > 0 ? (value - c.back()[1]) / beyond : 0);
  std::size_t i = 0;
  while (c[i + 1][1] < value) ++i;
  return c[i][0] + (value - c[i][1]) / slope(c, i);
}

/// ∫f dB over forces above none, up to where B leaves p.
double given_back(const TableCurves& t, double p) {
  double sum = 0;
  const auto add = [&](double from, double to, double rises) {
    if (to > from) sum += rises * (to * to - from * from) / 2;
  };
  if (p <= 0) return 0;
  const double until = force_of(t.unloading, t.beyond, p);
  for (std::size_t i = 0; i + 1 < t.unloading.size(); ++i)
    add(std::max(t.unloading[i][0], 0.0), std::min(t.unloading[i + 1][0], until), slope(t.unloading, i));
  add(range(t), until, t.beyond);
  return sum;
}

/// ∫δ_e df from none to f.
double area(const TableCurves& t, double f) {
  const TablePoints& c = t.elastic;
  const double low = std::min(f, 0.0), high = std::max(f, 0.0);
  double sum = 0, from = low;
  for (std::size_t i = piece(c, low); from < high; ++i) {
    const double to = i + 2 < c.size() ? std::min(c[i + 1][0], high) : high;
    sum += (to - from) * (elastic(t, from) + elastic(t, to)) / 2;
    from = to;
  }
  return f < 0 ? -sum : sum;
}

/// Where the curve bends, [f, δ] rising, with one point more beyond either end.
TablePoints corners_of(const TableLaw& law) {
  const TableCurves& t = curves_of(law);
  std::vector<double> forces;
  for (const auto& point : t.elastic) forces.push_back(point[0]);
  for (const double sign : {1.0, -1.0}) {
    if (!law.remembers()) break;
    const double left = law.left[sign > 0 ? 0 : 1];
    for (const TablePoints* curve : {&t.loading, &t.unloading}) {
      for (const auto& point : *curve) forces.push_back(sign * point[0]);
      if (left > 0) forces.push_back(sign * force_of(*curve, t.beyond, left));
    }
  }
  std::sort(forces.begin(), forces.end());
  const auto same = [&](double a, double b) { return b - a <= 1e-13 * range(t); };
  forces.erase(std::unique(forces.begin(), forces.end(), same), forces.end());
  forces.insert(forces.begin(), forces.front() - range(t));
  forces.push_back(forces.back() + range(t));
  TablePoints out;
  for (const double f : forces) out.push_back({f, table_deflection(law, f)});
  return out;
}

}  // namespace

double table_deflection(const TableLaw& law, double f) {
  const TableCurves& t = curves_of(law);
  if (!law.remembers()) return elastic(t, f);
  const std::array<double, 2> p = table_left(law, f);
  return elastic(t, f) + p[0] - p[1];
}

double table_compliance(const TableLaw& law, double f) {
  const TableCurves& t = curves_of(law);
  const double behind = farther(t, f), yields = slope(t.elastic, piece(t.elastic, behind));
  if (!law.remembers()) return yields;
  const bool pull = behind > 0;
  const double g = std::abs(behind), here = law.left[pull ? 0 : 1], other = law.left[pull ? 1 : 0];
  double sum = yields;
  if (bound(t.loading, t.beyond, g) > here)
    sum += slope_of_bound(t.loading, t.beyond, g);
  else if (bound(t.unloading, t.beyond, g) < here)
    sum += slope_of_bound(t.unloading, t.beyond, g);
  if (bound(t.unloading, t.beyond, -g) < other) sum += slope_of_bound(t.unloading, t.beyond, -g);
  return sum;
}

double table_change(const TableLaw& law, double P, double f) {
  const TableCurves& t = curves_of(law);
  const std::size_t i = piece(t.elastic, P);
  if (i == piece(t.elastic, P + f)) return slope(t.elastic, i) * f;
  return elastic(t, P + f) - elastic(t, P);
}

double table_change_energy(const TableLaw& law, double P, double f) {
  const TableCurves& t = curves_of(law);
  const std::size_t i = piece(t.elastic, P);
  if (i == piece(t.elastic, P + f)) return slope(t.elastic, i) * f * f / 2;
  return f * elastic(t, P + f) - (area(t, P + f) - area(t, P));
}

double table_stored_energy(const TableLaw& law, double f) {
  const TableCurves& t = curves_of(law);
  const double stored = f * elastic(t, f) - area(t, f);
  if (!law.remembers()) return stored;
  const std::array<double, 2> p = table_left(law, f);
  return stored + given_back(t, p[0]) + given_back(t, p[1]);
}

std::array<double, 2> table_left(const TableLaw& law, double f) {
  const TableCurves& t = curves_of(law);
  return {played(t, f, law.left[0]), played(t, -f, law.left[1])};
}

ScalarLaw table_by_corners(const TableLaw& law, double rest, double P) {
  const auto corners = std::make_shared<const TablePoints>(corners_of(law));
  const auto line = [corners](double d) {
    const auto above = std::upper_bound(corners->begin() + 1, corners->end() - 1, d,
                                        [](double x, const auto& point) { return x < point[1]; });
    return std::pair(*(above - 1), *above);
  };
  const auto stiffness = [](const auto& ends) {
    return (ends.second[0] - ends.first[0]) / (ends.second[1] - ends.first[1]);
  };
  const double none = std::numeric_limits<double>::infinity();
  return {-none, none,
          [=](double d) {
            const auto ends = line(d + rest);
            return ends.first[0] + stiffness(ends) * (d + rest - ends.first[1]) - P;
          },
          [=](double d) { return stiffness(line(d + rest)); }};
}

}  // namespace deflect::analytic
