#include "validation/subject/trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/frame_description.h"
#include "msa/frame/file/frame_fields.h"
#include "validation/subject/possible_sensors.h"

namespace deflect::subject {
namespace {

constexpr std::size_t most_poses = 9;
constexpr const char* load_names[] = {"fx", "fy", "fz", "mx", "my", "mz"};

/// Rows of one load at a time.
class Trials {
 public:
  explicit Trials(measurement::Measurements m) : m_(std::move(m)) { m_.note_columns = {"note"}; }

  template <class Load>
  void add(std::size_t pose, const Load& load, const std::string& plus, const std::string& minus) {
    for (const auto& [times, note] : {std::pair{0, plus}, {1, plus}, {0, plus}, {-1, minus}, {0, minus}}) {
      measurement::Reading r;
      r.pose = pose;
      r.notes = {note};
      r.sequence = static_cast<double>(m_.readings.size() + 1);
      r.line = m_.readings.size() + 2;
      load(r, times);
      m_.poses[pose].readings.push_back(m_.readings.size());
      m_.readings.push_back(std::move(r));
    }
  }
  measurement::Measurements done() && { return std::move(m_); }

 private:
  measurement::Measurements m_;
};

measurement::Measurements of_frame(const Subject& s, const measurement::Measurements& data) {
  measurement::Measurements m;
  m.origin = "readings that could be taken";
  m.instruments = s.instruments();
  m.instruments.load_points.clear();
  m.poses.push_back({"all", Vector6::Zero(), {}, {}});
  const std::vector<std::string> cases = m.instruments.load_cases;
  const std::vector<double> largest = largest_factors(s, data);
  const std::size_t sensors = m.instruments.sensors.size();
  Trials out(std::move(m));
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const double most = largest[k];
    const auto load = [&](measurement::Reading& r, int times) {
      r.factors.assign(cases.size(), 0);
      r.factors[k] = times * most;
      r.sensors.assign(sensors, 0.0);
    };
    out.add(0, load, fmt::format("load.{} × {:g}", cases[k], most), fmt::format("load.{} × {:g}", cases[k], -most));
  }
  return std::move(out).done();
}

measurement::Measurements of_machine(const Subject& s, const measurement::Measurements& data) {
  measurement::Measurements m;
  m.origin = "readings that could be taken";
  m.joint_rotates = data.joint_rotates;
  for (std::size_t p = 0; p < std::min(most_poses, data.poses.size()); ++p) {
    m.poses.push_back(data.poses[p]);
    m.poses.back().readings.clear();
  }
  const LargestLoads largest = largest_loads(s, data);
  std::optional<double> sigma_u, sigma_th;
  for (const measurement::Reading& r : data.readings) {
    if (r.sigma_u) sigma_u = std::min(sigma_u.value_or(*r.sigma_u), *r.sigma_u);
    if (r.sigma_th) sigma_th = std::min(sigma_th.value_or(*r.sigma_th), *r.sigma_th);
  }
  const std::vector<measurement::PoseGroup> poses = m.poses;
  Trials out(std::move(m));
  for (std::size_t p = 0; p < poses.size(); ++p)
    for (std::size_t i = 0; i < 6; ++i) {
      const double size = i < 3 ? largest.force : largest.moment;
      const auto load = [&](measurement::Reading& r, int times) {
        r.load(as_index(i)) = times * size;
        r.displacement.fill(0.0);
        r.sigma_u = sigma_u, r.sigma_th = sigma_th;
      };
      const auto note = [&](double times) {
        return fmt::format("{} = {:.4g} {} at pose {}", load_names[i], times * size, i < 3 ? "N" : "Nm",
                           poses[p].label);
      };
      out.add(p, load, note(1), note(-1));
    }
  return std::move(out).done();
}

}  // namespace

LargestLoads largest_loads(const Subject& s, const measurement::Measurements& data) {
  LargestLoads out;
  for (const measurement::Reading& r : data.readings) {
    out.force = std::max(out.force, r.load.head<3>().cwiseAbs().maxCoeff());
    out.moment = std::max(out.moment, r.load.tail<3>().cwiseAbs().maxCoeff());
  }
  const double arm = 0.1 * s.stand(data)->size();
  if (out.moment == 0) out.moment = out.force * arm;
  if (out.force == 0) out.force = out.moment / arm;
  return out;
}

std::vector<double> largest_factors(const Subject& s, const measurement::Measurements& data) {
  const std::vector<std::string>& known = data.instruments.load_cases;
  std::vector<double> out;
  for (const std::string& name : s.instruments().load_cases) {
    double most = 0;
    const auto at = std::find(known.begin(), known.end(), name);
    for (const measurement::Reading& r : data.readings)
      if (at != known.end()) most = std::max(most, std::abs(r.factors[as_size(at - known.begin())]));
    out.push_back(most > 0 ? most : 1);
  }
  return out;
}

ForcesAtNodes forces_at_nodes(const Subject& s, const measurement::Measurements& data,
                              const std::vector<std::string>& nodes) {
  const frame::FrameDescription& f = *s.frame();
  ForcesAtNodes out;
  std::vector<std::string> known;
  for (const auto& [node, at] : f.nodes) known.push_back(node);
  for (const std::string& node : nodes == std::vector<std::string>{"all"} ? known : nodes) {
    if (std::find(known.begin(), known.end(), node) == known.end())
      throw InputError(fmt::format("{}: {}", s.name(), frame::unknown_name("node", node, known)));
    out.points.push_back("node." + node);
  }
  if (nodes.empty()) out.points = data.instruments.load_points;
  for (int i = 0; i < 3; ++i)
    if (i != frame::normal_axis(f.plane)) out.axes.push_back(i);
  const auto count = [&](const Vector6& load, double factor) {
    out.most = std::max(out.most, factor * load.head<3>().cwiseAbs().maxCoeff());
  };
  const std::vector<double> factors = largest_factors(s, data);
  for (std::size_t k = 0; k < factors.size(); ++k)
    for (const auto& [node, load] : f.loads[k].second.nodes) count(load, factors[k]);
  for (const measurement::Reading& r : data.readings)
    for (const Vector6& load : r.at_points) count(load, 1);
  return out;
}

Subject instrumented(const Subject& s) {
  if (!s.frame()) return s;
  std::vector<PossibleSensor> all = possible_sensors(s);
  std::erase_if(all,
                [](const PossibleSensor& p) { return !(p.sigma > 0) || p.quantity == measurement::Quantity::force; });
  return with_sensors(s, all);
}

measurement::Measurements trial_readings(const Subject& s, const measurement::Measurements& data) {
  return s.frame() ? of_frame(s, data) : s.placed(of_machine(s, data));
}

}  // namespace deflect::subject
