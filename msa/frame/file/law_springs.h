// Laws of a frame's description as springs of its structure.
#pragma once

#include <array>

#include "msa/frame/file/frame_description.h"
#include "msa/frame/file/name_index.h"
#include "msa/frame/structure/model.h"

namespace deflect::frame {

/// Resolves materials and tables, and numbers what laws with a history keep in the order of the calls.
class LawSprings {
 public:
  explicit LawSprings(const FrameDescription& f) : f_(f), materials_(f.materials) {}  ///< must outlive it

  /// A connection that is rigid in these freedoms, where they have no laws.
  std::array<ConnectionFreedom, 6> freedoms(const Freedoms& rigid, const FreedomLaws&);

 private:
  SpringLaw spring(Law, bool rotation);

  const FrameDescription& f_;
  NameIndex materials_;
  int slips_ = 0;
};

}  // namespace deflect::frame
