#include "validation/figures/contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "validation/report/text.h"

namespace deflect::figures {
namespace {

/// An edge of the grid by a number: even along x from (i, j), odd along y.
using EdgeId = std::size_t;

struct Segment {
  EdgeId a, b;
};

/// The edges of a cell that the level crosses, in pairs: none, one pair, or two at a saddle.
class CellCrossing {
 public:
  CellCrossing(const GridField& f, std::size_t i, std::size_t j, double level) {
    const std::size_t n = f.x.size();
    const std::array<double, 4> v = {f.at(i, j), f.at(i + 1, j), f.at(i + 1, j + 1), f.at(i, j + 1)};
    if (std::any_of(v.begin(), v.end(), [](double x) { return std::isnan(x); })) return;
    const std::array<EdgeId, 4> edge = {2 * (j * n + i), 2 * (j * n + i + 1) + 1, 2 * ((j + 1) * n + i),
                                        2 * (j * n + i) + 1};
    std::vector<EdgeId> crossed;
    for (std::size_t k = 0; k < 4; ++k)
      if ((v[k] < level) != (v[(k + 1) % 4] < level)) crossed.push_back(edge[k]);
    if (crossed.size() == 2) segments_ = {{crossed[0], crossed[1]}};
    if (crossed.size() < 4) return;
    // At a saddle the value in the middle says which corners hang together.
    const bool middle_below = (v[0] + v[1] + v[2] + v[3]) / 4 < level;
    if ((v[0] < level) == middle_below)
      segments_ = {{edge[0], edge[1]}, {edge[2], edge[3]}};
    else
      segments_ = {{edge[3], edge[0]}, {edge[1], edge[2]}};
  }
  const std::vector<Segment>& segments() const { return segments_; }

 private:
  std::vector<Segment> segments_;
};

PlanePoint crossing(const GridField& f, EdgeId edge, double level) {
  const std::size_t at = edge / 2, i = at % f.x.size(), j = at / f.x.size();
  const bool along_y = edge % 2 == 1;
  const double a = f.at(i, j), b = along_y ? f.at(i, j + 1) : f.at(i + 1, j);
  const double t = (level - a) / (b - a);
  if (along_y) return {f.x[i], f.y[j] + t * (f.y[j + 1] - f.y[j])};
  return {f.x[i] + t * (f.x[i + 1] - f.x[i]), f.y[j]};
}

/// Follows segments from edge to edge until no unused one is left.
class CurveChains {
 public:
  explicit CurveChains(const std::vector<Segment>& segments) : segments_(segments), used_(segments.size(), 0) {
    for (std::size_t s = 0; s < segments.size(); ++s) {
      at_[segments[s].a].push_back(s);
      at_[segments[s].b].push_back(s);
    }
  }
  /// Open curves from their ends first, then closed ones.
  std::vector<std::vector<EdgeId>> all() {
    std::vector<std::vector<EdgeId>> out;
    for (const auto& [edge, of_edge] : at_)
      if (of_edge.size() == 1 && !used_[of_edge.front()]) out.push_back(from(edge));
    for (std::size_t s = 0; s < segments_.size(); ++s)
      if (!used_[s]) out.push_back(from(segments_[s].a));
    return out;
  }

 private:
  std::vector<EdgeId> from(EdgeId edge) {
    std::vector<EdgeId> chain = {edge};
    for (std::optional<std::size_t> s = unused_at(edge); s; s = unused_at(edge)) {
      used_[*s] = 1;
      edge = segments_[*s].a == edge ? segments_[*s].b : segments_[*s].a;
      chain.push_back(edge);
    }
    return chain;
  }
  std::optional<std::size_t> unused_at(EdgeId edge) const {
    for (const std::size_t s : at_.at(edge))
      if (!used_[s]) return s;
    return {};
  }

