#include "msa/mechanism/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <type_traits>

#include "msa/mechanism/joint_table.h"

namespace deflect {
namespace {

Quantity required(Dimension d, Range range = positive) { return {d, range, std::nullopt}; }
Quantity optional(double otherwise, Dimension d, Range range) { return {d, range, otherwise}; }
Quantity length() { return required(Dimension::length); }
Quantity area() { return required(Dimension::area); }

template <class T>
std::vector<std::string> names(const Named<T>* list) {
  std::vector<std::string> out;
  if (list)
    for (const auto& [name, value] : *list) out.push_back(name);
  return out;
}

std::size_t index_of(std::span<const char* const> all, const std::string& name) {
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin());
}

template <class V, std::size_t... I>
void become(V& variant, std::size_t index, std::index_sequence<I...>) {
  ((index == I ? static_cast<void>(variant.template emplace<I>()) : void()), ...);
}

// Sections

void fields(FieldVisitor& v, RoundSection& s) { v.quantity("diameter", s.diameter, length(), "outer diameter"); }

void fields(FieldVisitor& v, TubeSection& s) {
  v.quantity("outer_diameter", s.outer_diameter, length(), "outer diameter");
  v.quantity("inner_diameter", s.inner_diameter, length(), "inner diameter");
  v.require(s.inner_diameter < s.outer_diameter, "inner_diameter", "must be below outer_diameter");
}

void fields(FieldVisitor& v, RectangleSection& s) {
  v.quantity("width_y", s.width_y, length(), "side along local y");
  v.quantity("height_z", s.height_z, length(), "side along local z");
}

void fields(FieldVisitor& v, GivenSection& s) {
  v.quantity("A", s.A, area(), "cross-section");
  v.quantity("Iy", s.Iy, required(Dimension::second_moment), "second moment of area about local y");
  v.quantity("Iz", s.Iz, required(Dimension::second_moment), "second moment of area about local z");
  v.quantity("J", s.J, required(Dimension::second_moment), "torsion constant");
  v.quantity_if_given("As_y", s.As_y, area(), "shear area along local y");
  v.quantity_if_given("As_z", s.As_z, area(), "shear area along local z");
}

// Laws

void material_of(FieldVisitor& v, std::string& material) {
  v.word("material", material, {"material", names(v.surroundings.materials), std::nullopt}, "name of a material");
}

void fields(FieldVisitor& v, LinearLaw& l) {
  v.quantity("stiffness", l.stiffness,
             required(v.surroundings.rotation ? Dimension::rotational_stiffness : Dimension::stiffness),
             "constant stiffness");
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
  material_of(v, l.material);
  v.quantity("area", l.area, area(), "cross-section of the cable");
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
}

// Parts of a leg

void describe_laws(FieldVisitor& v, Joint& joint) {
  for (std::size_t i = 0; i < 6; ++i) {
    v.surroundings.rotation = i >= 3;
    ListElements<Law> laws(joint.laws[i]);
    v.one_or_list(freedom_names[i], laws, "laws in series on this freedom");
  }
}

void fields(FieldVisitor& v, Joint& joint) {
  v.word("joint", joint.type, {"joint type", joint_type_names(), std::nullopt}, "joint type");
  v.word("at", joint.at, {"point", v.surroundings.points, std::nullopt}, "point where the joint is");
  v.word("axes", joint.axes, {"set of axes", v.surroundings.axes, std::nullopt}, "axes of the joint");
  describe_laws(v, joint);
}

void fields(FieldVisitor& v, Member& member) {
  v.word("member", member.section, {"section", names(v.surroundings.sections), std::nullopt}, "name of a section");
  material_of(v, member.material);
  v.word("from", member.from, {"point", v.surroundings.points, std::nullopt}, "point where the member begins");
  v.word("to", member.to, {"point", v.surroundings.points, std::nullopt}, "point where the member ends");
  v.require(member.from != member.to, "to", "must be another point than 'from'");

  std::string beam = beam_theory_names[static_cast<std::size_t>(member.beam)];
  v.word("beam", beam,
         {"beam theory", {std::begin(beam_theory_names), std::end(beam_theory_names)}, beam_theory_names[0]},
         "beam theory");
  member.beam = static_cast<BeamTheory>(index_of(beam_theory_names, beam));
  const Section* section = v.surroundings.sections ? find(*v.surroundings.sections, member.section) : nullptr;
  const auto* given = section ? std::get_if<GivenSection>(&section->shape) : nullptr;
  v.require(member.beam != BeamTheory::timoshenko || !given || (given->As_y && given->As_z), "beam",
            fmt::format("timoshenko needs As_y and As_z in section '{}'", member.section));

  v.quantity("bending_factor", member.bending_factor, optional(1, Dimension::ratio, positive),
             "multiplies the bending stiffness");
}

/// base and tool: joints whose place is fixed and that hold, except where a law lets them yield.
void describe_fixture(FieldVisitor& v, const char* key, Joint& joint, const char* at, const char* axes,
                      const char* about) {
  joint.at = at;
  joint.axes = axes;
  v.surroundings.on_actuator = false;
  const auto body = [&] {
    v.word("joint", joint.type, {"joint type of base or tool", {"fixed"}, "fixed"}, "joint type");
    describe_laws(v, joint);
  };
  v.object(key, Need::optional, false, body, about);
  v.surroundings.on_actuator = true;
}

// Families

void fields(FieldVisitor& v, SixPsu& k) {
  const Range third{0, 120 * pi / 180};
  v.quantity("base_radius", k.base_radius, length(), "radius of the base joints' circle");
  v.quantity("platform_radius", k.platform_radius, length(), "radius of the platform joints' circle");
  v.quantity("link_length", k.link_length, length(), "distance between ball and universal joint");
  v.quantity("base_angle", k.base_angle, required(Dimension::angle, third), "angle between the base joints of a pair");
  v.quantity("platform_angle", k.platform_angle, required(Dimension::angle, third),
             "angle between the platform joints of a pair");
  v.quantity("slider_min", k.slider_min, length(), "smallest free length of the guideway");
  v.quantity("slider_max", k.slider_max, length(), "largest free length of the guideway");
  v.require(k.slider_min < k.slider_max, "slider_max", "must be above slider_min");
}

void place_names(const SixPsu&, Surroundings& s) {
  s.points = {"A", "B", "C"};
  s.axes = {"base", "guide", "link", "platform"};
}

void describe_rig(FieldVisitor& v, LoadCell& cell, Sensor& sensor) {
  const auto cell_fields = [&] {
    v.quantity("gain", cell.gain, optional(1, Dimension::ratio, positive), "true load over recorded load");
    v.vector3("rotation", cell.rotation, Dimension::angle, "rotation vector from recorded to true load");
  };
  const auto sensor_fields = [&] {
    v.vector3("rotation", sensor.rotation, Dimension::angle, "rotation vector from true to recorded displacement");
    v.vector3("drift", sensor.drift, Dimension::length, "drift of the reading over a sequence");
  };
  const auto both = [&] {
    v.object("load_cell", Need::optional, false, cell_fields, "how loads are recorded");
    v.object("sensor", Need::optional, false, sensor_fields, "how displacements are recorded");
  };
  v.object("rig", Need::optional, false, both, "how loads and displacements are recorded");
}

void describe_tolerances(FieldVisitor& v, Tolerances& t) {
  const Quantity relative = optional(0, Dimension::ratio, not_negative),
                 absolute = optional(0, Dimension::length, not_negative);
  v.quantity("modulus", t.modulus, relative, "standard deviation of E");
  v.quantity("guide_diameter", t.guide_diameter, relative, "standard deviation of a guideway's diameter");
  v.quantity("load", t.load, relative, "standard deviation of a recorded load");
  v.quantity("joint_position", t.joint_position, absolute, "standard deviation of a joint's position per axis");
  v.quantity("link_length", t.link_length, absolute, "standard deviation of a link's length");
  v.quantity("actuator_repeatability", t.actuator_repeatability, absolute, "standard deviation of a slider's position");
}

/// `key: name` says which alternative of the variant holds; its fields follow.
template <class V>
void tagged(FieldVisitor& v, V& variant, const char* key, const char* what, std::span<const char* const> all,
            const char* about) {
  std::string name = all[variant.index()];
  v.word(key, name, {what, {all.begin(), all.end()}, std::nullopt, true}, about);
  const std::size_t index = index_of(all, name);
  if (index != variant.index()) become(variant, index, std::make_index_sequence<std::variant_size_v<V>>());
  std::visit([&](auto& alternative) { fields(v, alternative); }, variant);
}

}  // namespace

