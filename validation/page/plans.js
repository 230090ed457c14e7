// Sections of plans: the readings that tell a tie apart; what a campaign will be able to tell.
import {axis, chart} from './charts.js';
import {el, figure, num, numbers, table} from './dom.js';

export const planHeadline = (p) => ({words: p.readings.length
  ? `${p.readings.length === 1 ? '1 more reading is' : `${p.readings.length} more readings are`} expected to show the right effect with a probability of ${num(p.probability, 3)}.`
  : 'No reading within these limits tells the tied effects apart.'});

const steps = (p) => chart('Expected probability by number of readings', 280, (t) => ({
  type: 'scatter',
  data: {datasets: [{label: 'expected probability', data: p.steps.map((s) => ({x: s.readings, y: s.probability})), showLine: true, borderColor: t.blue, backgroundColor: t.blue, borderWidth: 2, pointRadius: 2.5}]},
  options: {scales: {x: axis('further readings', t, {min: 0}), y: axis('probability of the right effect', t, {min: 0, max: 1})}, plugins: {legend: {display: false}}},
}));

/** A frame stands as it is: its readings have no poses. */
function readingsToTake(all) {
  const stands = all.some((r) => r.at);
  const columns = ['reading', ...(stands ? ['pose', 'at (mm, deg; joints in rad or mm)'] : []), 'load', 'how'];
  return {columns, rows: all.map((r, i) => [i + 1, ...(stands ? [r.pose, r.at] : []), r.load, r.how])};
}

export function planned(p) {
  const {columns, rows: readings} = readingsToTake(p.readings);
  const instrument = ['a further instrument', 'readings enough', 'probability by all', 'its line in the description'];
  const instruments = (p.new_sensors || []).map((n) => [n.name, n.enough.length ? `${n.enough.length}: ${n.enough.slice(0, 4).join(', ')}${n.enough.length > 4 ? ' …' : ''}` : 'more', num(n.probability, 3), n.entry]);
  return [
    figure('plan-rivals', 'Effects that are tied', '', table(['effect', 'probability'], p.rivals.map((r) => [r.effect, r.probability])),
      p.inseparable.map((i) => el('p', {}, `No reading within these limits tells ${i.between.join(' and ')} apart. What would: ${i.instead.join(' ')}`))),
    readings.length ? figure('plan-readings', 'Readings to take', 'In this order, pose by pose; together they are chosen to separate the effects most.', table(columns, readings, {most: 60, show: String}),
      numbers('plan', () => ({columns, rows: readings}))) : null,
    p.steps.length > 1 ? figure('plan-steps', 'What each further reading brings', 'Expected probability of the right effect after so many of them, in this order.', steps(p),
      numbers('plan-steps', () => ({columns: ['readings', 'probability'], rows: p.steps.map((s) => [s.readings, s.probability])}))) : null,
    instruments.length ? figure('plan-instruments', 'Instruments that would help', `Beside the others in these readings${readings.length ? '' : ' (those of the data, taken again)'}: how many of them would be enough and which, and the expected probability by all of them.`,
      table(instrument, instruments, {show: String}), numbers('plan-instruments', () => ({columns: instrument, rows: instruments}))) : null,
  ];
}

export const foresightHeadline = (f) => ({words: `With ${f.campaign}, ${f.given.effects_that_show} effects show within their bounds, and ${f.given.pairs_alike} ${f.given.pairs_alike === 1 ? 'pair of effects looks' : 'pairs of effects look'} alike.`});

/** What the campaign beside the given one is called. */
const otherName = (f) => (f.given_within_limits === false ? 'within the limits' : 'better');

