// Sections of a comparison with measurements: where it fails, tests, residuals, force–elongation curves.
import {axis, chart, labelled} from './charts.js';
import {attempt, el, figure, fineOf, num, numbers, sized, table} from './dom.js';
import {workspace} from './workspace.js';

const components = ['ux_mm', 'uy_mm', 'uz_mm', 'thx_rad', 'thy_rad', 'thz_rad'];
const loads = ['fx_N', 'fy_N', 'fz_N', 'mx_Nmm', 'my_Nmm', 'mz_Nmm'];
/** The members called mm hold numbers in the unit of the result: where only rotations were measured mrad, of forces N. */
const unitOf = (version) => version.result.unit;
const strength = (p) => (p === null || p === undefined ? null : Math.min(16, -Math.log10(Math.max(p, 1e-16))) / 16);
const pWords = (p) => (p === null || p === undefined ? '–' : p < 1e-16 ? '< 1e-16' : num(p, 2));

export function failureMap(version) {
  if (version.channels) return null;
  const [unit, times] = fineOf(version.unit);
  const maps = [{title: 'measured − predicted', values: version.poses.map((p) => p.rmse)},
                ...[0, 1, 2].map((k) => ({title: `nothing missing, draw ${k + 1}`, values: version.poses.map((p) => p.with_nothing_missing[k])}))];
  return figure('failure', 'Where it fails',
    `Root mean square of the residual at each pose, beside three draws of what noise, tolerances and loads give with nothing missing; one colour scale. Predicted by ${version.device}.`,
    attempt('The map', () => workspace('failure-map', version.poses, maps, {unit, times})),
    numbers('residual-by-pose', () => ({
      columns: ['pose', 'x_mm', 'y_mm', 'z_mm', `rms_${version.unit}`, 'mean_x', 'mean_y', 'mean_z', 'draw_1', 'draw_2', 'draw_3'],
      rows: version.poses.map((p) => [p.label, ...p.at_mm, p.rmse, ...p.bias, ...p.with_nothing_missing]),
    })));
}

/** Tests and patterns against versions: how surprising each is, and its size. */
export function testHeat(versions) {
  const kinds = [['tests', 'test', 'question'], ['patterns', 'pattern', 'title']];
  const rows = [], levels = [], cells = [], unit = unitOf(versions[0]);
  for (const [list, id, words] of kinds) {
    const ids = [...new Set(versions.flatMap((v) => v.result[list].map((t) => t[id])))];
    for (const name of ids) {
      const entries = versions.map((v) => v.result[list].find((t) => t[id] === name));
      const first = entries.find(Boolean);
      rows.push([`${name}: ${first[words]}`, ...entries.map((t) => (!t ? '–' : t.p_value === undefined ? 'not asked' : `${sized(t.size_mm, unit)}, p ${pWords(t.p_value)}`))]);
      levels.push([null, ...entries.map((t) => (t ? strength(t.p_value) : null))]);
      cells.push([name, list === 'tests' ? 'test' : 'pattern', ...entries.flatMap((t) => [t?.size_mm ?? null, t?.p_value ?? null])]);
    }
  }
  return figure('tests', 'Tests of the residual',
    'Questions that need no idea of what is missing, then patterns that a residual can have: size of what is seen and how likely chance is to do as much. The stronger the colour, the less likely.',
    table(['', ...versions.map((v) => v.device)], rows, {shade: (i, j) => levels[i][j], show: String}),
    numbers('tests', () => ({columns: ['name', 'kind', ...versions.flatMap((v, i) => [`size_mm_${i}`, `p_value_${i}`])], rows: cells})));
}

export function errorHeat(version) {
  const groups = Object.entries(version.result.errors).flatMap(([by, list]) => list.map((e) => [by.replace('by_', ''), e]));
  const same = groups.filter(([, e]) => (e.unit || unitOf(version)) === unitOf(version));
  const unit = fineOf(unitOf(version))[0];
  const worst = Math.max(...same.map(([, e]) => e.worst_mm)), largest = Math.max(...same.map(([, e]) => e.rmse_mm));
  // Without a tool point there are no axes to take means along.
  const axes = groups.some(([, e]) => e.bias_mm.some((x) => x !== 0)) ? ['mean x', 'mean y', 'mean z'] : [];
  const worstAt = 2 + axes.length, lineAt = worstAt + 1;
  const rows = groups.map(([by, e]) => [by === 'pose' ? e.group : `${by}: ${e.group}`, e.rmse_mm, ...(axes.length ? e.bias_mm : []), e.worst_mm, e.worst_line]);
  return figure('errors', 'Errors by group', `Root mean square${axes.length ? ', mean by axis' : ''} and worst of measured − predicted by ${version.device}, ${unit}.`,
    table(['group', 'rms', ...axes, 'worst', 'in line'], rows, {
      shade: (i, j) => (j === 0 || j === lineAt || !same.includes(groups[i]) ? null : Math.abs(rows[i][j]) / (j === worstAt ? worst : largest)),
      show: (x, i, j) => (j === 0 || j === lineAt ? String(x) : same.includes(groups[i]) ? num(fineOf(unitOf(version))[1] * x) : sized(x, groups[i][1].unit)),
    }),
    numbers('errors-by-group', () => ({columns: ['by', 'group', 'readings', 'rmse_mm', 'mean_x_mm', 'mean_y_mm', 'mean_z_mm', 'worst_mm', 'worst_line'],
      rows: groups.map(([by, e]) => [by, e.group, e.readings, e.rmse_mm, ...e.bias_mm, e.worst_mm, e.worst_line])})));
}

