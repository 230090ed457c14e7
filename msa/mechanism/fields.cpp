#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/field_lists.h"
#include "msa/mechanism/rig_fields.h"

namespace deflect {
namespace {

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
  ListElements<LegDeviation> deviations(k.deviations);
  v.list("deviations", deviations, "legs whose joints or links are not as drawn");
}

void fields(FieldVisitor& v, Chains& k) {
  describe_if_given(v, "home", k.home, "pose of the tool point from which the kinematics start",
                    [&v](Placement& p) { describe(v, p); });
  v.matrix("controller", k.controller, 0, Need::optional,
           "joint coordinates of the chain over those that users give, row by row");
  v.require(k.controller.size() == 0 || Eigen::FullPivLU<MatrixX>(k.controller).isInvertible(), "controller",
            "is singular: different coordinates of the user would be the same of the chain");
}

void place_names(const Chains&, Surroundings& s) { s.chains = true; }

void place_names(const SixPsu&, Surroundings& s) {
  s.points = {"A", "B", "C"};
  s.axes = {"base", "guide", "link", "platform"};
}

void describe_tolerances(FieldVisitor& v, Tolerances& t) {
  const Quantity relative = optional(0, Dimension::ratio, Range{0, 1}),
                 absolute = optional(0, Dimension::length, not_negative);
  v.quantity("modulus", t.modulus, relative, "standard deviation of E");
  v.quantity("guide_diameter", t.guide_diameter, relative, "standard deviation of a guideway's diameter");
  v.quantity("load", t.load, relative, "standard deviation of a recorded load");
  v.quantity("joint_position", t.joint_position, absolute, "standard deviation of a joint's position per axis");
  v.quantity("link_length", t.link_length, absolute, "standard deviation of a link's length");
  v.quantity("actuator_repeatability", t.actuator_repeatability, absolute, "standard deviation of a slider's position");
  v.others(t.numbers,
           "standard deviation of other numbers, by path ('leg.elbow.rz.stiffness') or kind of place "
           "('drive.stiffness', 'member.length'): '10 %' of each, or '0.1 mm'");
}

// Workspaces

void fields(FieldVisitor& v, CubeSpace& s) { v.quantity("cube_edge", s.edge, length(), "edge of a cube"); }

void fields(FieldVisitor& v, BoxSpace& s) {
  v.vector3("box", s.edges, Dimension::length, "edges along x, y and z; 0 mm where it is flat");
  v.require((s.edges.array() >= 0).all() && !s.edges.isZero(0), "box",
            "needs edges that are not negative, and one that is above zero: write for example 'box: [200 mm, 100 mm, 0 "
            "mm]'");
}

void fields(FieldVisitor& v, DiscSpace& s) {
  const auto body = [&] { v.quantity("radius", s.radius, length(), "radius of the disc"); };
  v.object("disc", Need::required, false, body, "level disc about the centre");
}

void fields(FieldVisitor& v, CylinderSpace& s) {
  const auto body = [&] {
    v.quantity("radius", s.radius, length(), "radius of the cylinder");
    v.quantity("height", s.height, length(), "height, half of it above the centre");
  };
  v.object("cylinder", Need::required, false, body, "upright cylinder about the centre");
}

/// Twice the enclosed area, either sign, over the square of the extent.
double flatness(const std::vector<PolygonSpace::Corner>& corners) {
  double area = 0, extent = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PolygonSpace::Corner &o = corners[0], &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
    extent = std::max(extent, std::hypot(a.x - o.x, a.y - o.y));
  }
  return extent > 0 ? std::abs(area) / (extent * extent) : 0;
}

void fields(FieldVisitor& v, PolygonSpace& s) {
  const auto body = [&] {
    ListElements<PolygonSpace::Corner> corners(s.corners);
    v.list("corners", corners, "corners in order, x and y in axes of the base");
    v.quantity_if_given("z", s.z, {Dimension::length, {}, std::nullopt}, "height, the centre's where absent");
    v.require(flatness(s.corners) > 1e-6, "corners",
              "enclose no area: write at least three, as in 'corners: [{x: 0 mm, y: 0 mm}, {x: 100 mm, y: 0 mm}, {x: 0 "
              "mm, y: 100 mm}]'");
  };
  v.object("polygon", Need::required, false, body, "level polygon");
}

