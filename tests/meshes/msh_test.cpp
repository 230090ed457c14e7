#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

#include "meshes/gmsh.h"
#include "msa/base/error.h"
#include "tests/meshes/scratch.h"

namespace deflect::gmsh {
namespace {

/// Bodies of the sections by name, in the order of the file.
std::multimap<std::string, std::string> sections(const std::string& text) {
  std::multimap<std::string, std::string> found;
  std::istringstream lines(text);
  std::string name, body;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("$End")) {
      EXPECT_EQ(line, "$End" + name);
      found.emplace(name, body);
      name.clear();
    } else if (line.starts_with('$')) {
      EXPECT_EQ(name, "") << "a section without an end";
      name = line.substr(1);
      body.clear();
    } else {
      body += line + "\n";
    }
  }
  EXPECT_EQ(name, "");
  return found;
}

std::multimap<std::string, std::string> written(const LineMesh& mesh, const FieldData& fields) {
  const Scratch scratch;
  write_msh(scratch / "a.msh", mesh, fields);
  EXPECT_EQ(scratch.files(), 1);
  return sections(read_text(scratch / "a.msh"));
}

std::string only(const std::multimap<std::string, std::string>& file, const std::string& name) {
  EXPECT_EQ(file.count(name), 1u) << name;
  return file.count(name) == 1 ? file.find(name)->second : "";
}

std::map<int, Vector3> nodes(const std::string& body) {
  std::istringstream in(body);
  std::size_t blocks = 0, all = 0, first = 0, last = 0;
  in >> blocks >> all >> first >> last;
  std::map<int, Vector3> found;
  for (std::size_t block = 0; block < blocks; ++block) {
    std::size_t dimension = 0, entity = 0, parametric = 0, count = 0;
    in >> dimension >> entity >> parametric >> count;
    std::vector<int> tags(count);
    for (int& tag : tags) in >> tag;
    for (const int tag : tags) in >> found[tag].x() >> found[tag].y() >> found[tag].z();
  }
  EXPECT_TRUE(in);
  EXPECT_EQ(found.size(), all);
  return found;
}

struct Element {
  int entity, a, b;
  bool operator==(const Element&) const = default;
};

std::map<int, Element> elements(const std::string& body) {
  std::istringstream in(body);
  std::size_t blocks = 0, all = 0, first = 0, last = 0;
  in >> blocks >> all >> first >> last;
  std::map<int, Element> found;
  for (std::size_t block = 0; block < blocks; ++block) {
    int dimension = 0, entity = 0, type = 0, count = 0;
    in >> dimension >> entity >> type >> count;
    EXPECT_EQ(dimension, 1);
    EXPECT_EQ(type, 1);
    for (int i = 0, tag = 0, a = 0, b = 0; i < count && in >> tag >> a >> b; ++i) found[tag] = {entity, a, b};
  }
  EXPECT_TRUE(in);
  EXPECT_EQ(found.size(), all);
  return found;
}

TEST(Msh, HoldsMeshAndGroups) {
  const LineMesh mesh = small_mesh();
  const auto file = written(mesh, {});
  EXPECT_EQ(only(file, "MeshFormat"), "4.1 0 8\n");
  EXPECT_EQ(only(file, "PhysicalNames"), "3\n1 1 \"leg 1 guideway\"\n1 2 \"spare\"\n1 3 \"platform\"\n");

  const auto points = nodes(only(file, "Nodes"));
  ASSERT_EQ(points.size(), mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    EXPECT_LT((points.at(static_cast<int>(i) + 1) - 1000 * mesh.points[i]).norm(), 1e-12);

  const std::map<int, Element> wanted = {{1, {1, 1, 2}}, {2, {3, 2, 3}}, {3, {1, 5, 3}}};
  EXPECT_EQ(elements(only(file, "Elements")), wanted);
  EXPECT_EQ(file.count("NodeData") + file.count("ElementData"), 0u);
}

TEST(Msh, HoldsOneViewPerField) {
  const auto file = written(small_mesh(), small_fields());
  EXPECT_EQ(file.count("NodeData"), 2u);
  EXPECT_EQ(
      file.find("NodeData")->second,
      "1\n\"displacement_mm\"\n1\n0\n3\n0\n3\n5\n1 1 2 3\n2 0.1 0.2 0.25\n3 -4 5 6\n4 7 8 9\n5 1e-300 0 1e+300\n");
  EXPECT_EQ(only(file, "ElementData"), "1\n\"axial_force_N\"\n1\n0\n3\n0\n1\n3\n1 1.5\n2 -2\n3 0.1\n");
  EXPECT_EQ(only(file, "Nodes"), only(written(small_mesh(), {}), "Nodes"));
}

TEST(Msh, NamesFitTheFormat) {
  LineMesh mesh = small_mesh();
  mesh.groups = {"the \"first\"\nline", "", "é" + std::string(116, 'x') + "éé" + "z"};
  const auto file = written(mesh, {{}, {{"\"Fx\" <N>", {1, 2, 3}}}});
  EXPECT_EQ(only(file, "PhysicalNames"),
            "3\n1 1 \"the 'first' line\"\n1 2 \"unnamed\"\n1 3 \"é" + std::string(116, 'x') + "é\"\n");
  EXPECT_EQ(only(file, "ElementData").substr(0, 13), "1\n\"'Fx' <N>\"\n");

  mesh.groups = {"leg", "leg", "leg"};
  EXPECT_EQ(only(written(mesh, {}), "PhysicalNames"), "3\n1 1 \"leg\"\n1 2 \"leg (2)\"\n1 3 \"leg (3)\"\n");
}

TEST(Msh, MeshesWithLittleInThem) {
  EXPECT_EQ(only(written({}, {}), "MeshFormat"), "4.1 0 8\n");
  EXPECT_EQ(written({}, {{{"d", {}}}, {{"f", {}}}}).count("NodeData"), 0u);
  const auto file = written({{{0, 0, 1}}, {}, {}}, {{{"d", {{1, 2, 3}}}}, {}});
  EXPECT_EQ(nodes(only(file, "Nodes")).size(), 1u);
  EXPECT_EQ(file.count("NodeData"), 1u);
}

TEST(Msh, SameBytesEveryTime) {
  const Scratch scratch;
  write_msh(scratch / "a.msh", small_mesh(), small_fields());
  write_msh(scratch / "b", small_mesh(), small_fields());
  EXPECT_EQ(read_text(scratch / "a.msh"), read_text(scratch / "b"));
}

TEST(Msh, FailedWriteLeavesTheOldFile) { expect_old_file_survives<InputError>(write_msh); }

TEST(Msh, RefusesDefectiveMeshesBeforeTouchingTheFile) {
  const Scratch scratch;
  LineMesh mesh = small_mesh();
  mesh.cells[0].b = 5;
  EXPECT_THROW(write_msh(scratch / "a.msh", mesh, {}), std::invalid_argument);
  EXPECT_EQ(scratch.files(), 0);
}

}  // namespace
}  // namespace deflect::gmsh
