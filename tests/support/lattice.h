// Cubic lattice frames: n³ nodes 100 mm apart, nearest neighbours joined by round rods (E 210 GPa, ν 0.3,
// Euler–Bernoulli), bottom face clamped, 1 N in x and −1 N in z on each top node.
#pragma once

#include <string>

#include "msa/frame/file/frame_description.h"

namespace deflect::test {

/// Node "x y z" by its place in the lattice, member "x y z d" from there along the axis d.
inline std::string lattice_node(int x, int y, int z) {
  return std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z);
}

inline frame::FrameDescription lattice(int n, double diameter = 0.006) {
  frame::FrameDescription f;
  f.name = "lattice";
  frame::FrameMaterial steel;
  steel.elastic.E = 210e9;
  steel.elastic.nu = 0.3;
  f.materials.push_back({"steel", steel});
  f.sections.push_back({"rod", {RoundSection{diameter}}});
  f.loads.push_back({"top", {}});
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const std::string name = lattice_node(x, y, z);
        f.nodes.push_back({name, 0.1 * Vector3(x, y, z)});
        const int next[3][3] = {{x + 1, y, z}, {x, y + 1, z}, {x, y, z + 1}};
        for (int d = 0; d < 3; ++d) {
          const auto& [a, b, c] = next[d];
          if (a >= n || b >= n || c >= n) continue;
          frame::FrameMember member;
          member.from = name, member.to = lattice_node(a, b, c);
          member.section = "rod", member.material = "steel";
          f.members.push_back({name + " " + std::to_string(d), member});
        }
        if (z == 0) f.supports.push_back({name, frame::Freedoms{true, true, true, true, true, true}});
        if (z == n - 1) f.loads[0].second.nodes.push_back({name, (Vector6() << 1, 0, -1, 0, 0, 0).finished()});
      }
  return f;
}

}  // namespace deflect::test
