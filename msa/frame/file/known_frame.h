// Readings of a frame near one that is known, in linear geometry: the same parts with other numbers, and with other
// laws. Known are the factor of its stiffness and its states under the loads, so that a near frame takes about as long
// as a few solutions with that factor.
//
// With K of the known frame and K' = K + ΔK of the near one, the change δu of a state follows from
//   K' δu = f' − f − ΔK u
// by conjugate gradients with K as preconditioner, which end after as many steps as ΔK has ranks, and sooner where ΔK
// is small. ΔK acts in the members and springs that differ alone. Laws that are not linear, and laws that the known
// frame does not have, are taken out (parted_laws.h); what they do is that of forces and deformations at their places
// (port_laws.h). The result is that of analyse(), to rounding.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "msa/frame/file/frame_description.h"
#include "msa/frame/file/parted_laws.h"

namespace deflect::frame {

/// What passes through freedoms of a frame, and what a deformation e there does to it: to what passes elsewhere and to
/// what sensors read. By Betti `response` is symmetric. Its diagonal is −(the stiffness with which the rest of the
/// frame holds against e): 0 where statics alone determines what passes, because then no deformation there strains
/// anything.
struct Passages {
  MatrixX carried;   ///< places × loads: N or Nm
  MatrixX moves;     ///< sensors × places: true reading by unit deformation
  MatrixX response;  ///< places × places: N/m and alike
  /// By place: whether it can deform. A support cannot beside rigid parts that hold the same: then nobody can say what
  /// passes, and what stands there means nothing.
  std::vector<bool> gives;
};

class KnownFrame {
 public:
  /// The frame in linear geometry, without its laws that are not linear, under these loads. Throws as analyse() does,
  /// and NumericalError where one of its checks fails. A frame with parts so stiff that they need coordinates of their
  /// own (relative.h) is not solved: nothing is near it.
  KnownFrame(const FrameDescription&, Named<LoadCase> loads);
  ~KnownFrame();
  KnownFrame(const KnownFrame&) = delete;
  KnownFrame& operator=(const KnownFrame&) = delete;

  /// The true readings of sensors (rows) by column of `factors` on the loads as the near frame has them; those under a
  /// name of the constructor's take about the time of the change. Columns follow one another where `in_sequence`.
  /// Nullopt where the frame is not near enough: other parts, misfits, a state that is not found to 1e-12 of its
  /// change, or a law at a place that cannot deform (Passages::gives).
  std::optional<MatrixX> readings(const FrameDescription&, const Named<LoadCase>& loads,
                                  const std::vector<const FrameSensor*>&, const MatrixX& factors,
                                  bool in_sequence) const;

  /// Of freedoms where something passes: rigid or elastic ones. Nullopt as readings().
  std::optional<Passages> passages(const std::vector<const FrameSensor*>&, const std::vector<TakenLaws>&) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace deflect::frame
