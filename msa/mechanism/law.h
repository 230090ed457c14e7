// The laws that an elastic freedom of a joint can follow: force along (or moment about) one axis against relative
// displacement. First the parameters of each law, then the table with one row for each: properties that do not depend
// on the parameters, and examples, from which the tests of all laws are made. `analytic/deflection.h` and
// `msa/frame/laws/component.h` compute the mechanics from the parameters independently of each other.
#pragma once

#include <array>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace deflect {

/// Isotropic linear-elastic solid. E in Pa. Exactly one of ν and G (Pa) is given; the other follows from E = 2G(1 + ν).
/// expansion: free strain per kelvin above 20 °C, 1/K.
struct Material {
  double E = 0;
  std::optional<double> nu, G;
  double expansion = 0;

  bool operator==(const Material&) const = default;
  double poisson() const { return nu ? *nu : E / (2 * *G) - 1; }
  double shear_modulus() const { return G ? *G : E / (2 * (1 + *nu)); }
};

/// Constant stiffness: N/m on a translation, Nm/rad on a rotation.
struct LinearLaw {
  double stiffness = 0;
  bool operator==(const LinearLaw&) const = default;
};

/// Hertz point contact of two bodies of one material; acts in both senses (a ball in its housing).
/// `radius` is the paper's effective radius R' of (24) in m: for a sphere of radius R on a plane R' = R/2.
struct HertzPointLaw {
  std::string material;
  double radius = 0;
  Material solid;  ///< resolved from the name by configure()
  bool operator==(const HertzPointLaw&) const = default;
};

/// Hertz line contact, linearised as in the paper's (28)–(30): no bulk term.
/// radius: effective radius R' of (24), for a line contact 1/R' = 1/r1 + 1/r2; length: of the line. Both m.
struct HertzLineLaw {
  std::string material;
  double radius = 0, length = 0;
  Material solid;
  bool operator==(const HertzLineLaw&) const = default;
};

/// Line contact of two cylinders of one material, with the compression of both between contact and centre (K. L.
/// Johnson, Contact Mechanics, 1985, §5.6). Radii and length in m; holds while the contact is much narrower than the
/// radii.
struct HertzLineBulkLaw {
  std::string material;
  double radius_1 = 0, radius_2 = 0, length = 0;
  Material solid;
  bool operator==(const HertzLineBulkLaw&) const = default;
};

/// A round pin, simply supported at its ends and loaded in the middle (31)–(32). Diameter and length in m.
struct PinBendingLaw {
  std::string material;
  double diameter = 0, length = 0;
  Material solid;
  bool operator==(const PinBendingLaw&) const = default;
};

/// Torsion of a solid round motor shaft (4), acting along a prismatic joint through a pulley of `pulley_radius` (5), m.
struct MotorShaftLaw {
  std::string material;
  double diameter = 0, length = 0, pulley_radius = 0;
  Material solid;
  bool operator==(const MotorShaftLaw&) const = default;
};

/// A drive cable (7): cross-section `area` (m²) of a material, or its EA (N) itself; free length in m, or the
/// actuator's extension where absent.
struct CableLaw {
  std::string material;
  double area = 0;
  std::optional<double> length;
  Material solid;
  std::optional<double> EA = std::nullopt;
  bool operator==(const CableLaw&) const = default;
};

/// Two parallel cables of a rotational transmission (8).
struct CablePairLaw {
  std::string material;
  double area_1 = 0, length_1 = 0, area_2 = 0, length_2 = 0;
  Material solid;
  bool operator==(const CablePairLaw&) const = default;
};

/// Timing belt (9)–(10): specific stiffness c_sp (stiffness of a belt of unit width and unit length, N/m), width b,
/// free lengths L1 and L2 of the tight and slack side (m). On a rotation the belt turns a pulley of `pulley_radius` at
/// the joint.
struct BeltLaw {
  double specific_stiffness = 0, width = 0, tight_length = 0, slack_length = 0;
  std::optional<double> pulley_radius = std::nullopt;
  bool operator==(const BeltLaw&) const = default;
};

// The laws below act on translations and on rotations: m and N, or rad and Nm. f is the force that the joint transmits
// along its axis, positive where it pulls the far side along +axis; δ is the motion of the far side along +axis.

