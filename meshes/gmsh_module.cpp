// The module deflect_gmsh. Gmsh keeps its state in globals, is left unusable by a failed mesh, and throws std::string:
// every call here is one session, begun with defaults and ended whatever happens.
#include "meshes/gmsh_module.h"
#include "msa/base/index.h"

#include <gmsh.h>

#include <algorithm>
#include <clocale>
#include <cstddef>
#include <exception>
#include <set>
#include <string_view>

// Null where Gmsh was built without OpenMP.
extern "C" {
int omp_get_max_threads() __attribute__((weak));
void omp_set_num_threads(int) __attribute__((weak));
}

namespace deflect::gmsh {
namespace {

namespace api = ::gmsh;

constexpr double mm_per_m = 1000;
constexpr int line_element = 1;
constexpr std::size_t longest_name = 120;  // with a number behind it less than the 127 that Gmsh writes

class Session {
 public:
  Session()
      : locale_(std::setlocale(LC_ALL, nullptr)), threads_(omp_get_max_threads != nullptr ? omp_get_max_threads() : 0) {
    api::initialize(0, nullptr, false);  // without the user's files, which could change results
    api::option::setNumber("General.Terminal", 0);
    api::option::setNumber("General.AbortOnError", 3);  // every error is an exception
    api::option::setNumber("General.ExpertMode", 1);    // asks nothing on standard input
    api::option::setNumber("General.NumThreads", 1);
    api::model::add(model);
  }
  ~Session() {
    try {
      api::finalize();
    } catch (...) {  // nothing is left to be saved, and the next session starts afresh
    }
    // The process is left as it was: Gmsh takes the environment's locale and sets the caller's OpenMP threads.
    std::setlocale(LC_ALL, locale_.c_str());
    if (threads_ > 0 && omp_set_num_threads != nullptr) omp_set_num_threads(threads_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  static constexpr const char* model = "deflect";

 private:
  std::string locale_;
  int threads_;
};

/// Runs `work` in a session and turns whatever it throws into text.
template <typename Work>
std::string in_session(Work work) noexcept {
  const auto said = [](std::string_view what) { return std::string(what.empty() ? "an unnamed error" : what); };
  try {
    const Session session;
    work();
    return {};
  } catch (const std::string& error) {
    return said(error);
  } catch (const char* error) {
    return said(error);
  } catch (const std::exception& error) {
    return said(error.what());
  } catch (...) {
    return said("");
  }
}

std::string subdivide(const std::vector<double>& lengths, std::vector<std::vector<double>>& positions) noexcept {
  return in_session([&] {
    positions.clear();
    for (const char* influence : {"Mesh.MeshSizeFromPoints", "Mesh.MeshSizeFromCurvature",
                                  "Mesh.MeshSizeExtendFromBoundary", "Mesh.MeshSizeFromParametricPoints"})
      api::option::setNumber(influence, 0);
    api::option::setNumber("Mesh.MeshSizeFactor", 1);
    api::option::setNumber("Mesh.MeshSizeMin", 1);
    api::option::setNumber("Mesh.MeshSizeMax", 1);

    std::vector<int> curves;
    for (const double length : lengths) {
      const auto y = static_cast<double>(curves.size());
      const int from = api::model::geo::addPoint(0, y, 0);
      const int to = api::model::geo::addPoint(length, y, 0);
      curves.push_back(api::model::geo::addLine(from, to));
    }
    api::model::geo::synchronize();
    api::model::mesh::generate(1);

    std::vector<std::size_t> tags;
    std::vector<double> xyz, parameters;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      api::model::mesh::getNodes(tags, xyz, parameters, 1, curves[i], true, false);
      std::vector<double>& member = positions.emplace_back();
      for (std::size_t k = 0; k < xyz.size(); k += 3) member.push_back(xyz[k] / lengths[i]);
      std::sort(member.begin(), member.end());
    }
  });
}

/// Names stand in double quotes without any escape, in buffers of fixed length.
std::string printable(std::string name) {
  if (name.size() > longest_name) {
    std::size_t end = longest_name;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;  // not within a UTF-8 character
    name.resize(end);
  }
  for (char& c : name) {
    if (c == '"') c = '\'';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return name;
}

struct Nodes {
  std::vector<std::size_t> tags;
  std::vector<double> xyz;
};

void add_mesh(const LineMesh& mesh) {
  // A node lives on one entity: that of the first cell which uses it, or the extra one behind all groups.
  const std::size_t groups = mesh.groups.size();
  std::vector<std::size_t> owner(mesh.points.size(), groups);
  std::vector<std::vector<std::size_t>> cells(groups), ends(groups);
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const LineCell& cell = mesh.cells[i];
    const auto group = as_size(cell.group);
    cells[group].push_back(i + 1);
    for (const int point : {cell.a, cell.b}) {
      const auto p = as_size(point);
      ends[group].push_back(p + 1);
      if (owner[p] == groups) owner[p] = group;
    }
  }
  std::vector<Nodes> nodes(groups + 1);
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    Nodes& own = nodes[owner[p]];
    own.tags.push_back(p + 1);
    for (const double x : mesh.points[p]) own.xyz.push_back(mm_per_m * x);
  }

