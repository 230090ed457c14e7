#include "validation/plan/possible.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/stand.h"
#include "validation/measurement/joined.h"
#include "validation/measurement/random.h"
#include "validation/plan/possible_loads.h"
#include "validation/prediction/campaign.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;
using measurement::PoseGroup;
using measurement::Reading;

/// Poses to choose from.
struct Poses {
  std::size_t measured;  ///< at most
  int drawn;
};
constexpr Poses usual = {9, 24}, in_sequences = {5, 3}, of_campaign = {16, 24};
constexpr double sizes[] = {1, 0.5, 0.2};
/// What follows a load that has gone on: shares of it.
const std::vector<std::vector<double>> sequences_of_loads = {{1}, {1, 0.5}, {1, 0}, {1, -1}};

bool is_same(const PoseGroup& p, const PoseGroup& q) {
  return q.pose_mm_deg == p.pose_mm_deg && q.joints.size() == p.joints.size() && q.joints == p.joints;
}

bool is_within(const Limits& limits, const Reading& r, bool frame) {
  const auto within = [](const Vector3& load, const std::optional<double>& most) {
    return !most || load.cwiseAbs().maxCoeff() <= *most * (1 + 1e-9);
  };
  const auto at_a_node = [&](const Vector6& load) { return within(load.head<3>(), limits.force); };
  return within(r.load.head<3>(), limits.force) && within(r.load.tail<3>(), limits.moment) &&
         !(limits.forces_only && !r.load.tail<3>().isZero(0)) &&
         (!frame || std::all_of(r.at_points.begin(), r.at_points.end(), at_a_node));
}

/// Poses that differ from each other, of a file.
std::vector<PoseGroup> distinct(const std::vector<PoseGroup>& all, std::size_t most) {
  std::vector<PoseGroup> out;
  for (const PoseGroup& p : all) {
    if (std::any_of(out.begin(), out.end(), [&](const PoseGroup& q) { return is_same(p, q); })) continue;
    out.push_back(p);
    out.back().readings.clear();
  }
  if (out.size() <= most) return out;
  std::vector<PoseGroup> some;  // spread over the file
  for (std::size_t i = 0; i < most; ++i) some.push_back(out[i * (out.size() - 1) / (most - 1)]);
  return some;
}

std::vector<PoseGroup> poses_of(const subject::Subject& s, const Measurements& data, const Limits& limits, Poses most,
                                std::uint64_t seed) {
  if (limits.poses) return distinct(limits.poses->poses, limits.poses->poses.size());
  std::vector<PoseGroup> out = distinct(data.poses, most.measured);
  if (!s.machine() || data.by_joints() || limits.where == Where::as_measured) return out;
  measurement::Random random(seed);
  const auto more = outcome_of([&] { return prediction::tilted_poses(*s.machine(), most.drawn, random); });
  if (!more) return out;  // a device without a workspace
  for (const Vector6& at : *more) out.push_back({"", at, {}, {}});
  return out;
}

/// A reading with everything that the data read.
Reading blank(const Measurements& data) {
  Reading out;
  double sigma_u = 0, sigma_th = 0, with_u = 0, with_th = 0;
  out.sensors.resize(data.instruments.sensors.size());
  for (const Reading& r : data.readings) {
    for (std::size_t i = 0; i < 6; ++i)
      if (r.displacement[i]) out.displacement[i] = 0;
    for (std::size_t k = 0; k < r.sensors.size(); ++k)
      if (r.sensors[k]) out.sensors[k] = 0;
    if (r.sigma_u) sigma_u += *r.sigma_u * *r.sigma_u, with_u += 1;
    if (r.sigma_th) sigma_th += *r.sigma_th * *r.sigma_th, with_th += 1;
  }
  if (with_u > 0) out.sigma_u = std::sqrt(sigma_u / with_u);
  if (with_th > 0) out.sigma_th = std::sqrt(sigma_th / with_th);
  return out;
}

/// Rows one after the other.
class Rows {
 public:
  Rows(const Measurements& data, bool sequences) : blank_(blank(data)), sequences_(sequences) {
    m_.origin = "readings that could be taken";
    m_.joint_rotates = data.joint_rotates;
    m_.instruments = data.instruments;
    m_.note_columns = {"note"};
  }

