// The interactive page in a real browser: node --test page.test.mjs, run in a folder with playwright-core. Needs
// MATSTRUCT_TOOL (the program) and MATSTRUCT_SOURCE; MATSTRUCT_BROWSER if chromium is not in PATH.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';

const { chromium } = createRequire(`${process.cwd()}/`)('playwright-core');
const { MATSTRUCT_TOOL: tool, MATSTRUCT_SOURCE: source } = process.env;
const executablePath = process.env.MATSTRUCT_BROWSER ?? ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);
const size = { width: 1000, height: 700 };
const folder = mkdtempSync(join(tmpdir(), 'matstruct-page-'));
const problems = [], requests = [];
let browser, page;

before(async () => {
  execFileSync(tool, ['compute', join(source, 'data/bracket.stl'), '-o', folder, '--gamma', '20', '--quiet']);
  execFileSync(tool, ['reconstruct', join(folder, 'bracket.ma'), '--tolerance', '1', '--quiet']);
  execFileSync(tool, ['view', folder, '--quiet']);
  browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-quic', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
  page = await browser.newPage({ viewport: size });
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(pathToFileURL(join(folder, 'bracket.html')).href);
  await page.waitForFunction(() => window.matstruct?.ready);
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

/// The spheres of the .ma file, read without the program.
function spheres() {
  const lines = readFileSync(join(folder, 'bracket.ma'), 'utf8').split('\n').filter((line) => line.startsWith('v '));
  return lines.map((line) => line.split(' ').slice(1).map(Number));
}

/// Bytes of what is drawn now.
const picture = () => page.evaluate(() => {
  window.matstruct.viewer.drawNow();
  return document.getElementById('canvas').toDataURL();
});
const layer = (key) => page.locator(`[data-layer=${key}]`);
const picked = () => page.locator('#picked').innerText();

test('loads from disk without errors and without the network', () => {
  assert.deepEqual(problems, []);
  assert.ok(requests.every((url) => url.startsWith('file:') || url.startsWith('data:') || url.startsWith('blob:')), requests.join());
});

test('says what it shows', async () => {
  assert.equal(await page.locator('h1').innerText(), 'bracket');
  assert.match(await page.locator('#facts').innerText(), new RegExp(`^${spheres().length} spheres`));
});

test('every layer changes the picture, and back', async () => {
  const all = await picture();
  for (const key of ['solid', 'mesh', 'wire', 'seams', 'junctions', 'boundaries', 'spheres', 'surface']) {
    const before = await picture();
    await layer(key).click();
    assert.notEqual(await picture(), before, key);
    await layer(key).click();
    assert.equal(await picture(), before, key);
  }
  assert.equal(await picture(), all);
});

test('only the seams: the picture is red lines on the background', async () => {
  const all = await picture();
  await page.locator('[data-only=seams]').click();
  for (const key of ['solid', 'mesh', 'wire', 'junctions', 'boundaries', 'curves']) assert.equal(await layer(key).isChecked(), false, key);
  const colors = await page.evaluate(() => {
    const { viewer } = window.matstruct;
    viewer.theme('light');
    viewer.drawNow();
    const gl = viewer.renderer.getContext();
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let red = 0, blue = 0;
    for (let k = 0; k < pixels.length; k += 4) {
      red += pixels[k] > pixels[k + 2] + 60;
      blue += pixels[k + 2] > pixels[k] + 60;
    }
    return { red, blue };
  });
  assert.ok(colors.red > 500, `${colors.red} red pixels`);
  assert.equal(colors.blue, 0);
  await page.locator('[data-only=seams]').click();
  assert.equal(await picture(), all);
});

test('the thickest place is the sphere of the greatest radius', async () => {
  await page.locator('#thickest').click();
  const all = spheres();
  const radius = Math.max(...all.map((s) => s[3]));
  const sphere = Number((await picked()).match(/Sphere\s+(\d+)/)[1]);
  assert.equal(all[sphere][3], radius);
  assert.ok((await picked()).includes(String(Number(radius.toPrecision(5)))), await picked());
});

test('a click names the face under it', async () => {
  await page.keyboard.press('r');
  await layer('junctions').uncheck();
  for (const key of ['seams', 'curves', 'boundaries']) await layer(key).uncheck();
  // Where the middle of the first face is on the screen, if nothing is before it.
  const at = await page.evaluate(() => {
    const { viewer } = window.matstruct, { data } = viewer;
    const rect = document.getElementById('canvas').getBoundingClientRect();
    for (let f = 0; f < data.sheetOfFace.length; ++f) {
      const p = viewer.camera.position.clone().set(0, 0, 0);
      for (let k = 0; k < 3; ++k)
        p.add(viewer.camera.position.clone().fromArray(data.centers, 3 * data.faces[3 * f + k]).multiplyScalar(1 / 3));
      p.project(viewer.camera);
      const x = ((p.x + 1) / 2) * rect.width, y = ((1 - p.y) / 2) * rect.height;
      viewer.pickAt(x, y);
      if (viewer.picked?.face === f && x < 700) return { x, y, sheet: data.sheetOfFace[f], face: f };
    }
    return null;
  });
  assert.ok(at);
  await page.evaluate(() => window.matstruct.viewer.select(null));
  await page.mouse.click(at.x, at.y);
  const text = await picked();
  assert.match(text, new RegExp(`Face\\s+${at.face}\\b`));
  assert.match(text, new RegExp(`Sheet\\s+${at.sheet}\\b`));
  for (const key of ['junctions', 'seams', 'curves', 'boundaries']) await layer(key).check();
});

test('a point on a seam names its stratum', async () => {
  await page.keyboard.press('r');
  for (const key of ['solid', 'mesh', 'wire', 'junctions', 'boundaries', 'curves']) await layer(key).uncheck();
  const found = await page.evaluate(() => {
    const { viewer } = window.matstruct, { data } = viewer;
    const rect = document.getElementById('canvas').getBoundingClientRect();
    const p = viewer.camera.position.clone().fromArray(data.centers, 3 * data.seams[0][1]).project(viewer.camera);
    viewer.pickAt(rect.left + ((p.x + 1) / 2) * rect.width, rect.top + ((1 - p.y) / 2) * rect.height);
    return { ...viewer.picked, sheets: data.sheets, seams: data.seams.length };
  });
  assert.equal(found.kind, 'seam');
  assert.ok(found.curve >= 0 && found.curve < found.seams);
  assert.equal(found.stratum, found.sheets + found.curve);
  assert.match(await picked(), new RegExp(`Stratum\\s+${found.stratum}\\b`));
  for (const key of ['solid', 'mesh', 'wire', 'junctions', 'boundaries', 'curves']) await layer(key).check();
});

test('the clipping plane, the exploded sheets and the radius colours change the picture', async () => {
  for (const [on, off] of [['x', 'x'], ['e', 'w'], ['c', 'c'], ['d', 'd']]) {
    const before = await picture();
    await page.keyboard.press(on);
    assert.notEqual(await picture(), before, on);
    await page.keyboard.press(off);
    assert.equal(await picture(), before, off);
  }
});

test('works by keyboard: help, layers, turning', async () => {
  await page.keyboard.press('?');
  assert.ok(await page.locator('#help').isVisible());
  await page.keyboard.press('Escape');
  assert.ok(!(await page.locator('#help').isVisible()));
  await page.keyboard.press('1');
  assert.equal(await layer('solid').isChecked(), false);
  await page.keyboard.press('1');
  const before = await picture();
  await page.locator('#canvas').focus();
  await page.keyboard.press('ArrowLeft');
  assert.notEqual(await picture(), before);
});

test('the picked element is in sight, and forgotten on Escape', async () => {
  await page.locator('#thickest').click();
  const inside = await page.evaluate(() => document.getElementById('picked').getBoundingClientRect().bottom <= innerHeight);
  assert.ok(inside);
  await page.locator('#canvas').focus();
  await page.keyboard.press('Escape');
  assert.equal(await page.evaluate(() => window.matstruct.viewer.marker.visible), false);
});

test('saves a large picture with the legend, and shows the same as before', async () => {
  const before = await picture(), files = [];
  for (const color of ['sheet', 'radius']) {
    await page.locator(`input[value=${color}]`).check();
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save').click()]);
    assert.equal(download.suggestedFilename(), 'bracket.png');
    files.push(readFileSync(await download.path()));
  }
  await page.locator('input[value=sheet]').check();
  assert.equal(await picture(), before);
  assert.deepEqual([...files[0].subarray(1, 4)], [...Buffer.from('PNG')]);
  assert.deepEqual([files[0].readUInt32BE(16), files[0].readUInt32BE(20)], [2560, 1792]);
  // The lower left corner of either picture: paper, and the legend.
  const colors = await page.evaluate((pictures) => Promise.all(pictures.map(async (bytes) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${bytes}`)).blob());
    const canvas = Object.assign(document.createElement('canvas'), { width: 500, height: 500 });
    canvas.getContext('2d').drawImage(bitmap, 0, 500 - bitmap.height);
    return new Set(new Uint32Array(canvas.getContext('2d').getImageData(50, 30, 60, 420).data.buffer)).size;
  })), files.map((file) => file.toString('base64')));
  assert.equal(colors[0], 1);
  assert.ok(colors[1] > 100, String(colors));
});

test('the marker of a picked sphere is never hidden', async () => {
  const changed = (view) => page.evaluate((name) => {
    const { viewer } = window.matstruct;
    viewer.view(name);
    viewer.goToThickest();
    const at = () => {
      viewer.drawNow();
      const gl = viewer.renderer.getContext(), pixel = new Uint8Array(4);
      const p = viewer.marker.position.clone().project(viewer.camera);
      gl.readPixels(((p.x + 1) / 2) * gl.drawingBufferWidth, ((p.y + 1) / 2) * gl.drawingBufferHeight, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return pixel.join();
    };
    const marked = at();
    viewer.marker.visible = false;
    return at() !== marked;
  }, view);
  for (const view of ['iso', 'top', 'front', 'left']) assert.ok(await changed(view), view);
  await page.keyboard.press('Escape');
  await page.keyboard.press('r');
});

test('on a narrow screen the solid is above the panel', async () => {
  await page.setViewportSize({ width: 400, height: 800 });
  await page.waitForFunction(() => window.matstruct.viewer.camera.view?.fullWidth === 400);
  await page.evaluate(() => window.matstruct.viewer.view('iso'));
  const lowest = await page.evaluate(() => {
    const { viewer } = window.matstruct;
    viewer.camera.updateMatrixWorld();
    let low = 0;
    for (let k = 0; k < 8; ++k) {
      const p = viewer.box.min.clone();
      ['x', 'y', 'z'].forEach((a, i) => (p[a] = (k >> i & 1 ? viewer.box.max : viewer.box.min)[a]));
      low = Math.max(low, ((1 - p.project(viewer.camera).y) / 2) * innerHeight);
    }
    return { low, panel: document.getElementById('panel').getBoundingClientRect().top };
  });
  assert.ok(lowest.low < lowest.panel, JSON.stringify(lowest));
  await page.setViewportSize(size);
  await page.waitForFunction((width) => window.matstruct.viewer.camera.view?.fullWidth === width, size.width);
});

test('a finger turns the view, and a tap picks', async () => {
  await page.keyboard.press('r');
  const cdp = await page.context().newCDPSession(page);
  const touch = (type, ...at) => cdp.send('Input.dispatchTouchEvent', { type, touchPoints: at.map(([x, y]) => ({ x, y })) });
  const before = await picture();
  await touch('touchStart', [300, 350]);
  for (const x of [320, 340, 360]) await touch('touchMove', [x, 350]);
  await touch('touchEnd');
  assert.notEqual(await picture(), before);
  await page.keyboard.press('r');
  // What the browser still has to do (a late resize, a late move) may turn the view between the look for a place and the tap there.
  let seen = [];
  for (let tries = 0; tries < 4; ++tries) {
    const at = await page.evaluate(placeForAFinger);
    assert.ok(at);
    await touch('touchStart', at);
    await touch('touchEnd');
    const found = await page.waitForFunction(() => window.matstruct.viewer.picked !== null, null, { timeout: 5000 }).then(() => true, () => false);
    if (found) return;
    seen = await page.evaluate(() => window.seen);
  }
  assert.fail(`no tap picked; the page saw ${JSON.stringify(seen)}`);
});

/// A place of the canvas where something is picked at and around it, for a finger may miss a border; events are noted from now on.
function placeForAFinger() {
  const { viewer } = window.matstruct;
  if (!window.seen)
    for (const type of ['pointerdown', 'pointermove', 'pointerup', 'pointercancel', 'resize'])
      addEventListener(type, (e) => window.seen.push([type, e.clientX, e.clientY]), true);
  window.seen = [];
  const hits = (x, y) => document.elementFromPoint(x, y)?.id === 'canvas' && (viewer.pickAt(x, y), viewer.picked !== null);
  const around = [[0, 0], [9, 0], [-9, 0], [0, 9], [0, -9]];
  for (let x = 100; x < 700; x += 7)
    for (let y = 100; y < 600; y += 7)
      if (around.every(([dx, dy]) => hits(x + dx, y + dy))) return viewer.select(null), [x, y];
  return null;
}

test('text is readable, light and dark', async () => {
  for (let k = 0; k < 2; ++k) {
    const ratios = await page.evaluate(() => {
      const style = getComputedStyle(document.documentElement);
      const luminance = (name) => {
        const hex = style.getPropertyValue(name).trim();
        const [r, g, b] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const ratio = (a, b) => (Math.max(luminance(a), luminance(b)) + 0.05) / (Math.min(luminance(a), luminance(b)) + 0.05);
      return [ratio('--ink', '--panel'), ratio('--quiet', '--panel'), ratio('--ink', '--paper')];
    });
    for (const r of ratios) assert.ok(r >= 4.5, ratios.join());
    await page.keyboard.press('d');
  }
});

test('every control has a name', async () => {
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, canvas[tabindex]')]
    .filter((e) => !(e.textContent.trim() || e.getAttribute('aria-label') || e.closest('label')?.textContent.trim())).map((e) => e.outerHTML));
  assert.deepEqual(nameless, []);
  assert.deepEqual(problems, []);
});
