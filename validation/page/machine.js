// The machine in 3D: where it stands, the shape that a load gives it, the residuals at the tool, the guilty part.
import * as THREE from 'three';
import {OrbitControls} from 'orbit-controls';
import {el, micro, num, tooltip} from './dom.js';
import {onTheme, theme} from './theme.js';

const components = ['fx', 'fy', 'fz', 'mx', 'my', 'mz'];
const up = new THREE.Vector3(0, 1, 0);

export function loadWords(load) {
  return load.map((x, i) => (x === 0 ? null : `${components[i]} ${num(x)} ${i < 3 ? 'N' : 'Nmm'}`)).filter(Boolean).join(', ') || 'no load';
}

/** 1, 2 or 5 times a power of ten, not above x. */
export function round125(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * (x / power >= 5 ? 5 : x / power >= 2 ? 2 : 1);
}

/** A renderer that draws when something changed, or a sentence where the browser has no WebGL. */
export function stage(holder, draw) {
  const canvas = el('canvas', {});
  holder.prepend(canvas);
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true, preserveDrawingBuffer: true});
  } catch (error) {
    canvas.remove();
    holder.append(el('p', {class: 'quiet'}, 'This browser does not draw in 3D (WebGL is missing); the numbers are below.'));
    return null;
  }
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  let asked = false;
  const now = () => {
    asked = false;
    const {clientWidth, clientHeight} = holder;
    if (!clientWidth || !clientHeight) return;
    const size = renderer.getSize(new THREE.Vector2());
    if (size.x !== clientWidth || size.y !== clientHeight) renderer.setSize(clientWidth, clientHeight, false);
    draw(renderer, clientWidth, clientHeight);
    canvas.dataset.drawn = String(Number(canvas.dataset.drawn || 0) + 1);
  };
  const ask = () => {
    if (!asked) asked = true, requestAnimationFrame(now);
  };
  new ResizeObserver(ask).observe(holder);
  onTheme(now);
  return {canvas, ask};
}

/** A camera that looks at a box, z up, with the mouse, fingers and buttons that turn it. */
export function view(box, element, changed, far = 1.42) {
  const centre = box.getCenter(new THREE.Vector3()), size = Math.max(1e-6, box.getSize(new THREE.Vector3()).length());
  const camera = new THREE.PerspectiveCamera(32, 1, size / 100, size * 20);
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, element);
  controls.enableKeys = false;
  controls.target.copy(centre);
  const reset = () => {
    controls.target.copy(centre);
    camera.position.copy(centre).add(new THREE.Vector3(1.1, -1.5, 0.75).normalize().multiplyScalar(far * size));
    controls.update();
    changed();
  };
  const turn = (angle) => {
    camera.position.sub(controls.target).applyAxisAngle(camera.up, angle).add(controls.target);
    controls.update();
    changed();
  };
  const zoom = (factor) => {
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
    controls.update();
    changed();
  };
  controls.addEventListener('change', changed);
  reset();
  const button = (text, title, act) => el('button', {type: 'button', title, 'aria-label': title, onclick: act}, text);
  const buttons = el('div', {class: 'buttons'}, button('⟲', 'turn left', () => turn(-0.35)), button('⟳', 'turn right', () => turn(0.35)),
                     button('+', 'nearer', () => zoom(0.8)), button('−', 'farther', () => zoom(1.25)), button('⌂', 'as at first', reset));
  const fit = (width, height) => {
    camera.aspect = width / height;
    camera.fov = 360 / Math.PI * Math.atan(0.287 * Math.max(1, 1.05 * height / width));
    camera.updateProjectionMatrix();
  };
  return {camera, buttons, fit};
}

