#include "validation/plan/new_sensors.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "msa/base/index.h"
#include "validation/measurement/joined.h"
#include "validation/parallel/cases.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;
using measurement::Quantity;
using measurement::Reading;
using subject::PossibleSensor;

constexpr std::size_t most_looked_at = 8, judged = 4, shown = 3;

/// What the readings have of the tool point, and σ of displacements and rotations; 0: not known.
struct InData {
  std::array<bool, 6> read = {};
  double length = 0, angle = 0;
};

InData in_data(const Measurements& m, const Noise& noise) {
  InData out{{}, noise.u.value_or(0), noise.th.value_or(0)};
  for (const measurement::SensorChannel& s : m.instruments.sensors) {
    if (s.quantity == Quantity::length) out.length = s.sigma.value_or(out.length);
    if (s.quantity == Quantity::angle) out.angle = s.sigma.value_or(out.angle);
  }
  for (const Reading& r : m.readings) {
    for (std::size_t i = 0; i < 6; ++i) out.read[i] = out.read[i] || r.displacement[i];
    out.length = r.sigma_u.value_or(out.length);
    out.angle = r.sigma_th.value_or(out.angle);
  }
  return out;
}

/// Those of known σ; of the tool point those that the data do not read.
std::vector<PossibleSensor> candidates(const subject::Subject& s, const Measurements& data, const Noise& noise) {
  const InData known = in_data(data, noise);
  std::vector<PossibleSensor> out = subject::possible_sensors(s);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string name = subject::name_at_tool_point(i);
    if (known.read[i]) std::erase_if(out, [&](const PossibleSensor& p) { return p.name == name; });
  }
  const double arm = 0.1 * s.stand(data)->size();
  for (PossibleSensor& p : out) {
    if (p.sigma > 0) continue;
    if (p.quantity == Quantity::length) p.sigma = known.length;
    if (p.quantity == Quantity::angle) p.sigma = known.angle > 0 ? known.angle : known.length / arm;
  }
  std::erase_if(out, [](const PossibleSensor& p) { return !(p.sigma > 0); });
  return out;
}

/// The readings of a subject with more sensors; those behind the first `taken` read them.
Measurements read_by(Measurements m, const std::vector<PossibleSensor>& more, std::size_t taken) {
  for (const PossibleSensor& p : more) m.instruments.sensors.push_back({p.name, p.quantity, p.sigma});
  for (std::size_t i = 0; i < m.readings.size(); ++i)
    for (std::size_t k = 0; k < more.size(); ++k)
      m.readings[i].sensors.push_back(i < taken ? std::nullopt : std::optional<double>(0));
  return m;
}

/// By sensor (rows): what each two rivals make it read differently in the readings added, over σ.
MatrixX differences(const subject::Subject& with, const Measurements& all, std::size_t taken,
                    const std::vector<PossibleSensor>& sensors, const std::vector<Rival>& rivals) {
  prediction::PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const auto n = std::ssize(sensors), added = std::ssize(all.readings) - as_index(taken);
  std::vector<MatrixX> read;
  for (const Rival& r : rivals) {
    const std::vector<VectorX> predicted =
        subject_with(with, r, r.values).stand(all)->predict(all, linear, parallel::alone);
    MatrixX& own = read.emplace_back(n, added);
    for (Eigen::Index i = 0; i < added; ++i) own.col(i) = predicted[taken + as_size(i)].tail(n);
    for (Eigen::Index k = 0; k < n; ++k) own.row(k) /= nth(sensors, k).sigma;
  }
  MatrixX out(n, 0);
  for (std::size_t a = 0; a < read.size(); ++a)
    for (std::size_t b = a + 1; b < read.size(); ++b) {
      out.conservativeResize(Eigen::NoChange, out.cols() + added);
      out.rightCols(added) = read[a] - read[b];
    }
  return out;
}

/// Those that differ most, each in another way than those before it.
std::vector<std::size_t> most_different(const MatrixX& differences) {
  constexpr double alike = 0.99;  // cosine
  std::vector<std::pair<double, std::size_t>> order;
  for (Eigen::Index k = 0; k < differences.rows(); ++k)
    if (const double size = differences.row(k).squaredNorm(); size > nothing_tells)
      order.emplace_back(-size, as_size(k));
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> out;
  for (const auto& [size, k] : order) {
    const VectorX own = differences.row(as_index(k)).normalized();
    const bool is_new = std::none_of(out.begin(), out.end(), [&](std::size_t other) {
      return std::abs(own.dot(differences.row(as_index(other)).normalized())) > alike;
    });
    if (is_new) out.push_back(k);
    if (out.size() == most_looked_at) break;
  }
  return out;
}