void fields(FieldVisitor& v, PoseSpace& s) {
  ListElements<Placement> poses(s.poses);
  v.list("poses", poses, "poses of the tool point: shift from the base's origin, turn");
  v.require(!s.poses.empty(), "poses",
            "needs at least one: write for example 'poses: [{shift: [0 mm, 0 mm, 100 mm]}]'");
}

/// The sensors of a machine whose legs are described already.
class SensorElements final : public Elements {
 public:
  explicit SensorElements(Mechanism& m) : machine_(m) {}
  std::size_t size() const override { return machine_.sensors.size(); }
  std::string name(std::size_t i) const override { return machine_.sensors[i].first; }
  void add(const std::string& name) override { machine_.sensors.emplace_back(name, PointSensor()); }
  void describe_element(FieldVisitor& v, std::size_t i) override { describe(v, machine_.sensors[i].second, machine_); }

 private:
  Mechanism& machine_;
};

}  // namespace

constexpr Range poisson{-1, 0.5, true};

void describe_elastic(FieldVisitor& v, Material& m) {
  v.quantity("E", m.E, required(Dimension::stress), "Young's modulus");
  v.quantity_if_given("nu", m.nu, required(Dimension::none, poisson), "Poisson's ratio");
  v.quantity_if_given("G", m.G, required(Dimension::stress), "shear modulus");
  v.require(m.nu.has_value() != m.G.has_value(), m.nu ? "G" : "nu",
            m.nu ? "nu and G are both given: E = 2G(1 + nu), remove one" : "is missing: give nu or G, as in 'nu: 0.3'");
}

void describe_geometry(FieldVisitor& v, Geometry& geometry) {
  choice(v, "geometry", geometry, "geometry", geometry_names, "shape in which equilibrium is found");
}

void describe(FieldVisitor& v, Material& m) {
  describe_elastic(v, m);
  v.quantity("expansion", m.expansion, optional(0, Dimension::thermal_expansion, {}), "strain per kelvin");
  if (m.nu || !m.G) return;
  v.require(poisson.holds(m.poisson()), "G",
            fmt::format("gives Poisson's ratio {}: it must lie between -1 and 0.5", m.poisson()));
}

void describe(FieldVisitor& v, Placement& p) {
  v.vector3("shift", p.shift, Dimension::length, "origin in the axes of the frame before");
  v.vector3("turn", p.turn, Dimension::angle, "roll, pitch, yaw");
}

void describe(FieldVisitor& v, LegDeviation& d) {
  v.integer("leg", d.leg, 1, 6, "number of the leg");
  v.vector3("base_joint", d.base_joint, Dimension::length, "base joint beside its drawing, base axes");
  v.vector3("platform_joint", d.platform_joint, Dimension::length, "platform joint beside its drawing, platform axes");
  v.quantity("link_length", d.link_length, optional(0, Dimension::length, {}), "link longer than its drawing");
}

void describe(FieldVisitor& v, Variation& variation) {
  v.integer("leg", variation.leg, 1, v.surroundings.legs, "number of the leg");
  v.text("path", variation.path, Need::required, "field inside the leg, as in 'guideway.bending_factor'");
  v.any("value", variation.value, "0.5", "what stands there in this leg");
}

void describe(FieldVisitor& v, Misfit& misfit) {
  v.integer("leg", misfit.leg, 1, v.surroundings.legs, "number of the leg");
  describe_placement(v, "base", misfit.base, "seat on the base beside its drawing");
  describe_placement(v, "platform", misfit.platform, "seat on the platform beside its drawing");
}

Surroundings surroundings_of(const Mechanism& m) {
  Surroundings s;
  s.materials = &m.materials;
  s.sections = &m.sections;
  std::visit([&](const auto& k) { place_names(k, s); }, m.kinematics);
  s.legs = leg_count(m);
  return s;
}

