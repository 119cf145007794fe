#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
/* Compares what Vernier makes of glTF files with what Khronos' validator says of them.

   usage: NODE_PATH=DIR/node_modules node check.js VERNIER [--variants N] [--list] FILE...

   NODE_PATH is where `npm install gltf-validator` was run. Each file is judged as it is, and so are N variants, of one
   change each, of a file that uses everything (everything.js). A valid file must be read; an invalid one is refused, or
   read with a warning that the file without the change does not have, or taken silently. --list names the last ones.
   Exits with 1 if a valid file is refused or the program does anything but read or refuse, with 77 where there is no
   validator. */
'use strict';
const childProcess = require('child_process');
const fs = require('fs');
const os = require('os');
const path = require('path');
const { everything } = require('./everything.js');
const { variants } = require('./variants.js');

let validator;
try {
  validator = require('gltf-validator');
} catch {
  console.error('npm install gltf-validator somewhere, and name its node_modules in NODE_PATH');
  process.exit(77);
}

function parseArguments(words) {
  const options = { files: [], variants: 0, list: false };
  for (let i = 0; i < words.length; ++i) {
    if (words[i] === '--variants') options.variants = Number(words[++i]);
    else if (words[i] === '--list') options.list = true;
    else if (!options.vernier) options.vernier = words[i];
    else options.files.push(words[i]);
  }
  return options;
}

// To the validator a value that is none of an enumeration's is no error, only a warning, since extensions may add some.
// Contents of extensions that it does not know are no matter of its verdict.
async function validate(file) {
  let messages;
  try {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
      maxIssues: 0,
      externalResourceFunction: async (uri) =>
        new Uint8Array(await fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri)))),
    });
    messages = report.issues.messages;
  } catch (problem) {
    return { errors: [{ code: String(problem) }], unknown: [] };
  }
  return {
    errors: messages.filter((m) => m.severity === 0 || m.code === 'VALUE_NOT_IN_LIST'),
    unknown: messages.filter((m) => m.code === 'UNSUPPORTED_EXTENSION').map((m) => m.message.split("'")[1]),
  };
}

function isAnimated(file) {
  const bytes = fs.readFileSync(file);
  return bytes.includes('"animations"');
}

// What the program says: how it ended, its warnings without the name of the file, its error.
function read(vernier, file) {
  const flags = isAnimated(file) ? ['--at', '0.3', '--animation', 'all'] : [];
  return new Promise((resolve) => {
    const options = { timeout: 60000, maxBuffer: 1 << 26 };
    childProcess.execFile(vernier, ['info', file, ...flags], options, (error, out, err) => {
      const lines = err.split('\n').map((line) => line.replaceAll(file, ''));
      resolve({
        code: error ? (error.signal ?? error.code) : 0,
        warnings: lines.filter((line) => line.startsWith('warning:')),
        error: lines.find((line) => line.startsWith('error:')) ?? '',
      });
    });
  });
}

// Data that is nowhere cannot be rendered, though a file without it is valid.
const WITHOUT_DATA = 'has no uri and the file has no binary chunk';

// One of: valid, valid refused, not judged, refused, warned of, silent, broken.
function verdict(judgement, reading, usual, where) {
  // 2 is a file without what --at asks for: its animations are an array without an animation.
  if (![0, 2, 3].includes(reading.code)) return 'broken';
  if (judgement.errors.length === 0) {
    if (reading.code === 0) return 'valid';
    const unjudged = [...judgement.unknown, WITHOUT_DATA];
    return unjudged.some((name) => (where + reading.error).includes(name)) ? 'not judged' : 'valid refused';
  }
  if (reading.code !== 0) return 'refused';
  return reading.warnings.some((line) => !usual.has(line)) ? 'warned of' : 'silent';
}

class Tally {
  constructor(title) {
    this.title = title;
    this.counts = new Map();
    this.cases = [];
  }
  add(name, result, judgement, reading) {
    this.counts.set(result, (this.counts.get(result) ?? 0) + 1);
    this.cases.push({ name, result, code: judgement.errors[0]?.code, at: judgement.errors[0]?.pointer, reading });
  }
  of(result) {
    return this.counts.get(result) ?? 0;
  }
  print(list) {
    const valid = this.of('valid') + this.of('valid refused');
    const invalid = this.of('refused') + this.of('warned of') + this.of('silent');
    console.log(`${this.title}: ${valid} valid, of which ${this.of('valid refused')} refused; ${invalid} invalid, of ` +
      `which ${this.of('refused')} refused, ${this.of('warned of')} warned of, ${this.of('silent')} taken silently; ` +
      `${this.of('not judged')} not judged, ${this.of('broken')} broken`);
    for (const { name, result, code, at, reading } of this.cases)
      if (['valid refused', 'broken'].includes(result) || (list && result === 'silent'))
        console.log(`  ${result}: ${name}: ${code ? `${code} ${at ?? ''}` : `${reading.code} ${reading.error}`}`);
  }
}

async function inParallel(items, work) {
  let next = 0;
  const worker = async () => {
    while (next < items.length) await work(items[next++]);
  };
  await Promise.all(Array.from({ length: os.cpus().length }, worker));
}

async function main() {
  const options = parseArguments(process.argv.slice(2));
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'gltf-validator-'));
  const whole = path.join(folder, 'everything.gltf');
  fs.writeFileSync(whole, JSON.stringify(everything()));
  const files = new Tally('files');
  await inParallel([whole, ...options.files], async (file) => {
    const judgement = await validate(file);
    const reading = await read(options.vernier, file);
    files.add(file, verdict(judgement, reading, new Set(), ''), judgement, reading);
  });
  files.print(options.list);
  let failed = files.of('valid refused') + files.of('broken') > 0;

  if (options.variants > 0) {
    const changed = new Tally('variants');
    const usual = new Set((await read(options.vernier, whole)).warnings);
    const jobs = [...variants(everything(), options.variants)].map((variant, i) => ({ ...variant, i }));
    await inParallel(jobs, async ({ where, change, json, i }) => {
      const file = path.join(folder, `${i}.gltf`);
      fs.writeFileSync(file, JSON.stringify(json));
      const judgement = await validate(file);
      const reading = await read(options.vernier, file);
      fs.unlinkSync(file);
      changed.add(`${where}: ${change}`, verdict(judgement, reading, usual, where), judgement, reading);
    });
    changed.print(options.list);
    failed ||= changed.of('valid refused') + changed.of('broken') > 0;
  }
  fs.rmSync(folder, { recursive: true });
  process.exitCode = failed ? 1 : 0;
}

main();
