// How long the viewer takes to open a large result, and how fluently it turns: 20 000 faces and a solid of 100 000
// triangles, software rendering, 1280 x 720. Run in build/<preset>/viewer (for its packages):
//   MATSTRUCT_TOOL=../matstruct node ../../../bench/viewer_limits.mjs
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const { chromium } = createRequire(`${process.cwd()}/`)('playwright-core');
const executablePath = process.env.MATSTRUCT_BROWSER ?? ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);
const folder = mkdtempSync(join(tmpdir(), 'matstruct-limits-'));

/// Vertices and triangles of a grid of n x m quads, its points given by place(u, v).
function grid(n, m, place) {
  const points = [], triangles = [];
  for (let i = 0; i <= n; ++i) for (let j = 0; j <= m; ++j) points.push(place(i / n, j / m));
  for (let i = 0; i < n; ++i)
    for (let j = 0; j < m; ++j) {
      const a = i * (m + 1) + j, b = a + m + 1;
      triangles.push([a, b, b + 1], [a, b + 1, a + 1]);
    }
  return { points, triangles };
}

const sheet = grid(100, 100, (u, v) => [u - 0.5, v - 0.5, 0.1 * Math.sin(6 * u) * Math.cos(5 * v)]);
const faces = sheet.triangles.map((f) => [...f].sort((a, b) => a - b));
const edges = new Map();
for (const [a, b, c] of faces) for (const e of [[a, b], [a, c], [b, c]]) edges.set(e.join(' '), e);
writeFileSync(join(folder, 'large.ma'), [`${sheet.points.length} ${edges.size} ${faces.length}`,
  ...sheet.points.map((p) => `v ${p.join(' ')} 0.05 0`), ...[...edges.keys()].map((e) => `e ${e}`), ...faces.map((f) => `f ${f.join(' ')}`), ''].join('\n'));
const solid = grid(250, 200, (u, v) => {
  const a = 2 * Math.PI * u, b = Math.PI * v;
  return [0.7 * Math.sin(b) * Math.cos(a), 0.7 * Math.sin(b) * Math.sin(a), 0.3 * Math.cos(b)];
});
writeFileSync(join(folder, 'large.solid.ply'), ['ply', 'format ascii 1.0', `element vertex ${solid.points.length}`, 'property double x',
  'property double y', 'property double z', `element face ${solid.triangles.length}`, 'property list uchar int vertex_indices', 'end_header',
  ...solid.points.map((p) => p.join(' ')), ...solid.triangles.map((t) => `3 ${t.join(' ')}`), ''].join('\n'));
execFileSync(process.env.MATSTRUCT_TOOL, ['view', folder, '--quiet']);

const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-quic', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
const begin = performance.now();
await page.goto(pathToFileURL(join(folder, 'large.html')).href);
await page.waitForFunction(() => window.matstruct?.ready);
const load = performance.now() - begin;
// A drag with the mouse, as fast as frames come.
await page.evaluate(() => {
  const { viewer } = window.matstruct;
  window.frames_drawn = 0;
  const draw = viewer.renderer.render.bind(viewer.renderer);
  viewer.renderer.render = (...a) => (draw(...a), viewer.renderer.getContext().finish(), ++window.frames_drawn);
});
await page.mouse.move(400, 300);
await page.mouse.down();
await page.mouse.move(410, 300);
await page.evaluate(() => (window.frames_drawn = 0));
const start = performance.now();
for (let k = 0; performance.now() - start < 4000; ++k) await page.mouse.move(400 + (k % 200), 300 + (k % 90));
const frames = await page.evaluate(() => window.frames_drawn);
const rate = frames / ((performance.now() - start) / 1000);
await page.mouse.up();
await browser.close();
rmSync(folder, { recursive: true });
console.log(`${faces.length} faces, ${solid.triangles.length} triangles of the solid`);
console.log(`open: ${(load / 1000).toFixed(2)} s (wanted < 3)`);
console.log(`turn: ${rate.toFixed(1)} frames/s (wanted > 20)`);
