// Validation in the words of the standards, fits and predictions.
import {axis, chart} from './charts.js';
import {el, figure, fineOf, num, numbers, table} from './dom.js';

export const validityHeadline = (v) => ({words: v.sentence, small: `Validation of ${v.device}.`});
export const fitHeadline = (f) => ({words: `${f.parameters.length} parameter${f.parameters.length === 1 ? '' : 's'} of ${f.device} fitted to ${f.data}.`, small: f.warnings.join(' ')});
export const predictionHeadline = (p) => ({words: `${p.numbers.length} readings of ${p.device} predicted, with 95 % intervals.`});

const chance = (p) => (p < 1e-16 ? '< 1e−16' : num(p, 2));
const range = (low, high, unit) => `${num(low)} … ${num(high)}${unit ? ' ' + unit : ''}`;

/** Errors and their uncertainty by quantity, in the fine unit of each. */
function errors(v) {
  const columns = ['quantity', 'n', 'mean E', 'rms E', 'u_num', 'u_input', 'u_D', 'u_val', 'within 2 u_val', 'p', 'area', 'bias δ', 'scatter σ_M'];
  const rows = v.channels.map((c) => {
    const [unit, per] = fineOf(c.unit), sizes = ['mean_E', 'rms_E', 'u_num', 'u_input', 'u_D', 'u_val'].map((key) => num(per * c[key], 3));
    return [`${c.name} (${unit})`, c.numbers, ...sizes, `${num(100 * c.within_2_u_val, 3)} %`, chance(c.agreement.p_value), num(c.area, 2), c.bias ? num(c.bias.factor) : '–', c.bias ? `${c.bias.scatter_from_experiment ? '≤ ' : ''}${num(100 * c.bias.scatter, 2)} %` : '–'];
  });
  return figure('validation-errors', 'Comparison errors and validation uncertainty', `All together: χ² = ${num(v.agreement.chi2)} of ${v.agreement.numbers} numbers, p = ${chance(v.agreement.p_value)}.`,
    table(columns, rows), el('ul', {class: 'quiet'}, v.formulas.map((f) => el('li', {}, f))),
    numbers('validation-errors', () => ({columns: ['name', 'unit', ...columns.slice(1, 8), 'within_2_u_val', 'p_value', 'area', 'bias', 'scatter'],
      rows: v.channels.map((c) => [c.name, c.unit, c.numbers, c.mean_E, c.rms_E, c.u_num, c.u_input, c.u_D, c.u_val, c.within_2_u_val, c.agreement.p_value, c.area, c.bias?.factor, c.bias?.scatter])})));
}

function pooled(v) {
  const steps = [{x: 0, y: 0}];
  for (const {u, F} of v.u) steps.push({x: u, y: steps[steps.length - 1].y}, {x: u, y: F});
  steps.push({x: 1, y: 1});
  const picture = chart('Distribution functions of u-pooling', 300, (t) => ({
    type: 'scatter',
    data: {datasets: [{label: 'measurements', data: steps, showLine: true, pointRadius: 0, borderColor: t.blue, borderWidth: 2},
                      {label: 'a right model', data: [{x: 0, y: 0}, {x: 1, y: 1}], showLine: true, pointRadius: 0, borderColor: t.orange, borderDash: [6, 4], borderWidth: 2}]},
    options: {scales: {x: axis('u = F(D), the prediction’s distribution function at the measurement', t, {min: 0, max: 1}), y: axis('share of the measurements', t, {min: 0, max: 1})}},
  }));
  return figure('validation-area', 'Area metric', `Area between both distribution functions: ${num(v.area, 3)}; a right model with independent errors has ${num(v.expected_area, 3)} on average, the worst has 0.5.`,
    picture, numbers('validation-area', () => ({columns: ['u', 'F'], rows: v.u.map((p) => [p.u, p.F])})));
}