  /// The load cases of the frame, in its order, and the nodes of these loads behind those of the data.
  void of_frame(const subject::Subject& s, const std::vector<PossibleLoad>& loads) {
    m_.instruments.load_cases = s.instruments().load_cases;
    std::vector<std::string>& points = m_.instruments.load_points;
    for (const PossibleLoad& load : loads)
      if (!load.point.empty() && std::find(points.begin(), points.end(), load.point) == points.end())
        points.push_back(load.point);
  }

  /// A pose that is approached anew.
  void approach(PoseGroup pose) {
    pose.label = fmt::format("plan {}", m_.poses.size() + 1);
    pose.readings.clear();
    m_.poses.push_back(std::move(pose));
  }

  /// A reading at the pose approached last; `known`: its load cases.
  void take_over(Reading r, const std::vector<std::string>& known) {
    const std::vector<double> factors = std::exchange(r.factors, {});
    r.factors.assign(m_.instruments.load_cases.size(), 0);
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const std::vector<std::string>& all = m_.instruments.load_cases;
      r.factors[as_size(std::find(all.begin(), all.end(), known[k]) - all.begin())] = factors[k];
    }
    if (!m_.instruments.load_points.empty()) r.at_points.resize(m_.instruments.load_points.size(), Vector6::Zero());
    r.notes = {"as in the campaign given"};
    blocks_.push_back({m_.readings.size(), 1, m_.poses.size() - 1});
    put(std::move(r));
  }

  /// Each load alone at the pose approached last.
  void each(const std::vector<PossibleLoad>& loads) {
    for (const PossibleLoad& load : loads)
      for (const double size : sizes) {
        if (size < 1 && load.in_full) continue;
        blocks_.push_back({m_.readings.size(), 1, m_.poses.size() - 1});
        reading(load, size, "");
      }
  }

  void add(const PoseGroup& pose, const std::vector<PossibleLoad>& loads) {
    if (!sequences_) {
      approach(pose);
      return each(loads);
    }
    for (const PossibleLoad& load : loads)
      for (const std::vector<double>& shares : sequences_of_loads) {
        approach(pose);
        blocks_.push_back({m_.readings.size(), shares.size(), m_.poses.size() - 1});
        for (std::size_t i = 0; i < shares.size(); ++i)
          reading(load, shares[i],
                  i == 0          ? "goes on"
                  : shares[i] > 0 ? "comes off to this"
                  : shares[i] < 0 ? "comes off and turns"
                                  : "is off");
      }
  }

  Measurements take() { return std::move(m_); }
  const std::vector<Block>& blocks() const { return blocks_; }

 private:
  void reading(const PossibleLoad& load, double share, const std::string& how) {
    Reading r = blank_;
    r.load = share * load.at_T + Vector6::Zero();  // no −0
    if (!m_.instruments.load_points.empty()) {
      r.at_tool = r.load;
      r.at_points.assign(m_.instruments.load_points.size(), Vector6::Zero());
      const std::vector<std::string>& points = m_.instruments.load_points;
      if (const auto at = std::find(points.begin(), points.end(), load.point); at != points.end())
        r.at_points[as_size(at - points.begin())] = share * load.at_point + Vector6::Zero();
    }
    for (const double factor : load.factors) r.factors.push_back(share * factor + 0.0);
    if (load.factors.empty()) r.factors.assign(m_.instruments.load_cases.size(), 0);
    r.notes = {how.empty() ? load.words : fmt::format("{}: {}", load.words, how)};
    put(std::move(r));
  }

  void put(Reading r) {
    r.pose = m_.poses.size() - 1;
    r.sequence = static_cast<double>(m_.readings.size() + 1);
    r.line = m_.readings.size() + 2;
    m_.poses.back().readings.push_back(m_.readings.size());
    m_.readings.push_back(std::move(r));
  }

  Measurements m_;
  Reading blank_;
  bool sequences_;
  std::vector<Block> blocks_;
};

}  // namespace

Measurements Possible::data() const {
  Measurements out = all;
  out.readings.resize(taken);
  for (measurement::PoseGroup& p : out.poses) std::erase_if(p.readings, [&](std::size_t i) { return i >= taken; });
  while (!out.poses.empty() && out.poses.back().readings.empty()) out.poses.pop_back();
  return out;
}