void describe(FieldVisitor& v, Material& m) {
  const Range poisson{-1, 0.5, true};
  v.quantity("E", m.E, required(Dimension::stress), "Young's modulus");
  v.quantity_if_given("nu", m.nu, required(Dimension::none, poisson), "Poisson's ratio");
  v.quantity_if_given("G", m.G, required(Dimension::stress), "shear modulus");
  v.require(m.nu.has_value() != m.G.has_value(), m.nu ? "G" : "nu",
            m.nu ? "nu and G are both given: E = 2G(1 + nu), remove one" : "is missing: give nu or G, as in 'nu: 0.3'");
  if (m.nu || !m.G) return;
  v.require(poisson.holds(m.poisson()), "G",
            fmt::format("gives Poisson's ratio {}: it must lie between -1 and 0.5", m.poisson()));
}

void describe(FieldVisitor& v, Section& s) {
  tagged(v, s.shape, "shape", "shape", shape_names, "shape of the cross-section");
}

void describe(FieldVisitor& v, Law& law) {
  tagged(v, law, "law", "law", law_names, "force against relative displacement");
  v.require(
      !v.surroundings.rotation || std::holds_alternative<LinearLaw>(law), "law",
      fmt::format("'{}' acts along a translation (tx, ty, tz); a rotation takes 'linear'", law_names[law.index()]));
}

