// The page from its data: what was found in a sentence, then pictures, each with its numbers, then how it was made.
import {checked, checkHeadline} from './checks.js';
import {attempt, download, el, figure, fileName, micro, num, numbers, sized, table} from './dom.js';
import {drawingHeadline, drawn} from './drawing.js';
import {frameHeadline, framed} from './frames.js';
import {loadWords, machine} from './machine.js';
import {curves, errorHeat, failureMap, findings, residuals, testHeat} from './measured.js';
import {foreseen, foresightHeadline, planHeadline, planned} from './plans.js';
import {fitHeadline, fitted, predicted, predictionHeadline, validity, validityHeadline} from './validity.js';
import {candidates, diagnosisHeadline, fall, leftOut, mapped, solved, strained, unexplained, unseen, validated} from './results.js';

const data = JSON.parse(document.getElementById('data').textContent);
const page = document.getElementById('page');
const of = (kind) => data.results.filter((r) => r.kind === kind).map((r) => r.result);

function historyHeadline(history) {
  const first = history.versions[0], last = history.versions[history.versions.length - 1], falls = last.rmse_mm <= first.rmse_mm;
  return {words: `The error ${falls ? 'falls' : 'rises'} from ${sized(first.rmse_mm, history.unit)} to ${sized(last.rmse_mm, history.unit)} rms; noise and tolerances alone give ${sized(last.noise_floor_mm, history.unit)}.`,
          small: `From ${first.device} to ${last.device}.`};
}

function solveHeadline(solve) {
  return {words: `The tool point moves by ${micro(Math.hypot(...solve[solve.reference].displacement.slice(0, 3)))} under ${loadWords(solve.load)}${solve.theories.length > 1 ? `; ${solve.theories.length === 2 ? 'both' : 'the'} theories agree to ${num(solve.relative_difference, 2)}, relative` : ''}.`};
}

/** What was found: `words` that a person reads, and in small the ids and values that belong to them. */
function headline() {
  const kinds = [['validity', validityHeadline], ['fit', fitHeadline], ['prediction', predictionHeadline], ['diagnosis', diagnosisHeadline], ['plan', planHeadline], ['foresight', foresightHeadline], ['comparison', (c) => ({words: c.verdict})], ['history', historyHeadline], ['solve', solveHeadline], ['check', checkHeadline], ['frame', frameHeadline], ['drawing', drawingHeadline],
    ['validation', (v) => ({words: `Both theories agree to ${num(v.max_relative_difference, 2)}, relative, at ${new Set(v.points.map((p) => p.point)).size} points.`})],
    ['map', (m) => ({words: `The stiffness is known at ${m.reached} of ${m.poses} poses of the workspace${m.max_relative_difference === undefined ? '' : `; both theories agree to ${num(m.max_relative_difference, 2)}, relative`}.`})]];
  for (const [kind, words] of kinds) if (of(kind).length) return words(of(kind)[0]);
  return {words: ''};
}

function facts() {
  const list = [], add = (name, value) => value !== undefined && value !== null && list.push(el('div', {}, el('dt', {}, name), el('dd', {}, value)));
  const [diagnosis] = of('diagnosis'), [comparison] = of('comparison').concat(data.versions.map((v) => v.result));
  if (comparison) add('readings', String(comparison.readings)), data.scene?.kind !== 'frame' && add('poses', String(comparison.poses)), add('χ² per degree of freedom', num((diagnosis ?? comparison).baseline.chi2_per_dof, 3));
  if (diagnosis) add('χ² with what was found', num(diagnosis.final.chi2_per_dof, 3)), add('chance of such a finding', diagnosis.chance_of_any === undefined ? null : num(diagnosis.chance_of_any, 2));
  return list.length ? el('dl', {class: 'facts'}, list) : null;
}

/** What the coloured parts are: in them the last version of the device differs from the first. */
function guilt() {
  const [diagnosis] = of('diagnosis');
  if (!diagnosis) return 'Here the last version differs from the first';
  return {ambiguous: 'The best of the tied candidates acts here', unknown_effect: 'What was explained acts here'}[diagnosis.verdict] || 'What is missing acts here';
}

const listed = {members: 'member', supports: 'support', springs: 'spring', sensors: 'sensor', loads: 'load', nodes: 'node'};
/** "member C2b", "start of beam_1", "support B", "node P1d": as the scene of a frame calls the parts of a place. */
const partsOf = ({path, also = []}) => [path, ...also].map((p) => p.split('.')).filter(([list]) => listed[list])
  .map(([list, name, end]) => (list === 'members' && (end === 'start' || end === 'end') ? `${end} of ${name}` : `${listed[list]} ${name}`));