/** Axes of the base at a corner, with their letters. */
export function triad(corner, length) {
  const group = new THREE.Group();
  ['x', 'y', 'z'].forEach((name, i) => {
    const end = new THREE.Vector3().setComponent(i, 1);
    group.add(new THREE.ArrowHelper(end, corner, length, 0x888888, 0.2 * length, 0.1 * length));
    const canvas = el('canvas', {width: 64, height: 64}), pen = canvas.getContext('2d');
    pen.font = '48px system-ui, sans-serif';
    pen.textAlign = 'center';
    pen.fillStyle = '#888';
    pen.fillText(name, 32, 46);
    const letter = new THREE.Sprite(new THREE.SpriteMaterial({map: new THREE.CanvasTexture(canvas), depthTest: false}));
    letter.position.copy(corner).addScaledVector(end, 1.25 * length);
    letter.scale.setScalar(0.4 * length);
    group.add(letter);
  });
  return group;
}

function boxOf(poses) {
  const box = new THREE.Box3();
  for (const pose of poses) for (const p of pose.points_mm) box.expandByPoint(new THREE.Vector3(...p));
  return box;
}

function place(mesh, a, b, radius) {
  const along = b.clone().sub(a), length = along.length();
  mesh.visible = length > 1e-9;
  if (!mesh.visible) return;
  mesh.position.copy(a).addScaledVector(along, 0.5);
  mesh.quaternion.setFromUnitVectors(up, along.divideScalar(length));
  mesh.scale.set(radius, length, radius);
}

