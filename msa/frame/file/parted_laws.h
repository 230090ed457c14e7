// A frame parted into what is linear and the laws that are not, or that another frame does not have: the rest of the
// frame sees such a law only as a deformation where it stands, or as a force there.
#pragma once

#include <optional>
#include <vector>

#include "msa/frame/file/frame_description.h"

namespace deflect::frame {

/// Laws that were taken out of a freedom. In series with the rest: all that passes there passes through them, which are
/// one chain, and what they leave is rigid or elastic. Else chains stand side by side with what is left, which is
/// elastic or free.
struct TakenLaws {
  enum class At { support, spring, start, end };
  At at = At::support;
  std::size_t part = 0, freedom = 0;  ///< by number in the description's list
  bool in_series = true;
  std::vector<std::vector<Law>> chains = {};  ///< the laws of a chain are in series with each other
};

struct PartedFrame {
  FrameDescription rest;
  std::vector<TakenLaws> taken;
};

/// Takes out the laws that are not linear, each with those behind it in series.
PartedFrame without_nonlinear_laws(const FrameDescription&);

/// Takes out what `rest` does not have, so that both have the same freedoms with as many linear laws. Nullopt where
/// `rest` has other parts, or laws that this frame lacks.
std::optional<PartedFrame> parted_as(const FrameDescription&, const FrameDescription& rest);

}  // namespace deflect::frame
