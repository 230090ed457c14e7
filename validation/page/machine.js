// A machine or a frame under load in 3D: where it stands, the shape that a load gives it, the load, the ground, the
// residuals at the tool, the guilty part.
import * as THREE from 'three';
import {groundUnder, label, lit, loadArrow, piece, put, shapes as bodies3d, triad, triadPoints, vector} from './bodies.js';
import {el, micro, num, tooltip} from './dom.js';
import {round125, stage, standpoint, view} from './stage.js';
import {onTheme, theme} from './theme.js';

const components = ['N along x', 'N along y', 'N along z', 'Nmm about x', 'Nmm about y', 'Nmm about z'];

export function loadWords(load) {
  return load.map((x, i) => (x === 0 ? null : `${num(x)} ${components[i]}`)).filter(Boolean).join(', ') || 'no load';
}

const shapeWords = (shape) => (shape.name === undefined ? loadWords(shape.load_N_Nmm) : `load case ${shape.name}`);
const nameOf = (part) => [part.leg, part.part].filter(Boolean).join(' ');

/** How large it is, how much its shapes are enlarged to be seen, and every point that the camera shows. */
function measured(scene3d) {
  const {bodies, poses, tool} = scene3d;
  const box = new THREE.Box3();
  for (const pose of poses) for (const p of pose.points_mm) box.expandByPoint(vector(p));
  const size = Math.max(1e-6, box.getSize(new THREE.Vector3()).length());
  const largest = (shape) => Math.max(1e-12, ...poses.flatMap((p) => p.shapes.slice(shape, shape + 1).flatMap((s) => s.displacement_mm.map((u) => Math.hypot(...u)))));
  const scaleOf = (shape) => round125(0.12 * size / largest(shape));
  const thick = Math.max(0, ...bodies.filter((b) => b.size_mm).map((b) => Math.max(...b.size_mm))) / 2;
  const arrow = 0.16 * size, points = [];
  for (const pose of poses) {
    for (const p of pose.points_mm) points.push(vector(p));
    for (const {arm_mm: arm} of pose.instruments || []) points.push(vector(pose.points_mm[tool]).add(vector(arm)));
    pose.shapes.forEach((shape, i) => {
      shape.displacement_mm.forEach((u, k) => points.push(vector(pose.points_mm[k]).addScaledVector(vector(u), scaleOf(i))));
      for (const a of shape.arrows) {
        const sense = tool === null ? -1 : 1, at = vector(pose.points_mm[a.point]).addScaledVector(vector(shape.displacement_mm[a.point]), scaleOf(i));
        points.push(at.addScaledVector(vector(a.vector).normalize(), (a.kind === 'line' ? 0.7 : 1.4) * sense * arrow));
      }
    });
  }
  return {box, size, scaleOf, arrow, points, thick};
}

/**
 * By cell: 'guilty', 'purple' where what is tied with it or something unknown acts, or nothing. The end of a member is marked by its outermost
 * element.
 */
function marksOf({bodies, cells, guilty, tied = []}) {
  const first = {}, last = {};
  cells.forEach(([, , i], k) => (first[i] ??= k, last[i] = k));
  const among = (names, i, k) => names.includes('member ' + bodies[i].part) || (first[i] === k && names.includes('start of ' + bodies[i].part)) || (last[i] === k && names.includes('end of ' + bodies[i].part));
  return cells.map(([, , i], k) => (bodies[i].guilty || among(guilty, i, k) ? 'guilty' : bodies[i].tied || among(tied, i, k) ? 'purple' : ''));
}

