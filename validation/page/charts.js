// Charts by Chart.js: one configuration per drawing, made anew for each theme.
import {BarController, BarElement, CategoryScale, Chart, Filler, Legend, LinearScale, LineController, LineElement,
        LogarithmicScale, PointElement, ScatterController, Tooltip} from 'chart.js';
import {el, missing, num} from './dom.js';
import {onTheme, theme} from './theme.js';

Chart.register(BarController, BarElement, CategoryScale, Filler, Legend, LinearScale, LineController, LineElement,
               LogarithmicScale, PointElement, ScatterController, Tooltip);
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
Chart.defaults.font.family = 'system-ui, sans-serif';
Object.assign(Chart.defaults.plugins.legend.labels, {boxWidth: 8, boxHeight: 7});

export function axis(title, t, more = {}) {
  return {title: {display: Boolean(title), text: title, color: t.quiet}, grid: {color: t.line},
          ticks: {color: t.quiet, callback: undefined}, ...more};
}

/** `about` says in words what is drawn; `make(theme)` gives Chart.js' configuration. */
export function chart(about, height, make) {
  const canvas = el('canvas', {role: 'img', 'aria-label': about});
  const holder = el('div', {class: 'chart', style: {height: height + 'px'}}, canvas);
  let drawn = null;
  const draw = () => {
    if (drawn) drawn.destroy();
    drawn = null;
    const t = theme();
    Chart.defaults.color = t.text;
    Chart.defaults.borderColor = t.line;
    try {
      const configuration = make(t);
      for (const scale of Object.values(configuration.options.scales || {}))
        if (scale.ticks && scale.ticks.callback === undefined) delete scale.ticks.callback;
      if (!canvas.getContext('2d')) throw new Error('this browser does not draw in two dimensions');
      drawn = new Chart(canvas, configuration);
      canvas.dataset.drawn = String(configuration.data.datasets.reduce((n, d) => n + d.data.length, 0));
    } catch (error) {
      holder.style.height = 'auto';
      holder.replaceChildren(missing(`“${about}”`, error));
    }
  };
  onTheme(draw);
  requestAnimationFrame(draw);
  return holder;
}

/** A name in lines that an axis has room for, cut behind blanks and underscores; on a telephone they are shorter. */
export function inLines(name, most = innerWidth < 640 ? 20 : 40) {
  return name.match(new RegExp(`.{1,${most}}(_|\\s|$)|.{1,${most}}`, 'g')) || [name];
}

/** Tooltip lines "series: value unit", under the whole name. */
export function labelled(unit, of = (item) => item.parsed.y) {
  return {callbacks: {title: (items) => (items.length ? [].concat(items[0].chart.data.labels?.[items[0].dataIndex] ?? items[0].label).join('') : ''),
                      label: (item) => `${item.dataset.label}: ${num(of(item))} ${unit}`}};
}

/** The error from version to version: what is left, what each step takes off, held-out poses, a placebo, the floor. */
export function waterfall(steps, floor = 'noise and tolerances', unit = 'µm') {
  const bars = [{label: steps[0].name, from: 0, to: steps[0].rmse, kind: 'level'}];
  for (let i = 1; i < steps.length; ++i) {
    bars.push({label: steps[i].step, from: steps[i].rmse, to: steps[i - 1].rmse, kind: steps[i].rmse <= steps[i - 1].rmse ? 'fall' : 'rise', held: steps[i].held, placebo: steps[i].placebo});
  }
  const last = steps[steps.length - 1];
  if (steps.length > 1) bars.push({label: 'left', from: 0, to: last.rmse, kind: 'level'});
  bars[0].held = steps[0].held;
  if (steps.length > 1) bars[bars.length - 1].held = last.held, bars[bars.length - 2].held = null;
  const points = (label, key, colour, style) => ({type: 'line', label, data: bars.map((b) => b[key] ?? null), showLine: false, pointStyle: style, pointRadius: 6, borderWidth: 2, borderColor: colour, backgroundColor: colour});
  return chart('Waterfall of the error', 320, (t) => ({
    type: 'bar',
    data: {
      labels: bars.map((b) => inLines(b.label, 22)),
      datasets: [
        points('held-out poses', 'held', t.purple, 'rectRot'),
        ...(bars.some((b) => b.placebo !== null && b.placebo !== undefined) ? [points('a placebo in its place', 'placebo', t.grey, 'crossRot')] : []),
        ...(Number.isFinite(last.floor) ? [{type: 'line', label: floor, data: bars.map(() => last.floor), borderColor: t.orange, borderDash: [6, 4], borderWidth: 2, pointRadius: 0, pointStyle: 'line'}] : []),
        {label: 'rms of measured − predicted', data: bars.map((b) => [b.from, b.to]), backgroundColor: bars.map((b) => ({level: t.blue, fall: t.green, rise: t.guilty}[b.kind])), maxBarThickness: 90},
      ],
    },
    options: {
      scales: {x: axis('', t, {grid: {display: false}}), y: axis('µm rms', t, {beginAtZero: true})},
      plugins: {legend: {position: 'bottom', labels: {usePointStyle: true}}, tooltip: {callbacks: {label: (item) => {
        const raw = item.raw;
        if (!Array.isArray(raw)) return `${item.dataset.label}: ${num(raw)} ${unit}`;
        return bars[item.dataIndex].kind === 'level' ? `rms: ${num(raw[1])} ${unit}` : `from ${num(raw[1])} to ${num(raw[0])} ${unit}`;
      }}}},
    },
  }));
}
