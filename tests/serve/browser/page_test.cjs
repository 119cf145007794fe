// SPDX-License-Identifier: Apache-2.0
// The page of `vernier serve` as people use it: node page_test.cjs PROGRAM [FOLDER for screenshots].
'use strict';
const assert = require('node:assert/strict');
const {spawn, execFileSync} = require('node:child_process');
const path = require('node:path');
const {chromium} = require('playwright-core');

const [program, folder] = process.argv.slice(2);
const scene = process.env.VERNIER_BROWSER_SCENE ?? path.join(__dirname, '../../scenes/two_spheres.gltf');
const size = process.env.VERNIER_BROWSER_SIZE ?? '320x180';
const patience = 60000;

function startServer() {
  const server = spawn(program, ['serve', scene, '--port', '0', '--size', size, '--spp', '64'], {stdio: ['ignore', 'pipe', 'inherit']});
  return new Promise((resolve, reject) => {
    server.once('exit', code => reject(new Error('vernier serve ended with ' + code)));
    server.stdout.on('data', data => {
      const address = /http:\S+/.exec(data);
      if (address) resolve({server, address: address[0]});
    });
  });
}

const shownView = page => page.evaluate(() => Number(document.getElementById('canvas').dataset.view ?? 0));
const text = (page, id) => page.locator('#' + id).textContent();

// Waits for the first picture of a view after `before`, and returns the milliseconds that it took.
async function waitForView(page, before) {
  const start = performance.now();
  await page.waitForFunction(view => Number(document.getElementById('canvas').dataset.view ?? 0) > view, before,
    {timeout: patience, polling: 5});
  return performance.now() - start;
}

async function waitForPrecision(page) {
  await page.waitForFunction(() => /^Error/.test(document.getElementById('error').textContent), null, {timeout: patience});
}

// Mean difference of the canvas's values from those that were kept before; keeps them.
const differenceFromKept = page => page.evaluate(() => {
  const canvas = document.getElementById('canvas');
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const before = window.kept ?? data;
  window.kept = data;
  let sum = 0, brighter = 0;
  for (let i = 0; i < data.length; ++i) {
    sum += Math.abs(data[i] - before[i]);
    brighter += data[i] - before[i];
  }
  return {mean: sum / data.length, brighter: brighter / data.length};
});

async function drag(page, right, down) {
  const box = await page.locator('#canvas').boundingBox();
  const x = box.x + box.width / 2, y = box.y + box.height / 2;
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 5; ++i) await page.mouse.move(x + right * i / 5, y + down * i / 5);
  await page.mouse.up();
}

async function testCamera(page) {
  await differenceFromKept(page);
  let view = await shownView(page);
  await drag(page, 120, 20);
  await waitForView(page, view);
  assert.ok((await differenceFromKept(page)).mean > 2, 'a drag changes the picture');
  await page.waitForFunction(() => document.getElementById('command').textContent.includes('--look-from'));

  view = await shownView(page);
  await page.locator('#canvas').focus();
  await page.keyboard.press('ArrowLeft');
  await waitForView(page, view);
  view = await shownView(page);
  await page.mouse.wheel(0, -300);
  await waitForView(page, view);
  view = await shownView(page);
  await page.keyboard.press('0');
  await waitForView(page, view);
  await page.waitForFunction(() => !document.getElementById('command').textContent.includes('--look-from'));
}

async function testControls(page) {
  await waitForPrecision(page);
  await differenceFromKept(page);
  let view = await shownView(page);
  await page.getByLabel('Exposure').fill('2');
  await waitForView(page, view);
  assert.ok((await differenceFromKept(page)).brighter > 5, 'exposure brightens the picture');
  assert.match(await text(page, 'command'), /--exposure 2/);

  await page.getByLabel('Lens').selectOption('1.4');
  await page.waitForFunction(() => document.getElementById('command').textContent.includes('--fstop 1.4'));
  const box = await page.locator('#canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height * 0.55);
  await page.waitForFunction(() => document.getElementById('command').textContent.includes('--focus'));
  assert.match(await text(page, 'pixel'), /object “.+”, material “.+”, .+ m away/);

  view = await shownView(page);
  await page.getByLabel('Surroundings').selectOption('sky');
  await waitForView(page, view);
  await page.getByRole('button', {name: 'Error map'}).click();
  await page.waitForFunction(() => document.getElementById('map-caption').textContent.includes('%'), null, {timeout: patience});
  assert.equal(await page.locator('#problem').isVisible(), false, await text(page, 'problem'));
}

// Of single moves of the camera while the picture is being refined.
async function measureLatency(page) {
  const times = [];
  for (let i = 0; i < 5; ++i) {
    await waitForPrecision(page);
    const view = await shownView(page);
    const waiting = waitForView(page, view);
    await page.locator('#canvas').press('ArrowRight');
    times.push(await waiting);
  }
  times.sort((a, b) => a - b);
  console.log(`from a key to the new picture: median ${times[2].toFixed(0)} ms, longest ${times[4].toFixed(0)} ms`);
}

async function testPhone(browser, address) {
  const context = await browser.newContext({viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true,
    deviceScaleFactor: 2, colorScheme: 'dark'});
  const page = await context.newPage();
  await page.goto(address);
  await waitForPrecision(page);
  const widths = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(widths[0] <= widths[1], 'nothing reaches beyond a phone: ' + widths);
  const box = await page.locator('#canvas').boundingBox();
  await page.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => document.getElementById('pixel').textContent.startsWith('Pixel'));
  if (folder) await page.screenshot({path: path.join(folder, 'phone_dark.png'), fullPage: true});
  await context.close();
}

// Each with connections of its own, as if in ten browsers.
async function testTenPages(browser, address) {
  const pages = await Promise.all(Array.from({length: 10}, () => browser.newPage()));
  await Promise.all(pages.map(page => page.goto(address)));
  await Promise.all(pages.map(page => waitForView(page, 0)));
  const view = await shownView(pages[0]);
  await pages[0].locator('#canvas').press('ArrowRight');
  await Promise.all(pages.map(page => waitForView(page, view)));
  await Promise.all(pages.map(page => page.close()));
}

async function main() {
  const {server, address} = await startServer();
  const browser = await chromium.launch({executablePath: execFileSync('sh', ['-c', 'command -v chromium']).toString().trim(),
    args: ['--no-sandbox', '--disable-gpu']});
  try {
    const page = await browser.newPage({viewport: {width: 1280, height: 860}});
    const complaints = [];
    page.on('console', message => { if (message.type() === 'error') complaints.push(message.text()); });
    page.on('pageerror', error => complaints.push(String(error)));
    page.on('request', request => {
      if (!request.url().startsWith(address) && !/^(data|blob):/.test(request.url())) complaints.push('asks for ' + request.url());
    });
    await page.goto(address);
    await waitForPrecision(page);
    if (folder) await page.screenshot({path: path.join(folder, 'desktop.png')});
    await measureLatency(page);
    await testCamera(page);
    await testControls(page);
    if (folder) await page.screenshot({path: path.join(folder, 'desktop_map.png')});
    assert.deepEqual(complaints, []);
    await testPhone(browser, address);
    await testTenPages(browser, address);
  } finally {
    await browser.close();
    server.removeAllListeners('exit');
    server.kill('SIGTERM');
  }
  console.log('1 passed, 0 failed');
}

main().catch(error => {
  console.error(error);
  process.exit(1);
});
