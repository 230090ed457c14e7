#include "msa/frame/file/frame_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/frame/file/member_axes.h"

namespace deflect::frame {
namespace {

Quantity required(Dimension d, Range range = positive) { return {d, range, std::nullopt}; }

constexpr Freedoms all_freedoms{true, true, true, true, true, true},
    translations{true, true, true, false, false, false};

/// A list of freedoms, or one of them; for supports also a word for several.
void describe_freedoms(FieldVisitor& v, const char* key, Freedoms& freedoms, const FreedomNames& names, Need need,
                       bool support, const char* about) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < 6; ++i)
    if (freedoms[i]) words.emplace_back(names[i]);
  if (support && freedoms == all_freedoms) words = {"clamped"};
  v.texts(key, words, need, about);
  freedoms = {};
  if (words.empty()) return;
  std::vector<std::string> known(names.begin(), names.end());
  if (support) known.insert(known.end(), {"clamped", "pinned"});
  for (const std::string& word : words) {
    const auto i = as_size(std::find(known.begin(), known.end(), word) - known.begin());
    if (i >= known.size()) {
      v.require(false, key, unknown_name("freedom", word, known));
    } else if (i < 6) {
      v.require(!freedoms[i], key, fmt::format("'{}' is named twice", word));
      freedoms[i] = true;
    } else {
      v.require(words.size() == 1, key, fmt::format("'{}' stands alone, without other freedoms", word));
      freedoms = i == 6 ? all_freedoms : translations;
    }
  }
}

void describe_material(FieldVisitor& v, FrameMaterial& m) {
  describe_elastic(v, m.elastic);
  v.quantity_if_given("density", m.density, required(Dimension::density), "mass per volume, for gravity");
  v.quantity_if_given("expansion", m.expansion, required(Dimension::thermal_expansion, {}), "strain per kelvin");
}

/// A whole number from 1 to 10000, 1 where absent.
void describe_count(FieldVisitor& v, const char* key, int& count, const char* about) {
  double number = count;
  v.quantity(key, number, {Dimension::none, Range{1, 10000}, 1}, about);
  if (number != std::floor(number)) v.require(false, key, fmt::format("{} is not a whole number", number));
  count = static_cast<int>(number);
}

void describe_geometry(FieldVisitor& v, FrameDescription& f) {
  deflect::describe_geometry(v, f.geometry);
  describe_count(v, "load_steps", f.load_steps, "in how many steps the load comes, at least");
  v.require(f.load_steps == 1 || f.geometry == Geometry::finite, "load_steps", "goes with 'geometry: finite'");
}

void describe_theory(FieldVisitor& v, FrameMember& m, const Section* section, const FrameMaterial* material) {
  describe_beam_theory(v, m.beam, section, m.section);
  if (m.beam != BeamTheory::timoshenko || !section) return;
  const bool tube = std::holds_alternative<TubeSection>(section->shape);
  if (!tube || !material || !(material->elastic.nu || material->elastic.G)) return;
  const double nu = material->elastic.poisson();
  v.require(nu > -1 && nu < 0.5 + 1e-12, "beam",
            fmt::format("timoshenko takes the shear coefficient of a tube from Poisson's ratio, which E and G of "
                        "'{}' make {:.4g}: give the section with its shear areas (shape: given)",
                        m.material, nu));
}

/// How a member is connected to its nodes.
void describe_connection(FieldVisitor& v, FrameMember& m, const FrameNames& names) {
  describe_freedoms(v, "release_from", m.release_from, member_freedoms, Need::optional, false,
                    "freedoms that are not passed on at 'from', member axes");
  describe_freedoms(v, "release_to", m.release_to, member_freedoms, Need::optional, false,
                    "freedoms that are not passed on at 'to', member axes");
  std::string truss = m.truss ? "true" : "false";
  v.word("truss", truss, {"truth value", {"false", "true"}, "false"}, "hinged at both ends: passes on no rotation");
  m.truss = truss == "true";
  v.require(!m.truss || (m.release_from == Freedoms{} && m.release_to == Freedoms{}), "truss",
            "releases the rotations of both ends: leave release_from and release_to away");
  constexpr Freedoms hinged{false, false, false, true, true, true};
  describe_end(v, "start", m.start, m.truss ? hinged : m.release_from, names,
               "how its start yields against the node 'from', member axes");
  describe_end(v, "end", m.end, m.truss ? hinged : m.release_to, names,
               "how its end yields against the node 'to', member axes");
}

