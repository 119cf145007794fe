// SPDX-License-Identifier: Apache-2.0
// The panel beside the picture. Each control stands for flags of `vernier render`; an empty value leaves one out.

const sides = [320, 480, 640, 960, 1280, 1920];
const stops = ['1.4', '2', '2.8', '4', '5.6', '8', '11', '16', '22'];
const efforts = [16, 64, 256, 1024, 4096].map(n => ({text: n + ' samples a pixel', flags: {'--spp': String(n), '--error': ''}}))
  .concat(['5%', '2%', '1%', '0.5%'].map(e => ({text: 'an error of ' + e.replace('%', ' %'), flags: {'--spp': '', '--error': e}})));

function element(tag, parent, properties = {}) {
  const made = Object.assign(document.createElement(tag), properties);
  parent.append(made);
  return made;
}

// A control has update(view), which shows what the view has.
class Panel {
  constructor(parent, send) {
    this.parent = parent;
    this.send = send;
    this.controls = [];
  }

  group(title) {
    this.section = element('section', this.parent);
    element('h2', this.section, {textContent: title});
  }

  row(name) {
    const row = element('label', this.section, {className: 'row'});
    element('span', row, {textContent: name});
    return row;
  }

  // `options` are {value, text}; read(view) gives a value, change(value) the flags. usable(view) tells whether the
  // control means anything.
  select(name, options, read, change, usable = () => true) {
    const select = element('select', this.row(name));
    select.append(...options.map(o => new Option(o.text, o.value)));
    select.addEventListener('change', () => this.send(change(select.value)));
    this.controls.push({update: view => {
      const value = String(read(view));
      select.disabled = !usable(view);
      if (![...select.options].some(o => o.value === value)) select.append(new Option(value, value));
      select.value = value;
    }});
  }

  // Names that a flag takes.
  names(name, flag, values, words = {}, usable = () => true) {
    this.select(name, values.map(v => ({value: v, text: v in words ? words[v] : v})), view => view.values[flag],
      value => ({[flag]: value}), usable);
  }

  range(name, flag, {low, high, step, usual, text, usable = () => true}) {
    const row = this.row(name), input = element('input', row, {type: 'range', min: low, max: high, step});
    const output = element('output', row);
    const show = value => { output.textContent = text(value); };
    input.addEventListener('input', () => {
      show(Number(input.value));
      this.send({[flag]: Number(input.value) === usual ? '' : input.value});
    });
    this.controls.push({update: view => {
      const value = view.values[flag];
      input.disabled = !usable(view);
      if (input.matches(':active')) return;  // it is being moved
      input.value = value === null ? low : value;
      show(value);
    }});
  }
}

function addPicture(panel, choices) {
  panel.group('Picture');
  panel.range('Exposure', '--exposure', {low: -6, high: 6, step: 0.1, usual: 0,
    text: v => (v > 0 ? '+' : '') + Number(v).toFixed(1) + ' EV'});
  panel.names('View', '--view', choices['--view']);
  // A size is chosen by its longer side; the shape stays.
  const size = (view, side) => {
    const scale = side / Math.max(view.width, view.height);
    return Math.max(1, Math.round(view.width * scale)) + 'x' + Math.max(1, Math.round(view.height * scale));
  };
  let shown = null;
  panel.select('Longer side', sides.map(s => ({value: String(s), text: s + ' pixels'})), view => {
    shown = shown && Math.abs(shown.width / shown.height - view.width / view.height) < 0.02 ? shown : view;
    return Math.max(view.width, view.height);
  }, side => ({'--size': size(shown, Number(side))}));
}

