// The machine as its file draws it: members with their sections and axes, joints, frames of reference, names and lengths;
// where it cannot stand, the motions that nothing resists, moving.
import * as THREE from 'three';
import {el, figure, num, numbers, tooltip} from './dom.js';
import {stage, view} from './machine.js';
import {onTheme, theme} from './theme.js';

const axisNames = ['x', 'y', 'z'], axisColours = [0xd14b4b, 0x3f9b54, 0x4c7fd1];
const up = new THREE.Vector3(0, 1, 0);
const vector = (p) => new THREE.Vector3(...p);

export const drawingVerdict = (d) => {
  if (d.motions.length) return `${d.name}: ${d.trouble}: ${d.motions[0].words}.`;
  if (d.trouble) return `${d.name}: ${d.trouble}.`;
  const driven = d.driven.length ? `driven: ${d.driven.map((q) => `${q.name} ${num(q.value)} ${q.unit}`).join(', ')}` : 'nothing is driven';
  return d.drawing === 'frame' ? `${d.name} as drawn: ${d.frames.length} nodes, ${d.members.length} members.` : `${d.name} as drawn, unloaded; ${driven}.`;
};

/** Text on a light ground that faces the eye. */
function label(words, height) {
  const canvas = el('canvas'), pen = canvas.getContext('2d'), font = '40px system-ui, sans-serif';
  pen.font = font;
  canvas.width = Math.ceil(pen.measureText(words).width) + 16;
  canvas.height = 56;
  pen.font = font;
  pen.fillStyle = 'rgba(255, 255, 255, 0.8)';
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = '#222';
  pen.fillText(words, 8, 42);
  const texture = new THREE.CanvasTexture(canvas);
  texture.minFilter = THREE.LinearFilter;  // of any size, without smaller copies
  texture.generateMipmaps = false;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({map: texture, depthTest: false}));
  sprite.scale.set(height * canvas.width / canvas.height, height, 1);
  sprite.center.set(0, 0);
  sprite.renderOrder = 2;
  return sprite;
}

