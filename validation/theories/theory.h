// A theory as a value: its names, and a function that solves a mechanism in a configuration. A theory in the table
// (all_theories) takes part in every command, result and figure.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meshes/line_mesh.h"
#include "msa/frame/mechanism/build.h"
#include "msa/mechanism/inside.h"
#include "validation/theories/answer.h"

namespace deflect::theories {

struct TheoryOptions {
  std::string device = {};              ///< its name, for messages
  frame::MemberDivision division = {};  ///< of members, for a theory that divides them
  bool keep_division = false;           ///< no refinement where the error is too large: to draw these elements
  /// Set where answers at many poses are needed, without energies by part: a theory may then condense the device once
  /// for all poses.
  bool condense = false;
  std::vector<Inside> inside = {};  ///< what predictions shall tell of the insides of legs
  /// In the deformed shape laws that jump are to be taken as in linear geometry (Answer::apart), by a theory that can.
  bool apart = false;
};

/// The mechanism assembled with its misfits, without load and weight.
struct Assembled {
  Vector6 offset;                                                  ///< displacement of T from its place in the drawing;
                                                                   ///< m, rad
  std::vector<std::pair<std::string, Vector6>> leg_wrenches = {};  ///< on each leg at T, where the theory knows them
};

/// The structure that a theory solved, for drawing: lines, and fields on them.
struct Structure {
  LineMesh mesh;
  FieldData fields;
};

/// One theory applied to one mechanism, pose after pose. It keeps a reference to the last configuration given, which
/// must outlive its use.
class TheoryAt {
 public:
  virtual ~TheoryAt() = default;

  /// Moves to another configuration of the same mechanism.
  virtual void move_to(const Configuration&) = 0;

  /// Solves and checks stiffness, sign, equilibrium and energy (answer.h). Throws NumericalError with theory, place and
  /// failed check, or where no equilibrium is found; ModelError where some motion is not held or nothing yields.
  virtual Answer answer(const Vector6& F_T_W, const Conditions& = {}) = 0;

  virtual Prediction predict(const Vector6& F_T_W, const Conditions&) = 0;
  /// Announces many predictions at this pose; with `warmer_or_colder` also at temperatures other than 20 °C.
  virtual void expect_many(bool warmer_or_colder) = 0;
  /// Whether predictions are affine in load and temperature, so that they cost next to nothing.
  virtual bool affine() const = 0;

  virtual Assembled assembled() = 0;
  /// Of the last answer; nullopt for a theory that has no structure.
  virtual std::optional<Structure> structure() { return std::nullopt; }
  /// Remarks on the structure: spins held because nothing resists them, redundant constraints, poor conditioning.
  virtual std::vector<std::string> notes() const { return {}; }
};

struct Theory {
  std::string name;     ///< in files, columns and options: "msa"
  std::string title;    ///< in tables and sentences: "MSA"
  std::string spoken;   ///< "the MSA"
  std::string legend;   ///< in figures: "MSA"
  std::string caption;  ///< below them: "matrix structural analysis (MSA)"
  /// Relative difference from the other theories that is allowed beyond rounding. Infinite: the difference is reported
  /// but never refused.
  double known_to = 0;
  bool divides = false;  ///< divides members into elements, by TheoryOptions::division
  std::function<std::unique_ptr<TheoryAt>(const Configuration&, const TheoryOptions&)> at;
};

/// Theories in the order of tables and columns; each outlives all results.
using Theories = std::vector<const Theory*>;

/// The table.
const Theories& all_theories();
/// Throws InputError with the known names.
const Theory& theory(const std::string& name);
/// The theories named in a list such as "analytic,msa", in the order of the table; all for an empty list. Throws
/// InputError for an unknown name.
Theories theories_named(const std::string& list);

/// Index of the theory whose stiffness and energies are shown where only one is: the last with known_to = 0.
std::size_t reference_of(const Theories&);
/// Index of a theory in the list. Throws InputError where it is not there.
std::size_t place_of(const Theories&, const std::string& name);

/// "analytic, MSA and softer".
std::string titles_of(const Theories&);

}  // namespace deflect::theories
