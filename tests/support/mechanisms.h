// Configurations built by hand, and the same mechanism in other axes or of another size.
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "msa/mechanism/sections/section.h"
#include "tests/support/devices.h"

namespace deflect::test {

inline PlacedJoint joint(const std::string& part, const Vector3& p_W, const std::string& letters,
                         const Matrix3& R_WJ = Matrix3::Identity()) {
  PlacedJoint j;
  j.part = part;
  j.p_W = p_W;
  j.R_WJ = R_WJ;
  j.freedoms = freedoms_of(letters);
  return j;
}

/// A joint that yields in the freedoms (0 tx … 5 rz) given, linearly.
inline PlacedJoint spring(const std::string& part, const Vector3& p_W,
                          const std::vector<std::pair<std::size_t, double>>& stiffness,
                          const Matrix3& R_WJ = Matrix3::Identity()) {
  PlacedJoint j = joint(part, p_W, "rrrrrr", R_WJ);
  for (const auto& [freedom, k] : stiffness) j.laws[freedom].emplace_back(std::in_place_type<LinearLaw>, LinearLaw{k});
  return j;
}

/// A round steel rod.
inline PlacedMember rod(const std::string& part, const Vector3& p_W_start, const Vector3& p_W_end, double diameter) {
  PlacedMember m;
  m.part = part;
  m.p_W_start = p_W_start;
  m.p_W_end = p_W_end;
  const Vector3 along = p_W_end - p_W_start;
  m.R_WM = axes_along_x(along, std::abs(along.normalized().z()) < 0.9 ? Vector3::UnitZ() : Vector3::UnitX());
  m.section = properties({RoundSection{diameter}}, 0.3);
  m.E = 210e9;
  m.G = m.E / 2.6;
  return m;
}

/// Axes with z along a direction.
inline Matrix3 z_along(const Vector3& z) {
  const Matrix3 R = axes_along_x(z, std::abs(z.normalized().x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY());
  Matrix3 turned;
  turned << R.col(1), R.col(2), R.col(0);
  return turned;
}

inline Configuration configuration(const Vector3& p_WT, std::vector<PlacedLeg> legs, double size) {
  Configuration c;
  c.pose.p_WT = p_WT;
  c.base = joint("base", Vector3::Zero(), "rrrrrr");
  c.tool = joint("tool", p_WT, "rrrrrr");
  c.legs = std::move(legs);
  c.size = size;
  return c;
}

/// A strut of axial stiffness k between two points, which turns freely at both.
inline PlacedLeg strut(const std::string& name, const Vector3& a, const Vector3& b, double k) {
  const Matrix3 R = z_along(b - a);
  return {name, {joint("foot", a, "rrrfff", R), spring("strut", b, {{2, k}}, R), joint("head", b, "rrrffr", R)}};
}

/// Feet and heads of six struts on two circles, irregular.
inline std::vector<std::pair<Vector3, Vector3>> hexapod(std::mt19937& random) {
  std::vector<std::pair<Vector3, Vector3>> struts;
  for (int i = 0; i < 6; ++i) {
    const double foot = pi / 3 * i + 0.4 * (i % 2), head = pi / 3 * i + 0.7 * ((i + 1) % 2) - 0.2;
    struts.emplace_back(Vector3(0.3 * std::cos(foot), 0.3 * std::sin(foot), 0) + random_vector(random, 0.02),
                        Vector3(0.15 * std::cos(head), 0.15 * std::sin(head), 0.4) + random_vector(random, 0.02));
  }
  return struts;
}

/// Legs and branches.
template <class Do>
void for_each_leg(std::vector<PlacedLeg>& legs, Do act) {
  for (PlacedLeg& leg : legs) {
    act(leg);
    for (PlacedPart& part : leg.parts)
      if (auto* parallel = std::get_if<PlacedParallel>(&part)) for_each_leg(parallel->branches, act);
  }
}

/// Moves points by p → scale · R p + shift, lengths of springs and sections along.
struct Moved {
  Matrix3 R = Matrix3::Identity();
  Vector3 shift = Vector3::Zero();
  double scale = 1;

  void operator()(PlacedJoint& j) const {
    j.p_W = scale * (R * j.p_W) + shift;
    j.R_WJ = R * j.R_WJ;
    if (j.stiffness) {
      Vector6 s = Vector6::Constant(std::sqrt(scale));
      s.head<3>() /= scale;
      j.stiffness = s.asDiagonal() * *j.stiffness * s.asDiagonal();
    }
    for (std::size_t i = 0; i < 6; ++i) {
      for (Law& law : j.laws[i]) {
        if (auto* linear = std::get_if<LinearLaw>(&law))
          linear->stiffness *= i < 3 ? 1 / scale : scale;
        else if (auto* hertz = std::get_if<HertzPointLaw>(&law)) {
          hertz->radius *= scale;
          hertz->solid.E /= scale * scale;
        }
      }
      if (i >= 3) j.preload[i] *= scale;
    }
  }
  void operator()(PlacedMember& m) const {
    m.p_W_start = scale * (R * m.p_W_start) + shift;
    m.p_W_end = scale * (R * m.p_W_end) + shift;
    m.R_WM = R * m.R_WM;
    const double s2 = scale * scale;
    m.section.A *= s2, m.section.As_y *= s2, m.section.As_z *= s2;
    m.section.Iy *= s2 * s2, m.section.Iz *= s2 * s2, m.section.J *= s2 * s2;
    m.E /= s2, m.G /= s2;
  }
  void operator()(PlacedParallel& p) const {
    p.p_W_start = scale * (R * p.p_W_start) + shift;
    p.p_W_end = scale * (R * p.p_W_end) + shift;
  }
};

/// The same mechanism in base axes turned by R, its origin moved, and with lengths in a unit `scale` times smaller.
inline Configuration moved(Configuration c, const Moved& m) {
  const auto joint_too = [&](PlacedJoint& j) { m(j); };
  joint_too(c.base);
  joint_too(c.tool);
  for_each_part(c.legs, m);
  for_each_leg(c.legs, [&](PlacedLeg& leg) {
    leg.misfit = rotate_twist(m.R) * leg.misfit;
    leg.misfit.head<3>() *= m.scale;
    for (PlacedPart& part : leg.parts)
      if (auto* parallel = std::get_if<PlacedParallel>(&part)) m(*parallel);
  });
  c.pose.p_WT = m.scale * (m.R * c.pose.p_WT) + m.shift;
  c.pose.R_WT = m.R * c.pose.R_WT;
  c.weight = m.R * c.weight;
  c.size *= m.scale;
  return c;
}

/// Four legs of rods between joints of every kind, some with branches side by side, one joint with six coupled springs.
inline Configuration random_mechanism(unsigned seed, bool contacts = false) {
  std::mt19937 random(seed);
  const char* letters[] = {"rrrffr", "rrrrrf", "rrfrrr", "rrrrrr", "frrrrf"};
  const auto any_joint = [&](const std::string& part, const Vector3& p) {
    PlacedJoint j = joint(part, p, letters[random() % 5], z_along(random_vector(random, 1)));
    j.laws[random() % 3].push_back(LinearLaw{uniform(random, 1e5, 1e7)});
    j.laws[3 + random() % 3].push_back(LinearLaw{uniform(random, 1e2, 1e4)});
    if (contacts) {
      const std::size_t i = random() % 3;
      j.laws[i].push_back(HertzPointLaw{"", 0.004, {210e9, 0.3, {}}});
      if (random() % 2) j.preload[i] = uniform(random, -30, 30);
    }
    return j;
  };
  const Vector3 p_WT(0.05, -0.02, 0.3);
  std::vector<PlacedLeg> legs;
  for (int i = 0; i < 4; ++i) {
    const Vector3 foot =
        Vector3(0.3 * std::cos(pi / 2 * i), 0.3 * std::sin(pi / 2 * i), 0) + random_vector(random, 0.05);
    const Vector3 head = p_WT + 0.3 * (foot - p_WT) + random_vector(random, 0.03), middle = (foot + head) / 2;
    PlacedLeg leg{"leg " + std::to_string(i + 1), {}};
    leg.parts.push_back(any_joint("foot", foot));
    leg.parts.push_back(rod("lower", foot, middle, 0.012));
    if (i % 2) {
      PlacedParallel loop{"loop", middle, head, {}};
      for (int b = 0; b < 2; ++b) {
        const Vector3 aside = random_vector(random, 0.05);
        loop.branches.push_back(
            {"loop " + std::to_string(b + 1),
             {joint("bearing", middle + aside, "rrrfff"), rod("bar", middle + aside, head + aside, 0.006),
              joint("clamp", head + aside, "rrrrrr")}});
      }
      leg.parts.push_back(loop);
    } else {
      leg.parts.push_back(rod("upper", middle, head, 0.01));
    }
    PlacedJoint last = any_joint("head", head);
    if (i == 2) {
      Matrix6 A;
      for (int k = 0; k < 36; ++k) A(k) = uniform(random, -1, 1);
      Vector6 scale;
      scale << 1e3, 1e3, 1e3, 50, 50, 50;
      last = joint("head", head, "rrrrrr", z_along(random_vector(random, 1)));
      last.stiffness = scale.asDiagonal() * (A * A.transpose() + Matrix6::Identity()) * scale.asDiagonal();
    }
    leg.parts.push_back(last);
    legs.push_back(leg);
  }
  Configuration c = configuration(p_WT, legs, 0.5);
  c.base = spring("base", Vector3::Zero(), {{0, 3e6}, {4, 2e5}});
  c.tool = spring("tool", p_WT, {{1, 5e6}, {2, 4e6}});
  return c;
}

}  // namespace deflect::test