/** Effects by what is mistaken for what: those with the largest chances where there are too many to be drawn. */
function confusions(f, found) {
  if (!f.given.chances || f.given.chances.length < 2) return null;
  const names = f.given.detectable.map((d) => d.effect), most = 40;
  const worst = names.map((_, i) => Math.max(...f.given.chances.flatMap((row, k) => (k === i ? [] : [row[i], f.given.chances[i][k]]))));
  const shown = names.map((_, i) => i).sort((a, b) => worst[b] - worst[a] || a - b).slice(0, most).sort((a, b) => a - b);
  const matrix = (title, chances, named) => {
    const rows = shown.map((i, at) => [named ? `${at + 1} ${names[i]}` : String(at + 1), ...shown.map((k) => (k === i ? null : chances[i][k]))]);
    const words = (x, i, j) => (j === 0 ? x : x === null ? '·' : x >= 0.005 ? String(Math.round(100 * x)) : '');
    const drawn = table([named ? 'present' : '', ...shown.map((_, at) => at + 1)], rows, {show: words, shade: (i, j) => (j && rows[i][j] !== null ? Math.min(1, rows[i][j] / 0.5) : null)});
    drawn.classList.add('matrix');
    return el('div', {}, el('h3', {}, title), drawn);
  };
  const left = names.length > most ? ` The ${most} of ${names.length} with the largest chances.` : '';
  return figure('foresight-confusions', 'What is mistaken for what', `Chance in percent of taking the effect of the column for that of the row, each as large as λ = 8 in ${f.campaign}: 50 where nothing tells them apart, empty below ½.${left}`,
    el('div', {class: 'matrices'}, matrix('this campaign', f.given.chances, true), found ? matrix(otherName(f), f.better.chances, false) : null),
    numbers('foresight-confusions', () => ({columns: ['present', ...names], rows: names.map((n, i) => [n, ...f.given.chances[i]])})));
}

/** What the first so many readings bring. */
function gains(f, found) {
  if (!f.given.gain || !(f.better.gain.length > 1)) return null;
  const precision = f.gain_in === 'um', what = precision ? 'error in use, µm rms' : 'chance of the wrong one';
  const picture = chart(what, 280, (t) => {
    const line = (label, gain, colour) => ({label, data: gain.map((g) => ({x: g.readings, y: g.value})), showLine: true, borderColor: colour, backgroundColor: colour, borderWidth: 2, pointRadius: gain.length > 40 ? 0 : 2});
    return {type: 'scatter', data: {datasets: [...(f.given.gain.length ? [line('this campaign', f.given.gain, t.blue)] : []), ...(found ? [line(otherName(f), f.better.gain, t.orange)] : [])]},
            options: {scales: {x: axis('readings', t, {min: 0}), y: axis(what, t, {min: precision ? 0 : undefined, type: precision ? 'linear' : 'logarithmic'})}, plugins: {legend: {position: 'bottom', labels: {usePointStyle: true}}}}};
  });
  const about = precision ? 'Root mean square error of predictions where the machine is used, once the tolerances are fitted.' : '½ ⟨exp(−λ²/8)⟩ over pairs of effects that remember no earlier loads.';
  return figure('foresight-gain', 'What each further reading brings', about, picture,
    numbers('foresight-gain', () => ({columns: ['campaign', 'readings', f.gain_in], rows: [['given', f.given], ...(found ? [[otherName(f), f.better]] : [])].flatMap(([name, c]) => c.gain.map((g) => [name, g.readings, g.value]))})));
}

