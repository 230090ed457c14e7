#include <fmt/format.h>
#include <fmt/ranges.h>

#include "msa/mechanism/field_lists.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/table.h"

namespace deflect {
namespace {

/// What a law along or about an axis is measured in.
Dimension motion(const FieldVisitor& v) { return v.surroundings.rotation ? Dimension::angle : Dimension::length; }
Dimension effort(const FieldVisitor& v) { return v.surroundings.rotation ? Dimension::moment : Dimension::force; }
Dimension stiffness(const FieldVisitor& v) {
  return v.surroundings.rotation ? Dimension::rotational_stiffness : Dimension::stiffness;
}
Dimension compliance(const FieldVisitor& v) {
  return v.surroundings.rotation ? Dimension::rotational_compliance : Dimension::compliance;
}
const char* effort_key(const FieldVisitor& v) { return v.surroundings.rotation ? "moment" : "force"; }

void fields(FieldVisitor& v, LinearLaw& l) {
  v.quantity("stiffness", l.stiffness, required(stiffness(v)), "constant stiffness");
}
void fields(FieldVisitor& v, HertzPointLaw& l) {
  material_of(v, l.material);
  v.quantity("radius", l.radius, length(), "effective radius");
}
void fields(FieldVisitor& v, HertzLineLaw& l) {
  material_of(v, l.material);
  v.quantity("radius", l.radius, length(), "effective radius");
  v.quantity("length", l.length, length(), "length of the line");
}
void fields(FieldVisitor& v, HertzLineBulkLaw& l) {
  material_of(v, l.material);
  v.quantity("radius_1", l.radius_1, length(), "radius of one cylinder");
  v.quantity("radius_2", l.radius_2, length(), "radius of the other cylinder");
  v.quantity("length", l.length, length(), "length of the line");
}
void fields(FieldVisitor& v, PinBendingLaw& l) {
  material_of(v, l.material);
  v.quantity("diameter", l.diameter, length(), "diameter of the pin");
  v.quantity("length", l.length, length(), "length of the pin");
}
void fields(FieldVisitor& v, MotorShaftLaw& l) {
  material_of(v, l.material);
  v.quantity("diameter", l.diameter, length(), "diameter of the shaft");
  v.quantity("length", l.length, length(), "length of the shaft");
  v.quantity("pulley_radius", l.pulley_radius, length(), "radius of the pulley");
}
void fields(FieldVisitor& v, CableLaw& l) {
  double EA = l.EA.value_or(0);
  const bool given = v.alternative({"EA", "material"}, l.EA ? 0 : 1) == 0;
  l.EA.reset();
  if (given) {
    v.quantity("EA", EA, required(Dimension::force), "axial rigidity of the cable");
    l.EA = EA;
  } else {
    material_of(v, l.material);
    v.quantity("area", l.area, area(), "cross-section of the cable");
  }
  v.quantity_if_given("length", l.length, length(), "free length, the actuator's extension where absent");
  v.require(l.length || v.surroundings.on_actuator, "length", "is needed here: this cable has no actuator");
}
void fields(FieldVisitor& v, CablePairLaw& l) {
  material_of(v, l.material);
  v.quantity("area_1", l.area_1, area(), "cross-section of cable 1");
  v.quantity("length_1", l.length_1, length(), "free length of cable 1");
  v.quantity("area_2", l.area_2, area(), "cross-section of cable 2");
  v.quantity("length_2", l.length_2, length(), "free length of cable 2");
}
void fields(FieldVisitor& v, BeltLaw& l) {
  // Force per unit strain and unit width times the width: a stiffness by its unit.
  v.quantity("specific_stiffness", l.specific_stiffness, required(Dimension::stiffness),
             "stiffness of a belt of unit width and length");
  v.quantity("width", l.width, length(), "width of the belt");
  v.quantity("tight_length", l.tight_length, length(), "free length of the tight side");
  v.quantity("slack_length", l.slack_length, length(), "free length of the slack side");
  double radius = l.pulley_radius.value_or(0);
  l.pulley_radius.reset();
  if (!v.surroundings.rotation) return;
  v.quantity("pulley_radius", radius, length(), "radius of the pulley that turns with the joint");
  l.pulley_radius = radius;
}

void fields(FieldVisitor& v, PowerLaw& l) {
  v.quantity("deflection", l.deflection, required(motion(v)), "deflection at that load");
  v.quantity(effort_key(v), l.force, required(effort(v)), "load at which the deflection is given");
  v.quantity("exponent", l.exponent, required(Dimension::none), "deflection grows with this power of the load");
  v.require(l.exponent <= 1, "exponent", "must be above 0 and at most 1: 0.6667 for a ball in its housing");
}
void fields(FieldVisitor& v, OneSidedLaw& l) {
  const Quantity one = required(compliance(v), not_negative);
  v.quantity_if_given("pull", l.pull, one, "compliance under a load along +axis, rigid where absent");
  v.quantity_if_given("push", l.push, one, "compliance under a load along -axis, rigid where absent");
  v.require(l.pull || l.push, "pull",
            fmt::format("is missing: give pull or push, as in 'pull: {}'",
                        v.surroundings.rotation ? "0.01 rad/Nm" : "0.001 mm/N"));
}
void fields(FieldVisitor& v, HardeningLaw& l) {
  v.quantity("stiffness", l.stiffness, required(stiffness(v)), "stiffness without load");
  v.quantity("reference", l.reference, required(motion(v)), "deflection at which the load is twice the linear one");
}
void fields(FieldVisitor& v, ClearanceLaw& l) {
  v.quantity("gap", l.gap, required(motion(v), not_negative), "free travel to either side of the middle");
}
/// `start` is a number or a word, which says what `kept` is.
void fields_of_start(FieldVisitor& v, FrictionLaw& l) {
  static const std::vector<std::string> words{std::begin(friction_start_words) + 1, std::end(friction_start_words)};
  std::string word = nth(friction_start_words, l.word);
  v.quantity_or_word(
      "start", l.start, optional(0, Dimension::none, {-1, 1}), word, words,
      "before the first reading of a pose: relaxed, kept, unknown, or the share of the largest load that "
      "came and went, -1 to 1; 0: relaxed");
  l.word = static_cast<FrictionStart>(index_of(friction_start_words, word));
  if (l.word != FrictionStart::given) {
    l.start = 0;
    l.kept = l.word == FrictionStart::kept ? 1 : 0;
    return;
  }
  v.quantity("kept", l.kept, optional(1, Dimension::none, {0, 1}),
             "share of what is in it that a friction beside a leg keeps from pose to pose, 0 to 1; 0: relaxed at each");
}
void fields(FieldVisitor& v, FrictionLaw& l) {
  v.quantity(effort_key(v), l.force, required(effort(v), not_negative), "load at which it slips");
  v.quantity("stiffness", l.stiffness, required(stiffness(v)), "stiffness before it slips");
  v.quantity("share", l.share, optional(0, Dimension::none, {0, 0.95}),
             "the load at which it slips grows by this share of what the laws beside it carry, 0 to 0.95");
  v.require(l.share == 0 || v.surroundings.side_by_side, "share",
            "is of the load in the laws that the friction stands side by side with: move it under 'beside' of a joint "
            "whose freedom has a law, as in 'beside: {rz: {law: friction, …}}'");
  fields_of_start(v, l);
}

void fields(FieldVisitor& v, TableLaw& l) {
  const std::array<Dimension, 2> units = {effort(v), motion(v)};
  v.pairs("points", l.points, units, Need::required, "load and deflection as measured, from no load upwards");
  v.pairs("unloading", l.unloading, units, Need::optional, "the same from the last point back to no load");
  const std::optional<TableMistake> mistake = mistake_in(l, units[0], units[1]);
  v.require(!mistake, mistake ? mistake->key : "points", mistake ? mistake->what : "");
}

/// "'linear', 'belt', … or 'friction'": the laws that a rotation takes.
std::string laws_about() {
  std::vector<std::string> names;
  for (const LawRow& law : law_rows)
    if (law.about) names.push_back(fmt::format("'{}'", law.name));
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

}  // namespace

void describe(FieldVisitor& v, Law& law) {
  tagged(v, law, "law", "law", law_names, "force against relative displacement", [&v](auto& l) { fields(v, l); });
  const LawRow& is = row_of(law);
  v.require(!v.surroundings.rotation || is.about, "law",
            fmt::format("'{}' acts along a translation (tx, ty, tz); a rotation takes {}", is.name, laws_about()));
}

}  // namespace deflect
