// How a laboratory's file may differ from what was measured, and the file with that undone.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "validation/measurement/measurements.h"

namespace deflect::frame {
struct FrameDescription;
}

namespace deflect::recording {

/// Six numbers that are six others, each times a factor: out(k) = factor[k] · in(from[k]).
struct Rewritten {
  std::array<std::size_t, 6> from = {0, 1, 2, 3, 4, 5};
  std::array<double, 6> factor = {1, 1, 1, 1, 1, 1};

  bool operator==(const Rewritten&) const = default;
  bool nothing() const { return *this == Rewritten{}; }
  Vector6 of(const Vector6&) const;
};

/// A mistake of recording with what undoes it.
struct Correction {
  std::string id;        ///< "force_in_kgf"
  std::string sentence;  ///< what the data look like, with the remedy: "loads in kgf: fx_N … want N, …"
  Rewritten displacement, load;
  Vector3 acts_at = Vector3::Zero();                            ///< m, base axes: forces act at T + acts_at
  std::function<void(measurement::PoseGroup&)> pose;            ///< empty: poses are as recorded
  std::function<void(measurement::Measurements&)> readings;     ///< of sensors and of loads at nodes; or empty
  std::vector<std::pair<std::size_t, double>> scaled_channels;  ///< by channel: the factor that `readings` applies
  std::function<void(frame::FrameDescription&)> description;    ///< of what sensors really show; or empty
  bool sigma_too = true;                                        ///< a unit of displacements is the unit of their σ too
  int fitted = 0;                                               ///< numbers that were fitted to the data
  bool effect_alike = false;                                    ///< an effect does the same, or more
};

/// A number without a partner in its new place (a column that was not recorded) is not measured.
measurement::Measurements corrected(const measurement::Measurements&, const Correction&);

}  // namespace deflect::recording
