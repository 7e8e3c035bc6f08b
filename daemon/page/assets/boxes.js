// SPDX-License-Identifier: MIT
'use strict';
// Boxplots of one kind of parameter as in the paper's Figure 10, with references and the newest value:
// each relative to its reference, or each in its unit on a separate scale.
const kBoxes_px = 200, kMostRows = 4; // height of a row; rows on the screen, then it scrolls sideways
class Boxes {
  constructor(canvas, plan, kind, onChoose) {
    this.canvas = canvas;
    this.kind = kind;
    this.plan = plan;
    this.index = plan.parameters.map((_, i) => i).filter(i => plan.parameters[i].kind === kind);
    this.title = ['Frame stiffness', 'Panel stiffness', 'Frame damping', 'Panel damping'][kind];
    this.left = 52; this.perRow = 1; this.step = 50;
    canvas.hidden = canvas.parentElement.hidden = this.index.length === 0;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', `Boxplots: ${this.title}. Arrow keys choose an element; the table below has all values.`);
    canvas.addEventListener('pointermove', e => {
      const k = this.place(e);
      if (k >= 0) showTip(elementText(this.index[k]), e.clientX, e.clientY); else hideTip();
    });
    canvas.addEventListener('click', e => { const k = this.place(e); if (k >= 0) onChoose(this.index[k]); });
    canvas.addEventListener('keydown', e => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[e.key], at = this.index.indexOf(chosen);
      if (!step) return;
      e.preventDefault();
      onChoose(this.index[at < 0 ? 0 : (at + step + this.index.length) % this.index.length]);
    });
  }
  place(e) {
    const b = this.canvas.getBoundingClientRect(), column = Math.floor((e.clientX - b.left - this.left) / this.step);
    const k = Math.floor((e.clientY - b.top) / kBoxes_px) * this.perRow + column;
    return column >= 0 && column < this.perRow && k >= 0 && k < this.index.length ? k : -1;
  }
  // Returns the values to draw for an element, in units of its axis.
  shape(i, percent) {
    const q = this.plan.parameters[i], has = boxes && boxes.count[i] > 0, value = known[i];
    const size = reference(i) || (has ? boxes.median[i] : value ? value.value : null);
    if (!size) return null;
    const unit = engineering(size, q.unit), f = percent ? v => 100 * (v / size - 1) : v => v * unit.factor;
    const all = k => has ? f(boxes[k][i]) : null;
    return {
      unit: unit.unit, low: all('low'), q1: all('q1'), median: all('median'), q3: all('q3'), high: all('high'), outliers: has ? boxes.outliers[i] : 0, count: has ? boxes.count[i] : 0,
      reference: reference(i) ? f(reference(i)) : null, design: baseline[i] && q.design && !isDamping(i) ? f(q.design) : null,
      value: value ? f(value.value) : null, error: value ? (percent ? 100 * value.error / size : value.error * unit.factor) : 0, old: value && !isNow(i) ? value.us : 0,
    };
  }
  range(shapes, least) {
    const all = shapes.filter(s => s).flatMap(s => [s.low, s.high, s.median, s.value, s.reference, ...(shapes.length === 1 && s.value !== null ? [s.value - s.error, s.value + s.error] : [])]).filter(v => v !== null && Number.isFinite(v));
    if (!all.length) return [-least, least];
    const low = Math.min(...all), high = Math.max(...all), room = Math.max(0.1 * (high - low), least - (high - low) / 2, 1e-9);
    return [low - room, high + room];
  }
  draw() {
    if (!this.index.length) return;
    const c = this.canvas, r = devicePixelRatio || 1, compared = this.index.filter(reference).length;
    const percent = boxMode === 'percent' && compared > 0;
    this.left = percent ? 52 : 8;
    const room = printWidth || c.parentElement.clientWidth, n = this.index.length, g = this.g = c.getContext('2d');
    g.font = '12px system-ui';
    this.widest = this.widest || 8 + Math.max(...this.index.map(i => g.measureText(called(this.plan.parameters[i])).width));
    const least = percent ? Math.max(room < 500 ? 38 : 50, this.widest / 2) : Math.max(84, this.widest);
    const fit = Math.max(1, Math.floor((room - this.left - 4) / least));
    const rows = printWidth ? Math.ceil(n / fit) : Math.min(kMostRows, Math.ceil(n / fit));
    this.perRow = Math.ceil(n / rows);
    const w = Math.max(room, this.left + 4 + this.perRow * least), h = rows * kBoxes_px;
    if (!room) return;
    c.style.width = w + 'px'; c.style.height = h + 'px';
    if (c.width !== Math.round(w * r) || c.height !== Math.round(h * r)) { c.width = Math.round(w * r); c.height = Math.round(h * r); }
    const style = theme();
    g.setTransform(r, 0, 0, r, 0, 0);
    g.clearRect(0, 0, w, h);
    g.font = '12px system-ui'; g.fillStyle = style.ink; g.textAlign = 'left';
    const judged = this.index.filter(i => baseline[i]).length, of = judged === compared ? '% from the baseline' : judged ? '% from the baseline (without one: from the design)' : '% from the design (no baseline yet)';
    const named = `${this.title}, ${percent ? of : 'each on its own scale'}`;
    g.fillText(g.measureText(named).width <= room - 8 ? named : this.title + (percent ? judged ? ', % from baseline' : ', % from design' : ''), 4, 12);
    this.step = (w - this.left - 4) / this.perRow;
    const narrow = this.step < this.widest; // then every second name is a row lower
    const shapes = this.index.map(i => this.shape(i, percent));
    if (!shapes.some(s => s)) { g.fillStyle = style.soft; g.fillText('no values yet', this.left, kBoxes_px / 2); }
    let [low, high] = this.range(shapes, 5);
    low = Math.max(low, -100); high = Math.min(high, 150); // one wild box must not flatten the others
    for (let row = 0; row < rows; ++row) {
      const top = row * kBoxes_px + 24, end = (row + 1) * kBoxes_px, bottom = end - (narrow ? 48 : 34);
      if (percent) this.axis(style, low, high, this.left, w - 4, top, bottom, t => (t > 0 ? '+' : t < 0 ? '−' : '') + Math.abs(t) + ' %');
      this.index.slice(row * this.perRow, (row + 1) * this.perRow).forEach((i, k) => this.one(style, i, k, shapes[row * this.perRow + k], percent, [low, high], top, bottom, end, narrow));
    }
  }
  // Draws one element at place `k` of its row, which ends at `end`.
  one(style, i, k, s, percent, [low, high], top, bottom, end, narrow) {
    const g = this.g, x = this.left + (k + 0.5) * this.step, from = x - this.step / 2;
    g.textAlign = 'center'; g.fillStyle = style.ink;
    const name = called(this.plan.parameters[i]), half = g.measureText(name).width / 2 + 2;
    g.fillText(name, Math.max(half, Math.min(x, this.canvas.width / (devicePixelRatio || 1) - half)), end - (narrow && k % 2 === 0 ? 33 : 19));
    if (i === chosen) { g.fillStyle = style.rule; g.globalAlpha = 0.4; g.fillRect(from, top - 6, this.step, bottom - top + 12); g.globalAlpha = 1; }
    if (!s) return this.note(style, estimate ? whyNot(i) : '', x, end);
    if (percent && s.reference === null) return this.note(style, 'no baseline', x, end);
    if (percent) this.box(style, s, x, v => bottom - (v - low) / (high - low) * (bottom - top), top, bottom);
    else {
      const [a, b] = this.range([s], Math.abs(s.reference || s.median || s.value || 1) * 0.002);
      this.axis(style, a, b, from + 40, from + this.step - 4, top + 12, bottom, String, 3);
      g.fillStyle = style.soft; g.textAlign = 'left'; g.fillText(s.unit, from + 4, top + 4);
      this.box(style, s, from + (44 + this.step) / 2, v => bottom - (v - a) / (b - a) * (bottom - top - 12), top + 12, bottom);
    }
    const doubt = !s.outliers ? '' : narrow ? `${s.outliers} out.` : `${s.outliers} outlier${s.outliers > 1 ? 's' : ''}`;
    this.note(style, s.old ? span((nowUs() - s.old) / 1e6) + (narrow ? '' : ' old') : doubt, x, end);
  }
  note(style, text, x, h) { const g = this.g; g.fillStyle = style.soft; g.textAlign = 'center'; g.font = '10.5px system-ui'; g.fillText(text, x, h - 5); g.font = '12px system-ui'; }
  axis(style, low, high, from, to, top, bottom, text, wanted = 5) {
    const g = this.g;
    for (const t of niceTicks(low, high, wanted)) {
      const y = bottom - (t - low) / (high - low) * (bottom - top);
      g.strokeStyle = style.rule; g.lineWidth = 1;
      g.beginPath(); g.moveTo(from, y); g.lineTo(to, y); g.stroke();
      g.fillStyle = style.soft; g.textAlign = 'right'; g.fillText(text(t), from - 5, y + 4);
    }
  }
  box(style, s, x, y, top, bottom) {
    const g = this.g, half = Math.min(boxMode === 'percent' ? 16 : 12, this.step * 0.26), line = (a, b, c, d) => { g.beginPath(); g.moveTo(a, b); g.lineTo(c, d); g.stroke(); };
    g.save();
    g.beginPath(); g.rect(x - this.step / 2, top - 8, this.step, bottom - top + 14); g.clip();
    const across = (v, dash, color, width) => { g.strokeStyle = color; g.lineWidth = width; g.setLineDash(dash); line(x - half * 1.6, y(v), x + half * 1.6, y(v)); g.setLineDash([]); };
    if (s.design !== null) across(s.design, [7, 4], style.soft, 1.4);
    if (s.reference !== null) across(s.reference, s.design !== null || baselineKnown() ? [2, 3] : [7, 4], style.ink, 1.6);
    if (s.count) {
      g.strokeStyle = style.blue; g.lineWidth = 1.5;
      line(x, y(s.q1), x, y(s.low)); line(x, y(s.q3), x, y(s.high));
      line(x - half / 2, y(s.low), x + half / 2, y(s.low)); line(x - half / 2, y(s.high), x + half / 2, y(s.high));
      g.fillStyle = style.card; g.fillRect(x - half, y(s.q3), 2 * half, Math.max(1, y(s.q1) - y(s.q3)));
      g.strokeRect(x - half, y(s.q3), 2 * half, Math.max(1, y(s.q1) - y(s.q3)));
      g.lineWidth = 3; line(x - half, y(s.median), x + half, y(s.median));
    }
    if (s.value !== null) {
      g.strokeStyle = g.fillStyle = s.old ? style.soft : style.orange; g.lineWidth = 2;
      line(x, y(s.value - s.error), x, y(s.value + s.error));
      g.beginPath(); g.arc(x, y(s.value), 3.2, 0, 7); if (s.old) g.stroke(); else g.fill();
    }
    g.restore();
  }
}
// Shows every value as text, for exact numbers and for screen readers.
function fitShort(i) {
  if (!fit || !fit.word[i]) return '';
  return (fit.word[i] < 3 ? `± ${percent(fit.error[i], fit.error[i]).slice(1)}, ` : '') + fitWords[fit.word[i]];
}
function valueTable() {
  if (!$('values').open) return;
  const table = $('value-table');
  table.replaceChildren();
  heads(table, ['element', 'value ± standard error', 'absolute value by the model', 'from', 'baseline', 'design', 'change', 'median', 'quartiles', 'outliers']);
  const body = table.createTBody();
  plan.parameters.forEach((q, i) => {
    const row = body.insertRow(), v = known[i], has = boxes && boxes.count[i] > 0, f = findingOf(q.name);
    cell(row, called(q) + (q.kind === 2 && called(q) !== q.name ? ', damping' : '')).title = `${q.name}: ${place(q)}`;
    cell(row, v ? withError(v.value, v.error, q.unit) : whyNot(i));
    cell(row, v ? fitShort(i) : '');
    cell(row, v ? (isNow(i) ? 'now' : when(v.us)) : '');
    cell(row, baseline[i] ? plain(baseline[i], q.unit) : ''); cell(row, q.design ? plain(q.design, q.unit) : '');
    cell(row, f ? `${percent(f.ratio, f.error)} ± ${percent(f.error, f.error).slice(1)}` : '');
    cell(row, has ? plain(boxes.median[i], q.unit) : '');
    cell(row, has ? plainRange(boxes.q1[i], boxes.q3[i], q.unit) : '');
    cell(row, has ? `${boxes.outliers[i]} of ${boxes.count[i]}` : '');
  });
}