/** Where the readings are taken, from above and from the side. */
function stands(f, found) {
  if (!f.given.stands || !f.given.stands.length) return null;
  const campaigns = [['this campaign', f.given, 'blue'], ...(found ? [[otherName(f), f.better, 'orange']] : [])];
  const most = Math.max(...campaigns.flatMap(([, c]) => c.stands.map((s) => s.readings)));
  const view = (i, k) => chart(`Poses, ${'xyz'[i]} and ${'xyz'[k]}`, 300, (t) => ({
    type: 'scatter',
    data: {datasets: campaigns.map(([label, c, colour], at) => ({label, data: c.stands.map((s) => ({x: s.pose_mm_deg[i], y: s.pose_mm_deg[k], s})), borderColor: t[colour], backgroundColor: at ? t[colour] : 'transparent', borderWidth: 2, clip: false,
      pointRadius: c.stands.map((s) => 3 + 7 * Math.sqrt(s.readings / most))}))},
    options: {scales: {x: axis(`${'xyz'[i]} (mm)`, t), y: axis(`${'xyz'[k]} (mm)`, t)}, plugins: {legend: {position: 'bottom', labels: {usePointStyle: true}},
      tooltip: {callbacks: {label: ({raw: {s}}) => `${s.pose}: ${s.pose_mm_deg.map((x) => num(x, 3)).join(', ')}; ${s.readings} readings`}}}},
  }));
  return figure('foresight-stands', 'Where the readings are taken', 'Poses, as large as many readings are taken there; tilts are in the numbers.', el('div', {class: 'pair'}, view(0, 1), view(0, 2)),
    numbers('foresight-stands', () => ({columns: ['campaign', 'pose', 'x_mm', 'y_mm', 'z_mm', 'roll_deg', 'pitch_deg', 'yaw_deg', 'readings'], rows: campaigns.flatMap(([name, c]) => c.stands.map((s) => [name, s.pose, ...s.pose_mm_deg, s.readings]))})));
}

function campaign(f, found) {
  if (!f.readings || !found) return null;
  const {columns, rows} = readingsToTake(f.readings);
  return figure('foresight-readings', f.given_within_limits === false ? 'The campaign within the limits' : 'The better campaign', '', table(columns, rows, {most: 60, show: String}), numbers('better-campaign', () => ({columns, rows})));
}

export function foreseen(f) {
  const found = f.better_found !== false;
  const compared = [['readings', 'readings'], ['poses', 'poses'], ['effects that show within their bounds', 'effects_that_show'], ['pairs of effects alike', 'pairs_alike'],
    ['pairs of effects told apart at λ = 8', 'pairs_told_apart'], ['chance of taking the wrong one of two, mean', 'chance_of_confusion'],
    ['error in use before fitting, µm rms', 'error_before_um'], ['error in use after fitting, µm rms', 'error_after_um'],
    ['O1 (Borm, Menq 1991)', 'O1'], ['O2 (Driels, Pathre 1990)', 'O2'], ['O3 (Nahvi, Hollerbach, Hayward 1994)', 'O3'], ['O4 (Nahvi, Hollerbach 1996)', 'O4'], ['O5 (Sun, Hollerbach 2008)', 'O5'], ['D-gain, nats (Lindley 1956)', 'D_gain']]
    .map(([words, key]) => [words, f.given[key], ...(found ? [f.better[key]] : [])]);
  const zeros = f.given.O1 === 0 || f.better.O1 === 0 ? [el('p', {class: 'about'}, 'O1 to O5 are 0 where some tolerance, or several together, leave no trace in the readings.')] : [];
  const seen = f.given.detectable.map((d) => [d.effect, d.smallest.length ? d.smallest.map((x, i) => `${d.parameters[i]} ${num(x, 3)}`).join(', ') : 'none within bounds', d.mistaken_for || '–', d.mistaken_for ? num(d.cosine, 3) : '–']);
  const columns = ['effect', 'smallest size shown', 'would be mistaken for', 'cosine'];
  return [
    figure('foresight', 'What the campaign will tell', f.given_within_limits === false ? 'It goes beyond the limits. Beside it the best one found within them.' : found ? `Beside a better campaign for ${f.toward}.` : `No better campaign of as many readings was found for ${f.toward}.`,
      table(['', 'this campaign', ...(found ? [otherName(f)] : [])], compared), ...zeros, numbers('foresight', () => ({columns: ['what', 'given', ...(found ? [otherName(f)] : [])], rows: compared}))),
    confusions(f, found),
    gains(f, found),
    stands(f, found),
    campaign(f, found),
    figure('foresight-effects', 'What this campaign can see', 'The smallest size of each effect that these readings would show, and what it would be mistaken for.',
      el('details', {}, el('summary', {}, `${seen.length} effects and places`), table(columns, seen, {show: String})), numbers('foresight-effects', () => ({columns, rows: seen}))),
  ];
}
