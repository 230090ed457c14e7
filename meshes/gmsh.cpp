#include "meshes/gmsh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <sstream>
#include <string>

#include "meshes/gmsh_module.h"
#include "msa/base/error.h"
#include "msa/base/files.h"

namespace deflect::gmsh {
namespace fs = std::filesystem;
namespace {

constexpr double most_elements = 1e6;

/// Runs `call` on the module, one call at a time because Gmsh is not thread-safe. A failed load is tried again.
template <typename Call>
std::string with_module(Call call) {
  static std::mutex mutex;
  static const Module* module = nullptr;
  const std::lock_guard lock(mutex);
  if (module == nullptr) module = static_cast<const Module*>(&load_module(module_kind));
  return call(*module);
}

bool is_positive(double x) { return std::isfinite(x) && x > 0; }

void check_subdivision(const std::vector<double>& lengths, double size) {
  if (!is_positive(size)) throw InputError(fmt::format("element size {} m: a positive number is wanted", size));
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (!is_positive(lengths[i]))
      throw InputError(fmt::format("member {} has length {} m: a positive number is wanted", i + 1, lengths[i]));
    if (lengths[i] / size > most_elements)
      throw InputError(
          fmt::format("element size {} m asks for more than {:.0f} elements in member {}, which is {} m long; "
                      "choose a larger size",
                      size, most_elements, i + 1, lengths[i]));
  }
}

/// Gmsh can fail without a word.
bool is_subdivision(const std::vector<double>& positions) {
  return positions.size() >= 2 && positions.front() == 0 && positions.back() == 1 &&
         std::adjacent_find(positions.begin(), positions.end(), std::greater_equal<>()) == positions.end();
}

[[noreturn]] void refuse_file(const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: cannot be written ({})", path.string(), reason));
}

/// Gmsh does not look whether its writes succeed: a full disk leaves sections without their end, or none at all.
bool is_complete(const std::string& text, const LineMesh& mesh, const FieldData& fields) {
  std::size_t begun = 0, ended = 0, elements = 0, node_data = 0, element_data = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with('$')) continue;
    ++(line.starts_with("$End") ? ended : begun);
    elements += line == "$EndElements";
    node_data += line == "$EndNodeData";
    element_data += line == "$EndElementData";
  }
  return begun > 0 && begun == ended && text.back() == '\n' && elements == (mesh.cells.empty() ? 0u : 1u) &&
         node_data == (mesh.points.empty() ? 0 : fields.points.size()) &&
         element_data == (mesh.cells.empty() ? 0 : fields.cells.size());
}

}  // namespace

std::vector<std::vector<double>> subdivide(const std::vector<double>& lengths, double element_size) {
  check_subdivision(lengths, element_size);
  if (lengths.empty()) return {};
  // Lengths in elements keep Gmsh's numbers far from its tolerances whatever the scale. A member below one element is
  // one element, however short it is.
  std::vector<double> sizes;
  for (const double length : lengths) sizes.push_back(std::max(length / element_size, 0.5));
  std::vector<std::vector<double>> positions;
  const std::string error = with_module([&](const Module& module) { return module.subdivide(sizes, positions); });
  if (!error.empty()) throw ModelError(fmt::format("Gmsh cannot subdivide the members: {}", error));
  if (positions.size() != lengths.size() || !std::all_of(positions.begin(), positions.end(), is_subdivision))
    throw ModelError("Gmsh gave no subdivision of the members and did not say why");
  return positions;
}

void write_msh(const fs::path& path, const LineMesh& mesh, const FieldData& fields) {
  check(mesh, fields);
  // Gmsh takes the format from the extension.
  const std::string text = text_written_by(path, ".msh", [&](const fs::path& part) {
    const std::string message =
        with_module([&](const Module& module) { return module.write_msh(part.string(), mesh, fields); });
    if (!message.empty()) refuse_file(path, "Gmsh: " + message);
  });
  if (!is_complete(text, mesh, fields)) refuse_file(path, "Gmsh's file is cut short: is the disk full?");
  write_text(path, text);
}

}  // namespace deflect::gmsh
