// Sections of results: diagnosis, history, solve, validation, map.
import {axis, chart, inLines, labelled, waterfall} from './charts.js';
import {attempt, el, figure, micro, num, numbers, table, um} from './dom.js';
import {workspace} from './workspace.js';

const places = ['ux', 'uy', 'uz', 'thx', 'thy', 'thz'], efforts = ['fx', 'fy', 'fz', 'mx', 'my', 'mz'];

/** The id of an effect at a place says where it acts; others say it in brackets. */
export const siteName = (c) => (c.place && c.site === 'machine' ? c.effect : `${c.effect} (${c.site})`);
/** With so many digits that the bounds can be told from each other. */
const intervalWords = (value, low, high) => {
  let digits = 4;
  if (high === null) return `${num(value, digits)} (at least ${num(low, digits)})`;
  while (digits < 12 && low !== high && num(low, digits) === num(high, digits)) ++digits;
  return `${num(value, digits)} (${num(low, digits)} … ${num(high, digits)})`;
};
const valueWords = (parameters) => parameters.map((p) => `${p.name} = ${intervalWords(p.value, p.low95, p.at_least ? null : p.high95)}`).join(', ');

/** What was found in words, then by its ids with the values that were fitted. */
export function diagnosisHeadline(d) {
  const words = d.headline || d.sentence || 'A diagnosis without its sentence.';
  if (d.mistakes?.[0]?.certain) return {words, small: 'No effect was looked for.'};
  return {words, small: (d.found || []).map((f) => siteName(f) + (f.parameters.length ? ': ' + valueWords(f.parameters) : '')).join('; ')};
}

export function candidates(d) {
  if (!d.candidates.length) return null;
  const tied = new Set(d.indistinguishable.flat());
  const isTied = (c) => tied.has(c.effect) || tied.has(siteName(c));
  const entries = [...d.candidates.map((c) => ({name: siteName(c), p: c.probability, tied: isTied(c)})),
                   ...(d.probability_nothing === undefined ? [] : [{name: 'nothing', p: d.probability_nothing}, {name: 'something unknown', p: d.probability_unknown}])]
    .sort((a, b) => b.p - a.p).slice(0, 12);
  const picture = chart('Probabilities of the candidates', 60 + 32 * entries.length, (t) => ({
    type: 'bar',
    data: {labels: entries.map((e) => inLines(e.name)), datasets: [{label: 'probability', data: entries.map((e) => e.p), maxBarThickness: 18, minBarLength: 2,
      backgroundColor: entries.map((e, i) => (e.tied ? t.orange : i === 0 ? t.blue : t.grey))}]},
    options: {indexAxis: 'y', scales: {x: axis('probability', t, {min: 0, max: 1}), y: axis('', t, {grid: {display: false}, ticks: {color: t.text, autoSkip: false}})},
              plugins: {legend: {display: false}, tooltip: labelled('', (item) => item.parsed.x)}},
  }));
  const ties = d.indistinguishable.length ? el('p', {}, el('span', {class: 'swatch', style: {background: 'var(--orange)'}}), 'These data cannot tell apart: ', d.indistinguishable.map((g) => g.join(', ')).join('; '), '.') : null;
  return figure('candidates', 'Candidates', 'Every effect of the catalogue at every place that it has, fitted with all tolerances free, weighed by the evidence. Intervals of those that are not named count tolerances as on the device as given.' +
    (d.missing.length > 1 ? ' Each is fitted alone here; they share the probability of the effects that were found together.' : ''),
    picture, ties, ...(d.splitting ?? []).map((s) => el('p', {}, s.sentence)),
    numbers('candidates', () => ({
      columns: ['candidate', 'probability', 'rmse_mm', 'held_out_rmse_mm', 'chi2_per_dof', 'values with 95 % interval'],
      rows: [...d.candidates.map((c) => [siteName(c), c.probability, c.rmse_mm, c.held_out_rmse_mm, c.chi2_per_dof, valueWords(c.parameters)]),
             ['nothing', d.probability_nothing, d.baseline.rmse_mm, d.baseline.held_out_rmse_mm, d.baseline.chi2_per_dof, ''], ['something unknown', d.probability_unknown, null, null, null, '']],
    }), {open: false}));
}

