// The page: a scene drawn on demand, and the controls beside it. Its state can be given in the address, as
// #layers=solid,mesh&view=iso&color=radius&theme=dark&clip=x,0.5&explode=0.3&bare=1
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { COLORS, rampColor } from './colors.js';
import { readData } from './data.js';
import { colorSheets, explodeSheets, makeLayers, radiusRange } from './layers.js';
import { describeSphere, pick, thickest } from './picking.js';

const VIEWS = { iso: [1, -1.25, 0.8], front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0], top: [0, 0, 1], bottom: [0, 0, -1] };
const AXES = ['x', 'y', 'z'];
// Scenes of more triangles than this are drawn coarsely while the view moves: with so many pixels per CSS pixel, and
// without the layers that cost most and tell least in motion.
const HEAVY = 20000, COARSE = 0.5, AT_REST = ['wire', 'solid'];
// Pixels of the longer side of a saved picture: 300 per inch on the width of a page.
const PICTURE = 2560;

const $ = (id) => document.getElementById(id);
const number = (x) => Number(x.toPrecision(5)).toString();

const triangles = (layers) => layers.reduce((sum, layer) => sum + (layer.shown ? layer.triangles : 0), 0);

class Viewer {
  constructor(data) {
    this.data = data;
    this.box = new THREE.Box3().setFromArray(data.solid.positions.length ? data.solid.positions : data.centers);
    this.middle = this.box.getCenter(new THREE.Vector3());
    this.diagonal = this.box.getSize(new THREE.Vector3()).length() || 1;
    const { list, sheets } = makeLayers(data);
    // A heavy scene is drawn with more pixels at rest instead, so that it turns without the price of it.
    this.smoothed = triangles(list) <= HEAVY;
    this.renderer = new THREE.WebGLRenderer({ canvas: $('canvas'), antialias: this.smoothed, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, this.diagonal / 100, this.diagonal * 20);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, $('canvas'));
    this.clip = { axis: null, share: 0.5, plane: new THREE.Plane() };
    this.frame = 0;
    this.fitted = 'iso';  // the named view that is still untouched, or null
    this.picked = null;
    this.layers = new Map(list.map((layer) => [layer.key, layer]));
    this.sheets = sheets;
    const sky = new THREE.HemisphereLight(0xffffff, 0x8a94a0, 1.6), lamp = new THREE.DirectionalLight(0xffffff, 1.6);
    this.camera.add(lamp);
    lamp.position.set(-0.5, 0.8, 1);
    this.scene.add(sky, this.camera);
    this.marker = new THREE.Mesh(new THREE.SphereGeometry(1, 48, 24),
      new THREE.MeshLambertMaterial({ color: COLORS.spheres, transparent: true, opacity: 0.55, depthWrite: false, depthTest: false }));
    this.marker.renderOrder = 1;  // over everything: where a part is thick, sheets hide its inside
    this.marker.visible = false;
    this.scene.add(this.marker);
    colorSheets(data, sheets, 'sheet');
    for (const layer of list) this.show(layer.key, layer.shown);
    this.view('iso');
    this.controls.addEventListener('change', () => this.draw());
    addEventListener('wheel', () => (this.fitted = null), { capture: true, passive: true });
    this.controls.addEventListener('start', () => (this.fitted = null));
    this.controls.addEventListener('start', () => this.setCoarse(triangles(list) > HEAVY));
    this.controls.addEventListener('end', () => this.setCoarse(false));
    addEventListener('resize', () => this.resize());
    this.setCoarse(false);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = $('stage');
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const { right, below } = this.covered();
    this.camera.setViewOffset(width, height, right / 2, below / 2, width, height);
    this.camera.updateProjectionMatrix();
    if (this.fitted) this.view(this.fitted);
    this.draw();
  }

