// What lies under a point of the screen.
import * as THREE from 'three';
import { TYPE_NAMES, stratumIds } from './data.js';

// Points and curves are picked within this many pixels.
const REACH = 9;

/// The sphere of the greatest radius, or -1.
export function thickest(data) {
  let best = -1;
  for (let v = 0; v < data.radii.length; ++v) if (best < 0 || data.radii[v] > data.radii[best]) best = v;
  return best;
}

export function describeSphere(data, v, kind) {
  return { kind: kind ?? `${TYPE_NAMES[data.types[v]]} sphere`, sphere: v, radius: data.radii[v], position: positionOf(data, v) };
}

function positionOf(data, v) {
  return [0, 1, 2].map((i) => data.origin[i] + data.centers[3 * v + i]);
}

/// `visible(key)` tells which layers are on; `clipped(point)` whether the clipping plane hides a point.
export function pick(data, sheets, camera, size, x, y, visible, clipped) {
  const ray = new THREE.Raycaster();
  ray.setFromCamera(new THREE.Vector2((2 * x) / size.width - 1, 1 - (2 * y) / size.height), camera);
  let hit = null;
  if (visible('mesh')) {
    const hits = ray.intersectObject(new THREE.Mesh(sheets, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide })));
    hit = hits.find((h) => !clipped(h.point)) ?? null;
  }
  const limit = hit ? hit.distance * 1.02 : Infinity;
  return nearPoint(data, camera, size, x, y, visible, clipped, limit) ?? (hit && faceAt(data, hit));
}

function faceAt(data, hit) {
  const face = hit.faceIndex;
  const corners = data.faces.subarray(3 * face, 3 * face + 3);
  const position = hit.object.geometry.getAttribute('position');
  const p = [0, 1, 2].map((k) => new THREE.Vector3().fromBufferAttribute(position, 3 * face + k));
  const share = THREE.Triangle.getBarycoord(hit.point, ...p, new THREE.Vector3()) ?? new THREE.Vector3(1, 0, 0);
  const weights = share.toArray();
  const mix = (value) => weights.reduce((sum, w, k) => sum + w * value(corners[k]), 0);
  return { kind: 'face', face, sheet: data.sheetOfFace[face], spheres: [...corners], radius: mix((v) => data.radii[v]),
           position: [0, 1, 2].map((i) => data.origin[i] + mix((v) => data.centers[3 * v + i])) };
}

// The nearest vertex on the screen of the junctions, then seams, curves and boundaries that are shown.
function nearPoint(data, camera, size, x, y, visible, clipped, limit) {
  const at = new THREE.Vector3();
  const first = stratumIds(data);
  let best = null, bestDistance = REACH;
  const offer = (v, describe) => {
    at.fromArray(data.centers, 3 * v);
    if (clipped(at) || camera.position.distanceTo(at) > limit) return;
    at.project(camera);
    const distance = Math.hypot(((at.x + 1) / 2) * size.width - x, ((1 - at.y) / 2) * size.height - y);
    if (distance < bestDistance) bestDistance = distance, best = describe();
  };
  if (visible('junctions')) data.junctions.forEach((v, k) => offer(v, () => ({ ...describeSphere(data, v, 'junction'), junction: k, stratum: first.junctions + k })));
  if (best) return best;
  for (const [key, kind, curves] of [['seams', 'seam', data.seams], ['curves', 'medial curve', data.curves], ['boundaries', 'boundary', data.boundaries]])
    if (visible(key)) curves.forEach((curve, k) => curve.forEach((v) => offer(v, () => ({ ...describeSphere(data, v, kind), curve: k, stratum: first[key] + k }))));
  return best;
}