/** Members, joints, tool point and the unloaded shape: what the sliders move. */
function built(scene3d, size) {
  const {bodies, cells, joints, tool} = scene3d;
  const root = lit(), thin = size * 0.0028, materials = {};
  for (const name of ['metal', 'pale', 'guilty', 'purple', 'quiet', 'blue']) materials[name] = new THREE.MeshLambertMaterial();
  materials.text = new THREE.MeshBasicMaterial({depthTest: false, transparent: true});  // loads, seen inside members too
  const marks = marksOf(scene3d);
  const wide = (body, mark) => {
    if (!body.size_mm) return [1.6 * thin, 1.6 * thin];
    return body.size_mm.map((s) => Math.max(s, mark ? 3 * thin : 1.5 * thin));
  };
  const thickest = {};
  const rods = cells.map(([a, b, i], k) => {
    const body = bodies[i], mark = marks[k], widths = wide(body, mark);
    for (const point of [a, b]) thickest[point] = Math.max(thickest[point] || 0, ...widths);
    const mesh = piece(a, b, widths, body.size_mm && !body.round, materials[mark || (body.kind === 'member' ? 'metal' : 'quiet')], nameOf(body));
    Object.assign(mesh.userData, {body: i, point: b, mark});
    root.add(mesh);
    return mesh;
  });
  const knots = joints.map((joint) => {
    const mesh = new THREE.Mesh(joint.driven ? bodies3d.block : bodies3d.ball, materials[joint.guilty ? 'guilty' : joint.tied ? 'purple' : joint.driven ? 'pale' : 'quiet']);
    const radius = Math.min(0.03 * size, Math.max(2 * thin, 0.62 * (thickest[joint.point] || 0), joint.guilty || joint.tied ? 4 * thin : 0));
    mesh.scale.setScalar(joint.driven ? 1.8 * radius : radius);
    mesh.userData = {words: nameOf(joint) + (joint.driven ? ', driven' : ''), point: joint.point};
    root.add(mesh);
    return mesh;
  });
  const tip = tool === null ? null : new THREE.Mesh(bodies3d.ball, materials.blue);
  if (tip) {
    tip.scale.setScalar(2.4 * thin);
    tip.userData = {words: 'tool point', point: tool};
    root.add(tip);
  }
  const ghost = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({transparent: true, opacity: 0.55}));
  ghost.frustumCulled = false;
  root.add(ghost);
  return {root, materials, rods, knots, tip, ghost, thickest};
}

/** Named sensors, as pointers that touch what they read, and points of load, each with its arm from the tool point. */
function instrumentsOf(pose, tip, size, material, thin) {
  return (pose.instruments || []).flatMap(({name, kind, arm_mm: arm, axis}) => {
    const at = tip.clone().add(vector(arm)), line = new THREE.Line(new THREE.BufferGeometry().setFromPoints([tip, at]), thin);
    if (axis) return [line, loadArrow(at, {vector: axis, kind: kind === 'sensor' ? 'line' : 'moment', words: name}, 0.08 * size, material, true, 0.028 * size)];
    const ball = new THREE.Mesh(bodies3d.ball, material), words = label(name, 0.028 * size, [-0.2, 0.5]);
    ball.position.copy(at), ball.scale.setScalar(0.006 * size), words.position.copy(at);
    return [line, ball, words];
  });
}

/** Sensors of a frame: an arrow with the name where and along what it reads. */
function frameSensors(scene3d, size, materials) {
  return (scene3d.sensors || []).map((s) => loadArrow(vector(s.at_mm), {vector: s.axis, kind: 'line', words: s.name}, 0.07 * size, materials[s.guilty ? 'guilty' : (scene3d.tied || []).includes('sensor ' + s.name) ? 'purple' : 'blue'], true, 0.028 * size));
}

/**
 * By member what the sensors say of its axial force: N more (or less) of its size than predicted at one reading; null
 * where nothing is known of that or nothing differs.
 */
function residualForces(measurements) {
  const inside = measurements && measurements.result.inside;
  if (!inside) return null;
  const more = new Map(inside.residual_forces.filter((f) => f.unit === 'N').map((f) => [f.name, {more: Math.abs(f.predicted + f.more_than_predicted) - Math.abs(f.predicted), predicted: f.predicted}]));
  const most = Math.max(0, ...[...more.values()].map((f) => Math.abs(f.more)));
  const size = Math.max(0, ...[...more.values()].map((f) => Math.abs(f.predicted)));
  return most > 1e-6 * size ? {more, most, line: inside.reading_line} : null;
}

