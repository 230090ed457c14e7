#include <fmt/format.h>

#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_fields.h"
#include "msa/frame/file/frame_file.h"
#include "validation/subject/subject.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;

std::size_t node_number(const FrameDescription& f, const std::string& node) {
  for (std::size_t i = 0; i < f.nodes.size(); ++i)
    if (f.nodes[i].first == node) return i;
  std::vector<std::string> known;
  for (const auto& [name, at] : f.nodes) known.push_back(name);
  throw InputError(fmt::format("{}: {}", f.name, frame::unknown_name("node", node, known)));
}

/// The largest distance of two corners of the box around its nodes.
double size_of(const FrameDescription& f) {
  Vector3 low = f.nodes.front().second, high = low;
  for (const auto& [name, at] : f.nodes) low = low.cwiseMin(at), high = high.cwiseMax(at);
  return (high - low).norm();
}

/// A frame does not move: it has one pose, whatever the measurements call it.
class FrameStanding final : public Standing {
 public:
  FrameStanding(std::shared_ptr<const FrameDescription> f, std::size_t node, std::size_t poses)
      : frame_(std::move(f)), node_(node), poses_(poses) {}

  std::size_t poses() const override { return poses_; }
  double size() const override { return size_of(*frame_); }
  BodyFrame tool(std::size_t) const override { return {frame_->nodes[node_].second, Matrix3::Identity()}; }
  BodyFrame base(std::size_t) const override { return {}; }
  std::vector<Site> sites(std::size_t) const override { return {}; }

  Matrix6 compliance(std::size_t) const override {
    std::vector<Vector6> unit;
    for (Eigen::Index i = 0; i < 6; ++i) unit.push_back(Vector6::Unit(i));
    const std::vector<Vector6> d = displacements(unit, Geometry::linear);
    Matrix6 C;
    for (Eigen::Index i = 0; i < 6; ++i) C.col(i) = nth(d, i);
    return C;
  }

  /// By the MSA, which alone knows frames.
  std::vector<VectorX> predict(const measurement::Measurements& data, const prediction::PredictionOptions& o,
                               const parallel::Work&) const override {
    std::vector<Vector6> loads;
    for (const measurement::Reading& reading : data.readings) loads.push_back(reading.load);
    const std::vector<Vector6> d = displacements(loads, o.geometry.value_or(frame_->geometry));
    return {d.begin(), d.end()};
  }

  std::unique_ptr<const Deviations> deviations(const measurement::Measurements&) const override;

 private:
  /// Of the node under wrenches on it. NumericalError where the frame finds no equilibrium or a check fails.
  std::vector<Vector6> displacements(const std::vector<Vector6>& loads, Geometry geometry) const {
    FrameDescription f = *frame_;
    f.geometry = geometry;
    if (geometry != Geometry::finite) f.load_steps = 1;
    f.loads.clear();
    for (std::size_t i = 0; i < loads.size(); ++i) {
      frame::LoadCase load;
      load.nodes.emplace_back(f.nodes[node_].first, loads[i]);
      f.loads.emplace_back(std::to_string(i), std::move(load));
    }
    const frame::FrameResult result = frame::analyse(f);
    if (const std::string failed = frame::failed_check(result); !failed.empty())
      throw NumericalError(fmt::format("{}: {}", f.name, failed));
    std::vector<Vector6> out;
    for (const frame::CaseResult& each : result.cases) out.push_back(each.displacements[node_]);
    return out;
  }

  std::shared_ptr<const FrameDescription> frame_;
  std::size_t node_, poses_;
};

/// Frame files declare no tolerances.
class NoDeviations final : public Deviations {
 public:
  explicit NoDeviations(FrameStanding drawn) : drawn_(std::move(drawn)) {}
  const std::vector<Tolerance>& tolerances() const override { return none_; }
  const Standing& drawn() const override { return drawn_; }
  std::unique_ptr<const Standing> with(std::size_t) const override { return std::make_unique<FrameStanding>(drawn_); }

 private:
  FrameStanding drawn_;
  std::vector<Tolerance> none_;
};

std::unique_ptr<const Deviations> FrameStanding::deviations(const measurement::Measurements&) const {
  FrameDescription linear = *frame_;
  linear.geometry = Geometry::linear;
  linear.load_steps = 1;
  return std::make_unique<NoDeviations>(
      FrameStanding(std::make_shared<const FrameDescription>(std::move(linear)), node_, poses_));
}

class FrameSubject final : public Subject::Kind {
 public:
  FrameSubject(FrameDescription f, std::string node)
      : number_(node_number(f, node)),
        frame_(std::make_shared<const FrameDescription>(std::move(f))),
        node_(std::move(node)) {}

  const std::string& name() const override { return frame_->name; }
  Geometry geometry() const override { return frame_->geometry; }
  double load_tolerance() const override { return 0; }
  std::shared_ptr<const Standing> stand(const measurement::Measurements& data, const Standing*) const override {
    return std::make_shared<FrameStanding>(frame_, number_, data.poses.size());
  }
  std::shared_ptr<const Kind> edited(const std::vector<Edit>& edits) const override {
    return frame_subject(frame::edited(*frame_, edits), node_);
  }

 private:
  std::size_t number_;
  std::shared_ptr<const FrameDescription> frame_;
  std::string node_;
};

}  // namespace

std::shared_ptr<const Subject::Kind> frame_subject(FrameDescription f, std::string node) {
  return std::make_shared<FrameSubject>(std::move(f), std::move(node));
}

}  // namespace deflect::subject