function addCamera(panel, choices) {
  panel.group('Camera');
  const cameras = [{value: 'start', text: 'that of the command'}, {value: 'fitted', text: 'all of the scene'}]
    .concat(choices['--camera'].map(name => ({value: name, text: name})));
  panel.select('Stands', cameras.concat({value: 'moved', text: 'moved by hand'}), view => {
    if (view.camera.name === 'look-from') return 'moved';
    if (view.values['--camera']) return view.values['--camera'];
    return view.camera.name === 'fitted' ? 'fitted' : 'start';
  }, camera => camera === 'moved' ? {} : {camera});
  panel.select('Lens', [{value: '', text: 'everything sharp'}].concat(stops.map(s => ({value: s, text: 'f/' + s}))),
    view => view.values['--fstop'] ?? '', stop => ({'--fstop': stop}));
}

function addLight(panel, facts) {
  const choices = facts.choices;
  panel.group('Light');
  panel.names('Surroundings', '--env', choices['--env'],
    {'': 'the scene’s own, or a studio', none: 'none', studio: 'studio', sky: 'sky'});
  panel.range('Turned', '--env-rotate', {low: -180, high: 180, step: 1, usual: 0, text: v => v + '°',
    usable: view => !['', 'none'].includes(view.values['--env'])});
  // Each by the part of the light that it scatters across the subject, in mean free paths.
  const fogs = [['haze', 0.1], ['mist', 0.3], ['fog', 1], ['thick fog', 3]].map(([name, paths]) => {
    const density = (paths / (2 * facts.radius)).toPrecision(2);
    return {value: String(Number(density)), text: `${name}, ${Number(density)} a metre`};
  });
  panel.select('Air', [{value: '', text: 'clear'}].concat(facts.radius > 0 ? fogs : []), view => view.values['--fog'],
    density => ({'--fog': density}));
}

function addScene(panel, facts) {
  const variants = facts.choices['--variant'], animations = facts.animations;
  if (variants.length < 2 && animations.length === 0) return;
  panel.group('Scene');
  if (variants.length > 1) panel.names('Variant', '--variant', variants, {'': 'as the file has it'});
  if (animations.length > 1)
    panel.names('Animation', '--animation', facts.choices['--animation'], Object.fromEntries([['', 'all, or the first']]
      .concat(animations.map((animation, i) => [String(i), animation.name || 'number ' + i]))));
  if (animations.length > 0)
    panel.range('Time', '--at', {low: 0, high: Math.max(...animations.map(a => a.seconds)), step: 0.01, usual: null,
      text: v => v === null ? 'at rest' : Number(v).toFixed(2) + ' s'});
}

function addRender(panel, choices) {
  panel.group('Rendering');
  panel.names('Integrator', '--integrator', choices['--integrator'],
    {path: 'path: all light', gradient: 'gradient: path, less noise in rooms', whitted: 'whitted: direct light', light: 'light: paths from the lights', raycast: 'raycast: what is met'});
  panel.names('Caustics', '--caustics', choices['--caustics'],
    {auto: 'where lamps make some', on: 'yes', off: 'no'}, view => ['path', 'gradient'].includes(view.values['--integrator']));
  panel.names('Shows', '--show', choices['--show'], {}, view => view.values['--integrator'] === 'raycast');
  panel.select('Until', efforts.map((e, i) => ({value: String(i), text: e.text})), view => {
    const {'--spp': samples, '--error': error} = view.values;
    const found = efforts.findIndex(e => error > 0 ? e.flags['--error'] === 100 * error + '%' && samples === 0 :
      e.flags['--spp'] === String(samples));
    return found >= 0 ? found : 'as the command says';
  }, value => efforts[Number(value)]?.flags ?? {});
  panel.names('Denoise', '--denoise', choices['--denoise'], {'': 'no'});
}

// Returns what shows a view in all controls. send(change) is called with flags.
export function buildControls(parent, facts, send) {
  const panel = new Panel(parent, send);
  addPicture(panel, facts.choices);
  addCamera(panel, facts.choices);
  addLight(panel, facts);
  addScene(panel, facts);
  addRender(panel, facts.choices);
  return view => panel.controls.forEach(control => control.update(view));
}
