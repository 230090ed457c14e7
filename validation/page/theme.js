// Colours as the style sheet has them in light, in dark and on paper; pictures are drawn again when that changes.

const names = ['page', 'card', 'text', 'quiet', 'line', 'blue', 'pale', 'orange', 'green', 'purple', 'grey', 'guilty', 'metal'];
const redraws = [];

export function theme() {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(names.map((name) => [name, style.getPropertyValue('--' + name).trim()]));
}

export function onTheme(redraw) {
  redraws.push(redraw);
}

function redrawAll() {
  for (const redraw of redraws) redraw();
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redrawAll);
addEventListener('beforeprint', () => {
  document.documentElement.classList.add('paper');
  redrawAll();
});
addEventListener('afterprint', () => {
  document.documentElement.classList.remove('paper');
  redrawAll();
});

const stops = [[76, 120, 200], [96, 166, 190], [214, 184, 70], [232, 134, 48], [196, 44, 26]];

/** From small (0, blue) to large (1, red), for points and for the bar beside them. */
export function colour(level) {
  const x = Math.min(1, Math.max(0, level)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(x));
  return stops[i].map((from, k) => Math.round(from + (x - i) * (stops[i + 1][k] - from)));
}

export const colourBar = `linear-gradient(to right, ${stops.map((s) => `rgb(${s})`).join(', ')})`;