void describe_member(FieldVisitor& v, FrameMember& m, const FrameNames& names) {
  v.text("from", m.from, Need::required, "node where the member begins");
  v.text("to", m.to, Need::required, "node where the member ends");
  const int a = require_known(v, "from", "node", m.from, names.nodes, names.frame.nodes);
  const int b = require_known(v, "to", "node", m.to, names.nodes, names.frame.nodes);
  v.require(m.from != m.to, "to", "must be another node than 'from'");
  v.text("section", m.section, Need::required, "name of a section");
  v.text("material", m.material, Need::required, "name of a material");
  const int section = require_known(v, "section", "section", m.section, names.sections, names.frame.sections);
  const int material = require_known(v, "material", "material", m.material, names.materials, names.frame.materials);
  describe_theory(v, m, section < 0 ? nullptr : &nth(names.frame.sections, section).second,
                  material < 0 ? nullptr : &nth(names.frame.materials, material).second);
  v.vector3("y_axis", m.y_axis, Dimension::none, "local y lies in the plane of the member and this vector");
  describe_connection(v, m, names);
  v.quantity("bending_factor", m.bending_factor, {Dimension::ratio, positive, 1}, "multiplies the bending stiffness");
  v.quantity("factor", m.factor, {Dimension::ratio, positive, 1}, "multiplies all stiffnesses of the member");
  v.quantity("misfit", m.misfit, {Dimension::length, {}, 0}, "how much too long the member is, without force");
  v.quantity("heated", m.heated, {Dimension::temperature, {}, 0}, "how much warmer it is than at the assembly");
  const FrameMaterial* of = material < 0 ? nullptr : &nth(names.frame.materials, material).second;
  if (m.heated != 0 && of && !of->expansion)
    v.require(false, "heated",
              fmt::format("material '{0}' has no thermal expansion: write for example 'expansion: 12e-6 1/K' in "
                          "materials.{0}",
                          m.material));
  describe_count(v, "elements", m.elements, "elements of equal length");
  if (a < 0 || b < 0) return;

  const Vector3 along = nth(names.frame.nodes, b).second - nth(names.frame.nodes, a).second;
  const bool length = along.norm() > 1e-9 * names.extent;
  if (!length)
    v.require(false, "to",
              fmt::format("'{}' and '{}' are at one place: a member has a length; join nodes with rigid_links or "
                          "springs",
                          m.from, m.to));
  v.require(!length || std::abs(m.misfit) < along.norm(), "misfit", "must be smaller than the member's length");
  const bool parallel = along.cross(m.y_axis).norm() <= 1e-6 * along.norm() * m.y_axis.norm();
  v.require(m.y_axis.isZero(0) || !length || !parallel, "y_axis", "is parallel to the member: name another direction");
}

void describe_link(FieldVisitor& v, RigidLink& link, const FrameNames& names) {
  v.text("master", link.master, Need::required, "node that leads");
  require_known(v, "master", "node", link.master, names.nodes, names.frame.nodes);
  v.texts("nodes", link.nodes, Need::required, "nodes that follow");
  for (const std::string& node : link.nodes) {
    require_known(v, "nodes", "node", node, names.nodes, names.frame.nodes);
    v.require(node != link.master, "nodes", "the master cannot follow itself");
  }
  Freedoms some = link.freedoms == all_freedoms ? Freedoms{} : link.freedoms;
  describe_freedoms(v, "freedoms", some, node_freedoms, Need::optional, false,
                    "freedoms that follow, all where absent");
  link.freedoms = some == Freedoms{} ? all_freedoms : some;
}

void describe_term(FieldVisitor& v, ConstraintTerm& t, const FrameNames& names) {
  v.text("node", t.node, Need::required, "node");
  require_known(v, "node", "node", t.node, names.nodes, names.frame.nodes);
  std::string freedom = nth(node_freedoms, t.freedom);
  v.word("freedom", freedom, {"freedom", {node_freedoms.begin(), node_freedoms.end()}, std::nullopt}, "freedom");
  const auto at = std::find(node_freedoms.begin(), node_freedoms.end(), freedom) - node_freedoms.begin();
  t.freedom = at < 6 ? static_cast<int>(at) : 0;
  v.quantity("factor", t.factor, {Dimension::none, {}, 1}, "factor of the displacement");
  v.require(t.factor != 0, "factor", "must not be zero");
  v.quantity_if_given("arm", t.arm, required(Dimension::length, {}), "makes a length of a rotation");
  v.require(!t.arm || (t.freedom >= 3 && *t.arm != 0), "arm", "goes with a rotation (rx, ry, rz) and is not zero");
}

class Terms final : public Elements {
 public:
  Terms(std::vector<ConstraintTerm>& terms, const FrameNames& names) : terms_(terms), names_(names) {}
  std::size_t size() const override { return terms_.size(); }
  std::string name(std::size_t) const override { return ""; }
  void add(const std::string&) override { terms_.emplace_back(); }
  void describe_element(FieldVisitor& v, std::size_t i) override { describe_term(v, terms_[i], names_); }

 private:
  std::vector<ConstraintTerm>& terms_;
  const FrameNames& names_;
};