const unmarked = (names) => [...new Set(names)].filter((name) => !data.scene.guilty.includes(name));

/** Parts of a frame in which what is tied with the best candidate acts. */
function tiedParts() {
  const rivals = of('diagnosis').flatMap((d) => d.ties || []).flatMap((t) => t.rivals).flatMap((r) => r.effects).filter((e) => e.place);
  return unmarked(rivals.flatMap((e) => partsOf(e.place)));
}

/** Parts in which something unknown may act, and those of them that no effect marks; of a machine these are marked. */
function suspects() {
  const places = of('diagnosis').filter((d) => d.unexplained?.significant).flatMap((d) => d.unexplained.localised || []).map((l) => l.place);
  if (data.scene.kind === 'frame') return {all: [...new Set(places.flatMap(partsOf))], free: unmarked(places.flatMap(partsOf))};
  const parts = [...data.scene.bodies, ...data.scene.joints], all = new Set(), free = new Set();
  for (const {part, leg} of places) {
    const [, name, end] = part.match(/^(.*?)(?:\.(start|end))?$/);
    for (const each of parts.filter((p) => (name === p.part || name.endsWith('.' + p.part)) && (!leg || p.leg === `leg ${leg}`))) {
      const ofMember = end && !leg;
      const words = ofMember ? `${end} of ${each.part}` : (leg ? `leg ${leg} ` : '') + each.part;
      all.add(words);
      if (each.guilty) continue;
      free.add(words);
      if (!ofMember) each.tied = true;
    }
  }
  return {all: [...all], free: [...free]};
}

function machineFigure() {
  const unknown = suspects();
  data.scene.tied = unknown.free.length ? unknown.free : data.scene.kind === 'frame' ? tiedParts() : [];
  if (unknown.free.length) Object.assign(data.scene, {tiedWords: unknown.all.length > 1 ? 'Something unknown acts at one of these' : 'Something unknown acts here', tiedNames: unknown.all});
  for (const foot of data.scene.kind === 'frame' ? data.scene.ground : []) foot.tied = data.scene.tied.includes(foot.name);
  const nodes = data.scene.kind === 'frame' ? data.scene.nodes : {};
  for (const part of data.scene.tied.filter((name) => name.startsWith('node ') && name.slice(5) in nodes)) data.scene.joints.push({leg: '', part, point: nodes[part.slice(5)], driven: false, guilty: false, tied: true});
  if (data.scene.kind === 'frame' && data.versions.length) return figure('machine', 'The frame under its loads', 'Drag to turn, scroll or pinch to zoom. Arrows with names: sensors.', attempt('The frame', () => machine(data.scene, data.versions[0], guilt())));
  if (data.scene.kind === 'frame') return figure('machine', 'The frame under its loads', 'Drag to turn, scroll or pinch to zoom.', attempt('The frame', () => machine(data.scene, null, '')));
  const version = data.versions[0];
  const moves = () => ({
    columns: ['pose', 'x_mm', 'y_mm', 'z_mm', 'fx_N', 'fy_N', 'fz_N', 'mx_Nmm', 'my_Nmm', 'mz_Nmm', 'ux_mm', 'uy_mm', 'uz_mm'],
    rows: data.scene.poses.flatMap((p) => p.shapes.map((s) => [p.label, ...p.pose_mm_deg.slice(0, 3), ...s.load_N_Nmm, ...s.displacement_mm[data.scene.tool]])),
  });
  const outside = of('diagnosis').flatMap((d) => d.found || []).filter((f) => f.site === 'rig');
  const left = version && version.poses.length > data.scene.poses.length ? ` The ${data.scene.poses.length} of ${version.poses.length} poses where the residual is largest.` : '';
  return figure('machine', 'The machine', `Drag to turn, scroll or pinch to zoom.${left}`, attempt('The machine', () => machine(data.scene, version, guilt())), outside.length ? el('p', {}, `Not in the machine but in the rig: ${outside.map((f) => f.effect).join(', ')}.`) : null, numbers('tool-displacement', moves));
}

/** A browser does not turn thousands of members smoothly. */
function notDrawn(frame) {
  const [first] = Object.values(frame.cases), members = first ? first.members.length + ((first.left_out || {}).members || 0) : 0;
  return members > 3000 ? figure('machine', 'The frame under its loads', `${members} members are too many to be drawn here (at most 3000). deflect frame with --out writes the frame for ParaView.`) : null;
}

