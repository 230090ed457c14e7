// The drawing on paper: three views, all coordinates in mm of the paper.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "msa/base/index.h"
#include "validation/figures/drawing_results.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

using Paper = Eigen::Vector2d;

constexpr const char *metal = "#9db4c8", *dark = "#33475b", *rigid_grey = "#9a9a9a", *driven_orange = "#d95f02",
                     *free_motion_red = "#c1121f";
constexpr const char* axis_colours[] = {"#c1121f", "#2a7f3f", "#1f5fbf"};
constexpr double points_in_mm = 72 / 25.4, axes_length = 0.1;  // of the machine's size

/// A direction from which the machine is seen: what lies to the right and upwards on the paper.
struct Eye {
  const char* name;
  Vector3 right, up;
};

Eye askew() {
  const Vector3 forward = -Vector3(1.1, -1.5, 0.75).normalized(), right = forward.cross(Vector3::UnitZ()).normalized();
  return {"", right, right.cross(forward)};
}

/// The frames of reference that are drawn with all three axes: of a frame one at the corner of the box around it.
std::vector<std::pair<Vector3, Matrix3>> shown_axes(const MachineDrawing& d) {
  std::vector<std::pair<Vector3, Matrix3>> out;
  if (!d.frame) {
    for (const DrawnPoint& p : d.frames) out.emplace_back(p.at, p.axes);
  } else if (!d.points.empty()) {
    Eigen::AlignedBox3d box;
    for (const Vector3& p : d.points) box.extend(p);
    out.emplace_back(box.min(), Matrix3::Identity());
  }
  return out;
}

/// A panel of the sheet with the machine to scale in it, arrows of its axes included.
class DrawnView {
 public:
  DrawnView(Sheet& s, const MachineDrawing& d, const Eye& eye, const Eigen::Vector4d& xywh, double margin)
      : sheet_(s), drawing_(d), eye_(eye), box_(xywh) {
    Eigen::AlignedBox2d seen;
    for (const Vector3& p : d.points) seen.extend(flat(p));
    for (const auto& [from, axes] : shown_axes(d))
      for (Eigen::Index axis = 0; axis < 3; ++axis) seen.extend(flat(from + axes_length * d.size() * axes.col(axis)));
    const Paper size = seen.sizes(),
                room(box_(2) - 2 * margin, box_(3) - 2 * margin * std::min(1.0, box_(3) / box_(2)));
    const double least = 1e-6 + 1e-3 * d.size();
    scale_ = std::min(room.x() / std::max(size.x(), least), room.y() / std::max(size.y(), least));
    middle_ = seen.center();
  }

  /// On the panel, mm from its lower left corner.
  Paper at(const Vector3& p) const { return Paper(box_(2), box_(3)) / 2 + scale_ * (flat(p) - middle_); }
  double scale() const { return scale_; }  ///< mm of paper per m

  void lines(const std::string& name, const std::vector<std::pair<Vector3, Vector3>>& all) {
    std::string data;
    for (const auto& [a, b] : all) data += point(at(a)) + point(at(b)) + "\n";
    block(name, data);
  }
  void block(const std::string& name, const std::string& data) { sheet_.put("${} << EOD\n{}EOD", name, data); }
  static std::string point(const Paper& p) { return fmt::format("{:.3f} {:.3f}\n", p.x(), p.y()); }

  void add(const std::string& series) { series_ += (series_.empty() ? "" : ", ") + series; }

  void plot() {
    sheet_.panel(box_(0), box_(1), box_(2), box_(3));
    sheet_.put("set xrange [0:{:.3f}]\nset yrange [0:{:.3f}]", box_(2), box_(3));
    sheet_.plot("plot " + series_);
  }

  Sheet& sheet() { return sheet_; }
  const Eigen::Vector4d& box() const { return box_; }

 private:
  Paper flat(const Vector3& p) const { return {p.dot(eye_.right), p.dot(eye_.up)}; }

  Sheet& sheet_;
  const MachineDrawing& drawing_;
  Eye eye_;
  Eigen::Vector4d box_;
  double scale_ = 1;
  Paper middle_ = Paper::Zero();
  std::string series_;
};

Vector3 point_of(const MachineDrawing& d, int i) { return nth(d.points, i); }

/// Members as wide as their sections, rigid pieces as thin lines.
void draw_bodies(DrawnView& v, const MachineDrawing& d, const std::string& id) {
  std::vector<std::pair<Vector3, Vector3>> rigid, axes;
  for (const MachineDrawing::Line& line : d.lines)
    if (line.member < 0) rigid.emplace_back(point_of(d, line.a), point_of(d, line.b));
  v.lines("rigid" + id, rigid.empty() ? std::vector{std::pair{d.points.front(), d.points.front()}} : rigid);
  v.add(fmt::format("$rigid{} with lines lw 0.8 lc rgb '{}' notitle", id, rigid_grey));
  for (std::size_t i = 0; i < d.members.size(); ++i) {
    const DrawnMember& m = d.members[i];
    const double size = std::max(m.size_y, m.size_z);
    const double width = std::clamp(size * v.scale() * points_in_mm, 1.2, 14.0);
    v.lines(fmt::format("m{}_{}", i, id), {{m.start, m.end}});
    v.add(fmt::format("$m{}_{} with lines lw {:.2f} lc rgb '{}' notitle", i, id, width, metal));
    axes.emplace_back(m.start, m.end);
  }
  if (axes.empty()) return;
  v.lines("axis" + id, axes);
  v.add(fmt::format("$axis{} with lines lw 0.7 lc rgb '{}' notitle", id, dark));
}

