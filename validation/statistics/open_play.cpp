#include "validation/statistics/open_play.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "msa/base/index.h"
#include "msa/base/outcome.h"

namespace deflect::statistics {
namespace {

constexpr double little = 1e-3;  // of a load

/// These readings with a little more load along an axis (0 … 2) or about it (3 … 5).
measurement::Measurements with_more(const measurement::Measurements& data, std::size_t axis, double size,
                                    const std::vector<bool>& which) {
  measurement::Measurements out = data;
  for (std::size_t i = 0; i < out.readings.size(); ++i) {
    if (!which[i]) continue;
    measurement::Reading& r = out.readings[i];
    const double force = std::hypot(r.load.head<3>().norm(), r.load.tail<3>().norm() / size);
    const double more = little * force * (axis < 3 ? 1 : size);
    r.load(as_index(axis)) += more;
    r.at_tool(as_index(axis)) += more;
  }
  return out;
}

}  // namespace

std::vector<MatrixX> open_play(const subject::Standing& standing, const measurement::Measurements& data) {
  prediction::PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const prediction::Predicted middle = standing.predicted(data, linear, parallel::alone);
  if (middle.floating.at_readings.empty()) return {};
  for (std::size_t i = 0; i < data.readings.size(); ++i) linear.only.push_back(middle.floating.at(i));
  const auto found = outcome_of([&] {
    std::array<prediction::Predicted, 6> out;
    for (std::size_t axis = 0; axis < out.size(); ++axis)
      out[axis] = standing.predicted(with_more(data, axis, standing.size(), linear.only), linear, parallel::alone);
    return out;
  });
  if (!found) return {};
  const std::array<prediction::Predicted, 6>& ends = *found;
  std::vector<MatrixX> out;
  for (std::size_t i = 0; i < data.readings.size(); ++i) {
    out.emplace_back(middle.readings[i].size(), 0);
    if (!linear.only[i]) continue;
    // Play that several loads close counts once: each of them with its share, that of the play that fewest close.
    std::map<std::string, double> times;
    const auto closes = [&](std::size_t axis, const std::string& play) {
      return !ends[axis].floating.at(i) || !ends[axis].floating.at_readings[i].contains(play);
    };
    for (const std::string& play : middle.floating.at_readings[i])
      for (std::size_t axis = 0; axis < ends.size(); ++axis) times[play] += closes(axis, play) ? 1 : 0;
    for (std::size_t axis = 0; axis < ends.size(); ++axis) {
      double share = 0;
      for (const auto& [play, count] : times)
        if (closes(axis, play)) share = std::max(share, 1 / count);
      if (share == 0) continue;
      out.back().conservativeResize(Eigen::NoChange, out.back().cols() + 1);
      out.back().rightCols<1>() = std::sqrt(2 * share) * (ends[axis].readings[i] - middle.readings[i]);
    }
  }
  return out;
}

bool is_anywhere_in_play(const Uncertainty& with, const Uncertainty& without, const VectorX& residual) {
  const double left = with.whitened(residual).squaredNorm();
  const double gain = without.whitened(residual).squaredNorm() - left;
  const double scale = std::max(1.0, left / static_cast<double>(std::max<std::size_t>(1, with.count())));
  return gain / scale > with.whitening()->log_determinant() - without.whitening()->log_determinant();
}

}  // namespace deflect::statistics