function source() {
  const block = (title, file) => (file ? el('div', {}, el('h3', {}, `${title}: ${file.name}`),
    file.text === null ? el('p', {class: 'quiet'}, `${file.bytes} bytes, not held in this page.`)
      : el('div', {class: 'with-csv'}, el('details', {}, el('summary', {}, `${file.bytes} bytes`), el('pre', {}, file.text)),
           el('button', {type: 'button', class: 'csv', 'data-name': file.name, onclick: () => download(file.name, file.text, 'text/plain')}, 'Save'))) : null);
  return figure('source', 'To repeat it', `deflect ${data.version}, ${data.made_with}.`,
    el('p', {}, el('code', {}, data.command)), block(of('check').length ? 'Matrix' : of('frame').length || data.scene?.kind === 'frame' ? 'Frame' : 'Device', data.device), block('Measurements', data.data),
    data.results.map((r) => el('div', {class: 'with-csv'}, el('span', {}, `Result of ${fileName(r.origin)} (${r.kind})`),
      el('button', {type: 'button', class: 'csv', 'data-name': r.kind + '.json', onclick: () => download(r.kind + '.json', JSON.stringify(r.result, null, 2), 'application/json')}, 'JSON'))));
}

/** Each a section of the page by its name; one that fails leaves the others alone. */
function sections() {
  const [diagnosis] = of('diagnosis'), [history] = of('history'), versions = data.versions;
  const comparisons = of('comparison');
  const first = versions[0], last = versions[versions.length - 1];
  const all = [
    ['The machine', () => (data.scene ? machineFigure() : of('frame').map(notDrawn))],
    ['Where it fails', () => (first ? failureMap(first) : null)],
    ['Candidates', () => diagnosis && candidates(diagnosis)],
    ['What is left unexplained', () => diagnosis && unexplained(diagnosis)],
    ['The error falling', () => (history || diagnosis ? fall(history, diagnosis) : null)],
    ['What the residual holds', () => comparisons.map(findings)],
    ['Force–elongation', () => first && curves(versions)],
    ['Tests of the residual', () => (first ? testHeat(versions) : comparisons.map((c) => testHeat([{device: c.device, result: c}])))],
    ['Errors by group', () => (first ? errorHeat(first) : comparisons.map((c) => errorHeat({device: c.device, result: c, unit: 'mm'})))],
    ['Residuals', () => first && residuals(first, 0)],
    ['Residuals of the last version', () => versions.length > 1 && residuals(last, 1)],
    ...[['The drawing', 'drawing', drawn], ['The displacement', 'solve', solved], ['The frame', 'frame', framed], ['The checks', 'check', checked], ['Validity', 'validity', validity], ['The fit', 'fit', fitted], ['The prediction', 'prediction', predicted], ['The plan', 'plan', planned], ['The campaign', 'foresight', foreseen], ['The validation', 'validation', validated], ['The map', 'map', mapped]]
      .flatMap(([name, kind, make]) => data.results.filter((r) => r.kind === kind)
        .map((r, _, alike) => [name, () => [alike.length > 1 ? el('p', {class: 'from'}, `From ${fileName(r.origin)}:`) : null, make(r.result)]])),
    ['Strained tolerances', () => diagnosis && strained(diagnosis)],
    ['What this campaign can see', () => diagnosis && unseen(diagnosis)],
    ['What was not looked at', () => diagnosis && leftOut(diagnosis)],
    ['To repeat it', source],
  ];
  return all.map(([name, make]) => attempt(name, make)).flat(3).filter(Boolean).map((part) => (part.tagName === 'P' ? el('section', {class: 'card'}, part) : part));
}

function head() {
  const subject = [data.device?.name.replace(/\.yaml$/, ''), data.data?.name].filter(Boolean).join(' against ') || data.results.map((r) => fileName(r.origin)).join(', ');
  document.title = subject + ' – deflect';
  const {words, small} = headline();
  return el('header', {class: 'card'}, el('h1', {class: 'verdict', id: 'verdict'}, words), small ? el('p', {class: 'quiet', id: 'verdict-ids'}, small) : null, el('p', {class: 'quiet', id: 'subject'}, subject), attempt('The facts', facts));
}

page.append(attempt('The head of the page', head), ...sections());
requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = String(Math.round(performance.now())); }));
