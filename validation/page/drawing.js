// The machine as its file draws it: members with their sections and axes, joints, frames of reference, names and lengths;
// where it cannot stand, the motions that nothing resists, moving.
import * as THREE from 'three';
import {groundUnder, label, lit, loadArrow, piece, put, shapes, vector} from './bodies.js';
import {attempt, el, figure, num, numbers, tooltip} from './dom.js';
import {stage, standpoint, view} from './stage.js';
import {onTheme, theme} from './theme.js';

const axisNames = ['x', 'y', 'z'], axisColours = [0xd14b4b, 0x3f9b54, 0x4c7fd1];

/** The verdict in words, then the names and numbers that belong to it. */
export const drawingHeadline = (d) => {
  const what = d.drawing === 'frame' ? 'The frame' : 'The machine', count = (n, one) => `${n} ${one}${n === 1 ? '' : 's'}`;
  if (d.motions.length) return {words: `${what} as drawn cannot stand: nothing resists ${count(d.motions.length, 'motion')}.`, small: d.motions.map((m) => m.words).join('; ')};
  if (d.trouble) return {words: `${what} as drawn does not go together.`, small: d.trouble + '.'};
  if (d.drawing === 'frame') return {words: `The frame as drawn has ${count(d.frames.length, 'node')} and ${count(d.members.length, 'member')}.`};
  const driven = d.driven.map((q) => `${q.name} ${num(q.value)} ${q.unit}`).join(', ');
  return {words: `The machine as drawn, unloaded, has ${count(d.members.length, 'member')} and ${count(d.joints.length, 'joint')}; ${d.driven.length || 'none'} of its motions ${d.driven.length === 1 ? 'is' : 'are'} driven.`, small: driven && `Driven: ${driven}.`};
};

function triadAt(at, axes, length, which = [0, 1, 2]) {
  const group = new THREE.Group();
  for (const i of which) {
    const arrow = new THREE.ArrowHelper(vector(axes[i]).normalize(), vector(at), length, axisColours[i], 0.25 * length, 0.12 * length);
    for (const part of [arrow.line, arrow.cone]) part.material.depthTest = false, part.renderOrder = 1;
    group.add(arrow);
  }
  return group;
}

/** Every point that the camera shows: both ends of every motion, widths of members, tips of axes. */
function inView(d, rest, size, box, more) {
  const points = [...rest, ...more];
  for (const motion of d.motions) motion.displacement_mm.forEach((u, i) => points.push(rest[i].clone().add(vector(u)), rest[i].clone().sub(vector(u))));
  for (const m of d.members)
    for (const p of [m.start_mm, m.end_mm])
      for (const [y, z] of [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]]) points.push(vector(p).addScaledVector(vector(m.axes[1]), y * m.size_mm[0]).addScaledVector(vector(m.axes[2]), z * m.size_mm[1]));
  const frames = d.drawing === 'frame' ? [{at_mm: box.min.toArray(), axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}] : d.frames;
  for (const f of frames) for (const axis of f.axes) points.push(vector(f.at_mm).addScaledVector(vector(axis), 0.12 * size));
  return points;
}

