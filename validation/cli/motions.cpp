#include "validation/cli/motions.h"

#include <fmt/format.h>

#include <filesystem>

#include "meshes/gmsh.h"
#include "meshes/structure.h"
#include "meshes/vtu.h"
#include "msa/frame/structure/stability.h"

namespace deflect::cli {

void drawing_motions(const std::string& out, const std::function<void()>& run) try {
  run();
} catch (const frame::CannotStand& e) {
  if (out.empty()) throw ModelError(fmt::format("{}\nAdd --out DIR to draw each motion.", e.what()));
  const LineMesh mesh = lines_of(*e.model);
  for (std::size_t i = 0; i < e.motions.size(); ++i) {
    const FieldData fields = fields_of_motion(*e.model, e.motions[i].u);
    const std::filesystem::path file = std::filesystem::path(out) / fmt::format("motion-{}", i + 1);
    write_vtu(file.string() + ".vtu", mesh, fields);
    gmsh::write_msh(file.string() + ".msh", mesh, fields);
  }
  throw ModelError(
      fmt::format("{}\nThe motions are drawn as displacements in {}/motion-*.vtu, motion-*.msh", e.what(), out));
}

}  // namespace deflect::cli
