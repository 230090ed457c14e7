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
  std::vector<int> watched;  ///< freedoms of which Solution says how far play lets them move
};

class ExtendedStructure;
struct GeometricState;  // geometric_solver.h

struct Solution {
  VectorX u;                  ///< by freedom of Solver::model(), the given ones first: m, rad, and the scalars' unit
  ExtendedVector fine;        ///< the same, for differences; with u's own digits where springs are not linear
  VectorX spring_tangents;    ///< N/m or Nm/rad at u; infinite where a law is rigid
  VectorX spring_forces;      ///< N or Nm, beside preloads
  VectorX heat;               ///< among the loads, what members that are warmer push (MsaModel); by freedom
  std::vector<double> slips;  ///< of frictions after the load, by their numbers
  /// Springs whose play nothing loads, where the structure floats in it. u is the middle: of all displacements that are
  /// in equilibrium the one with the least Σ (δ/gap)² over such springs (set_valued_laws.h).
  std::vector<std::string> loose;
  MatrixX free;         ///< columns: how u changes within that play, which changes no force
  VectorX least, most;  ///< by NewtonOptions::watched: how far it may move from u
  std::string message;  ///< where it did not converge, why, if that is known
  bool converged = false;
  int iterations = 0;
  double residual = 0;  ///< |Tᵀ(f − f_int)| relative to |Tᵀf| + |Tᵀ f_int|, largest entry
  std::shared_ptr<const GeometricState>
      geometric;  ///< where the geometry was not linear: all that is known of the state
};

/// Keeps elimination, ordering and symbolic analysis of one structure for all its load cases and spring states.
class Solver {
 public:
  /// Refuses before any load: ModelError for constraints that contradict each other, and for a structure that cannot
  /// stand (mobility.h), naming every body that moves, how, and what would hold it. Idle motions are held and noted.
  /// Very stiff members get relative coordinates (relative.h).
  explicit Solver(Model);

  /// The structure that is solved: the given one, with the constraints and coordinates that were added behind its own.
  const Model& model() const { return *model_; }
  const Elimination& elimination() const { return *elimination_; }
  /// Both of these, from a solver that is done.
  std::pair<Model, Elimination> structure() &&;
  /// How many of the model's constraints, the last ones, hold idle motions.
  std::size_t idle_motions() const { return idle_.size(); }

  /// No spring's stiffness depends on its load.
  bool linear_springs() const;

  /// What a user should know: idle spins that were held, redundant constraints, poor conditioning.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Slips of the frictions before the loads that follow, by their numbers; empty: zero.
  void begin_slips(const std::vector<double>&);

  /// One load by freedom (of the given model, or of model()), constraint values as in the model. Newton with a line
  /// search on the potential where a spring is nonlinear; where one jumps (stepped_spring.h), or Newton does not
  /// converge, the potential condensed to the elongations of these springs (set_valued.cpp), to rounding. Throws
  /// ModelError when the load drives an idle spin, and when a state loses the stiffness that keeps the structure
  /// standing.
  Solution solve(const VectorX& load, const NewtonOptions& options = {});

  /// What solve refuses before it begins: values that contradict each other, a load that drives an idle spin.
  void check(const VectorX& load, const VectorX& values) const;

  /// As above for other constraint values (prescribed displacements).
  Solution solve(const VectorX& load, const VectorX& values, const NewtonOptions& options = {});

  /// Linear response of the tangent structure (springs at `spring_tangents`) to columns of loads and of constraint
  /// values; the columns of the result are u. Residuals are formed with extended digits until what a correction would
  /// leave lies below them: the answers' error is that of the structure's own numbers. Throws NumericalError where the
  /// corrections do not shrink: then the factor has no digits.
  ExtendedMatrix linear(const VectorX& spring_tangents, const MatrixX& loads, const MatrixX& values);

  /// Of the answers of linear() so far the largest first correction, relative: what rounding costs a plain solution,
  /// and so the share that the rounding of the structure's numbers may cost any.
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
  ExtendedVector refined(const std::vector<ScalarLaw>&, SetValuedSolution&, const LinearRelation&,
                         const ExtendedVector& u0);
  std::string reason(const SetValuedSolution&) const;
  void factor(const VectorX& spring_tangents);
  VectorX starting_tangents(double force) const;

  std::unique_ptr<Model> model_;  // pointers, so that a solver can be moved and rebuilt
  std::unique_ptr<Elimination> elimination_;
  std::unique_ptr<Assembly> assembly_;
  std::unique_ptr<SparseCholesky> cholesky_;
  std::vector<std::string> notes_;
  std::vector<IdleMotion> idle_;  // held by the last constraints
  double rounding_ = 0;
  bool factored_ = false;
  VectorX factored_tangents_;                          // the state that the factor belongs to
  std::shared_ptr<const ExtendedStructure> extended_;  // made when first needed
  VectorX extended_tangents_;                          // its state
  std::shared_ptr<const Condensed> condensed_;         // made when first needed
  bool frictions_soft_ = true;                         // the stiffness that stands in for them there
};

/// Stored energies by part: beams ½ (d − d0)ᵀ K (d − d0), d0 the free strains' (by beam; none: 0), springs ∫ F dδ,
/// frictions and what else jumps by their laws; in order of first appearance. J.
std::vector<std::pair<std::string, double>> energies(const Model&, const ExtendedVector& u,
                                                     const std::vector<double>& strains = {});

}  // namespace deflect::frame