export function unexplained(d) {
  const {significant, share_of_misfit, pattern, localised = [], nearest, nearest_share} = d.unexplained;
  if (!significant) return null;
  const rows = [...localised.map((l) => [`at this place${l.effect ? ", most like" : ""}: ${l.what}`, l.share, l.probability]),
    ...(nearest ? [[`nearest entry: ${nearest}`, nearest_share, '–']] : [])];
  const columns = ['', 'share', 'probability of the place'];
  return figure('unexplained', 'What is left unexplained', `${num(100 * share_of_misfit, 3)} % of the misfit beyond noise and tolerances: ${pattern}. Of that explains:`,
    table(columns, rows, {shade: (i, j) => (j === 1 ? rows[i][1] : null), show: (x) => (typeof x === 'number' ? num(100 * x, 3) + ' %' : x)}),
    numbers('unexplained', () => ({columns: ['what', ...columns.slice(1)], rows})));
}

export function unseen(d) {
  if (!d.detectable || !d.detectable.length) return null;
  const rows = d.detectable.map((e) => [siteName(e), e.smallest.length ? e.smallest.map((x, i) => `${(e.parameters || [])[i] || ''} ${num(x, 3)}`.trim()).join(', ') : 'none within bounds', e.mistaken_for || '–', e.mistaken_for ? num(e.cosine, 3) : '–']);
  const columns = ['effect', 'smallest size shown', 'would be mistaken for', 'cosine'];
  const holder = el('details', {}, el('summary', {}, `${rows.length} effects and places`), table(columns, rows, {show: String}));
  return figure('unseen', 'What this campaign can see', 'The smallest size of each effect that these readings would show, and what it would be mistaken for.', holder,
    numbers('detectable', () => ({columns, rows: d.detectable.map((e) => [siteName(e), e.smallest, e.mistaken_for, e.cosine])})));
}

export function leftOut(d) {
  const list = d.left_out || [];
  if (!list.length) return null;
  const columns = ['entry of the catalogue', 'why'], rows = list.map((e) => [e.effect, e.why]);
  return figure('left-out', 'What was not looked at', 'Entries that this machine has no place for, or these data nothing to say of.',
    el('details', {}, el('summary', {}, `${rows.length} entries`), table(columns, rows, {show: String})), numbers('left-out', () => ({columns, rows})));
}

export function fall(history, diagnosis) {
  const title = 'The error falling', about = 'What each step takes off the residual; on poses held out (tolerances learnt at the others); what a placebo, the same change with signs drawn by lot, would have reached in its place; what noise and tolerances give.';
  if (history) {
    const names = history.versions.map((v) => v.device);
    const step = (i) => (names[i].startsWith(names[i - 1] + ' + ') ? names[i].slice(names[i - 1].length + 1) : names[i]);
    const steps = history.versions.map((v, i) => ({name: i ? names[i] : 'as given', step: i ? step(i) : '', rmse: um(v.rmse_mm), held: um(v.held_out_rmse_mm), placebo: um(v.placebo_rmse_mm), floor: um(v.noise_floor_mm)}));
    return figure('fall', title, about, waterfall(steps), numbers('history', () => ({
      columns: ['device', 'rmse_mm', 'placebo_rmse_mm', 'held_out_rmse_mm', 'chi2_per_dof', 'noise_floor_mm', 'failing tests', 'patterns left', 'strained tolerances'],
      rows: history.versions.map((v) => [v.device, v.rmse_mm, v.placebo_rmse_mm, v.held_out_rmse_mm, v.chi2_per_dof, v.noise_floor_mm, v.failing_tests.join(' '), v.patterns.join(' '), v.strained_tolerances.length]),
    }), {open: true}));
  }
  const one = (q, name, label) => ({name, step: label, rmse: um(q.rmse_mm), held: um(q.held_out_rmse_mm), placebo: null, floor: um(diagnosis.noise_floor_mm)});
  const steps = [one(diagnosis.baseline, 'as given', '')];
  if (diagnosis.missing.length) steps.push(one(diagnosis.final, 'with what was found', '+ ' + diagnosis.missing.join(' + ')));
  return figure('fall', title, 'What is found takes off the residual; poses held out; the readings’ noise.', waterfall(steps, 'noise of the readings'), numbers('fall', () => ({
    columns: ['state', 'rmse_mm', 'held_out_rmse_mm', 'chi2_per_dof'],
    rows: [['as given', ...Object.values(diagnosis.baseline)], ['with what was found', ...Object.values(diagnosis.final)]],
  }), {open: true}));
}

