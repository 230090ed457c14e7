#include "validation/recording/recording_mistakes.h"
#include "msa/base/index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace deflect::recording {
namespace {

constexpr const char* base_axis_names = "xyz";
constexpr double kgf = 9.80665, lbf = 4.4482216152605, inch = 25.4;

/// Axes permuted and turned round: recorded(k) = sign[k] · true(order[k]).
struct SignedAxes {
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::array<double, 3> sign = {1, 1, 1};

  bool in_place() const { return order == std::array<std::size_t, 3>{0, 1, 2}; }
  bool all_turned() const { return in_place() && sign == std::array<double, 3>{-1, -1, -1}; }
  bool nothing() const { return in_place() && sign == std::array<double, 3>{1, 1, 1}; }
  double handedness() const {
    const bool even = (order[0] + 1) % 3 == order[1];
    return (even ? 1 : -1) * sign[0] * sign[1] * sign[2];
  }
  /// "x = y, y = −x, z = z".
  std::string words() const {
    std::string out;
    for (std::size_t k = 0; k < 3; ++k)
      out += fmt::format("{}{} = {}{}", k ? ", " : "", base_axis_names[k], sign[k] < 0 ? "−" : "",
                         base_axis_names[order[k]]);
    return out;
  }
  /// "x_y_z" with minus signs as "m", as part of an id.
  std::string id() const {
    std::string out;
    for (std::size_t k = 0; k < 3; ++k) out += fmt::format("_{}{}", sign[k] < 0 ? "m" : "", base_axis_names[order[k]]);
    return out;
  }
};

std::vector<SignedAxes> all_signed_axes() {
  std::vector<SignedAxes> out;
  SignedAxes a;
  do {
    for (unsigned bits = 0; bits < 8; ++bits) {
      for (unsigned k = 0; k < 3; ++k) a.sign[k] = bits >> k & 1 ? -1 : 1;
      if (!a.nothing()) out.push_back(a);
    }
  } while (std::next_permutation(a.order.begin(), a.order.end()));
  return out;
}

/// What undoes it for the three numbers from `first`.
void turn_back(Rewritten& r, const SignedAxes& a, std::size_t first, double handedness = 1) {
  for (std::size_t k = 0; k < 3; ++k) {
    r.from[first + a.order[k]] = first + k;
    r.factor[first + a.order[k]] = handedness * a.sign[k];
  }
}

/// "displacements of which x and z have the opposite sign", "… that stand in other axes (recorded x = y, …)".
std::string axes_words(const SignedAxes& a, const std::string& what) {
  if (a.all_turned()) return fmt::format("{} that have the opposite sign", what);
  if (!a.in_place()) return fmt::format("{} that stand in other axes (recorded {})", what, a.words());
  std::string turned;
  for (std::size_t k = 0; k < 3; ++k)
    if (a.sign[k] < 0) turned += fmt::format("{}{}", turned.empty() ? "" : " and ", base_axis_names[k]);
  return fmt::format("{} of which {} {} the opposite sign", what, turned, turned.size() == 1 ? "has" : "have");
}

bool measured_any(const measurement::Measurements& data, std::size_t first) {
  for (const measurement::Reading& r : data.readings)
    for (std::size_t k = first; k < first + 3; ++k)
      if (r.displacement[k]) return true;
  return false;
}

bool loaded(const measurement::Measurements& data, Eigen::Index first) {
  return std::any_of(data.readings.begin(), data.readings.end(),
                     [&](const measurement::Reading& r) { return !r.load.segment<3>(first).isZero(0); });
}

void add_mistaken_axes(const measurement::Measurements& data, std::vector<Correction>& out) {
  const bool u = measured_any(data, 0), th = measured_any(data, 3), f = loaded(data, 0), m = loaded(data, 3);
  for (const SignedAxes& a : all_signed_axes()) {
    const auto add = [&](const std::string& id, const std::string& sentence, auto change) {
      Correction c;
      c.id = id + a.id();
      c.sentence = sentence;
      change(c);
      out.push_back(std::move(c));
    };
    const double hand = a.handedness();
    if (u && th) {
      add("displacement_axes", axes_words(a, "displacements and rotations") + ": turn the columns u… and th… back",
          [&](Correction& c) { turn_back(c.displacement, a, 0), turn_back(c.displacement, a, 3); });
      if (hand < 0)
        add("displacement_hand",
            axes_words(a, "displacements in left-handed axes") + ": turn the columns u… back, and th… as rotations",
            [&](Correction& c) { turn_back(c.displacement, a, 0), turn_back(c.displacement, a, 3, hand); });
    }
    if (u)
      add("translation_axes", axes_words(a, th ? "translations" : "displacements") + ": turn the columns u… back",
          [&](Correction& c) { turn_back(c.displacement, a, 0); });
    if (th)
      add("rotation_axes", axes_words(a, "rotations") + ": turn the columns th… back",
          [&](Correction& c) { turn_back(c.displacement, a, 3); });
    if (f && m) {
      if (!a.all_turned())  // the same as displacements that have the opposite sign
        add("load_axes", axes_words(a, "loads") + ": turn the columns f… and m… back",
            [&](Correction& c) { turn_back(c.load, a, 0), turn_back(c.load, a, 3); });
      if (hand < 0)
        add("load_hand", axes_words(a, "loads in left-handed axes") + ": turn the columns f… back, and m… as moments",
            [&](Correction& c) { turn_back(c.load, a, 0), turn_back(c.load, a, 3, hand); });
    }
    if (f && (m || !a.all_turned()))
      add("force_axes", axes_words(a, m ? "forces" : "loads") + ": turn the columns f… back",
          [&](Correction& c) { turn_back(c.load, a, 0); });
    if (m)
      add("moment_axes", axes_words(a, "moments") + ": turn the columns m… back",
          [&](Correction& c) { turn_back(c.load, a, 3); });
  }
}

/// What undoes numbers in another unit: translations or forces, rotations or moments times a factor.
Rewritten scaled_halves(double first, double second) {
  return {{0, 1, 2, 3, 4, 5}, {first, first, first, second, second, second}};
}

void add_mistaken_units(const measurement::Measurements& data, std::vector<Correction>& out) {
  const bool th = measured_any(data, 3), u = measured_any(data, 0), f = loaded(data, 0), m = loaded(data, 3);
  const auto displacement = [&](const char* id, double t, double r, const char* sentence) {
    if ((t != 1 && !u) || (r != 1 && !th)) return;
    Correction c;
    c.id = id;
    c.sentence = sentence;
    c.displacement = scaled_halves(t, r);
    out.push_back(c);
    // σ may be in the right unit where the readings are not.
    c.sigma_too = false;
    out.push_back(std::move(c));
  };
  displacement("displacement_in_m", 1e3, 1, "displacements in m: ux_mm … want mm");
  displacement("displacement_in_um", 1e-3, 1, "displacements in µm: ux_mm … want mm");
  displacement("displacement_in_cm", 10, 1, "displacements in cm: ux_mm … want mm");
  displacement("displacement_in_inch", inch, 1, "displacements in inches: ux_mm … want mm");
  displacement("displacement_in_mil", inch / 1e3, 1, "displacements in thousandths of an inch: ux_mm … want mm");
  displacement("rotation_in_deg", 1, pi / 180, "rotations in degrees: thx_rad … want rad");
  displacement("rotation_in_mrad", 1, 1e-3, "rotations in mrad: thx_rad … want rad");
  displacement("rotation_in_urad", 1, 1e-6, "rotations in µrad: thx_rad … want rad");
  displacement("rotation_in_arcsec", 1, pi / 180 / 3600, "rotations in seconds of arc: thx_rad … want rad");

  const auto load = [&](const char* id, double force, double moment, const char* sentence) {
    if ((force != 1 && !f) || (moment != 1 && force == 1 && !m) || (moment != force && !m)) return;
    Correction c;
    c.id = id;
    c.sentence = sentence;
    c.load = scaled_halves(force, moment);
    out.push_back(std::move(c));
  };
  load("load_in_kgf", kgf, kgf, "loads in kgf: fx_N … want N, 1 kgf = 9.80665 N");
  load("force_in_kgf", kgf, 1, "forces in kgf beside moments in Nmm: fx_N … want N, 1 kgf = 9.80665 N");
  load("load_times_g", 1 / kgf, 1 / kgf, "loads multiplied by g where they were in N already");
  load("load_in_lbf", lbf, lbf, "loads in lbf: fx_N … want N, 1 lbf = 4.448 N");
  load("force_in_lbf", lbf, 1, "forces in lbf beside moments in Nmm: fx_N … want N, 1 lbf = 4.448 N");
  load("load_in_kN", 1e3, 1e3, "loads in kN: fx_N … want N");
  load("force_in_kN", 1e3, 1, "forces in kN beside moments in Nmm: fx_N … want N");
  load("force_in_mN", 1e-3, 1, "forces in mN beside moments in Nmm: fx_N … want N");
  load("moment_in_Nm", 1, 1e3, "moments in Nm: mx_Nmm … want Nmm");
  load("moment_in_Ncm", 1, 10, "moments in Ncm: mx_Nmm … want Nmm");
  load("moment_in_kgfmm", 1, kgf, "moments in kgf·mm: mx_Nmm … want Nmm");
  load("moment_in_kgfm", 1, 1e3 * kgf, "moments in kgf·m: mx_Nmm … want Nmm");
  load("moment_in_lbfin", 1, lbf * inch, "moments in lbf·in: mx_Nmm … want Nmm");
}

Correction posed(const std::string& id, const std::string& sentence, const std::function<void(Vector6&)>& undo) {
  Correction c;
  c.id = id;
  c.sentence = sentence;
  c.pose = [undo](measurement::PoseGroup& group) { undo(group.pose_mm_deg); };
  return c;
}

/// Those that change any pose.
std::vector<Correction> that_matter(std::vector<Correction> all, const measurement::Measurements& data) {
  std::erase_if(all, [&](const Correction& c) {
    return std::all_of(data.poses.begin(), data.poses.end(), [&](measurement::PoseGroup group) {
      const Vector6 before = group.pose_mm_deg;
      const VectorX joints = group.joints;
      c.pose(group);
      return before.isApprox(group.pose_mm_deg, 1e-12) && joints == group.joints;
    });
  });
  return all;
}

std::vector<Correction> mistaken_joints(const measurement::Measurements& data) {
  Correction degrees, turned;
  degrees.id = "joints_in_deg";
  degrees.sentence = "joint coordinates in degrees: q1_rad … want rad";
  degrees.pose = [rotates = data.joint_rotates](measurement::PoseGroup& group) {
    for (std::size_t i = 0; i < rotates.size(); ++i)
      if (rotates[i]) group.joints(as_index(i)) *= pi / 180;
  };
  turned.id = "joints_sign";
  turned.sentence = "joint coordinates of the opposite sign: turn the columns q… back";
  turned.pose = [](measurement::PoseGroup& group) { group.joints *= -1; };
  return {degrees, turned};
}

}  // namespace

