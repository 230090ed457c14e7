#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>

#include "msa/base/index.h"
#include "msa/mechanism/field_lists.h"
#include "msa/mechanism/joint_table.h"
#include "msa/mechanism/law.h"

namespace deflect {
namespace {

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

void fields(FieldVisitor& v, BoxSection& s) {
  v.quantity("width_y", s.width_y, length(), "outer side along local y");
  v.quantity("height_z", s.height_z, length(), "outer side along local z");
  v.quantity("wall", s.wall, length(), "thickness of the walls");
  v.require(2 * s.wall < std::min(s.width_y, s.height_z), "wall",
            "two walls fill the box: it must be below half of width_y and of height_z");
}

/// Of an I or a channel.
template <class Flanged>
void fields_of_flanged(FieldVisitor& v, Flanged& s) {
  v.quantity("width_y", s.width_y, length(), "width of the flanges, along local y");
  v.quantity("height_z", s.height_z, length(), "outer height, along local z");
  v.quantity("web", s.web, length(), "thickness of the web");
  v.quantity("flange", s.flange, length(), "thickness of the flanges");
  v.require(s.web < s.width_y, "web", "must be below width_y");
  v.require(2 * s.flange < s.height_z, "flange", "two flanges fill the height: it must be below half of height_z");
}
void fields(FieldVisitor& v, ISection& s) { fields_of_flanged(v, s); }
void fields(FieldVisitor& v, ChannelSection& s) { fields_of_flanged(v, s); }

void fields(FieldVisitor& v, AngleSection& s) {
  v.quantity("long_leg", s.long_leg, length(), "outer length of the longer leg");
  v.quantity("short_leg", s.short_leg, length(), "outer length of the shorter leg, or of both");
  v.quantity("wall", s.wall, length(), "thickness of the legs");
  v.require(s.short_leg <= s.long_leg, "short_leg", "must not be above long_leg");
  v.require(s.wall < s.short_leg, "wall", "must be below short_leg");
}

// Parts of a leg

void fields(FieldVisitor& v, DhRow& row) {
  const Quantity angle = optional(0, Dimension::angle, {}), distance = optional(0, Dimension::length, {});
  v.quantity("theta", row.theta, angle, "turn about z at coordinate zero");
  v.quantity("d", row.d, distance, "offset along z");
  v.quantity("a", row.a, distance, "distance along x");
  v.quantity("alpha", row.alpha, angle, "twist about x");
}

Dimension coordinate(std::size_t freedom) { return freedom < 3 ? Dimension::length : Dimension::angle; }

void describe_laws(FieldVisitor& v, Joint& joint) {
  for (std::size_t i = 0; i < 6; ++i) {
    v.surroundings.rotation = i >= 3;
    ListElements<Law> laws(joint.laws[i]);
    v.one_or_list(freedom_names[i], laws, "laws in series on this freedom");
  }
  const auto preloads = [&] {
    for (std::size_t i = 0; i < 6; ++i)
      v.quantity(freedom_names[i], joint.preload[i], optional(0, i < 3 ? Dimension::force : Dimension::moment, {}),
                 "force that the joint keeps in its laws");
  };
  v.object("preload", Need::optional, false, preloads, "forces that the joint itself keeps in its laws");
  for (std::size_t i = 0; i < 6; ++i)
    v.require(joint.preload[i] == 0 || !joint.laws[i].empty(), "preload",
              fmt::format("acts in the laws of a freedom: {} has none", freedom_names[i]));
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& laws = joint.laws[i];
    v.require(joint.preload[i] == 0 || std::none_of(laws.begin(), laws.end(), has_history), "preload",
              fmt::format("{} has {}, which keeps no force by itself", freedom_names[i],
                          std::any_of(laws.begin(), laws.end(), remembers) ? "a table with 'unloading'" : "friction"));
  }
}

/// Laws side by side with what a freedom of a leg's joint does.
void describe_beside(FieldVisitor& v, Joint& joint) {
  const auto laws = [&] {
    for (std::size_t i = 0; i < 6; ++i) {
      v.surroundings.rotation = i >= 3;
      v.surroundings.side_by_side = !joint.laws[i].empty();
      ListElements<Law> beside(joint.beside[i]);
      v.one_or_list(freedom_names[i], beside, "laws, each side by side with all that is on this freedom");
    }
    v.surroundings.side_by_side = false;
  };
  v.object("beside", Need::optional, false, laws, "laws side by side with those of a freedom");
  const JointType* type = find_joint_type(joint.type);
  const std::string letters = joint.freedoms.size() == 6 ? joint.freedoms : type ? type->letters : "ffffff";
  for (std::size_t i = 0; i < 6; ++i)
    v.require(joint.beside[i].empty() || letters[i] == 'f' || !joint.laws[i].empty(), "beside",
              fmt::format("{} is rigid here, so that nothing side by side with it is loaded: give {} a law first",
                          freedom_names[i], freedom_names[i]));
  const auto any = [](const auto& all) {
    return std::any_of(all.begin(), all.end(), [](const auto& l) { return !l.empty(); });
  };
  v.require(!joint.stiffness || !any(joint.beside), "beside",
            "stands side by side with laws of single freedoms, and this joint has a stiffness of all of them");
}

/// A stiffness of all freedoms together.
void describe_stiffness(FieldVisitor& v, Joint& joint) {
  deflect::describe_stiffness(v, joint.stiffness, "leave a free freedom to the joint type");
  const bool laws = std::any_of(joint.laws.begin(), joint.laws.end(), [](const auto& l) { return !l.empty(); });
  v.require(!joint.stiffness || !laws, "stiffness", "a joint has a stiffness of all freedoms or laws, not both");
}

bool are_freedoms(const std::string& letters) {
  return letters.size() == 6 && letters.find_first_not_of("rfa") == letters.npos;
}

void describe_coordinates(FieldVisitor& v, Joint& joint) {
  const auto home = [&] {
    for (std::size_t i = 0; i < 6; ++i)
      v.quantity(freedom_names[i], joint.home[i], optional(0, coordinate(i), {}), "coordinate");
  };
  v.object("home", Need::optional, false, home, "coordinates from which the kinematics start");
  const auto limits = [&](const char* key, std::array<std::optional<double>, 6>& values, const char* about) {
    const auto body = [&] {
      for (std::size_t i = 0; i < 6; ++i)
        v.quantity_if_given(freedom_names[i], values[i], {coordinate(i), {}, std::nullopt}, about);
    };
    v.object(key, Need::optional, false, body, about);
  };
  limits("min", joint.min, "smallest coordinate");
  limits("max", joint.max, "largest coordinate");

  std::string letters = find_joint_type(joint.type)->letters;
  if (joint.type == "custom") letters = are_freedoms(joint.freedoms) ? joint.freedoms : "aaaaaa";  // refused before
  std::vector<std::string> moving;
  for (std::size_t i = 0; i < 6; ++i)
    if (letters[i] != 'r') moving.emplace_back(freedom_names[i]);
  const std::string moves = moving.empty() ? "does not move" : fmt::format("moves in {}", fmt::join(moving, ", "));
  for (std::size_t i = 0; i < 6; ++i) {
    const char* name = freedom_names[i];
    for (const auto& [key, given] : {std::pair{"home", joint.home[i] != 0},
                                     {"min", joint.min[i].has_value()},
                                     {"max", joint.max[i].has_value()}}) {
      v.require(!given || letters[i] != 'r', key,
                fmt::format("{} is no coordinate of this joint, which {}", name, moves));
      v.require(!given || key == std::string("home") || i < 3 || !letters.ends_with("fff"), key,
                fmt::format("{} has no limits: the turn of a ball joint is no angle about one axis", name));
    }
    v.require(!joint.min[i] || !joint.max[i] || *joint.min[i] < *joint.max[i], "max",
              fmt::format("{} must be above that of min", name));
    const double q = joint.home[i];
    v.require(q == 0 || (q >= joint.min[i].value_or(q) && q <= joint.max[i].value_or(q)), "home",
              fmt::format("{} lies outside of the joint's min … max", name));
  }
}

/// Of a joint beside a leg: no actuator moves it.
bool stands_beside(const std::string& type) {
  const std::string letters = find_joint_type(type)->letters;
  return type != "parallelogram" && letters.find('a') == letters.npos;
}

std::vector<std::string> joint_types(const Surroundings& s) {
  std::vector<std::string> all = joint_type_names();
  if (s.beside)
    std::erase_if(all, [](const std::string& t) { return !stands_beside(t); });
  else if (!s.chains)
    std::erase_if(all, [](const std::string& t) { return t == "custom" || t == "parallelogram"; });
  return all;
}

void describe_freedoms(FieldVisitor& v, Joint& joint) {
  if (joint.type != "custom") return;
  const bool actuated = !v.surroundings.beside;
  v.text("freedoms", joint.freedoms, Need::required,
         actuated ? "six letters for tx ty tz rx ry rz, which move in this order: r rigid, f free, a actuated"
                  : "six letters for tx ty tz rx ry rz, which move in this order: r rigid, f free");
  v.require(are_freedoms(joint.freedoms) && (actuated || joint.freedoms.find('a') == joint.freedoms.npos), "freedoms",
            fmt::format("'{}' are not six letters {}: write for example 'freedoms: {}'", joint.freedoms,
                        actuated ? "r, f or a" : "r or f", actuated ? "rrfrrf" : "ffrfff"));
}

/// Where a joint of a chain stands, and how it moves the chain.
void describe_in_chain(FieldVisitor& v, Joint& joint) {
  v.word("axes", joint.axes, {"place of the axes", {"before", "after"}, "before"},
         "laws act along the chain's axes before or after the joint's motion");
  Vector3 axis = joint.axis == Vector3::UnitZ() ? Vector3(Vector3::Zero()) : joint.axis;
  v.vector3("axis", axis, Dimension::none, "direction of the joint's z, in the axes of the chain");
  joint.axis = axis.isZero(0) ? Vector3(Vector3::UnitZ()) : axis;
  const auto row = [&v](DhRow& r) { fields(v, r); };
  describe_if_given(v, "dh", joint.dh, "row of a Denavit-Hartenberg table: the joint, then the row", row);
  describe_if_given(v, "modified_dh", joint.modified_dh, "row of a modified (Craig) table: the row, then the joint",
                    row);
  v.require(!joint.dh || !joint.modified_dh, "modified_dh",
            "a joint has one row: of the standard or of the modified table");
  describe_freedoms(v, joint);
  if (joint.type == "parallelogram") {
    v.vector3("bar", joint.bar, Dimension::length, "bars of the parallelogram at coordinate zero; they turn about z");
    v.require(joint.bar.head<2>().norm() > 0, "bar",
              "needs a length across z: write for example 'bar: [100 mm, 0 mm, 0 mm]'");
  }
  describe_coordinates(v, joint);
}

void fields(FieldVisitor& v, Joint& joint) {
  v.word("joint", joint.type, {"joint type", joint_types(v.surroundings), std::nullopt}, "joint type");
  if (v.surroundings.chains) {
    describe_in_chain(v, joint);
  } else {
    if (v.surroundings.beside) describe_freedoms(v, joint);
    v.word("at", joint.at, {"point", v.surroundings.points, std::nullopt}, "point where the joint is");
    v.word("axes", joint.axes, {"set of axes", v.surroundings.axes, std::nullopt}, "axes of the joint");
  }
  describe_laws(v, joint);
  describe_stiffness(v, joint);
  describe_beside(v, joint);
}

/// `from: PART`, or `from: {part: PART, at: start}`.
void describe_from(FieldVisitor& v, Member& member) {
  const char* about = "earlier part of the leg where the member begins";
  const Words parts{"earlier part of the leg", v.surroundings.earlier_parts, std::nullopt};
  const bool more = member.from_point != PartPoint::usual;
  std::string at = nth(part_point_names, member.from_point);
  member.from_point = PartPoint::usual;
  const auto fields = [&] {
    v.word("part", member.from, parts, about);
    v.word("at", at, {"point of a part", {"start", "end"}, std::nullopt}, "which point of the part");
    member.from_point = static_cast<PartPoint>(index_of(part_point_names, at));
  };
  v.word_or_object("from", member.from, parts, more, fields, about);
}

void describe_ends(FieldVisitor& v, Member& member) {
  if (v.surroundings.chains) {
    const std::size_t index = v.alternative({"along", "from"}, member.along ? 0 : 1);
    Vector3 along = member.along.value_or(Vector3::Zero());
    member.along.reset();
    if (index == 1) {
      describe_from(v, member);
    } else {
      v.vector3("along", along, Dimension::length, "from the start to the end, in the axes of the chain");
      member.along = along;
      v.require(along.norm() > 0, "along", "the member has no length");
    }
    v.vector3("y_axis", member.y_axis, Dimension::none,
              "local y lies in the plane of the member and this vector, axes of the chain");
    const double across = along.cross(member.y_axis).norm(), most = along.norm() * member.y_axis.norm();
    return v.require(index == 1 || member.y_axis.isZero(0) || across > 1e-6 * most, "y_axis",
                     "is parallel to the member: name another direction");
  }
  v.word("from", member.from, {"point", v.surroundings.points, std::nullopt}, "point where the member begins");
  v.word("to", member.to, {"point", v.surroundings.points, std::nullopt}, "point where the member ends");
  v.require(member.from != member.to, "to", "must be another point than 'from'");
}

}  // namespace

