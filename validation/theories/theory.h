// A theory is a value: its names, and how it answers for a mechanism that stands somewhere. A row of the table makes a
// theory part of every command, result and figure.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meshes/line_mesh.h"
#include "msa/frame/mechanism/build.h"
#include "validation/theories/answer.h"

namespace deflect::theories {

struct TheoryOptions {
  std::string device = {};              ///< its name, which begins the messages
  frame::MemberDivision division = {};  ///< of members, for a theory that divides them
  bool keep_division = false;           ///< not refined where it leaves too much: for a picture of these elements
  /// Answers at many poses are wanted, and energies by part are not: a theory may condense the device once for all.
  bool condense = false;
};

/// The mechanism assembled with its misfits, without load and weight.
struct Assembled {
  Vector6 offset;                                                  ///< T beside its place in the drawing; m, rad
  std::vector<std::pair<std::string, Vector6>> leg_wrenches = {};  ///< on each leg at T, by a theory that knows them
};

/// The structure that a theory solved, to be drawn: lines, and fields on them.
struct Structure {
  LineMesh mesh;
  FieldData fields;
};

/// One theory of one mechanism, from pose to pose. Configurations must outlive their use: the last one given is kept.
class TheoryAt {
 public:
  virtual ~TheoryAt() = default;

  /// The same mechanism where it stands now.
  virtual void move_to(const Configuration&) = 0;

  /// Checked: stiffness, sign, equilibrium, energy (answer.h). Throws NumericalError naming theory, place and check, or
  /// where no equilibrium is found; ModelError where nothing holds or nothing yields.
  virtual Answer answer(const Vector6& F_T_W, const Conditions& = {}) = 0;

  virtual Prediction predict(const Vector6& F_T_W, const Conditions&) = 0;
  /// Many predictions are to come at this pose, at other temperatures than 20 °C too where `warmer_or_colder`.
  virtual void expect_many(bool warmer_or_colder) = 0;
  /// Predictions cost next to nothing: they are affine in load and temperature.
  virtual bool affine() const = 0;

  virtual Assembled assembled() = 0;
  /// Of the last answer; absent of a theory that has no structure.
  virtual std::optional<Structure> structure() { return std::nullopt; }
  /// What it held or found poor: idle spins, redundant constraints, conditioning.
  virtual std::vector<std::string> notes() const { return {}; }
};

struct Theory {
  std::string name;     ///< in files, columns and options: "msa"
  std::string title;    ///< in tables and sentences: "MSA"
  std::string spoken;   ///< "the MSA"
  std::string legend;   ///< in figures: "MSA"
  std::string caption;  ///< below them: "matrix structural analysis (MSA)"
  /// Relative: how far beside rounding it may be from the others. Infinite: its difference is told, never refused.
  double known_to = 0;
  bool divides = false;  ///< members into elements, by TheoryOptions::division
  std::function<std::unique_ptr<TheoryAt>(const Configuration&, const TheoryOptions&)> at;
};

/// Theories in the order of tables and columns; each outlives all results.
using Theories = std::vector<const Theory*>;

/// The table.
const Theories& all_theories();
/// InputError with the names that there are.
const Theory& theory(const std::string& name);
/// "analytic,msa": of the table, in its order; all for an empty text. InputError on names that are not there.
Theories theories_named(const std::string& list);

/// The theory whose stiffness and energies are shown where one must do: the last of those that are exact.
std::size_t reference_of(const Theories&);
/// Place of a theory in the list; InputError where it is not.
std::size_t place_of(const Theories&, const std::string& name);

/// "analytic, MSA and softer".
std::string titles_of(const Theories&);

}  // namespace deflect::theories