void draw_joints(DrawnView& v, const MachineDrawing& d, const std::string& id) {
  for (const bool driven : {false, true}) {
    std::string data;
    for (const DrawnJoint& j : d.joints)
      if (j.driven() == driven) data += DrawnView::point(v.at(j.at));
    if (data.empty()) continue;
    const std::string name = fmt::format("{}{}", driven ? "driven" : "passive", id);
    v.block(name, data);
    if (driven) {
      v.add(fmt::format("${} with points pt 5 ps 0.75 lc rgb '{}' notitle", name, driven_orange));
    } else {
      v.add(fmt::format("${} with points pt 7 ps 0.65 lc rgb 'white' notitle", name));
      v.add(fmt::format("${} with points pt 6 ps 0.65 lw 0.9 lc rgb '{}' notitle", name, dark));
    }
  }
  std::string held;
  for (const DrawnPoint& p : d.frames)
    if (!p.held.empty()) held += DrawnView::point(v.at(p.at));
  if (held.empty()) return;
  v.block("held" + id, held);
  v.add(fmt::format("$held{} with points pt 9 ps 0.9 lc rgb '{}' notitle", id, dark));
}

/// Axes of a frame of reference, or y and z of a section.
void draw_axes(DrawnView& v, const MachineDrawing& d, const std::string& id, bool sections) {
  const double length = (sections ? 0.045 : axes_length) * d.size();
  for (Eigen::Index axis = sections ? 1 : 0; axis < 3; ++axis) {
    std::string data;
    const auto add = [&](const Vector3& from, const Matrix3& R) {
      const Paper a = v.at(from), b = v.at(from + length * R.col(axis)) - a;
      data += fmt::format("{:.3f} {:.3f} {:.3f} {:.3f}\n", a.x(), a.y(), b.x(), b.y());
    };
    if (sections) {
      for (const DrawnMember& m : d.members)
        if (!m.round && m.axes != Matrix3::Identity()) add((m.start + m.end) / 2, m.axes);
    } else {
      for (const auto& [at, axes] : shown_axes(d)) add(at, axes);
    }
    if (data.empty()) continue;
    const std::string name = fmt::format("{}{}_{}", sections ? "section" : "frame", axis, id);
    v.block(name, data);
    v.add(fmt::format("${} with vectors head filled size {},20 fixed lw {} lc rgb '{}' notitle", name,
                      sections ? 0.8 : 1.4, sections ? 0.8 : 1.2, axis_colours[axis]));
  }
}

void draw_motion(DrawnView& v, const MachineDrawing& d, const std::string& id) {
  if (d.motions.empty()) return;
  std::vector<std::pair<Vector3, Vector3>> moved;
  const std::vector<Vector3>& u = d.motions.front().displacements;
  for (const MachineDrawing::Line& line : d.lines) {
    const auto a = as_size(line.a), b = as_size(line.b);
    moved.emplace_back(d.points[a] + u[a], d.points[b] + u[b]);
  }
  v.lines("moved" + id, moved);
  v.add(fmt::format("$moved{} with lines lw 1 dt 2 lc rgb '{}' notitle", id, free_motion_red));
}

struct Callout {
  std::string text;
  Paper at;
};

/// Each name once: of legs alike the first one speaks for all.
std::vector<Callout> callouts(const DrawnView& v, const MachineDrawing& d) {
  std::vector<Callout> out;
  std::set<std::string> said;
  for (const DrawnMember& m : d.members)
    if (said.insert(m.part).second)
      out.push_back(
          {fmt::format("{}, {:.4g} mm", m.part, report::mm * (m.end - m.start).norm()), v.at((m.start + m.end) / 2)});
  for (const DrawnJoint& j : d.joints)
    if (said.insert(j.part).second) out.push_back({j.part + (j.driven() ? ", driven" : ""), v.at(j.at)});
  for (const DrawnPoint& p : d.frames)
    out.push_back({p.held.empty() ? p.name : fmt::format("{}: {}", p.name, p.held), v.at(p.at)});
  return out;
}