/** Of a frame: each number as a multiple of the standard deviation that noise and tolerances give it. */
function channelResiduals(version, index) {
  const sequence = version.readings.every((r) => r.sequence !== null), x = (r, i) => (sequence ? r.sequence : i);
  const left = version.readings_left_out ? ` The first ${version.readings.length} readings; ${version.readings_left_out} more are left out.` : '';
  const picture = chart('Residuals channel by channel', 360, (t) => {
    const colours = [t.blue, t.orange, t.green, t.purple, t.pale, t.grey], ranks = version.readings.map(x), first = Math.min(...ranks), last = Math.max(...ranks);
    const edge = (y, more) => ({type: 'line', label: 'two deviations', data: [{x: first, y}, {x: last, y}], borderColor: t.grey, borderDash: [5, 4], borderWidth: 1.5, pointRadius: 0, ...more});
    return {
      type: 'scatter',
      data: {datasets: [
        ...version.channels.map((c, k) => ({label: c.name, pointRadius: 2.4, backgroundColor: colours[k % colours.length], borderWidth: 0, pointStyle: ['circle', 'triangle', 'rect'][Math.floor(k / colours.length) % 3],
          data: version.readings.map((r, i) => ({x: x(r, i), y: r.sensors && r.sensors[c.name] && c.deviation > 0 ? r.sensors[c.name].residual / c.deviation : null, i})).filter((p) => p.y !== null)})),
        edge(2, {}), edge(-2, {})]},
      options: {
        scales: {x: axis(sequence ? 'in the order taken' : 'in the order of the file', t, {min: first, max: last}), y: axis('standard deviations', t)},
        plugins: {legend: {position: 'bottom', labels: {usePointStyle: true, filter: (item) => item.datasetIndex <= version.channels.length}}, tooltip: {callbacks: {label: (item) => {
          const r = version.readings[item.raw.i], of = r && r.sensors && r.sensors[item.dataset.label];
          return of ? `${item.dataset.label} ${num(of.residual)} ${of.unit}, line ${r.line}` : `${num(item.parsed.y)}`;
        }}}},
      },
    };
  });
  const names = version.channels.map((c) => c.name), loads = [...new Set(version.readings.flatMap((r) => Object.keys(r.loads || {})))];
  return figure('residuals-' + index, 'Residuals channel by channel', `Measured − predicted by ${version.device}, each in standard deviations of what noise and tolerances give with nothing missing.${left}`, picture,
    numbers('readings-' + index, () => ({
      columns: ['line', 'sequence', ...loads, ...version.channels.flatMap((c) => [`measured_${c.name}_${c.unit}`, `residual_${c.name}_${c.unit}`]), ...version.note_columns],
      rows: version.readings.map((r) => [r.line, r.sequence, ...loads.map((l) => (r.loads || {})[l] ?? 0), ...names.flatMap((n) => [r.sensors?.[n]?.measured ?? null, r.sensors?.[n]?.residual ?? null]), ...(r.notes || [])]),
    })));
}

