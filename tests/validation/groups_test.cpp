// Groups of places: what is of one kind in a leg, in a stage, on a line of supports; the laws there.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/edit_paths.h"
#include "validation/effects/place_effects.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace effects;
using subject::Place;
using subject::Subject;

Subject frame_named(const std::string& name) {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"));
}

Place group_in(const Subject& s, const std::string& id) {
  for (const Place& p : s.places())
    if (id_of(p) == id) return p;
  ADD_FAILURE() << s.name() << " has no place " << id;
  return {};
}

std::vector<std::string> parts_of(const Place& p) {
  std::vector<std::string> out = {p.part};
  for (const subject::OtherPart& other : p.others) out.push_back(other.part);
  return out;
}

using Parts = std::vector<std::string>;

TEST(Groups, AreOfOneKindInALegOrInAStage) {
  const Subject tripteron(test::device("tripteron")), gantry(test::device("gantry")), arm(test::device("arm"));
  EXPECT_EQ(parts_of(group_in(tripteron, "revolute_joints.tilt")), (Parts{"shoulder", "elbow", "wrist"}));
  EXPECT_TRUE(group_in(tripteron, "revolute_joints.tilt").in_legs());
  EXPECT_EQ(name_of(group_in(tripteron, "revolute_joints.tilt")), "group of revolute joints tilt");
  EXPECT_EQ(parts_of(group_in(tripteron, "members.rod")), (Parts{"upper_link", "lower_link"}));
  EXPECT_EQ(parts_of(group_in(gantry, "drives.tz")), (Parts{"x_slide", "portal.mounts.0.y_slide", "z_slide"}));
  EXPECT_EQ(parts_of(group_in(gantry, "members.post")), (Parts{"portal.mounts.0.post", "portal.mounts.1.post"}));
  EXPECT_EQ(parts_of(group_in(gantry, "portal.mounts.1.members")),
            (Parts{"portal.mounts.1.post", "portal.mounts.1.bridge"}));
  EXPECT_EQ(group_in(arm, "drives.rz").others.size(), 5U);
  EXPECT_EQ(group_in(arm, "drives.rz").hold, subject::Hold::elastic);
}

// l0 and r0 stand on one wall, l0 and l4 under one truss; l0 and r0 hold ux too.
TEST(Groups, OfFramesAreOnALineOrOfOneSection) {
  const Subject girder = frame_named("lattice-girder"), pads = frame_named("beam-on-springs");
  EXPECT_EQ(parts_of(group_in(girder, "supports.l0.along_y.uz")), (Parts{"support.l0", "support.r0"}));
  EXPECT_EQ(parts_of(group_in(girder, "supports.l0.along_x.uz")), (Parts{"support.l0", "support.l4"}));
  EXPECT_EQ(group_in(girder, "supports.uz").others.size(), 3U);
  EXPECT_EQ(parts_of(group_in(girder, "supports.ux")), (Parts{"support.l0", "support.r0"}));
  EXPECT_EQ(parts_of(group_in(girder, "supports.like_support.l4.ux")), (Parts{"support.l4", "support.r4"}));
  EXPECT_EQ(group_in(pads, "springs.uz").others.size(), 5U);
  EXPECT_EQ(name_of(group_in(girder, "supports.l0.along_y.uz")), "group of supports on the line through l0 along y uz");
}

std::vector<Subject> subjects() {
  std::vector<Subject> out;
  for (const std::string& name : test::device_names()) out.emplace_back(test::device(name));
  for (const char* name : {"truss", "truss-45", "portal", "portal-semi-rigid", "lattice-girder", "beam-on-springs"})
    out.push_back(frame_named(name));
  return out;
}

/// What an effect edits, whatever its parameters are called.
std::set<std::string> edits_of(const Effect& e, const Subject& s) {
  std::set<std::string> out;
  for (const EffectEdit& edit : e.edits)
    for (const std::string& path : paths_of(edit, s))
      out.insert(
          fmt::format("{} {} {}", path, fmt::underlying(edit.action), edit.value.substr(0, edit.value.find(','))));
  return out;
}

