#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/frame_tolerances.h"
#include "validation/subject/frame_groups.h"
#include "validation/subject/frame_nodes.h"
#include "validation/subject/frame_places.h"
#include "validation/subject/frame_readings.h"
#include "validation/subject/frame_sites.h"
#include "validation/subject/subject.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;

/// A frame does not move: it has one pose, whatever labels the measurements have.
class FrameStanding : public Standing {
 public:
  /// `near`: of a frame that may differ little.
  FrameStanding(std::shared_ptr<const FrameDescription> f, const measurement::Measurements& data,
                std::shared_ptr<const FrameNearby> near = nullptr)
      : frame_(std::move(f)), poses_(data.poses.size()), near_(std::move(near)), known_(near_) {
    if (!known_) known_ = std::make_shared<const FrameNearby>(*frame_, data);
  }

  const std::shared_ptr<const FrameNearby>& known() const { return known_; }

  std::size_t poses() const override { return poses_; }
  double size() const override { return size_of(*frame_); }
  bool has_history() const override { return subject::has_history(*frame_); }

  /// By the MSA, which alone knows frames.
  prediction::Predicted predicted(const measurement::Measurements& data, const prediction::PredictionOptions& o,
                                  const parallel::Work&) const override {
    return {predicted_readings(*frame_, data, o.geometry.value_or(frame_->geometry), near_.get())};
  }

  InnerSites inner_sites(const measurement::Measurements& data) const override {
    return inner_sites_of(*frame_, data, *known_);
  }
  std::vector<InnerSite> joint_sites(const measurement::Measurements& data) const override {
    return joint_sites_of(*frame_, data, *known_);
  }
  std::vector<NodeMotion> node_motions(const measurement::Measurements& data) const override {
    return node_motions_of(*frame_, data, *known_);
  }

  std::unique_ptr<const Deviations> deviations(const measurement::Measurements&) const override;

 private:
  std::shared_ptr<const FrameDescription> frame_;
  std::size_t poses_;
  std::shared_ptr<const FrameNearby> near_, known_;  // for itself; for others
};

/// One tolerance; its number by a standard deviation.
struct FrameMove {
  Tolerance tolerance;
  NumberMove number = {};
  std::string sensor = {};
  double gain = 0, zero = 0;  ///< of the sensor
};

std::vector<FrameMove> frame_moves(const FrameDescription& f, const measurement::Measurements& data) {
  std::vector<FrameMove> out;
  for (NumberMove& number : frame::number_moves(f)) {
    FrameMove move{{number.name, number.sigma}};
    move.tolerance.step = step_of(number.relative);
    move.number = std::move(number);
    out.push_back(std::move(move));
  }
  const std::vector<measurement::SensorChannel>& channels = data.instruments.sensors;
  for (std::size_t k = 0; k < channels.size(); ++k)
    for (const auto& [name, sensor] : f.sensors) {
      if (name != channels[k].name) continue;
      if (sensor.gain_sigma > 0)
        out.push_back({{fmt::format("gain of {}", name), sensor.gain_sigma}, {}, name, sensor.gain_sigma, 0});
      double largest = 0;
      for (const measurement::Reading& r : data.readings)
        largest = std::max(largest, std::abs(r.sensors[k].value_or(0)));
      if (sensor.free_zero && largest > 0)
        out.push_back({{fmt::format("zero of {}", name), 10 * largest, {}, true}, {}, name, 0, 10 * largest});
    }
  return out;
}

/// Of the readings those with the largest load of each channel.
measurement::Measurements largest_loads(const measurement::Measurements& data) {
  const MatrixX loads = measurement::loads_of(data).cwiseAbs();
  std::set<std::size_t> largest;
  for (const auto& channel : loads.rowwise())
    largest.insert(as_size(std::max_element(channel.begin(), channel.end()) - channel.begin()));
  measurement::Measurements out = data;
  out.readings.clear();
  out.poses.resize(1);
  out.poses.front().readings.clear();
  for (const std::size_t i : largest) {
    out.poses.front().readings.push_back(out.readings.size());
    out.readings.push_back(data.readings[i]);
    out.readings.back().pose = 0;
  }
  return out;
}