std::vector<Correction> mistaken_readings(const measurement::Measurements& data) {
  std::vector<Correction> out;
  add_mistaken_units(data, out);
  add_mistaken_axes(data, out);
  return out;
}

std::vector<Correction> mistaken_poses(const measurement::Measurements& data) {
  if (data.by_joints()) return that_matter(mistaken_joints(data), data);
  std::vector<Correction> out;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index j = (i + 1) % 3;
    const char a = base_axis_names[std::min(i, j)], b = base_axis_names[std::max(i, j)];
    out.push_back(
        posed(fmt::format("pose_{}_{}_swapped", a, b),
              fmt::format("poses of which {0} and {1} are exchanged: exchange the columns {0}_mm and {1}_mm", a, b),
              [i, j](Vector6& pose) { std::swap(pose(i), pose(j)); }));
  }
  for (Eigen::Index i = 0; i < 3; ++i)
    out.push_back(
        posed(fmt::format("pose_{}_mirrored", base_axis_names[i]),
              fmt::format("poses of which {0} has the opposite sign: turn the column {0}_mm back", base_axis_names[i]),
              [i](Vector6& pose) { pose(i) *= -1; }));
  constexpr const char* angles[] = {"roll", "pitch", "yaw"};
  out.push_back(posed("angles_in_rad", "angles of the poses in rad: roll_deg, pitch_deg, yaw_deg want degrees",
                      [](Vector6& pose) { pose.tail<3>() *= 180 / pi; }));
  for (Eigen::Index i = 0; i < 3; ++i) {
    out.push_back(posed(fmt::format("{}_in_rad", angles[i]),
                        fmt::format("a {0} in rad: {0}_deg wants degrees", angles[i]),
                        [i](Vector6& pose) { pose(3 + i) *= 180 / pi; }));
    out.push_back(posed(fmt::format("{}_mirrored", angles[i]),
                        fmt::format("a {0} of the opposite sign: turn the column {0}_deg back", angles[i]),
                        [i](Vector6& pose) { pose(3 + i) *= -1; }));
  }
  out.push_back(posed("roll_yaw_swapped",
                      "poses of which roll and yaw are exchanged: exchange the columns roll_deg and yaw_deg",
                      [](Vector6& pose) { std::swap(pose(3), pose(5)); }));
  return that_matter(std::move(out), data);
}