/// δ = deflection · sign(f) |f/force|^exponent, 0 < exponent ≤ 1: Hertz contact has 2/3.
struct PowerLaw {
  double deflection = 0, force = 0, exponent = 1;
  bool operator==(const PowerLaw&) const = default;
};

/// δ = pull · f where f > 0, push · f where f < 0; zero or absent means rigid in that sense. Models a contact or a
/// cable without preload.
struct OneSidedLaw {
  std::optional<double> pull, push;
  bool operator==(const OneSidedLaw&) const = default;
};

/// f = stiffness · δ (1 + (δ/reference)²).
struct HardeningLaw {
  double stiffness = 0, reference = 0;
  bool operator==(const HardeningLaw&) const = default;
};

/// Free travel ±gap: δ = +gap under f > 0, −gap under f < 0, f = 0 in between. A clearance that carries nothing (below
/// 1e-9 of the largest force) stays in the middle.
struct ClearanceLaw {
  double gap = 0;
  bool operator==(const ClearanceLaw&) const = default;
};

/// How a friction stands at the first reading of a pose, in words of a device file.
enum class FrictionStart {
  given,    ///< by the numbers `start` and `kept`
  relaxed,  ///< carries nothing: start 0, kept 0
  kept,     ///< carries what it carried at the pose before: start 0, kept 1
  unknown,  ///< anything: predicted as relaxed, `start` is uniform from −1 to 1 (subject/machine.cpp)
};
inline constexpr const char* friction_start_words[] = {"", "relaxed", "kept", "unknown"};

/// Elastic–Coulomb friction (a Jenkins element): f = stiffness · (δ − slip), |f| ≤ limit. Beyond that the slip changes
/// so that |f| = limit. The slip is the law's history (conditions.h). limit = force + share · |what the laws that it
/// stands side by side with carry|: teeth, pins and bearings rub by the force that presses them. Only a friction beside
/// an elastic freedom of a joint has a share. While it slides, the tangent stiffness leaves out that the limit grows.
struct FrictionLaw {
  double force = 0, stiffness = 0;
  /// −1 … 1: initial state. Before the first reading of a pose the machine carried this share of the pose's largest
  /// load, and the load was removed again; readings are relative to this unloaded state. 0: no earlier load.
  double start = 0;
  double kept = 1;   ///< 0 … 1: share of its force that a friction element beside a leg keeps from pose to pose
  double share = 0;  ///< 0 … 0.95
  FrictionStart word = FrictionStart::given;
  int number = -1;  ///< index among the slips of a configuration, see number_slips(); not compared
  bool operator==(const FrictionLaw& other) const {
    return force == other.force && stiffness == other.stiffness && start == other.start && kept == other.kept &&
           share == other.share && word == other.word;
  }
};

/// Points [f, δ] of a measured curve, straight between them.
using TablePoints = std::vector<std::array<double, 2>>;

struct TableCurves;  // table.h

/// δ(f) as measured. `points` pass through [0, 0] and rise; where none has a negative force the curve is odd. Beyond
/// the ends it goes on with its last slope. `unloading`: the branch from the last point back to no force; with it the
/// law remembers (table.h), and the deflections that loads leave in it are two of its history's numbers (conditions.h).
struct TableLaw {
  TablePoints points, unloading = {};
  std::shared_ptr<const TableCurves> curves = nullptr;  ///< by identified(), as configure() does
  int number = -1;                                      ///< of the first of the two, see number_slips()
  std::array<double, 2> left{};                         ///< those before the load, under pull and under push
  bool remembers() const { return !unloading.empty(); }
  bool operator==(const TableLaw& other) const { return points == other.points && unloading == other.unloading; }
};

using Law =
    std::variant<LinearLaw, HertzPointLaw, HertzLineLaw, PinBendingLaw, MotorShaftLaw, CableLaw, CablePairLaw, BeltLaw,
                 HertzLineBulkLaw, PowerLaw, OneSidedLaw, HardeningLaw, ClearanceLaw, FrictionLaw, TableLaw>;

enum class Curve {
  straight,  ///< one stiffness at every load
  smooth,    ///< stiffness depends on the load; force and deflection each follow from the other
  jumps,     ///< set-valued: at some force any deflection, or at some deflection any force; solved by phases
};

