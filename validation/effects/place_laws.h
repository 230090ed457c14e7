// The laws that effects put at the places of a subject, each with where physics allows it (place_effects.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "validation/effects/effect.h"
#include "validation/subject/place.h"

namespace deflect::effects {

/// Where a law may act in one leg alone: what wears does so at one part.
enum class OneLeg { never, at_a_part, at_parts_alike };

/// One law where it can act.
struct PlaceLaw {
  const char* id;
  bool (*acts)(const subject::Place&);
  const char* title;  ///< after "the elbow rz "
  std::vector<EffectParameter> (*parameters)(const subject::Place&);
  std::string (*value)(const std::vector<EffectParameter>&, const subject::Place&);
  EffectPages pages;  ///< with {} for the place
  OneLeg of_one_leg = OneLeg::never;
  EffectEdit::Action action = EffectEdit::Action::append;
  const char* field = "";     ///< behind the freedom
  bool side_by_side = false;  ///< with what yields there
  /// Of a law with one parameter for each of some axes, which its edits name behind the field: those axes.
  std::vector<std::size_t> subject::Place::*axes = nullptr;
};

/// All of them; rig_laws() are those of sensors and load cases.
std::span<const PlaceLaw> place_laws();
std::span<const PlaceLaw> rig_laws();

}  // namespace deflect::effects
