// SPDX-License-Identifier: Apache-2.0
// The picture under the pointer: what fingers, mouse and keys do to the camera.

const turnPerHeight = Math.PI;  // of a drag as long as the picture is high
const stepOfKey = 0.06;         // of its height
const clickReach = 5;           // pixels of the screen within which a drag is none

// `act` has orbit(right, up), pan(right, up), zoom(factor), hover(x, y), click(x, y), goAround(x, y), reset().
export function listen(canvas, act) {
  const pointers = new Map();
  let pressed = null;  // where, and whether it has become a drag

  const place = event => {
    const box = canvas.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top, height: box.height, width: box.width};
  };
  // In pixels of the picture.
  const pixel = event => {
    const at = place(event);
    return [Math.floor(at.x / at.width * canvas.width), Math.floor(at.y / at.height * canvas.height)];
  };
  const middle = () => {
    const all = [...pointers.values()];
    return {x: all.reduce((sum, p) => sum + p.x, 0) / all.length, y: all.reduce((sum, p) => sum + p.y, 0) / all.length,
      spread: all.length < 2 ? 0 : Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y)};
  };

  canvas.addEventListener('pointerdown', event => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, place(event));
    pressed = pointers.size > 1 ? {isDrag: true} : {...place(event), isDrag: false};
  });

  canvas.addEventListener('pointermove', event => {
    if (!pointers.has(event.pointerId)) {
      act.hover(...pixel(event));
      return;
    }
    const before = middle(), now = place(event);
    pointers.set(event.pointerId, now);
    const after = middle();
    if (!pressed.isDrag) {
      pressed.isDrag = Math.hypot(now.x - pressed.x, now.y - pressed.y) > clickReach;
      if (!pressed.isDrag) return;
    }
    const right = (after.x - before.x) / now.height, down = (after.y - before.y) / now.height;
    const sideways = pointers.size > 1 || event.buttons & 6 || event.shiftKey;
    if (sideways)
      act.pan(-right, down);
    else
      act.orbit(-right * turnPerHeight, down * turnPerHeight);
    if (before.spread > 0 && after.spread > 0) act.zoom(after.spread / before.spread);
  });

  const release = event => {
    if (!pointers.delete(event.pointerId)) return;
    if (event.type === 'pointerup' && pressed && !pressed.isDrag) act.click(...pixel(event));
    if (pointers.size === 0) pressed = null;
  };
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('contextmenu', event => event.preventDefault());
  canvas.addEventListener('dblclick', event => act.goAround(...pixel(event)));
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    const lines = event.deltaMode === 0 ? event.deltaY / 100 : event.deltaY / 3;
    act.zoom(Math.exp(-0.15 * Math.max(-3, Math.min(3, lines))));
  }, {passive: false});

  canvas.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
    if (event.key in arrows) {
      const [right, up] = arrows[event.key];
      if (event.shiftKey)
        act.pan(right * stepOfKey, up * stepOfKey);
      else
        act.orbit(right * stepOfKey * turnPerHeight, up * stepOfKey * turnPerHeight);
    } else if (event.key === '+' || event.key === '=') {
      act.zoom(1.1);
    } else if (event.key === '-') {
      act.zoom(1 / 1.1);
    } else if (event.key === '0') {
      act.reset();
    } else {
      return;
    }
    event.preventDefault();
  });
}
