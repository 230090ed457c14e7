#include "validation/report/map_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "msa/base/index.h"
#include "validation/json/json_text.h"
#include "validation/report/by_point.h"
#include "validation/report/map_correlation.h"
#include "validation/report/text.h"
#include "validation/report/theory_words.h"

namespace deflect::report {
namespace {

/// A number of MapValues with its name in files, unit included.
struct Column {
  std::string name;
  double (*of)(const studies::MapValues&);
};

const std::vector<Column>& columns() {
  static const std::vector<Column> list = {
      {"cxx_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(0, 0); }},
      {"cxy_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(0, 1); }},
      {"cxz_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(0, 2); }},
      {"cyx_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(1, 0); }},
      {"cyy_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(1, 1); }},
      {"cyz_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(1, 2); }},
      {"czx_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(2, 0); }},
      {"czy_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(2, 1); }},
      {"czz_mm_per_N", [](const studies::MapValues& v) { return v.compliance_mm_N(2, 2); }},
      {"stiffness_x_N_per_mm", [](const studies::MapValues& v) { return v.stiffness_N_mm(0); }},
      {"stiffness_y_N_per_mm", [](const studies::MapValues& v) { return v.stiffness_N_mm(1); }},
      {"stiffness_z_N_per_mm", [](const studies::MapValues& v) { return v.stiffness_N_mm(2); }},
      {"smallest_N_per_mm", [](const studies::MapValues& v) { return v.smallest_N_mm; }},
      {"largest_N_per_mm", [](const studies::MapValues& v) { return v.largest_N_mm; }},
      {"isotropy", [](const studies::MapValues& v) { return v.isotropy; }},
      {"kxx_N_per_mm", [](const studies::MapValues& v) { return v.K_ii(0); }},
      {"kyy_N_per_mm", [](const studies::MapValues& v) { return v.K_ii(1); }},
      {"kzz_N_per_mm", [](const studies::MapValues& v) { return v.K_ii(2); }},
      {"kthx_Nmm_per_rad", [](const studies::MapValues& v) { return v.K_ii(3); }},
      {"kthy_Nmm_per_rad", [](const studies::MapValues& v) { return v.K_ii(4); }},
      {"kthz_Nmm_per_rad", [](const studies::MapValues& v) { return v.K_ii(5); }}};
  return list;
}
constexpr std::size_t first_ranged = 9, last_ranged = 14;  // what a person is told the range of
constexpr const char* ranged_names[] = {"along x, 1/Cxx", "along y, 1/Cyy", "along z, 1/Czz",
                                        "smallest",       "largest",        "isotropy"};

bool several(const studies::StiffnessMap& map) { return map.options.theories.size() > 1; }

/// What belongs to a pose and to no theory.
struct SlideColumn {
  std::string name;
  double studies::MapPose::*of;
};

std::vector<SlideColumn> slide_columns(const studies::StiffnessMap& map) {
  if (map.slides.key.empty()) return {};
  return {{map.slides.key + "_min_mm", &studies::MapPose::slide_min_mm},
          {map.slides.key + "_mean_mm", &studies::MapPose::slide_mean_mm},
          {map.slides.key + "_max_mm", &studies::MapPose::slide_max_mm}};
}

struct Spread {
  double smallest = 0, largest = 0;
  const studies::MapPose *smallest_at = nullptr, *largest_at = nullptr;
};

Spread range_of(const studies::StiffnessMap& map, std::size_t theory, const Column& column) {
  Spread r;
  for (const studies::MapPose& p : map.poses) {
    if (!p.reached()) continue;
    const double value = column.of(p.values[theory]);
    if (!r.smallest_at || value < r.smallest) r.smallest = value, r.smallest_at = &p;
    if (!r.largest_at || value > r.largest) r.largest = value, r.largest_at = &p;
  }
  return r;
}

std::size_t reached(const studies::StiffnessMap& map) {
  return as_size(
      std::count_if(map.poses.begin(), map.poses.end(), [](const studies::MapPose& p) { return p.reached(); }));
}

double largest_difference(const studies::StiffnessMap& map) {
  double largest = 0;
  for (const studies::MapPose& p : map.poses) largest = std::max(largest, p.relative_difference);
  return largest;
}

std::string position(const studies::MapPose& p) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", p.pose_mm_deg(0), p.pose_mm_deg(1), p.pose_mm_deg(2));
}

std::string grid_text(const studies::MapGrid& g) {
  return fmt::format(
      "{} × {} × {} poses, x {:.5g} … {:.5g}, y {:.5g} … {:.5g}, z {:.5g} … {:.5g} mm, roll pitch yaw "
      "({:g}, {:g}, {:g})°",
      g.counts[0], g.counts[1], g.counts[2], g.low_mm(0), g.high_mm(0), g.low_mm(1), g.high_mm(1), g.low_mm(2),
      g.high_mm(2), g.tilt_deg(0), g.tilt_deg(1), g.tilt_deg(2));
}

/// VTK's cell of the grid's dimension: number, and its corners as steps along the axes that have several values.
struct CellShape {
  int vtk_type = 1;  // vertex
  std::vector<std::array<int, 3>> corners = {{0, 0, 0}};
};

CellShape cell_shape(const studies::MapGrid& g) {
  CellShape shape;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (g.counts[axis] < 2) continue;
    std::vector<std::array<int, 3>> far = shape.corners;
    for (auto& corner : far) corner[axis] = 1;
    if (far.size() == 2) std::swap(far[0], far[1]);  // around a quadrilateral
    shape.corners.insert(shape.corners.end(), far.begin(), far.end());
  }
  shape.vtk_type = shape.corners.size() == 8 ? 12 : shape.corners.size() == 4 ? 9 : shape.corners.size() == 2 ? 3 : 1;
  return shape;
}

/// The poses reached as points of a grid for VTK, and its cells of points by their numbers.
struct VtkGrid {
  std::vector<const studies::MapPose*> points;
  std::vector<std::vector<int>> cells;
};

/// Cells between neighbours that are all points; `point` is the number of each pose's, -1 where it has none.
std::vector<std::vector<int>> whole_cells(const studies::MapGrid& g, const std::vector<int>& point) {
  const CellShape shape = cell_shape(g);
  std::vector<std::vector<int>> cells;
  const auto last = [&](int axis) { return std::max(1, nth(g.counts, axis) - 1); };
  for (int k = 0; k < last(2); ++k)
    for (int j = 0; j < last(1); ++j)
      for (int i = 0; i < last(0); ++i) {
        std::vector<int> cell;
        for (const auto& [a, b, c] : shape.corners) cell.push_back(point[g.index(i + a, j + b, k + c)]);
        if (std::find(cell.begin(), cell.end(), -1) == cell.end()) cells.push_back(std::move(cell));
      }
  return cells;
}

/// Points in no other cell are cells of their own, behind the others.
VtkGrid vtk_grid(const studies::StiffnessMap& map) {
  VtkGrid grid;
  std::vector<int> point(map.poses.size(), -1);
  for (std::size_t i = 0; i < map.poses.size(); ++i)
    if (map.poses[i].reached()) {
      point[i] = static_cast<int>(grid.points.size());
      grid.points.push_back(&map.poses[i]);
    }
  grid.cells = whole_cells(map.options.grid, point);
  std::vector<char> used(grid.points.size(), 0);
  for (const std::vector<int>& cell : grid.cells)
    for (const int p : cell) nth(used, p) = 1;
  for (std::size_t p = 0; p < used.size(); ++p)
    if (!used[p]) grid.cells.push_back({static_cast<int>(p)});
  return grid;
}

std::string number_text(double value) { return fmt::format("{}", value); }

struct ArrayHead {
  const char* type;
  std::string name;
  const char* more = "";  ///< further attributes
};

/// A DataArray of VTK with a line for each element.
template <class Range, class Print>
std::string vtk_array(const ArrayHead& head, const Range& range, Print print) {
  std::string text =
      fmt::format(R"(<DataArray type="{}" Name="{}"{} format="ascii">)", head.type, head.name, head.more) + "\n";
  for (const auto& each : range) text += print(each) + "\n";
  return text + "</DataArray>\n";
}

/// What holds for the whole map.
std::string vtk_field_data(const studies::MapOptions& o) {
  std::string text = "<FieldData>\n";
  text += vtk_array({"Float64", "length_mm", R"( NumberOfTuples="1")"}, std::vector{o.length_mm}, number_text);
  if (o.load_N_Nmm)
    text += vtk_array({"Float64", "load_N_Nmm", R"( NumberOfTuples="6")"}, *o.load_N_Nmm, number_text);
  else
    text += vtk_array({"Float64", "force_N", R"( NumberOfTuples="1")"}, std::vector{o.force_N}, number_text);
  return text + "</FieldData>\n";
}

/// The columns of the CSV.
std::string vtk_point_data(const studies::StiffnessMap& map, const std::vector<const studies::MapPose*>& points) {
  std::string text = "<PointData>\n";
  for (const SlideColumn& slide : slide_columns(map))
    text += vtk_array({"Float64", slide.name}, points,
                      [&](const studies::MapPose* p) { return number_text(p->*slide.of); });
  for (std::size_t t = 0; t < map.options.theories.size(); ++t)
    for (const Column& column : columns())
      text += vtk_array({"Float64", fmt::format("{}_{}", map.options.theories[t]->name, column.name)}, points,
                        [&](const studies::MapPose* p) { return number_text(column.of(p->values[t])); });
  if (several(map))
    text += vtk_array({"Float64", "relative_difference"}, points,
                      [](const studies::MapPose* p) { return number_text(p->relative_difference); });
  return text + "</PointData>\n";
}

std::string vtk_points(const std::vector<const studies::MapPose*>& points) {
  return "<Points>\n" +
         vtk_array({"Float64", "points_mm", R"( NumberOfComponents="3")"}, points,
                   [](const studies::MapPose* p) {
                     return fmt::format("{} {} {}", p->pose_mm_deg(0), p->pose_mm_deg(1), p->pose_mm_deg(2));
                   }) +
         "</Points>\n";
}

/// Cells of several points are all of one type, VTK's number of it.
std::string vtk_cells(const std::vector<std::vector<int>>& cells, int type) {
  std::string text = "<Cells>\n";
  text += vtk_array({"Int64", "connectivity"}, cells,
                    [](const auto& cell) { return fmt::format("{}", fmt::join(cell, " ")); });
  text += vtk_array({"Int64", "offsets"}, cells,
                    [end = std::size_t{0}](const auto& cell) mutable { return fmt::format("{}", end += cell.size()); });
  text += vtk_array({"UInt8", "types"}, cells,
                    [&](const auto& cell) { return fmt::format("{}", cell.size() == 1 ? 1 : type); });
  return text + "</Cells>\n";
}

}  // namespace

std::vector<OutOfReach> out_of_reach(const studies::StiffnessMap& map) {
  std::vector<OutOfReach> list;
  for (std::size_t i = 0; i < map.poses.size(); ++i) {
    if (map.poses[i].reached()) continue;
    const std::string& reason = map.poses[i].reason;
    const auto found = std::find_if(list.begin(), list.end(), [&](const OutOfReach& o) { return o.reason == reason; });
    if (found == list.end())
      list.push_back({reason, 1, i});
    else
      ++found->poses;
  }
  return list;
}

const studies::MapValues* shown(const studies::MapPose& p) { return p.values.empty() ? nullptr : &p.values.front(); }
const theories::Theory& shown_theory(const studies::StiffnessMap& map) { return *map.options.theories.front(); }

std::string map_load_text(const studies::StiffnessMap& map) {
  if (!map.options.load_N_Nmm) return fmt::format("{:g} N along x, y, z in turn", map.options.force_N);
  const Vector6& w = *map.options.load_N_Nmm;
  return fmt::format("force ({:g}, {:g}, {:g}) N, moment ({:g}, {:g}, {:g}) Nmm", w(0), w(1), w(2), w(3), w(4), w(5));
}

std::string map_kind_text(const studies::StiffnessMap& map) {
  return map.options.load_N_Nmm ? "C and K tangent under the load"
                                : "C secant from no load to the force, K tangent at the force";
}

std::string map_report(const studies::StiffnessMap& map) {
  const std::size_t n = reached(map);
  std::string text = fmt::format("{}: stiffness of the tool point over {}\nload: {}: {}\n", map.device,
                                 grid_text(map.options.grid), map_load_text(map), map_kind_text(map));
  for (const theories::Theory* theory : map.options.theories)
    if (theory->divides)
      text += fmt::format("{}: one element per member, which is exact at its nodes\n", theory->title);
  text += fmt::format("reached: {} of {} poses\n", n, map.poses.size());
  for (const OutOfReach& o : out_of_reach(map))
    text +=
        fmt::format("out of reach: {} poses: {}\n  first: {}\n", o.poses, o.reason, map.poses[o.example].out_of_reach);
  if (n == 0) return text;
  const bool same_digits = largest_difference(map) < 1e-6;
  for (std::size_t t = 0; t < (same_digits ? 1 : map.options.theories.size()); ++t) {
    std::vector<std::vector<std::string>> rows = {
        {map.options.theories[t]->title, "from", "at x, y, z (mm)", "to", "at x, y, z (mm)"}};
    for (std::size_t c = first_ranged; c <= last_ranged; ++c) {
      const Spread r = range_of(map, t, columns()[c]);
      const char* unit = c == last_ranged ? "" : " N/mm";
      rows.push_back({ranged_names[c - first_ranged], fmt::format("{:.4g}{}", r.smallest, unit),
                      position(*r.smallest_at), fmt::format("{:.4g}{}", r.largest, unit), position(*r.largest_at)});
    }
    text += "\n" + aligned(rows);
  }
  text += fmt::format(
      "\nsmallest, largest: translational stiffness over all directions of a force, rotations free. isotropy: smallest "
      "over largest eigenvalue of K (1 isotropic, 0 singular) with rotations times the characteristic length {:.6g} "
      "mm\n",
      map.options.length_mm);
  if (n > 1 && !map.slides.key.empty()) {
    std::vector<std::vector<std::string>> rows = {
        {"correlation with the mean " + map.slides.words, "Spearman", "Pearson"}};
    for (int axis = 0; axis < 3; ++axis) {
      const Correlation c = with_slides(map, axis);
      rows.push_back({fmt::format("stiffness along {}", axis_names[axis]), fmt::format("{:.3f}", c.spearman),
                      fmt::format("{:.3f}", c.pearson)});
    }
    text += "\n" + aligned(rows);
  }
  if (several(map))
    text += fmt::format("\n{}, displacements, relative: largest {:.1e}\n", against_text(map.options.theories),
                        largest_difference(map));
  return text;
}

std::string map_csv(const studies::StiffnessMap& map) {
  std::string text = "x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,";
  text += map.options.load_N_Nmm ? "fx_N,fy_N,fz_N,mx_Nmm,my_Nmm,mz_Nmm," : "force_N,";
  text += "compliance_kind,length_mm,reached,note_out_of_reach";
  for (const SlideColumn& slide : slide_columns(map)) text += "," + slide.name;
  const theories::Theories& theories = map.options.theories;
  for (const theories::Theory* theory : theories)
    for (const Column& column : columns()) text += fmt::format(",{}_{}", theory->name, column.name);
  text += several(map) ? ",relative_difference\n" : "\n";
  const std::string load = map.options.load_N_Nmm ? fmt::format("{},tangent", fmt::join(*map.options.load_N_Nmm, ","))
                                                  : fmt::format("{},secant", map.options.force_N);
  for (const studies::MapPose& p : map.poses) {
    text += fmt::format("{},{},{},{},", fmt::join(p.pose_mm_deg, ","), load, map.options.length_mm, int{p.reached()});
    if (!p.out_of_reach.empty()) text += csv_cell(p.out_of_reach);  // the kinematics' words contain commas
    for (const SlideColumn& slide : slide_columns(map)) text += p.reached() ? fmt::format(",{}", p.*slide.of) : ",";
    for (std::size_t t = 0; t < theories.size(); ++t)
      for (const Column& column : columns()) text += p.reached() ? fmt::format(",{}", column.of(p.values[t])) : ",";
    if (several(map)) text += p.reached() ? fmt::format(",{}", p.relative_difference) : ",";
    text += "\n";
  }
  return text;
}

std::string map_json(const studies::StiffnessMap& map) {
  const studies::MapOptions& o = map.options;
  Json result, grid, arrays;
  result["kind"] = "map";
  result["device"] = map.device;
  result["theories"] = json_theories(o.theories);
  if (o.load_N_Nmm)
    result["load"] = json::json_numbers(*o.load_N_Nmm, "load");
  else
    result["force_N"] = o.force_N;
  result["compliance_kind"] = o.load_N_Nmm ? "tangent" : "secant";
  result["length_mm"] = o.length_mm;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < nth(o.grid.counts, axis); ++i)
      grid[fmt::format("{}_mm", axis_names[axis])].push_back(o.grid.coordinate(axis, i));
  grid["roll_pitch_yaw_deg"] = {o.grid.tilt_deg(0), o.grid.tilt_deg(1), o.grid.tilt_deg(2)};
  grid["order"] = "x fastest";
  result["grid"] = std::move(grid);
  result["poses"] = map.poses.size();
  result["reached"] = reached(map);
  result["out_of_reach"] = Json::array();
  for (const OutOfReach& r : out_of_reach(map))
    result["out_of_reach"].push_back(
        {{"reason", r.reason}, {"poses", r.poses}, {"example", map.poses[r.example].out_of_reach}});
  const auto array = [&](const std::string& name, const auto& of) {
    Json list = Json::array();
    for (const studies::MapPose& p : map.poses) list.push_back(p.reached() ? json::json_number(of(p), name) : Json());
    return list;
  };
  for (const SlideColumn& slide : slide_columns(map))
    arrays[slide.name] = array(slide.name, [&](const studies::MapPose& p) { return p.*slide.of; });
  for (std::size_t t = 0; t < o.theories.size(); ++t)
    for (std::size_t c = 0; c < columns().size(); ++c) {
      const Column& column = columns()[c];
      const std::string& theory = o.theories[t]->name;
      arrays[theory][column.name] =
          array(column.name, [&](const studies::MapPose& p) { return column.of(p.values[t]); });
      if (c < first_ranged || c > last_ranged || reached(map) == 0) continue;
      const Spread r = range_of(map, t, column);
      Json& range = result["ranges"][theory][column.name];
      range["smallest"] = r.smallest;
      range["smallest_at"] = json::json_numbers(r.smallest_at->pose_mm_deg, "pose");
      range["largest"] = r.largest;
      range["largest_at"] = json::json_numbers(r.largest_at->pose_mm_deg, "pose");
    }
  if (reached(map) > 1 && !map.slides.key.empty())
    for (int axis = 0; axis < 3; ++axis) {
      const Correlation c = with_slides(map, axis);
      result[fmt::format("correlation_with_{}_mean", map.slides.key)][axis_names[axis]] = {{"spearman", c.spearman},
                                                                                           {"pearson", c.pearson}};
    }
  if (several(map))
    result["max_relative_difference"] = json::json_number(largest_difference(map), "max_relative_difference");
  result["arrays"] = std::move(arrays);
  return json::json_text(result);
}

std::string map_vtu(const studies::StiffnessMap& map) {
  const VtkGrid grid = vtk_grid(map);
  std::string text = R"(<?xml version="1.0" encoding="UTF-8"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid>
)";
  text += vtk_field_data(map.options);
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", grid.points.size(), grid.cells.size());
  text += vtk_point_data(map, grid.points) + vtk_points(grid.points);
  text += vtk_cells(grid.cells, cell_shape(map.options.grid).vtk_type);
  return text + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace deflect::report
