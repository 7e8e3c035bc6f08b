// SPDX-License-Identifier: MIT
'use strict';
// Numbers, units and times as people write them.
let zone = localStorage.getItem('zone') || 'UTC';
const isDate = us => us > 9.4e14; // else a sensor clock that does not count from 1970
function dateText(us) {
  const d = new Date(us / 1e3);
  return (zone === 'UTC' ? d : new Date(d - d.getTimezoneOffset() * 6e4)).toISOString();
}
const zoneText = () => zone === 'UTC' ? ' UTC' : '';
const clock = us => isDate(us) ? dateText(us).slice(11, 19) : (us / 1e6).toFixed(1) + ' s';
// With the day where that is not today.
function when(us) {
  if (!isDate(us)) return clock(us);
  const day = dateText(us).slice(0, 10);
  return (day === dateText(Date.now() * 1e3).slice(0, 10) ? '' : day + ' ') + clock(us) + zoneText();
}
function span(s) {
  if (s < 100) return s.toFixed(0) + ' s';
  if (s < 6000) return (s / 60).toFixed(0) + ' min';
  return s < 172800 ? (s / 3600).toFixed(0) + ' h' : (s / 86400).toFixed(0) + ' d';
}
// The factor and the unit in which a value of this size has one to three digits before the point.
function engineering(size, unit) {
  const name = unit.replace(/\*/g, '·'), a = Math.abs(size);
  for (const [power, prefix] of [[1e9, 'G'], [1e6, 'M'], [1e3, 'k']]) if (a >= power) return {factor: 1 / power, unit: prefix + name};
  return {factor: 1, unit: name};
}
function digits(v, n) {
  if (v === null || !Number.isFinite(v)) return '?';
  const before = v === 0 ? 1 : Math.floor(Math.log10(Math.abs(v))) + 1;
  return v.toFixed(Math.min(9, Math.max(0, n - before)));
}
// "25.02 ± 0.14 kN/m": as many digits as the error deserves.
function withError(value, error, unit) {
  const e = engineering(value, unit), v = value * e.factor, s = error * e.factor;
  const places = s > 0 ? Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(s)))) : 3;
  return `${v.toFixed(places)} ± ${s.toFixed(places)} ${e.unit}`;
}
function plain(value, unit) { const e = engineering(value, unit); return `${digits(value * e.factor, 4)} ${e.unit}`; }
function plainRange(low, high, unit) { const e = engineering(high, unit); return `${digits(low * e.factor, 4)} to ${digits(high * e.factor, 4)} ${e.unit}`; }
function percent(ratio, error) {
  const places = error > 0 ? Math.min(2, Math.max(0, Math.ceil(-Math.log10(100 * error)))) : 1;
  return (ratio < 0 ? '−' : '+') + Math.abs(100 * ratio).toFixed(places) + ' %';
}
function niceTicks(low, high, wanted) {
  const raw = (high - low) / wanted, p = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 2.5, 5, 10].find(m => m * p >= raw) * p, out = [];
  for (let t = Math.ceil(low / step) * step; t <= high + step * 1e-9; t += step) out.push(+t.toPrecision(12));
  return out;
}
const frameName = f => [...plan.frames_x, ...plan.frames_y][f];
const frameWords = name => plan.labels[name] || `frame ${name}`;
// The name of a parameter in lists: its place if people labelled its frame.
const called = q => q.frames.length === 1 && plan.labels[frameName(q.frames[0])] ? place(q) : q.name;
// Where a parameter of the plan is.
function place(q) {
  if (q.kind === 4) return `all frames along ${q.direction}`;
  if (q.frames.length) {
    const stories = q.last_story > q.story ? `stories ${q.story} to ${q.last_story}` : `story ${q.story}`;
    return `${stories}, ` + (q.frames.length > 1 ? `along ${q.direction}` : frameWords(frameName(q.frames[0])));
  }
  return `floor ${q.story}, panel ${q.name.split('_').pop()}`;
}
