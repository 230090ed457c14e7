// Frictions whose limit grows with a load, in the deformed shape.
#include "msa/base/index.h"
#include "msa/base/settle.h"
#include "msa/frame/deformed/geometric_solver.h"

namespace deflect::frame {

GeometricState solve_settled(GeometricSolver& solver, const GeometricLoad& load, GeometricOptions options) {
  std::vector<const FrictionSpring*> growing;
  options.limits.clear();
  for (const Spring& s : solver.model().springs) {
    const auto* f = std::get_if<FrictionSpring>(&s.law);
    if (!f || f->number < 0) continue;
    options.limits.resize(std::max(options.limits.size(), as_size(f->number) + 1));
    options.limits[as_size(f->number)] = f->own;
    if (f->share > 0 && f->beside >= 0) growing.push_back(f);
  }
  if (growing.empty()) return solver.solve(load, options);
  GeometricState state;
  VectorX limits(std::ssize(growing));
  for (std::size_t i = 0; i < growing.size(); ++i) limits(as_index(i)) = growing[i]->own;
  const auto of_loads = [&](const VectorX& tried) -> std::optional<VectorX> {
    for (std::size_t i = 0; i < growing.size(); ++i) options.limits[as_size(growing[i]->number)] = tried(as_index(i));
    state = solver.solve(load, options);
    if (!state.converged) return std::nullopt;
    VectorX out = tried;
    for (std::size_t i = 0; i < growing.size(); ++i)
      out(as_index(i)) = growing[i]->own + growing[i]->share * std::abs(state.spring_forces(growing[i]->beside));
    return out;
  };
  if (!settle(limits, of_loads, 0, 1e-11)) {
    state.converged = false;
    state.message = "friction that grows with a load does not settle in the deformed shape";
  }
  return state;
}

}  // namespace deflect::frame