/** Members that are not marked get materials of their own, to be coloured by force. */
function giveForces(rods, bodies, forces) {
  for (const rod of rods) {
    const body = bodies[rod.userData.body], force = forces && body.kind === 'member' && forces.more.get(body.part);
    if (!force) continue;
    rod.userData.force = force.more;
    rod.userData.words += `, predicted ${num(force.predicted)} N, ${num(Math.abs(force.more))} N ${force.more < 0 ? 'less' : 'more'} by the sensors`;
    if (!rod.userData.mark) rod.material = rod.material.clone();
  }
}

function paintForces(rods, forces, on, t) {
  for (const rod of rods) {
    const {force, mark} = rod.userData;
    if (force === undefined || mark) continue;
    rod.material.color.set(t.metal);
    if (on) rod.material.color.lerp(new THREE.Color(force > 0 ? t.orange : t.blue), Math.sqrt(Math.abs(force) / forces.most));
  }
}

/** Measured − predicted at the tool: an arrow for each reading, on one scale. */
function residualArrows(scene3d, version, size) {
  const lengths = (version ? version.readings : []).map((r) => Math.hypot(...r.residual.slice(0, 3).map((x) => x || 0))).sort((a, b) => a - b);
  const times = round125(0.12 * size / Math.max(1e-12, lengths[Math.floor(0.95 * lengths.length)] || 0));
  const colourOf = (load) => {
    const t = theme(), i = load.map(Math.abs).indexOf(Math.max(...load.map(Math.abs)));
    return [t.blue, t.orange, t.green, t.purple, t.pale, t.grey][i];
  };
  const at = (pose) => (version ? version.readings.filter((r) => version.poses[r.pose].label === pose.label && r.residual.slice(0, 3).some((x) => x !== null)) : []);
  const draw = (pose) => at(pose).flatMap((reading) => {
    const r = new THREE.Vector3(...reading.residual.slice(0, 3).map((x) => x || 0)), length = r.length() * times;
    if (length < size * 1e-3) return [];
    const arrow = new THREE.ArrowHelper(r.normalize(), vector(pose.points_mm[scene3d.tool]), length, colourOf(reading.load_N_Nmm), Math.min(length * 0.3, size * 0.015), Math.min(length * 0.15, size * 0.008));
    for (const part of [arrow.line, arrow.cone]) part.material.depthTest = false, part.renderOrder = 1;
    return [arrow];
  });
  return {times, draw};
}

function describe(scene3d, state) {
  const pose = scene3d.poses[state.pose], shape = pose.shapes[state.shape], {tool} = scene3d;
  const where = pose.pose_mm_deg ? `Pose ${pose.label || ''} at (${pose.pose_mm_deg.slice(0, 3).map((x) => num(x)).join(', ')}) mm` : '';
  if (!shape) return where + '.';
  const drawn = `drawn ${num(state.scale, 3)} times as large`;
  if (tool === null) {
    const largest = Math.max(...shape.displacement_mm.map((u) => Math.hypot(...u)));
    return `Under ${shapeWords(shape)}${shape.other_loads ? ` (with ${shape.other_loads})` : ''} no point moves by more than ${num(largest)} mm, ${drawn}.`;
  }
  const moved = shape.displacement_mm[tool];
  return `${where}: under ${shapeWords(shape)} the tool moves by (${moved.map((x) => num(Math.abs(x) < 1e-9 * Math.hypot(...moved) ? 0 : 1e3 * x)).join(', ')}) µm by the MSA, ${drawn}.`;
}

/** What is under the pointer and how far it moves. */
function explain(shot, looking, meshes, shapeNow) {
  shot.canvas.addEventListener('pointermove', (event) => {
    const at = shot.canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - at.left) / at.width - 1, 1 - 2 * (event.clientY - at.top) / at.height), looking.camera);
    const hit = ray.intersectObjects(meshes)[0], shape = shapeNow();
    if (!hit) return tooltip(event, '');
    const {words, point} = hit.object.userData;
    tooltip(event, words + (shape && point !== undefined ? `: moves by ${micro(Math.hypot(...shape.displacement_mm[point]))}` : ''));
  });
  shot.canvas.addEventListener('pointerleave', (event) => tooltip(event, ''));
}