std::vector<Correction> mistaken_pose_lengths(const measurement::Measurements& data) {
  if (data.by_joints()) return {};
  std::vector<Correction> out;
  for (const auto& [unit, mm] : {std::pair{"m", 1e3}, {"µm", 1e-3}, {"cm", 10.0}, {"inches", inch}})
    out.push_back(posed(fmt::format("pose_in_{}", unit), fmt::format("poses in {}: x_mm, y_mm, z_mm want mm", unit),
                        [factor = mm](Vector6& pose) { pose.head<3>() *= factor; }));
  return that_matter(std::move(out), data);
}

Correction shifted_poses(const Vector3& by_mm) {
  std::string words;
  for (int k = 0; k < 3; ++k)
    if (by_mm(k) != 0)
      words += fmt::format("{}{} by {:.3g} mm", words.empty() ? "" : ", ", base_axis_names[k], by_mm(k));
  Correction c =
      posed("pose_shifted",
            fmt::format("poses that are recorded off in {}: enter where the tool point of the device file is, "
                        "in base axes",
                        words),
            [by_mm](Vector6& pose) { pose.head<3>() -= by_mm; });
  for (int k = 0; k < 3; ++k)
    if (by_mm(k) != 0) c.id += fmt::format("_{}", base_axis_names[k]), ++c.fitted;
  return c;
}

Correction forces_elsewhere(const Vector3& p) {
  Correction c;
  c.id = "force_elsewhere";
  c.sentence = fmt::format(
      "forces that act at another point, T + ({:.3g}, {:.3g}, {:.3g}) mm in base axes: enter the "
      "moment about T that comes of it",
      1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
  c.acts_at = p;
  c.fitted = 3;
  return c;
}

}  // namespace deflect::recording
