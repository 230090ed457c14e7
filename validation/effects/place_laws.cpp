#include "validation/effects/place_laws.h"

#include <fmt/format.h>

#include <limits>

#include "msa/base/index.h"

namespace deflect::effects {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How parameters are measured at a place: along an axis or about one.
struct Units {
  const char *way, *force, *moment_word;
  double small_way, stiffness;  ///< a way that is little (mm, rad), a stiffness that is large (N/mm, Nmm/rad)
};
constexpr Units along{"mm", "N", "force", 1e-4, 1e5}, about{"rad", "Nmm", "moment", 1e-6, 1e9};

const Units& units(const subject::Place& p) { return p.rotation() ? about : along; }

EffectParameter parameter(std::string name, std::string unit, double start, double vanishes, std::string words) {
  return {std::move(name), std::move(unit), start, start * 1e-6, start * 1e6, true, vanishes, std::move(words)};
}

EffectParameter spring(const subject::Place& p, const char* words) {
  const Units& u = units(p);
  return parameter(fmt::format("stiffness_{}_per_{}", u.force, u.way), fmt::format("{}/{}", u.force, u.way),
                   u.stiffness, infinity, fmt::format("{}, {}/{}", words, u.force, u.way));
}

bool in_series(const subject::Place& p) { return !p.freedoms.empty() && p.hold != subject::Hold::free; }
bool single(const subject::Place& p) { return p.freedoms.size() == 1; }
bool of_frame(const subject::Place& p) {
  return p.path.starts_with("supports.") || p.path.starts_with("springs.") || p.path.starts_with("members.");
}
/// A frame has many ends of members: there only what is common is looked for.
bool may_be_loose(const subject::Place& p) {
  return in_series(p) && single(p) && !(p.kind == subject::PlaceKind::member_end && of_frame(p));
}

std::vector<EffectParameter> yields_in_one_sense(const subject::Place& p) {
  const Units& u = units(p);
  return {parameter(fmt::format("yields_{}_per_{}", u.way, u.force), fmt::format("{}/{}", u.way, u.force),
                    1 / u.stiffness, 0, "deflection by force in the sense in which it yields")};
}

std::string first_of(const std::vector<EffectParameter>& p) { return "$" + p.front().name; }

const PlaceLaw of_places[] = {
    {"linear",
     [](const subject::Place& p) { return in_series(p) && !p.one_stiffness; },
     "yields like a spring",
     [](const subject::Place& p) { return std::vector{spring(p, "its stiffness")}; },
     [](const auto& p, const subject::Place&) { return "{law: linear, stiffness: " + first_of(p) + "}"; },
     {"Force passes through {} on its way to the tool. There it is not as rigid as it is drawn: a bearing, a clamp, a "
      "screw joint or a thin wall yields in proportion to the force.",
      "The displacement is too large in proportion to the load, the same in both senses, where {} carries force, and "
      "not where it carries none.",
      "Put a dial gauge across {} and load the tool there and back: the reading follows the force on a straight "
      "line.",
      "Stiffen {}, preload it, or take its stiffness into the model."},
     OneLeg::at_parts_alike},
    {"factor",
     [](const subject::Place& p) { return p.one_stiffness; },
     "is not as stiff as described",
     [](const subject::Place& p) {
       return std::vector<EffectParameter>{{"factor", "", 0.9, of_frame(p) ? 1e-6 : 0.02, 50, true, 1,
                                            "true stiffness over the one in the description"}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"The stiffness of {} in the description comes from a data sheet or an estimate; the part has another one.",
      "The displacement is too large or too small in proportion to the load that {} carries.",
      "Load {} alone and read its stiffness off the slope.", "Put the measured stiffness into the description."},
     OneLeg::at_parts_alike,
     EffectEdit::Action::multiply,
     ".stiffness"},
    {"factor",
     [](const subject::Place& p) { return p.kind == subject::PlaceKind::member && p.in_legs(); },
     "does not bend as the description says",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{
           {"factor", "", 0.9, 0.02, 50, true, 1, "true bending stiffness over the one in the description"}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"{} bends more or less than its section and material say: a cut, a weld, a wall that is thinner.",
      "The displacement is too large or too small in proportion to the bending moment in {}.",
      "Bend {} alone and read its stiffness off the slope.", "Measure the section, or put the factor into the model."},
     OneLeg::at_parts_alike,
     EffectEdit::Action::multiply,
     ".bending_factor"},
    {"factor",
     [](const subject::Place& p) { return p.path.starts_with("members.") && p.freedoms.empty(); },
     "is not as stiff as described",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{
           {"factor", "", 0.9, 1e-6, 50, true, 1, "true stiffness over the one in the description; near 0: missing"}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"{} is softer or stiffer than its section and material say: another section or grade, corrosion, a crack, a "
      "loose "
      "connection, cladding that carries. A factor near zero is a member that does nothing.",
      "Readings are off in proportion to the force in {}, and its share of the load goes to its neighbours.",
      "Measure its section; tap it and listen; read the strain on it under a known load.",
      "Repair it, or put the factor into the model."},
     OneLeg::never,
     EffectEdit::Action::multiply,
     ".factor"},
    {"factor",
     [](const subject::Place& p) { return p.path.starts_with("materials."); },
     "is stiffer or softer than described",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{
           {"factor", "", 0.95, 0.3, 3, true, 1, "true modulus over the one in the description"}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"The moduli of {} are not those of the description: another alloy, a wrong table.",
      "What bends or stretches of it is off by one factor.", "Test a sample.", "Put the measured modulus in."},
     OneLeg::never,
     EffectEdit::Action::multiply,
     ".<moduli>"},
    {"factor",
     [](const subject::Place& p) { return p.path.starts_with("sections."); },
     "is not as described",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{
           {"factor", "", 0.98, 0.4, 2.5, true, 1, "true length over the one in the description"}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"{} was made, worn or written down wrong.", "All members of that section are off by one factor.",
      "Measure it with a caliper.", "Put the measured length in."},
     OneLeg::never,
     EffectEdit::Action::multiply},
    {"heat",
     [](const subject::Place& p) { return p.expands; },
     "is warmer than at the zero",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{{"heated_K", "K", 5, -300, 300, false, 0, "how much warmer it is, K"}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"{} has another temperature than when the readings were set to zero: the sun on one side, a motor, a draught. It "
      "is longer by expansion times its length.",
      "All readings are off by one number each, whatever the load, in the pattern of a longer {}.",
      "A thermometer on it and on its neighbours.", "Wait, shade it, or take the zero again."},
     OneLeg::never,
     EffectEdit::Action::add,
     ".heated"},
    {"misfit",
     [](const subject::Place& p) { return p.misfit_shows; },
     "is too long or too short",
     [](const subject::Place&) {
       return std::vector<EffectParameter>{{"misfit_mm", "mm", 0.1, -50, 50, false, 0, "how much too long it is, mm"}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"{} was made or tightened to another length than its nodes are apart: it is strained before any load, and "
      "strains "
      "others.",
      "What depends on the force that is there already: play that is taken up earlier on one side, bending that grows "
      "with the axial force.",
      "Loosen its joint: it springs.", "Adjust its length, or put the misfit into the description."},
     OneLeg::never,
     EffectEdit::Action::add,
     ".misfit"},
    {"settled",
     [](const subject::Place& p) {
       return p.kind == subject::PlaceKind::support && p.hold == subject::Hold::rigid && single(p);
     },
     "has moved",
     [](const subject::Place& p) {
       const Units& u = units(p);
       const double way = 1e3 * u.small_way;
       return std::vector<EffectParameter>{{fmt::format("way_{}", u.way), u.way, way, -1e4 * way, 1e4 * way, false, 0,
                                            fmt::format("how far it has moved since the zero, {}", u.way)}};
     },
     [](const auto& p, const subject::Place&) { return first_of(p); },
     {"{} has moved since the readings were set to zero: soil that gives, a shim that was put in, a jack.",
      "All readings are off by one number each, whatever the load, as a movement of {} makes them.",
      "Level it against a point that does not move.", "Jack it back, or take the zero again."},
     OneLeg::never,
     EffectEdit::Action::add,
     ".settled"},
    {"clearance",
     may_be_loose,
     "has play",
     [](const subject::Place& p) {
       const Units& u = units(p);
       return std::vector{parameter(fmt::format("gap_{}", u.way), u.way, u.small_way, 0,
                                    fmt::format("free travel to either side of the middle, {}", u.way))};
     },
     [](const auto& p, const subject::Place&) { return "{law: clearance, gap: " + first_of(p) + "}"; },
     {"{} moves freely by a little before it carries force: a worn bearing, a loose fit, backlash of a gear.",
      "A step where the force in {} changes sign, of the same size at every load; nothing grows with the load.",
      "Push and pull by a small force: it jumps by the whole play.", "Preload {} or take up the play."},
     OneLeg::at_a_part},
    {"pull",
     may_be_loose,
     "yields to positive force alone",
     yields_in_one_sense,
     [](const auto& p, const subject::Place&) { return "{law: one_sided, pull: " + first_of(p) + "}"; },
     {"{} is held in one sense alone: an unpreloaded contact, a cable, a bearing against one shoulder. It yields where "
      "force pulls it along its positive axis.",
      "The displacement is too large for one sense of the load and right for the other.",
      "Load both senses: two slopes that meet at zero.", "Preload {}."}},
    {"push",
     may_be_loose,
     "yields to negative force alone",
     yields_in_one_sense,
     [](const auto& p, const subject::Place&) { return "{law: one_sided, push: " + first_of(p) + "}"; },
     {"{} is held in one sense alone: an unpreloaded contact, a cable, a bearing against one shoulder. It yields where "
      "force pushes it against its positive axis.",
      "The displacement is too large for one sense of the load and right for the other.",
      "Load both senses: two slopes that meet at zero.", "Preload {}."}},
    {"contact",
     [](const subject::Place& p) { return in_series(p) && single(p) && !p.rotation(); },
     "yields like a contact",
     [](const subject::Place&) {
       return std::vector{parameter("approach_mm", "mm", 1e-5, 0, "approach under 1 N, mm")};
     },
     [](const auto& p, const subject::Place&) {
       return "{law: power, deflection: " + first_of(p) + ", force: 1 N, exponent: 0.66666666666666663}";
     },
     {"Round bodies touch at {}: a ball, a roller, a cam. The contact flattens as the force to the power 2/3.",
      "The displacement is too large, most so at small loads: it grows as the force to the power 2/3.",
      "Load in steps: the slope falls with the load.", "Preload {}, or more and larger rolling bodies."}},
    {"hardening",
     [](const subject::Place& p) { return p.kind == subject::PlaceKind::drive && single(p); },
     "yields and becomes stiffer with deflection",
     [](const subject::Place& p) {
       const Units& u = units(p);
       std::vector<EffectParameter> out = {spring(p, "stiffness without load")};
       out.push_back(
           {fmt::format("reference_{}", u.way), u.way, 1e2 * u.small_way, 1e-2 * u.small_way, 1e5 * u.small_way, true,
            std::nullopt,
            fmt::format("deflection at which the {} is twice that of a linear spring, {}", u.moment_word, u.way)});
       return out;
     },
     [](const auto& p, const subject::Place&) {
       return fmt::format("{{law: hardening, stiffness: ${}, reference: ${}}}", p[0].name, p[1].name);
     },
     {"More and more of {} carries as it deflects: teeth, rollers, a flexspline, a rubber element.",
      "The displacement is too large at small loads and less so at large ones, odd in the load.",
      "Load in steps: the slope rises with the load.", "Take the measured curve into the model."},
     OneLeg::at_a_part},
    {"friction",
     [](const subject::Place& p) { return single(p) && p.hold != subject::Hold::rigid; },
     "sticks before it slips",
     [](const subject::Place& p) {
       const Units& u = units(p);
       const double force = p.rotation() ? 100 : 2, stiffness = p.rotation() ? 1e6 : 1e3;
       const std::string strength = fmt::format("{}_{}", u.moment_word, u.force),
                         stuck = fmt::format("stiffness_{}_per_{}", u.force, u.way);
       const double most = of_frame(p) ? 1e6 : 1e4;  // a support of a building carries MN
       std::vector<EffectParameter> out = {
           {strength, u.force, force, force * 1e-4, force * most, true, 0,
            fmt::format("{} that friction holds before it slips, {}", u.moment_word, u.force)},
           {stuck, fmt::format("{}/{}", u.force, u.way), stiffness, stiffness * 1e-4, stiffness * most, true,
            std::nullopt, fmt::format("stiffness while it sticks, {}/{}", u.force, u.way)}};
       if (!of_frame(p))  // whose frictions start relaxed
         out.push_back({"start_share", "", 0, -1, 1, false, std::nullopt,
                        "share of the largest load that came and went before the first reading", true});
       return out;
     },
     [](const auto& p, const subject::Place& at) {
       return fmt::format("{{law: friction, {}: ${}, stiffness: ${}{}}}", units(at).moment_word, p[0].name, p[1].name,
                          p.size() > 2 ? ", start: $" + p[2].name : "");
     },
     {"{} rubs: seals, bearings and teeth hold a part of the load until they slip.",
      "Loops: loading and unloading differ, and the displacement does not return to zero.",
      "Load and unload slowly; tap the machine: it creeps towards the frictionless curve.",
      "Lubricate {}, relieve its preload, or approach every reading from the same side."},
     OneLeg::at_a_part,
     EffectEdit::Action::append,
     "",
     true},
    {"load_friction",
     [](const subject::Place& p) {
       return p.kind == subject::PlaceKind::drive && single(p) && p.hold == subject::Hold::elastic;
     },
     "rubs in proportion to its load",
     [](const subject::Place& p) {
       const Units& u = units(p);
       const double stiffness = p.rotation() ? 1e6 : 1e3;
       return std::vector<EffectParameter>{
           {"share", "", 0.2, 1e-3, 0.9, true, 0, "friction by load in the elastic parts that it stands beside"},
           {fmt::format("stiffness_{}_per_{}", u.force, u.way), fmt::format("{}/{}", u.force, u.way), stiffness,
            stiffness * 1e-4, stiffness * 1e4, true, std::nullopt,
            fmt::format("stiffness while it sticks, {}/{}", u.force, u.way)},
           {"start_share", "", 0, -1, 1, false, std::nullopt,
            "share of the largest load that came and went before the first reading", true}};
     },
     [](const auto& p, const subject::Place& at) {
       const Units& u = units(at);
       return fmt::format("{{law: friction, {}: 0 {}, share: ${}, stiffness: ${}, start: ${}}}", u.moment_word, u.force,
                          p[0].name, p[1].name, p[2].name);
     },
     {"What presses teeth, pins and bearings of {} is the load itself: they rub the more the more it carries.",
      "Loops that are wide where the load is large and narrow at zero: loading is steep, and after the turn the "
      "displacement stays until a good part of the load is gone.",
      "Load and unload to two amplitudes: the width of the loop grows with the load.",
      "Lubricate {}, or let rollers roll where they slide."},
     OneLeg::never,
     EffectEdit::Action::append,
     "",
     true},
    {"restraint",
     [](const subject::Place& p) { return single(p) && p.hold == subject::Hold::free; },
     "is not free",
     [](const subject::Place& p) {
       const Units& u = units(p);
       return std::vector<EffectParameter>{{fmt::format("stiffness_{}_per_{}", u.force, u.way),
                                            fmt::format("{}/{}", u.force, u.way), u.stiffness * 1e-5,
                                            u.stiffness * 1e-11, u.stiffness * (of_frame(p) ? 1e4 : 10), true, 0,
                                            fmt::format("stiffness that holds it, {}/{}", u.force, u.way)}};
     },
     [](const auto& p, const subject::Place&) { return "{law: linear, stiffness: " + first_of(p) + "}"; },
     {"{} is drawn free and is held: a hose, a seal, a flexure, a joint that binds.",
      "The displacement is too small in proportion to the load, where the motion of {} would give way.",
      "Move {} by hand, unloaded: it springs back.", "Free it, or take the restraint into the model."}},
};

}  // namespace

std::span<const PlaceLaw> place_laws() {
  static const std::vector<PlaceLaw> laws = [] {
    std::vector<PlaceLaw> out(std::begin(of_places), std::end(of_places));
    out.insert(out.end(), rig_laws().begin(), rig_laws().end());
    return out;
  }();
  return laws;
}

}  // namespace deflect::effects
