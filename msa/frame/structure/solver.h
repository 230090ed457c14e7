// Static equilibrium of a structure: f_int(u) = f under u = T q + G b.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "msa/frame/structure/assembly.h"
#include "msa/frame/structure/mobility.h"
#include "msa/frame/structure/reactions.h"

namespace deflect {
struct ScalarLaw;  // set_valued_laws.h
struct LinearRelation;
struct SetValuedSolution;
}  // namespace deflect

namespace deflect::frame {

struct NewtonOptions {
  int max_iterations = 100;
  double tolerance = 1e-12;  ///< of the last step and of the residual, relative; rounding may stop a little above
  std::vector<int> watched;  ///< freedoms for which Solution::least and most are computed
};

class ExtendedStructure;
struct GeometricState;  // geometric_solver.h

struct Solution {
  VectorX u;                  ///< by freedom of Solver::model(), the given ones first: m, rad, and the scalars' unit
  ExtendedVector fine;        ///< the same in extended precision, for differences; only the precision of u where
                              ///< springs are nonlinear
  VectorX spring_tangents;    ///< N/m or Nm/rad at u; infinite where a law is rigid
  VectorX spring_forces;      ///< N or Nm, in excess of preloads
  VectorX heat;               ///< thermal part of the loads (MsaModel); by freedom
  std::vector<double> slips;  ///< of friction elements after the load, by their numbers
  /// Springs with unloaded play in which the structure floats. u is the middle: of all displacements in equilibrium,
  /// the one with the least Σ (δ/gap)² over these springs (set_valued_laws.h).
  std::vector<std::string> loose;
  MatrixX free;         ///< columns: changes of u within that play, which change no force
  VectorX least, most;  ///< by NewtonOptions::watched: how far it may move from u
  std::string message;  ///< why it did not converge, if known
  bool converged = false;
  int iterations = 0;
  double residual = 0;  ///< |Tᵀ(f − f_int)| relative to |Tᵀf| + |Tᵀ f_int|, largest entry
  std::shared_ptr<const GeometricState>
      geometric;  ///< where the geometry was not linear: all that is known of the state
};

/// Keeps elimination, ordering and symbolic analysis of one structure for all its load cases and spring states.
class Solver {
 public:
  /// Throws ModelError for contradicting constraints, and for a structure that cannot stand (mobility.h), with every
  /// body that can move, its motion, and what would hold it. Idle motions are held, with a note. Very stiff members get
  /// relative coordinates (relative.h).
  explicit Solver(Model);

  /// The structure that is solved: the given one, with added constraints and coordinates appended.
  const Model& model() const { return *model_; }
  const Elimination& elimination() const { return *elimination_; }
  /// Moves both out of a solver that is no longer needed.
  std::pair<Model, Elimination> structure() &&;
  /// The number of constraints, at the end of the model's list, that hold idle motions.
  std::size_t idle_motions() const { return idle_.size(); }

  /// Whether no spring's stiffness depends on its load.
  bool linear_springs() const;

  /// Notes for the user: idle spins that were held, redundant constraints, poor conditioning.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Sets the slips of the friction elements before the next loads, by their numbers; empty: zero.
  void begin_slips(const std::vector<double>&);
  /// The same for their limits; empty: what each holds where nothing is carried beside it. solve() finds those that
  /// grow with a load.
  void begin_limits(const std::vector<double>&);

  /// One load by freedom (of the given model, or of model()), constraint values as in the model. Nonlinear springs:
  /// Newton's method with a line search on the potential. Where a spring jumps (stepped_spring.h), or Newton does not
  /// converge: the potential condensed to the elongations of these springs (set_valued.cpp), solved to rounding. Throws
  /// ModelError where the load acts on an idle spin, and where in some state the structure loses the stiffness that it
  /// needs to stand.
  Solution solve(const VectorX& load, const NewtonOptions& options = {});

  /// The checks that solve() makes first: throws ModelError for contradicting values and for a load that acts on an
  /// idle spin.
  void check(const VectorX& load, const VectorX& values) const;

  /// As above for other constraint values (prescribed displacements).
  Solution solve(const VectorX& load, const VectorX& values, const NewtonOptions& options = {});

  /// Linear response of the tangent structure (springs at `spring_tangents`) to columns of loads and of constraint
  /// values; the columns of the result are u. Iterative refinement with residuals in extended precision, until the
  /// error is that of the structure's own numbers. Throws NumericalError where the corrections do not decrease: the
  /// factorisation then has no accurate digits.
  ExtendedMatrix linear(const VectorX& spring_tangents, const MatrixX& loads, const MatrixX& values);

  /// The largest relative first correction in linear() so far. It is the error of a solution without refinement, and an
  /// estimate of the error that rounding of the structure's numbers causes in any solution.
  double rounding() const { return rounding_; }

 private:
  void prepare();
  std::vector<char> resisting(const VectorX& spring_tangents) const;
  void hold(std::vector<IdleMotion>);
  bool hold_idle_motions();
  void note_condition();
  void refuse_driven_motions(const VectorX& load) const;
  ExtendedVector refined(const VectorX& tangents, const VectorX& load, const VectorX& values);
  bool corrected(const VectorX& tangents, const VectorX& load, const VectorX& values, ExtendedVector& u, double& lost,
                 double& left);
  Solution solve_linear(const VectorX& load, const VectorX& values);
  struct Work;
  void begin_by_forces(Work&);
  double line_search(const Work&, const VectorX& step) const;
  bool newton(Work&, const NewtonOptions&, Solution&);
  void conclude(const Work&, Solution&) const;
  void try_to_factor(const VectorX& spring_tangents);
  struct Condensed;
  const Condensed& condensed();
  Solution solve_condensed(const VectorX& load, const VectorX& values, const std::vector<int>& watched);
  SetValuedSolution settled(const LinearRelation&, std::vector<ScalarLaw>&, const MatrixX& watched,
                            const ExtendedVector& u0);
  ExtendedVector refined(const std::vector<ScalarLaw>&, SetValuedSolution&, const LinearRelation&,
                         const ExtendedVector& u0);
  ExtendedVector balanced(const std::vector<ScalarLaw>&, SetValuedSolution&, const LinearRelation&, ExtendedVector u0,
                          const VectorX& load);
  std::string reason(const SetValuedSolution&) const;
  void factor(const VectorX& spring_tangents);
  VectorX starting_tangents(double force) const;

  std::unique_ptr<Model> model_;  // pointers, so that a solver can be moved
  std::unique_ptr<Elimination> elimination_;
  std::unique_ptr<Assembly> assembly_;
  std::unique_ptr<SparseCholesky> cholesky_;
  std::vector<std::string> notes_;
  std::vector<IdleMotion> idle_;  // held by the last constraints
  double rounding_ = 0;
  bool factored_ = false;
  VectorX factored_tangents_;                          // state of the spring tangents that is factored
  std::shared_ptr<const ExtendedStructure> extended_;  // made on first use
  VectorX extended_tangents_;                          // its state
  std::shared_ptr<const Condensed> condensed_;         // made on first use
  bool frictions_soft_ = true;                         // the stiffness that stands in for them there
};

/// Stored energies by part, J, in order of first appearance: beams ½ (d − d0)ᵀ K (d − d0) with d0 by the free strains
/// (by beam; empty: 0); springs ∫ F dδ; friction elements and other springs that jump by their laws.
std::vector<std::pair<std::string, double>> energies(const Model&, const ExtendedVector& u,
                                                     const std::vector<double>& strains = {});

}  // namespace deflect::frame
