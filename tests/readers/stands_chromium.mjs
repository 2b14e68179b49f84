// node stands_chromium.mjs MOTION.npy METRES_PER_UNIT FILE...: as stands_node.mjs, in a page that a
// headless Chromium shows. The program is $CHROMIUM, else "chromium".
import {spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createServer} from 'node:http';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {basename, dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {hipsOf} from './npz.mjs';

const [npy, metresPerUnit, ...files] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const three = dirname(dirname(createRequire(import.meta.url).resolve('three')));
const page = `<!doctype html>
<script type="importmap">
{"imports": {"three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"}}
</script>
<script type="module">
const answer = [];
try {
  const {check} = await import('/stands.mjs');
  const expected = ${JSON.stringify(hipsOf(npy))};
  for (const name of ${JSON.stringify(files.map((file) => basename(file)))}) {
    const bytes = await (await fetch('/files/' + name)).arrayBuffer();
    answer.push(await check(name, bytes, expected, ${Number(metresPerUnit)}));
  }
} catch (error) {
  answer.push({text: navigator.userAgent, problems: [String(error)]});
}
await fetch('/answer', {method: 'POST', body: JSON.stringify(answer)});
</script>`;

function content(path) {
  if (path === '/') return page;
  if (path === '/stands.mjs') return readFileSync(join(here, 'stands.mjs'));
  if (path.startsWith('/three/')) return readFileSync(join(three, path.slice('/three/'.length)));
  return readFileSync(files.find((file) => path === '/files/' + basename(file)));
}

const profile = mkdtempSync(join(tmpdir(), 'stands-'));
let browser;
function finish(code) {
  // Its helpers write to the profile until it has ended.
  browser.on('exit', () => {
    rmSync(profile, {recursive: true, force: true, maxRetries: 20, retryDelay: 100});
    process.exit(code);
  });
  browser.kill('SIGTERM');
}
const server = createServer((request, response) => {
  if (request.method === 'POST') {
    let body = '';
    request.on('data', (part) => body += part);
    request.on('end', () => {
      response.end(() => {
        const answer = JSON.parse(body);
        for (const {text, problems} of answer) {
          console.log(`three.js in Chromium: ${text}`);
          problems.forEach((problem) => console.log(`  ${problem}`));
        }
        const good = answer.length === files.length && answer.every((each) => !each.problems.length);
        finish(good ? 0 : 1);
      });
    });
    return;
  }
  try {
    const type = request.url === '/' ? 'text/html' :
        /\.m?js$/.test(request.url) ? 'text/javascript' : 'application/octet-stream';
    response.setHeader('Content-Type', type);
    response.end(content(request.url));
  } catch {
    response.statusCode = 404;
    response.end();
  }
});
server.listen(0, '127.0.0.1', () => {
  browser = spawn(process.env.CHROMIUM ?? 'chromium', [
    '--headless', '--no-sandbox', '--disable-gpu', `--user-data-dir=${profile}`,
    `http://127.0.0.1:${server.address().port}/`], {stdio: 'ignore'});
  browser.on('error', (error) => {
    console.log(`Chromium does not start: ${error.message}`);
    rmSync(profile, {recursive: true});
    process.exit(1);
  });
});
setTimeout(() => {
  console.log('Chromium gave no answer in 120 s');
  finish(1);
}, 120000);
