// A frame under its load cases: displacements, reactions, forces in members, shares of the energy.
import {axis, chart, inLines, labelled} from './charts.js';
import {el, figure, num, numbers} from './dom.js';

const displacements = ['ux_mm', 'uy_mm', 'uz_mm', 'rx_rad', 'ry_rad', 'rz_rad'], forces = ['fx_N', 'fy_N', 'fz_N', 'mx_Nmm', 'my_Nmm', 'mz_Nmm'];
const inMember = ['N_N', 'Vy_N', 'Vz_N', 'T_Nmm', 'My_Nmm', 'Mz_Nmm'];

const size = (d) => Math.hypot(d.ux_mm, d.uy_mm, d.uz_mm);
const largest = (list, of) => list.reduce((best, each) => (best === null || of(each) > of(best) ? each : best), null);

export function frameHeadline(f) {
  const cases = Object.entries(f.cases).map(([name, c]) => ({name, at: largest(c.displacements, size)})).filter((c) => c.at);
  const worst = largest(cases, (c) => size(c.at));
  if (!worst) return {words: 'The frame has no nodes to move.'};
  return {words: `The frame moves by ${num(size(worst.at))} mm at most${cases.length > 1 ? ` under the worst of its ${cases.length} load cases` : ''}; all checks hold.`,
          small: `At node ${worst.at.node} under load case ${worst.name}; ${f.geometry} geometry.`};
}

/** Rows of a list in every load case; "–" where a freedom is free. */
const rowsOf = (f, list, key, columns, of = (each, column) => each[column]) =>
  Object.entries(f.cases).flatMap(([name, c]) => c[list].map((each) => [name, each[key], ...columns.map((column) => of(each, column) ?? null)]));

function listed(f, id, title, about, list, key, columns, of) {
  const rows = rowsOf(f, list, key, columns, of), open = rows.length <= 24;
  if (!rows.length) return null;
  const left = Object.values(f.cases).reduce((n, c) => n + ((c.left_out || {})[list] || 0), 0);
  return figure(id, title, about + (left ? ` ${left} more rows are not in this page; --out writes them all.` : ''),
    numbers(id, () => ({columns: ['load case', key, ...columns.map((c) => c.replace('.', ' '))], rows}), {open}));
}

function shares(f) {
  return Object.entries(f.cases).map(([name, c], i) => {
    const parts = [...c.shares].sort((a, b) => b.share - a.share).slice(0, 20);
    if (!parts.length || !c.energy_Nmm) return null;
    return figure('shares-' + i, `What yields: load case ${name}`, `Share of each section or spring in the elastic energy, ${num(c.energy_Nmm)} Nmm.`,
      chart('Share in the elastic energy under ' + name, 60 + 28 * parts.length, (t) => ({
        type: 'bar', data: {labels: parts.map((x) => inLines(x.part)), datasets: [{label: 'share', data: parts.map((x) => 100 * x.share), backgroundColor: t.blue, maxBarThickness: 18, minBarLength: 2}]},
        options: {indexAxis: 'y', scales: {x: axis('% of the elastic energy', t, {min: 0, max: 100}), y: axis('', t, {grid: {display: false}})}, plugins: {legend: {display: false}, tooltip: labelled('%', (item) => item.parsed.x)}},
      })), numbers('shares-' + i, () => ({columns: ['part', 'share'], rows: parts.map((x) => [x.part, x.share])})));
  });
}

export function framed(f) {
  const ends = inMember.flatMap((name) => ['start.' + name, 'end.' + name]);
  const at = (member, column) => (column.includes('.') ? member[column.split('.')[0]][column.split('.')[1]] : member[column]);
  return [
    listed(f, 'displacements', 'Displacements of nodes', 'Base axes.', 'displacements', 'node', displacements),
    listed(f, 'reactions', 'Reactions', 'On the frame, base axes; empty where the support leaves a freedom free.', 'reactions', 'node', forces),
    listed(f, 'members', 'Forces in members', 'In member axes: at the start what the member does to the node, at the end what the node does to it.', 'members', 'member', ['largest_My_Nmm', 'largest_Mz_Nmm', ...ends], at),
    ...shares(f),
    f.notes.length ? figure('notes', 'Notes', null, el('ul', {class: 'findings'}, f.notes.map((n) => el('li', {}, n)))) : null,
  ];
}