  /// Pixels that the panel covers: at the right side, or below on a narrow screen.
  covered() {
    if (document.documentElement.hasAttribute('data-bare')) return { right: 0, below: 0 };
    return $('stage').clientWidth > 700 ? { right: 280, below: 0 } : { right: 0, below: 0.4 * $('stage').clientHeight };
  }

  setCoarse(coarse) {
    this.renderer.setPixelRatio(coarse ? COARSE : this.smoothed ? Math.min(devicePixelRatio, 2) : 2);
    for (const key of AT_REST) {
      const layer = this.layers.get(key);
      if (layer.object) layer.object.visible = layer.shown && !coarse;
    }
    this.resize();
  }

  draw() {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.drawNow();
    });
  }

  drawNow() {
    this.renderer.render(this.scene, this.camera);
  }

  shown(key) {
    return this.layers.get(key)?.shown ?? false;
  }

  show(key, on) {
    const layer = this.layers.get(key);
    layer.shown = on;
    if (on && !layer.object) this.scene.add((layer.object = layer.make()));
    if (layer.object) layer.object.visible = on;
    this.draw();
  }

  view(name) {
    this.fitted = name;
    const direction = new THREE.Vector3(...VIEWS[name]).normalize();
    if (Math.abs(direction.z) === 1) direction.y -= 1e-3;  // off the pole, where the camera would have no upright
    this.controls.target.copy(this.middle);
    this.camera.position.copy(this.middle).addScaledVector(direction, this.fittingDistance(direction));
    this.controls.update();
    this.draw();
  }

  /// The distance from which the whole box is seen, with some room around it.
  fittingDistance(direction) {
    const { clientWidth: width, clientHeight: height } = $('stage'), { right: atRight, below } = this.covered();
    const slope = Math.tan((this.camera.fov / 2) * (Math.PI / 180)) / 1.08;
    const wide = (slope * (width - atRight)) / height, high = (slope * (height - below)) / height;
    const right = new THREE.Vector3().crossVectors(this.camera.up, direction).normalize();
    const up = new THREE.Vector3().crossVectors(direction, right);
    let distance = this.diagonal / 20;
    for (let k = 0; k < 8; ++k) {
      const corner = new THREE.Vector3(...AXES.map((a, i) => (k >> i & 1 ? this.box.max : this.box.min)[a])).sub(this.middle);
      const across = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / high);
      distance = Math.max(distance, across + corner.dot(direction));
    }
    return distance;
  }

  turn(right, up) {
    this.fitted = null;
    const arm = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target).applyAxisAngle(new THREE.Vector3(1, 0, 0), -Math.PI / 2));
    arm.theta += right;
    arm.phi = Math.min(Math.max(arm.phi - up, 0.01), Math.PI - 0.01);
    this.camera.position.setFromSpherical(arm).applyAxisAngle(new THREE.Vector3(1, 0, 0), Math.PI / 2).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  zoom(factor) {
    this.fitted = null;
    this.camera.position.lerpVectors(this.controls.target, this.camera.position, factor);
    this.controls.update();
    this.draw();
  }

  setClip(axis, share) {
    this.clip.axis = axis;
    this.clip.share = share;
    const k = AXES.indexOf(axis);
    if (k >= 0) {
      const low = this.box.min.getComponent(k), high = this.box.max.getComponent(k);
      this.clip.plane.set(new THREE.Vector3(...AXES.map((a) => (a === axis ? -1 : 0))), low + share * (high - low));
    }
    this.renderer.clippingPlanes = k >= 0 ? [this.clip.plane] : [];
    this.draw();
  }

  explode(share) {
    explodeSheets(this.data, this.sheets, share);
    this.draw();
  }

  color(mode) {
    colorSheets(this.data, this.sheets, mode);
    $('legend').hidden = mode !== 'radius';
    this.draw();
  }

  theme(name) {
    document.documentElement.dataset.theme = name;
    this.scene.background = new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue('--paper').trim());
    this.draw();
  }

  pickAt(x, y) {
    const rect = $('canvas').getBoundingClientRect();
    const clipped = (p) => this.clip.axis !== null && this.clip.plane.distanceToPoint(p) < 0;
    this.select(pick(this.data, this.sheets, this.camera, rect, x - rect.left, y - rect.top, (key) => this.shown(key), clipped));
  }

  goToThickest() {
    this.fitted = null;
    const v = thickest(this.data);
    if (v < 0) return;
    const shift = new THREE.Vector3().fromArray(this.data.centers, 3 * v).sub(this.controls.target);
    this.controls.target.add(shift);
    this.camera.position.add(shift);
    this.controls.update();
    this.select(describeSphere(this.data, v, 'thickest place'));
  }

  /// What is drawn now, with its legend and as if there were no panel, as a large PNG in the reader's downloads.
  savePicture() {
    const { clientWidth: width, clientHeight: height } = $('stage'), scale = Math.max(1, PICTURE / Math.max(width, height));
    this.renderer.setPixelRatio(this.smoothed ? scale : 2 * scale);
    this.camera.clearViewOffset();
    this.drawNow();
    const picture = Object.assign(document.createElement('canvas'), { width: Math.floor(width * scale), height: Math.floor(height * scale) });
    const pen = picture.getContext('2d');
    pen.drawImage($('canvas'), 0, 0, picture.width, picture.height);
    this.setCoarse(false);
    pen.scale(scale, scale);
    if (!$('legend').hidden) drawLegend(pen, height);
    picture.toBlob((blob) => {
      const href = URL.createObjectURL(blob);
      Object.assign(document.createElement('a'), { href, download: `${this.data.name}.png` }).click();
      setTimeout(() => URL.revokeObjectURL(href), 10000);
    });
  }

  select(found) {
    this.picked = found;
    this.marker.visible = found !== null && found.radius > 0;
    if (this.marker.visible) {
      this.marker.position.set(...found.position.map((x, i) => x - this.data.origin[i]));
      this.marker.scale.setScalar(found.radius);
    }
    describe(found);
    this.draw();
  }
}