function triadAt(at, axes, length, which = [0, 1, 2]) {
  const group = new THREE.Group();
  for (const i of which) {
    const arrow = new THREE.ArrowHelper(vector(axes[i]).normalize(), vector(at), length, axisColours[i], 0.25 * length, 0.12 * length);
    for (const part of [arrow.line, arrow.cone]) part.material.depthTest = false, part.renderOrder = 1;
    group.add(arrow);
  }
  return group;
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
  const root = new THREE.Scene();
  root.add(new THREE.HemisphereLight(0xffffff, 0x8a8a8a, 0.85));
  const sun = new THREE.DirectionalLight(0xffffff, 0.45);
  sun.position.set(1, -1, 2);
  root.add(sun);
  const materials = {};
  for (const name of ['metal', 'pale', 'quiet', 'blue', 'orange', 'guilty']) materials[name] = new THREE.MeshLambertMaterial();
  Object.assign(materials.metal, {transparent: true, opacity: 0.6, depthWrite: false});  // joints and axes are seen inside
  const cylinder = new THREE.CylinderBufferGeometry(0.5, 0.5, 1, 20), block = new THREE.BoxBufferGeometry(1, 1, 1), ball = new THREE.SphereBufferGeometry(1, 16, 12);
  const rest = d.points_mm.map(vector);
  const hits = [];

  // A piece between two points; members as wide as their sections, turned into their axes.
  const pieces = d.lines.map(([a, b, m]) => {
    const member = m < 0 ? null : d.members[m];
    const [y, z] = member ? member.size_mm.map((s) => Math.max(s, thin)) : [0.7 * thin, 0.7 * thin];
    const mesh = new THREE.Mesh(!member || member.round ? cylinder : block, materials[member ? 'metal' : 'quiet']);
    mesh.userData = {a, b, y, z, axes: member && !member.round ? member.axes : null,
      words: member ? `${[member.leg, member.part].filter(Boolean).join(' ')}: ${member.section}, ${member.material}, ${num(member.length_mm, 5)} mm` : 'rigid'};
    root.add(mesh);
    hits.push(mesh);
    return mesh;
  });
  const put = (mesh, a, b) => {
    const along = b.clone().sub(a), length = along.length(), {y, z, axes} = mesh.userData;
    mesh.visible = length > 1e-9;
    if (!mesh.visible) return;
    mesh.position.copy(a).addScaledVector(along, 0.5);
    along.divideScalar(length);
    if (axes) {
      const side = vector(axes[1]), other = new THREE.Vector3().crossVectors(along, side).normalize();
      side.crossVectors(other, along);
      mesh.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(side, along, side.clone().cross(along)));
      mesh.scale.set(y, length, z);
    } else {
      mesh.quaternion.setFromUnitVectors(up, along);
      mesh.scale.set(y, length, z);
    }
  };
  const thickest = Math.max(thin, ...d.members.map((m) => Math.min(0.03 * size, Math.max(...m.size_mm) / 2)));
  for (const joint of d.joints) {
    const moving = [0, 1, 2, 3, 4, 5].filter((i) => joint.freedoms[i] !== 'r');
    const mesh = new THREE.Mesh(joint.driven ? block : ball, materials[joint.driven ? 'orange' : 'pale']);
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
  for (const f of d.frames.filter((each) => each.held)) {
    const foot = new THREE.Mesh(new THREE.ConeBufferGeometry(0.018 * size, 0.03 * size, 4), materials.quiet);
    foot.rotation.x = Math.PI / 2;
    foot.position.copy(vector(f.at_mm)).add(new THREE.Vector3(0, 0, -0.016 * size));
    foot.userData = {words: `${f.name}: ${f.held} held`};
    root.add(foot);
    hits.push(foot);
  }
  const said = new Set();
  const name = (words, at) => {
    if (said.has(words)) return;
    said.add(words);
    const sprite = label(words, 0.026 * size);
    sprite.position.copy(vector(at));
    layers.names.add(sprite);
  };
  for (const m of d.members) name(`${m.part} ${num(m.length_mm, 4)} mm`, m.start_mm.map((x, i) => (x + m.end_mm[i]) / 2));
  for (const j of d.joints) name(j.part + (j.driven ? ' (driven)' : ''), j.at_mm);
  for (const f of d.frames) name(f.name, f.at_mm);

  const holder = el('div', {class: 'view', id: 'machine-view'});
  const shot = stage(holder, (renderer, width, height) => {
    const t = theme();
    for (const [key, material] of Object.entries(materials)) material.color.set(t[key] || t.quiet);
    looking.fit(width, height);
    renderer.render(root, looking.camera);
  });
  if (!shot) return el('div', {}, holder);
  const looking = view(box, shot.canvas, shot.ask);
  shot.canvas.setAttribute('role', 'img');
  shot.canvas.setAttribute('aria-label', 'The machine as drawn, in 3D');
  holder.append(looking.buttons);

  const readout = el('p', {class: 'quiet', id: 'machine-readout', 'aria-live': 'polite'});
  const state = {motion: d.motions.length ? 0 : -1, phase: 1, moving: d.motions.length > 0};
  const update = () => {
    const motion = d.motions[state.motion], amplitude = state.phase;
    const at = rest.map((p, i) => (motion ? p.clone().addScaledVector(vector(motion.displacement_mm[i]), amplitude) : p));
    for (const piece of pieces) put(piece, at[piece.userData.a], at[piece.userData.b]);
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
  return [
    figure('machine', d.trouble ? 'As drawn: it does not stand' : 'As drawn, unloaded', 'Before any solution. Drag to turn, scroll or pinch to zoom; a part under the pointer says what it is.', picture(d)),
    figure('members', 'Members', 'Lengths from node to node; axes of the section in axes of the base.', numbers('members', members, {open: d.members.length <= 30})),
    d.joints.length ? figure('joints', 'Joints', 'tx ty tz along, rx ry rz about the axes x y z of the joint.', numbers('joints', joints, {open: d.joints.length <= 30})) : null,
    figure('frames', d.drawing === 'frame' ? 'Nodes' : 'Frames', null, numbers('frames', frames, {open: d.frames.length <= 30})),
  ];
}