/** `measured`: residuals of the device as given (page data), or nothing; `guilt`: what the guilty parts are. */
export function machine(scene3d, measured, guilt) {
  const version = measured && measured.unit === 'mm' ? measured : null;
  const {bodies, cells, joints, poses, tool} = scene3d;
  const box = boxOf(poses), size = box.getSize(new THREE.Vector3()).length();
  const largest = (shape) => Math.max(1e-12, ...poses.flatMap((p) => p.shapes.slice(shape, shape + 1).flatMap((s) => s.displacement_mm.map((u) => Math.hypot(...u)))));
  const scaleOf = (shape) => round125(0.15 * size / largest(shape));
  const residualsAt = (pose) => (version ? version.readings.filter((r) => version.poses[r.pose].label === pose.label && r.residual.slice(0, 3).some((x) => x !== null)) : []);
  const lengths = (version ? version.readings : []).map((r) => Math.hypot(...r.residual.slice(0, 3).map((x) => x || 0))).sort((a, b) => a - b);
  const arrowScale = round125(0.15 * size / Math.max(1e-12, lengths[Math.floor(0.95 * lengths.length)] || 0));
  const worst = version ? [...version.poses].sort((a, b) => b.rmse - a.rmse)[0].label : null;
  const state = {pose: Math.max(0, poses.findIndex((p) => p.label === worst)), shape: 0, scale: scaleOf(0), arrows: true};

  const root = new THREE.Scene();
  root.add(new THREE.HemisphereLight(0xffffff, 0x8a8a8a, 0.85));
  const sun = new THREE.DirectionalLight(0xffffff, 0.45);
  sun.position.set(1, -1, 2);
  root.add(sun);
  const cylinder = new THREE.CylinderBufferGeometry(1, 1, 1, 12), ball = new THREE.SphereBufferGeometry(1, 16, 12), cube = new THREE.BoxBufferGeometry(1.6, 1.6, 1.6);
  const materials = {};
  for (const name of ['metal', 'pale', 'guilty', 'quiet', 'blue']) materials[name] = new THREE.MeshLambertMaterial();
  const thin = size * 0.0028;
  const radiusOf = (body) => (body.kind === 'member' ? Math.min(size * 0.02, Math.max(thin, body.radius_mm)) : body.kind === 'platform' ? thin * 1.6 : thin * 0.7);
  const colourOf = (body) => (body.guilty ? 'guilty' : body.kind === 'member' ? 'metal' : 'quiet');
  const thickest = Math.max(thin, ...bodies.filter((b) => b.kind === 'member').map(radiusOf));
  const rods = cells.map(([a, b, body]) => {
    const mesh = new THREE.Mesh(cylinder, materials[colourOf(bodies[body])]);
    mesh.userData = {a, b, radius: radiusOf(bodies[body]) * (bodies[body].guilty ? 1.25 : 1), words: [bodies[body].leg, bodies[body].part].filter(Boolean).join(' '), point: b};
    root.add(mesh);
    return mesh;
  });
  const knots = joints.map((joint) => {
    const mesh = new THREE.Mesh(joint.driven ? cube : ball, materials[joint.guilty ? 'guilty' : joint.driven ? 'pale' : 'quiet']);
    mesh.scale.setScalar(Math.max(thin * 2, joint.guilty ? Math.max(3 * thin, 1.5 * thickest) : 0));
    mesh.userData = {words: [joint.leg, joint.part].filter(Boolean).join(' '), point: joint.point};
    root.add(mesh);
    return mesh;
  });
  const tip = new THREE.Mesh(ball, materials.blue);
  tip.scale.setScalar(thin * 2.4);
  tip.userData = {words: 'tool point', point: tool};
  root.add(tip);
  const ghost = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({transparent: true, opacity: 0.55}));
  ghost.frustumCulled = false;
  root.add(ghost);
  root.add(triad(box.min, 0.12 * size));
  const arrows = new THREE.Group();
  root.add(arrows);

  const holder = el('div', {class: 'view', id: 'machine-view'});
  const legend = el('div', {class: 'legend'}), scaleWords = el('span');
  const readout = el('p', {class: 'quiet', id: 'machine-readout', 'aria-live': 'polite'});
  const shot = stage(holder, (renderer, width, height) => {
    const t = theme();
    for (const [name, material] of Object.entries(materials)) material.color.set(t[name]);
    ghost.material.color.set(t.quiet);
    looking.fit(width, height);
    renderer.render(root, looking.camera);
  });
  if (!shot) return {element: el('div', {}, holder)};
  const looking = view(box, shot.canvas, shot.ask);
  shot.canvas.setAttribute('role', 'img');
  shot.canvas.setAttribute('aria-label', 'The mechanism in 3D');
  holder.append(looking.buttons);

  const loadColour = (load) => {
    const t = theme(), i = load.map(Math.abs).indexOf(Math.max(...load.map(Math.abs)));
    return [t.blue, t.orange, t.green, t.purple, t.pale, t.grey][i];
  };
  const redrawArrows = () => {
    arrows.remove(...arrows.children);
    if (!state.arrows) return;
    const from = new THREE.Vector3(...poses[state.pose].points_mm[tool]);
    for (const reading of residualsAt(poses[state.pose])) {
      const r = new THREE.Vector3(...reading.residual.slice(0, 3).map((x) => x || 0)), length = r.length() * arrowScale;
      if (length < size * 1e-3) continue;
      const arrow = new THREE.ArrowHelper(r.normalize(), from, length, loadColour(reading.load_N_Nmm), Math.min(length * 0.3, size * 0.015), Math.min(length * 0.15, size * 0.008));
      for (const part of [arrow.line, arrow.cone]) part.material.depthTest = false, part.renderOrder = 1;
      arrows.add(arrow);
    }
  };
  const update = () => {
    const pose = poses[state.pose], shape = pose.shapes[state.shape];
    const rest = pose.points_mm.map((p) => new THREE.Vector3(...p));
    const bent = rest.map((p, i) => (shape ? p.clone().addScaledVector(new THREE.Vector3(...shape.displacement_mm[i]), state.scale) : p));
    for (const rod of rods) place(rod, bent[rod.userData.a], bent[rod.userData.b], rod.userData.radius);
    for (const knot of knots) knot.position.copy(bent[knot.userData.point]);
    tip.position.copy(bent[tool]);
    ghost.geometry.dispose();
    ghost.geometry = new THREE.BufferGeometry().setFromPoints(cells.flatMap(([a, b]) => [rest[a], rest[b]]));
    redrawArrows();
    scaleWords.textContent = '× ' + num(state.scale, 3);
    const moved = shape ? shape.displacement_mm[tool] : null;
    readout.textContent = `Pose ${pose.label || ''} at (${pose.pose_mm_deg.slice(0, 3).map((x) => num(x)).join(', ')}) mm` +
      (shape ? `: under ${loadWords(shape.load_N_Nmm)} the tool moves by (${moved.map((x) => num(Math.abs(x) < 1e-9 * Math.hypot(...moved) ? 0 : 1e3 * x)).join(', ')}) µm by the MSA, drawn ${num(state.scale, 3)} times as large.` : '.');
    legend.replaceChildren(...[
      scene3d.guilty.length ? el('div', {}, el('span', {class: 'swatch', style: {background: 'var(--guilty)'}}), guilt + ': ' + shorten(scene3d.guilty)) : null,
      el('div', {}, `Thin lines: unloaded; solid: deflection × ${num(state.scale, 3)}`),
      version && state.arrows ? el('div', {}, `Arrows: measured − predicted × ${num(arrowScale, 3)}, by axis of the load: `,
        ...['x', 'y', 'z'].map((name, i) => el('span', {}, el('span', {class: 'swatch', style: {background: `var(--${['blue', 'orange', 'green'][i]})`}}), name + ' '))) : null,
    ].filter(Boolean));
    shot.ask();
  };
  onTheme(update);

  shot.canvas.addEventListener('pointermove', (event) => {
    const at = shot.canvas.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - at.left) / at.width - 1, 1 - 2 * (event.clientY - at.top) / at.height), looking.camera);
    const hit = ray.intersectObjects([...rods, ...knots, tip])[0];
    const shape = poses[state.pose].shapes[state.shape];
    if (!hit) return tooltip(event, '');
    const {words, point} = hit.object.userData;
    tooltip(event, words + (shape ? `: moves by ${micro(Math.hypot(...shape.displacement_mm[point]))}` : ''));
  });
  shot.canvas.addEventListener('pointerleave', (event) => tooltip(event, ''));

  const poseWords = el('span', {}, poses[state.pose].label);
  const slider = (label, words, attributes, change) => el('label', {}, label, ' ', words, el('input', {type: 'range', ...attributes, oninput: (event) => change(Number(event.target.value))}));
  const controls = el('div', {class: 'controls'},
    poses.length > 1 ? slider('Pose', poseWords, {id: 'pose-slider', min: 0, max: poses.length - 1, step: 1, value: state.pose}, (value) => {
      state.pose = value;
      poseWords.textContent = poses[value].label;
      update();
    }) : null,
    poses[0].shapes.length ? slider('Deflection', scaleWords, {id: 'scale-slider', min: 0, max: 3, step: 0.05, value: 1}, (value) => {
      state.scale = value * scaleOf(state.shape);
      update();
    }) : null,
    poses[0].shapes.length > 1 ? el('label', {}, 'Shape under', el('select', {id: 'shape', onchange: (event) => {
      state.scale *= scaleOf(Number(event.target.value)) / scaleOf(state.shape);
      state.shape = Number(event.target.value);
      update();
    }},
      poses[0].shapes.map((shape, i) => el('option', {value: i}, loadWords(shape.load_N_Nmm))))) : null,
    version ? el('label', {}, el('input', {type: 'checkbox', checked: true, onchange: (event) => { state.arrows = event.target.checked; update(); }}), ' residual arrows') : null);
  update();
  return {element: el('div', {}, holder, legend, controls, readout)};
}

function shorten(names) {
  const legs = names.map((n) => n.match(/^leg \d+ (.*)$/)), parts = new Set(legs.map((m) => m && m[1]));
  if (names.length > 2 && legs.every(Boolean) && parts.size === 1) return `${[...parts][0]} of ${names.length} legs`;
  return names.length > 4 ? names.slice(0, 4).join(', ') + ` and ${names.length - 4} more` : names.join(', ');
}