function domain(v) {
  const used = v.use !== undefined;
  const rows = v.domain.map((r) => [r.name, range(r.low, r.high, r.unit), ...(used ? [range(r.use_low, r.use_high, r.unit), r.outside ? 'outside' : 'within'] : [])]);
  const parts = [table(['variable', 'validated', ...(used ? ['used', ''] : [])], rows)];
  if (used) {
    const columns = ['line', 'reading', 'predicted', '95 % interval', 'where'];
    const of = (n) => { const [unit, per] = fineOf(n.unit); return [n.line, n.channel, `${num(per * n.value)} ${unit}`, range(per * n.low95, per * n.high95, unit), n.where]; };
    const outside = v.use.points.filter((p) => !p.inside).length;
    parts.push(el('p', {}, `${outside} of ${v.use.points.length} points of use are outside the domain of validation.`), table(columns, v.use.numbers.map(of), {most: 40}),
      numbers('use', () => ({columns: ['line', 'channel', 'unit', 'value', 'low95', 'high95', 'where'], rows: v.use.numbers.map((n) => [n.line, n.channel, n.unit, n.value, n.low95, n.high95, n.where])})));
  }
  return figure('validation-domain', used ? 'Domain of validation and of use' : 'Domain of validation', '', parts);
}

function robustness(v) {
  const changes = v.without.filter((w) => w.changes);
  const parts = [changes.length ? table(['left out', 'readings', 'p'], changes.map((w) => [`${w.kind} ${w.name}`, w.readings, chance(w.p_value)]))
    : el('p', {}, `The verdict stays the same without any one of ${v.without.length} poses, load directions and sessions.`)];
  if (v.same.length) parts.push(el('p', {}, 'Whether a parameter is the same everywhere (p-value):'), table(['parameter', 'at every', 'groups', 'p'], v.same.map((s) => [s.parameter, s.kind, s.groups, chance(s.p_value)])));
  if (v.calibration) parts.push(el('p', {}, `Calibration data, kept apart: ${v.calibration.data}, ${v.calibration.readings} readings; rms E ${num(fineOf(v.calibration.unit)[1] * v.calibration.rms_E, 3)} ${fineOf(v.calibration.unit)[0]} there, ${num(fineOf(v.calibration.unit)[1] * v.calibration.validation_rms_E, 3)} here.`));
  return figure('validation-robustness', changes.length ? 'The verdict changes without a group of readings' : 'What the verdict hangs on', '', parts,
    numbers('without', () => ({columns: ['kind', 'name', 'readings', 'p_value', 'changes'], rows: v.without.map((w) => [w.kind, w.name, w.readings, w.p_value, w.changes ? 1 : 0])})));
}

/** What the run knows; the level is for a person to write by hand. */
function maturity(v) {
  const rows = v.maturity.map((m) => [`${m.scheme}: ${m.element}`, m.known, '']);
  return figure('validation-maturity', 'Maturity', 'PCMM (SAND2007-5948) and NASA-STD-7009. Known is what this run knows; the level is for a person to judge.', table(['element', 'known', 'level, by whom'], rows));
}

export const validity = (v) => [errors(v), pooled(v), domain(v), robustness(v), maturity(v)];

export function fitted(f) {
  const rows = f.parameters.map((p) => [p.path, `${num(p.before)} ${p.unit}`, `${num(p.value, 6)} (${num(p.low95, 6)} … ${num(p.high95, 6)}) ${p.unit}`, p.prior ? `${num(p.prior.mean)} ± ${num(p.prior.deviation, 2)} ${p.unit}` : 'none']);
  return figure('fit', 'Fitted parameters', '', table(['parameter', 'was', 'fitted (95 %)', 'prior'], rows),
    f.undetermined.length ? el('p', {}, 'Not determined by these data: ', f.undetermined.map((u) => u.sentence).join('; '), '.') : null,
    numbers('fit', () => ({columns: ['path', 'unit', 'before', 'value', 'low95', 'high95'], rows: f.parameters.map((p) => [p.path, p.unit, p.before, p.value, p.low95, p.high95])})));
}

export function predicted(p) {
  const shares = ['parameters', 'tolerances', 'load', 'discrepancy', 'noise'];
  const rows = p.numbers.map((n) => [`${n.pose}, line ${n.line}: ${n.channel}`, `${num(n.value, 5)} ${n.unit}`, range(n.low95, n.high95, n.unit), ...shares.map((s) => n.deviation[s])]);
  return figure('prediction', 'Predicted readings', 'With the standard deviations that make up each interval.', table(['reading', 'predicted', '95 % interval', ...shares], rows, {most: 60}),
    numbers('prediction', () => ({columns: ['line', 'pose', 'channel', 'unit', 'value', 'low95', 'high95', ...shares], rows: p.numbers.map((n) => [n.line, n.pose, n.channel, n.unit, n.value, n.low95, n.high95, ...shares.map((s) => n.deviation[s])])})));
}
