#include "msa/frame/elements/table_spring.h"

namespace deflect::frame {
namespace {

using Corner = TableSpring::Corner;
using Corners = TableSpring::Corners;
using Memory = TableSpring::Memory;

constexpr double same_force = 1e-13;  // of the range of the table

/// The corner at which the straight line to the next one holds x, found by what `of` says of corners.
template <class Of>
std::size_t line(const Corners& c, double x, Of of) {
  std::size_t low = 0, high = c.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (x < of(c[middle]) ? high : low) = middle;
  }
  return low;
}

double force_of(const Corner& c) { return c.f; }
double motion_of(const Corner& c) { return c.d; }

double stiffness(const Corners& c, std::size_t i) { return (c[i + 1].f - c[i].f) / (c[i + 1].d - c[i].d); }

/// What a bound holds at a force.
double held(const Corners& bound, double beyond, double f) {
  const Corner &first = bound.front(), &last = bound.back();
  if (f <= first.f) return 0;
  if (f >= last.f) return last.d + beyond * (f - last.f);
  const std::size_t i = line(bound, f, force_of);
  const Corner &a = bound[i], &b = bound[i + 1];
  return ((b.f - f) * a.d + (f - a.f) * b.d) / (b.f - a.f);
}

/// The force at which a bound begins to hold more than p > 0.
double reaches(const Corners& bound, double beyond, double p) {
  const Corner& last = bound.back();
  if (p >= last.d) return beyond > 0 ? last.f + (p - last.d) / beyond : last.f;
  std::size_t i = 1;
  while (bound[i].d < p) ++i;
  const Corner &a = bound[i - 1], &b = bound[i];
  return ((b.d - p) * a.f + (p - a.d) * b.f) / (b.d - a.d);
}

double moved(const Memory& m, double f, double before) {
  return std::clamp(before, held(m.loads, m.beyond, f),
                    std::max(held(m.loads, m.beyond, f), held(m.falls, m.beyond, f)));
}

/// ∫F dp over what a bound has taken up to p, as far as it gives that back: where F > 0.
double taken(const Corners& bound, double beyond, double p) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < bound.size() && bound[i].d < p; ++i) {
    const Corner& a = bound[i];
    Corner b = bound[i + 1];
    if (b.d > p) b = {p, reaches(bound, beyond, p)};
    if (b.f <= 0) continue;
    const double from = a.f < 0 ? a.d + (b.d - a.d) * -a.f / (b.f - a.f) : a.d;
    sum += (b.d - from) * (std::max(a.f, 0.0) + b.f) / 2;
  }
  const Corner& last = bound.back();
  if (p > last.d) sum += (p - last.d) * (last.f + reaches(bound, beyond, p)) / 2;
  return sum;
}

}  // namespace

void TableSpring::begin(const std::array<double, 2>& before) {
  left = before;
  std::vector<double> forces;
  for (const int sign : {1, -1}) {
    const double p = before[sign > 0 ? 0 : 1];
    for (const Corners* bound : {&memory->loads, &memory->falls}) {
      for (const Corner& corner : *bound) forces.push_back(sign * corner.f);
      if (p > 0) forces.push_back(sign * reaches(*bound, memory->beyond, p));
    }
  }
  forces.push_back(0);
  const double range = memory->loads.back().f;
  const auto [least, most] = std::minmax_element(forces.begin(), forces.end());
  const double below = *least - range, above = *most + range;
  forces.insert(forces.end(), {below, above});
  std::sort(forces.begin(), forces.end());
  auto now = std::make_shared<Corners>();
  for (const double f : forces) {
    const std::array<double, 2> p = left_after(f);
    const double d = memory->c * f + p[0] - p[1];
    if (now->empty() || f - now->back().f > same_force * range) now->push_back({d, f});
  }
  corners = std::move(now);
}

std::array<double, 2> TableSpring::left_after(double f) const {
  return {moved(*memory, f, left[0]), moved(*memory, -f, left[1])};
}

double TableSpring::force(double d) const {
  const std::size_t i = line(*corners, d, motion_of);
  return (*corners)[i].f + stiffness(*corners, i) * (d - (*corners)[i].d);
}

double TableSpring::elongation(double f) const {
  const std::size_t i = line(*corners, f, force_of);
  return (*corners)[i].d + (f - (*corners)[i].f) / stiffness(*corners, i);
}

/// At a corner, to 1e-9 of its force, of the line farther from no force.
double TableSpring::at_force(double f) const {
  const double little = 1e-12 * corners->back().f, more = 1e-9 * std::abs(f) + little;
  return stiffness(*corners, line(*corners, f > -little ? f + more : f - more, force_of));
}

double TableSpring::energy(double d) const {
  const double rest = elongation(0), low = std::min(rest, d), high = std::max(rest, d);
  double sum = 0, from = low;
  for (std::size_t i = line(*corners, low, motion_of); from < high; ++i) {
    const double to = i + 2 < corners->size() ? std::min((*corners)[i + 1].d, high) : high;
    sum += (to - from) * (force(from) + force(to)) / 2;
    from = to;
  }
  return d < rest ? -sum : sum;
}

double TableSpring::stored(double f) const {
  if (!memory) return energy(elongation(f));
  const std::array<double, 2> p = left_after(f);
  return memory->c * f * f / 2 + taken(memory->falls, memory->beyond, p[0]) +
         taken(memory->falls, memory->beyond, p[1]);
}

}  // namespace deflect::frame
