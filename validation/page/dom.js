// Elements, numbers, tables, downloads. Text always becomes text nodes, never markup.

export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === undefined || value === null) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (name === 'style') Object.assign(node.style, value);
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return node;
}

/** Four digits for reading; "–" for what is not there. */
export function num(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return '–';
  if (typeof x !== 'number') return String(x);
  if (x === 0) return '0';
  const size = Math.abs(x);
  const text = size >= 1e5 || size < 1e-3 ? x.toExponential(digits - 1).replace(/\.?0*e\+?/, 'e') : String(Number(x.toPrecision(digits)));
  return text.replace(/-/g, '−');
}

export const um = (mm) => (mm === null || mm === undefined ? null : 1e3 * mm);
export const micro = (mm) => num(um(mm)) + ' µm';
/** The unit in which errors are read, and how many of it are in one of the unit of the data. */
export const fineOf = (unit) => ({mm: ['µm', 1e3], mrad: ['µrad', 1e3], rad: ['µrad', 1e6], um_per_m: ['µm/m', 1]}[unit] || [unit || 'µm', unit ? 1 : 1e3]);
export const sized = (x, unit) => `${num(fineOf(unit)[1] * x)} ${fineOf(unit)[0]}`;
export const fileName = (path) => path.split('/').pop();

function csvCell(value) {
  if (value === null || value === undefined) return '';
  const text = Array.isArray(value) ? value.join(' ') : String(value);
  return /[",\n\r]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
}

export function csv(columns, rows) {
  return [columns, ...rows].map((row) => row.map(csvCell).join(',')).join('\n') + '\n';
}

export function download(name, text, type = 'text/csv') {
  const url = URL.createObjectURL(new Blob([text], {type: type + ';charset=utf-8'}));
  const link = el('a', {href: url, download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/**
 * A table as it is read; `shade(row, column)` gives a cell's background, 0 … 1, or nothing. Long tables show their first
 * rows and say so; the CSV has them all.
 */
export function table(columns, rows, {shade = () => null, most = 200, show = (x) => num(x)} = {}) {
  const isText = columns.map((_, j) => rows.some((row) => typeof row[j] === 'string' && row[j].length > 40));
  const body = rows.slice(0, most).map((row, i) =>
    el('tr', {}, row.map((value, j) => {
      const level = shade(i, j);
      const cell = el(j === 0 ? 'th' : 'td', j === 0 ? {scope: 'row'} : {}, show(value, i, j));
      if (typeof value === 'number') cell.title = String(value);
      if (isText[j]) cell.classList.add('text');
      if (level !== null && level !== undefined) cell.style.setProperty('--level', String(Math.min(1, Math.max(0, level))));
      if (level !== null && level !== undefined) cell.classList.add('level');
      return cell;
    })));
  const head = el('thead', {}, el('tr', {}, columns.map((name, j) => el('th', isText[j] ? {scope: 'col', class: 'text'} : {scope: 'col'}, name))));
  const whole = el('div', {class: 'scroll'}, el('table', {}, head, el('tbody', {}, body)));
  if (rows.length <= most) return whole;
  return el('div', {}, whole, el('p', {class: 'quiet'}, `${rows.length - most} more rows are in the CSV.`));
}

/** The numbers behind a picture: a table that opens, and its CSV. `make()` → {columns, rows}. */
export function numbers(name, make, options = {}) {
  const holder = el('div');
  const details = el('details', {class: 'numbers'}, el('summary', {}, 'Numbers'), holder);
  let shown = false;
  const fill = () => {
    if (shown) return;
    shown = true;
    holder.append(attempt('The table', () => {
      const {columns, rows} = make();
      return table(columns, rows, options);
    }));
  };
  details.addEventListener('toggle', () => details.open && fill());
  if (options.open) {
    details.open = true;
    fill();
  }
  const save = el('button', {type: 'button', class: 'csv', 'data-name': name + '.csv', onclick: () => {
    const failed = attempt('The table', () => {
      const {columns, rows} = make();
      download(name + '.csv', csv(columns, rows));
    });
    if (failed) holder.replaceChildren(failed), details.open = true;
  }}, 'CSV');
  return el('div', {class: 'with-csv'}, details, save);
}

/** A picture with a title, a sentence and the numbers behind it. */
export function figure(id, title, about, ...children) {
  return el('section', {id, class: 'card'}, el('h2', {}, title), about ? el('p', {class: 'about'}, about) : null, children);
}

/** What stands in the place of a picture that could not be drawn. */
export function missing(what, error) {
  return el('p', {class: 'missing', role: 'note'}, `${what} could not be drawn: ${error.message || error}. Nothing else on this page depends on it.`);
}

/** What `make` gives, or where it fails a sentence that says so: one picture less, and the page goes on. */
export function attempt(what, make) {
  try {
    return make();
  } catch (error) {
    return missing(what, error);
  }
}

let tip = null;
/** A small note beside the pointer; nothing hides it. */
export function tooltip(event, text) {
  if (!tip) document.body.append(tip = el('div', {class: 'tip', role: 'status'}));
  tip.hidden = !text;
  if (!text) return;
  tip.textContent = text;
  tip.style.left = Math.min(event.clientX + 14, window.innerWidth - tip.offsetWidth - 8) + 'px';
  tip.style.top = Math.min(event.clientY + 14, window.innerHeight - tip.offsetHeight - 8) + 'px';
}