struct LawRow {
  const char* name;   ///< in device files
  const char* along;  ///< an example on a translation, as a device file has it
  const char* about;  ///< an example on a rotation; null: only allowed on translations
  Curve curve;
  bool has_history = false;       ///< its force always depends on earlier loads (conditions.h)
  bool length_from_pose = false;  ///< without a given length it is as long as the actuator's extension
};

/// In the order of the variant.
inline constexpr LawRow law_rows[] = {
    {"linear", "stiffness: 400 N/mm", "stiffness: 100 Nm/rad", Curve::straight},
    {"hertz_point", "material: steel, radius: 4 mm", nullptr, Curve::smooth},
    {"hertz_line", "material: steel, radius: 1.5 mm, length: 10 mm", nullptr, Curve::straight},
    {"pin_bending", "material: steel, diameter: 3 mm, length: 10 mm", nullptr, Curve::straight},
    {"motor_shaft", "material: steel, diameter: 6 mm, length: 50 mm, pulley_radius: 10 mm", nullptr, Curve::straight},
    {"cable", "material: steel, area: 1 mm^2, length: 80 mm", nullptr, Curve::straight, false, true},
    {"cable_pair", "material: steel, area_1: 1 mm^2, length_1: 80 mm, area_2: 2 mm^2, length_2: 300 mm", nullptr,
     Curve::straight},
    {"belt", "specific_stiffness: 2000 N/mm, width: 10 mm, tight_length: 100 mm, slack_length: 300 mm",
     "specific_stiffness: 2000 N/mm, width: 10 mm, tight_length: 100 mm, slack_length: 300 mm, pulley_radius: 20 mm",
     Curve::straight},
    {"hertz_line_bulk", "material: steel, radius_1: 3 mm, radius_2: 4 mm, length: 10 mm", nullptr, Curve::smooth},
    {"power", "deflection: 2.5 um, force: 1 N, exponent: 0.6667", "deflection: 1 mrad, moment: 1 Nm, exponent: 0.7",
     Curve::smooth},
    {"one_sided", "pull: 1e-5 mm/N, push: 0.01 mm/N", "pull: 0.01 rad/Nm, push: 0.001 rad/Nm", Curve::jumps},
    {"hardening", "stiffness: 500 N/mm, reference: 0.1 mm", "stiffness: 100 Nm/rad, reference: 0.01 rad",
     Curve::smooth},
    {"clearance", "gap: 0.02 mm", "gap: 0.1 deg", Curve::jumps},
    {"friction", "force: 1000 N, stiffness: 1e4 N/mm", "moment: 100 Nm, stiffness: 1e4 Nm/rad", Curve::jumps, true},
    {"table", "points: [[0 N, 0 mm], [15 N, 0.06 mm], [41 N, 0.1 mm], [90 N, 0.15 mm]]",
     "points: [[0 Nm, 0 mrad], [0.13 Nm, 1.5 mrad], [1.1 Nm, 4 mrad]]", Curve::smooth},
};
static_assert(std::size(law_rows) == std::variant_size_v<Law>, "a law without a row, or a row without a law");

inline constexpr auto law_names = [] {
  std::array<const char*, std::size(law_rows)> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = law_rows[i].name;
  return names;
}();

inline const LawRow& row_of(const Law& law) { return law_rows[law.index()]; }

/// Whether the stiffness does not depend on the force. A power law with exponent 1 is linear.
inline bool is_linear(const Law& law) {
  const auto* power = std::get_if<PowerLaw>(&law);
  return row_of(law).curve == Curve::straight || (power && power->exponent == 1);
}

/// Whether it is a table that has a branch for unloading.
inline bool remembers(const Law& law) {
  const auto* table = std::get_if<TableLaw>(&law);
  return table && table->remembers();
}
/// Whether its force depends on earlier loads.
inline bool has_history(const Law& law) { return row_of(law).has_history || remembers(law); }
/// Whether it is solved by phases: a table that remembers is, because it begins where earlier loads left it.
inline bool jumps(const Law& law) { return row_of(law).curve == Curve::jumps || remembers(law); }

/// The field for the length that a law may take from the pose, empty where the file gives no length; null for a law
/// without such a field.
inline std::optional<double>* length_from_pose(Law& law) {
  auto* cable = std::get_if<CableLaw>(&law);
  return cable ? &cable->length : nullptr;
}
inline bool lacks_length(const Law& law) {
  const auto* cable = std::get_if<CableLaw>(&law);
  return cable && !cable->length;
}

}  // namespace deflect
