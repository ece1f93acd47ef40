// Bundles the page into one file with no links: node build.mjs OUTPUT. The tool puts its data in place of the marker.
import { build } from 'esbuild';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const output = process.argv[2] ?? `${here}/dist/viewer.html`;
const bundle = await build({
  entryPoints: [`${here}/src/main.js`],
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2020',
  legalComments: 'inline',
  write: false,
});
const script = bundle.outputFiles[0].text.replaceAll('</script', '<\\/script');
const style = await readFile(`${here}/src/style.css`, 'utf8');
const page = await readFile(`${here}/src/page.html`, 'utf8');
await mkdir(dirname(output), { recursive: true });
await writeFile(output, page.replace('/*style*/', () => style).replace('/*script*/', () => script));
