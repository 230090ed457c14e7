// Frame files: YAML in and out. One of each:
//
//   name: portal
//   geometry: finite
//   load_steps: 10
//   materials: {steel: {E: 210 GPa, nu: 0.3, density: 7850 kg/m^3, expansion: 12e-6 1/K}}
//   sections: {tube: {shape: tube, outer_diameter: 60 mm, inner_diameter: 52 mm}}
//   nodes: {A: [0 m, 0 m, 0 m], B: [0 m, 0 m, 3 m], C: [4 m, 0 m, 3 m]}
//   members:
//     post: {from: A, to: B, section: tube, material: steel}
//     beam: {from: B, to: C, section: tube, material: steel, beam: timoshenko, y_axis: [0, 1, 0],
//            release_to: [ry, rz], bending_factor: 0.9, elements: 8}
//   supports: {A: clamped, C: [ux, uy, uz, rx]}
//   springs: {bed: {node: C, to: B, uz: 5 N/mm, ry: 2 Nm/rad}}
//   rigid_links: {plate: {master: B, nodes: [C], freedoms: [ux, uy, rz]}}
//   constraints: {same: {terms: [{node: B, freedom: ux}, {node: C, freedom: ry, factor: -1, arm: 2 m}]}}
//   loads:
//     case 1:
//       nodes: {B: {fx: 1 kN, my: 20 Nm}}
//       members: {beam: {qz: -2 N/mm, axes: member}}
//       temperature: {beam: 30 K}
//       gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
//       displacements: {C: {uz: -1 mm}}
//
// A material has nu or G; a section any shape of a device file; a support `clamped`, `pinned` (ux uy uz) or a list; a
// spring without `to` stands on the ground; a link without `freedoms` has all six. What the fields mean:
// frame_description.h.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "msa/fields/edit.h"
#include "msa/frame/file/frame_description.h"

namespace deflect::frame {

/// Reads a frame. Strict: an unknown or doubled key, a wrong or missing unit, a missing field, a name that does not
/// resolve, a member without length, a load or a displacement where it cannot act is an InputError "file:line: path:
/// what, and the nearest valid name".
FrameDescription read_frame(const std::filesystem::path&);

/// The same from text; `origin` stands for the file's name in messages.
FrameDescription parse_frame(std::string_view yaml, const std::string& origin);

/// The description as a frame file; reading it again gives an equal description, to the last bit of every number.
std::string write_frame(const FrameDescription&);

/// A new description with the edits in it one after the other, checked like a file. InputError naming the edit and what
/// does not fit, with the nearest valid name.
FrameDescription edited(const FrameDescription&, const std::vector<Edit>&);

}  // namespace deflect::frame