// One set of places, one law, one scope: one id.
TEST(Groups, NoTwoIdsStandForTheSameSet) {
  for (const Subject& s : subjects()) {
    std::set<std::string> ids;
    std::map<std::pair<bool, std::set<std::string>>, std::string> sets;
    int groups = 0;
    for (const Effect& e : place_effects(s, test::all_effects())) {
      EXPECT_TRUE(ids.insert(e.name).second) << s.name() << " " << e.name;
      const auto [at, is_new] = sets.emplace(std::pair(e.scope == Scope::one_leg, edits_of(e, s)), e.name);
      const bool same_law = e.name.substr(0, e.name.find('@')) == at->second.substr(0, at->second.find('@'));
      EXPECT_TRUE(is_new || !same_law) << s.name() << " " << e.name << " " << at->second;
      groups += e.place->others.empty() ? 0 : 1;
    }
    EXPECT_GT(groups, 0) << s.name();
    for (const Place& p : s.places()) {
      std::set<std::string> paths = {p.path};
      for (const subject::OtherPart& other : p.others)
        EXPECT_TRUE(paths.insert(other.path).second) << s.name() << " " << other.path;
    }
  }
}

// To act in a group is to act in each of its parts by the same amount.
TEST(Groups, ActAsTheirPartsDoTogether) {
  const Mechanism machine = test::device("tripteron");
  const std::vector<Effect> all = place_effects(Subject(machine), test::all_effects());
  const VectorX value = test::values({1e8});
  Mechanism each = machine;
  for (const char* part : {"shoulder", "elbow", "wrist"})
    each = with_effect(each, find_effect(all, fmt::format("linear@leg.{}.tilt", part)), value, 2);
  EXPECT_EQ(write_mechanism(with_effect(machine, find_effect(all, "linear@leg.revolute_joints.tilt"), value, 2)),
            write_mechanism(each));

  const Subject girder = frame_named("lattice-girder");
  const std::vector<Effect> laws = place_effects(girder, test::all_effects());
  const auto with = [&](const Subject& s, const char* name) {
    return effects::with_effect(s, {{&find_effect(laws, name), {}}, test::values({5e4})});
  };
  EXPECT_EQ(with(girder, "linear@supports.l0.along_y.uz").file_text("a", "b"),
            with(with(girder, "linear@support.l0.uz"), "linear@support.r0.uz").file_text("a", "b"));
}

bool names(const diagnosis::Diagnosis& d, const std::string& effect) {
  const auto same = [&](const std::string& id) { return id.starts_with(effect); };
  return std::any_of(d.missing.begin(), d.missing.end(), [&](const auto& e) { return same(e.effect->name); }) ||
         std::any_of(d.indistinguishable.begin(), d.indistinguishable.end(),
                     [&](const auto& tie) { return std::any_of(tie.begin(), tie.end(), same); });
}

std::string said(const diagnosis::Diagnosis& d) {
  std::string out;
  for (const auto& e : d.missing) out += e.effect->name + " ";
  for (const auto& tie : d.indistinguishable) out += fmt::format("({}) ", fmt::join(tie, ", "));
  return out;
}

frame::FrameDescription deformed(frame::FrameDescription f) {
  f.geometry = Geometry::finite;
  return f;
}

// Of machines readings of the other theory; all of them in the deformed shape, every part off by its tolerance.
TEST(Groups, AreNamedWhereTheyAreHidden) {
  struct Case {
    const char *subject, *effect;
    double value;
    std::optional<int> leg = {};
  };
  for (const Case& c : {Case{"tripteron", "linear@leg.revolute_joints.tilt", 2e9, 2},
                        {"tripteron", "linear@revolute_joints.tilt", 5e9},
                        {"arm", "factor@drives.rz", 0.8},
                        {"lattice-girder", "linear@supports.l0.along_y.uz", 5e4},
                        {"lattice-girder", "linear@supports.uz", 1e5},
                        {"beam-on-springs", "factor@springs.uz", 0.75}}) {
    const bool machine = std::string(c.subject).find("-") == std::string::npos;
    const Subject s = machine ? Subject(test::device(c.subject)) : frame_named(c.subject);
    std::vector<Effect> all = test::all_effects();
    for (Effect& e : place_effects(s, all)) all.push_back(std::move(e));
    const Effect& hidden = find_effect(all, c.effect);
    const Subject with = effects::with_effect(s, {{&hidden, c.leg}, VectorX::Constant(1, c.value)});
    prediction::SimulationOptions o;
    o.seed = 3;
    const measurement::Measurements data =
        machine ? prediction::simulate(*with.machine(), prediction::campaign("random", *s.machine(), 50, 3), o)
                : subject::simulate_frame(deformed(*with.frame()), subject::frame_campaign("rich", *s.frame(), 3), o);
    const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, all, {{}, 199});
    EXPECT_TRUE(names(d, c.effect)) << c.subject << " " << c.effect << ": " << said(d);
  }
}

}  // namespace
}  // namespace deflect
