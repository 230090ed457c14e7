#include "validation/report/map_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <regex>

#include "validation/report/by_point.h"
#include "validation/report/json_text.h"
#include "validation/report/map_correlation.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

/// A number of MapValues with its name in files, unit included.
struct Column {
  std::string name;
  double (*of)(const MapValues&);
};

const std::vector<Column>& columns() {
  static const std::vector<Column> list = {
      {"cxx_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(0, 0); }},
      {"cxy_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(0, 1); }},
      {"cxz_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(0, 2); }},
      {"cyx_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(1, 0); }},
      {"cyy_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(1, 1); }},
      {"cyz_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(1, 2); }},
      {"czx_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(2, 0); }},
      {"czy_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(2, 1); }},
      {"czz_mm_per_N", [](const MapValues& v) { return v.compliance_mm_N(2, 2); }},
      {"stiffness_x_N_per_mm", [](const MapValues& v) { return v.stiffness_N_mm(0); }},
      {"stiffness_y_N_per_mm", [](const MapValues& v) { return v.stiffness_N_mm(1); }},
      {"stiffness_z_N_per_mm", [](const MapValues& v) { return v.stiffness_N_mm(2); }},
      {"smallest_N_per_mm", [](const MapValues& v) { return v.smallest_N_mm; }},
      {"largest_N_per_mm", [](const MapValues& v) { return v.largest_N_mm; }},
      {"isotropy", [](const MapValues& v) { return v.isotropy; }},
      {"kxx_N_per_mm", [](const MapValues& v) { return v.K_ii(0); }},
      {"kyy_N_per_mm", [](const MapValues& v) { return v.K_ii(1); }},
      {"kzz_N_per_mm", [](const MapValues& v) { return v.K_ii(2); }},
      {"kthx_Nmm_per_rad", [](const MapValues& v) { return v.K_ii(3); }},
      {"kthy_Nmm_per_rad", [](const MapValues& v) { return v.K_ii(4); }},
      {"kthz_Nmm_per_rad", [](const MapValues& v) { return v.K_ii(5); }}};
  return list;
}
constexpr std::size_t first_ranged = 9, last_ranged = 14;  // what a person is told the range of
constexpr const char* ranged_names[] = {"along x, 1/Cxx", "along y, 1/Cyy", "along z, 1/Czz",
                                        "smallest",       "largest",        "isotropy"};

struct TheoryColumns {
  const char *name, *title;
  std::optional<MapValues> MapPose::*values;
};
std::vector<TheoryColumns> theories_of(const StiffnessMap& map) {
  std::vector<TheoryColumns> list;
  if (map.options.analytic) list.push_back({"analytic", "analytic", &MapPose::analytic});
  if (map.options.msa) list.push_back({"msa", "MSA", &MapPose::msa});
  return list;
}

bool both(const StiffnessMap& map) { return map.options.analytic && map.options.msa; }

/// What belongs to a pose and to no theory.
struct SlideColumn {
  std::string name;
  double MapPose::*of;
};

std::vector<SlideColumn> slide_columns(const StiffnessMap& map) {
  if (map.slides.key.empty()) return {};
  return {{map.slides.key + "_min_mm", &MapPose::slide_min_mm},
          {map.slides.key + "_mean_mm", &MapPose::slide_mean_mm},
          {map.slides.key + "_max_mm", &MapPose::slide_max_mm}};
}

struct Spread {
  double smallest = 0, largest = 0;
  const MapPose *smallest_at = nullptr, *largest_at = nullptr;
};

Spread range_of(const StiffnessMap& map, std::optional<MapValues> MapPose::*theory, const Column& column) {
  Spread r;
  for (const MapPose& p : map.poses) {
    if (!p.reached()) continue;
    const double value = column.of(*(p.*theory));
    if (!r.smallest_at || value < r.smallest) r.smallest = value, r.smallest_at = &p;
    if (!r.largest_at || value > r.largest) r.largest = value, r.largest_at = &p;
  }
  return r;
}

std::size_t reached(const StiffnessMap& map) {
  return static_cast<std::size_t>(
      std::count_if(map.poses.begin(), map.poses.end(), [](const MapPose& p) { return p.reached(); }));
}

double largest_difference(const StiffnessMap& map) {
  double largest = 0;
  for (const MapPose& p : map.poses) largest = std::max(largest, p.relative_difference);
  return largest;
}

std::string reason_of(const std::string& message) {
  std::string text = std::regex_replace(message, std::regex("^(.*: )?leg [0-9]+: "), "");
  if (const std::size_t colon = text.find(": ");
      colon != text.npos && text.find_first_of("0123456789", colon) != text.npos)
    text.resize(colon);
  return std::regex_replace(text, std::regex("-?[0-9][0-9.]*(e[-+]?[0-9]+)?"), "…");
}

std::string position(const MapPose& p) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", p.pose_mm_deg(0), p.pose_mm_deg(1), p.pose_mm_deg(2));
}

std::string grid_text(const MapGrid& g) {
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

CellShape cell_shape(const MapGrid& g) {
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

}  // namespace

std::vector<OutOfReach> out_of_reach(const StiffnessMap& map) {
  std::vector<OutOfReach> list;
  for (std::size_t i = 0; i < map.poses.size(); ++i) {
    if (map.poses[i].reached()) continue;
    const std::string reason = reason_of(map.poses[i].out_of_reach);
    const auto found = std::find_if(list.begin(), list.end(), [&](const OutOfReach& o) { return o.reason == reason; });
    if (found == list.end())
      list.push_back({reason, 1, i});
    else
      ++found->poses;
  }
  return list;
}

const MapValues* shown(const MapPose& p) { return p.analytic ? &*p.analytic : p.msa ? &*p.msa : nullptr; }
const char* shown_theory(const StiffnessMap& map) { return map.options.analytic ? "analytic" : "MSA"; }

std::string map_load_text(const StiffnessMap& map) {
  if (!map.options.load_N_Nmm) return fmt::format("{:g} N along x, y, z in turn", map.options.force_N);
  const Vector6& w = *map.options.load_N_Nmm;
  return fmt::format("force ({:g}, {:g}, {:g}) N, moment ({:g}, {:g}, {:g}) Nmm", w(0), w(1), w(2), w(3), w(4), w(5));
}

std::string map_kind_text(const StiffnessMap& map) {
  return map.options.load_N_Nmm ? "C and K tangent under the load"
                                : "C secant from no load to the force, K tangent at the force";
}

std::string map_report(const StiffnessMap& map) {
  const std::size_t n = reached(map);
  std::string text = fmt::format("{}: stiffness of the tool point over {}\nload: {}: {}\n", map.device,
                                 grid_text(map.options.grid), map_load_text(map), map_kind_text(map));
  if (map.options.msa) text += "MSA: one element per member, which is exact at its nodes\n";
  text += fmt::format("reached: {} of {} poses\n", n, map.poses.size());
  for (const OutOfReach& o : out_of_reach(map))
    text +=
        fmt::format("out of reach: {} poses: {}\n  first: {}\n", o.poses, o.reason, map.poses[o.example].out_of_reach);
  if (n == 0) return text;
  std::vector<TheoryColumns> told = theories_of(map);
  if (both(map) && largest_difference(map) < 1e-6) told.pop_back();  // the same digits again
  for (const TheoryColumns& theory : told) {
    std::vector<std::vector<std::string>> rows = {{theory.title, "from", "at x, y, z (mm)", "to", "at x, y, z (mm)"}};
    for (std::size_t c = first_ranged; c <= last_ranged; ++c) {
      const Spread r = range_of(map, theory.values, columns()[c]);
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
  if (both(map))
    text += fmt::format("\nanalytic against MSA, displacements, relative: largest {:.1e}\n", largest_difference(map));
  return text;
}

std::string map_csv(const StiffnessMap& map) {
  std::string text = "x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,";
  text += map.options.load_N_Nmm ? "fx_N,fy_N,fz_N,mx_Nmm,my_Nmm,mz_Nmm," : "force_N,";
  text += "compliance_kind,length_mm,reached,note_out_of_reach";
  for (const SlideColumn& slide : slide_columns(map)) text += "," + slide.name;
  const std::vector<TheoryColumns> theories = theories_of(map);
  for (const TheoryColumns& theory : theories)
    for (const Column& column : columns()) text += fmt::format(",{}_{}", theory.name, column.name);
  text += both(map) ? ",relative_difference\n" : "\n";
  const std::string load = map.options.load_N_Nmm ? fmt::format("{},tangent", fmt::join(*map.options.load_N_Nmm, ","))
                                                  : fmt::format("{},secant", map.options.force_N);
  for (const MapPose& p : map.poses) {
    text += fmt::format("{},{},{},{},", fmt::join(p.pose_mm_deg, ","), load, map.options.length_mm, int{p.reached()});
    std::string note = p.out_of_reach;  // in quotes; the kinematics' words contain commas
    for (std::size_t at = note.find('"'); at != note.npos; at = note.find('"', at + 2)) note.insert(at, 1, '"');
    if (!note.empty()) text += '"' + note + '"';
    for (const SlideColumn& slide : slide_columns(map)) text += p.reached() ? fmt::format(",{}", p.*slide.of) : ",";
    for (const TheoryColumns& theory : theories)
      for (const Column& column : columns())
        text += p.reached() ? fmt::format(",{}", column.of(*(p.*theory.values))) : ",";
    if (both(map)) text += p.reached() ? fmt::format(",{}", p.relative_difference) : ",";
    text += "\n";
  }
  return text;
}

std::string map_json(const StiffnessMap& map) {
  const MapOptions& o = map.options;
  Json result, grid, arrays;
  result["kind"] = "map";
  result["device"] = map.device;
  if (o.load_N_Nmm)
    result["load"] = json_numbers(*o.load_N_Nmm, "load");
  else
    result["force_N"] = o.force_N;
  result["compliance_kind"] = o.load_N_Nmm ? "tangent" : "secant";
  result["length_mm"] = o.length_mm;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < o.grid.counts[static_cast<std::size_t>(axis)]; ++i)
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
    for (const MapPose& p : map.poses) list.push_back(p.reached() ? json_number(of(p), name) : Json());
    return list;
  };
  for (const SlideColumn& slide : slide_columns(map))
    arrays[slide.name] = array(slide.name, [&](const MapPose& p) { return p.*slide.of; });
  for (const TheoryColumns& theory : theories_of(map))
    for (std::size_t c = 0; c < columns().size(); ++c) {
      const Column& column = columns()[c];
      arrays[theory.name][column.name] =
          array(column.name, [&](const MapPose& p) { return column.of(*(p.*theory.values)); });
      if (c < first_ranged || c > last_ranged || reached(map) == 0) continue;
      const Spread r = range_of(map, theory.values, column);
      Json& range = result["ranges"][theory.name][column.name];
      range["smallest"] = r.smallest;
      range["smallest_at"] = json_numbers(r.smallest_at->pose_mm_deg, "pose");
      range["largest"] = r.largest;
      range["largest_at"] = json_numbers(r.largest_at->pose_mm_deg, "pose");
    }
  if (reached(map) > 1 && !map.slides.key.empty())
    for (int axis = 0; axis < 3; ++axis) {
      const Correlation c = with_slides(map, axis);
      result[fmt::format("correlation_with_{}_mean", map.slides.key)][axis_names[axis]] = {{"spearman", c.spearman},
                                                                                           {"pearson", c.pearson}};
    }
  if (both(map)) result["max_relative_difference"] = json_number(largest_difference(map), "max_relative_difference");
  result["arrays"] = std::move(arrays);
  return json_text(result);
}

std::string map_vtu(const StiffnessMap& map) {
  const MapGrid& g = map.options.grid;
  std::vector<int> point(map.poses.size(), -1);
  std::vector<const MapPose*> points;
  for (std::size_t i = 0; i < map.poses.size(); ++i)
    if (map.poses[i].reached()) {
      point[i] = static_cast<int>(points.size());
      points.push_back(&map.poses[i]);
    }
  const CellShape shape = cell_shape(g);
  std::vector<std::vector<int>> cells;
  std::vector<char> used(points.size(), 0);
  const auto last = [&](int axis) { return std::max(1, g.counts[static_cast<std::size_t>(axis)] - 1); };
  for (int k = 0; k < last(2); ++k)
    for (int j = 0; j < last(1); ++j)
      for (int i = 0; i < last(0); ++i) {
        std::vector<int> cell;
        for (const auto& [a, b, c] : shape.corners) cell.push_back(point[g.index(i + a, j + b, k + c)]);
        if (std::find(cell.begin(), cell.end(), -1) != cell.end()) continue;
        for (const int p : cell) used[static_cast<std::size_t>(p)] = 1;
        cells.push_back(std::move(cell));
      }
  for (std::size_t p = 0; p < points.size(); ++p)
    if (!used[p]) cells.push_back({static_cast<int>(p)});

  std::string text = R"(<?xml version="1.0" encoding="UTF-8"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid>
)";
  const auto array = [&](const char* type, const std::string& name, const char* more, const auto& range, auto print) {
    text += fmt::format(R"(<DataArray type="{}" Name="{}"{} format="ascii">)", type, name, more) + "\n";
    for (const auto& each : range) text += print(each) + "\n";
    text += "</DataArray>\n";
  };
  const auto number = [](double value) { return fmt::format("{}", value); };
  text += "<FieldData>\n";
  array("Float64", "length_mm", R"( NumberOfTuples="1")", std::vector{map.options.length_mm}, number);
  if (map.options.load_N_Nmm)
    array("Float64", "load_N_Nmm", R"( NumberOfTuples="6")", *map.options.load_N_Nmm, number);
  else
    array("Float64", "force_N", R"( NumberOfTuples="1")", std::vector{map.options.force_N}, number);
  text += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n", points.size(),
                      cells.size());
  for (const SlideColumn& slide : slide_columns(map))
    array("Float64", slide.name, "", points, [&](const MapPose* p) { return number(p->*slide.of); });
  for (const TheoryColumns& theory : theories_of(map))
    for (const Column& column : columns())
      array("Float64", fmt::format("{}_{}", theory.name, column.name), "", points,
            [&](const MapPose* p) { return number(column.of(*(p->*theory.values))); });
  if (both(map))
    array("Float64", "relative_difference", "", points,
          [&](const MapPose* p) { return number(p->relative_difference); });
  text += "</PointData>\n<Points>\n";
  array("Float64", "points_mm", R"( NumberOfComponents="3")", points, [](const MapPose* p) {
    return fmt::format("{} {} {}", p->pose_mm_deg(0), p->pose_mm_deg(1), p->pose_mm_deg(2));
  });
  text += "</Points>\n<Cells>\n";
  array("Int64", "connectivity", "", cells, [](const auto& cell) { return fmt::format("{}", fmt::join(cell, " ")); });
  array("Int64", "offsets", "", cells,
        [end = std::size_t{0}](const auto& cell) mutable { return fmt::format("{}", end += cell.size()); });
  array("UInt8", "types", "", cells,
        [&](const auto& cell) { return fmt::format("{}", cell.size() == 1 ? 1 : shape.vtk_type); });
  text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return text;
}

}  // namespace deflect
