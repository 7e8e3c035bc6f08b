// SPDX-License-Identifier: MIT
'use strict';
// The building in 3D: frames as walls between floors, panels as floors, moved by the floors' motion.
const kMaxExaggeration = 2000;
class Building {
  constructor(canvas, plan, onChoose) {
    this.canvas = canvas;
    this.plan = plan;
    this.turn = -0.6;
    this.tilt = 0.42;
    this.ratio = [];
    this.known = [];
    this.old = [];
    this.still = false;
    this.shape = null;
    this.factor = 1;
    this.chosen = 0;
    this.onChoose = onChoose;
    this.largest = 1e-6;
    const line = (spans, names, other) => {
      const at = [0];
      for (const s of spans) at.push(at[at.length - 1] + s);
      if (names.length === 0) at.push(other); // a plane building: frames need some length
      return names.length === 1 && spans.length === 0 ? [0] : at;
    };
    const size = Math.max(...plan.story_height_m);
    this.xs = line(plan.span_x_m, plan.frames_y, size);
    this.ys = line(plan.span_y_m, plan.frames_x, size);
    if (this.xs.length === 1) this.xs.push(size);
    if (this.ys.length === 1 && plan.frames_y.length > 0) this.ys.push(size);
    this.zs = [0];
    for (const h of plan.story_height_m) this.zs.push(this.zs[this.zs.length - 1] + h);
    this.extent = Math.max(this.xs.at(-1), this.ys.at(-1), this.zs.at(-1));
    const n = plan.frames_x.length, frames = n + plan.frames_y.length;
    // If only some floors have channels, the server appends the motion of every frame, the base first.
    this.axisOf = plan.grouped ? (story, frame) => plan.axes.length + story * frames + frame
      : (story, frame) => plan.axes.findIndex(a => a.story === story && a.frame === frame);
    this.baseOf = direction => plan.axes.findIndex(a => a.story === 0 && a.direction === direction);
    const motions = plan.grouped ? plan.axes.length + (plan.stories + 1) * frames : plan.axes.length;
    // The reference of each motion: the base of its frame or of its direction.
    this.from = Array.from({length: motions}, (_, i) => i < plan.axes.length ? this.baseOf(plan.axes[i].direction)
      : this.axisOf(0, (i - plan.axes.length) % frames));
    this.ofBase = i => i < plan.axes.length ? plan.axes[i].story === 0 : i < plan.axes.length + frames;
    this.measured = [...new Set(plan.axes.map(a => a.story))];
    this.floorAxis = [];
    for (let s = 0; s <= plan.stories; s++) this.floorAxis.push(Array.from({length: frames}, (_, f) => s === 0 ? -1 : this.axisOf(s, f)));
    this.begin();
    this.faces = this.makeFaces();
    canvas.addEventListener('pointerdown', e => { this.drag = [e.clientX, e.clientY]; this.moved = 0; canvas.setPointerCapture(e.pointerId); });
    canvas.addEventListener('pointermove', e => this.pointer(e));
    canvas.addEventListener('pointerup', e => { if (this.moved < 4) this.choose(this.hit(e)); this.drag = null; });
    canvas.addEventListener('keydown', e => {
      const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[e.key];
      if (!step) return;
      e.preventDefault();
      const size = this.faces.length, of = k => this.faces[k].i;
      let k = this.chosen;
      do k = (k + step + size) % size; while (of(k) === of(this.chosen) && k !== this.chosen); // a group has many
      this.choose(k);
    });
  }
  // Hides the transient of the integrators after a start during motion.
  begin() {
    this.motion = this.from.map(() => ({last: null, a: 0, v: 0, d: 0}));
    this.settling = Math.ceil(1.2 * this.plan.rate_hz / this.plan.high_pass_hz);
  }
  makeFaces() {
    const p = this.plan, n = p.frames_x.length, faces = [];
    const xe = this.xs.length - 1, ye = this.ys.length - 1;
    p.parameters.forEach((q, i) => {
      const t = q.story;
      if (q.kind === 0) {
        for (let s = t; s <= q.last_story; s++)
          for (const f of q.frames) faces.push({i, at: f < n ? [[0, f, s - 1], [xe, f, s - 1], [xe, f, s], [0, f, s]]
            : [[f - n, 0, s - 1], [f - n, ye, s - 1], [f - n, ye, s], [f - n, 0, s]]});
      } else if (q.kind === 1) {
        const bays = p.frames_y.length - 1, x = q.panel % bays, y = Math.floor(q.panel / bays);
        faces.push({i, at: [[x, y, t], [x + 1, y, t], [x + 1, y + 1, t], [x, y + 1, t]]});
      }
    });
    return faces;
  }
  // Adds one instant: displacement relative to the base, integrated twice above high_pass_hz.
  push(accel) {
    const dt = 1 / this.plan.rate_hz, keep = Math.exp(-2 * Math.PI * this.plan.high_pass_hz * dt);
    if (this.settling > 0) --this.settling;
    this.motion.forEach((m, i) => {
      if (this.ofBase(i) || accel[i] === null || accel[i] === undefined) return;
      const relative = accel[i] - (accel[this.from[i]] ?? 0);
      m.a = m.last === null ? 0 : keep * (m.a + relative - m.last);
      m.last = relative;
      m.v = keep * m.v + m.a * dt;
      m.d = keep * m.d + m.v * dt;
      if (!this.settling) this.largest = Math.max(this.largest, Math.abs(m.d));
    });
    this.largest *= 0.9997;
  }
  drift(parameter) {
    const q = this.plan.parameters[parameter];
    if (!q || !q.frames.length || this.settling) return null;
    const d = s => { const a = this.axisOf(s, q.frames[0]); return s === 0 || a < 0 ? 0 : this.motion[a].d; };
    return d(q.last_story) - d(q.story - 1);
  }
  // Displacement of floor `s` along the x-parallel frame `y` and the y-parallel frame `x` as drawn.
  moved(x, y, s) {
    const n = this.plan.frames_x.length, m = this.plan.frames_y.length;
    const d = f => {
      if (s === 0) return 0;
      if (this.shape) return this.factor * this.shape[(s - 1) * (n + m) + f];
      const i = this.floorAxis[s][f];
      return i >= 0 ? this.factor * this.motion[i].d : 0;
    };
    return [n ? d(Math.min(y, n - 1)) : 0, m ? d(n + Math.min(x, m - 1)) : 0];
  }
  at(x, y, s) {
    const [u, v] = this.moved(x, y, s);
    return this.project([this.xs[x] + u, this.ys[y] + v, this.zs[s]]);
  }
  project([x, y, z]) {
    x -= this.xs.at(-1) / 2; y -= this.ys.at(-1) / 2; z -= this.zs.at(-1) / 2;
    const c = Math.cos(this.turn), s = Math.sin(this.turn), ct = Math.cos(this.tilt), st = Math.sin(this.tilt);
    const u = c * x - s * y, v = s * x + c * y;
    return [this.w / 2 + this.zoom * u, this.h / 2 - this.zoom * (ct * z + st * v), -v * ct + z * st];
  }
  draw() {
    const c = this.canvas, r = devicePixelRatio || 1, w = printWidth || c.clientWidth, h = printWidth ? 260 : c.clientHeight;
    if (c.width !== Math.round(w * r) || c.height !== Math.round(h * r)) { c.width = Math.round(w * r); c.height = Math.round(h * r); }
    const g = c.getContext('2d'), style = theme();
    g.setTransform(r, 0, 0, r, 0, 0);
    g.clearRect(0, 0, w, h);
    this.w = w; this.h = h;
    const across = Math.hypot(this.xs.at(-1), this.ys.at(-1)) * 1.25;
    this.zoom = Math.min(w / across, h / (this.zs.at(-1) * Math.cos(this.tilt) + across * Math.sin(this.tilt)) / 1.02);
    // Limits the enlargement, so that noise does not look like an earthquake.
    const visible = this.extent * 0.13;
    this.factor = this.shape ? visible : this.still || this.settling ? 0 : Math.min(kMaxExaggeration, visible / Math.max(this.largest, 1e-9));
    this.shapes = this.faces.map((f, k) => {
      const points = f.at.map(a => this.at(...a));
      return {k, i: f.i, points, depth: points.reduce((s, p) => s + p[2], 0)};
    }).sort((a, b) => a.depth - b.depth);
    const ground = [[0, 0], [this.xs.at(-1), 0], [this.xs.at(-1), this.ys.at(-1)], [0, this.ys.at(-1)]].map(p => this.project([...p, 0]));
    this.path(g, ground);
    g.strokeStyle = style.soft; g.setLineDash([3, 4]); g.stroke(); g.setLineDash([]);
    for (const s of this.shapes) {
      this.path(g, s.points);
      const floor = this.plan.parameters[s.i].kind === 1;
      if (this.known[s.i]) {
        g.globalAlpha = ((floor ? 0.35 : 0.5) + 0.45 * Math.min(1, Math.abs(this.ratio[s.i] - 1) / kFullColor)) * (this.old[s.i] ? 0.75 : 1);
        g.fillStyle = ratioColor(this.ratio[s.i], style);
        g.fill();
      } else this.hatch(g, s.points, style);
      g.globalAlpha = 1;
      const chosen = this.faces[this.chosen] && this.faces[this.chosen].i === s.i;
      g.lineWidth = chosen ? 4 : 1.3;
      g.strokeStyle = chosen ? style.ink : style.soft;
      g.stroke();
    }
    this.levels(g, style);
    this.labels(g, style);
    const dead = deadChannels();
    this.dots = [];
    for (const a of this.plan.axes) {
      if (a.x_m !== undefined) { this.dot(g, style, a.name, this.planPoint(a), dead.has(a.name)); continue; }
      if (a.story === 0 || a.frame < 0) { if (dead.has(a.name)) this.dot(g, style, a.name, ground[a.direction === 'x' ? 0 : 3], true); continue; }
      const n = this.plan.frames_x.length, inX = a.frame < n;
      const p = inX ? this.at(0, a.frame, a.story) : this.at(a.frame - n, 0, a.story);
      const q = inX ? this.at(Math.min(1, this.xs.length - 1), a.frame, a.story) : this.at(a.frame - n, Math.min(1, this.ys.length - 1), a.story);
      const x = p[0] * 0.75 + q[0] * 0.25, y = p[1] * 0.75 + q[1] * 0.25;
      this.dot(g, style, a.name, [x, y], dead.has(a.name));
    }
    g.font = '12px system-ui'; g.fillStyle = style.soft; g.textAlign = 'left';
    const rest = this.still || this.factor * this.largest < this.extent * 0.004;
    g.fillText(this.shape ? 'shape of a mode' : this.still ? 'no motion to show' : rest ? 'hardly moves' : 'motion × ' + digits(this.factor, 2), 6, h - 8);
    this.drifts(g, style);
    this.compass(g, style);
  }
  // Returns the floors with channels if other floors have none.
  levels(g, style) {
    if (!this.plan.grouped) return;
    const x = this.xs.length - 1, y = this.ys.length - 1;
    g.lineWidth = 2.5; g.strokeStyle = style.ink;
    for (const s of this.measured) {
      if (s === 0) continue;
      this.path(g, [this.at(0, 0, s), this.at(x, 0, s), this.at(x, y, s), this.at(0, y, s)]);
      g.stroke();
    }
  }
  // Writes the labels of frames at their feet.
  labels(g, style) {
    g.font = '12px system-ui'; g.textAlign = 'center'; g.fillStyle = style.ink; g.strokeStyle = style.card; g.lineWidth = 4; g.lineJoin = 'round';
    const n = this.plan.frames_x.length;
    [...this.plan.frames_x, ...this.plan.frames_y].forEach((name, f) => {
      const text = this.plan.labels[name], [x, y] = this.project(f < n ? [this.xs.at(-1) / 2, this.ys[f], 0] : [this.xs[f - n], this.ys.at(-1) / 2, 0]);
      if (text) { g.strokeText(text, x, y + 4); g.fillText(text, x, y + 4); }
    });
  }
  // Position of a channel that is not on a frame.
  planPoint(a) {
    const [u, v] = this.moved(0, 0, a.story), inside = (v, all) => Math.min(Math.max(v, 0), all.at(-1));
    return this.project([inside(a.x_m, this.xs) + u, inside(a.y_m, this.ys) + v, this.zs[a.story]]);
  }
  dot(g, style, name, [x, y], dead) {
    g.beginPath(); g.arc(x, y, dead ? 7 : 3, 0, 7);
    g.fillStyle = dead ? style.red : style.ink; g.fill();
    if (!dead) return;
    g.lineWidth = 2; g.strokeStyle = style.card; g.stroke();
    g.font = '600 12px system-ui'; g.textAlign = 'left';
    g.lineWidth = 4; g.lineJoin = 'round'; g.fillStyle = style.ink; g.strokeText(name, x + 11, y + 4); g.fillText(name, x + 11, y + 4); g.lineJoin = 'miter';
    this.dots.push(name);
  }
  // Draws the peak drift ratios of the newest shake beside their stories.
  drifts(g, style) {
    if (!told.drift.length) return;
    g.font = '12px system-ui'; g.textAlign = 'right'; g.fillStyle = style.soft;
    g.fillText('peak drift ratio', this.w - 6, 14);
    const largest = told.drift.reduce((m, d, i) => d.frame >= 0 && !(d.ratio <= told.drift[m].ratio) ? i : m, 0), taken = [];
    const order = told.drift.map((_, i) => i).sort((a, b) => (b === largest) - (a === largest) || b - a);
    for (const i of order) {
      const d = told.drift[i];
      if (d.frame < 0) continue;
      const low = this.project([this.xs.at(-1) / 2, this.ys.at(-1) / 2, this.zs[i]]), high = this.project([this.xs.at(-1) / 2, this.ys.at(-1) / 2, this.zs[i + 1]]);
      g.fillStyle = style.ink;
      const at = [this.w - 6, Math.max(30, (low[1] + high[1]) / 2)], words = `story ${i + 1}: ${digits(100 * d.ratio, 3)} %`;
      if (taken.some(y => Math.abs(y - at[1]) < 14)) continue; // a tall building has no room for all
      taken.push(at[1]);
      g.strokeStyle = style.card; g.lineWidth = 4; g.lineJoin = 'round';
      g.strokeText(words, ...at); g.fillText(words, ...at);
    }
  }
  compass(g, style) {
    const o = this.project([0, 0, 0]), length = 26;
    for (const [name, v] of [['x', [1, 0, 0]], ['y', [0, 1, 0]]]) {
      const p = this.project(v), l = Math.hypot(p[0] - o[0], p[1] - o[1]) || 1;
      const ex = (p[0] - o[0]) / l * length, ey = (p[1] - o[1]) / l * length;
      g.strokeStyle = style.soft; g.lineWidth = 1.3;
      g.beginPath(); g.moveTo(44, 44); g.lineTo(44 + ex, 44 + ey); g.stroke();
      g.fillText(name, 41 + ex * 1.35, 48 + ey * 1.35);
    }
  }
  path(g, points) {
    g.beginPath();
    points.forEach((p, i) => i ? g.lineTo(p[0], p[1]) : g.moveTo(p[0], p[1]));
    g.closePath();
  }
  hatch(g, points, style) {
    g.save();
    g.clip();
    g.strokeStyle = style.grey; g.lineWidth = 1; g.globalAlpha = 0.7;
    const xs = points.map(p => p[0]), ys = points.map(p => p[1]);
    const x0 = Math.min(...xs), x1 = Math.max(...xs), y0 = Math.min(...ys), y1 = Math.max(...ys);
    g.beginPath();
    for (let x = x0 - (y1 - y0); x < x1; x += 8) { g.moveTo(x, y1); g.lineTo(x + (y1 - y0), y0); }
    g.stroke();
    g.restore();
    this.path(g, points);
  }
  hit(e) {
    const b = this.canvas.getBoundingClientRect(), x = e.clientX - b.left, y = e.clientY - b.top;
    const inside = p => {
      let is = false;
      for (let i = 0, j = p.length - 1; i < p.length; j = i++)
        if ((p[i][1] > y) !== (p[j][1] > y) && x < (p[j][0] - p[i][0]) * (y - p[i][1]) / (p[j][1] - p[i][1]) + p[i][0]) is = !is;
      return is;
    };
    for (const s of [...(this.shapes || [])].reverse()) if (inside(s.points)) return s.k;
    return -1;
  }
  pointer(e) {
    if (this.drag) {
      const dx = e.clientX - this.drag[0], dy = e.clientY - this.drag[1];
      this.moved += Math.abs(dx) + Math.abs(dy);
      this.turn += dx * 0.008;
      this.tilt = Math.min(1.3, Math.max(0.05, this.tilt + dy * 0.006));
      this.drag = [e.clientX, e.clientY];
      return;
    }
    const k = this.hit(e);
    if (k >= 0) showTip(elementText(this.faces[k].i), e.clientX, e.clientY); else hideTip();
  }
  choose(k) {
    if (k < 0) return;
    this.chosen = k;
    this.onChoose(this.faces[k].i);
  }
}