function picture(d) {
  const box = new THREE.Box3();
  for (const p of d.points_mm) box.expandByPoint(vector(p));
  const bare = box.getSize(new THREE.Vector3());
  for (const m of d.members) {
    const half = Math.max(...m.size_mm) / 2;
    for (const p of [m.start_mm, m.end_mm]) box.union(new THREE.Box3().setFromCenterAndSize(vector(p), new THREE.Vector3(half, half, half)));
  }
  const size = Math.max(1e-6, box.getSize(new THREE.Vector3()).length()), thin = 0.0028 * size;
  const root = lit(), materials = {};
  for (const name of ['metal', 'pale', 'quiet', 'blue', 'orange', 'guilty']) materials[name] = new THREE.MeshLambertMaterial();
  Object.assign(materials.metal, {transparent: true, opacity: 0.6, depthWrite: false});  // joints and axes are seen inside
  const rest = d.points_mm.map(vector);
  const hits = [];

  // A piece between two points; members as wide as their sections, turned into their axes.
  const pieces = d.lines.map(([a, b, m]) => {
    const member = m < 0 ? null : d.members[m];
    const [y, z] = member ? member.size_mm.map((s) => Math.max(s, thin)) : [0.7 * thin, 0.7 * thin];
    const mesh = piece(a, b, [y, z], member && !member.round, materials[member ? 'metal' : 'quiet'],
      member ? `${name(member)}: ${member.section}, ${member.material}, ${num(member.length_mm, 5)} mm` : 'rigid');
    mesh.userData.side = member && !member.round ? vector(member.axes[1]) : null;
    root.add(mesh);
    hits.push(mesh);
    return mesh;
  });
  const thickest = Math.max(thin, ...d.members.map((m) => Math.min(0.03 * size, Math.max(...m.size_mm) / 2)));
  for (const joint of d.joints) {
    const moving = [0, 1, 2, 3, 4, 5].filter((i) => joint.freedoms[i] !== 'r');
    const mesh = new THREE.Mesh(joint.driven ? shapes.block : shapes.ball, materials[joint.driven ? 'orange' : 'pale']);
    mesh.scale.setScalar(joint.driven ? 2.6 * Math.max(thickest, 2 * thin) : 1.3 * Math.max(thickest, 2 * thin));
    mesh.position.copy(vector(joint.at_mm));
    mesh.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(...joint.axes.map(vector)));
    mesh.userData = {words: `${[joint.leg, joint.part].filter(Boolean).join(' ')}: ${joint.words}`};
    root.add(mesh);
    hits.push(mesh);
    // The axis that it turns about or slides along.
    for (const i of moving) {
      const axis = vector(joint.axes[i % 3]).multiplyScalar(0.05 * size), at = vector(joint.at_mm);
      const line = new THREE.Line(new THREE.BufferGeometry().setFromPoints([at.clone().sub(axis), at.add(axis)]), new THREE.LineBasicMaterial({color: axisColours[i % 3]}));
      root.add(line);
    }
  }
  const layers = {sections: new THREE.Group(), names: new THREE.Group(), frames: new THREE.Group()};
  Object.values(layers).forEach((layer) => root.add(layer));
  for (const m of d.members) layers.sections.add(triadAt(m.start_mm.map((x, i) => (x + m.end_mm[i]) / 2), m.axes, 0.05 * size, [1, 2]));
  for (const f of d.drawing === 'frame' ? [{at_mm: box.min.toArray(), axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}] : d.frames) layers.frames.add(triadAt(f.at_mm, f.axes, 0.11 * size));
  const held = d.frames.filter((f) => f.held).map((f) => ({at_mm: f.at_mm, words: `${f.name}: ${f.held} held`, whole: f.held.split(' ').length === 6}));
  const ground = groundUnder(held, false, box.getCenter(new THREE.Vector3()), size, standpoint(box).up);
  root.add(ground.group);
  hits.push(...ground.meshes);
  const said = new Set();
  const tag = (words, at) => {
    if (said.has(words)) return;
    said.add(words);
    const sprite = label(words, 0.026 * size);
    sprite.position.copy(vector(at));
    layers.names.add(sprite);
  };
  for (const m of d.members) tag(`${m.part} ${num(m.length_mm, 4)} mm`, m.start_mm.map((x, i) => (x + m.end_mm[i]) / 2));
  for (const j of d.joints) tag(j.part + (j.driven ? ' (driven)' : ''), j.at_mm);
  for (const f of d.frames) tag(f.name, f.at_mm);
  for (const i of d.instruments) {
    tag(i.name, i.at_mm);
    if (i.axis) layers.frames.add(loadArrow(vector(i.at_mm), {vector: i.axis, kind: i.words.startsWith('rotation') ? 'moment' : 'line'}, 0.08 * size, materials.blue, true, 0.028 * size));
  }

  const holder = el('div', {class: 'view', id: 'machine-view'});
  const shot = stage(holder, 'The machine as drawn, in 3D', (renderer, width, height) => {
    const t = theme();
    for (const [key, material] of Object.entries(materials)) material.color.set(t[key] || t.quiet);
    looking.fit(width, height);
    renderer.render(root, looking.camera);
  });
  const {from, up} = standpoint(box), right = new THREE.Vector3().crossVectors(up, from).normalize();
  const ends = layers.names.children.map((sprite) => sprite.position.clone().addScaledVector(right, sprite.scale.x).addScaledVector(up, sprite.scale.y));
  const looking = view([...inView(d, rest, size, box, ground.points), ...ends], shot.canvas, shot.ask);
  holder.append(looking.buttons, el('div', {class: 'measures'}, looking.scale));

  const readout = el('p', {class: 'quiet', id: 'machine-readout', 'aria-live': 'polite'});
  const state = {motion: d.motions.length ? 0 : -1, phase: 1, moving: d.motions.length > 0};
  const update = () => {
    const motion = d.motions[state.motion], amplitude = state.phase;
    const at = rest.map((p, i) => (motion ? p.clone().addScaledVector(vector(motion.displacement_mm[i]), amplitude) : p));
    for (const each of pieces) put(each, at[each.userData.a], at[each.userData.b], each.userData.side);
    shot.ask();
  };
  const say = () => { readout.textContent = state.motion < 0 ? d.trouble : `${d.motions[state.motion].words}. Drawn as large as a tenth of the machine; a motion without any load.`; };
  // The motion goes to and fro where the page is seen and the reader did not ask for stillness.
  const still = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
  const start = performance.now();
  const swing = (now) => {
    if (!state.moving) return;
    state.phase = Math.sin((now - start) / 600);
    update();
    requestAnimationFrame(swing);
  };
  const slider = d.motions.length ? el('input', {type: 'range', id: 'scale-slider', min: -1, max: 1, step: 0.05, value: 1, oninput: (event) => {
    state.moving = false;
    box4motion.checked = false;
    state.phase = Number(event.target.value);
    update();
  }}) : null;
  const box4motion = el('input', {type: 'checkbox', id: 'swing', checked: !still, onchange: (event) => {
    state.moving = event.target.checked;
    if (state.moving) requestAnimationFrame(swing);
  }});
  const layer = (key, words, on) => {
    layers[key].visible = on;
    return el('label', {}, el('input', {type: 'checkbox', checked: on, onchange: (event) => { layers[key].visible = event.target.checked; shot.ask(); }}), ' ' + words);
  };
  const controls = el('div', {class: 'controls'}, layer('names', 'names and lengths', true), layer('sections', 'axes of sections', d.members.length <= 40), layer('frames', d.drawing === 'frame' ? 'axes of the base' : 'frames of base and tool', true),
    d.motions.length > 1 ? el('label', {}, 'Motion ', el('select', {id: 'motion', onchange: (event) => { state.motion = Number(event.target.value); say(); update(); }}, d.motions.map((m, i) => el('option', {value: i}, String(i + 1))))) : null,
    d.motions.length ? [el('label', {}, box4motion, ' moving'), el('label', {}, 'Motion drawn ', slider)] : null);
  const legend = el('div', {class: 'legend'},
    el('div', {}, ...[['orange', 'driven joint '], ['pale', 'other joint '], ['metal', 'member '], ['quiet', d.drawing === 'frame' ? 'support, rigid ' : 'rigid ']].map(([key, words]) => el('span', {}, el('span', {class: 'swatch', style: {background: `var(--${key})`}}), words))),
    el('div', {}, ...axisNames.map((axis, i) => el('span', {}, el('span', {class: 'swatch', style: {background: '#' + axisColours[i].toString(16).padStart(6, '0')}}), axis + ' '))));
  shot.canvas.addEventListener('pointermove', (event) => {
    const rect = shot.canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - rect.left) / rect.width - 1, 1 - 2 * (event.clientY - rect.top) / rect.height), looking.camera);
    const hit = ray.intersectObjects(hits)[0];
    tooltip(event, hit ? hit.object.userData.words : '');
  });
  shot.canvas.addEventListener('pointerleave', (event) => tooltip(event, ''));
  onTheme(update);
  say();
  update();
  state.moving = state.moving && !still;
  if (state.moving) requestAnimationFrame(swing);
  return el('div', {}, holder, legend, controls, readout, el('p', {class: 'quiet'}, `The box around its nodes measures ${bare.toArray().map((x) => num(x)).join(' × ')} mm.`));
}

