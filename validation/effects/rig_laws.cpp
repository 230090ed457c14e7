#include <fmt/format.h>

#include "msa/base/index.h"
#include "validation/effects/place_laws.h"

namespace deflect::effects {
namespace {

/// How what a sensor reads is measured, and what is little of it.
struct ReadUnit {
  const char *suffix, *unit;
  double small;
};
const ReadUnit& read_unit(const subject::Place& p) {
  static constexpr ReadUnit units[] = {
      {"mm", "mm", 0.01}, {"rad", "rad", 1e-4}, {"N", "N", 10}, {"Nmm", "Nmm", 1e4}, {"um_per_m", "um/m", 5}};
  return nth(units, *p.reads);
}

std::string value_of_first(const std::vector<EffectParameter>& p, const subject::Place&) {
  return "$" + p.front().name;
}

/// Where a point lies that is described elsewhere.
std::vector<EffectParameter> point_of(const subject::Place& p) {
  std::vector<EffectParameter> out;
  for (const std::size_t axis : p.shifts)
    out.push_back({fmt::format("{}_mm", "xyz"[axis]), "mm", 5, -1000, 1000, false, 0,
                   fmt::format("from the described to the true point along {} of the platform, mm", "xyz"[axis])});
  return out;
}

const PlaceLaw of_rig[] = {
    {"factor",
     [](const subject::Place& p) { return p.kind == subject::PlaceKind::load && p.shifts.empty(); },
     "is not as large as described",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{{"factor", "", 0.95, 0.1, 10, true, 1, "true load over the recorded one"}};
     },
     value_of_first,
     {"The load {} is another one than described: a weight that was not weighed, a jack with friction, a wrong unit.",
      "All readings under {} are off by one factor, those under other loads are right.",
      "Weigh it, or put a load cell under it.", "Put the measured load in."},
     OneLeg::never,
     EffectEdit::Action::multiply,
     ".factor"},
    {"gain",
     [](const subject::Place& p) {
       return p.kind == subject::PlaceKind::sensor && p.other.empty() && p.shifts.empty();
     },
     "reads too much or too little",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{{"gain", "", 0.98, 0.3, 3, true, 1, "recorded over true value"}};
     },
     value_of_first,
     {"The scale of {} is off: its calibration, its amplifier, the lever or the angle at which it touches.",
      "All readings of {} are off by one factor, those of the other instruments are right.",
      "Give {} a known value and read the step.", "Calibrate it, or put the gain into the description."},
     OneLeg::never,
     EffectEdit::Action::set,
     ".gain"},
    {"zero",
     [](const subject::Place& p) { return p.reads.has_value(); },
     "does not count from zero",
     [](const subject::Place& p) {
       const ReadUnit& u = read_unit(p);
       return std::vector<EffectParameter>{{fmt::format("offset_{}", u.suffix), u.unit, u.small, -1e5 * u.small,
                                            1e5 * u.small, false, 0, "what it reads where the true value is zero"}};
     },
     value_of_first,
     {"The zero of {} was not taken, or has moved since.",
      "All readings of {} are off by one number, whatever the load.", "Unload and read it.",
      "Take the zero again, or say 'zero: free' in the description."},
     OneLeg::never,
     EffectEdit::Action::set,
     ".offset"},
    {"stiction",
     [](const subject::Place& p) { return p.reads && p.may_stick; },
     "sticks before it follows",
     [](const subject::Place& p) {
       const ReadUnit& u = read_unit(p);
       return std::vector<EffectParameter>{{fmt::format("stick_{}", u.suffix), u.unit, u.small, u.small * 1e-6,
                                            u.small * 1e6, true, 0, "how far the reading lags before it follows"}};
     },
     value_of_first,
     {"{} lags behind what it reads: a plunger that rubs, a worn spindle, play in its linkage.",
      "Loops of {} alone, of one width at every load; the other instruments show none.", "Tap it: it jumps.",
      "Clean or replace it; approach every reading from one side."},
     OneLeg::never,
     EffectEdit::Action::set,
     ".stick"},
    {"crosstalk",
     [](const subject::Place& p) { return !p.other.empty(); },
     "reads some of another sensor",
     [](const subject::Place& p) {
       return std::vector<EffectParameter>{
           {"share", "", 0.05, -1, 1, false, 0, "share of the true reading of " + p.other + " in its own"}};
     },
     [](const auto& p, const subject::Place& at) {
       return fmt::format("{{\"{}\": {}}}", at.other, value_of_first(p, at));
     },
     {"{} holds a share of what another channel reads: wires side by side, one amplifier for both, a plunger that is "
      "pushed sideways.",
      "{} is off in proportion to the other channel, also under loads that leave its own place at rest.",
      "Move or load the other instrument by hand: this one must not follow.",
      "Part the wires, shield them, or put the share into the description."}},
    {"turned",
     [](const subject::Place& p) { return !p.turns.empty(); },
     "acts in another direction",
     [](const subject::Place& p) {
       std::vector<EffectParameter> out;
       for (const std::size_t axis : p.turns)
         out.push_back(
             {fmt::format("r{}_rad", "xyz"[axis]), "rad", 0.01, -0.8, 0.8, false, 0,
              fmt::format("turn from the described to the true load about {} of the base, rad", "xyz"[axis])});
       return out;
     },
     value_of_first,
     {"The load {} leans: the jack or the rope stands askew, the weight hangs beside its point. A lean of 0.05 rad "
      "pushes "
      "sideways with 5 % of the load.",
      "Under {} readings sideways of the load, in proportion to it and right under other loads.",
      "A plumb line or a level beside the loading.", "Align it, or put its direction into the description."},
     OneLeg::never,
     EffectEdit::Action::add,
     ".turned",
     false,
     &subject::Place::turns},
    {"moved",
     [](const subject::Place& p) { return p.kind == subject::PlaceKind::load && !p.shifts.empty(); },
     "acts at another point",
     point_of,
     value_of_first,
     {"{} acts beside its point: the hook sits on a handle, the jack stands off the centre, the weight hangs on a "
      "gripper. 10 mm beside it, 100 N give a moment of 1 Nm.",
      "Readings that follow the moment of {} about its point: off most where the machine is soft in rotation, and "
      "right "
      "under a force through the true point.",
      "Measure where it touches, or turn the mount by 180 degrees and repeat.",
      "Load at the point, or put the true point into the description."},
     OneLeg::never,
     EffectEdit::Action::add,
     ".point",
     false,
     &subject::Place::shifts},
    {"moved",
     [](const subject::Place& p) { return p.kind == subject::PlaceKind::sensor && !p.shifts.empty(); },
     "reads another point",
     point_of,
     value_of_first,
     {"{} follows a point beside the one described: a reflector on the flange, a probe at the rim of the platform. "
      "10 mm beside it, a turn of 1 mrad reads as 10 um.",
      "Readings that follow the turn of the platform: off most under moments, and right where it does not turn. "
      "Rotations are read right.",
      "Measure where it touches, or turn its mount by 180 degrees and repeat.",
      "Read at the point, or put the true point into the description."},
     OneLeg::never,
     EffectEdit::Action::add,
     ".point",
     false,
     &subject::Place::shifts},
};

}  // namespace

std::span<const PlaceLaw> rig_laws() { return of_rig; }

}  // namespace deflect::effects
