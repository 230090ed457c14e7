// Sections of plans: the readings that tell a tie apart; what a campaign will be able to tell.
import {el, figure, num, numbers, table} from './dom.js';

export const planHeadline = (p) => ({words: p.readings.length
  ? `${p.readings.length} more readings are expected to show the right effect with a probability of ${num(p.probability, 3)}.`
  : 'No reading within these limits tells the tied effects apart.'});

export function planned(p) {
  const readings = p.readings.map((r, i) => [i + 1, r.pose, r.at, r.load, r.how]);
  const columns = ['reading', 'pose', 'at (mm, deg; joints in rad or mm)', 'load', 'how'];
  return [
    figure('plan-rivals', 'Effects that are tied', '', table(['effect', 'probability'], p.rivals.map((r) => [r.effect, r.probability])),
      p.inseparable.map((i) => el('p', {}, `No reading within these limits tells ${i.between.join(' and ')} apart. What would: ${i.instead.join(' ')}`))),
    readings.length ? figure('plan-readings', 'Readings to take', 'In this order; each is chosen to separate the effects most.', table(columns, readings, {most: 60, show: String}),
      numbers('plan', () => ({columns, rows: readings}))) : null,
    p.steps.length > 1 ? figure('plan-steps', 'What they bring', 'Expected probability of the right effect after so many readings.', table(['readings', 'probability'], p.steps.map((s) => [s.readings, s.probability]), {most: 60}),
      numbers('plan-steps', () => ({columns: ['readings', 'probability'], rows: p.steps.map((s) => [s.readings, s.probability])}))) : null,
  ];
}

export const foresightHeadline = (f) => ({words: `With ${f.campaign}, ${f.given.effects_that_show} effects show within their bounds, and ${f.given.pairs_alike} pairs of effects look alike.`});

export function foreseen(f) {
  const compared = [['readings', 'readings'], ['poses', 'poses'], ['effects that show within their bounds', 'effects_that_show'], ['pairs of effects alike', 'pairs_alike'],
    ['error in use before fitting, µm rms', 'error_before_um'], ['error in use after fitting, µm rms', 'error_after_um'], ['D-gain, nats', 'D_gain']]
    .map(([words, key]) => [words, f.given[key], f.better[key]]);
  const seen = f.given.detectable.map((d) => [d.effect, d.smallest.length ? d.smallest.map((x, i) => `${d.parameters[i]} ${num(x, 3)}`).join(', ') : 'none within bounds', d.mistaken_for || '–', d.mistaken_for ? num(d.cosine, 3) : '–']);
  const columns = ['effect', 'smallest size shown', 'would be mistaken for', 'cosine'];
  return [
    figure('foresight', 'What the campaign will tell', `Beside a better campaign for ${f.toward}.`, table(['', 'this campaign', 'better'], compared), numbers('foresight', () => ({columns: ['what', 'given', 'better'], rows: compared}))),
    figure('foresight-effects', 'What this campaign can see', 'The smallest size of each effect that these readings would show, and what it would be mistaken for.',
      el('details', {}, el('summary', {}, `${seen.length} effects and places`), table(columns, seen, {show: String})), numbers('foresight-effects', () => ({columns, rows: seen}))),
  ];
}
