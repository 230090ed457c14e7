#include "meshes/line_mesh.h"
#include "msa/base/index.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace deflect {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("mesh to export: " + what); }

void check_finite(bool finite, const std::string& what, std::size_t index) {
  if (!finite) refuse(fmt::format("{} {} is not finite", what, index));
}

void check_index(int index, std::size_t count, const char* what, std::size_t cell) {
  if (index < 0 || as_size(index) >= count)
    refuse(fmt::format("cell {} names {} {}, there are {}", cell, what, index, count));
}

void check_name(const std::string& name, std::set<std::string>& names) {
  if (name.empty()) refuse("a field has no name");
  if (name == "group") refuse("the name \"group\" is taken by the cells' groups");
  if (!names.insert(name).second) refuse(fmt::format("two fields are called \"{}\"", name));
}

void check_size(const std::string& name, std::size_t values, std::size_t wanted, const char* places) {
  if (values != wanted) refuse(fmt::format("field \"{}\" has {} values for {} {}", name, values, wanted, places));
}

}  // namespace

void check(const LineMesh& mesh, const FieldData& fields) {
  for (std::size_t i = 0; i < mesh.points.size(); ++i) check_finite(mesh.points[i].allFinite(), "point", i);
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const LineCell& cell = mesh.cells[i];
    check_index(cell.a, mesh.points.size(), "point", i);
    check_index(cell.b, mesh.points.size(), "point", i);
    check_index(cell.group, mesh.groups.size(), "group", i);
    if (cell.a == cell.b) refuse(fmt::format("cell {} begins and ends at point {}", i, cell.a));
  }
  std::set<std::string> names;
  for (const PointField& field : fields.points) {
    check_name(field.name, names);
    check_size(field.name, field.values.size(), mesh.points.size(), "points");
    for (std::size_t i = 0; i < field.values.size(); ++i)
      check_finite(field.values[i].allFinite(), field.name + " at point", i);
  }
  names.clear();
  for (const CellField& field : fields.cells) {
    check_name(field.name, names);
    check_size(field.name, field.values.size(), mesh.cells.size(), "cells");
    for (std::size_t i = 0; i < field.values.size(); ++i)
      check_finite(std::isfinite(field.values[i]), field.name + " in cell", i);
  }
}

}  // namespace deflect
