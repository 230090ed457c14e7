// The checks of a stiffness from elsewhere.
import {el, figure, num, numbers, table} from './dom.js';

const places = ['ux', 'uy', 'uz', 'thx', 'thy', 'thz'], efforts = ['fx', 'fy', 'fz', 'mx', 'my', 'mz'];

export const checkHeadline = (c) => ({
  words: c.verdict,
  small: [...(c.reference ? [`Against ${c.reference}.`] : []), ...new Set(c.diagnosis.map((d) => `Remedy: ${d.remedy}.`))].join(' '),
});

const bound = (c) => (c.at_least !== undefined && c.at_most !== undefined ? `${num(c.at_least, 3)} … ${num(c.at_most, 3)}` : c.at_most !== undefined ? `≤ ${num(c.at_most, 2)}` : `≥ ${num(c.at_least, 2)}`);

function judged(c) {
  const rows = c.checks.map((k) => [`${k.check.replace(/_/g, ' ')}: ${k.quantity}`, k.measured === undefined ? 'not judged' : k.passes ? 'passes' : 'FAILS', k.measured === undefined ? '–' : num(k.measured, 3), bound(k)]);
  return figure('checks', 'Checks', 'What was measured on the matrix, and the bound that its digits leave to rounding.',
    table(['check', '', 'measured', 'bound'], rows, {shade: (i, j) => (j === 1 && rows[i][1] === 'FAILS' ? 1 : null), show: (x) => x}),
    numbers('checks', () => ({columns: ['check', 'quantity', 'measured', 'at_least', 'at_most', 'passes'], rows: c.checks.map((k) => [k.check, k.quantity, k.measured ?? null, k.at_least ?? null, k.at_most ?? null, String(k.passes)])})));
}

function matrix(c) {
  const scale = (i, j) => Math.sqrt(Math.abs(c.matrix[i][i] * c.matrix[j][j])) || 1;
  return figure('stiffness', 'The matrix', 'As it was read: N/mm, N, Nmm, angles in rad. The stronger the colour, the larger against √(K_ii K_jj).',
    table(['', ...places], c.matrix.map((row, i) => [efforts[i], ...row]), {shade: (i, j) => (j ? Math.abs(c.matrix[i][j - 1]) / scale(i, j - 1) : null)}),
    numbers('matrix', () => ({columns: ['effort', ...places], rows: c.matrix.map((row, i) => [efforts[i], ...row])})));
}

/** What the matrix says of the machine. */
function structure(c) {
  const at = (p) => `T + (${p.map((x) => num(x, 4)).join(', ')}) mm`, rows = [];
  if (c.centre_of_stiffness_mm) rows.push(['centre of stiffness', at(c.centre_of_stiffness_mm)]);
  if (c.centre_of_compliance_mm) rows.push(['centre of compliance', at(c.centre_of_compliance_mm)]);
  (c.principal_translation_N_per_mm || []).forEach((k, i) => rows.push([`stiffness along (${c.principal_axes[i].map((x) => num(x, 3)).join(', ')})`, `${num(k, 5)} N/mm`]));
  (c.principal_rotation_Nmm_per_rad || []).forEach((k, i) => rows.push([`stiffness of rotation ${i + 1} about the centre of stiffness`, `${num(k, 5)} Nmm/rad`]));
  rows.push(['eigenvalues, rotations weighed by ' + num(c.weighing_length_mm, 4) + ' mm', c.eigenvalues_N_per_mm.map((x) => num(x, 4)).join(', ') + ' N/mm']);
  return figure('structure', 'What it says of the machine', null, table(['', ''], rows, {show: (x) => x}), numbers('structure', () => ({columns: ['quantity', 'value'], rows})));
}

export function checked(c) {
  const causes = c.diagnosis.length ? figure('causes', c.diagnosis.length > 1 ? 'What explains the failure: one of these' : 'What explains the failure', null,
    el('ul', {class: 'findings'}, c.diagnosis.map((d) => el('li', {}, `${d.sentence}. `, el('span', {class: 'quiet'}, `Remedy: ${d.remedy}.`))))) : null;
  return [causes, judged(c), matrix(c), structure(c)];
}
