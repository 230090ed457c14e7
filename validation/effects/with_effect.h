// Inserts effects into descriptions.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/mechanism_tree.h"
#include "validation/effects/effect.h"
#include "validation/subject/subject.h"

namespace deflect::effects {

/// An effect with its place: `leg` (1-based) is given if and only if the effect's scope is one leg.
struct PlacedEffect {
  const Effect* effect = nullptr;
  std::optional<int> leg;
};

/// The same with values for its parameters, in their units and order.
struct EffectInstance : PlacedEffect {
  VectorX values;
};

/// "all legs", "leg 4", "machine" or "rig".
std::string site_of(const PlacedEffect&);

/// Throws InputError "GIVEN: the value must lie between … and …" with the remedy where it does not.
void require_in_bounds(const std::string& given, const Effect&, const EffectParameter&, double value);

/// The start values of the parameters.
VectorX start_values(const Effect&);

/// A new description with the effect, checked like a file. Optional values at the end may be omitted. An edit is left
/// out where one of its parameters has the value at which it vanishes (also infinity). Values may lie outside the
/// bounds of a search as long as the description allows them. Throws InputError "file:line: edits.i: …" with what does
/// not fit and the nearest valid name.
Mechanism with_effect(const Mechanism&, const Effect&, const VectorX& values, std::optional<int> leg = {});
Mechanism with_effect(const Mechanism&, const EffectInstance&);
subject::Subject with_effect(const subject::Subject&, const EffectInstance&);
/// The same, with the numbers that depend on the effect's parameters, which are counted from `first`.
DependentMechanism with_effect(const DependentMechanism&, const Effect&, const VectorX& values, std::optional<int> leg,
                               std::size_t first);
frame::DependentFrame with_effect(const frame::DependentFrame&, const Effect&, const VectorX& values,
                                  std::size_t first);

/// The description itself.
const Mechanism& description(const DependentMechanism&);
const frame::FrameDescription& description(const frame::DependentFrame&);

/// Why the effect has no place in the subject (or in that leg); nullopt where it has one.
std::optional<std::string> why_not(const Effect&, const subject::Subject&, std::optional<int> leg = {});

/// Every place the effect has in the subject: one, or one per leg, or none.
std::vector<PlacedEffect> places_of(const Effect&, const subject::Subject&);

/// Effects placed in one subject, for many values in a row. The edits are made once and tell which numbers of the
/// description depend on which parameter; a call only sets these numbers. The legs are resolved (see `resolved` in
/// device_file.h), so the machine is for models, not for files.
class PreparedEffects {
 public:
  /// The effects must outlive this object. Throws InputError as with_effect() does.
  PreparedEffects(const subject::Subject&, std::vector<PlacedEffect>);

  /// `values`: of all effects, concatenated.
  subject::Subject operator()(const VectorX& values) const;

  /// The machine with the effects, where the subject is one. InputError where its description cannot hold the values.
  Mechanism machine(const VectorX& values) const;

  /// Which numbers of the description, its legs resolved, a parameter moves, by their index; none where two parameters
  /// move the same number.
  std::vector<std::size_t> moved_by(std::size_t parameter) const;

  Eigen::Index parameter_count() const { return std::ssize(parameters_); }

 private:
  /// Number `at` of the description is offset + factor · parameter.
  struct Slot {
    std::size_t at = 0, parameter = 0;
    double offset = 0, factor = 0;
  };

  template <class Description>
  struct Versions {
    Description bare, with;  // without the effects; with them, at arbitrary values
  };

  template <class Dependent>
  void prepare(Dependent);
  template <class Description>
  Description at(const Versions<Description>&, const VectorX& values) const;
  template <class Description>
  Description edited_one_by_one(const Description& bare, const VectorX& values) const;
  bool find_slots(const std::vector<DescribedNumber>&, const Dependences&);

  std::variant<Versions<Mechanism>, Versions<frame::FrameDescription>> versions_;
  std::vector<PlacedEffect> effects_;
  std::vector<const EffectParameter*> parameters_;
  std::vector<Slot> slots_;  // by `at`
  bool affine_ = true;       // otherwise every call edits the description: two parameters move one number
};

}  // namespace deflect::effects