export function residuals(version, index) {
  if (version.channels) return channelResiduals(version, index);
  const rotation = version.unit === 'rad', from = rotation ? 3 : 0, times = rotation ? 1e6 : 1e3, unit = rotation ? 'µrad' : 'µm';
  const sequence = version.readings.every((r) => r.sequence !== null);
  const x = (r, i) => (sequence ? r.sequence : i);
  const band = rotation ? null : 2e3 * version.result.noise_floor_mm;
  const left = version.readings_left_out ? ` The first ${version.readings.length} readings; ${version.readings_left_out} more are left out.` : '';
  const picture = chart('Residuals reading by reading', 320, (t) => {
    const ranks = version.readings.map(x), first = Math.min(...ranks), last = Math.max(...ranks);
    const edge = (sign, more) => ({type: 'line', label: 'two deviations of noise and tolerances', data: [{x: first, y: sign * band}, {x: last, y: sign * band}], borderColor: t.grey, borderDash: [5, 4], borderWidth: 1.5, pointRadius: 0, ...more});
    return {
      type: 'scatter',
      data: {datasets: [
        ...['x', 'y', 'z'].map((name, k) => ({label: 'Δ' + name, pointRadius: 2.2, backgroundColor: [t.blue, t.orange, t.green][k], borderWidth: 0, data: version.readings.map((r, i) => ({x: x(r, i), y: r.residual[from + k] === null ? null : times * r.residual[from + k], i})).filter((p) => p.y !== null)})),
        ...(band ? [edge(1, {}), edge(-1, {})] : [])]},
      options: {
        scales: {x: axis(sequence ? 'in the order taken' : 'in the order of the file', t, {min: first, max: last}), y: axis(unit, t)},
        plugins: {legend: {position: 'bottom', labels: {usePointStyle: true, filter: (item, data) => item.datasetIndex < 4}}, tooltip: {callbacks: {label: (item) => {
          const r = version.readings[item.raw.i];
          return r ? `${item.dataset.label} ${num(item.parsed.y)} ${unit}, line ${r.line}, pose ${version.poses[r.pose].label}` : `${num(item.parsed.y)} ${unit}`;
        }}}},
      },
    };
  });
  return figure('residuals-' + index, 'Residuals reading by reading', `Measured − predicted by ${version.device}.${left}`, picture,
    numbers('readings-' + index, () => ({
      columns: ['line', 'pose', 'sequence', ...loads, ...components.map((c) => 'measured_' + c), ...components.map((c) => 'predicted_' + c), ...components.map((c) => 'residual_' + c), ...version.note_columns],
      rows: version.readings.map((r) => [r.line, version.poses[r.pose].label, r.sequence, ...r.load_N_Nmm, ...r.measured, ...r.predicted, ...r.residual, ...(r.notes || [])]),
    })));
}

export function curves(versions) {
  const first = versions[0], last = versions[versions.length - 1];
  if (!first.curves.length) return null;
  const cells = first.curves.map((curve) => {
    const unit = curve.rotation ? ['Nmm', 'mrad'] : ['N', 'µm'];
    const after = versions.length > 1 ? last.curves.find((c) => c.site === curve.site) : null;
    const picture = chart(`Force–elongation of ${curve.site}`, 220, (t) => {
      const line = (c, label, colour, band) => {
        const points = (sign) => c.force.map((f, i) => ({x: f, y: 1e3 * (c.elongation[i] + sign * c.deviation[i])}));
        return [{label, data: points(0), borderColor: colour, backgroundColor: colour, borderWidth: 2, pointRadius: 2},
                {label: '+σ', data: points(1), borderWidth: 0, pointRadius: 0, fill: '+1', backgroundColor: band},
                {label: '−σ', data: points(-1), borderWidth: 0, pointRadius: 0}];
      };
      return {
        type: 'line',
        data: {datasets: [...line(curve, 'as given', t.blue, t.pale + '66'), ...(after ? line(after, 'with what was found', t.guilty, t.guilty + '33') : [])]},
        options: {
          parsing: false, interaction: {mode: 'nearest', intersect: false},
          scales: {x: axis(curve.rotation ? 'moment (Nmm)' : 'force (N)', t, {type: 'linear'}), y: axis(unit[1], t)},
          plugins: {legend: {display: false},
                    tooltip: {filter: (item) => item.datasetIndex % 3 === 0, callbacks: {...labelled(unit[1]).callbacks, title: (items) => (items.length ? `${num(items[0].parsed.x)} ${unit[0]}` : '')}}},
        },
      };
    });
    return el('div', {}, el('h3', {}, curve.site), picture);
  });
  return figure('curves', 'Force–elongation of the sites, beyond the model’s',
    'Read off the residuals without a law: a slope is a compliance, a step at zero free travel, one unlike its fellows a damaged part. The band is one standard deviation; flat at zero means that nothing is missing there.',
    versions.length > 1 ? el('p', {}, el('span', {class: 'swatch', style: {background: 'var(--blue)'}}), 'as given ', el('span', {class: 'swatch', style: {background: 'var(--guilty)'}}), 'with what was found') : null,
    el('div', {class: 'grid'}, cells),
    numbers('force-elongation', () => ({
      columns: ['version', 'site', 'force', 'elongation', 'deviation', 'units'],
      rows: versions.flatMap((v) => v.curves.flatMap((c) => c.force.map((f, i) => [v.device, c.site, f, c.elongation[i], c.deviation[i], c.rotation ? 'Nmm rad' : 'N mm']))),
    })));
}

export function findings(result) {
  const unit = result.unit;
  if (!result.findings.length && !result.looks_like.length) return null;
  return figure('findings', 'What the residual holds', null,
    el('ul', {class: 'findings'}, result.looks_like.map((s) => el('li', {}, s)), result.findings.map((f) => el('li', {}, `${f.sentence}. `,
      el('span', {class: 'quiet'}, `${sized(f.size_mm, unit)} rms, ${num(100 * f.share_of_misfit, 3)} % of the misfit beyond noise, p ${pWords(f.p_value)}${f.instead.length ? '; nearly as well: ' + f.instead.join(', ') : ''}`)))));
}
