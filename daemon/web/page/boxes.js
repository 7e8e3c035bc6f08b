'use strict';
// Boxplots of one kind of parameter, with references and the newest value.
class Boxes {
  constructor(canvas, plan, kind, onChoose) {
    this.canvas = canvas;
    this.kind = kind;
    this.index = plan.parameters.map((_, i) => i).filter(i => plan.parameters[i].kind === kind);
    this.plan = plan;
    const stiffness = kind < 2, unit = this.index.length ? plan.parameters[this.index[0]].unit : '';
    this.factor = stiffness ? 1e-3 : 1;
    this.label = ['frame stiffness', 'panel stiffness', 'frame damping', 'panel damping'][kind] + ', ' + (stiffness ? 'k' : '') + unit;
    canvas.hidden = this.index.length === 0;
    canvas.setAttribute('aria-label', 'boxplots: ' + this.label);
    canvas.addEventListener('pointermove', e => {
      const k = this.place(e);
      if (k >= 0) showTip(elementText(this.index[k]), e.clientX, e.clientY); else hideTip();
    });
    canvas.addEventListener('click', e => { const k = this.place(e); if (k >= 0) onChoose(this.index[k]); });
  }
  place(e) {
    const b = this.canvas.getBoundingClientRect(), k = Math.floor((e.clientX - b.left - 54) / this.step);
    return k >= 0 && k < this.index.length ? k : -1;
  }
  draw(boxes, estimate, baseline, chosen) {
    if (!this.index.length) return;
    const c = this.canvas, r = devicePixelRatio || 1, w = c.clientWidth, h = c.clientHeight;
    if (c.width !== Math.round(w * r) || c.height !== Math.round(h * r)) { c.width = Math.round(w * r); c.height = Math.round(h * r); }
    const g = c.getContext('2d'), style = theme();
    g.setTransform(r, 0, 0, r, 0, 0);
    g.clearRect(0, 0, w, h);
    const left = 54, top = 20, bottom = h - 20;
    this.step = (w - left - 4) / this.index.length;
    const f = this.factor, all = [], has = i => boxes && boxes.count[i] > 0;
    for (const i of this.index) {
      const q = this.plan.parameters[i];
      if (q.design) all.push(q.design * f);
      if (has(i)) all.push(boxes.low[i] * f, boxes.high[i] * f, boxes.median[i] * f);
      if (baseline[i]) all.push(baseline[i] * f);
      if (estimate && estimate.reason[i] === 0) all.push(estimate.value[i] * f);
    }
    g.font = '12px system-ui';
    g.fillStyle = style.ink; g.textAlign = 'left';
    g.fillText(this.label, 4, 12);
    if (!all.length) { g.fillStyle = style.soft; g.fillText('no values yet', left, h / 2); }
    // The references set the scale; one wild box must not flatten the others.
    const middle = all.filter(Number.isFinite).sort((a, b) => a - b);
    let low = middle.length ? middle[0] : 0, high = middle.length ? middle.at(-1) : 1;
    const designs = this.index.map(i => this.plan.parameters[i].design * f).filter(v => v > 0);
    if (designs.length) { low = Math.max(low, -Math.max(...designs)); high = Math.min(high, 2.5 * Math.max(...designs)); }
    const room = Math.max((high - low) * 0.1, Math.abs(high) * 0.02, 1e-9);
    low -= room; high += room;
    const y = v => bottom - (v - low) / (high - low) * (bottom - top);
    for (const t of niceTicks(low, high, 4)) {
      g.strokeStyle = style.rule; g.lineWidth = 1;
      g.beginPath(); g.moveTo(left, y(t)); g.lineTo(w - 4, y(t)); g.stroke();
      g.fillStyle = style.soft; g.textAlign = 'right'; g.fillText(shortNumber(t), left - 5, y(t) + 4);
    }
    g.save();
    g.beginPath(); g.rect(left, top - 6, w - left, bottom - top + 12); g.clip();
    this.index.forEach((i, k) => {
      const x = left + (k + 0.5) * this.step, half = Math.min(16, this.step * 0.28), q = this.plan.parameters[i];
      const across = (v, dash, color, width) => {
        g.strokeStyle = color; g.lineWidth = width; g.setLineDash(dash);
        g.beginPath(); g.moveTo(x - this.step * 0.44, y(v)); g.lineTo(x + this.step * 0.44, y(v)); g.stroke(); g.setLineDash([]);
      };
      if (i === chosen) { g.fillStyle = style.rule; g.globalAlpha = 0.4; g.fillRect(x - this.step / 2, top - 6, this.step, bottom - top + 12); g.globalAlpha = 1; }
      if (q.design) across(q.design * f, [7, 4], style.soft, 1.4);
      if (baseline[i]) across(baseline[i] * f, [2, 3], style.ink, 1.6);
      if (has(i)) {
        g.strokeStyle = style.blue; g.lineWidth = 1.5;
        const line = (a, b, c2, d) => { g.beginPath(); g.moveTo(a, b); g.lineTo(c2, d); g.stroke(); };
        const q1 = y(boxes.q1[i] * f), q3 = y(boxes.q3[i] * f), lo = y(boxes.low[i] * f), hi = y(boxes.high[i] * f);
        line(x, q1, x, lo); line(x, q3, x, hi); line(x - half / 2, lo, x + half / 2, lo); line(x - half / 2, hi, x + half / 2, hi);
        g.fillStyle = style.card; g.fillRect(x - half, q3, 2 * half, Math.max(1, q1 - q3));
        g.strokeRect(x - half, q3, 2 * half, Math.max(1, q1 - q3));
        g.lineWidth = 3; line(x - half, y(boxes.median[i] * f), x + half, y(boxes.median[i] * f));
        if (boxes.outliers[i]) { g.fillStyle = style.soft; g.textAlign = 'center'; g.font = '10px system-ui'; g.fillText('+' + boxes.outliers[i], x + half + 9, Math.max(top + 4, hi)); g.font = '12px system-ui'; }
      }
      if (estimate && estimate.reason[i] === 0) {
        const v = estimate.value[i] * f, e = estimate.error[i] * f;
        g.strokeStyle = g.fillStyle = style.orange; g.lineWidth = 2;
        g.beginPath(); g.moveTo(x, y(v - e)); g.lineTo(x, y(v + e)); g.stroke();
        g.beginPath(); g.arc(x, y(v), 3.2, 0, 7); g.fill();
      } else if (estimate) {
        g.fillStyle = style.soft; g.textAlign = 'center'; g.font = '10px system-ui';
        g.fillText(reasons[estimate.reason[i]] || '', x, bottom - 3); g.font = '12px system-ui';
      }
    });
    g.restore();
    g.fillStyle = style.ink; g.textAlign = 'center';
    const every = Math.ceil(64 / this.step);
    this.index.forEach((i, k) => { if (k % every === 0) g.fillText(this.plan.parameters[i].name, left + (k + 0.5) * this.step, h - 5); });
  }
}