void describe_stiffness(FieldVisitor& v, std::optional<Matrix6>& stiffness, const char* where_free) {
  MatrixX rows;
  std::string units = "N-mm";
  if (stiffness) {
    const Matrix6 in_mm = stiffness_in_mm(*stiffness);
    const bool exact = stiffness_from_mm(in_mm) == *stiffness;  // to the last bit when it is read again
    units = exact ? "N-mm" : "N-m";
    rows = exact ? in_mm : *stiffness;
  }
  const bool absent = !stiffness;
  stiffness.reset();
  const auto body = [&] {
    v.word("units", units, {"set of units", {"N-mm", "N-m"}, "N-mm"}, "N/mm, N, Nmm or N/m, N, Nm");
    v.matrix("rows", rows, 6, Need::required, "stiffness [f; m] over [translation; rotation] in its axes");
    if (rows.size() == 0) return;
    Matrix6 K = rows;
    if (units == "N-mm") K = stiffness_from_mm(K);
    const bool symmetric = (K - K.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * K.cwiseAbs().maxCoeff();
    v.require(symmetric, "rows", "a stiffness is symmetric; this one is not");
    v.require(!symmetric || Eigen::LLT<Matrix6>(K).info() == Eigen::Success, "rows",
              fmt::format("a stiffness is positive definite; this one is not: {}", where_free));
    stiffness = (K + K.transpose()) / 2;
  };
  v.object("stiffness", Need::optional, absent, body, "stiffness of all six freedoms together");
}

void describe_beam_theory(FieldVisitor& v, BeamTheory& beam, const Section* section, const std::string& section_name) {
  choice(v, "beam", beam, "beam theory", beam_theory_names, "beam theory");
  const auto* given = section ? std::get_if<GivenSection>(&section->shape) : nullptr;
  v.require(beam != BeamTheory::timoshenko || !given || (given->As_y && given->As_z), "beam",
            fmt::format("timoshenko needs As_y and As_z in section '{}'", section_name));
}

namespace {

void fields(FieldVisitor& v, Member& member) {
  v.word("member", member.section, {"section", names(v.surroundings.sections), std::nullopt}, "name of a section");
  material_of(v, member.material);
  describe_ends(v, member);

  const Section* section = v.surroundings.sections ? find(*v.surroundings.sections, member.section) : nullptr;
  describe_beam_theory(v, member.beam, section, member.section);

  v.quantity("bending_factor", member.bending_factor, optional(1, Dimension::ratio, positive),
             "multiplies the bending stiffness");
  describe_fixture(v, "start", member.start, "", "", "how its start yields against what stands before it; x along it");
  describe_fixture(v, "end", member.end, "", "", "how its end yields against what follows; x along it");
}

void fields(FieldVisitor& v, Offset& o) {
  v.vector3("offset", o.shift, Dimension::length, "to the next frame of the chain");
  v.vector3("turn", o.turn, Dimension::angle, "roll, pitch, yaw to the next frame");
}

void fields(FieldVisitor& v, Parallel& p) {
  ListElements<Mount> mounts(p.mounts);
  v.list("mounts", mounts, "where the branches begin and end");
  NamedElements<Part> parts(p.leg);
  v.entries("leg", parts, Need::optional, "parts of every branch");
  const bool all = std::all_of(p.mounts.begin(), p.mounts.end(), [](const Mount& m) { return !m.leg.empty(); });
  v.require(!p.mounts.empty(), "mounts", "needs at least one branch");
  v.require(all || !p.leg.empty(), "leg", "is missing: the parts of every branch, or of each in its mount");
}

}  // namespace

void describe(FieldVisitor& v, Section& s) {
  tagged(v, s.shape, "shape", "shape", shape_names, "shape of the cross-section",
         [&v](auto& shape) { fields(v, shape); });
}

void describe(FieldVisitor& v, Joint& joint) {
  v.surroundings.beside = true;
  fields(v, joint);
  v.surroundings.beside = false;
}

void describe(FieldVisitor& v, Part& part) {
  const std::vector<std::string> kinds = v.surroundings.chains
                                             ? std::vector<std::string>{"joint", "member", "offset", "mounts"}
                                             : std::vector<std::string>{"joint", "member"};
  become(part, v.alternative(kinds, part.index()));
  std::visit([&](auto& p) { fields(v, p); }, part);
}

void describe(FieldVisitor& v, Named<Part>& chain, std::size_t i) {
  const std::vector<std::string> outer = v.surroundings.earlier_parts;
  for (std::size_t k = 0; k < i; ++k) v.surroundings.earlier_parts.push_back(chain[k].first);
  describe(v, chain[i].second);
  v.surroundings.earlier_parts = outer;
}

void describe(FieldVisitor& v, Mount& mount) {
  describe_placement(v, "base", mount.base, "first frame of the leg, in the frame of the base");
  describe_placement(v, "platform", mount.platform, "last frame of the leg, in the frame of the platform");
  NamedElements<Part> parts(mount.leg);
  v.entries("leg", parts, Need::optional, "parts of this leg, where they are not those of every leg");
}

void describe_fixture(FieldVisitor& v, const char* key, Joint& joint, const char* at, const char* axes,
                      const char* about) {
  joint.at = at;
  joint.axes = axes;
  v.surroundings.on_actuator = false;
  const auto body = [&] {
    v.word("joint", joint.type, {"joint type of base or tool", {"fixed"}, "fixed"}, "joint type");
    describe_laws(v, joint);
    describe_stiffness(v, joint);
  };
  v.object(key, Need::optional, false, body, about);
  v.surroundings.on_actuator = true;
}

void describe_leg(FieldVisitor& v, Named<Part>& leg) {
  NamedElements<Part> parts(leg);
  v.entries("leg", parts, v.surroundings.chains ? Need::optional : Need::required,
            "parts of every leg from the base to the platform");
}

}  // namespace deflect
