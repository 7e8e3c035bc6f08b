// SPDX-License-Identifier: MIT
'use strict';
// Histories on uPlot. Rings are mirrored so that the newest stretch is one subarray. x: sensor time, s.
class Ring {
  constructor(columns, size) { this.size = size; this.n = 0; this.data = Array.from({length: columns}, () => new Float64Array(2 * size).fill(NaN)); }
  push(values) {
    const k = this.n++ % this.size;
    values.forEach((v, c) => { const x = v === null || v === undefined ? NaN : v; this.data[c][k] = x; this.data[c][k + this.size] = x; });
  }
  view() {
    const count = Math.min(this.n, this.size), end = this.n <= this.size ? this.n : this.n % this.size + this.size;
    return this.data.map((d, c) => c === 0 ? d.subarray(end - count, end) : Array.from(d.subarray(end - count, end), v => Number.isNaN(v) ? null : v));
  }
}
const kPause_s = 3; // longer: the line is broken
// Marks values without neighbors: summaries of minutes from before the server started.
function alone(plot, series) {
  const v = plot.data[series], out = [];
  for (let i = 0; i < v.length; ++i) if (v[i] !== null && (i === 0 || v[i - 1] === null) && (i + 1 === v.length || v[i + 1] === null)) out.push(i);
  return out.length ? out : null;
}
class Strip {
  constructor(parent, title, why, series, seconds, rate) {
    this.box = document.createElement('div');
    this.box.className = 'strip';
    parent.append(this.box);
    this.title = title; this.why = why; this.series = series;
    this.ring = new Ring(series.length + 1, Math.ceil(seconds * rate));
    this.seconds = seconds; this.least = 0.9 / rate; this.last = null;
    this.make();
  }
  make() {
    if (this.plot) this.plot.destroy();
    const style = theme(), axis = {stroke: style.soft, grid: {stroke: style.rule, width: 1}, ticks: {stroke: style.rule}, font: '11px system-ui'};
    this.plot = new uPlot({
      title: this.title, width: Math.max(200, this.box.clientWidth || 400), height: 150, legend: {show: this.series.length > 1, live: false},
      cursor: {drag: {x: false, y: false}}, scales: {x: {time: false}, y: {range: (u, a, b) => a === null || b === null ? [0, 1] : uPlot.rangeNum(a, b, 0.12, true)}},
      axes: [{...axis, size: 26, space: 84, incrs: [1, 2, 5, 10, 15, 30, 60, 120, 300], values: (u, v) => v.map(x => clock(x * 1e6))}, {...axis, size: 56, values: (u, v, i, room, step) => v.map(x => x.toFixed(Math.min(6, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)))))}],
      series: [{}, ...this.series.map(s => ({label: s.name, stroke: style[s.color], width: s.width || 1.4, dash: s.dash, points: this.least > 0.1 ? {show: false, size: 5, filter: alone} : {show: false}, spanGaps: false}))],
      bands: this.series.some(s => s.band) ? [{series: [3, 2], fill: style.blue + '33'}] : [],
    }, [[], ...this.series.map(() => [])], this.box);
    this.box.querySelector('.u-title').title = this.why;
    this.box.setAttribute('role', 'img');
    this.box.setAttribute('aria-label', `${this.title}. ${this.why}`);
  }
  name(title) {
    if (title === this.title) return;
    this.title = title;
    this.box.querySelector('.u-title').textContent = title;
    this.box.setAttribute('aria-label', `${title}. ${this.why}`);
  }
  clear() { this.ring = new Ring(this.series.length + 1, this.ring.size); this.last = null; this.fresh = true; }
  // Leaves out values that are closer than the rate.
  push(values) {
    if (this.last !== null && values[0] < this.last) this.clear();
    if (this.last !== null && values[0] - this.last < this.least) return;
    if (this.last !== null && values[0] - this.last > kPause_s) this.ring.push([values[0] - 1e-3, ...values.slice(1).map(() => null)]);
    this.last = values[0];
    this.ring.push(values);
    this.fresh = true;
  }
  draw() {
    const width = printWidth ? printWidth / 2 : Math.max(200, this.box.clientWidth);
    if (Math.abs(this.plot.width - width) > 2) this.plot.setSize({width, height: 150});
    if (!this.fresh) return;
    this.fresh = false;
    const view = this.ring.view(), last = view[0].at(-1);
    this.plot.setData(view, false);
    if (last !== undefined) this.plot.setScale('x', {min: Math.max(last - this.seconds, view[0][0] - 1e-3), max: last});
  }
}
