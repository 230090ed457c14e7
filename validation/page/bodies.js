// What 3D pictures are made of: members as wide as their sections, axes, labels, loads, the ground.
import * as THREE from 'three';
import {el} from './dom.js';

export const vector = (p) => new THREE.Vector3(...p);
const up = new THREE.Vector3(0, 1, 0);

export const shapes = {
  cylinder: new THREE.CylinderBufferGeometry(0.5, 0.5, 1, 20), block: new THREE.BoxBufferGeometry(1, 1, 1),
  ball: new THREE.SphereBufferGeometry(1, 16, 12), cone: new THREE.ConeBufferGeometry(0.5, 1, 20),
};

/** Light from the sky and from a side. */
export function lit() {
  const root = new THREE.Scene(), sun = new THREE.DirectionalLight(0xffffff, 0.45);
  sun.position.set(1, -1, 2);
  root.add(new THREE.HemisphereLight(0xffffff, 0x8a8a8a, 0.85), sun);
  return root;
}

/** Between points a and b: round, or with `axes` (x, y, z of the section) a box y by z, mm. */
export function piece(a, b, [y, z], axes, material, words) {
  const mesh = new THREE.Mesh(axes ? shapes.block : shapes.cylinder, material);
  mesh.userData = {a, b, y, z, words};
  return mesh;
}

/** From one place to another; of a box its local y lies as near to `side` as the piece allows. */
export function put(mesh, from, to, side) {
  const along = to.clone().sub(from), length = along.length(), {y, z} = mesh.userData;
  mesh.visible = length > 1e-9;
  if (!mesh.visible) return;
  mesh.position.copy(from).addScaledVector(along, 0.5);
  along.divideScalar(length);
  mesh.scale.set(y, length, z);
  if (!side) return mesh.quaternion.setFromUnitVectors(up, along);
  const other = new THREE.Vector3().crossVectors(along, side).normalize(), across = new THREE.Vector3().crossVectors(other, along);
  mesh.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(across, along, across.clone().cross(along)));
}

/** Text on a light ground that faces the eye; `centre` of it at its position: (0, 0) is its lower left corner. */
export function label(words, height, centre = [0, 0]) {
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
  sprite.center.set(...centre);
  sprite.renderOrder = 2;
  return sprite;
}