void describe_constraint(FieldVisitor& v, FrameConstraint& c, const FrameNames& names) {
  Terms terms(c.terms, names);
  v.list("terms", terms, "what adds up to zero");
  v.require(!c.terms.empty(), "terms", "needs terms '- {node: N1, freedom: ux, factor: 1}'");
  const auto angle = [](const ConstraintTerm& t) { return t.freedom >= 3 && !t.arm; };
  const auto angles = as_size(std::count_if(c.terms.begin(), c.terms.end(), angle));
  v.require(angles == 0 || angles == c.terms.size(), "terms",
            "adds lengths and angles: give the rotations an arm, as in 'arm: 10 mm'");
}

}  // namespace

void describe_held(FieldVisitor& v, const char* key, Freedoms& freedoms) {
  describe_freedoms(v, key, freedoms, node_freedoms, Need::optional, true, "fixed freedoms, or 'clamped', or 'pinned'");
}

std::string unknown_name(const char* what, const std::string& name, const std::vector<std::string>& known) {
  const std::string hint = nearest(name, known);
  std::string list = fmt::format("{} are known", known.size());
  if (known.size() <= 12) list = known.empty() ? "known: none" : fmt::format("known: {}", fmt::join(known, ", "));
  return fmt::format("unknown {} '{}'{} ({})", what, name,
                     hint.empty() ? "" : fmt::format(", did you mean '{}'?", hint), list);
}

void describe_freedom_values(FieldVisitor& v, FreedomValues& values, Dimension translation, Dimension rotation,
                             Range range, const char* about) {
  for (std::size_t i = 0; i < 6; ++i)
    v.quantity_if_given(node_freedoms[i], values[i], required(i < 3 ? translation : rotation, range), about);
}

void describe(FieldVisitor& v, FrameDescription& f, bool absent_ends) {
  v.keys({"name", "about", "source", "geometry", "load_steps", "plane", "materials", "sections", "nodes", "members",
          "supports", "springs", "rigid_links", "constraints", "loads", "sensors", "rig", "tolerances"});
  describe_name(v, f.name, "name of the frame");
  v.text("about", f.about, Need::optional, "one line about the frame");
  v.text("source", f.source, Need::optional, "where the numbers are from");
  describe_geometry(v, f);
  std::string plane = nth(plane_names, f.plane);
  v.word("plane", plane, {"plane", {"xy", "xz", "yz", "none"}, "none"}, "the frame moves in this plane only");
  f.plane = static_cast<Plane>(std::find(plane_names.begin(), plane_names.end(), plane) - plane_names.begin());
  FrameNames names{f, {}, {}, {}, {}, {}, 0, absent_ends};

  FrameEntries<FrameMaterial> materials(f.materials, [](auto& w, auto&, auto& m) { describe_material(w, m); });
  v.entries("materials", materials, Need::optional, "materials by name");
  names.materials = NameIndex(f.materials);
  Named<Material> elastic;  // for laws
  for (const auto& [name, material] : f.materials) elastic.emplace_back(name, material.elastic);
  v.surroundings.materials = &elastic;
  FrameEntries<Section> sections(f.sections, [](auto& w, auto&, auto& s) { deflect::describe(w, s); });
  v.entries("sections", sections, Need::optional, "cross-sections by name");
  names.sections = NameIndex(f.sections);

  FrameEntries<Vector3> nodes(
      f.nodes, [](auto& w, auto&, auto& p) { w.vector3("", p, Dimension::length, "position"); }, true);
  v.entries("nodes", nodes, Need::required, "positions by name of the node");
  names.nodes = NameIndex(f.nodes);
  Eigen::AlignedBox3d box;
  for (const auto& [name, position] : f.nodes) box.extend(position);
  names.extent = f.nodes.empty() ? 0 : box.diagonal().norm();

  FrameEntries<FrameMember> members(f.members, [&](auto& w, auto&, auto& m) { describe_member(w, m, names); });
  v.entries("members", members, Need::optional, "members by name");
  names.members = NameIndex(f.members);
  FrameEntries<FrameSupport> supports(f.supports, [&](auto& w, auto& node, auto& s) { describe(w, node, s, names); });
  v.entries("supports", supports, Need::optional, "what holds nodes against the ground, by node");
  names.supports = NameIndex(f.supports);

  FrameEntries<FrameSpring> springs(f.springs, [&](auto& w, auto&, auto& s) { describe(w, s, names); });
  v.entries("springs", springs, Need::optional, "springs by name");
  v.surroundings.materials = nullptr;
  FrameEntries<RigidLink> links(f.rigid_links, [&](auto& w, auto&, auto& l) { describe_link(w, l, names); });
  v.entries("rigid_links", links, Need::optional, "nodes that move with another, by name");
  FrameEntries<FrameConstraint> constraints(f.constraints,
                                            [&](auto& w, auto&, auto& c) { describe_constraint(w, c, names); });
  v.entries("constraints", constraints, Need::optional, "linear conditions on displacements, by name");
  FrameEntries<LoadCase> loads(f.loads, [&](auto& w, auto&, auto& c) { describe(w, c, names); });
  v.entries("loads", loads, Need::required, "load cases by name");
  describe_rig(v, f, names);
}

}  // namespace deflect::frame
