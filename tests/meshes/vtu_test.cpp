#include "meshes/vtu.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>

#include "msa/base/error.h"
#include "tests/meshes/scratch.h"

namespace deflect {
namespace {

std::string written(const LineMesh& mesh, const FieldData& fields) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", mesh, fields);
  EXPECT_EQ(scratch.files(), 1);
  return read_text(scratch / "a.vtu");
}

/// Bodies of the data arrays by "parents/name", names as they stand in the file; fails when the XML is not well-formed.
std::map<std::string, std::string> arrays(const std::string& text) {
  static const std::regex tag(R"(<(/?)([A-Za-z]+)((?: [A-Za-z_]+="[^"<]*")*)>)");
  static const std::regex name(R"rx( Name="([^"]*)")rx");
  static const std::regex bare_ampersand("&(?!(amp|lt|gt|quot);)");
  const std::string head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  EXPECT_TRUE(text.starts_with(head));
  EXPECT_FALSE(std::regex_search(text, bare_ampersand));

  std::map<std::string, std::string> found;
  std::vector<std::string> open;
  std::string array;
  auto at = text.cbegin() + static_cast<std::ptrdiff_t>(head.size());
  for (std::smatch m; std::regex_search(at, text.cend(), m, tag); at = m[0].second) {
    const std::string body(at, m[0].first);
    EXPECT_EQ(body.find_first_of("<>"), std::string::npos) << body;
    if (m[1].length() == 0) {
      const std::string attributes = m[3];
      std::smatch n;
      array = std::regex_search(attributes, n, name) ? n[1].str() : "";
      open.push_back(m[2]);
      continue;
    }
    if (open.empty() || open.back() != m[2]) {
      ADD_FAILURE() << "unexpected </" << m[2] << ">";
      return {};
    }
    open.pop_back();
    if (m[2] != "DataArray") continue;
    EXPECT_TRUE(found.emplace(open.back() + "/" + array, body).second) << array;
  }
  EXPECT_TRUE(open.empty());
  EXPECT_EQ(std::string(at, text.cend()), "\n");
  return found;
}

std::vector<double> numbers(const std::string& body) {
  std::istringstream in(body);
  std::vector<double> out;
  for (std::string word; in >> word;) out.push_back(std::stod(word));
  return out;
}

TEST(Vtu, HoldsMeshAndGroups) {
  const std::string text = written(small_mesh(), {});
  EXPECT_NE(text.find(R"(<Piece NumberOfPoints="5" NumberOfCells="3">)"), std::string::npos);
  auto found = arrays(text);
  std::vector<double> points;
  for (const Vector3& p : small_mesh().points)
    for (const double x : p) points.push_back(1000 * x);
  EXPECT_EQ(numbers(found.at("Points/points_mm")), points) << "to the last bit";
  EXPECT_EQ(numbers(found.at("Cells/connectivity")), (std::vector<double>{0, 1, 1, 2, 4, 2}));
  EXPECT_EQ(numbers(found.at("Cells/offsets")), (std::vector<double>{2, 4, 6}));
  EXPECT_EQ(numbers(found.at("Cells/types")), (std::vector<double>{3, 3, 3}));
  EXPECT_EQ(numbers(found.at("CellData/group")), (std::vector<double>{0, 2, 0}));

  std::string names;
  for (const double code : numbers(found.at("FieldData/group_names")))
    names += code == 0 ? '|' : static_cast<char>(code);
  EXPECT_EQ(names, "leg 1 guideway|spare|platform|");
  EXPECT_NE(text.find(R"(Name="group_names" NumberOfTuples="3")"), std::string::npos);
  EXPECT_EQ(found.size(), 6u);
}

TEST(Vtu, FieldsRoundTrip) {
  FieldData fields = small_fields();
  fields.cells.push_back({"odd", {1.0 / 3, 5e-324, -1.7976931348623157e308}});
  auto found = arrays(written(small_mesh(), fields));
  for (const PointField& field : fields.points) {
    std::vector<double> wanted;
    for (const Vector3& v : field.values) wanted.insert(wanted.end(), v.begin(), v.end());
    std::istringstream in(found.at("PointData/" + field.name));
    std::vector<double> got;
    for (std::string word; in >> word;) got.push_back(std::strtod(word.c_str(), nullptr));
    EXPECT_EQ(got, wanted);
  }
  EXPECT_EQ(found.at("CellData/axial_force_N"), "\n1.5\n-2\n0.1\n");
  EXPECT_EQ(found.at("CellData/odd"), "\n0.3333333333333333\n5e-324\n-1.7976931348623157e+308\n");
}

TEST(Vtu, NamesAreEscaped) {
  LineMesh mesh = small_mesh();
  mesh.groups[0] = "a<&>\"é";
  const auto found = arrays(written(mesh, {{}, {{"<\"F\" & 'M'>\n\x01", {1, 2, 3}}}}));
  EXPECT_TRUE(found.count("CellData/&lt;&quot;F&quot; &amp; 'M'&gt;  "));
  EXPECT_TRUE(found.at("FieldData/group_names").starts_with("\n97 60 38 62 34 -61 -87 0\n"))
      << found.at("FieldData/group_names");
}

TEST(Vtu, EmptyMesh) { EXPECT_EQ(arrays(written({}, {})).size(), 6u); }

TEST(Vtu, FailedWriteLeavesTheOldFile) { expect_old_file_survives<InputError>(write_vtu); }

TEST(Vtu, RefusesWhatTheMeshDoesNotCarry) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::map<std::string, std::function<void(LineMesh&, FieldData&)>> defects = {
      {"cell 2 names point 5, there are 5", [](LineMesh& m, FieldData&) { m.cells[2].a = 5; }},
      {"cell 0 names point -1, there are 5", [](LineMesh& m, FieldData&) { m.cells[0].b = -1; }},
      {"cell 1 names group 3, there are 3", [](LineMesh& m, FieldData&) { m.cells[1].group = 3; }},
      {"cell 1 begins and ends at point 2", [](LineMesh& m, FieldData&) { m.cells[1].a = 2; }},
      {"point 3 is not finite", [&](LineMesh& m, FieldData&) { m.points[3].y() = nan; }},
      {"field \"rotation_rad\" has 4 values for 5 points",
       [](LineMesh&, FieldData& f) { f.points[1].values.pop_back(); }},
      {"field \"axial_force_N\" has 4 values for 3 cells",
       [](LineMesh&, FieldData& f) { f.cells[0].values.push_back(0); }},
      {"displacement_mm at point 1 is not finite", [&](LineMesh&, FieldData& f) { f.points[0].values[1].z() = nan; }},
      {"axial_force_N in cell 2 is not finite", [&](LineMesh&, FieldData& f) { f.cells[0].values[2] = 1 / 0.0; }},
      {"a field has no name", [](LineMesh&, FieldData& f) { f.cells[0].name.clear(); }},
      {"two fields are called \"rotation_rad\"", [](LineMesh&, FieldData& f) { f.points[0].name = "rotation_rad"; }},
      {"the name \"group\" is taken by the cells' groups", [](LineMesh&, FieldData& f) { f.cells[0].name = "group"; }},
  };
  const Scratch scratch;
  for (const auto& [message, spoil] : defects) {
    LineMesh mesh = small_mesh();
    FieldData fields = small_fields();
    spoil(mesh, fields);
    try {
      write_vtu(scratch / "a.vtu", mesh, fields);
      ADD_FAILURE() << "accepted: " << message;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), "mesh to export: " + message);
    }
  }
  EXPECT_EQ(scratch.files(), 0);
}

}  // namespace
}  // namespace deflect