const name = (part) => [part.leg, part.part].filter(Boolean).join(' ');
const place = (p) => p.map((x) => num(x, 5)).join(', ');
const axis = (a) => a.map((x) => num(x, 3)).join(', ');

export function drawn(d) {
  const members = () => ({
    columns: ['member', 'section', 'material', 'length_mm', 'from_mm', 'to_mm', 'local y', 'local z'],
    rows: d.members.map((m) => [name(m), m.section, m.material, m.length_mm, place(m.start_mm), place(m.end_mm), axis(m.axes[1]), axis(m.axes[2])]),
  });
  const joints = () => ({
    columns: ['joint', 'what it does', 'at_mm', 'x', 'y', 'z'],
    rows: d.joints.map((j) => [name(j), j.words, place(j.at_mm), ...j.axes.map(axis)]),
  });
  const frames = () => ({
    columns: d.drawing === 'frame' ? ['node', 'at_mm', 'held'] : ['frame', 'at_mm', 'x', 'y', 'z'],
    rows: d.frames.map((f) => (d.drawing === 'frame' ? [f.name, place(f.at_mm), f.held] : [f.name, place(f.at_mm), ...f.axes.map(axis)])),
  });
  const instruments = () => ({
    columns: ['name', 'what it is', 'at_mm', 'reads along'],
    rows: d.instruments.map((i) => [i.name, i.words, place(i.at_mm), i.axis ? axis(i.axis) : '']),
  });
  const entries = (list) => () => ({columns: ['name', 'what it is'], rows: d[list].map((e) => [e.name, e.words])});
  return [
    figure('machine', d.trouble ? 'As drawn: it does not stand' : 'As drawn, unloaded', 'Before any solution. Drag to turn, scroll or pinch to zoom; a part under the pointer says what it is.', attempt('The machine', () => picture(d))),
    figure('members', 'Members', 'Lengths from node to node; axes of the section in axes of the base.', numbers('members', members, {open: d.members.length <= 30})),
    d.joints.length ? figure('joints', 'Joints', 'tx ty tz along, rx ry rz about the axes x y z of the joint.', numbers('joints', joints, {open: d.joints.length <= 30})) : null,
    d.instruments.length ? figure('instruments', 'Sensors and points of load', null, numbers('instruments', instruments, {open: true})) : null,
    figure('frames', d.drawing === 'frame' ? 'Nodes' : 'Frames', null, numbers('frames', frames, {open: d.frames.length <= 30})),
    ...[['springs', 'Springs'], ['laws', 'Laws at supports and ends of members'], ['loads', 'Load cases'], ['sensors', 'Sensors']].map(([list, title]) => ((d[list] || []).length ? figure(list, title, null, numbers(list, entries(list), {open: d[list].length <= 30})) : null)),
  ];
}
