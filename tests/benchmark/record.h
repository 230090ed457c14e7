// A set after it was diagnosed: the truth, and what every method made of it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/benchmark/measured_set.h"

namespace deflect::benchmark {

/// The product first. Those from `answering` on only predict.
inline constexpr const char* method_names[] = {"deflect", "fixed nuisances",  "all parameters",
                                               "BIC",     "Gaussian process", "nothing added"};
inline constexpr std::size_t answering = 4;

/// An effect that was hidden, by its names.
struct HiddenEffect {
  std::string effect, site;
  std::vector<std::pair<std::string, double>> values;
};

struct Record {
  Case order;
  Truth truth;
  std::vector<HiddenEffect> hidden;
  double lambda = 0, separation = 0, lambda_left = 0;  ///< as in MeasuredSet
  std::string skipped;
  std::vector<Answer> answers;  ///< of those methods that answer
  /// By method: root mean square of prediction − truth at new poses, of the machine as drawn, over σ of a reading.
  /// NaN where a method has no prediction; empty where what is hidden is no effect.
  std::vector<double> new_poses;
  int intervals = 0, covering = 0;  ///< 95 % intervals of effects that were found, and those that hold the truth
  double seconds = 0;               ///< of the diagnosis
};

/// A record as bytes and back, but for its order.
std::string packed(const Record&);
Record unpacked(const std::string& bytes, const Case& order);

/// Makes the set and has it diagnosed, on this thread alone.
Record run(const Case&, const Mechanism&, const std::vector<effects::Effect>&, Plans&);

}  // namespace deflect::benchmark
