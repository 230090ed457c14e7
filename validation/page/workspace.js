// Values over the workspace: points in 3D, one picture or several side by side that turn together on one scale.
import * as THREE from 'three';
import {el, num, tooltip} from './dom.js';
import {triad, triadPoints} from './bodies.js';
import {stage, view} from './stage.js';
import {colour, colourBar, theme} from './theme.js';

function disc() {
  const canvas = el('canvas', {width: 64, height: 64}), pen = canvas.getContext('2d');
  pen.fillStyle = '#fff';
  pen.arc(32, 32, 30, 0, 7);
  pen.fill();
  return new THREE.CanvasTexture(canvas);
}

/** `maps`: [{title, values}] beside `points` [{at_mm, label}]; null values are left out. `unit` and `times` for words. */
export function workspace(id, points, maps, {unit, times = 1, low = 0} = {}) {
  const at = points.map((p) => new THREE.Vector3(...p.at_mm));
  const box = new THREE.Box3().setFromPoints(at);
  box.expandByScalar(Math.max(1, 0.06 * box.getSize(new THREE.Vector3()).length()));
  const letters = 0.22 * box.getSize(new THREE.Vector3()).length();
  const all = maps.flatMap((m) => m.values).filter((x) => x !== null);
  const bottom = low === null ? Math.min(...all) : low, top = Math.max(...all, bottom + 1e-15);
  const one = maps.length === 1;
  const holder = el('div', {class: one ? 'maps one' : 'maps', id});
  const cells = maps.map((m) => el('div', {class: 'cell'}, m.title));
  holder.append(...cells);
  const scenes = maps.map((map) => {
    const scene = new THREE.Scene();
    const kept = at.map((p, i) => i).filter((i) => map.values[i] !== null);
    const geometry = new THREE.BufferGeometry().setFromPoints(kept.map((i) => at[i]));
    const colours = kept.flatMap((i) => colour((map.values[i] - bottom) / (top - bottom)).map((c) => c / 255));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
    const size = points.length > 2000 ? 5 : points.length > 300 ? 8 : one ? 16 : 13;
    scene.add(new THREE.Points(geometry, new THREE.PointsMaterial({size, sizeAttenuation: false, vertexColors: THREE.VertexColors, map: disc(), alphaTest: 0.5})));
    const frame = new THREE.Box3Helper(box, 0x888888);
    scene.add(frame, triad(box.min, letters));
    return {scene, frame, kept};
  });
  let rectangles = [];
  const shot = stage(holder, maps.map((m) => m.title).join('; '), (renderer, width, height) => {
    const origin = holder.getBoundingClientRect();
    renderer.setScissorTest(false);
    renderer.clear();
    renderer.setScissorTest(true);
    rectangles = cells.map((cell) => {
      const r = cell.getBoundingClientRect();
      return {x: r.left - origin.left, y: r.top - origin.top, w: r.width, h: r.height};
    });
    scenes.forEach(({scene, frame}, i) => {
      const {x, y, w, h} = rectangles[i];
      frame.material.color.set(theme().quiet);
      looking.fit(w, h);
      renderer.setViewport(x, height - y - h, w, h);
      renderer.setScissor(x, height - y - h, w, h);
      renderer.render(scene, looking.camera);
    });
  });
  const ends = el('div', {class: 'bar-ends'}, el('span', {}, num(bottom * times) + ' ' + unit), el('span', {}, num(top * times) + ' ' + unit));
  const whole = el('div', {}, holder, el('div', {class: 'bar', style: {background: colourBar, marginTop: '.5rem'}}), ends);
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => new THREE.Vector3(...['x', 'y', 'z'].map((name, k) => (i & (1 << k) ? box.max : box.min)[name])));
  const looking = view([...corners, ...triadPoints(box.min, letters)], shot.canvas, () => shot.ask());
  looking.buttons.style.marginTop = '.4rem';
  looking.buttons.style.display = 'flex';
  looking.buttons.style.gap = '.3rem';
  whole.append(looking.buttons);
  shot.canvas.addEventListener('pointermove', (event) => {
    const r = shot.canvas.getBoundingClientRect(), x = event.clientX - r.left, y = event.clientY - r.top;
    const which = rectangles.findIndex((c) => x >= c.x && x <= c.x + c.w && y >= c.y && y <= c.y + c.h);
    if (which < 0) return tooltip(event, '');
    const c = rectangles[which];
    let nearest = null, distance = 16;
    for (const i of scenes[which].kept) {
      const p = at[i].clone().project(looking.camera);
      const d = Math.hypot(c.x + (p.x + 1) / 2 * c.w - x, c.y + (1 - p.y) / 2 * c.h - y);
      if (d < distance) distance = d, nearest = i;
    }
    tooltip(event, nearest === null ? '' : `${points[nearest].label}\n(${points[nearest].at_mm.map((v) => num(v)).join(', ')}) mm\n${num(times * maps[which].values[nearest])} ${unit}`);
  });
  shot.canvas.addEventListener('pointerleave', (event) => tooltip(event, ''));
  return whole;
}