void describe(FieldVisitor& v, Mechanism& m) {
  describe_name(v, m.name, "name of the device");
  v.text("about", m.about, Need::optional, "one line about the device");
  v.text("source", m.source, Need::optional, "where the numbers are from");
  const auto family = [&] {
    tagged(v, m.kinematics, "family", "family", family_names, "family of mechanisms", [&v](auto& k) { fields(v, k); });
  };
  v.object("kinematics", Need::required, false, family, "family and dimensions");

  NamedElements<Material> materials(m.materials);
  v.entries("materials", materials, Need::optional, "materials by name");
  NamedElements<Section> sections(m.sections);
  v.entries("sections", sections, Need::optional, "cross-sections by name");

  v.surroundings = surroundings_of(m);
  if (v.surroundings.chains) {
    ListElements<Mount> mounts(m.mounts);
    v.list("mounts", mounts, "where the legs stand on the base and on the platform");
    v.surroundings.legs = leg_count(m);
  }
  describe_leg(v, m.leg);
  const bool own_parts = std::all_of(m.mounts.begin(), m.mounts.end(), [](const Mount& p) { return !p.leg.empty(); });
  v.require(!m.leg.empty() || (own_parts && !m.mounts.empty()), "leg",
            "is missing: the parts of every leg, or of each in its mount");
  ListElements<Variation> variations(m.variations);
  v.list("variations", variations, "legs that differ");
  if (!v.surroundings.chains) {
    NamedElements<Joint> beside(m.beside);
    v.entries("beside", beside, Need::optional, "joints side by side with every leg, between base and platform");
  }
  describe_fixture(v, "base", m.base, "origin", "base", "between the world and the machine");
  describe_fixture(v, "tool", m.tool, "T", "platform", "between the platform and the tool point");

  v.quantity("payload", m.payload, optional(0, Dimension::mass, not_negative), "mass at the tool point");
  ListElements<Misfit> misfits(m.misfits);
  v.list("misfits", misfits, "legs that are assembled beside their drawing");

  describe_geometry(v, m.geometry);

  describe_workspace(v, m.workspace);
  describe_rig(v, m.load_cell, m.sensor, m.trusted);
  SensorElements sensors(m);
  v.entries("sensors", sensors, Need::optional, "instruments by name, beside the one at the tool point");
  NamedElements<LoadPoint> loads(m.loads);
  v.entries("loads", loads, Need::optional, "points by name at which loads act, beside the tool point");
  v.object(
      "tolerances", Need::optional, false, [&] { describe_tolerances(v, m.tolerances); },
      "standard deviations from machine to machine");
}

void describe(FieldVisitor& v, PolygonSpace::Corner& c) {
  const Quantity anywhere{Dimension::length, {}, std::nullopt};
  v.quantity("x", c.x, anywhere, "along x of the base");
  v.quantity("y", c.y, anywhere, "along y of the base");
}

void describe_workspace(FieldVisitor& v, Workspace& w) {
  const auto* cube = std::get_if<CubeSpace>(&w.shape);
  const bool absent = w.nominal_slider == 0 && cube && cube->edge == 0;
  const auto body = [&] {
    if (!v.surroundings.chains)
      v.quantity("nominal_slider", w.nominal_slider, length(), "free length of every guideway at the centre");
    become(w.shape, v.alternative({std::begin(workspace_keys), std::end(workspace_keys)}, w.shape.index()));
    std::visit([&](auto& shape) { fields(v, shape); }, w.shape);
    describe_if_given(v, "centre", w.centre, "pose of the tool point in the middle, the home pose where absent",
                      [&v](Placement& p) { describe(v, p); });
    v.require(!w.centre || !std::holds_alternative<PoseSpace>(w.shape), "centre", "does not go with a list of poses");
  };
  v.object("workspace", Need::optional, absent, body, "where it is validated, mapped and measured");
}

}  // namespace deflect