export function strained(d) {
  const list = d.strained_tolerances || [];
  if (!list.length) return null;
  return figure('strained', 'Tolerances that would have to be strained', 'Beyond two of their declared standard deviations, in these.', table(['tolerance', 'standard deviations'], list.map((t) => [t.name, t.sigmas]), {shade: (i, j) => (j ? Math.abs(list[i].sigmas) / 6 : null)}),
    numbers('strained-tolerances', () => ({columns: ['tolerance', 'sigmas'], rows: list.map((t) => [t.name, t.sigmas])})));
}

const against = (result, words) => (result.theories.length > 1 ? words : '');

export function solved(s) {
  const shown = s.theories.find((t) => t.name === s.reference), K = s[shown.name].stiffness;
  const scale = (i, j) => Math.sqrt(Math.abs(K[i][i] * K[j][j])) || 1;
  const displacement = places.map((name, i) => [`${name} (${i < 3 ? 'mm' : 'rad'})`, ...s.theories.map((t) => s[t.name].displacement[i])]);
  const stiffness = K.map((row, i) => [efforts[i], ...row.map((x, j) => (Math.abs(x) < 1e-10 * scale(i, j) ? 0 : x))]);
  const shares = [...s.shares].sort((a, b) => b.share - a.share);
  const picture = shares.length ? chart('Share of each part in the elastic energy', 60 + 28 * shares.length, (t) => ({
    type: 'bar', data: {labels: shares.map((x) => inLines(x.part)), datasets: [{label: 'share', data: shares.map((x) => 100 * x.share), backgroundColor: t.blue, maxBarThickness: 18, minBarLength: 2}]},
    options: {indexAxis: 'y', scales: {x: axis('% of the elastic energy', t, {min: 0, max: 100}), y: axis('', t, {grid: {display: false}})}, plugins: {legend: {display: false}, tooltip: labelled('%', (item) => item.parsed.x)}},
  })) : null;
  return [
    figure('displacement', s.theories.length === 2 ? 'Displacement by both theories' : 'Displacement', against(s, `They differ by ${num(s.relative_difference, 2)}, relative.`), table(['', ...s.theories.map((t) => t.title)], displacement, {show: (x) => num(x, 7)}),
      numbers('displacement', () => ({columns: ['component', ...s.theories.map((t) => t.name)], rows: displacement}))),
    picture ? figure('shares', 'What yields', 'Share of each part in the elastic energy.', picture, numbers('shares', () => ({columns: ['part', 'share'], rows: shares.map((x) => [x.part, x.share])}))) : null,
    figure('stiffness', 'Stiffness of the tool point', `By ${shown.spoken}, base axes; N/mm, N, Nmm. The stronger the colour, the larger against √(K_ii K_jj).`, table(['', ...places], stiffness, {shade: (i, j) => (j ? Math.abs(stiffness[i][j]) / scale(i, j - 1) : null)}),
      numbers('stiffness', () => ({columns: ['theory', 'effort', ...places], rows: s.theories.flatMap((theory) => s[theory.name].stiffness.map((row, i) => [theory.name, efforts[i], ...row]))}))),
  ];
}

