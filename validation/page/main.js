// The page from its data: what was found in a sentence, then pictures, each with its numbers, then how it was made.
import {download, el, figure, fileName, micro, num, numbers, table} from './dom.js';
import {drawingVerdict, drawn} from './drawing.js';
import {loadWords, machine} from './machine.js';
import {curves, errorHeat, failureMap, findings, residuals, testHeat} from './measured.js';
import {candidates, diagnosisVerdict, fall, leftOut, mapped, solved, strained, unexplained, unseen, validated} from './results.js';

const data = JSON.parse(document.getElementById('data').textContent);
const page = document.getElementById('page');
const of = (kind) => data.results.filter((r) => r.kind === kind).map((r) => r.result);

function verdict() {
  const [diagnosis] = of('diagnosis'), [comparison] = of('comparison'), [history] = of('history'), [solve] = of('solve'), [validation] = of('validation'), [map] = of('map'), [drawing] = of('drawing');
  if (diagnosis) return diagnosisVerdict(diagnosis);
  if (comparison) return comparison.verdict;
  if (history) {
    const first = history.versions[0], last = history.versions[history.versions.length - 1];
    return `From ${first.device} to ${last.device} the error goes from ${micro(first.rmse_mm)} to ${micro(last.rmse_mm)} rms; noise and tolerances give ${micro(last.noise_floor_mm)}.`;
  }
  if (solve) return `Under ${loadWords(solve.load)} the tool point moves by ${micro(Math.hypot(...solve.msa.displacement.slice(0, 3)))}; both theories agree to ${num(solve.relative_difference, 2)}.`;
  if (drawing) return drawingVerdict(drawing);
  if (validation) return `Both theories agree to ${num(validation.max_relative_difference, 2)} at ${new Set(validation.points.map((p) => p.point)).size} points.`;
  return map ? `Stiffness at ${map.reached} of ${map.poses} poses.` : '';
}

function facts() {
  const list = [], add = (name, value) => value !== undefined && value !== null && list.push(el('div', {}, el('dt', {}, name), el('dd', {}, value)));
  const [diagnosis] = of('diagnosis'), [comparison] = of('comparison').concat(data.versions.map((v) => v.result));
  if (comparison) add('readings', String(comparison.readings)), add('poses', String(comparison.poses)), add('χ² per degree of freedom', num(comparison.baseline.chi2_per_dof, 3));
  if (diagnosis) add('χ² with what was found', num(diagnosis.final.chi2_per_dof, 3)), add('chance of such a finding', diagnosis.chance_of_any === undefined ? null : num(diagnosis.chance_of_any, 2));
  return list.length ? el('dl', {class: 'facts'}, list) : null;
}

/** What the coloured parts are: in them the last version of the device differs from the first. */
function guilt() {
  const [diagnosis] = of('diagnosis');
  if (!diagnosis) return 'Here the last version differs from the first';
  return {ambiguous: 'The best of the tied candidates acts here', unknown_effect: 'What was explained acts here'}[diagnosis.verdict] || 'What is missing acts here';
}

function machineFigure() {
  const version = data.versions[0];
  const moves = () => ({
    columns: ['pose', 'x_mm', 'y_mm', 'z_mm', 'fx_N', 'fy_N', 'fz_N', 'mx_Nmm', 'my_Nmm', 'mz_Nmm', 'ux_mm', 'uy_mm', 'uz_mm'],
    rows: data.scene.poses.flatMap((p) => p.shapes.map((s) => [p.label, ...p.pose_mm_deg.slice(0, 3), ...s.load_N_Nmm, ...s.displacement_mm[data.scene.tool]])),
  });
  const outside = of('diagnosis').flatMap((d) => d.found || []).filter((f) => f.site === 'rig');
  const left = version && version.poses.length > data.scene.poses.length ? ` The ${data.scene.poses.length} of ${version.poses.length} poses where the residual is largest.` : '';
  return figure('machine', 'The machine', `Drag to turn, scroll or pinch to zoom.${left}`, machine(data.scene, version, guilt()).element, outside.length ? el('p', {}, `Not in the machine but in the rig: ${outside.map((f) => f.effect).join(', ')}.`) : null, numbers('tool-displacement', moves));
}

function source() {
  const block = (title, file) => (file ? el('div', {}, el('h3', {}, `${title}: ${file.name}`),
    file.text === null ? el('p', {class: 'quiet'}, `${file.bytes} bytes, not held in this page.`)
      : el('div', {class: 'with-csv'}, el('details', {}, el('summary', {}, `${file.bytes} bytes`), el('pre', {}, file.text)),
           el('button', {type: 'button', class: 'csv', 'data-name': file.name, onclick: () => download(file.name, file.text, 'text/plain')}, 'Save'))) : null);
  return figure('source', 'To repeat it', `deflect ${data.version}, ${data.made_with}.`,
    el('p', {}, el('code', {}, data.command)), block('Device', data.device), block('Measurements', data.data),
    data.results.map((r) => el('div', {class: 'with-csv'}, el('span', {}, `Result of ${fileName(r.origin)} (${r.kind})`),
      el('button', {type: 'button', class: 'csv', 'data-name': r.kind + '.json', onclick: () => download(r.kind + '.json', JSON.stringify(r.result, null, 2), 'application/json')}, 'JSON'))));
}

function sections() {
  const [diagnosis] = of('diagnosis'), [history] = of('history'), versions = data.versions;
  const comparisons = of('comparison');
  const first = versions[0], last = versions[versions.length - 1];
  return [
    data.scene ? machineFigure() : null,
    first ? failureMap(first) : null,
    diagnosis ? [candidates(diagnosis), unexplained(diagnosis)] : null,
    history || diagnosis ? fall(history, diagnosis) : null,
    comparisons.map(findings),
    first ? [curves(versions), testHeat(versions), errorHeat(first), residuals(first, 0), versions.length > 1 ? residuals(last, 1) : null]
          : comparisons.map((c) => [testHeat([{device: c.device, result: c}]), errorHeat({device: c.device, result: c, unit: 'mm'})]),
    of('drawing').map(drawn), of('solve').map(solved), of('validation').map(validated), of('map').map(mapped),
    diagnosis ? [strained(diagnosis), unseen(diagnosis), leftOut(diagnosis)] : null,
    source(),
  ].flat(3).filter(Boolean);
}

const title = [data.device?.name.replace(/\.yaml$/, ''), data.data?.name].filter(Boolean).join(' against ') || data.results.map((r) => fileName(r.origin)).join(', ');
document.title = title + ' – deflect';
page.append(el('header', {class: 'card'}, el('h1', {}, title), el('p', {class: 'verdict', id: 'verdict'}, verdict()), facts()), ...sections());
requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = String(Math.round(performance.now())); }));
