// SPDX-License-Identifier: Apache-2.0
// Draws every <canvas data-chart="ID"> from the JSON of the <script id="ID">: curves over logarithmic axes.
(function () {
  'use strict';
  const colors = ['#4269a5', '#d98032', '#4d9a6a', '#a3557e', '#8c8f3f', '#7a828e', '#2f9aa8', '#b3423f'];

  const style = getComputedStyle(document.documentElement);
  const line = style.getPropertyValue('--line');
  Chart.defaults.color = style.getPropertyValue('--quiet');

  function trimmed(value) { return String(Number(value.toPrecision(3))); }
  function percent(value) { return trimmed(100 * value) + ' %'; }

  // Ticks at 1, 2 and 5 times a power of ten, at every digit where that leaves too few, or at the powers alone
  // where it leaves too many; none at the ends of the axis, which are not round.
  function roundTicks(ticks) {
    function withDigits(digits) {
      return ticks.filter(function (tick) {
        return digits.test(Number(tick.value.toPrecision(6)).toExponential());
      });
    }
    const usual = withDigits(/^[125]e/);
    return usual.length < 3 ? withDigits(/^[1-9]e/) : usual.length > 9 ? withDigits(/^1e/) : usual;
  }

  function axis(title, values, format) {
    const margin = 1.15;
    return {
      type: 'logarithmic',
      min: Math.min.apply(null, values) / margin,
      max: Math.max.apply(null, values) * margin,
      title: { display: true, text: title },
      afterBuildTicks: function (scale) { scale.ticks = roundTicks(scale.ticks); },
      ticks: { callback: format, autoSkip: false, maxRotation: 0 },
      grid: { color: line }
    };
  }

  function points(pairs) { return pairs.map(function (pair) { return { x: pair[0], y: pair[1] }; }); }

  function edge(curve, which, options) {
    return Object.assign({
      label: '', isBand: true, borderWidth: 0, pointRadius: 0,
      data: curve.points.map(function (point, i) { return { x: point[0], y: curve.band[i][which] }; })
    }, options);
  }

  // Colours come again after eight curves, dotted.
  function datasets(curve, number) {
    const color = curve.guide ? '#7a828e' : colors[number % colors.length];
    const drawn = {
      label: curve.name, data: points(curve.points), borderColor: color, backgroundColor: color,
      borderWidth: 2, borderDash: number < colors.length ? [] : [2, 3], pointRadius: 3, tension: 0
    };
    if (curve.guide) return [Object.assign(drawn, { borderDash: [5, 4], borderWidth: 1, pointRadius: 0 })];
    if (curve.band.length === 0) return [drawn];
    return [drawn, edge(curve, 0, { fill: false }), edge(curve, 1, { fill: '-1', backgroundColor: color + '33' })];
  }

  function draw(canvas) {
    const chart = JSON.parse(document.getElementById(canvas.dataset.chart).textContent);
    const xs = [];
    let sets = [], ys = [], next = 0;
    chart.curves.forEach(function (curve) {
      sets = sets.concat(datasets(curve, curve.guide ? 0 : next++));
      curve.points.forEach(function (point) { xs.push(point[0]); ys.push(point[1]); });
      curve.band.forEach(function (ends) { ys = ys.concat(ends.filter(function (v) { return v > 0; })); });
    });
    if (xs.length > 0) new Chart(canvas, {
      type: 'line',
      data: { datasets: sets },
      options: {
        animation: false,
        maintainAspectRatio: false,
        interaction: { mode: 'nearest', intersect: false },
        scales: { x: axis(chart.x, xs, trimmed), y: axis(chart.y, ys, percent) },
        plugins: {
          legend: { labels: { usePointStyle: true, pointStyle: 'line', filter: function (item, data) {
            return !data.datasets[item.datasetIndex].isBand;
          } } },
          tooltip: {
            filter: function (item) { return !item.dataset.isBand; },
            callbacks: {
              title: function () { return ''; },
              label: function (item) {
                return item.dataset.label + ': ' + percent(item.parsed.y) + ' at ' + trimmed(item.parsed.x);
              }
            }
          }
        }
      }
    });
  }

  document.querySelectorAll('canvas[data-chart]').forEach(draw);
}());
