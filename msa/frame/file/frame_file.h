// Frame files: YAML in and out. Every key appears once in this example:
//
//   name: portal
//   geometry: finite
//   load_steps: 10
//   materials: {steel: {E: 210 GPa, nu: 0.3, density: 7850 kg/m^3, expansion: 12e-6 1/K}}
//   sections: {tube: {shape: tube, outer_diameter: 60 mm, inner_diameter: 52 mm}}
//   nodes: {A: [0 m, 0 m, 0 m], B: [0 m, 0 m, 3 m], C: [4 m, 0 m, 3 m]}
//   members:
//     post: {from: A, to: B, section: tube, material: steel, factor: 0.95, misfit: 0.2 mm, heated: 5 K,
//            start: {ry: {law: linear, stiffness: 200 kNm/rad}, beside: {ry: {law: friction, moment: 5 Nm,
//                                                                              stiffness: 100 kNm/rad}}}}
//     beam: {from: B, to: C, section: tube, material: steel, beam: timoshenko, y_axis: [0, 1, 0],
//            release_to: [ry, rz], bending_factor: 0.9, elements: 8, end: {tx: {law: clearance, gap: 0.1 mm}}}
//   supports:
//     A: {holds: clamped, settled: {uz: -0.5 mm}}
//     C: {holds: [ux, uy, rx], uz: [{law: clearance, gap: 0.2 mm}, {law: linear, stiffness: 5 kN/mm}],
//         beside: {uz: {law: friction, force: 100 N, stiffness: 10 kN/mm}}}
//   springs:
//     bed: {node: C, to: B, uz: 5 N/mm, ry: {law: hardening, stiffness: 2 Nm/rad, reference: 0.1 rad},
//           beside: {uz: {law: power, deflection: 0.1 mm, force: 1 N, exponent: 0.7}}}
//     block: {node: B, stiffness: {units: N-mm, rows: [[900, 0, 0, 0, 0, 0], [0, 900, 0, 0, 0, 0], [0, 0, 900, 0, 0,
//     0],
//             [0, 0, 0, 1e6, 0, 0], [0, 0, 0, 0, 1e6, 2e5], [0, 0, 0, 0, 2e5, 1e6]]}}
//   rigid_links: {plate: {master: B, nodes: [C], freedoms: [ux, uy, rz]}}
//   constraints: {same: {terms: [{node: B, freedom: ux}, {node: C, freedom: ry, factor: -1, arm: 2 m}]}}
//   loads:
//     case 1:
//       factor: 1.02
//       turned: [0 deg, 1 deg, 0 deg]
//       nodes: {B: {fx: 1 kN, my: 20 Nm}}
//       members: {beam: {qz: -2 N/mm, axes: member}}
//       temperature: {beam: 30 K}
//       gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
//       displacements: {C: {ux: -1 mm}}
//   sensors:
//     lvdt: {node: B, direction: ux, sigma: 0.01 mm, zero: free, gain: 1 ± 0.5 %}
//     cell: {member: beam, force: axial, at: 0.5, sigma: 2 N}
//     gauge: {member: post, strain: {at: 0.1, y: 30 mm, z: 0 mm}, sigma: 2 um/m}
//     pad: {support: C, reaction: fz, gain: 1 ± 3 %, offset: 5 N, stick: 1 N, resolution: 1 N, crosstalk: {cell: 2 %}}
//   rig: {load_cell: {gain: 1}, trusted: [load]}
//   tolerances: {modulus: 1 %, load: 0.5 %, node.position: 1 mm, member.bending_factor: 5 %}
//
// A material has nu or G; a section any shape of a device file; a support `clamped`, `pinned` (ux uy uz), a list, or a
// map with what it `holds` and laws; a spring without `to` is connected to the ground; a link without `freedoms` has
// all six. Laws are those of device files, one or a list in series; at springs also a stiffness alone. `beside` has
// laws side by side with what is elastic or free. The fields are explained in frame_description.h.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "msa/fields/edit.h"
#include "msa/fields/number_walk.h"
#include "msa/fields/tree_edit.h"
#include "msa/frame/file/frame_description.h"

namespace deflect::frame {

/// Reads a frame strictly. Throws InputError "file:line: path: what is wrong, and the nearest valid name" for an
/// unknown or repeated key, a wrong or missing unit, a missing field, a name that does not resolve, a member without
/// length, and a load or displacement where it cannot act.
FrameDescription read_frame(const std::filesystem::path&);

/// The same from text; `origin` takes the place of the file's name in messages.
FrameDescription parse_frame(std::string_view yaml, const std::string& origin);

/// The description as a frame file; reading it again gives an equal description, to the last bit of every number.
std::string write_frame(const FrameDescription&);

/// Every number of the description in a fixed order, to be read or replaced: as for_each_number and described_numbers
/// of a mechanism (numbers.h).
void for_each_number(FrameDescription&, const std::function<void(std::size_t, double&)>& f);
std::vector<DescribedNumber> described_numbers(const FrameDescription&);

/// A frame, and which of its numbers depend on parameters that were filled into its tree.
struct DependentFrame {
  FrameDescription frame;
  Dependences depends = {};
};
/// As edited(), for edits into which parameters were filled.
DependentFrame edited_in_turn(DependentFrame, const std::vector<TreeEdit>&);

/// The whole description as a tree, implied values included.
YamlNode tree_of(const FrameDescription&);

/// A copy with the edits made in order, checked like a file. Every place has its laws by freedom whether the file names
/// it or not: `supports.B.uz` (where B is `clamped`, too), `supports.B.beside.ux`, `members.beam.start.ry`, and
/// `springs.bed.uz.stiffness` where the file has a stiffness alone. Throws InputError with the edit, what does not fit,
/// and the nearest valid name.
FrameDescription edited(const FrameDescription&, const std::vector<Edit>&);

}  // namespace deflect::frame