/** Axes of the base with their letters. */
export function triad(corner, length) {
  const group = new THREE.Group();
  ['x', 'y', 'z'].forEach((name, i) => {
    const end = new THREE.Vector3().setComponent(i, 1);
    group.add(new THREE.ArrowHelper(end, corner, length, 0x888888, 0.2 * length, 0.12 * length));
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

/** What a camera must see of it. */
export const triadPoints = (corner, length) => [0, 1, 2].map((i) => corner.clone().setComponent(i, corner.getComponent(i) + 1.4 * length)).concat(corner);

/**
 * An arrow of a load with its value: a force has one head, a moment two (right-hand rule). It leaves `at`, or with
 * `onto` ends there.
 */
export function loadArrow(at, {vector: along, kind, words}, length, material, onto, textHeight) {
  const group = new THREE.Group(), direction = vector(along).normalize(), start = onto ? at.clone().addScaledVector(direction, -length) : at.clone();
  const head = Math.min(0.3 * length, 0.9 * textHeight), thick = 0.22 * head;
  const add = (shape, from, to, wide) => {
    const part = piece(0, 0, [wide, wide], null, material, '');
    part.geometry = shape;
    put(part, start.clone().addScaledVector(direction, from), start.clone().addScaledVector(direction, to));
    part.renderOrder = 1;
    group.add(part);
  };
  const heads = kind === 'moment' ? 2 : 1;
  add(shapes.cylinder, 0, length - 0.9 * head, thick);
  for (let i = 0; i < heads; ++i) add(shapes.cone, length - (1 + 0.8 * i) * head, length - 0.8 * i * head, 0.7 * head);
  if (words) {
    const text = label(words, textHeight, onto ? [0.5, -0.2] : [-0.08, 0.5]);
    text.position.copy(onto ? start : start.clone().addScaledVector(direction, length));
    group.add(text);
  }
  return group;
}

function hatched() {
  const canvas = el('canvas', {width: 64, height: 64}), pen = canvas.getContext('2d');
  pen.fillStyle = '#d8d8d8';
  pen.fillRect(0, 0, 64, 64);
  pen.strokeStyle = '#7a7a7a';
  pen.lineWidth = 5;
  for (let x = -64; x < 128; x += 21.333) pen.moveTo(x, 64), pen.lineTo(x + 64, 0);
  pen.stroke();
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  return texture;
}

/** The axis (0, 1, 2) on which three points or more all have the same coordinate; null where there is none. */
function levelAcross(points, size) {
  if (points.length < 3) return null;
  const box = new THREE.Box3().setFromPoints(points), s = box.getSize(new THREE.Vector3()).toArray();
  const flat = s.indexOf(Math.min(...s));
  return s[flat] < 0.02 * size ? flat : null;
}

/**
 * The ground: a hatched plate under a machine whose feet stand in one level; a pad under each foot elsewhere and under
 * nodes of frames; a cone where a support holds some directions only. Returns the group, its meshes with words, and points
 * for the camera.
 */
export function groundUnder(feet, isMachine, machineMiddle, size, upwards) {
  const group = new THREE.Group(), meshes = [], points = [];
  const thick = 0.012 * size, at = feet.map((f) => vector(f.at_mm)), level = isMachine ? levelAcross(at, size) : null;
  const marked = (foot, otherwise) => (foot.guilty ? 0xd62728 : foot.tied ? 0x8a3ea8 : otherwise);
  const add = (middle, widths, words, opacity, color = 0xffffff) => {
    const map = hatched();
    const wide = [...widths].sort((a, b) => b - a);
    map.repeat.set(Math.max(1, wide[0] / (0.05 * size)), Math.max(1, wide[1] / (0.05 * size)));
    const mesh = new THREE.Mesh(shapes.block, new THREE.MeshLambertMaterial({map, color, transparent: opacity < 1, opacity, depthWrite: opacity === 1}));
    mesh.scale.set(...widths);
    mesh.position.copy(middle);
    mesh.userData = {words};
    group.add(mesh);
    meshes.push(mesh);
    for (const x of [-0.5, 0.5]) for (const y of [-0.5, 0.5]) for (const z of [-0.5, 0.5]) points.push(middle.clone().add(new THREE.Vector3(x * widths[0], y * widths[1], z * widths[2])));
  };
  if (level !== null) {
    const box = new THREE.Box3().setFromPoints(at).expandByScalar(0.05 * size), middle = box.getCenter(new THREE.Vector3()), widths = box.getSize(new THREE.Vector3()).toArray();
    widths[level] = thick;
    const side = machineMiddle.getComponent(level) >= middle.getComponent(level) ? -1 : 1;
    middle.setComponent(level, middle.getComponent(level) + side * thick / 2);
    add(middle, widths, 'ground', 0.55);
    return {group, meshes, points};
  }
  feet.forEach((foot, i) => {
    if (foot.whole) {
      const widths = [0.06 * size, 0.06 * size, 0.06 * size], axis = upwards.toArray().map(Math.abs).indexOf(1);
      widths[axis] = thick;
      return add(at[i].clone().addScaledVector(upwards, -thick / 2), widths, foot.words, 1, marked(foot, 0xffffff));
    }
    const cone = new THREE.Mesh(shapes.cone, new THREE.MeshLambertMaterial({color: marked(foot, 0x8a929b)}));
    cone.scale.setScalar(0.035 * size);
    cone.quaternion.setFromUnitVectors(up, upwards);
    cone.position.copy(at[i]).addScaledVector(upwards, -0.0175 * size);
    cone.userData = {words: foot.words, point: foot.point};
    group.add(cone);
    meshes.push(cone);
    points.push(at[i].clone().addScaledVector(upwards, -0.035 * size));
  });
  return {group, meshes, points};
}
