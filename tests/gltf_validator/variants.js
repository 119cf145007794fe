// SPDX-License-Identifier: Apache-2.0
// Copies of a JSON document with one change each.
'use strict';

function* places(value, where = []) {
  if (where.length > 0) yield where;
  if (value !== null && typeof value === 'object')
    for (const key of Object.keys(value)) yield* places(value[key], [...where, key]);
}

// What a value may be changed to; undefined takes it away.
function changesOf(value) {
  const changes = [['taken away', undefined], ['null', null]];
  if (typeof value === 'number')
    changes.push(['negative', -1 - value], ['one more', value + 1], ['half more', value + 0.5], ['large', 1e9],
      ['too large', 1e300], ['zero', 0], ['text', String(value)], ['array', [value]]);
  else if (typeof value === 'string')
    changes.push(['empty', ''], ['other text', value + 'X'], ['number', 1], ['object', {}]);
  else if (typeof value === 'boolean')
    changes.push(['opposite', !value], ['number', 1], ['text', String(value)]);
  else if (Array.isArray(value))
    changes.push(['empty', []], ['one less', value.slice(0, -1)], ['last twice', [...value, value.at(-1)]],
      ['object', { ...value }]);
  else if (value !== null)
    changes.push(['empty', {}], ['array', [value]], ['one more member', { ...value, unheardOf: 1 }]);
  return changes;
}

function changed(document, where, to) {
  const copy = structuredClone(document);
  let owner = copy;
  for (const key of where.slice(0, -1)) owner = owner[key];
  const last = where.at(-1);
  if (to !== undefined) owner[last] = to;
  else if (Array.isArray(owner)) owner.splice(Number(last), 1);
  else delete owner[last];
  return copy;
}

// About `count` of all such copies, evenly spread over them and the same every time.
function* variants(document, count) {
  const all = [];
  for (const where of places(document)) {
    const value = where.reduce((owner, key) => owner[key], document);
    for (const [change, to] of changesOf(value)) all.push([where, change, to]);
  }
  const step = Math.max(all.length / count, 1);
  for (let i = 0; Math.floor(i) < all.length; i += step) {
    const [where, change, to] = all[Math.floor(i)];
    yield { where: '/' + where.join('/'), change, json: changed(document, where, to) };
  }
}

module.exports = { variants };