export function validated(v) {
  const points = [...new Set(v.points.map((p) => p.point))], axes = ['x', 'y', 'z'];
  const at = (point, axisName) => v.points.find((p) => p.point === point && p.load_axis === axisName);
  const along = (row, theory) => (row ? 1e3 * row[theory][axes.indexOf(row.load_axis)] : null);
  const looks = [{pointStyle: 'circle', pointRadius: 7, backgroundColor: 'transparent'}, {pointStyle: 'cross', pointRadius: 5}, {pointStyle: 'rect', pointRadius: 5, backgroundColor: 'transparent'}, {pointStyle: 'triangle', pointRadius: 5, backgroundColor: 'transparent'}];
  const picture = chart('Deflection along the load at each point by each theory', 330, (t) => ({
    type: 'line', data: {labels: points.map(String), datasets: axes.flatMap((name, k) => {
      const colour = [t.blue, t.orange, t.green][k];
      return v.theories.map((theory, i) => ({label: `${name}, ${theory.title}`, data: points.map((p) => along(at(p, name), theory.name)), showLine: false, borderColor: colour, borderWidth: 2, ...looks[i % looks.length]}));
    })},
    options: {scales: {x: axis('point', t), y: axis(`µm along ${num(v.points[0].load_N)} N`, t)}, plugins: {legend: {position: 'bottom', labels: {usePointStyle: true}}, tooltip: labelled('µm')}},
  }));
  const validation = figure('validation', v.theories.length === 2 ? 'Two theories at the same points' : 'Deflection at the points', against(v, `Largest relative difference ${num(v.max_relative_difference, 2)}, rms ${num(v.rms_relative_difference, 2)}.`), picture,
    numbers('validation', () => ({
      columns: ['point', 'x_mm', 'y_mm', 'z_mm', 'roll_deg', 'pitch_deg', 'yaw_deg', 'load_axis', 'load_N', ...v.theories.flatMap((t) => places.map((n) => t.name + '_' + n))],
      rows: v.points.map((p) => [p.point, ...p.pose, p.load_axis, p.load_N, ...v.theories.flatMap((t) => p[t.name])]),
    })));
  return v.errata ? [validation, errata(v)] : validation;
}

/** Ratios as printed / corrected as ranges; the stronger the colour, the farther from 1, four decades at most. */
function errata(v) {
  const range = (e, k) => (e.refused ? 'no solution' : e.smallest[k] === e.largest[k] ? num(e.smallest[k], 4) : `${num(e.smallest[k], 4)} … ${num(e.largest[k], 4)}`);
  const away = (e, k) => (e.refused ? 0 : Math.max(...[e.smallest[k], e.largest[k]].map((x) => (x > 0 ? Math.abs(Math.log10(x)) / 4 : 1))));
  return figure('errata', 'Price of the errata', `Deflection along ${num(v.points[0].load_N)} N as printed / corrected, smallest … largest of the points; below 1 the printed equation makes the device too stiff.`,
    table(['erratum', 'equations', 'x', 'y', 'z', 'check that fails'], v.errata.map((e) => [e.erratum, e.equations, ...[0, 1, 2].map((k) => range(e, k)), e.failed_check.split(':')[0]]),
      {shade: (i, j) => (j >= 2 && j <= 4 ? away(v.errata[i], j - 2) : null), show: (x) => x}),
    numbers('errata', () => ({
      columns: ['erratum', ...['x', 'y', 'z'].flatMap((n) => ['ratio_' + n + '_min', 'ratio_' + n + '_max'])],
      rows: v.errata.map((e) => [e.erratum, ...[0, 1, 2].flatMap((k) => (e.refused ? [null, null] : [e.smallest[k], e.largest[k]]))]),
    })));
}

export function mapped(m) {
  const {x_mm, y_mm, z_mm} = m.grid, points = [];
  for (const z of z_mm) for (const y of y_mm) for (const x of x_mm) points.push({label: `pose ${points.length + 1}`, at_mm: [x, y, z]});
  const theory = m.theories[0], values = m.arrays[theory.name];
  const shown = Object.keys(values).filter((k) => /^(stiffness|smallest|largest|isotropy)/.test(k));
  const holder = el('div');
  const draw = (key) => holder.replaceChildren(attempt('The map', () => workspace('map-view', points, [{title: key.replace(/_/g, ' ').replace(' N per mm', ', N/mm'), values: values[key]}], {unit: key === 'isotropy' ? '' : 'N/mm', low: null})));
  draw(shown[0]);
  return figure('map', 'Stiffness over the workspace', `${m.reached} of ${m.poses} poses reached; ${theory.title} theory.`,
    el('label', {}, 'Shown ', el('select', {id: 'map-quantity', onchange: (event) => draw(event.target.value)}, shown.map((key) => el('option', {value: key}, key)))), holder,
    numbers('map', () => ({columns: ['x_mm', 'y_mm', 'z_mm', ...shown], rows: points.map((p, i) => [...p.at_mm, ...shown.map((k) => values[k][i])])}), {most: 60}));
}
