// SPDX-License-Identifier: Apache-2.0
// The page of `vernier serve`: hears of views and pictures, shows them, and asks for others. docs/serve.md describes
// what is said between the two.
import {OrbitCamera} from '/camera.js';
import {buildControls} from '/controls.js';
import {listen} from '/stage.js';

const get = id => document.getElementById(id);
const canvas = get('canvas'), mapCanvas = get('map-canvas');
const secondsBetweenPixels = 0.1, secondsBetweenMaps = 1, secondsBetweenTries = 3;

let view = null;      // the newest "view" event
let picture = null;   // the newest "picture" event
let camera = null;
let shownFrame = 0, mapFrame = 0;
let showView = () => {};

function digits(v) { return String(Number(v.toPrecision(3))); }
function percent(v) { return digits(100 * v) + ' %'; }
function interval(e) { return percent(e.rel_rmse) + ' (' + digits(100 * e.low) + ' to ' + percent(e.high) + ')'; }

function showProblem(text) {
  get('problem').textContent = text;
  get('problem').hidden = !text;
}

// --- asking for views ---

let pending = null, isSending = false, lastAsked = 0;

// While one change is on its way, those that follow are put together.
async function send(change) {
  if ('camera' in change) pending = null;
  if ('--look-from' in change && pending) delete pending.camera;
  pending = {...pending, ...change};
  if (isSending) return;
  isSending = true;
  try {
    while (pending) {
      const body = JSON.stringify(pending);
      pending = null;
      const response = await fetch('/view', {method: 'POST', body, headers: {'Content-Type': 'application/json'}});
      const answer = await response.json();
      if (response.ok) lastAsked = answer.view;
      showProblem(response.ok ? '' : answer.problem);
    }
  } catch {
    showProblem('Vernier does not answer.');
  }
  isSending = false;
}

function move(act) {
  if (!camera) return;
  act(camera);
  send(camera.flags());
}

// --- pictures ---

async function load(path, target, size) {
  const response = await fetch(path);
  if (!response.ok) return null;
  const bitmap = await createImageBitmap(await response.blob());
  if (target.width !== size.width || target.height !== size.height) {
    target.width = size.width;
    target.height = size.height;
  }
  const context = target.getContext('2d');
  context.clearRect(0, 0, target.width, target.height);
  context.drawImage(bitmap, 0, 0, target.width, target.height);
  return response.headers;
}

// Frames that come while another is fetched are left out, but for the newest.
let isLoading = false;
async function showPicture() {
  if (isLoading) return;
  isLoading = true;
  try {
    while (picture && shownFrame < picture.frame) {
      const headers = await load('/picture', canvas, picture);
      if (!headers) break;
      shownFrame = Number(headers.get('Vernier-Frame'));
      canvas.dataset.view = headers.get('Vernier-View');
      canvas.dataset.frame = shownFrame;
    }
  } catch {
    // The stream of events tells when the program has gone.
  }
  isLoading = false;
}

let mapTimer = null;
async function showMap() {
  mapTimer = null;
  if (get('map').hidden || !picture || !picture.has_error || mapFrame === picture.frame) return;
  mapFrame = picture.frame;
  const headers = await load('/error-map', mapCanvas, picture).catch(() => null);
  if (headers)
    get('map-caption').textContent = 'Relative standard error of each pixel. Black 0, pale yellow ' +
      headers.get('Vernier-Largest') + ' and more.';
}
function showMapSoon() { mapTimer ??= setTimeout(showMap, 1000 * secondsBetweenMaps); }

function describeError() {
  if (picture.step > 1) return 'A coarse picture first.';
  if (!picture.error) return 'The error is not known yet.';
  const missing = picture.missing || '';
  if (picture.denoised && picture.denoised.rel_rmse !== undefined)
    return 'Error ' + interval(picture.denoised) + ' denoised, ' + percent(picture.error.rel_rmse) + ' before' + missing;
  return 'Error ' + interval(picture.error) + missing;
}

function describeEffort() {
  if (picture.step > 1 || picture.samples === undefined) return '';
  const reasons = {samples: 'Done: all samples are taken.', time: 'Done: the time is over.', error: 'Done: the error is reached.'};
  return digits(picture.samples) + ' samples a pixel in ' + digits(picture.seconds) + ' s. ' + (reasons[picture.ended_by] ?? '');
}

function showProgress() {
  const samples = view?.values['--spp'], error = view?.values['--error'];
  let part = 0;
  if (picture.ended_by) part = 0;
  else if (error > 0 && picture.error) part = Math.min(1, (error / picture.error.rel_rmse) ** 2);
  else if (samples > 0 && picture.step === 1) part = (picture.samples ?? 0) / samples;
  get('progress').value = part;
}