function controlsOf(scene3d, state, scaleWords, scaleOf, hasResiduals, hasForces, update) {
  const {poses} = scene3d, poseWords = el('span', {}, poses[state.pose].label);
  const slider = (name, words, attributes, change) => el('label', {}, name, ' ', words, el('input', {type: 'range', ...attributes, oninput: (event) => change(Number(event.target.value))}));
  return el('div', {class: 'controls'},
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
    }}, poses[0].shapes.map((shape, i) => el('option', {value: i}, shapeWords(shape))))) : null,
    hasResiduals ? el('label', {}, el('input', {type: 'checkbox', checked: true, onchange: (event) => { state.arrows = event.target.checked; update(); }}), ' residual arrows') : null,
    hasForces ? el('label', {}, el('input', {type: 'checkbox', id: 'residual-forces', checked: true, onchange: (event) => { state.forces = event.target.checked; update(); }}), ' members by residual force') : null);
}

function shorten(names) {
  const legs = names.map((n) => n.match(/^leg \d+ (.*)$/)), parts = new Set(legs.map((m) => m && m[1]));
  if (names.length > 2 && legs.every(Boolean) && parts.size === 1) return `${[...parts][0]} of ${names.length} legs`;
  return names.length > 4 ? names.slice(0, 4).join(', ') + ` and ${names.length - 4} more` : names.join(', ');
}

function legendOf(scene3d, state, guilt, residuals, forces) {
  const shape = scene3d.poses[state.pose].shapes[state.shape];
  return [
    scene3d.guilty.length ? el('div', {}, el('span', {class: 'swatch', style: {background: 'var(--guilty)'}}), guilt + ': ' + shorten(scene3d.guilty)) : null,
    (scene3d.tied || []).length ? el('div', {}, el('span', {class: 'swatch', style: {background: 'var(--purple)'}}), (scene3d.tiedWords || 'As likely here') + ': ' + shorten(scene3d.tiedNames || scene3d.tied)) : null,
    el('div', {}, `Thin lines: unloaded; solid: deflection × ${num(state.scale, 3)}`),
    (scene3d.sensors || []).length ? el('div', {}, el('span', {class: 'swatch', style: {background: 'var(--blue)'}}), 'sensors') : null,
    shape && shape.arrows.length ? el('div', {}, el('span', {class: 'swatch', style: {background: 'var(--text)'}}), scene3d.kind === 'frame' ? 'loads' : 'load on the tool') : null,
    scene3d.ground.length ? el('div', {}, el('span', {class: 'swatch hatched'}), scene3d.kind === 'frame' ? 'supports' : 'ground') : null,
    forces && state.forces ? el('div', {}, `Members, by the sensors, at line ${forces.line}: ${num(forces.most, 2)} N less than predicted `,
      el('span', {class: 'forces'}), ` ${num(forces.most, 2)} N more`) : null,
    residuals && state.arrows ? el('div', {}, `Arrows: measured − predicted × ${num(residuals.times, 3)}, by axis of the load: `,
      ...['x', 'y', 'z'].map((name, i) => el('span', {}, el('span', {class: 'swatch', style: {background: `var(--${['blue', 'orange', 'green'][i]})`}}), name + ' '))) : null,
  ].filter(Boolean);
}

/** The arrows of a shape; the larger a load of its kind, the longer its arrow. */
function loadsOf(scene3d, shape, bent, length, size, material) {
  if (!shape) return [];
  const strength = (a) => Math.hypot(...a.vector), most = {};
  for (const a of shape.arrows) most[a.kind] = Math.max(most[a.kind] || 0, strength(a));
  return shape.arrows.map((a) => {
    const share = 0.45 + 0.55 * strength(a) / most[a.kind];
    return loadArrow(bent[a.point], a, (a.kind === 'line' ? 0.45 : 1) * share * length, material, scene3d.tool === null, 0.032 * size);
  });
}

/**
 * `measurements`: residuals of the device as given (page data), or nothing; `guilt`: what the guilty parts are. Throws
 * where the browser does not draw in 3D.
 */