function describe(found) {
  const box = $('picked');
  box.replaceChildren();
  if (!found) {
    box.append(Object.assign(document.createElement('p'), { textContent: 'Nothing there.' }));
    return;
  }
  const rows = { Element: found.kind };
  if (found.face !== undefined) rows.Face = found.face;
  if (found.sheet !== undefined) rows.Sheet = found.sheet;
  if (found.junction !== undefined) rows.Junction = found.junction;
  if (found.curve !== undefined) rows.Curve = found.curve;
  if (found.stratum !== undefined) rows.Stratum = found.stratum;
  if (found.sphere !== undefined) rows.Sphere = found.sphere;
  if (found.spheres) rows.Spheres = found.spheres.join(', ');
  rows.Radius = number(found.radius);
  rows.Thickness = number(2 * found.radius);
  rows.Place = found.position.map(number).join(', ');
  const list = document.createElement('dl');
  for (const [name, value] of Object.entries(rows))
    list.append(Object.assign(document.createElement('dt'), { textContent: name }), Object.assign(document.createElement('dd'), { textContent: value }));
  box.append(list);
  box.scrollIntoView({ block: 'nearest' });
}

function button(text, action) {
  const b = Object.assign(document.createElement('button'), { type: 'button', textContent: text });
  b.addEventListener('click', () => action(b));
  return b;
}

/// Nothing but one layer; if it is so already, the layers of the first picture.
function showOnly(key) {
  const boxes = [...document.querySelectorAll('[data-layer]')];
  const alone = boxes.every((box) => box.checked === (box.dataset.layer === key));
  for (const box of boxes) if (box.checked !== (alone ? box.defaultChecked : box.dataset.layer === key)) box.click();
}