/// Whether equilibrium in the deformed shape changes what tolerances do to some sensor by more than a hundredth, and by
/// more than its σ: a column whose load adds a fifth to its deflection adds a fifth to that of being off plumb too.
/// Asked of all tolerances at once, each off by a standard deviation this way or that.
bool shape_changes_tolerances(const FrameDescription& f, const std::vector<FrameMove>& moves,
                              const measurement::Measurements& data) {
  constexpr double little = 0.01, nothing = 1e-3;
  if (f.geometry == Geometry::linear) return false;
  NumberMove all;
  for (std::size_t k = 0; k < moves.size(); ++k)
    for (const auto& [number, shift] : moves[k].number.shifts)
      all.shifts.emplace_back(number, std::sin(1.0 + static_cast<double>(k)) > 0 ? shift : -shift);
  if (all.shifts.empty()) return false;
  const FrameDescription built = frame::moved(f, all);
  const measurement::Measurements largest = largest_loads(data);
  const auto read = [&](const FrameDescription& frame, Geometry geometry) {
    const std::vector<VectorX> by_reading = predicted_readings(frame, largest, geometry);
    MatrixX out(by_reading.front().size(), std::ssize(by_reading));
    for (std::size_t i = 0; i < by_reading.size(); ++i) out.col(as_index(i)) = by_reading[i];
    return out;
  };
  const auto changes = outcome_of([&] {
    const MatrixX drawn = read(f, Geometry::linear), linear = read(built, Geometry::linear) - drawn;
    const MatrixX shape = read(built, f.geometry) - read(f, f.geometry) - linear;
    for (std::size_t k = 0; k < data.instruments.sensors.size(); ++k) {
      const auto row = as_index(6 + k);
      const double of = std::max(linear.row(row).norm(), nothing * drawn.row(row).norm());
      const double seen = std::max(little * of, data.instruments.sensors[k].sigma.value_or(0));
      if (shape.row(row).norm() > seen) return true;
    }
    return false;
  });
  return changes.value.value_or(false);
}

/// A frame off by a tolerance. Where it does not stand in its deformed shape, for it bends more than what bears the
/// load as drawn, the tolerance does what it does in linear geometry.
class DeviatingFrame final : public FrameStanding {
 public:
  DeviatingFrame(FrameDescription built, const measurement::Measurements& data,
                 std::shared_ptr<const FrameStanding> drawn)
      : FrameStanding(std::make_shared<const FrameDescription>(std::move(built)), data, drawn->known()),
        drawn_(std::move(drawn)) {}

  prediction::Predicted predicted(const measurement::Measurements& data, const prediction::PredictionOptions& o,
                                  const parallel::Work& work) const override {
    auto read = outcome_of([&] { return FrameStanding::predicted(data, o, work); });
    if (read) return std::move(*read);
    prediction::PredictionOptions linear = o;
    linear.geometry = Geometry::linear;
    prediction::Predicted out = FrameStanding::predicted(data, linear, work);
    const std::vector<VectorX> stands = drawn_->predict(data, o, work), drawn = drawn_->predict(data, linear, work);
    for (std::size_t i = 0; i < stands.size(); ++i) out.readings[i] += stands[i] - drawn[i];
    return out;
  }

 private:
  std::shared_ptr<const FrameStanding> drawn_;
};

class FrameDeviations final : public Deviations {
 public:
  /// `further`: of a frame that may differ little, null for none. It serves where the frame itself cannot be known.
  FrameDeviations(FrameDescription f, const measurement::Measurements& data, std::shared_ptr<const FrameNearby> further)
      : data_(data), moves_(frame_moves(f, data)) {
    if (!shape_changes_tolerances(f, moves_, data)) f.geometry = Geometry::linear, f.load_steps = 1;
    frame_ = std::make_shared<const FrameDescription>(std::move(f));
    drawn_ = std::make_shared<const FrameStanding>(
        frame_, data, std::make_shared<const FrameNearby>(*frame_, data, std::move(further)));
    for (const FrameMove& move : moves_) tolerances_.push_back(move.tolerance);
  }

