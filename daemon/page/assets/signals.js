// SPDX-License-Identifier: MIT
'use strict';
// Any signals over time, or over another signal: those of every sample and those of every window.
let signals = null;
const kSpans = {10: '10 s', 60: '1 min', 300: '5 min'}, kMaxSignals = 6, kWindows_hz = 4;
const kColors = ['blue', 'orange', 'green', 'purple', 'red', 'amber'], kDashes = [[], [7, 3], [2, 2], [9, 3, 2, 3], [4, 4], [12, 4]], kBorders = ['solid', 'dashed', 'dotted', 'dashed', 'dotted', 'dashed'];
class Signals {
  constructor() {
    const all = [];
    plan.axes.forEach((a, i) => all.push({id: 'a:' + a.name, group: 'acceleration', label: a.name, unit: 'm/s²', row: accel => accel[i]}));
    plan.parameters.forEach((q, i) => { if (q.kind === 0) all.push({id: 'd:' + q.name, group: 'drift', label: 'drift, ' + place(q), unit: 'mm', row: () => { const d = building.drift(i); return d === null ? null : 1e3 * d; }}); });
    plan.parameters.forEach((q, i) => {
      const unit = engineering(q.design || 1, q.unit);
      all.push({id: 'p:' + q.name, group: 'stiffness, damping', label: called(q) === q.name ? q.name : `${q.name}: ${place(q)}`, unit: unit.unit, estimate: e => e.reason[i] === 0 ? e.value[i] * unit.factor : null});
    });
    all.push({id: 'residual', group: 'other', label: 'residual over response', unit: '', estimate: e => e.status === 0 ? null : e.residual});
    all.push({id: 'rms', group: 'other', label: 'rms of the base', unit: 'm/s²'}, {id: 'gap', group: 'other', label: 'gap', unit: ''});
    this.all = new Map(all.map(s => [s.id, s]));
    this.chosen = (Array.isArray(layout.signals) ? layout.signals : []).map(id => this.all.get(id)).filter(Boolean).slice(0, kMaxSignals);
    this.over = this.all.get(layout.over) || null;
    this.span = layout.span in kSpans ? +layout.span : 10;
    this.drawn = 0;
    for (const id of ['g-add', 'g-over']) for (const s of all) this.group($(id), s.group).append(new Option(s.label, s.id));
    for (const [s, text] of Object.entries(kSpans)) $('g-span').add(new Option(text, s));
    $('g-over').value = this.over ? this.over.id : ''; $('g-span').value = this.span;
    $('g-add').onchange = e => { const s = this.all.get(e.target.value); e.target.value = ''; if (s && !this.chosen.includes(s) && this.chosen.length < kMaxSignals) { this.chosen.push(s); this.changed(); } };
    $('g-over').onchange = e => { this.over = this.all.get(e.target.value) || null; this.changed(); };
    $('g-span').onchange = e => { this.span = +e.target.value; this.changed(); };
    this.changed();
  }
  group(select, label) {
    const is = [...select.querySelectorAll('optgroup')].find(g => g.label === label);
    if (is) return is;
    const made = document.createElement('optgroup');
    made.label = label; select.append(made);
    return made;
  }
  used() { return this.over ? [...this.chosen, this.over] : this.chosen; }
  ring(s) { return s.ring || (s.ring = new Ring(2, Math.ceil(300 * (s.row ? plan.rate_hz : s.estimate ? kWindows_hz : 20)))); }
  changed() {
    for (const s of this.all.values()) if (!this.used().includes(s)) s.ring = null;
    for (const s of this.used()) if (!s.ring && s.estimate) past.forEach(e => this.push(s, seconds(e.end_us), s.estimate(e)));
    if (playback) playback.sought = playback.at;
    saveLayout({signals: this.chosen.map(s => s.id), over: this.over ? this.over.id : '', span: this.span});
    $('g-add').disabled = this.chosen.length >= kMaxSignals;
    $('g-chosen').replaceChildren(...this.chosen.map((s, i) => {
      const item = document.createElement('li'), b = document.createElement('button');
      b.textContent = `${this.named(s)} ×`; b.className = kColors[i]; b.setAttribute('aria-label', `Remove ${s.label}`);
      b.onclick = () => { this.chosen.splice(i, 1); this.changed(); };
      item.append(b);
      return item;
    }));
    this.make();
  }
  named(s) { return s.label + (s.unit ? ', ' + s.unit : ''); }
  push(s, t, v) {
    const ring = this.ring(s);
    if (s.last !== undefined && t < s.last) ring.n = 0; // another clock
    s.last = t;
    ring.push([t, v]);
  }
  row(t, accel) { for (const s of this.used()) if (s.row) this.push(s, t, s.row(accel)); }
  estimate(e) { for (const s of this.used()) if (s.estimate) this.push(s, seconds(e.end_us), s.estimate(e)); }
  value(id, t, v) { const s = this.all.get(id); if (this.used().includes(s)) this.push(s, t, v); }
  clear() { for (const s of this.all.values()) { s.ring = null; s.last = undefined; } }
  make() {
    if (this.plot) this.plot.destroy();
    this.plot = null;
    const box = $('g-plot');
    box.setAttribute('aria-label', this.chosen.length ? `${this.chosen.map(s => s.label).join(', ')} over ${this.over ? this.over.label : 'time'}` : 'No signal is chosen.');
    $('g-none').hidden = this.chosen.length > 0;
    this.drawn = 0;
    if (!this.chosen.length) return;
    const style = theme(), units = [...new Set(this.chosen.map(s => s.unit))], key = u => 'y' + units.indexOf(u);
    const axis = {stroke: style.soft, grid: {stroke: style.rule, width: 1}, ticks: {stroke: style.rule}, font: '11px system-ui', labelFont: '12px system-ui', labelSize: 18};
    const range = (u, a, b) => a === null || b === null || a === undefined ? [0, 1] : uPlot.rangeNum(a, b, 0.08, true);
    const line = (u, i) => uPlot.orient(u, i, (s, xs, ys, sx, sy, px, py, left, top, width, height) => {
      const path = new Path2D();
      for (let k = 0, up = true; k < xs.length; ++k) {
        if (ys[k] === null || xs[k] === null) { up = true; continue; }
        path[up ? 'moveTo' : 'lineTo'](px(xs[k], sx, width, left), py(ys[k], sy, height, top));
        up = false;
      }
      const g = u.ctx;
      g.save(); g.beginPath(); g.rect(left, top, width, height); g.clip();
      g.strokeStyle = style[kColors[i - 1]]; g.lineWidth = 1.3 * devicePixelRatio; g.setLineDash(kDashes[i - 1].map(d => d * devicePixelRatio)); g.stroke(path);
      g.restore();
      return null;
    });
    this.plot = new uPlot({
      mode: this.over ? 2 : 1, width: this.width(), height: 320, legend: {show: true, live: false, markers: {dash: (u, i) => kBorders[i - 1]}}, cursor: {drag: {x: false, y: false}},
      scales: {x: this.over ? {time: false, range} : {time: false}, ...Object.fromEntries(units.map(u => [key(u), {range}]))},
      axes: [{...axis, size: 34, ...(this.over ? {label: this.named(this.over)} : {space: 84, incrs: [1, 2, 5, 10, 15, 30, 60, 120, 300], values: (u, v) => v.map(x => clock(x * 1e6))})},
        ...units.map((u, i) => ({...axis, scale: key(u), side: i ? 1 : 3, size: 58, label: u || 'ratio', grid: {show: i === 0, stroke: style.rule, width: 1}}))],
      series: [this.over ? null : {}, ...this.chosen.map((s, i) => ({label: this.named(s), scale: key(s.unit), stroke: style[kColors[i]], width: 1.4, dash: kDashes[i], points: {show: false}, spanGaps: false,
        ...(this.over ? {paths: line, facets: [{scale: 'x', auto: true}, {scale: key(s.unit), auto: true}]} : {})}))],
    }, this.over ? [null, ...this.chosen.map(() => [[], []])] : [[], ...this.chosen.map(() => [])], box);
  }
  width() { return printWidth ? printWidth : Math.max(200, $('g-plot').clientWidth); }
  // The newest span of a signal.
  newest(s, end) {
    const [t, v] = this.ring(s).view(), from = t.findIndex(x => x >= end - this.span);
    return from < 0 ? [[], []] : [t.subarray(from), v.slice(from)];
  }
  draw(now) {
    if (!this.plot) return;
    const width = this.width();
    if (Math.abs(this.plot.width - width) > 2) this.plot.setSize({width, height: 320});
    if (now - this.drawn < (this.span > 10 ? 1000 : 100)) return;
    this.drawn = now;
    const end = Math.max(...this.used().map(s => s.last === undefined ? -Infinity : s.last));
    if (!Number.isFinite(end)) return;
    const views = this.chosen.map(s => this.newest(s, end));
    if (!this.over) {
      this.plot.setData(uPlot.join(views), false);
      this.plot.setScale('x', {min: end - this.span, max: end});
      return;
    }
    const [ts, xs] = this.newest(this.over, end);
    // The value that the other signal had at each time.
    const at = t => { let k = 0; return t.map ? Array.from(t, x => { while (k + 1 < ts.length && ts[k + 1] <= x) ++k; return ts.length && ts[k] <= x ? xs[k] : null; }) : []; };
    this.plot.setData([null, ...views.map(([t, v]) => [at(t), v])]);
  }
}
