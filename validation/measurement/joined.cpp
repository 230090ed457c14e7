#include "validation/measurement/joined.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::measurement {
namespace {

/// Where each of `names` stands in `all`; those that do not are added.
template <class T, class Name>
std::vector<std::size_t> merged(std::vector<T>& all, const std::vector<T>& more, const Name& name) {
  std::vector<std::size_t> at;
  for (const T& each : more) {
    auto found = std::find_if(all.begin(), all.end(), [&](const T& known) { return name(known) == name(each); });
    if (found == all.end()) found = all.insert(all.end(), each);
    at.push_back(as_size(found - all.begin()));
  }
  return at;
}

/// Entry i of `values` at place at[i]; the others are `nothing`.
template <class T>
std::vector<T> spread(const std::vector<T>& values, const std::vector<std::size_t>& at, std::size_t size,
                      const T& nothing) {
  std::vector<T> out(size, nothing);
  for (std::size_t i = 0; i < values.size(); ++i) out[at[i]] = values[i];
  return out;
}

class Joining {
 public:
  explicit Joining(const std::vector<Measurements>& all) : all_(all) {
    out_.origin = all.front().origin;
    out_.joint_rotates = all.front().joint_rotates;
    out_.instruments.stationary = all.front().instruments.stationary;
    const auto own_name = [](const auto& x) { return x; };
    for (const Measurements& m : all) {
      if (&m != &all.front()) out_.origin += " + " + m.origin;
      sensors_.push_back(
          merged(out_.instruments.sensors, m.instruments.sensors, [](const SensorChannel& s) { return s.name; }));
      points_.push_back(merged(out_.instruments.load_points, m.instruments.load_points, own_name));
      cases_.push_back(merged(out_.instruments.load_cases, m.instruments.load_cases, own_name));
      notes_.push_back(merged(out_.note_columns, m.note_columns, own_name));
      in_sequence_ = in_sequence_ && !m.readings.empty() && m.readings.front().sequence;
    }
  }

  Measurements join() {
    for (std::size_t i = 0; i < all_.size(); ++i) add(i);
    return std::move(out_);
  }

 private:
  void add(std::size_t session) {
    const Measurements& m = all_[session];
    if (m.joint_rotates != out_.joint_rotates)
      throw InputError(
          fmt::format("{} and {}: one commands poses and the other joint coordinates, or other ones: one device "
                      "wants one kind",
                      out_.origin, m.origin));
    out_.temperature_recorded = out_.temperature_recorded || m.temperature_recorded;
    out_.how_read.insert(out_.how_read.end(), m.how_read.begin(), m.how_read.end());
    const std::size_t first_pose = out_.poses.size();
    for (const PoseGroup& pose : m.poses) {
      PoseGroup& own = out_.poses.emplace_back(pose);
      own.readings.clear();
      for (std::size_t number = session + 1; !labels_.insert(own.label).second; ++number)
        own.label = fmt::format("{} ({})", pose.label, number);
    }
    const double begun = last_;
    for (const Reading& each : m.readings) {
      Reading r = each;
      r.pose += first_pose;
      out_.poses[r.pose].readings.push_back(out_.readings.size());
      r.sensors = spread(r.sensors, sensors_[session], out_.instruments.sensors.size(), std::optional<double>());
      r.factors = spread(r.factors, cases_[session], out_.instruments.load_cases.size(), 0.0);
      r.notes = spread(r.notes, notes_[session], out_.note_columns.size(), std::string());
      if (!out_.instruments.load_points.empty()) {
        if (m.instruments.load_points.empty()) r.at_tool = r.load;
        r.at_points =
            spread(r.at_points, points_[session], out_.instruments.load_points.size(), Vector6(Vector6::Zero()));
      }
      if (in_sequence_) {
        r.sequence = begun + *r.sequence - *first_of(m);
        last_ = std::max(last_, *r.sequence + 1);
      } else {
        r.sequence.reset();
      }
      r.line = out_.readings.size() + 2;
      out_.readings.push_back(std::move(r));
    }
  }

  static std::optional<double> first_of(const Measurements& m) {
    return std::min_element(m.readings.begin(), m.readings.end(),
                            [](const Reading& a, const Reading& b) { return *a.sequence < *b.sequence; })
        ->sequence;
  }

  const std::vector<Measurements>& all_;
  Measurements out_;
  std::vector<std::vector<std::size_t>> sensors_, points_, cases_, notes_;  // by session
  std::set<std::string> labels_;
  bool in_sequence_ = true;
  double last_ = 1;
};

}  // namespace

Measurements joined(const std::vector<Measurements>& all) {
  if (all.size() == 1) return all.front();
  return Joining(all).join();
}

void require_different(const std::vector<std::pair<std::string, std::string>>& sessions) {
  for (std::size_t i = 0; i < sessions.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (sessions[i].first == sessions[k].first)
        throw InputError(fmt::format(
            "{}: these are the readings of {} again: the same numbers twice are no replicates. Give each session once",
            sessions[i].second, sessions[k].second));
}

}  // namespace deflect::measurement