function onPicture(event) {
  picture = JSON.parse(event.data);
  get('error').textContent = describeError();
  get('effort').textContent = describeEffort();
  showProgress();
  showPicture();
  showMapSoon();
}

function onView(event) {
  view = JSON.parse(event.data);
  if (view.view >= lastAsked && !pending) camera = new OrbitCamera(view.camera);
  if (view.view >= lastAsked) showView(view);
  get('command').textContent = view.command;
  get('note-list').replaceChildren(...view.notes.map(text => Object.assign(document.createElement('li'), {textContent: text})));
  get('notes').hidden = view.notes.length === 0;
}

// --- pixels ---

let wantedPixel = null, pixelTimer = null;

async function readPixel(x, y) {
  const response = await fetch('/pixel?x=' + x + '&y=' + y);
  return response.ok ? response.json() : null;
}

function describePixel(p) {
  const names = ['R', 'G', 'B'];
  const values = p.value.map((v, i) => names[i] + ' ' + digits(v) + (p.error ? ' ± ' + digits(p.error[i]) : '')).join(', ');
  const thing = p.object === undefined ? 'no surface' :
    'object “' + p.object + '”, material “' + p.material + '”, ' + digits(p.distance) + ' m away';
  return 'Pixel ' + p.x + ', ' + p.y + ': ' + values + '; ' + thing + '.';
}

function hover(x, y) {
  wantedPixel = [x, y];
  pixelTimer ??= setTimeout(async () => {
    const p = await readPixel(...wantedPixel).catch(() => null);
    if (p) get('pixel').textContent = describePixel(p);
    pixelTimer = null;
  }, 1000 * secondsBetweenPixels);
}

async function click(x, y) {
  const p = await readPixel(x, y).catch(() => null);
  if (!p) return;
  get('pixel').textContent = describePixel(p);
  if (view && view.values['--fstop'] !== null && p.distance > 0) send({'--focus': String(Number(p.distance.toPrecision(6)))});
}

async function goAround(x, y) {
  const p = await readPixel(x, y).catch(() => null);
  if (p && p.position) move(c => c.goAround(p.position));
}

// --- the rest ---

async function copyCommand() {
  const text = get('command').textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch {  // pages that come without encryption from elsewhere may not
    getSelection().selectAllChildren(get('command'));
    document.execCommand('copy');
  }
  get('copy').textContent = 'Copied';
  setTimeout(() => { get('copy').textContent = 'Copy the command'; }, 1500);
}

function toggleMap() {
  get('map').hidden = !get('map').hidden;
  get('show-map').setAttribute('aria-pressed', String(!get('map').hidden));
  showMap();
}

function reset() { send({camera: 'start'}); }

// A page that nobody sees asks for nothing, and then nothing is rendered for it.
let events = null;
function connect() {
  if (events || document.hidden) return;
  events = new EventSource('/events');
  events.addEventListener('view', onView);
  events.addEventListener('picture', onPicture);
  events.addEventListener('problem', event => showProblem(JSON.parse(event.data)));
  events.addEventListener('people', event => {
    get('people').textContent = event.data === '1' ? '' : event.data + ' pages look at this view';
  });
  events.addEventListener('open', () => showProblem(''));
  events.addEventListener('error', () => {
    disconnect();
    showProblem('No connection: the program has ended, or too many pages are open. Trying again.');
    setTimeout(connect, 1000 * secondsBetweenTries);
  });
}
function disconnect() {
  events?.close();
  events = null;
}

async function start() {
  const facts = await (await fetch('/facts')).json();
  const name = facts.file.split('/').pop();
  get('file').textContent = name;
  get('file').title = facts.file;
  document.title = name + ' - Vernier';
  showView = buildControls(get('controls'), facts, send);
  listen(canvas, {
    orbit: (right, up) => move(c => c.orbit(right, up)),
    pan: (right, up) => move(c => c.pan(right, up)),
    zoom: factor => move(c => c.zoom(factor)),
    hover, click, goAround, reset
  });
  get('copy').addEventListener('click', copyCommand);
  get('show-map').addEventListener('click', toggleMap);
  get('reset').addEventListener('click', reset);
  document.addEventListener('keydown', event => {
    if (event.target.matches('input, select') || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === 'e') toggleMap();
    if (event.key === 'c') copyCommand();
  });
  document.addEventListener('visibilitychange', () => document.hidden ? disconnect() : connect());
  connect();
}

start();