  const std::vector<Segment>& segments_;
  std::vector<char> used_;
  std::map<EdgeId, std::vector<std::size_t>> at_;
};

}  // namespace

std::vector<Polyline> iso_curves(const GridField& f, double level) {
  std::vector<Segment> segments;
  for (std::size_t j = 0; j + 1 < f.y.size(); ++j)
    for (std::size_t i = 0; i + 1 < f.x.size(); ++i) {
      const CellCrossing cell(f, i, j, level);
      segments.insert(segments.end(), cell.segments().begin(), cell.segments().end());
    }
  std::vector<Polyline> out;
  for (const std::vector<EdgeId>& chain : CurveChains(segments).all()) {
    Polyline line;
    for (const EdgeId edge : chain) line.push_back(crossing(f, edge, level));
    out.push_back(std::move(line));
  }
  return out;
}

bool CurveLabel::covers(const PlanePoint& p) const {
  return std::abs(p.x - at.x) < half_width && std::abs(p.y - at.y) < half_height;
}

LabelledCurves::LabelledCurves(const GridField& field, double wide, double tall, double letter_mm, double line_mm)
    : field_(field),
      mm_x_(wide / (field.x.back() - field.x.front())),
      mm_y_(tall / (field.y.back() - field.y.front())),
      letter_(letter_mm),
      line_(line_mm) {}

void LabelledCurves::add(double level) { all_.push_back({level, iso_curves(field_, level)}); }

const std::vector<Polyline>& LabelledCurves::curves_of(double level) const {
  static const std::vector<Polyline> none_drawn;
  const auto found = std::find_if(all_.begin(), all_.end(), [&](const Curves& c) { return c.level == level; });
  return found == all_.end() ? none_drawn : found->lines;
}

bool LabelledCurves::fits(const CurveLabel& l) const {
  const auto inside = [](double at, double half, double low, double high) {
    return at - half > low && at + half < high;
  };
  if (!inside(l.at.x, l.half_width, field_.x.front(), field_.x.back()) ||
      !inside(l.at.y, l.half_height, field_.y.front(), field_.y.back()))
    return false;
  return std::none_of(labels_.begin(), labels_.end(), [&](const CurveLabel& other) {
    return std::abs(l.at.x - other.at.x) < l.half_width + other.half_width &&
           std::abs(l.at.y - other.at.y) < l.half_height + other.half_height;
  });
}

PlanePoint LabelledCurves::moved_inside(const CurveLabel& l) const {
  constexpr double kept = 0.02;  // of the panel, from its edge
  const auto within = [](double at, double half, const std::vector<double>& axis) {
    const double edge = half + kept * (axis.back() - axis.front());
    const double low = axis.front() + edge, high = axis.back() - edge;
    return low < high ? std::clamp(at, low, high) : at;
  };
  return {within(l.at.x, l.half_width, field_.x), within(l.at.y, l.half_height, field_.y)};
}

void LabelledCurves::label(double level, bool tight) {
  const double width = letter_ * (static_cast<double>(report::letters(fmt::format("{:g}", level))) + 0.6);
  for (const Polyline& line : curves_of(level)) {
    std::vector<double> run = {0};  // mm along the curve
    for (std::size_t k = 1; k < line.size(); ++k)
      run.push_back(run.back() + std::hypot(mm_x_ * (line[k].x - line[k - 1].x), mm_y_ * (line[k].y - line[k - 1].y)));
    if (run.back() < (tight ? 1.3 : 2.5) * width) continue;
    // As near to the middle of the curve as there is room.
    std::optional<CurveLabel> best;
    double farthest = run.back();
    for (std::size_t k = 0; k < line.size(); ++k) {
      CurveLabel here{line[k], level, width / 2 / mm_x_, 0.55 * line_ / mm_y_};
      if (tight) here.at = moved_inside(here);
      const double away = std::abs(run[k] - run.back() / 2);
      if (away < farthest && fits(here) && here.covers(line[k])) best = here, farthest = away;
    }
    if (best) labels_.push_back(*best);
  }
}

std::vector<Polyline> LabelledCurves::visible(double level) const {
  std::vector<Polyline> out;
  for (const Polyline& line : curves_of(level)) {
    Polyline part;
    for (const PlanePoint& p : line) {
      const bool hidden = std::any_of(labels_.begin(), labels_.end(), [&](const CurveLabel& l) { return l.covers(p); });
      if (!hidden) part.push_back(p);
      if ((hidden || &p == &line.back()) && part.size() > 1) out.push_back(part);
      if (hidden) part.clear();
    }
  }
  return out;
}

std::string matrix_rows(const GridField& f) {
  std::string text;
  for (std::size_t j = 0; j < f.y.size(); ++j)
    for (std::size_t i = 0; i < f.x.size(); ++i) text += fmt::format("{}{:.5g}", i ? " " : j ? "\n" : "", f.at(i, j));
  return text + "\n";
}

std::string matrix_columns(const GridField& f) {
  const auto spaced = [](const std::vector<double>& axis, int column) {
    const double step = axis.size() > 1 ? (axis.back() - axis.front()) / static_cast<double>(axis.size() - 1) : 0;
    return fmt::format("({:.10g}+${}*{:.10g})", axis.front(), column, step);
  };
  return fmt::format("matrix using {}:{}:3", spaced(f.x, 1), spaced(f.y, 2));
}

CurveRows curve_rows(LabelledCurves curves, const std::vector<double>& iso, const std::vector<double>& index,
                     double light) {
  for (const double level : iso) curves.add(level);
  for (const double level : index) curves.label(level);
  // Where none of the heavy ones has room, another carries its number: curves without any say little.
  for (const bool tight : {false, true})
    for (auto level = iso.begin(); level != iso.end() && curves.labels().empty(); ++level) curves.label(*level, tight);
  const auto ink = [&](double level) { return level < light ? 0xFFFFFF : 0x000000; };
  CurveRows out;
  for (const double level : iso) {
    const bool named = std::find(index.begin(), index.end(), level) != index.end();
    for (const Polyline& line : curves.visible(level)) {
      std::string& rows = named ? out.heavy : out.thin;
      for (const PlanePoint& p : line) rows += fmt::format("{:.6g} {:.6g} {}\n", p.x, p.y, ink(level));
      rows += "\n";
    }
  }
  for (const CurveLabel& l : curves.labels())
    out.values += fmt::format("{:.6g} {:.6g} {:g} {}\n", l.at.x, l.at.y, l.level, ink(l.level));
  return out;
}

}  // namespace deflect::figures