function makePanel(viewer, data) {
  document.title = `${data.name} - matstruct`;
  $('name').textContent = data.name;
  $('facts').textContent = data.facts;
  for (const layer of viewer.layers.values()) {
    const label = document.createElement('label'), box = Object.assign(document.createElement('input'), { type: 'checkbox', checked: layer.shown, defaultChecked: layer.shown });
    box.dataset.layer = layer.key;
    box.addEventListener('change', () => viewer.show(layer.key, box.checked));
    const swatch = Object.assign(document.createElement('span'), { className: 'swatch' });
    swatch.style.background = layer.color;
    label.append(box, swatch, layer.name);
    if (layer.count !== null) label.append(Object.assign(document.createElement('span'), { className: 'count', textContent: layer.count }));
    const only = button('only', () => showOnly(layer.key));
    only.dataset.only = layer.key;
    only.setAttribute('aria-label', `Only ${layer.name}`);
    const row = Object.assign(document.createElement('div'), { className: 'layer' });
    row.append(label, only);
    $('layers').append(row);
  }
  for (const name of Object.keys(VIEWS)) $('views').append(button(name, () => viewer.view(name)));
  const axes = new Map();
  for (const axis of [null, ...AXES]) {
    const b = button(axis ?? 'off', () => setClip(axis, Number($('clip').value)));
    axes.set(axis, b);
    $('clip-axes').append(b);
  }
  const setClip = (axis, share) => {
    $('clip').disabled = axis === null;
    $('clip').value = share;
    for (const [name, b] of axes) b.setAttribute('aria-pressed', String(name === axis));
    viewer.setClip(axis, share);
  };
  setClip(null, 0.5);
  $('clip').addEventListener('input', () => setClip(viewer.clip.axis, Number($('clip').value)));
  $('explode').addEventListener('input', () => viewer.explode(Number($('explode').value)));
  const setColor = (mode) => {
    document.querySelector(`input[name=color][value=${mode}]`).checked = true;
    viewer.color(mode);
  };
  for (const b of document.querySelectorAll('input[name=color]')) b.addEventListener('change', () => setColor(b.value));
  const setTheme = (name) => viewer.theme(name);
  const otherTheme = () => setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
  $('theme').addEventListener('click', otherTheme);
  $('thickest').addEventListener('click', () => viewer.goToThickest());
  $('save').addEventListener('click', () => viewer.savePicture());
  $('help-button').addEventListener('click', () => $('help').showModal());
  makeLegend(data);
  return { setClip, setColor, setTheme, otherTheme };
}

function makeLegend(data) {
  const [low, high] = radiusRange(data);
  $('legend-min').textContent = number(low);
  $('legend-max').textContent = number(high);
  const pen = $('ramp').getContext('2d');
  for (let y = 0; y < 160; ++y) {
    pen.fillStyle = `rgb(${rampColor(1 - y / 159).map((c) => Math.round(255 * c)).join()})`;
    pen.fillRect(0, y, 16, 1);
  }
}

/// The legend of the radii at the lower left of a picture, in CSS pixels.
function drawLegend(pen, height) {
  pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--ink').trim();
  pen.font = '14px system-ui, sans-serif';
  pen.drawImage($('ramp'), 24, height - 184);
  pen.fillText($('legend-max').textContent, 48, height - 173);
  pen.fillText('radius, units of the input', 48, height - 99);
  pen.fillText($('legend-min').textContent, 48, height - 26);
}

