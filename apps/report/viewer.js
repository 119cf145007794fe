// SPDX-License-Identifier: Apache-2.0
// Makes of every <div class="viewer"> one large picture: two of its figures, with an edge between them that can
// be dragged, and the values of the pixel under the pointer. Without this program the figures stand one below
// the other.
(function () {
  'use strict';

  function element(tag, className, parent) {
    const made = document.createElement(tag);
    made.className = className;
    parent.append(made);
    return made;
  }

  // IEEE 754 binary16.
  function fromHalf(bits) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (exponent ? Math.pow(2, exponent - 15) * (1 + fraction / 1024) : fraction * Math.pow(2, -24));
  }

  // Red, green, blue and relative error of a pixel.
  function reader(id) {
    const stored = JSON.parse(document.getElementById(id).textContent);
    const bytes = Uint8Array.from(atob(stored.halves), function (c) { return c.charCodeAt(0); });
    const view = new DataView(bytes.buffer);
    return {
      width: stored.width, height: stored.height, scale: stored.scale,
      at: function (x, y) {
        return [0, 1, 2, 3].map(function (c) { return fromHalf(view.getUint16(8 * (y * stored.width + x) + 2 * c, true)); });
      }
    };
  }

  function digits(value) { return isNaN(value) ? 'not known' : String(Number(value.toPrecision(3))); }

  function describe(values, u, v) {
    const x = Math.min(values.width - 1, Math.floor(u * values.width));
    const y = Math.min(values.height - 1, Math.floor(v * values.height));
    const pixel = values.at(x, y), of = values.scale > 1 ? ' (mean of ' + values.scale + ' x ' + values.scale + ')' : '';
    const error = isNaN(pixel[3]) ? 'not known' : digits(100 * pixel[3]) + ' %';
    return 'Pixel ' + x * values.scale + ', ' + y * values.scale + of + ': R ' + digits(pixel[0]) + ', G ' +
      digits(pixel[1]) + ', B ' + digits(pixel[2]) + '; standard error ' + error;
  }

  function selector(label, figures, chosen, parent) {
    const box = element('label', '', parent);
    box.append(label + ' ');
    const select = element('select', '', box);
    figures.forEach(function (figure, i) {
      const option = element('option', '', select);
      option.textContent = figure.dataset.name;
      option.value = i;
    });
    select.value = chosen;
    return select;
  }

  function start(viewer) {
    const figures = Array.from(viewer.querySelectorAll('figure'));
    const values = reader(viewer.dataset.values);
    viewer.classList.add('live');
    const stage = element('div', 'stage', viewer);
    stage.style.maxWidth = 'calc(90vh * ' + values.width / values.height + ')';  // all of it fits the window
    const right = element('img', 'right', stage), left = element('img', 'left', stage);
    const edge = element('i', 'edge', stage);
    const readout = element('p', 'readout', viewer), controls = element('div', 'controls', viewer);
    const leftChoice = selector('left', figures, 0, controls);
    const range = element('input', '', controls);
    range.type = 'range';
    range.setAttribute('aria-label', 'where the left picture ends, in percent');
    const rightChoice = selector('right', figures, figures.length > 1 ? 1 : 0, controls);
    const captions = element('p', 'captions', viewer);

    function show() {
      const chosen = [leftChoice, rightChoice].map(function (choice) { return figures[choice.value]; });
      [left, right].forEach(function (image, i) {
        image.src = chosen[i].querySelector('img').src;
        image.alt = chosen[i].dataset.name;
      });
      captions.textContent = chosen[0] === chosen[1] ? chosen[0].querySelector('figcaption').textContent :
        'Left: ' + chosen[0].querySelector('figcaption').textContent + ' Right: ' +
        chosen[1].querySelector('figcaption').textContent;
    }
    function place() {
      left.style.clipPath = 'inset(0 ' + (100 - range.value) + '% 0 0)';
      edge.style.left = range.value + '%';
    }
    function point(event) {
      const box = stage.getBoundingClientRect();
      const u = (event.clientX - box.left) / box.width, v = (event.clientY - box.top) / box.height;
      if (u < 0 || u >= 1 || v < 0 || v >= 1) return;
      readout.textContent = describe(values, u, v);
      if (event.buttons & 1 || event.type === 'pointerdown') {
        range.value = 100 * u;
        place();
      }
    }
    readout.textContent = 'Point at the picture for values; drag to move the edge.';
    stage.addEventListener('pointermove', point);
    stage.addEventListener('pointerdown', point);
    stage.addEventListener('dragstart', function (event) { event.preventDefault(); });
    range.addEventListener('input', place);
    leftChoice.addEventListener('change', show);
    rightChoice.addEventListener('change', show);
    range.value = figures.length > 1 ? 50 : 100;
    show();
    place();
  }

  document.querySelectorAll('.viewer').forEach(start);
}());
