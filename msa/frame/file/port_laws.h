// Laws that a linear structure sees through a few numbers: the structure is condensed to its ports, a small system in
// equilibrium with the laws there, solved as any structure is (solver.h).
//
// Port p has laws in series with the structure, which deform by e under the force F that passes, or laws between two
// points, which move by δ under the force f that the laws carry (−f acts on the structure). With s = −f of the second
// kind and x of all ports (e of the first, s of the second) the structure answers
//   F = F0 + R x,   δ = δ0 + R x
// with R the response to unit inputs: by Betti R is symmetric among ports of one kind and antisymmetric between kinds.
#pragma once

#include <optional>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/frame/file/frame_description.h"
#include "msa/frame/file/parted_laws.h"

namespace deflect::frame {

/// x by port (rows) for each column of `unloaded` (F0 or δ0 by port), in which columns follow one another: frictions
/// keep their slips where `in_sequence`, else each column begins relaxed. Materials are those of the description.
/// Nullopt where there is no equilibrium, or the structure does not resist what the laws need.
std::optional<MatrixX> inputs_of_ports(const FrameDescription&, const std::vector<TakenLaws>&, const MatrixX& response,
                                       const MatrixX& unloaded, bool in_sequence);

}  // namespace deflect::frame
