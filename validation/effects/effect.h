// An effect: something a model can lack (a clamp that yields, a load cell that reads too little), as data. It is a few
// edits of the description whose values contain physical parameters. Both theories see it only through the edited
// description. Effects are read from files (effect_file.h); the catalogue is a folder of such files.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "msa/base/spatial.h"
#include "validation/subject/place.h"

namespace deflect::effects {

/// What is known of a parameter before the data: a normal distribution, on a logarithmic scale of ln p with the
/// standard deviation deviation/mean.
struct ParameterPrior {
  double mean = 0, deviation = 0;  ///< in the parameter's unit
};

/// Numbers are in the unit that the name ends with: "stiffness_N_per_mm". A name without one is a plain number.
struct EffectParameter {
  std::string name, unit;          ///< as written after a value, "N/mm"; empty for a plain number
  double start = 0;                ///< where a search begins
  double low = 0, high = 0;        ///< bounds of a search, inclusive
  bool log = false;                ///< searched on a logarithmic scale; low > 0
  std::optional<double> vanishes;  ///< the value (may be infinite) at which the edits that use it do nothing
  std::string about;
  bool optional = false;  ///< need not be given: the default is `start`; for an unknown initial state
  std::optional<ParameterPrior> prior = {};  ///< what is known of it before
};

/// One change of the description. `paths` are alternatives for devices that differ in structure: the first that the
/// device has is taken. They are paths as edited() takes them, or contain selectors:
///   leg.<actuated>  every part with a driven freedom (in the legs, in separate mounts, in branches);
///   leg.<line>      the start of every bar that can carry only a force along itself, x along it;
///   leg.<pivot>     the joint at which such a bar begins, z along it, in families with named axes;
///   leg.<guide>     every driven slide that holds a member;
///   leg.<guided>, sections.<guided>  that member, its section;
///   leg.<carriage>  a fixed joint at that member's tip;
///   leg.<seat>      a fixed joint at the end of a leg in the axes of the platform;
///   …<motion>       after leg.<actuated>: each of its driven freedoms;
///   …<slide>        those along an axis;
///   …<turn>         those about an axis;
///   materials.*.<moduli>  E of the material and, where it is given, G.
/// `value` is YAML in flow style. In it "$name" stands for a parameter in its own unit, "$name unit" for one in another
/// unit.
struct EffectEdit {
  enum class Action {
    set,       ///< the field takes the value
    append,    ///< the value joins a list: laws in series
    multiply,  ///< the number is multiplied by the plain number `value`
    add,       ///< the value is added to the number
  };
  Action action = Action::set;
  std::vector<std::string> paths;
  std::string value;
  int line = 0;  ///< in the file
};

/// What the effect acts on. An effect of one leg is applied to the leg given; its paths begin with "leg.".
enum class Scope { all_legs, one_leg, machine, rig };
inline constexpr const char* scope_names[] = {"all legs", "one leg", "machine", "rig"};

/// Explanation for the user.
struct EffectPages {
  std::string machine;  ///< what happens in the machine
  std::string data;     ///< what it looks like in the data
  std::string bench;    ///< how to confirm it on the bench
  std::string cure;     ///< what to do about it
};

struct Effect {
  std::string name, title;
  Scope scope = Scope::all_legs;
  std::vector<EffectParameter> parameters;
  std::vector<EffectEdit> edits;
  EffectPages pages;
  std::string see;     ///< sources
  std::string origin;  ///< the file, for messages
  int line = 0;        ///< of the effect's name in that file
  /// Set for an effect that is a law at a place (place_effects.h) and not an entry of a file.
  std::optional<subject::Place> place;
  /// Set where a function computes the edits, without "$name" in them, from the values of the parameters (in their
  /// units): `edits` are then those at the start values. The same values must give the same edits, in any thread. It is
  /// not called where every parameter that can vanish does: nothing is edited then. May throw InputError.
  std::function<std::vector<EffectEdit>(const VectorX& values)> edits_at = nullptr;
};

/// Whether all it changes is the shape in which equilibrium is written (`geometry`): its size is then known and there
/// is nothing to fit.
inline bool is_geometry(const Effect& e) {
  return !e.edits.empty() && std::all_of(e.edits.begin(), e.edits.end(), [](const EffectEdit& edit) {
    return edit.paths == std::vector<std::string>{"geometry"};
  });
}

}  // namespace deflect::effects
