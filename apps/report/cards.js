// SPDX-License-Identifier: Apache-2.0
// Plays the pictures of a card that has several, unless the reader wants things to keep still.
(function () {
  'use strict';
  const milliseconds = 125;
  if (matchMedia('(prefers-reduced-motion: reduce)').matches) return;
  document.querySelectorAll('.card .frames').forEach(function (frames) {
    const pictures = Array.from(frames.children);
    let shown = 0;
    setInterval(function () {
      pictures[shown].hidden = true;
      shown = (shown + 1) % pictures.length;
      pictures[shown].hidden = false;
    }, milliseconds);
  });
}());
