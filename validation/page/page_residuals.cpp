#include "validation/page/page_residuals.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/measurement/random.h"
#include "validation/report/compare_results.h"
#include "validation/report/text.h"

namespace deflect::page {
namespace {

/// Of each pose, over the kind of numbers that Errors speak of.
std::vector<double> rmse_by_pose(const compare::Comparison& c, const VectorX& residual,
                                 measurement::Quantity quantity) {
  std::vector<double> squares(c.study.data->poses.size(), 0), count(squares.size(), 0);
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    if (v.quantity != quantity) continue;
    const std::size_t pose = c.study.data->readings[v.reading].pose;
    const double r = residual(as_index(i));
    squares[pose] += r * r;
    count[pose] += 1;
  }
  for (std::size_t p = 0; p < squares.size(); ++p) squares[p] = count[p] > 0 ? std::sqrt(squares[p] / count[p]) : 0;
  return squares;
}

VectorX with_nothing_missing(const compare::Comparison& c, std::uint64_t seed) {
  measurement::Random random(seed);
  VectorX eta(c.tolerances.A.cols());
  for (double& each : eta) each = random.normal();
  for (std::size_t k = 0; k < c.tolerances.nuisances.size(); ++k)
    if (c.tolerances.nuisances[k].zero) eta(as_index(k)) = 0;  // the residual is free of it
  VectorX r = c.tolerances.A * eta;
  std::vector<double> loads;
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    const MatrixX& of_loads = c.study.load_errors.of(v.reading);
    if (i == 0 || v.reading != c.study.values[i - 1].reading) {
      loads.assign(as_size(of_loads.cols()), 0);
      for (double& each : loads) each = random.normal();
    }
    r(as_index(i)) += c.sigma[i] * random.normal();
    for (std::size_t k = 0; k < loads.size(); ++k)
      r(as_index(i)) += of_loads(as_index(v.channel), as_index(k)) * loads[k];
  }
  return r;
}

Json poses_json(const compare::Comparison& c, measurement::Quantity quantity) {
  const double unit = measurement::row_of(quantity).per_SI;
  std::vector<std::vector<double>> healthy;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    healthy.push_back(rmse_by_pose(c, with_nothing_missing(c, seed), quantity));
  Json out = Json::array();
  for (std::size_t p = 0; p < c.by_pose.size(); ++p) {
    const Vector3 at = report::mm * c.study.standing->tool(p).p_W;
    const compare::Errors& e = c.by_pose[p];
    Json pose = {{"label", c.study.data->poses[p].label},
                 {"at_mm", {at.x(), at.y(), at.z()}},
                 {"rmse", unit * e.rmse},
                 {"bias", {unit * e.bias.x(), unit * e.bias.y(), unit * e.bias.z()}}};
    for (const std::vector<double>& draw : healthy) pose["with_nothing_missing"].push_back(unit * draw[p]);
    out.push_back(std::move(pose));
  }
  return out;
}

Json readings_json(const compare::Comparison& c, std::size_t most) {
  const measurement::Measurements& data = *c.study.data;
  const std::vector<measurement::LoadChannel> channels = measurement::load_channels(data);
  Json out = Json::array();
  for (std::size_t i = 0; i < std::min(most, data.readings.size()); ++i) {
    const measurement::Reading& r = data.readings[i];
    Vector6 load = r.load;
    load.tail<3>() *= report::mm;
    const Json nothing = Json::array({nullptr, nullptr, nullptr, nullptr, nullptr, nullptr});
    Json reading = {{"line", r.line},
                    {"pose", r.pose},
                    {"sequence", r.sequence ? Json(*r.sequence) : Json()},
                    {"load_N_Nmm", json::json_numbers(load, "load")},
                    {"measured", nothing},
                    {"predicted", json::json_numbers(twist_in_mm(c.study.predicted[i].head<6>()), "predicted")},
                    {"residual", nothing}};
    for (std::size_t k = 0; data.instruments.stationary && k < channels.size(); ++k)
      if (const double load_there = c.study.loads(as_index(k), as_index(i)); load_there != 0)
        reading["loads"][channels[k].name] = load_there * (channels[k].moment ? report::mm : 1);
    if (!data.note_columns.empty()) reading["notes"] = r.notes;
    out.push_back(std::move(reading));
  }
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    if (v.reading >= out.size()) continue;
    const double unit = measurement::row_of(v.quantity).per_SI, residual = unit * c.residual(as_index(i));
    if (v.of_tool_point()) {
      out[v.reading]["measured"][v.channel] = unit * v.value;
      out[v.reading]["residual"][v.channel] = residual;
    } else {
      out[v.reading]["sensors"][measurement::channel_name(data, v.channel)] = {
          {"measured", unit * v.value}, {"residual", residual}, {"unit", measurement::row_of(v.quantity).unit}};
    }
  }
  return out;
}

Json curves_json(const compare::Comparison& c) {
  Json out = Json::array();
  for (const compare::ElongationCurve& curve : c.curves) {
    Json json = {{"site", curve.site}, {"rotation", curve.rotation}};
    for (std::size_t i = 0; i < curve.force.size(); ++i) {
      json["force"].push_back((curve.rotation ? report::mm : 1) * curve.force[i]);
      json["elongation"].push_back((curve.rotation ? 1 : report::mm) * curve.elongation[i]);
      json["deviation"].push_back((curve.rotation ? 1 : report::mm) * curve.deviation[i]);
    }
    out.push_back(std::move(json));
  }
  return out;
}

/// Each channel with its unit and the standard deviation of its residual with nothing missing.
Json channels_json(const compare::Comparison& c) {
  const std::vector<measurement::SensorChannel>& sensors = c.study.data->instruments.sensors;
  const VectorX deviation = compare::expected_deviations(c);
  std::vector<double> variance(sensors.size(), 0), count(sensors.size(), 0);
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const std::size_t k = c.study.values[i].channel - 6;
    variance[k] += deviation(as_index(i)) * deviation(as_index(i));
    count[k] += 1;
  }
  Json out = Json::array();
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const measurement::QuantityRow& row = measurement::row_of(sensors[k].quantity);
    if (count[k] > 0)
      out.push_back({{"name", sensors[k].name},
                     {"unit", row.unit},
                     {"deviation", row.per_SI * std::sqrt(variance[k] / count[k])}});
  }
  return out;
}

}  // namespace

Json residuals_json(const compare::Comparison& c, std::size_t most) {
  const measurement::Quantity quantity = compare::quantity_of_errors(c.study.values);
  Json out;
  out["device"] = c.device;
  out["result"] = Json::parse(report::compare_json(c));
  out["unit"] = measurement::row_of(quantity).unit;
  out["poses"] = poses_json(c, quantity);
  out["readings"] = readings_json(c, most);
  out["readings_left_out"] = c.study.data->readings.size() - out["readings"].size();
  out["note_columns"] = c.study.data->note_columns;
  out["curves"] = curves_json(c);
  if (!c.study.standing->has_tool_point()) out["channels"] = channels_json(c);
  return out;
}

}  // namespace deflect::page