  const std::vector<Tolerance>& tolerances() const override { return tolerances_; }
  const Standing& drawn() const override { return *drawn_; }
  std::unique_ptr<const Standing> with(std::size_t k) const override {
    const FrameMove& move = moves_[k];
    FrameDescription built =
        move.number.shifts.empty() ? *frame_ : frame::moved(*frame_, move.number, move.tolerance.step);
    for (auto& [name, sensor] : built.sensors)
      if (name == move.sensor) sensor.gain += move.gain, sensor.zero += move.zero;
    return std::make_unique<DeviatingFrame>(std::move(built), data_, drawn_);
  }

 private:
  const measurement::Measurements& data_;
  std::vector<FrameMove> moves_;
  std::vector<Tolerance> tolerances_;
  std::shared_ptr<const FrameDescription> frame_;
  std::shared_ptr<const FrameStanding> drawn_;
};

std::unique_ptr<const Deviations> FrameStanding::deviations(const measurement::Measurements& data) const {
  return std::make_unique<FrameDeviations>(*frame_, data, near_);
}

/// Of one reading, where the description gives it: scatter, and rounding to a step, which is as good as even over it.
std::optional<double> noise_of(const frame::FrameSensor& s) {
  const double sigma = std::hypot(s.sigma, s.resolution / std::sqrt(12));
  return s.sigma > 0 ? std::optional(sigma) : std::nullopt;
}

class FrameSubject final : public Subject::Kind {
 public:
  explicit FrameSubject(FrameDescription f) : frame_(std::make_shared<const FrameDescription>(std::move(f))) {}

  const std::string& name() const override { return frame_->name; }
  const std::string& about() const override { return frame_->about; }
  std::string file_text(const std::string& name, const std::string& about) const override {
    FrameDescription f = *frame_;
    f.name = name, f.about = about;
    return frame::write_frame(f);
  }
  Geometry geometry() const override { return frame_->geometry; }
  double load_tolerance() const override { return frame_->tolerances.load; }
  std::vector<Place> places() const override {
    std::vector<Place> all = places_of(*frame_);
    const std::vector<Place> groups = groups_of(*frame_, all);
    all.insert(all.end(), groups.begin(), groups.end());
    return all;
  }
  const FrameDescription* frame() const override { return frame_.get(); }

  measurement::Instruments instruments() const override {
    measurement::Instruments out;
    out.stationary = true;
    for (const auto& [name, s] : frame_->sensors) out.sensors.push_back({name, quantity_of(s), noise_of(s)});
    for (const auto& [name, load] : frame_->loads) out.load_cases.push_back(name);
    for (const auto& [name, at] : frame_->nodes) out.load_points.push_back("node." + name);
    return out;
  }

  std::shared_ptr<const Standing> stand(const measurement::Measurements& data, const Standing* known) const override {
    const auto* near = dynamic_cast<const FrameStanding*>(known);
    return std::make_shared<FrameStanding>(frame_, data, near ? near->known() : nullptr);
  }
  std::shared_ptr<const Kind> named(const std::string& name) const override {
    FrameDescription f = *frame_;
    f.name = name;
    return frame_subject(std::move(f));
  }
  std::shared_ptr<const Kind> edited(const std::vector<Edit>& edits) const override {
    return frame_subject(frame::edited(*frame_, edits));
  }

 private:
  std::shared_ptr<const FrameDescription> frame_;
};

}  // namespace

std::shared_ptr<const Subject::Kind> frame_subject(FrameDescription f) {
  return std::make_shared<FrameSubject>(std::move(f));
}

}  // namespace deflect::subject