export function machine(scene3d, measurements, guilt) {
  const version = measurements && measurements.unit === 'mm' ? measurements : null;
  const {cells, poses, tool} = scene3d;
  const {box, size, scaleOf, arrow, points, thick} = measured(scene3d);
  const worst = version ? [...version.poses].sort((a, b) => b.rmse - a.rmse)[0].label : null;
  const state = {pose: Math.max(0, poses.findIndex((p) => p.label === worst)), shape: 0, scale: poses[0].shapes.length ? scaleOf(0) : 1, arrows: true, forces: true};
  const {root, materials, rods, knots, tip, ghost, thickest} = built(scene3d, size);
  const forces = residualForces(measurements);
  giveForces(rods, scene3d.bodies, forces);
  const atTool = version && version.readings.some((r) => r.residual.slice(0, 3).some((x) => x !== null));
  const residuals = atTool ? residualArrows(scene3d, version, size) : null;
  const ground = groundUnder(scene3d.ground, scene3d.kind === 'machine', box.getCenter(new THREE.Vector3()), size, standpoint(box).up);
  // Cones of springs move with their nodes, below the member.
  const below = standpoint(box).up.clone().normalize();
  for (const mesh of ground.meshes) if (mesh.userData.point !== undefined) mesh.userData.below = below.clone().multiplyScalar(-0.0175 * size - 0.5 * (thickest[mesh.userData.point] || 0));
  const moving = new THREE.Group(), corner = box.min.clone().addScalar(-0.02 * size);
  root.add(ground.group, moving, triad(corner, 0.1 * size), ...frameSensors(scene3d, size, materials));

  const holder = el('div', {class: 'view', id: 'machine-view'}), factor = el('div', {class: 'factor'});
  const shot = stage(holder, 'The ' + scene3d.kind + ' under load, in 3D', (renderer, width, height) => {
    const t = theme();
    for (const [name, material] of Object.entries(materials)) material.color.set(t[name]);
    if (forces) paintForces(rods, forces, state.forces, t);
    ghost.material.color.set(t.quiet);
    looking.fit(width, height);
    renderer.render(root, looking.camera);
  });
  const looking = view([...points, ...ground.points, ...triadPoints(corner, 0.1 * size)], shot.canvas, shot.ask, thick);
  holder.append(looking.buttons, el('div', {class: 'measures'}, looking.scale, factor));

  const legend = el('div', {class: 'legend'}), scaleWords = el('span'), readout = el('p', {class: 'quiet', id: 'machine-readout', 'aria-live': 'polite'});
  const update = () => {
    const pose = poses[state.pose], shape = pose.shapes[state.shape];
    const rest = pose.points_mm.map(vector);
    const bent = rest.map((p, i) => (shape ? p.clone().addScaledVector(vector(shape.displacement_mm[i]), state.scale) : p));
    for (const rod of rods) {
      const {a, b, body} = rod.userData;
      put(rod, bent[a], bent[b], rod.geometry === bodies3d.block ? vector(pose.axes[body]) : null);
    }
    for (const knot of knots) knot.position.copy(bent[knot.userData.point]);
    for (const {position, userData} of ground.meshes) if (userData.below) position.copy(bent[userData.point]).add(userData.below);
    if (tip) tip.position.copy(bent[tool]);
    ghost.geometry.dispose();
    ghost.geometry = new THREE.BufferGeometry().setFromPoints(cells.flatMap(([a, b]) => [rest[a], rest[b]]));
    moving.remove(...moving.children);
    moving.add(...loadsOf(scene3d, shape, bent, arrow, size, materials.text), ...(tip ? instrumentsOf(pose, bent[tool], size, materials.blue, ghost.material) : []), ...(residuals && state.arrows ? residuals.draw(pose) : []));
    scaleWords.textContent = shape ? '× ' + num(state.scale, 3) : '';
    factor.textContent = shape ? `deflection × ${num(state.scale, 3)}` : '';
    readout.textContent = describe(scene3d, state);
    legend.replaceChildren(...legendOf(scene3d, state, guilt, residuals, forces));
    shot.ask();
  };
  onTheme(update);
  explain(shot, looking, [...rods, ...knots, ...(tip ? [tip] : []), ...ground.meshes], () => poses[state.pose].shapes[state.shape]);
  update();
  return el('div', {}, holder, legend, controlsOf(scene3d, state, scaleWords, scaleOf, Boolean(residuals), Boolean(forces), update), readout);
}
