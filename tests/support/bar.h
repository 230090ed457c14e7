// A bar between two posts on an elastic pad at its middle, pushed there by 400 N.
#pragma once

#include <string>

#include "msa/frame/file/frame_file.h"

namespace deflect::test {

/// σ is a hundredth of what the bar reads, or so. `tolerances`: the entries of its block.
inline frame::FrameDescription bar_on_a_pad(const std::string& tolerances) {
  return frame::parse_frame(R"(
name: bar
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 20 mm, height_z: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [0.5 m, 0 m, 0 m], C: [1 m, 0 m, 0 m]}
members:
  left: {from: A, to: B, section: bar, material: steel, y_axis: [0, 1, 0]}
  right: {from: B, to: C, section: bar, material: steel, y_axis: [0, 1, 0]}
supports: {A: [ux, uz], C: [uz]}
springs: {pad: {node: B, uz: 200 N/mm}}
loads: {push: {nodes: {B: {fz: -400 N}}}}
sensors: {z: {node: B, direction: uz, sigma: 6 um}, turn: {node: A, direction: ry, sigma: 0.02 mrad}}
tolerances: {)" + tolerances + "}\n",
                            "bar.yaml");
}

}  // namespace deflect::test
