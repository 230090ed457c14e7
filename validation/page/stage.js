// A place to draw in 3D: the renderer, a camera that has everything in view, and a bar that says how long a length is.
import * as THREE from 'three';
import {OrbitControls} from 'orbit-controls';
import {el, missing, num} from './dom.js';
import {onTheme} from './theme.js';

/** 1, 2 or 5 times a power of ten, not above x. */
export function round125(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * (x / power >= 5 ? 5 : x / power >= 2 ? 2 : 1);
}

/** Throws where the browser has no WebGL. */
function rendererOn(canvas) {
  const wishes = {antialias: true, alpha: true, preserveDrawingBuffer: true};
  const context = canvas.getContext('webgl', wishes) || canvas.getContext('experimental-webgl', wishes);
  if (!context) throw new Error('this browser does not draw in 3D (it has no WebGL, or it is switched off)');
  return new THREE.WebGLRenderer({canvas, context, ...wishes});
}

/** A renderer that draws when something changed. Throws where the browser does not draw in 3D; `what` is drawn. */
export function stage(holder, what, draw) {
  const canvas = el('canvas', {role: 'img', 'aria-label': what});
  const renderer = rendererOn(canvas);
  holder.prepend(canvas);
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  let asked = false, given = false;
  const giveUp = (error) => {
    given = true;
    holder.classList.add('without');
    holder.replaceChildren(missing(what, error));
  };
  const now = () => {
    asked = false;
    const {clientWidth, clientHeight} = holder;
    if (given || !clientWidth || !clientHeight) return;
    try {
      const size = renderer.getSize(new THREE.Vector2());
      if (size.x !== clientWidth || size.y !== clientHeight) renderer.setSize(clientWidth, clientHeight, false);
      draw(renderer, clientWidth, clientHeight);
      canvas.dataset.drawn = String(Number(canvas.dataset.drawn || 0) + 1);
    } catch (error) {
      giveUp(error);
    }
  };
  const ask = () => {
    if (!asked) asked = true, requestAnimationFrame(now);
  };
  canvas.addEventListener('webglcontextlost', () => giveUp(new Error('the browser has taken its 3D picture away; load the page again')));
  new ResizeObserver(ask).observe(holder);
  onTheme(now);
  return {canvas, ask};
}

/** From where a thing is seen: askew, or nearly head-on what lies in a plane; with what points upwards. */
export function standpoint(box) {
  const s = box.getSize(new THREE.Vector3()), flat = s.toArray().map((x) => x < 1e-6 * Math.max(...s.toArray()));
  const z = new THREE.Vector3(0, 0, 1);
  if (flat.filter(Boolean).length === 1) {
    if (flat[0]) return {from: new THREE.Vector3(1, -0.2, 0.22), up: z};
    if (flat[1]) return {from: new THREE.Vector3(0.2, -1, 0.22), up: z};
    return {from: new THREE.Vector3(0.2, -0.22, 1), up: new THREE.Vector3(0, 1, 0)};
  }
  return {from: new THREE.Vector3(1.1, -1.5, 0.75), up: z};
}

/**
 * A camera that has all `points`, and `around` them so many mm, in view whatever the window's shape, until somebody turns it with the mouse, fingers or
 * buttons. `scale`: a bar with its length in the plane through the middle of the picture.
 */
export function view(points, element, changed, around = 0) {
  const box = new THREE.Box3().setFromPoints(points), size = Math.max(1e-6, box.getSize(new THREE.Vector3()).length());
  const {from, up} = standpoint(box), middle = box.getCenter(new THREE.Vector3());
  const camera = new THREE.PerspectiveCamera(22, 1, size / 100, size * 30);
  camera.up.copy(up);
  camera.position.copy(middle).addScaledVector(from, size);
  const controls = new OrbitControls(camera, element);
  controls.enableKeys = false;
  controls.target.copy(middle);
  let home = true, aspect = 0;
  /** The nearest place along `from` at which every point lies within the picture, the machine in its middle. */
  const place = () => {
    const towards = from.clone().normalize(), right = new THREE.Vector3().crossVectors(up, towards).normalize(), upright = new THREE.Vector3().crossVectors(towards, right);
    const tall = 0.94 * Math.tan(camera.fov * Math.PI / 360), wide = tall * aspect;
    const most = {right: -Infinity, left: -Infinity, above: -Infinity, below: -Infinity};
    for (const point of points) {
      const p = point.clone().sub(middle), x = p.dot(right), y = p.dot(upright), near = p.dot(towards);
      most.right = Math.max(most.right, near + (x + around) / wide);
      most.left = Math.max(most.left, near + (-x + around) / wide);
      most.above = Math.max(most.above, near + (y + around) / tall);
      most.below = Math.max(most.below, near + (-y + around) / tall);
    }
    const distance = Math.max(0.05 * size, (most.right + most.left) / 2, (most.above + most.below) / 2);
    controls.target.copy(middle).addScaledVector(right, wide * (most.right - most.left) / 2).addScaledVector(upright, tall * (most.above - most.below) / 2);
    camera.position.copy(controls.target).addScaledVector(towards, distance);
    controls.update();
  };
  const moved = (act) => () => {
    home = false;
    act();
    controls.update();
    changed();
  };
  const turn = (angle) => moved(() => camera.position.sub(controls.target).applyAxisAngle(camera.up, angle).add(controls.target));
  const zoom = (factor) => moved(() => camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target));
  const reset = () => {
    home = true;
    aspect = 0;
    changed();
  };
  controls.addEventListener('start', () => { home = false; });
  controls.addEventListener('change', changed);
  const button = (text, title, act) => el('button', {type: 'button', title, 'aria-label': title, onclick: act}, text);
  const buttons = el('div', {class: 'buttons'}, button('⟲', 'turn left', turn(-0.35)), button('⟳', 'turn right', turn(0.35)),
                     button('+', 'nearer', zoom(0.8)), button('−', 'farther', zoom(1.25)), button('⌂', 'as at first', reset));
  const bar = el('span', {class: 'bar-of-scale'}), words = el('span');
  const scale = el('div', {class: 'scale', title: 'a length in the plane through the middle of the picture'}, words, bar);
  const measure = (width, height) => {
    const pixels = height / (2 * Math.tan(camera.fov * Math.PI / 360) * Math.max(1e-9, camera.position.distanceTo(controls.target)));  // of a mm
    const length = round125(0.25 * width / pixels);
    bar.style.width = `${length * pixels}px`;
    words.textContent = `${num(length)} mm`;
  };
  const fit = (width, height) => {
    if (aspect !== width / height) {
      aspect = camera.aspect = width / height;
      camera.updateProjectionMatrix();
      if (home) place();
    }
    measure(width, height);
  };
  return {camera, buttons, scale, fit};
}
