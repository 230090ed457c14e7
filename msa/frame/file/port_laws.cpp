#include "msa/frame/file/port_laws.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "msa/base/index.h"
#include "msa/base/normal_map.h"
#include "msa/base/outcome.h"
#include "msa/frame/elements/jumping_springs.h"
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

/// The laws at the ports as springs, without the structure.
struct Laws {
  Model m;
  std::vector<LinearForm> y;       // by port
  std::vector<Eigen::Index> port;  // by spring
  std::vector<char> in_series;     // by spring
};

/// Whether earlier loads may have left something in it.
bool has_a_number(const SpringLaw& law) {
  return std::holds_alternative<FrictionSpring>(law) || std::holds_alternative<TableSpring>(law);
}

/// One load after another, in doubles: x of the scalars, y = Yᵀx, elongations d = Eᵀx. With a k of the structure's size
/// beside each law, A = Y H Yᵀ + E k Eᵀ and o = d − s/k, x = A⁻¹(Y load + E k o).
class InDoubles {
 public:
  /// Nullopt where that leaves too few digits.
  static std::optional<InDoubles> of(const Laws&, const MatrixX& H);

  /// y, and in `slips` what the load leaves; nullopt where more must be asked (normal_map.h).
  std::optional<VectorX> solve(const VectorX& load, std::vector<double>& slips) {
    VectorX size(std::ssize(laws_));
    scalar_.resize(laws_.size());
    for (std::size_t i = 0; i < laws_.size(); ++i) {
      if (scalar_[i].force && !has_a_number(laws_[i])) continue;
      begin(laws_[i], slips);
      scalar_[i] = scalar_law(laws_[i]);
    }
    for (std::size_t i = 0; i < laws_.size(); ++i) size(as_index(i)) = std::abs(load(port_[i]));
    const VectorX d0 = d_by_load_ * load;
    const auto found = map_.solve(d0, size, scalar_);
    if (!found) return std::nullopt;
    // In series a structure may resist by rounding alone, as where it is determinate. Then d is a small difference from
    // a large d0.
    for (Eigen::Index i = 0; i < d0.size(); ++i)
      if (nth(in_series_, i) && std::abs(found->d(i)) < few_digits * std::abs(d0(i))) return std::nullopt;
    for (std::size_t i = 0; i < laws_.size(); ++i)
      keep_slips(laws_[i], found->d(as_index(i)), found->s(as_index(i)), found->end[i], slips);
    return VectorX(y_by_load_ * load + y_by_offset_ * (k_.cwiseProduct(found->d) - found->s));
  }

 private:
  InDoubles(const Laws& laws, VectorX k, const MatrixX& E, const MatrixX& per_E, const MatrixX& Y, const MatrixX& per_Y)
      : port_(laws.port),
        in_series_(laws.in_series),
        k_(std::move(k)),
        d_by_load_(E.transpose() * per_Y),
        y_by_load_(Y.transpose() * per_Y),
        y_by_offset_(Y.transpose() * per_E),
        map_(k_.cwiseInverse(), E.transpose() * per_E * k_.asDiagonal()) {
    for (const Spring& s : laws.m.springs) laws_.push_back(s.law);
  }

  std::vector<SpringLaw> laws_;
  std::vector<ScalarLaw> scalar_;  // of the laws as the last load left them
  std::vector<Eigen::Index> port_;
  std::vector<char> in_series_;
  VectorX k_;
  MatrixX d_by_load_, y_by_load_, y_by_offset_;
  NormalMap map_;
};

MatrixX columns_of(const std::vector<LinearForm>& forms, Eigen::Index rows) {
  MatrixX out = MatrixX::Zero(rows, std::ssize(forms));
  for (std::size_t i = 0; i < forms.size(); ++i)
    for (const Term& t : forms[i]) out(t.dof, as_index(i)) += t.coefficient;
  return out;
}

std::optional<InDoubles> InDoubles::of(const Laws& laws, const MatrixX& H) {
  std::vector<LinearForm> elongations;
  VectorX k(std::ssize(laws.port));
  for (std::size_t i = 0; i < laws.port.size(); ++i) {
    const Spring& spring = laws.m.springs[i];
    const auto* friction = std::get_if<FrictionSpring>(&spring.law);
    if (friction && friction->share > 0 && friction->beside >= 0) return std::nullopt;  // a limit of its own
    elongations.push_back(spring.elongation);
    k(as_index(i)) = H(laws.port[i], laws.port[i]);
  }
  if (!(k.minCoeff() > 0) || !k.allFinite()) return std::nullopt;
  const MatrixX Y = columns_of(laws.y, laws.m.dofs()), E = columns_of(elongations, laws.m.dofs());
  const MatrixX A = Y * H * Y.transpose() + E * k.asDiagonal() * E.transpose();
  const VectorX per_unit = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<MatrixX> llt(per_unit.asDiagonal() * A * per_unit.asDiagonal());
  if (llt.info() != Eigen::Success || !(llt.rcond() > few_digits)) return std::nullopt;
  const auto solved = [&](const MatrixX& right) {
    return MatrixX(per_unit.asDiagonal() * llt.solve(MatrixX(per_unit.asDiagonal() * right)));
  };
  return InDoubles(laws, k, E, solved(E), Y, solved(Y));
}

/// y as before, with any laws. Nullopt where an equilibrium is not found.
std::optional<MatrixX> in_equilibrium(const Laws& laws, const MatrixX& H, const MatrixX& loads, bool in_sequence) {
  std::optional<InDoubles> doubles = InDoubles::of(laws, H);
  std::optional<Solver> general;
  MatrixX out(loads.rows(), loads.cols());
  std::vector<double> left;
  for (Eigen::Index c = 0; c < loads.cols(); ++c) {
    std::vector<double> slips = left;
    if (const auto y = doubles ? doubles->solve(loads.col(c), slips) : std::nullopt) {
      out.col(c) = *y;
    } else {
      if (!general) {
        Model m = laws.m;
        add_structure(m, H, laws.y);
        general.emplace(std::move(m));
      }
      VectorX load = VectorX::Zero(laws.m.dofs());
      for (Eigen::Index p = 0; p < loads.rows(); ++p)
        for (const Term& t : nth(laws.y, p)) load(t.dof) = loads(p, c);
      general->begin_slips(left);
      const Solution s = general->solve(load);
      if (!s.converged) return std::nullopt;
      slips = s.slips;
      for (Eigen::Index p = 0; p < loads.rows(); ++p) out(p, c) = evaluate(nth(laws.y, p), s.fine);
    }
    if (in_sequence) left = slips;
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
  Laws laws;
  for (std::size_t p = 0; p < ports.size(); ++p) {
    laws.y.push_back(add_chain(laws.m, springs, ports[p], ports[p].chains.front(), {}));
    for (std::size_t k = 1; k < ports[p].chains.size(); ++k)
      add_chain(laws.m, springs, ports[p], ports[p].chains[k], laws.y.back());
    laws.port.resize(laws.m.springs.size(), as_index(p));
    laws.in_series.resize(laws.m.springs.size(), ports[p].in_series ? 1 : 0);
  }
  const auto found = outcome_of([&] { return in_equilibrium(laws, structure->H, loads, in_sequence); });
  if (!found || !*found) return std::nullopt;
  return answer(**found);
}

}  // namespace deflect::frame
