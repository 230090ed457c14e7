// What the sensors of a frame read under the loads of measurements, by matrix structural analysis.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "msa/frame/file/frame_description.h"
#include "msa/frame/file/known_frame.h"
#include "validation/measurement/measurements.h"

namespace deflect::subject {

/// By reading: six zeros, because a frame has no tool point, then what each sensor of the measurements records. In
/// linear geometry with linear laws each load is solved once and readings are sums; else each load that readings have
/// has its own equilibrium, or where friction keeps its state each reading, in the order of `sequence`. True loads are
/// load_gain times the recorded ones. Throws NumericalError "file:line: …" where a reading has no equilibrium or a
/// check of the analysis fails, InputError where the frame lacks a sensor, a node or a load case of the measurements.
/// `near`: of a frame that may differ little; the result is the same, and sooner there in linear geometry.
std::vector<VectorX> predicted_readings(const frame::FrameDescription&, const measurement::Measurements&, Geometry,
                                        const class FrameNearby* near = nullptr);

/// One case for each channel of load, in the order of load_channels(), and one for what is always there: misfits, heat,
/// settlements.
Named<frame::LoadCase> unit_loads(const frame::FrameDescription&, const measurement::Measurements&);
/// By reading (columns) the true factors on unit_loads(): without a load there is what is always there.
MatrixX true_factors(const frame::FrameDescription&, const measurement::Measurements&);

/// What is known of a frame under the loads of measurements (known_frame.h), computed when it is first asked for.
class FrameNearby {
 public:
  /// `further`: another frame, asked where nothing is known of this one or a frame is not near enough to it.
  FrameNearby(const frame::FrameDescription&, const measurement::Measurements&,
              std::shared_ptr<const FrameNearby> further = nullptr);
  const FrameNearby* further() const { return further_.get(); }
  /// Null where nothing can be known: the frame does not stand without its laws that are not linear.
  const frame::KnownFrame* known() const;

 private:
  frame::FrameDescription frame_;
  Named<frame::LoadCase> loads_;
  std::shared_ptr<const FrameNearby> further_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const frame::KnownFrame> known_;
};

bool has_linear_laws(const frame::FrameDescription&);

/// The largest distance of two corners of the box around its nodes.
double size_of(const frame::FrameDescription&);

/// Whether a reading depends on the loads before it.
bool has_history(const frame::FrameDescription&);

}  // namespace deflect::subject
