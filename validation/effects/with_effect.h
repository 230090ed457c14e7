// Inserts effects into descriptions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"
#include "validation/effects/effect.h"
#include "validation/subject/subject.h"

namespace deflect {

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
Subject with_effect(const Subject&, const EffectInstance&);

/// Why the effect has no place in the subject (or in that leg); nullopt where it has one.
std::optional<std::string> why_not(const Effect&, const Subject&, std::optional<int> leg = {});

/// Every place the effect has in the subject: one, or one per leg, or none.
std::vector<PlacedEffect> places_of(const Effect&, const Subject&);

/// Effects placed in one subject, to be evaluated at many values. The edits are worked out once, so that each call only
/// sets numbers, and the legs are resolved (`resolved` in device_file.h). The results serve models and are not meant to
/// be written to files.
class PreparedEffects {
 public:
  /// The effects must outlive this object. Throws InputError as with_effect() does.
  PreparedEffects(const Subject&, std::vector<PlacedEffect>);

  /// `values`: of all effects, concatenated.
  Subject operator()(const VectorX& values) const;

  /// The same as a machine.
  Mechanism machine(const VectorX& values) const;

  Eigen::Index parameter_count() const { return std::ssize(parameters_); }

 private:
  /// Number `at` of the description is offset + factor · parameter.
  struct Slot {
    std::size_t at = 0, parameter = 0;
    double offset = 0, factor = 0;
  };

  Mechanism edited_one_by_one(const VectorX& values) const;
  VectorX probe(double part) const;  // values at this fraction of the way from the start to the farther bound
  bool find_slots();                 // finds which numbers depend on which parameter, from a few values
  bool slots_hold() const;           // checks the slots at another value

  Mechanism bare_, with_;  // without the effects; with them, at arbitrary values
  std::vector<PlacedEffect> effects_;
  std::vector<const EffectParameter*> parameters_;
  std::vector<Slot> slots_;  // by `at`
  bool affine_ = true;       // numbers are affine in parameters; otherwise every call makes the edits
};

}  // namespace deflect