  std::vector<int> entities;
  std::set<std::string> names;
  for (std::size_t g = 0; g < groups; ++g) {
    const int entity = entities.emplace_back(api::model::addDiscreteEntity(1));
    api::model::mesh::addNodes(1, entity, nodes[g].tags, nodes[g].xyz);
    const int physical = api::model::addPhysicalGroup(1, {entity});
    const std::string name = mesh.groups[g].empty() ? "unnamed" : printable(mesh.groups[g]);
    std::string own = name;  // Gmsh drops a name that it has already
    for (int k = 2; !names.insert(own).second; ++k) own = name + " (" + std::to_string(k) + ")";
    api::model::setPhysicalName(1, physical, own);
  }
  if (const Nodes& unused = nodes[groups]; !unused.tags.empty())
    api::model::mesh::addNodes(0, api::model::addDiscreteEntity(0), unused.tags, unused.xyz);
  // Elements last: a group's cells may end at nodes of the groups behind it.
  for (std::size_t g = 0; g < groups; ++g)
    if (!cells[g].empty()) api::model::mesh::addElementsByType(entities[g], line_element, cells[g], ends[g]);
}

void append_view(const std::string& file, const std::string& name, const char* kind, std::size_t count,
                 const std::vector<double>& values, int components) {
  if (count == 0) return;
  std::vector<std::size_t> tags(count);
  for (std::size_t i = 0; i < count; ++i) tags[i] = i + 1;
  const int view = api::view::add(printable(name));
  api::view::addHomogeneousModelData(view, 0, Session::model, kind, tags, values, 0, components);
  api::view::write(view, file, true);
}

std::string write_msh(const std::string& file, const LineMesh& mesh, const FieldData& fields) noexcept {
  return in_session([&] {
    api::option::setNumber("Mesh.MshFileVersion", 4.1);
    api::option::setNumber("Mesh.Binary", 0);
    api::option::setNumber("Mesh.SaveAll", 1);  // fields have values at points that no cell uses, too
    api::option::setNumber("PostProcessing.SaveMesh", 0);
    api::option::setNumber("PostProcessing.SaveInterpolationMatrices", 0);  // a line's are known to every reader
    add_mesh(mesh);
    api::write(file);
    for (const PointField& field : fields.points) {
      std::vector<double> values;
      for (const Vector3& v : field.values) values.insert(values.end(), v.begin(), v.end());
      append_view(file, field.name, "NodeData", field.values.size(), values, 3);
    }
    for (const CellField& field : fields.cells)
      append_view(file, field.name, "ElementData", field.values.size(), field.values, 1);
  });
}

constexpr Module table = {{module_kind.interface, DEFLECT_VERSION}, subdivide, write_msh};

}  // namespace
}  // namespace deflect::gmsh

extern "C" __attribute__((visibility("default"))) const deflect::ModuleHead* deflect_gmsh_module() {
  return &deflect::gmsh::table;
}
