// SPDX-License-Identifier: Apache-2.0
// A camera that goes around a point, in metres and radians, and the flags of `vernier render` that stand for it.

const add = (a, b) => a.map((v, i) => v + b[i]);
const sub = (a, b) => a.map((v, i) => v - b[i]);
const times = (a, s) => a.map(v => v * s);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => times(a, 1 / Math.hypot(...a));

// Rodrigues' formula; `axis` is a unit vector.
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}

const number = v => String(Number(v.toPrecision(7)));
const point = p => p.map(number).join(',');

const steepest = 89 * Math.PI / 180;

export class OrbitCamera {
  // `camera` is that of a "view" event.
  constructor(camera) {
    this.from = camera.from;
    this.at = camera.at;
    this.up = unit(camera.up);
    this.orthographic = camera.orthographic;
    this.height = camera.height;
    this.fov = camera.fov;
  }

  // To the right and up in its picture.
  axes() {
    const back = unit(sub(this.from, this.at));
    let right = cross(this.up, back);
    if (Math.hypot(...right) < 1e-6) right = cross([0, 0, back[1] > 0 ? -1 : 1], back);
    right = unit(right);
    return {right, up: cross(back, right)};
  }

  // What is seen at the point, in metres from bottom to top.
  seenHeight() {
    if (this.orthographic) return this.height;
    return 2 * Math.hypot(...sub(this.from, this.at)) * Math.tan(this.fov * Math.PI / 360);
  }

  orbit(right, up) {
    let offset = sub(this.from, this.at);
    const elevation = Math.asin(Math.max(-1, Math.min(1, dot(unit(offset), this.up))));
    const risen = Math.max(-steepest, Math.min(steepest, elevation + up));
    offset = turned(offset, this.axes().right, elevation - risen);
    this.from = add(this.at, turned(offset, this.up, right));
  }

  // In parts of the picture's height.
  pan(right, up) {
    const axes = this.axes(), height = this.seenHeight();
    const move = add(times(axes.right, right * height), times(axes.up, up * height));
    this.from = add(this.from, move);
    this.at = add(this.at, move);
  }

  zoom(factor) {
    if (this.orthographic)
      this.height /= factor;
    else
      this.from = add(this.at, times(sub(this.from, this.at), 1 / factor));
  }

  // Turns to another point, from the same side and as far away.
  goAround(place) {
    this.from = add(place, sub(this.from, this.at));
    this.at = place;
  }

  flags() {
    const flags = {'--look-from': point(this.from), '--look-at': point(this.at)};
    if (this.up[1] < 1 - 1e-6) flags['--up'] = point(this.up);
    if (this.orthographic)
      flags['--ortho'] = number(this.height);
    else
      flags['--fov'] = number(this.fov);
    return flags;
  }
}
