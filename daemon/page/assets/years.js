// SPDX-License-Identifier: MIT
'use strict';
// A day, a month, a year or all of the history: one element over time with its weather, events and notes on one axis.
const kDay_s = 86400, kYearSpans = {day: {s: kDay_s, again_s: 60}, month: {s: 30 * kDay_s, again_s: 600}, year: {s: 365 * kDay_s, again_s: 3600}, all: {s: 0, again_s: 3600}};
const kAtOnce = 8, kMapRow_px = 18, kMapFull = 0.05, kPlotLeft_px = 66, kPlotRight_px = 14; // elements of a request; the map of elements
const kUnits = {degc: '°C', pct: '%', mps: 'm/s', wpm2: 'W/m²'};
const covariateUnit = name => kUnits[name.split('_').pop()] || '';
const covariateName = name => name.replace(/_[a-z0-9]+$/, '').replace(/_/g, ' ');
const dayTimeText = us => dateText(us).slice(0, 16).replace('T', ' ');
const middle = list => { const v = list.filter(x => x !== null).sort((a, b) => a - b); return v.length ? v[v.length >> 1] : null; };
const least = list => list.reduce((a, b) => b !== null && (a === null || b < a) ? b : a, null);
const most = list => list.reduce((a, b) => b !== null && (a === null || b > a) ? b : a, null);
const inWords = names => names.length < 2 ? names.join() : `${names.slice(0, -1).join(', ')} and ${names.at(-1)}`;
const noteWords = n => `${n.who || 'somebody'}${n.kind === 'note' ? '' : n.kind === 'maintenance' ? ' changed the building' : ` acknowledged ${n.kind}`}` + (n.comment ? `: “${n.comment}”` : '');
const axisOf = style => ({stroke: style.soft, grid: {stroke: style.rule, width: 1}, ticks: {stroke: style.rule}, font: '11px system-ui', labelFont: '12px system-ui', labelSize: 16, labelGap: 0});
let years = null;
class Years {
  constructor() {
    this.span = layout.years in kYearSpans ? layout.years : 'year';
    this.from_us = null; this.to_us = null; // null: the newest
    this.plots = []; this.map = new Map(); this.wait_s = 2;
    for (const b of document.querySelectorAll('#years-card [data-span]')) b.onclick = () => { this.span = b.dataset.span; saveLayout({years: this.span}); this.go(null, null); };
    $('y-earlier').onclick = () => this.move(-1);
    $('y-later').onclick = () => this.move(1);
    $('y-newest').onclick = () => { if (this.span === '') this.span = layout.years in kYearSpans ? layout.years : 'year'; this.go(null, null); };
    plan.parameters.forEach((q, i) => $('y-element').add(new Option(`${q.name}  (${place(q)})`, i)));
    $('y-element').onchange = e => choose(+e.target.value);
    $('y-plots').addEventListener('keydown', e => this.key(e));
    $('y-map').addEventListener('click', e => { const i = this.mapRow(e); if (i !== undefined) choose(i); });
    $('y-map').addEventListener('pointermove', e => this.mapTip(e));
    $('y-map').addEventListener('pointerleave', hideTip);
    $('y-map').addEventListener('keydown', e => {
      const step = {ArrowDown: 1, ArrowUp: -1}[e.key], rows = this.mapRows(), at = rows.indexOf(chosen);
      if (!step) return;
      e.preventDefault();
      choose(rows[at < 0 ? 0 : (at + step + rows.length) % rows.length]);
    });
    $('y-table').addEventListener('toggle', () => this.table());
    this.press();
    $('years-card').hidden = false;
    // Only a viewer who looks costs the server a look into its history.
    new IntersectionObserver(seen => { this.seen = seen.at(-1).isIntersecting; if (this.seen && !this.asked) this.load(); }).observe($('years-card'));
    setInterval(() => { if (this.seen && !document.hidden && this.due && performance.now() > this.due) this.load(); }, 1000);
  }
  go(from_us, to_us) { this.from_us = from_us; this.to_us = to_us; this.press(); this.load(); }
  move(by) {
    const d = this.data;
    if (!d || d.first_us === null) return;
    const length = d.to_us - d.from_us, from = d.from_us + by * length;
    if (from + length >= d.end_us && this.span !== '') this.go(null, null); else this.go(from, from + length);
  }
  press() {
    for (const b of document.querySelectorAll('#years-card [data-span]')) b.setAttribute('aria-pressed', b.dataset.span === this.span);
    $('y-element').value = chosen;
  }
  query(elements) {
    const at = us => new Date(us / 1e3).toISOString(), q = new URLSearchParams({elements: elements.map(i => plan.parameters[i].name).join()});
    if (this.from_us !== null) { q.set('from', at(this.from_us)); q.set('to', at(this.to_us)); } else if (kYearSpans[this.span].s) q.set('last', kYearSpans[this.span].s + 's');
    return 'years.json?' + q;
  }
  // Loads the chosen element, then the others for the map.
  async load() {
    if (this.abort) this.abort.abort();
    const abort = this.abort = new AbortController(), began = performance.now();
    this.asked = true; this.due = 0;
    $('years-card').setAttribute('aria-busy', 'true');
    const get = async path => {
      const answer = await fetch(path, {signal: abort.signal});
      if (!answer.ok) throw new Error((await answer.text()).trim());
      return answer.json();
    };
    try {
      const data = await get(this.query([chosen]));
      if (abort.signal.aborted) return;
      this.data = data;
      this.wait_s = data.model.state === 'fitting' ? Math.min(30, 1.5 * this.wait_s) : 2;
      this.show(data);
      $('years-card').dataset.shown_ms = Math.round(performance.now() - began);
      const span = kYearSpans[this.span];
      this.due = performance.now() + 1e3 * (data.model.state === 'fitting' ? this.wait_s : this.from_us === null && span ? span.again_s : 3600);
      const key = [data.from_us, data.to_us, data.model.state].join();
      if (key !== this.mapKey) {
        this.mapKey = key; this.map.clear();
        this.mapSpan = {from: data.from_us / 1e6, to: data.to_us / 1e6, begin: data.begin_us / 1e6, step: data.step_s};
        const rows = this.mapRows();
        for (let k = 0; k < rows.length; k += kAtOnce) {
          const part = rows.slice(k, k + kAtOnce), more = await get(this.query(part) + '&only=elements');
          if (abort.signal.aborted) return;
          for (const e of more.elements) this.map.set(e.name, e);
          this.drawMap();
        }
      }
    } catch (e) {
      if (abort.signal.aborted) return;
      this.mapKey = '';
      this.fail(String(e.message || e));
      this.due = performance.now() + 1e4;
    } finally { if (this.abort === abort) $('years-card').setAttribute('aria-busy', 'false'); }
  }
  fail(text) { say2($('y-problem'), `Cannot show the history: ${text}`); $('y-problem').hidden = false; }
  // Another element was chosen, anywhere on the page.
  element() {
    $('y-element').value = chosen;
    if (this.asked) this.load();
  }
  show(d) {
    if (!this.data_at || this.data_at !== d.begin_us) { this.at = undefined; say2($('y-read'), 'Point at a plot, or use the arrow keys on it, to read its values.'); }
    this.data_at = d.begin_us;
    $('y-problem').hidden = true;
    const e = this.e = d.elements[0], q = plan.parameters[chosen];
    const newest = d.first_us === null || d.to_us >= d.end_us;
    $('y-later').disabled = $('y-newest').disabled = newest && this.span !== '';
    $('y-earlier').disabled = d.first_us === null || d.from_us <= d.first_us;
    this.t = Array.from({length: d.points}, (_, i) => d.begin_us / 1e6 + (i + 0.5) * d.step_s);
    const usual = e ? middle(e.median) : null;
    this.unit = engineering(usual || reference(chosen) || 1, q.unit);
    say2($('y-words'), this.words(d, e, q, usual));
    this.marks = [...d.events.map(x => ({us: x.since_us >= d.from_us && x.since_us < x.time_us ? x.since_us : x.time_us, grave: x.severity, what: x.message, place: x.place, told_us: x.time_us, kind: x.kind})),
      ...d.notes.map(n => ({us: n.time_us, grave: -1, what: noteWords(n), place: n.place, told_us: n.time_us, kind: 'note'}))].sort((a, b) => a.us - b.us);
    this.marks.forEach((m, i) => { m.number = i + 1; });
    this.make(); this.drawMap(); this.list(d); this.table();
    window.framewatch.years = d;
  }
  words(d, e, q, usual) {
    if (d.first_us === null) return 'The history has no summaries yet: framewatch run writes the first one after a minute.';
    const from = dayTimeText(d.from_us), to = dayTimeText(d.to_us), span = `${from} to ${to}${zoneText()}`;
    const step = d.step_s >= kDay_s ? (d.step_s === kDay_s ? 'day' : `${d.step_s / kDay_s} days`) : d.step_s === 3600 ? 'hour' : d.step_s > 60 ? `${d.step_s / 60} minutes` : 'minute';
    if (!e || usual === null) return `${span}: no values of ${called(q)}. The building did not move enough, or framewatch did not run.`;
    const covered = e.covered.filter(c => c !== null), share = covered.reduce((a, b) => a + b, 0) / (covered.length || 1), f = this.unit.factor;
    const value = `${called(q)}: median ${digits(usual * f, 4)} ${this.unit.unit}, middle half ${digits(middle(e.q1) * f, 4)} to ${digits(middle(e.q3) * f, 4)}, by ${step}; values in ${digits(100 * share, 2)} % of the time.`;
    const m = d.model, by = m.covariates.length ? inWords(m.covariates.map(covariateName)) : 'the season, because the history has no weather';
    const corrected = e.corrected && e.corrected.some(v => v !== null) ? ` Orange: as it would be in the mean weather (${by}; learned from ${m.days} days).`
      : m.state === 'fitting' ? ' The line corrected for the weather appears when the effect of the weather is learned from the whole history.'
      : m.state === 'failed' ? ` No correction for the weather: ${m.problem}.`
      : e.corrected ? ' No correction for the weather: none is known of this span.' : ' No correction for the weather: it is learned for frames only.';
    return `${span}. ${value}${corrected}`;
  }
  axes(style, last, label, values) {
    const axis = axisOf(style);
    const day = '{D} {MMM}', on = '\n{D} {MMM} {YYYY}';
    const x = {...axis, size: last ? 40 : 8, space: 70, values: last ? [[kDay_s * 365, '{YYYY}', null, null, null, null, null, null, 1], [kDay_s * 28, '{MMM}', '\n{YYYY}', null, null, null, null, null, 1], [kDay_s, day, '\n{YYYY}', null, null, null, null, null, 1], [60, '{HH}:{mm}', on, null, on, null, null, null, 1]] : (u, v) => v.map(() => '')};
    return [x, {...axis, size: kPlotLeft_px - 16, label, ...(values ? {values} : {})}];
  }
  plot(title, height, last, label, series, data, bands, range, first) {
    const box = document.createElement('div'), style = theme();
    box.className = 'strip'; box.tabIndex = 0;
    box.setAttribute('role', 'img'); box.setAttribute('aria-label', `${title}. Arrow keys read the values.`);
    $('y-plots').append(box);
    const y = range || ((u, a, b) => a === null || b === null || a === undefined ? [0, 1] : uPlot.rangeNum(a, b, 0.1, true));
    const p = new uPlot({
      title, width: this.width(), height, legend: {show: series.filter(s => s.label).length > 1, live: false}, padding: [first ? 16 : 6, kPlotRight_px, 0, 0],
      tzDate: s => zone === 'UTC' ? uPlot.tzDate(new Date(s * 1e3), 'Etc/UTC') : new Date(s * 1e3),
      cursor: {sync: {key: 'years'}, drag: {x: true, y: false, setScale: false}, y: false, points: {show: false}},
      scales: {x: {time: true, range: () => [this.data.from_us / 1e6, this.data.to_us / 1e6]}, y: {range: y}}, axes: this.axes(style, last, label),
      series: [{}, ...series.map(s => ({stroke: style[s.color], width: 1.4, spanGaps: false, points: {show: false, size: 4, filter: alone}, ...s}))], bands: bands || [],
      hooks: {draw: [u => this.drawMarks(u, first)], setCursor: [u => { if (u.cursor.idx !== null && u.cursor.idx !== undefined && u.cursor.left >= 0) this.read(u.cursor.idx); }],
        setSelect: [u => { if (u.select.width > 8) this.zoom(u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x')); }]},
    }, [this.t, ...data], box);
    this.plots.push(p);
    return p;
  }
  zoom(from, to) {
    if (this.zoomed) return; // the other plots of the axis say it too
    this.zoomed = true; setTimeout(() => { this.zoomed = false; }, 100);
    this.span = '';
    this.go(Math.round(1e6 * from), Math.round(1e6 * to));
  }
  width() { return printWidth ? printWidth : Math.max(260, $('y-plots').clientWidth); }
  make() {
    for (const p of this.plots) p.destroy();
    this.plots = [];
    $('y-plots').replaceChildren(); $('y-over').replaceChildren();
    const d = this.data, e = this.e, style = theme();
    if (!d || !e || d.first_us === null) return;
    const q = plan.parameters[chosen], f = this.unit.factor, scaled = list => list.map(v => v === null ? null : v * f), corrected = e.corrected && e.corrected.some(v => v !== null);
    const fill = color => style[color] + '38';
    this.plot(`${called(q)}, ${this.unit.unit}`, 260, false, this.unit.unit,
      [{label: 'upper quartile', color: 'blue', width: 0.5}, {label: 'lower quartile', color: 'blue', width: 0.5}, {label: 'median', color: 'blue', width: 1.8}, ...(corrected ? [{label: 'median in the mean weather', color: 'orange', width: 1.8}] : [])],
      [scaled(e.q3), scaled(e.q1), scaled(e.median), ...(corrected ? [scaled(e.corrected)] : [])], [{series: [1, 2], fill: fill('blue')}], null, true);
    this.plot('share of the time with values, %', 96, !d.weather.length, '%', [{color: 'green', fill: fill('green'), width: 1.2}], [e.covered.map(v => v === null ? null : 100 * v)], null, () => [0, 100]);
    d.weather.forEach((w, i) => this.plot(`${covariateName(w.name)}, ${covariateUnit(w.name)}`, i + 1 === d.weather.length ? 132 : 100, i + 1 === d.weather.length, covariateUnit(w.name),
      [{color: 'purple', width: 0.4}, {color: 'purple', width: 0.4}, {color: 'purple', width: 1.5}], [w.max, w.min, w.mean], [{series: [1, 2], fill: fill('purple')}]));
    // All boxes first: their number makes their width.
    const boxes = d.weather.map(() => { const box = document.createElement('div'); $('y-over').append(box); return box; });
    d.weather.forEach((w, i) => this.over(boxes[i], w, e, scaled, corrected, style));
    $('y-over-title').hidden = !d.weather.length;
  }
  // The values over a covariate: what follows the weather is a slope, what is corrected has none.
  over(box, w, e, scaled, corrected, style) {
    const name = `${covariateName(w.name)}, ${covariateUnit(w.name)}`;
    box.className = 'strip'; box.setAttribute('role', 'img'); box.setAttribute('aria-label', `${this.unit.unit} over ${name}`);
    const dots = color => (u, s) => uPlot.orient(u, s, (series, xs, ys, sx, sy, px, py, left, top, width, height) => {
      const path = new Path2D(), r = 1.9 * devicePixelRatio;
      for (let k = 0; k < xs.length; ++k) if (xs[k] !== null && ys[k] !== null) { const x = px(xs[k], sx, width, left), y = py(ys[k], sy, height, top); path.moveTo(x + r, y); path.arc(x, y, r, 0, 7); }
      u.ctx.save(); u.ctx.fillStyle = style[color] + 'a0'; u.ctx.fill(path); u.ctx.restore();
      return null;
    });
    const range = (u, a, b) => a === null || b === null || a === undefined ? [0, 1] : uPlot.rangeNum(a, b, 0.08, true);
    const lists = [['as measured', 'blue', scaled(e.median)], ...(corrected ? [['in the mean weather', 'orange', scaled(e.corrected)]] : [])];
    const axis = axisOf(style);
    this.plots.push(new uPlot({mode: 2, width: printWidth ? printWidth / 2 : Math.max(220, box.clientWidth), height: 230, legend: {show: corrected, live: false}, cursor: {show: false}, scales: {x: {time: false, range}, y: {range}},
      axes: [{...axis, size: 30, label: name}, {...axis, size: kPlotLeft_px - 16, label: this.unit.unit}],
      series: [null, ...lists.map(([label, color]) => ({label, stroke: style[color], fill: style[color], paths: dots(color), points: {show: false}, facets: [{scale: 'x', auto: true}, {scale: 'y', auto: true}]}))],
    }, [null, ...lists.map(([, , values]) => [w.mean, values])], box));
  }
  // Lines of events and notes; the first plot has their numbers.
  drawMarks(u, first) {
    const g = u.ctx, r = devicePixelRatio, style = theme(), {left, top, width, height} = u.bbox;
    let taken = -Infinity;
    g.save();
    g.font = `bold ${11 * r}px system-ui`; g.textAlign = 'center'; g.lineWidth = r;
    for (const m of this.marks) {
      const x = u.valToPos(m.us / 1e6, 'x', true);
      if (x < left - 1 || x > left + width + 1) continue;
      g.strokeStyle = g.fillStyle = style[this.colorOf(m)];
      g.setLineDash(m.grave < 0 ? [2 * r, 3 * r] : m.grave > 1 ? [] : [5 * r, 3 * r]);
      g.lineWidth = (m.grave > 1 ? 2 : 1) * r;
      g.beginPath(); g.moveTo(x, top); g.lineTo(x, top + height); g.stroke();
      if (!first || x - taken < 16 * r) continue;
      taken = x;
      g.fillText(String(m.number), x, top - 4 * r);
    }
    g.restore();
  }
  colorOf(m) { return m.grave < 0 ? 'purple' : m.grave > 1 ? 'red' : m.grave > 0 ? 'amber' : 'soft'; }
  read(i) {
    const d = this.data, e = this.e, f = this.unit.factor, at = list => list && list[i] !== null && list[i] !== undefined ? list[i] : null;
    if (i < 0 || i >= this.t.length) return;
    this.at = i;
    const start = d.begin_us + i * d.step_s * 1e6, unit = this.unit.unit, median = at(e.median);
    const parts = [median === null ? 'no value' : `median ${digits(median * f, 5)} ${unit}, quartiles ${digits(at(e.q1) * f, 5)} to ${digits(at(e.q3) * f, 5)}`];
    if (at(e.corrected) !== null) parts.push(`in the mean weather ${digits(at(e.corrected) * f, 5)} ${unit}`);
    if (at(e.covered) !== null) parts.push(`values in ${digits(100 * at(e.covered), 2)} % of the time`);
    for (const w of d.weather) if (at(w.mean) !== null) parts.push(`${covariateName(w.name)} ${digits(at(w.mean), 3)} ${covariateUnit(w.name)}`);
    say2($('y-read'), `${d.step_s >= kDay_s ? dayTimeText(start).slice(0, 10) : dayTimeText(start) + zoneText()}: ${parts.join('; ')}`);
  }
  key(e) {
    const step = {ArrowRight: 1, ArrowLeft: -1, PageDown: 10, PageUp: -10}[e.key], u = this.plots[0];
    if (!u || !(step || e.key === 'Home' || e.key === 'End')) return;
    e.preventDefault();
    const to = e.key === 'Home' ? 0 : e.key === 'End' ? this.t.length - 1 : Math.max(0, Math.min(this.t.length - 1, (this.at === undefined ? (step > 0 ? -1 : this.t.length) : this.at) + step));
    u.setCursor({left: u.valToPos(this.t[to], 'x'), top: 10});
    this.read(to);
  }
  list(d) {
    const table = $('y-events'), shown = [...this.marks].reverse();
    table.replaceChildren();
    say2($('y-no-events'), shown.length ? d.events_in_all > d.events.length ? `The gravest ${d.events.length} of ${d.events_in_all} events.` : '' : 'No events and no notes in this span.');
    if (!shown.length) return;
    heads(table, ['number', 'time', 'place', 'what happened']);
    const body = table.createTBody();
    for (const m of shown) {
      const row = body.insertRow();
      cell(row, String(m.number), this.colorOf(m)); cell(row, dayTimeText(m.us) + zoneText()); cell(row, placeName(m.place), 'text'); cell(row, m.what, 'text');
    }
  }
  table() {
    const table = $('y-values'), d = this.data, e = this.e;
    if (!$('y-table').open || !d || !e) return;
    table.replaceChildren();
    const unit = this.unit.unit, f = this.unit.factor, number = v => v === null || v === undefined ? '' : digits(v * f, 5), plainly = v => v === null ? '' : digits(v, 3);
    heads(table, ['from', `median, ${unit}`, `lower quartile, ${unit}`, `upper quartile, ${unit}`, `in the mean weather, ${unit}`, 'time with values, %', ...d.weather.map(w => `${covariateName(w.name)}, ${covariateUnit(w.name)}`)]);
    const body = table.createTBody();
    for (let i = 0; i < d.points; ++i) {
      const row = body.insertRow();
      cell(row, dayTimeText(d.begin_us + i * d.step_s * 1e6));
      for (const list of [e.median, e.q1, e.q3, e.corrected || []]) cell(row, number(list[i]));
      cell(row, e.covered[i] === null ? '' : digits(100 * e.covered[i], 2));
      for (const w of d.weather) cell(row, plainly(w.mean[i]));
    }
  }
  // The map: a row for each frame's stiffness, colored by its change from its median in the span.
  mapRows() { return plan.parameters.map((_, i) => i).filter(i => plan.parameters[i].kind === 0); }
  mapRow(e) { return this.mapRows()[Math.floor((e.clientY - $('y-map').getBoundingClientRect().top) / kMapRow_px)]; }
  mapValues(i) {
    const e = this.map.get(plan.parameters[i].name);
    if (!e) return null;
    const values = e.corrected && e.corrected.some(v => v !== null) ? e.corrected : e.median, usual = middle(values);
    return values.map(v => v === null || !usual ? null : v / usual);
  }
  drawMap() {
    const canvas = $('y-map'), rows = this.mapRows(), style = theme(), r = devicePixelRatio || 1;
    const width = this.width(), height = rows.length * kMapRow_px + 4, s = this.mapSpan, g = canvas.getContext('2d');
    $('y-map-box').hidden = !this.map.size;
    if (!this.map.size || !s) return;
    canvas.style.width = width + 'px'; canvas.style.height = height + 'px';
    canvas.width = Math.round(width * r); canvas.height = Math.round(height * r);
    g.setTransform(r, 0, 0, r, 0, 0);
    g.font = '11px system-ui';
    const from = kPlotLeft_px, room = width - from - kPlotRight_px, x = t => from + Math.max(0, Math.min(1, (t - s.from) / (s.to - s.from))) * room;
    rows.forEach((i, k) => {
      const values = this.mapValues(i), top = k * kMapRow_px + 1;
      g.fillStyle = style.rule; g.fillRect(from, top + kMapRow_px / 2 - 1.5, room, 1);
      if (values) values.forEach((v, p) => {
        if (v === null) return;
        const a = x(s.begin + p * s.step), b = x(s.begin + (p + 1) * s.step);
        g.fillStyle = mix(style.rule, v < 1 ? style.orange : style.blue, Math.min(1, Math.abs(v - 1) / kMapFull));
        g.fillRect(a, top, Math.max(0.6, b - a + 0.3), kMapRow_px - 2);
      });
      g.fillStyle = style.ink; g.textAlign = 'right'; g.font = `${i === chosen ? 'bold ' : ''}11px system-ui`;
      g.fillText(plan.parameters[i].name, from - 6, top + 12);
      if (i === chosen) { g.strokeStyle = style.ink; g.lineWidth = 1.6; g.strokeRect(from - 1, top - 0.5, room + 2, kMapRow_px - 1); }
    });
    canvas.setAttribute('aria-label', `Every frame's stiffness over the span. ${rows.map(i => { const v = (this.mapValues(i) || []).filter(x => x !== null); return v.length ? `${plan.parameters[i].name}: ${percent(least(v) - 1, 0.001)} to ${percent(most(v) - 1, 0.001)}` : `${plan.parameters[i].name}: no values`; }).join('; ')}. Up and down arrow keys choose an element.`);
  }
  mapTip(e) {
    const i = this.mapRow(e), s = this.mapSpan, canvas = $('y-map').getBoundingClientRect(), values = i === undefined ? null : this.mapValues(i);
    if (!values) { hideTip(); return; }
    const t = s.from + (e.clientX - canvas.left - kPlotLeft_px) / (canvas.width - kPlotLeft_px - kPlotRight_px) * (s.to - s.from), v = values[Math.floor((t - s.begin) / s.step)];
    showTip(`${plan.parameters[i].name}: ${place(plan.parameters[i])}\n${dayTimeText(1e6 * Math.max(s.from, Math.min(s.to, t)))}: ${v === null || v === undefined ? 'no value' : `${percent(v - 1, 0.001)} from its median`}`, e.clientX, e.clientY);
  }
  redraw() { if (this.data) { this.make(); this.drawMap(); } }
  // Follows the width of the card.
  draw() {
    const width = this.width();
    if (!this.plots.length || Math.abs(width - this.plots[0].width) <= 2) return;
    this.redraw();
  }
}