void describe(FieldVisitor& v, Part& part) {
  const std::size_t index = v.alternative({"joint", "member"}, part.index());
  if (index != part.index()) become(part, index, std::make_index_sequence<2>());
  std::visit([&](auto& p) { fields(v, p); }, part);
}

void describe(FieldVisitor& v, Variation& variation) {
  v.integer("leg", variation.leg, 1, 6, "number of the leg");
  v.text("path", variation.path, Need::required, "field inside the leg, as in 'guideway.bending_factor'");
  v.any("value", variation.value, "what stands there in this leg");
}

void describe_leg(FieldVisitor& v, Named<Part>& leg) {
  NamedElements<Part> parts(leg);
  v.entries("leg", parts, Need::required, "parts of every leg from the base to the platform");
}

Surroundings surroundings_of(const Mechanism& m) {
  Surroundings s;
  s.materials = &m.materials;
  s.sections = &m.sections;
  std::visit([&](const auto& k) { place_names(k, s); }, m.kinematics);
  return s;
}

void describe(FieldVisitor& v, Mechanism& m) {
  v.text("name", m.name, Need::required, "name of the device");
  v.text("about", m.about, Need::optional, "one line about the device");
  v.text("source", m.source, Need::optional, "where the numbers are from");
  const auto family = [&] { tagged(v, m.kinematics, "family", "family", family_names, "family of mechanisms"); };
  v.object("kinematics", Need::required, false, family, "family and dimensions");

  NamedElements<Material> materials(m.materials);
  v.entries("materials", materials, Need::optional, "materials by name");
  NamedElements<Section> sections(m.sections);
  v.entries("sections", sections, Need::optional, "cross-sections by name");

  v.surroundings = surroundings_of(m);
  describe_leg(v, m.leg);
  ListElements<Variation> variations(m.variations);
  v.list("variations", variations, "legs that differ");
  describe_fixture(v, "base", m.base, "origin", "base", "between the world and the machine");
  describe_fixture(v, "tool", m.tool, "T", "platform", "between the platform and the tool point");

  Workspace& w = m.workspace;
  const auto cube = [&] {
    v.quantity("nominal_slider", w.nominal_slider, length(), "free length of every guideway at the centre");
    v.quantity("cube_edge", w.cube_edge, length(), "edge of the cube of validation");
  };
  v.object("workspace", Need::optional, w.nominal_slider == 0 && w.cube_edge == 0, cube, "where it is validated");
  describe_rig(v, m.load_cell, m.sensor);
  v.object(
      "tolerances", Need::optional, false, [&] { describe_tolerances(v, m.tolerances); },
      "standard deviations from machine to machine");
}

}  // namespace deflect
