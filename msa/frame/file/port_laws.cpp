#include "msa/frame/file/port_laws.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/law_springs.h"
#include "msa/frame/structure/solver.h"

namespace deflect::frame {
namespace {

constexpr double no_digits = 1e-11;  // relative: a stiffness below that is rounding
constexpr double few_digits = 1e-6;  // of a condition number's inverse: extended digits are needed below that

/// The structure as springs between the ports: gradient(y) = H y − load, y the e and δ of the ports.
struct Condensed {
  MatrixX H;                      // N/m; symmetric
  MatrixX to_loads;               // load = to_loads · (F0, δ0)
  MatrixX from_y, from_unloaded;  // x = from_y y + from_unloaded (F0, δ0)
};

/// Solves the answers of the second kind for s: s = C⁻¹(δ − δ0 − D e).
std::optional<Condensed> condensed(const std::vector<TakenLaws>& ports, const MatrixX& response) {
  const auto n = std::ssize(ports);
  std::vector<Eigen::Index> series, between;
  for (Eigen::Index p = 0; p < n; ++p) (nth(ports, p).in_series ? series : between).push_back(p);
  const MatrixX C = response(between, between);
  const VectorX unit = C.diagonal().cwiseMax(0).cwiseSqrt();
  if (!between.empty() && !(unit.minCoeff() > 0)) return std::nullopt;  // it cannot move there
  const Eigen::LLT<MatrixX> llt(unit.cwiseInverse().asDiagonal() * C * unit.cwiseInverse().asDiagonal());
  if (!between.empty() && !(llt.rcond() > no_digits)) return std::nullopt;
  const MatrixX inverse = unit.cwiseInverse().asDiagonal() * llt.solve(MatrixX(unit.cwiseInverse().asDiagonal()));
  Condensed out;
  out.from_y = out.from_unloaded = out.H = out.to_loads = MatrixX::Zero(n, n);
  for (const Eigen::Index p : series) out.from_y(p, p) = 1;
  const MatrixX D = response(between, series), to_series = response(series, between) * inverse;
  out.from_y(between, between) = inverse;
  out.from_y(between, series) = -inverse * D;
  out.from_unloaded(between, between) = -inverse;
  // −F of the structure as a function of y; and −s.
  const MatrixX ee = -response(series, series) + to_series * D;
  out.H(series, series) = (ee + ee.transpose()) / 2;
  out.H(series, between) = -to_series;
  out.H(between, series) = -to_series.transpose();
  out.H(between, between) = (inverse + inverse.transpose()) / 2;
  for (const Eigen::Index p : series) out.to_loads(p, p) = 1;
  out.to_loads(series, between) = -to_series;
  out.to_loads(between, between) = inverse;
  return out;
}

/// Laws in series, together as long as `whole`; empty: each has an elongation of its own, and their sum is returned.
LinearForm add_chain(Model& m, LawSprings& springs, const TakenLaws& port, const std::vector<Law>& chain,
                     LinearForm whole) {
  LinearForm sum;
  FreedomLaws laws;
  laws.set(port.freedom, chain);
  std::vector<SpringLaw> all = springs.freedoms({}, laws)[port.freedom].laws;
  for (std::size_t k = 0; k < all.size(); ++k) {
    LinearForm own = whole;
    if (whole.empty() || k + 1 < all.size()) {
      own = {{m.dofs(), 1}};
      m.scalars.push_back("law");
      sum.push_back(own.front());
    } else {
      for (const Term& t : sum) own.push_back({t.dof, -1});
    }
    m.springs.push_back({std::move(own), std::move(all[k]), "law", "law"});
  }
  return sum;
}

/// H as springs along its eigenvectors, in units in which its diagonal is 1.
void add_structure(Model& m, const MatrixX& H, const std::vector<LinearForm>& y) {
  const VectorX unit = H.diagonal().cwiseMax(0).cwiseSqrt();
  const VectorX per_unit = unit.unaryExpr([](double u) { return u > 0 ? 1 / u : 0; });
  const Eigen::SelfAdjointEigenSolver<MatrixX> parts(per_unit.asDiagonal() * H * per_unit.asDiagonal());
  for (Eigen::Index k = 0; k < H.rows(); ++k) {
    if (!(parts.eigenvalues()(k) > no_digits)) continue;
    LinearForm form;
    for (Eigen::Index p = 0; p < H.rows(); ++p)
      if (const double along = parts.eigenvectors()(p, k) * unit(p); along != 0)
        for (const Term& t : nth(y, p)) form.push_back({t.dof, along * t.coefficient});
    if (!form.empty())
      m.springs.push_back({std::move(form), LinearSpring{parts.eigenvalues()(k)}, "structure", "structure"});
  }
}

/// Of chains side by side, each of linear laws in series: 1/k = Σ 1/kᵢ of a chain.
double stiffness_of(LawSprings& springs, const TakenLaws& port) {
  double sum = 0;
  for (const std::vector<Law>& chain : port.chains) {
    FreedomLaws laws;
    laws.set(port.freedom, chain);
    double compliance = 0;
    const auto freedoms = springs.freedoms({}, laws);
    for (const SpringLaw& law : freedoms[port.freedom].laws) compliance += 1 / tangent(law, 0);
    sum += 1 / compliance;
  }
  return sum;
}

bool all_linear(const std::vector<TakenLaws>& ports) {
  for (const TakenLaws& port : ports)
    for (const std::vector<Law>& chain : port.chains)
      if (!std::all_of(chain.begin(), chain.end(), [](const Law& law) { return is_linear(law); })) return false;
  return true;
}

/// y by port (rows) and column of loads at the ports, with laws of stiffnesses k: (H + k) y = load. Nullopt where that
/// leaves too few digits.
std::optional<MatrixX> with_stiffnesses(MatrixX H, const VectorX& k, const MatrixX& loads) {
  H.diagonal() += k;
  const VectorX unit = H.diagonal().cwiseMax(0).cwiseSqrt();
  if (!(unit.minCoeff() > 0) || !unit.allFinite()) return std::nullopt;
  const VectorX per_unit = unit.cwiseInverse();
  const Eigen::LLT<MatrixX> llt(per_unit.asDiagonal() * H * per_unit.asDiagonal());
  if (llt.info() != Eigen::Success || !(llt.rcond() > few_digits)) return std::nullopt;
  MatrixX y = per_unit.asDiagonal() * llt.solve(MatrixX(per_unit.asDiagonal() * loads));
  y += per_unit.asDiagonal() * llt.solve(MatrixX(per_unit.asDiagonal() * (loads - H * y)));
  return y;
}

/// y as before, with any laws: the springs of `m`. Nullopt where an equilibrium is not found.
std::optional<MatrixX> in_equilibrium(Model m, const std::vector<LinearForm>& y, const MatrixX& loads,
                                      bool in_sequence) {
  const int scalars = m.dofs();
  Solver solver(std::move(m));
  MatrixX out(loads.rows(), loads.cols());
  std::vector<double> slips;
  for (Eigen::Index c = 0; c < loads.cols(); ++c) {
    VectorX load = VectorX::Zero(scalars);
    for (Eigen::Index p = 0; p < loads.rows(); ++p)
      for (const Term& t : nth(y, p)) load(t.dof) = loads(p, c);
    solver.begin_slips(slips);
    const Solution s = solver.solve(load);
    if (!s.converged) return std::nullopt;
    if (in_sequence) slips = s.slips;
    for (Eigen::Index p = 0; p < loads.rows(); ++p) out(p, c) = evaluate(nth(y, p), s.fine);
  }
  return out;
}

}  // namespace

std::optional<MatrixX> inputs_of_ports(const FrameDescription& f, const std::vector<TakenLaws>& ports,
                                       const MatrixX& response, const MatrixX& unloaded, bool in_sequence) {
  const std::optional<Condensed> structure = condensed(ports, response);
  if (!structure) return std::nullopt;
  const MatrixX loads = structure->to_loads * unloaded;
  const auto answer = [&](const MatrixX& y) {
    return MatrixX(structure->from_y * y + structure->from_unloaded * unloaded);
  };
  LawSprings springs(f);
  if (all_linear(ports)) {
    VectorX k(std::ssize(ports));
    for (std::size_t p = 0; p < ports.size(); ++p) k(as_index(p)) = stiffness_of(springs, ports[p]);
    if (const std::optional<MatrixX> y = with_stiffnesses(structure->H, k, loads)) return answer(*y);
  }
  Model m;
  std::vector<LinearForm> y;
  for (const TakenLaws& port : ports) {
    y.push_back(add_chain(m, springs, port, port.chains.front(), {}));
    for (std::size_t k = 1; k < port.chains.size(); ++k) add_chain(m, springs, port, port.chains[k], y.back());
  }
  add_structure(m, structure->H, y);
  const auto found = outcome_of([&] { return in_equilibrium(std::move(m), y, loads, in_sequence); });
  if (!found || !*found) return std::nullopt;
  return answer(**found);
}

}  // namespace deflect::frame