function makeKeys(viewer, panel) {
  const layerBoxes = [...document.querySelectorAll('[data-layer]')];
  const nudge = (id, step) => {
    const slider = $(id);
    if (slider.disabled) return;
    slider.value = Number(slider.value) + step;
    slider.dispatchEvent(new Event('input'));
  };
  const keys = [
    ['?', 'this help', () => $('help').showModal()],
    ...layerBoxes.map((box, k) => [String(k + 1), `show or hide: ${viewer.layers.get(box.dataset.layer).name}`, () => box.click()]),
    ['c', 'colour by sheet or radius', () => panel.setColor($('legend').hidden ? 'radius' : 'sheet')],
    ['t', 'go to the thickest place', () => viewer.goToThickest()],
    ...AXES.map((a) => [a, `clipping plane across ${a}, or off`, () => panel.setClip(viewer.clip.axis === a ? null : a, viewer.clip.share)]),
    ['[', 'move the clipping plane back', () => nudge('clip', -0.02)],
    [']', 'move the clipping plane on', () => nudge('clip', 0.02)],
    ['e', 'sheets further apart', () => nudge('explode', 0.05)],
    ['w', 'sheets closer together', () => nudge('explode', -0.05)],
    ['r', 'first view', () => viewer.view('iso')],
    ['d', 'dark or light', panel.otherTheme],
    ['s', 'save the picture', () => viewer.savePicture()],
    ['Escape', 'forget what was picked', () => viewer.select(null)],
    ['ArrowLeft', 'turn left', () => viewer.turn(-0.1, 0)],
    ['ArrowRight', 'turn right', () => viewer.turn(0.1, 0)],
    ['ArrowUp', 'turn up', () => viewer.turn(0, 0.1)],
    ['ArrowDown', 'turn down', () => viewer.turn(0, -0.1)],
    ['+', 'nearer', () => viewer.zoom(0.9)],
    ['-', 'farther', () => viewer.zoom(1.1)],
  ];
  for (const [key, text] of keys)
    $('keys').append(Object.assign(document.createElement('dt'), { textContent: key }), Object.assign(document.createElement('dd'), { textContent: text }));
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || $('help').open) return;
    if (event.target.matches('input[type=range], input[type=radio]') && event.key.startsWith('Arrow')) return;
    const found = keys.find(([key]) => key === event.key);
    if (!found) return;
    event.preventDefault();
    found[2]();
  });
}

function makePicking(viewer) {
  let down = null;
  $('canvas').addEventListener('pointerdown', (e) => (down = [e.clientX, e.clientY]));
  $('canvas').addEventListener('pointerup', (e) => {
    if (down && Math.hypot(e.clientX - down[0], e.clientY - down[1]) < 4) viewer.pickAt(e.clientX, e.clientY);
    down = null;
  });
}

function applyAddress(viewer, panel) {
  const wanted = new URLSearchParams(location.hash.slice(1));
  const dark = matchMedia('(prefers-color-scheme: dark)').matches;
  panel.setTheme(wanted.get('theme') ?? (dark ? 'dark' : 'light'));
  if (wanted.has('bare')) document.documentElement.setAttribute('data-bare', '');
  if (wanted.has('layers')) {
    const keys = wanted.get('layers').split(',');
    for (const box of document.querySelectorAll('[data-layer]')) {
      box.checked = keys.includes(box.dataset.layer);
      viewer.show(box.dataset.layer, box.checked);
    }
  }
  if (wanted.has('color')) panel.setColor(wanted.get('color'));
  if (wanted.has('clip')) {
    const [axis, share] = wanted.get('clip').split(',');
    panel.setClip(axis, Number(share ?? 0.5));
  }
  if (wanted.has('explode')) {
    $('explode').value = wanted.get('explode');
    viewer.explode(Number(wanted.get('explode')));
  }
  viewer.resize();
  viewer.view(VIEWS[wanted.get('view')] ? wanted.get('view') : 'iso');
}

try {
  const begin = performance.now();
  const data = readData($('data'));
  const viewer = new Viewer(data);
  const panel = makePanel(viewer, data);
  makeKeys(viewer, panel);
  makePicking(viewer);
  applyAddress(viewer, panel);
  viewer.drawNow();
  window.matstruct = { viewer, ready: true, milliseconds: performance.now() - begin };
} catch (error) {
  $('failure').hidden = false;
  $('failure').textContent = `This page cannot be shown: ${error.message}`;
  throw error;
}
