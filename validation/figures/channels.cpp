#include "validation/figures/channels.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

constexpr std::size_t most_channels = 24;

struct Channel {
  std::string name;
  const measurement::QuantityRow* unit = nullptr;
  std::vector<std::pair<double, double>> points;  // place in the order, residual in the fine unit
  double band = 0, worst = 0;                     // two standard deviations; largest |residual|

  double beside_band() const { return band > 0 ? worst / band : worst; }
};

std::vector<Channel> channels_of(const compare::Comparison& c) {
  std::vector<Channel> all(6 + c.study.data->instruments.sensors.size());
  const VectorX deviation = compare::expected_deviations(c);
  std::vector<double> variance(all.size(), 0);
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    Channel& to = all[v.channel];
    to.unit = &measurement::row_of(v.quantity);
    const double at = c.study.sequence ? *c.study.data->readings[v.reading].sequence : static_cast<double>(v.reading);
    const double r = to.unit->fine_per_SI * c.residual(as_index(i));
    to.points.emplace_back(at, r);
    to.worst = std::max(to.worst, std::abs(r));
    variance[v.channel] += deviation(as_index(i)) * deviation(as_index(i));
  }
  std::vector<Channel> out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].points.empty()) continue;
    all[k].name = measurement::channel_name(*c.study.data, k);
    all[k].band = 2 * all[k].unit->fine_per_SI * std::sqrt(variance[k] / static_cast<double>(all[k].points.size()));
    out.push_back(std::move(all[k]));
  }
  return out;
}

}  // namespace

std::optional<Figure> channels(const compare::Comparison& c, const FigureStyle& style) {
  std::vector<Channel> all = channels_of(c);
  if (all.empty()) return std::nullopt;
  const std::size_t left_out = all.size() > most_channels ? all.size() - most_channels : 0;
  if (left_out > 0) {
    std::stable_sort(all.begin(), all.end(),
                     [](const Channel& a, const Channel& b) { return a.beside_band() > b.beside_band(); });
    all.resize(most_channels);
  }
  Sheet s("channels", style, 160);
  double last = 1;
  for (std::size_t k = 0; k < all.size(); ++k) {
    s.put("$c{} << EOD", k);
    for (const auto& [at, r] : all[k].points) s.put("{} {}", at, r), last = std::max(last, at);
    s.put("EOD");
  }
  s.put("set multiplot\nunset key");
  const std::string order = c.study.sequence ? "in the order taken" : "in the order of the file";
  double y = s.heading("Residuals of each channel " + order, {report::subjects(c)}) + 0.8 * s.line();
  const std::size_t columns = s.narrow() || all.size() < 4 ? 1 : 2;
  const double height = std::max(5.2 * s.line(), 20.0), gap = 1.4 * s.line();
  Tics widest;
  std::vector<Tics> tics;
  for (const Channel& each : all) {
    const double most = 1.1 * std::max({each.band, each.worst, 1e-9});
    tics.push_back(s.tics(-most, most, height, true));
    widest.letters = std::max(widest.letters, tics.back().letters);
  }
  const double left = s.left_of(widest);
  const double w = (s.width() - static_cast<double>(columns) * left - 4) / static_cast<double>(columns);
  s.put("set xrange [0:{}]\nset xtics {}\nset xzeroaxis lt 1 lc rgb '#404040' lw 0.7", 1.01 * last,
        s.tics(0, last, w).step);
  const double top = y;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Channel& each = all[k];
    const double most = 1.1 * std::max({each.band, each.worst, 1e-9});
    const bool below = k + columns >= all.size();
    y = top + static_cast<double>(k / columns) * (height + gap);
    s.panel(left + static_cast<double>(k % columns) * (w + left), y, w, height);
    s.axis_names(below ? "reading" : "", fmt::format("{} ({})", report::clip(each.name, 14), each.unit->fine), widest);
    s.put("set object 1 rectangle from graph 0,first {} to graph 1,first {} fc rgb '#E8E8E8' fs solid noborder behind",
          -each.band, each.band);
    s.put("set yrange [{}:{}]\nset ytics {}\nset format x '{}'", -most, most, tics[k].step, below ? "%g" : "");
    s.plot(fmt::format("plot $c{} using 1:2 with points pt 7 ps 0.35 lc rgb '#0072B2'", k));
  }
  s.put("unset multiplot");
  return s.figure(
      y + height + s.below(),
      fmt::format("Measured − predicted of each channel{}, {}. Grey: ±2 standard deviations of what noise "
                  "and tolerances give with nothing missing. {} {}",
                  left_out > 0 ? fmt::format(" ({} more, with smaller residuals, are left out)", left_out) : "", order,
                  report::data_sentence(c), report::noise_sentence(c)));
}

}  // namespace deflect::figures