/// Names in a column at either side, in the order of height, with a line to what they name.
void write_callouts(DrawnView& v, const std::vector<Callout>& all, std::size_t letters_of_column) {
  Sheet& s = v.sheet();
  const double width = v.box()(2), height = v.box()(3), step = 1.05 * s.line();
  std::vector<Callout> columns[2], sorted = all;
  std::sort(sorted.begin(), sorted.end(), [](const Callout& a, const Callout& b) { return a.at.x() < b.at.x(); });
  const auto room = as_size(std::lround(std::floor(std::max(1.0, height / step))));
  for (std::size_t i = 0; i < sorted.size(); ++i) columns[2 * i < sorted.size() ? 0 : 1].push_back(sorted[i]);
  std::string leaders;
  for (const int side : {0, 1}) {
    std::vector<Callout>& column = columns[side];
    if (column.size() > room) column.resize(room);
    std::sort(column.begin(), column.end(), [](const Callout& a, const Callout& b) { return a.at.y() > b.at.y(); });
    double below = height - 0.5 * s.line(), rest = step * static_cast<double>(column.size());
    for (const Callout& c : column) {
      const double y = std::clamp(c.at.y(), std::min(rest - step + 0.5 * s.line(), below), below);
      below = y - step;
      rest -= step;
      const double column_mm = s.text_mm(letters_of_column, 0.94), text_x = side ? width - column_mm : column_mm;
      s.label(report::clip(c.text, letters_of_column + 4), v.box()(0) + text_x, v.box()(1) + height - y,
              std::string(side ? "left " : "right ") + "textcolor rgb '#202020' " + s.font(0.94));
      leaders += DrawnView::point({text_x + (side ? -0.7 : 0.7), y}) + DrawnView::point(c.at) + "\n";
    }
  }
  v.block("leaders", leaders);
  v.add("$leaders with lines lw 0.35 lc rgb '#b0b0b0' notitle");
}

/// 1, 2 or 5 times a power of ten, about a fifth of the width.
void draw_scale_bar(DrawnView& v) {
  const double wanted = 0.2 * v.box()(2) / v.scale(), power = std::pow(10, std::floor(std::log10(wanted)));
  const double lead = wanted / power, length = power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
  const double x = 2, y = 1.2;
  v.block("bar", DrawnView::point({x, y}) + DrawnView::point({x + length * v.scale(), y}));
  v.add("$bar with lines lw 1.6 lc rgb '#202020' notitle");
  v.sheet().label(fmt::format("{:g} mm", report::mm * length), v.box()(0) + x, v.box()(1) + v.box()(3) - y - 1.2,
                  "left offset 0,0.5 textcolor rgb '#202020' " + v.sheet().font(0.94));
}

std::string what_is_drawn(const MachineDrawing& d) {
  std::string text = d.frame ? "triangles: supported nodes" : "squares: driven joints; circles: others";
  return text + "; grey: rigid; arrows: x red, y green, z blue of base and tool, short ones y and z of sections";
}

}  // namespace

Figure drawing_figure(const MachineDrawing& d, const FigureStyle& style) {
  Sheet s("drawing", style, 160);
  s.put("unset border\nunset tics\nunset grid\nunset key");
  std::vector<std::string> notes = {what_is_drawn(d)};
  if (!d.trouble.empty()) notes.push_back(d.trouble);
  if (!d.motions.empty()) notes.push_back("red: " + d.motions.front().words);
  double y = s.heading(fmt::format("{}: as drawn, unloaded", report::clip(d.name, 60)), notes) + 1;
  const double w = s.width(), large = 0.62 * w, small = 0.42 * w;
  const std::size_t letters_of_column = as_size(std::lround(std::floor(0.24 * w / s.text_mm(1, 0.94))));
  s.put("set multiplot");
  DrawnView whole(s, d, askew(), {0, y, w, large}, 0.27 * w);
  draw_bodies(whole, d, "0");
  write_callouts(whole, callouts(whole, d), letters_of_column);
  draw_motion(whole, d, "0");
  draw_axes(whole, d, "0", true);
  draw_axes(whole, d, "0", false);
  draw_joints(whole, d, "0");
  draw_scale_bar(whole);
  whole.plot();
  y += large + s.line();
  const Eye eyes[] = {{"from the front: x, z", Vector3::UnitX(), Vector3::UnitZ()},
                      {"from above: x, y", Vector3::UnitX(), Vector3::UnitY()}};
  for (const int i : {0, 1}) {
    const double x = (0.04 + 0.48 * i) * w;
    s.label(eyes[i].name, x, y, "left textcolor rgb '#505050' " + s.font(0.94));
    DrawnView view(s, d, eyes[i], {x, y + 0.5 * s.line(), 0.44 * w, small}, 4);
    draw_bodies(view, d, std::to_string(i + 1));
    draw_motion(view, d, std::to_string(i + 1));
    draw_axes(view, d, std::to_string(i + 1), false);
    draw_joints(view, d, std::to_string(i + 1));
    view.plot();
  }
  s.put("unset multiplot");
  const std::string caption = fmt::format(
      "{} as its file draws it, unloaded and before any solution, seen askew, from the front (x to the right, z up) "
      "and "
      "from above (x to the right, y up); base axes. Members are drawn as wide as their sections, {}. Lengths in mm, "
      "from node to node. No load, no measurements.{}",
      d.name, what_is_drawn(d), d.trouble.empty() ? "" : " " + d.trouble + ".");
  return s.figure(y + small + s.line() + 1, caption);
}

}  // namespace deflect::figures