Possible possible_readings(const subject::Subject& s, const Measurements& data, const Limits& limits, bool sequences,
                           std::uint64_t seed) {
  Rows rows(data, sequences);
  const std::vector<PossibleLoad> loads = possible_loads(s, data, limits, !sequences);
  if (s.frame()) rows.of_frame(s, loads);
  for (const PoseGroup& pose : poses_of(s, data, limits, sequences ? in_sequences : usual, seed)) rows.add(pose, loads);
  Possible out;
  out.taken = data.readings.size();
  out.sequences = sequences;
  const std::size_t poses = data.poses.size();
  out.all = s.placed(measurement::joined({data, rows.take()}));
  out.blocks = rows.blocks();
  for (Block& b : out.blocks) b.first += out.taken, b.pose += poses;
  return out;
}

Possible possible_campaign(const subject::Subject& s, const Measurements& given, const Limits& limits,
                           std::uint64_t seed) {
  Rows rows(given, false);
  const std::vector<PossibleLoad> loads = possible_loads(s, given, limits, true);
  if (s.frame()) rows.of_frame(s, loads);
  std::vector<PoseGroup> poses = poses_of(s, given, limits, of_campaign, seed);
  Possible out;
  for (const PoseGroup& pose : given.poses) {
    const auto here = std::find_if(poses.begin(), poses.end(), [&](const PoseGroup& p) { return is_same(p, pose); });
    if (here == poses.end() && limits.poses) continue;
    std::vector<std::size_t> kept;
    for (const std::size_t i : pose.readings)
      if (is_within(limits, given.readings[i], s.frame() != nullptr)) kept.push_back(i);
    if (kept.empty()) continue;
    rows.approach(pose);
    for (const std::size_t i : kept) {
      out.given.push_back(rows.blocks().size());
      rows.take_over(given.readings[i], given.instruments.load_cases);
    }
    if (here == poses.end()) continue;  // the loads stand at an earlier approach, or at enough other poses
    rows.each(loads);
    poses.erase(here);
  }
  for (const PoseGroup& pose : poses) rows.add(pose, loads);
  out.blocks = rows.blocks();
  out.all = s.placed(rows.take());
  return out;
}

Possible without_data(Possible p) {
  const std::size_t poses = p.blocks.empty() ? 0 : p.all.readings[p.taken].pose;
  p.all.readings.erase(p.all.readings.begin(), p.all.readings.begin() + as_index(p.taken));
  p.all.poses.erase(p.all.poses.begin(), p.all.poses.begin() + as_index(poses));
  for (PoseGroup& pose : p.all.poses)
    for (std::size_t& i : pose.readings) i -= p.taken;
  for (Reading& r : p.all.readings) r.pose -= poses;
  for (Block& b : p.blocks) b.first -= p.taken, b.pose -= poses;
  p.taken = 0;
  return p;
}

std::vector<std::size_t> pose_by_pose(const Possible& p, std::vector<std::size_t> chosen) {
  std::map<std::size_t, std::size_t> turn;  // of each pose
  for (const std::size_t b : chosen) turn.emplace(p.blocks[b].pose, turn.size());
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](std::size_t a, std::size_t b) { return turn.at(p.blocks[a].pose) < turn.at(p.blocks[b].pose); });
  return chosen;
}

Measurements as_plan(const Possible& p, const std::vector<std::size_t>& chosen) {
  Measurements out;
  out.origin = "plan";
  out.joint_rotates = p.all.joint_rotates;
  out.instruments = p.all.instruments;
  out.note_columns = {"note"};
  const auto note =
      std::find(p.all.note_columns.begin(), p.all.note_columns.end(), "note") - p.all.note_columns.begin();
  std::optional<std::size_t> pose;
  for (const std::size_t b : pose_by_pose(p, chosen)) {
    const Block& block = p.blocks[b];
    if (pose != block.pose || p.sequences) {
      PoseGroup group = p.all.poses[block.pose];
      group.label = fmt::format("plan {}", out.poses.size() + 1);
      group.readings.clear();
      out.poses.push_back(std::move(group));
    }
    pose = block.pose;
    for (std::size_t i = block.first; i < block.first + block.count; ++i) {
      Reading r = p.all.readings[i];
      r.pose = out.poses.size() - 1;
      r.displacement.fill(std::nullopt);
      std::fill(r.sensors.begin(), r.sensors.end(), std::nullopt);
      r.notes = {nth(p.all.readings[i].notes, note)};
      r.sequence = static_cast<double>(out.readings.size() + 1);
      r.line = out.readings.size() + 2;
      out.poses.back().readings.push_back(out.readings.size());
      out.readings.push_back(std::move(r));
    }
  }
  return out;
}

}  // namespace deflect::plan
