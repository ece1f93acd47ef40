// The data that the tool has put into the page, as typed arrays. Positions are relative to `origin` (input units).

const KINDS = { f32: Float32Array, i32: Int32Array, u8: Uint8Array };

function decode({ kind, base64 }) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return new KINDS[kind](bytes.buffer);
}

/// Curves are given as all their vertices one after the other, and where each begins.
function curves({ start, vertices }) {
  const list = [];
  for (let k = 0; k + 1 < start.length; ++k) list.push(vertices.subarray(start[k], start[k + 1]));
  return list;
}

export function readData(element) {
  const raw = JSON.parse(element.textContent);
  const a = {};
  for (const [name, array] of Object.entries(raw.arrays)) a[name] = decode(array);
  return {
    name: raw.name,
    facts: raw.facts,
    origin: raw.origin,
    solid: { positions: a.solidPositions, triangles: a.solidTriangles },
    reconstruction: a.surfacePositions && { positions: a.surfacePositions, triangles: a.surfaceTriangles },
    centers: a.centers,
    radii: a.radii,
    types: a.types,
    faces: a.faces,
    sheetOfFace: a.sheetOfFace,
    sheets: raw.sheets,
    seams: curves({ start: a.seamStart, vertices: a.seamVertices }),
    boundaries: curves({ start: a.boundaryStart, vertices: a.boundaryVertices }),
    curves: curves({ start: a.curveStart, vertices: a.curveVertices }),
    junctions: a.junctions,
  };
}

/// The first ids of strata (docs/structure-schema.md) of each kind; those of sheets begin at 0.
export function stratumIds(data) {
  const seams = data.sheets, boundaries = seams + data.seams.length, curves = boundaries + data.boundaries.length;
  return { seams, boundaries, curves, junctions: curves + data.curves.length };
}

export const TYPE_NAMES = ['sheet', 'seam', 'junction', 'sharp line', 'corner'];
