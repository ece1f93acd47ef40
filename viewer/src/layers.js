// The three.js objects of each layer.
import * as THREE from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { COLORS, rampLinear, sheetColor } from './colors.js';

// More spheres than this hide each other and take long to draw: every n-th is shown, and the label says so.
const MOST_SPHERES = 1500;

/// A surface like glass: clear where it faces the eye, denser towards its outline.
function glass() {
  return new THREE.ShaderMaterial({
    transparent: true,
    depthWrite: false,
    side: THREE.DoubleSide,
    clipping: true,
    uniforms: { tint: { value: new THREE.Color(COLORS.solid) } },
    vertexShader: `
      #include <clipping_planes_pars_vertex>
      varying vec3 seen;
      void main() {
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        seen = mvPosition.xyz;
        gl_Position = projectionMatrix * mvPosition;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: `
      #include <clipping_planes_pars_fragment>
      uniform vec3 tint;
      varying vec3 seen;
      void main() {
        #include <clipping_planes_fragment>
        vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
        float slant = 1.0 - abs(dot(normal, normalize(seen)));
        gl_FragColor = vec4(tint, 0.07 + 0.33 * slant * slant * slant);
        #include <colorspace_fragment>
      }`,
  });
}

function surfaceGeometry({ positions, triangles }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(triangles.buffer), 1));
  return geometry;
}

/// Triangles with corners of their own, so that each has its sheet's colour and moves with it.
function sheetGeometry(data) {
  const geometry = new THREE.BufferGeometry();
  const positions = new Float32Array(9 * data.sheetOfFace.length);
  for (let k = 0; k < data.faces.length; ++k) positions.set(data.centers.subarray(3 * data.faces[k], 3 * data.faces[k] + 3), 3 * k);
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(positions.length), 3));
  return geometry;
}

function segments(data, curves) {
  const points = [];
  for (const curve of curves)
    for (let k = 0; k + 1 < curve.length; ++k)
      for (const v of [curve[k], curve[k + 1]]) points.push(...data.centers.subarray(3 * v, 3 * v + 3));
  return points;
}

function fatLines(data, curves, color, width) {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(segments(data, curves));
  const lines = new LineSegments2(geometry, new LineMaterial({ color, linewidth: width, clipping: true }));
  lines.frustumCulled = false;
  return lines;
}

function discTexture() {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 32;
  const pen = canvas.getContext('2d');
  pen.fillStyle = '#fff';
  pen.arc(16, 16, 15, 0, 2 * Math.PI);
  pen.fill();
  return new THREE.CanvasTexture(canvas);
}

function dots(data, vertices, color, size) {
  const geometry = new THREE.BufferGeometry();
  const positions = new Float32Array(3 * vertices.length);
  vertices.forEach((v, k) => positions.set(data.centers.subarray(3 * v, 3 * v + 3), 3 * k));
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  return new THREE.Points(geometry, new THREE.PointsMaterial({ color, size, sizeAttenuation: false, map: discTexture(), alphaTest: 0.5 }));
}

function spheres(data) {
  const shown = [];
  for (let v = 0; v < data.radii.length; ++v) if (data.radii[v] > 0) shown.push(v);
  const step = Math.max(1, Math.ceil(shown.length / MOST_SPHERES));
  const ids = shown.filter((_, k) => k % step === 0);
  const mesh = new THREE.InstancedMesh(new THREE.IcosahedronGeometry(1, 7), new THREE.MeshLambertMaterial({ color: COLORS.spheres }), ids.length);
  const matrix = new THREE.Matrix4();
  ids.forEach((v, k) => {
    const r = data.radii[v];
    mesh.setMatrixAt(k, matrix.makeScale(r, r, r).setPosition(data.centers[3 * v], data.centers[3 * v + 1], data.centers[3 * v + 2]));
  });
  mesh.frustumCulled = false;
  mesh.userData = { step };
  return mesh;
}

/// All layers, as { key, name, triangles, count, object, shown, color }; objects that few people switch on are made when needed.
export function makeLayers(data) {
  const faces = data.sheetOfFace.length;
  const sheets = sheetGeometry(data);
  const meshMaterial = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, flatShading: true,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  const wire = () => {
    const object = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: COLORS.wire, transparent: true, opacity: 0.45 }));
    const index = new Uint32Array(6 * faces);
    for (let f = 0; f < faces; ++f) index.set([3 * f, 3 * f + 1, 3 * f + 1, 3 * f + 2, 3 * f + 2, 3 * f], 6 * f);
    object.geometry.setAttribute('position', sheets.getAttribute('position'));
    object.geometry.setIndex(new THREE.BufferAttribute(index, 1));
    object.frustumCulled = false;
    return object;
  };
  const list = [
    { key: 'solid', name: 'Solid', triangles: data.solid.triangles.length / 3, count: data.solid.triangles.length / 3, shown: true, color: COLORS.solid,
      make: () => new THREE.Mesh(surfaceGeometry(data.solid), glass()) },
    { key: 'mesh', name: 'Sheets', triangles: faces, count: data.sheets, shown: true, color: COLORS.mesh, make: () => new THREE.Mesh(sheets, meshMaterial) },
    { key: 'wire', name: 'Mesh edges', triangles: 2 * faces, count: null, shown: faces <= 30000, color: COLORS.wire, make: wire },
    { key: 'seams', name: 'Seams', triangles: 0, count: data.seams.length, shown: true, color: COLORS.seams, make: () => fatLines(data, data.seams, COLORS.seams, 2.5) },
    { key: 'junctions', name: 'Junctions', triangles: 0, count: data.junctions.length, shown: true, color: COLORS.junctions, make: () => dots(data, data.junctions, COLORS.junctions, 9) },
    { key: 'boundaries', name: 'Boundaries', triangles: 0, count: data.boundaries.length, shown: true, color: COLORS.boundaries, make: () => fatLines(data, data.boundaries, COLORS.boundaries, 1.5) },
    { key: 'curves', name: 'Medial curves', triangles: 0, count: data.curves.length, shown: true, color: COLORS.curves, make: () => fatLines(data, data.curves, COLORS.curves, 2.5) },
    { key: 'spheres', name: 'Spheres', triangles: 1280 * Math.min(data.radii.length, MOST_SPHERES), count: data.radii.length, shown: false, color: COLORS.spheres, make: () => spheres(data) },
  ];
  if (data.reconstruction)
    list.push({ key: 'surface', name: 'Reconstruction', triangles: data.reconstruction.triangles.length / 3, count: data.reconstruction.triangles.length / 3, shown: false, color: COLORS.surface,
      make: () => new THREE.Mesh(surfaceGeometry(data.reconstruction), new THREE.MeshLambertMaterial({ color: COLORS.surface, flatShading: true, side: THREE.DoubleSide })) });
  return { list, sheets };
}

export function colorSheets(data, sheets, mode) {
  const color = sheets.getAttribute('color');
  const [low, high] = radiusRange(data);
  for (let k = 0; k < data.faces.length; ++k)
    color.array.set(mode === 'radius' ? rampLinear((data.radii[data.faces[k]] - low) / (high - low || 1))
                                      : sheetColor(data.sheetOfFace[Math.floor(k / 3)]), 3 * k);
  color.needsUpdate = true;
}

export function radiusRange(data) {
  let low = Infinity, high = 0;
  for (const r of data.radii) low = Math.min(low, r), high = Math.max(high, r);
  return [Math.min(low, high), high];
}

/// Moves every sheet away from the middle of the mesh by `share` of its distance from there.
export function explodeSheets(data, sheets, share) {
  const sum = new Float64Array(3 * data.sheets), corners = new Float64Array(data.sheets);
  for (let k = 0; k < data.faces.length; ++k) {
    const s = data.sheetOfFace[Math.floor(k / 3)];
    ++corners[s];
    for (let i = 0; i < 3; ++i) sum[3 * s + i] += data.centers[3 * data.faces[k] + i];
  }
  const position = sheets.getAttribute('position');
  for (let k = 0; k < data.faces.length; ++k) {
    const s = data.sheetOfFace[Math.floor(k / 3)];
    for (let i = 0; i < 3; ++i) position.array[3 * k + i] = data.centers[3 * data.faces[k] + i] + share * 1.5 * sum[3 * s + i] / corners[s];
  }
  position.needsUpdate = true;
  sheets.boundingSphere = null;
}