/// Readings that are enough, in their order or the most telling first; none where not even all are.
std::vector<std::size_t> enough(RivalryAim aim, std::size_t blocks, bool in_order) {
  std::vector<std::size_t> left, out;
  for (std::size_t i = 0; i < blocks; ++i) left.push_back(i);
  while (!left.empty()) {
    std::size_t next = 0;
    double most = -INFINITY;
    for (std::size_t i = 0; i < left.size() && !in_order; ++i)
      if (const double value = aim.with(left[i]); value > most) most = value, next = i;
    aim.take(left[next]);
    out.push_back(left[next]);
    left.erase(left.begin() + as_index(next));
    if (aim.reached()) return out;
  }
  return {};
}

/// The readings added, read by one more sensor.
class ReadBy {
 public:
  ReadBy(const subject::Subject& s, PossibleSensor sensor, const Measurements& all, std::size_t taken,
         const std::vector<Rival>& rivals, const SensorOptions& o)
      : sensor_(std::move(sensor)),
        with_(subject::with_sensors(s, {sensor_})),
        prospect_(with_, possible(with_.placed(read_by(all, {sensor_}, taken)), taken), o.noise, parallel::alone,
                  subject_with_likeliest(with_, rivals)),
        o_(o) {}

  /// Probability expected of the true rival to first order, with the rivals as fitted.
  double promise(const std::vector<Rival>& rivals) const {
    const Rivalry rivalry(prospect_, with_, rivals, 1, o_.seed, parallel::alone);
    return rivalry.probability(rivalry.gain_of_all());
  }

  NewSensor judged(const std::vector<Rival>& rivals) const {
    Rivalry rivalry(prospect_, with_, rivals, o_.draws, o_.seed, parallel::alone);
    NewSensor out{sensor_, 0, {}, 0};
    const auto [gain, at] = rivalry.refitted(parallel::alone);
    out.probability = rivalry.probability(gain);
    out.separation = INFINITY;
    for (const Pair& p : rivalry.pairs(gain)) out.separation = std::min(out.separation, p.separation);
    rivalry = rivalry.about(at, parallel::alone);
    out.enough = enough(RivalryAim(rivalry, {}, o_.probability), prospect_.possible().blocks.size(), o_.in_order);
    return out;
  }

 private:
  static Possible possible(Measurements all, std::size_t taken) {
    Possible out;
    out.all = std::move(all);
    out.taken = taken;
    for (std::size_t i = taken; i < out.all.readings.size(); ++i)
      out.blocks.push_back({i, 1, out.all.readings[i].pose});
    return out;
  }

  PossibleSensor sensor_;
  subject::Subject with_;
  Prospect prospect_;
  const SensorOptions& o_;
};

}  // namespace

std::vector<NewSensor> new_sensors(const subject::Subject& s, const Measurements& data, const Measurements& added,
                                   const std::vector<Rival>& rivals, const SensorOptions& o,
                                   const parallel::Work& work) {
  std::vector<PossibleSensor> sensors = candidates(s, data, o.noise);
  if (sensors.empty()) return {};
  const Measurements all = s.placed(measurement::joined({data, added}));
  const std::size_t taken = data.readings.size();
  const subject::Subject with = subject::with_sensors(s, sensors);
  const std::vector<std::size_t> order =
      most_different(differences(with, with.placed(read_by(all, sensors, taken)), taken, sensors, rivals));
  std::vector<std::optional<ReadBy>> read(order.size());
  std::vector<std::pair<double, std::size_t>> promising(order.size());
  parallel::for_each_case(order.size(), 1, work.threads, [&](std::size_t i) {
    read[i].emplace(s, sensors[order[i]], all, taken, rivals, o);
    promising[i] = {-read[i]->promise(rivals), i};
  });
  std::stable_sort(promising.begin(), promising.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  promising.resize(std::min(promising.size(), judged));
  std::vector<NewSensor> out(promising.size());
  parallel::for_each_case(out.size(), 1, work.threads,
                          [&](std::size_t i) { out[i] = read[promising[i].second]->judged(rivals); });
  std::erase_if(out, [](const NewSensor& n) { return !(n.separation > nothing_tells); });
  std::stable_sort(out.begin(), out.end(), [](const NewSensor& a, const NewSensor& b) {
    const auto many = [](const NewSensor& n) { return n.enough.empty() ? std::size_t(-1) : n.enough.size(); };
    return std::pair(many(a), -a.probability) < std::pair(many(b), -b.probability);
  });
  out.resize(std::min(out.size(), shown));
  return out;
}

}  // namespace deflect::plan
