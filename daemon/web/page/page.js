'use strict';
// Ties the stream of events to what is drawn. All numbers shown come from the events.
const $ = id => document.getElementById(id);
const reasons = ['', 'warming up', 'quiet', 'floor too stiff', 'plan symmetric', 'channel lost'];
const kSilence_ms = 1500;
let plan, building, boxPlots = [], strips = {}, boxes, estimate, baseline = [], status, chosen = 0;
let lastMotion = 0, lastAlive = 0, firstUs = null, lastRow = null, frames = [];
const alarms = new Map();
// What the browser test asks for.
window.framewatch = {rows: 0, lost: 0, leftOut: 0, dropped: 0, latency: [], estimate: null, boxes: null, motion: null, alarms, fps: () => frames.length};

const themes = {};
function theme() {
  const name = document.documentElement.dataset.theme;
  if (!themes[name]) {
    const s = getComputedStyle(document.documentElement);
    themes[name] = Object.fromEntries(['ink', 'soft', 'rule', 'card', 'blue', 'orange', 'green', 'purple', 'grey'].map(k => [k, s.getPropertyValue('--' + k).trim()]));
  }
  return themes[name];
}
const mix = (a, b, t) => '#' + [1, 3, 5].map(i => Math.round(parseInt(a.slice(i, i + 2), 16) * (1 - t) + parseInt(b.slice(i, i + 2), 16) * t).toString(16).padStart(2, '0')).join('');
// Orange: softer than the baseline, blue: stiffer.
const kFullColor = 0.15;
function ratioColor(ratio, style) {
  const t = Math.min(1, Math.abs(ratio - 1) / kFullColor);
  return mix(style.grey, ratio < 1 ? style.orange : style.blue, t);
}
function shortNumber(v) { return v === null ? '' : Math.abs(v) >= 1e4 || (v !== 0 && Math.abs(v) < 1e-3) ? v.toExponential(1) : String(+v.toPrecision(4)); }
function niceTicks(low, high, wanted) {
  const raw = (high - low) / wanted, p = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find(m => m * p >= raw) * p, out = [];
  for (let t = Math.ceil(low / step) * step; t <= high; t += step) out.push(+t.toPrecision(12));
  return out;
}
function showTip(text, x, y) {
  const tip = $('tip');
  tip.textContent = text; tip.hidden = false;
  tip.style.left = Math.max(4, Math.min(innerWidth - tip.offsetWidth - 8, x + 14)) + 'px';
  tip.style.top = Math.max(4, Math.min(innerHeight - tip.offsetHeight - 8, y + 14)) + 'px';
}
function hideTip() { $('tip').hidden = true; }
function place(q) {
  const n = plan.frames_x.length;
  if (q.frame >= 0) return `story ${q.story}, frame ${q.frame < n ? plan.frames_x[q.frame] : plan.frames_y[q.frame - n]}`;
  return `floor ${q.story}, panel ${q.name.split('_').pop()}`;
}
const meaning = ['Story shear of the frame over its story drift.', 'In-plane shear force of the floor panel per unit length and radian.', 'Viscous damping of the frame.', 'Viscous damping of the floor panel.'];
function reference(i) { return baseline[i] || plan.parameters[i].design || null; }
function elementText(i) {
  const q = plan.parameters[i], f = q.kind < 2 ? 1e-3 : 1, unit = (q.kind < 2 ? 'k' : '') + q.unit;
  const out = [`${q.name}: ${place(q)}`, meaning[q.kind]];
  if (estimate && estimate.reason[i] === 0) {
    out.push(`now ${(estimate.value[i] * f).toPrecision(4)} ± ${(estimate.error[i] * f).toPrecision(2)} ${unit} (one standard error)`);
    if (reference(i)) out.push(`${(100 * (estimate.value[i] / reference(i) - 1)).toFixed(1)} % from its ${baseline[i] ? 'baseline' : 'design'}`);
  } else if (estimate) out.push(`no value: ${reasons[estimate.reason[i]]}`);
  if (boxes && boxes.count[i] > 0) out.push(`median ${(boxes.median[i] * f).toPrecision(4)} ${unit}, quartiles ${(boxes.q1[i] * f).toPrecision(4)} to ${(boxes.q3[i] * f).toPrecision(4)}, ${boxes.outliers[i]} outliers in ${boxes.count[i]} windows`);
  return out.join('\n');
}
const clock = us => us > 9.4e14 ? new Date(us / 1e3).toISOString().slice(11, 19) : (us / 1e6).toFixed(1) + ' s';
const seconds = us => (us - firstUs) / 1e6;

function choose(i) {
  chosen = i;
  $('element').value = i;
  building.chosen = Math.max(0, building.faces.findIndex(f => f.i === i));
  strips.k.clear(); strips.drift.clear();
  past.forEach(pushStiffness);
  const q = plan.parameters[i];
  strips.k.name(`${q.name}, ${(q.kind < 2 ? 'k' : '') + q.unit}: value and one standard error`);
  strips.drift.name(q.frame >= 0 ? `story drift in ${place(q)}, mm` : 'story drift: choose a frame');
}
function start(json) {
  plan = json;
  document.title = `${plan.name || 'building'} - framewatch`;
  $('name').textContent = plan.name || 'framewatch';
  $('version').textContent = `framewatch ${plan.version}, configuration ${plan.config_sha256.slice(0, 12)}`;
  $('window').textContent = `windows of ${plan.window_s} s`;
  plan.parameters.forEach((q, i) => $('element').add(new Option(`${q.name}  (${place(q)})`, i)));
  plan.axes.forEach((a, i) => $('channel').add(new Option(a.name, i)));
  building = new Building($('building'), plan, choose);
  boxPlots = [['box-k', 0], ['box-g', 1], ['box-c', 2], ['box-d', 3]].map(([id, kind]) => new Boxes($(id), plan, kind, choose));
  const top = plan.axes.findIndex(a => a.story === plan.stories), rate = plan.rate_hz, parent = $('strips');
  $('channel').value = top;
  strips.accel = new Strip(parent, 'acceleration, m/s²', 'Absolute acceleration of the chosen channel and of the base, calibrated.', [{name: 'channel', color: 'blue'}, {name: 'base', color: 'orange', width: 1}], 10, rate);
  strips.drift = new Strip(parent, 'story drift, mm', 'Displacement of the floor above less that below in the frame, by two leaky integrations for the eye; the estimator integrates nothing.', [{name: 'drift', color: 'purple'}], 10, rate);
  strips.k = new Strip(parent, 'stiffness', 'The newest window\'s value with one standard error to either side; baseline dashed.', [{name: 'value', color: 'blue', width: 2}, {name: '+ error', color: 'blue', width: 0.5}, {name: '- error', color: 'blue', width: 0.5, band: true}, {name: 'baseline', color: 'soft', dash: [5, 4]}], 60, 20);
  strips.excitation = new Strip(parent, 'excitation: rms of the base over a second, m/s²', 'Without excitation nothing can be identified.', [{name: 'base rms', color: 'green'}], 60, 20);
  strips.residual = new Strip(parent, 'residual over response', 'What the identified model leaves of the measured response in the newest window, rms over rms. 0: it explains everything.', [{name: 'residual', color: 'orange'}], 60, 20);
  startSession();
  choose(0);
  const bar = document.createElement('canvas');
  bar.id = 'bar'; bar.width = 160; bar.height = 14; bar.style.width = '160px';
  const text = t => { const s = document.createElement('span'); s.textContent = t; return s; };
  $('scale').replaceChildren(text('−15 %, softer'), bar, text('+15 %, stiffer than the baseline; hatched: no value'));
  applyTheme();
  listen();
  requestAnimationFrame(draw);
}
function applyTheme() {
  const g = $('bar') && $('bar').getContext('2d');
  if (g) for (let x = 0; x < 160; x++) { g.fillStyle = ratioColor(1 + kFullColor * (x / 80 - 1), theme()); g.fillRect(x, 0, 1, 14); }
  for (const s of Object.values(strips)) { s.make(); s.fresh = true; }
}
let rms = [];
function onMotion(m) {
  if (firstUs === null) firstUs = m.first_us;
  const step = 1e6 / plan.rate_hz;
  const axis = +$('channel').value, base = building.baseOf(plan.axes[axis].direction);
  for (const [offset, accel] of m.rows) {
    const us = m.first_us + offset;
    if (lastRow !== null && us > lastRow) window.framewatch.lost += Math.max(0, Math.round((us - lastRow) / step) - 1);
    lastRow = us;
    window.framewatch.rows++;
    building.push(accel);
    const t = seconds(us);
    strips.accel.push([t, accel[axis], accel[base]]);
    const d = building.drift(chosen);
    if (d !== null) strips.drift.push([t, d * 1e3]);
    const b = accel[base];
    if (b !== null && b !== undefined) { rms.push(b); if (rms.length > plan.rate_hz) rms.shift(); }
  }
  window.framewatch.leftOut = m.left_out;
  window.framewatch.motion = m;
  const mean = rms.reduce((a, b) => a + b, 0) / (rms.length || 1);
  strips.excitation.push([seconds(lastRow), Math.sqrt(rms.reduce((a, b) => a + (b - mean) ** 2, 0) / (rms.length || 1))]);
  lastMotion = performance.now();
  pending = lastRow;
}
// Until a gap arrives there is no strip for it.
function onGap(g) {
  window.framewatch.gap = g;
  if (!strips.gap) strips.gap = new Strip($('strips'), 'gap', 'What a simulation with the identified values does not explain of the measurement, rms over rms: of all channels, of the chosen one, and the least that sensor noise allows.', [{name: 'all channels', color: 'orange', width: 2}, {name: 'chosen channel', color: 'blue'}, {name: 'noise floor', color: 'soft', dash: [5, 4]}], 300, 4);
  if (firstUs === null) return;
  const i = g.name.indexOf(plan.axes[+$('channel').value].name);
  strips.gap.name('gap between simulation and measurement' + (i < 0 ? '' : `, ${g.name[i]}`));
  strips.gap.push([seconds(g.end_us), g.overall, i < 0 ? null : g.nrmse[i], g.noise_floor]);
}
let pending = null;
const past = []; // estimates of the last minute: another element's history is there at once
function pushStiffness(e) {
  const f = plan.parameters[chosen].kind < 2 ? 1e-3 : 1, ok = e.reason[chosen] === 0;
  const v = ok ? e.value[chosen] * f : null, s = ok ? e.error[chosen] * f : 0;
  strips.k.push([seconds(e.end_us), v, ok ? v + s : null, ok ? v - s : null, baseline[chosen] ? baseline[chosen] * f : null]);
}
function onEstimate(e) {
  estimate = window.framewatch.estimate = e;
  plan.parameters.forEach((q, i) => {
    if (q.kind > 1) return;
    building.known[i] = e.reason[i] === 0;
    building.ratio[i] = reference(i) ? e.value[i] / reference(i) : 1;
  });
  if (firstUs === null) return;
  past.push(e);
  if (past.length > 1200) past.shift();
  pushStiffness(e);
  strips.residual.push([seconds(e.end_us), e.status === 0 ? null : e.residual]);
}
function cell(row, text, name) { const td = row.insertCell(); td.textContent = text; if (name) td.className = name; return td; }
function heads(table, names) { const row = table.createTHead().insertRow(); for (const n of names) { const th = document.createElement('th'); th.textContent = n; row.append(th); } }
let before = null;
function onStatus(s) {
  status = s;
  const dt = before ? (s.time_us - before.time_us) / 1e6 : 0;
  $('health').textContent = `${s.windows} windows, ${s.gaps} gaps, ${s.refused} messages refused, estimator's delay ${(1e3 * s.latency_s).toFixed(1)} ms, queue at most ${s.queue_high} (${s.queue_dropped} dropped)` + (s.same_config ? '' : '. The estimator runs with another configuration than this page!');
  const table = $('channels');
  table.replaceChildren();
  heads(table, ['channel', 'rate, Hz', 'lost', 'late', 'repaired', 'rejected', 'stuck', 'clipped', 'noise, µm/s²/√Hz']);
  const body = table.createTBody();
  s.channels.forEach((c, i) => {
    const row = body.insertRow(), old = before && before.channels[i];
    cell(row, c.name);
    cell(row, dt > 0 && old ? ((c.received - old.received) / dt).toFixed(1) : '');
    for (const k of ['lost', 'late', 'repaired', 'rejected', 'stuck', 'clipped']) cell(row, c[k], old && c[k] > old[k] ? 'bad' : '');
    cell(row, c.noise === null ? '?' : (c.noise * 1e6).toPrecision(3));
  });
  before = s;
}
const busStates = ['not there', 'active', 'warning', 'passive', 'off'];
function onCan(s) {
  window.framewatch.can = s;
  const table = $('buses'), percent = v => v === null ? '?' : (100 * v).toFixed(0) + ' %';
  table.replaceChildren();
  heads(table, ['bus', 'state', 'frames/s', 'load', 'error frames', 'bus errors', 'bus-off', 'overflow']);
  const body = table.createTBody();
  for (const b of s.buses) {
    const row = body.insertRow();
    cell(row, b.interface); cell(row, busStates[b.state + 1], b.state === 0 ? '' : 'bad'); cell(row, b.frames_hz === null ? '?' : b.frames_hz.toFixed(0));
    cell(row, `${percent(b.load)} (${percent(b.expected_load)})`, b.load > 0.5 ? 'bad' : '');
    for (const k of ['error_frames', 'bus_errors', 'bus_off', 'overflow']) cell(row, b[k], b[k] > 0 ? 'bad' : '');
  }
}
function onAlarm(a) {
  const at = plan.parameters.findIndex(q => q.name === a.place);
  if (a.state !== 0 && !a.acknowledged && !alarms.has(a.id) && at >= 0) choose(at);
  if (a.unit === '%' && a.value !== null) Object.assign(a, {value: a.value / 100, error: a.error === null ? null : a.error / 100, unit: 'ratio'});
  a.told = a.unit !== 'ratio' || a.value === null || a.error === null;  // by its message alone
  alarms.set(a.id, a);
  const list = [...alarms.values()].sort((x, y) => y.time_us - x.time_us);
  $('no-alarms').hidden = list.length > 0;
  const table = $('alarms');
  table.replaceChildren();
  if (list.length) heads(table, ['time', 'place', 'change', 'standard error', 'state', '']);
  const body = table.createTBody();
  for (const x of list.slice(0, 100)) {
    const row = body.insertRow();
    cell(row, clock(x.since_us)); cell(row, x.place).title = x.message;
    cell(row, x.told ? x.message : (100 * x.value).toFixed(1) + ' %'); cell(row, x.told ? '' : (100 * x.error).toFixed(2) + ' %');
    cell(row, x.state === 0 ? 'cleared' : !x.acknowledged ? 'raised' : x.who ? `acknowledged by ${x.who}` : 'acknowledged').title = x.comment || '';
    const last = row.insertCell();
    if (!x.acknowledged && x.state !== 0) last.append(acknowledgeButton(x.id));
  }
  banner(list);
}
const sure = n => n > 100 ? 'more than 100 standard errors' : `${Math.round(n)} standard errors`;
const size = a => a.told ? 0 : Math.abs(a.value);
function banner(list) {
  const open = list.filter(x => x.state !== 0 && !x.acknowledged).sort((x, y) => size(y) - size(x)), box = $('alarm');
  box.hidden = open.length === 0;
  if (!open.length) return;
  const a = open[0], q = plan.parameters.find(p => p.name === a.place);
  const what = document.createElement('strong');
  what.textContent = a.told ? a.message : `${q ? place(q) : a.place}: ${a.value < 0 ? 'softer' : 'stiffer'} by ${Math.abs(100 * a.value).toFixed(1)} %`;
  const error = document.createElement('span');
  error.textContent = a.told ? `since ${clock(a.since_us)}` : `± ${(100 * a.error).toPrecision(2)} % (${sure(Math.abs(a.value / a.error))}), ${a.place}, since ${clock(a.since_us)}` + (open.length > 1 ? `; ${open.length - 1} more` : '');
  box.replaceChildren(what, error, acknowledgeButton(a.id));
}
function acknowledgeButton(id) {
  const b = document.createElement('button');
  b.textContent = 'Acknowledge';
  b.onclick = () => post('acknowledge?id=' + id);
  return b;
}
async function post(path) {
  const answer = await fetch(path, {method: 'POST'}).catch(() => null);
  const text = answer ? (await answer.text()).trim() : 'the server does not answer';
  if (!answer || !answer.ok) warn(text);
  else if (answer.status === 202) given(text);
}
function warn(text) { showTip(text, innerWidth / 2, 60); setTimeout(hideTip, 8000); }
// Commands of this page by their ids, and why some were not obeyed: that may come before the id does.
const ours = new Set(), refusals = new Map();
function given(id) { ours.add(id); showRefusal(id); }
function onRefused(r) {
  if (refusals.size > 100) refusals.clear();
  refusals.set(r.answered, r.refused);
  showRefusal(r.answered);
}
function showRefusal(id) { if (ours.has(id) && refusals.has(id)) warn('Refused: ' + refusals.get(id)); }
function listen() {
  const source = new EventSource('events');
  const on = (name, f) => source.addEventListener(name, e => { lastAlive = performance.now(); f(JSON.parse(e.data)); });
  on('motion', onMotion); on('estimate', onEstimate); on('status', onStatus); on('alarm', onAlarm);
  on('session', onSession); on('gap', onGap); on('can', onCan); on('refused', onRefused);
  on('boxes', b => { boxes = window.framewatch.boxes = b; });
  on('baseline', b => { baseline = b.value; });
  on('dropped', d => { window.framewatch.dropped = d.events; });
  on('alive', () => {});
  source.onopen = () => { lastAlive = performance.now(); };
  // A refusal (too many viewers) ends an EventSource for good.
  source.onerror = () => { if (source.readyState === EventSource.CLOSED) setTimeout(listen, 5000); };
}
function say(text, kind) { const s = $('state'); if (s.textContent !== text) s.textContent = text; s.className = 'pill ' + kind; }
function draw() {
  const now = performance.now();
  frames.push(now);
  while (frames[0] < now - 1000) frames.shift();
  building.draw();
  for (const s of Object.values(strips)) s.draw();
  if (now - (draw.slow || 0) > 200) { draw.slow = now; slow(now); }
  if (pending !== null) {
    const ms = Date.now() - pending / 1e3;
    if (Math.abs(ms) < 1e4) { window.framewatch.latency.push(ms); if (window.framewatch.latency.length > 600) window.framewatch.latency.shift(); }
    pending = null;
  }
  requestAnimationFrame(draw);
}
function slow(now) {
  sessionAge(now);
  for (const b of boxPlots) b.draw(boxes, estimate, baseline, chosen);
  $('chosen').textContent = elementText(chosen).split('\n').slice(0, 1).concat(elementText(chosen).split('\n').slice(2)).join('; ');
  if (now - lastAlive > 3000) say('no connection to the server', 'dead');
  else if (lastMotion === 0) say('waiting for samples', 'wait');
  else if (now - lastMotion > kSilence_ms) say(`no samples for ${((now - lastMotion) / 1e3).toFixed(0)} s`, 'dead');
  else if (!estimate || estimate.status === 0) say('warming up', 'wait');
  else say('live', 'live');
  const l = [...window.framewatch.latency].sort((a, b) => a - b), median = l.length ? l[l.length >> 1] : null;
  $('rates').textContent = `${frames.length} frames/s` + (median !== null ? `, sample to screen ${median.toFixed(0)} ms` : '') + (window.framewatch.dropped ? `, ${window.framewatch.dropped} events dropped` : '');
}
document.documentElement.dataset.theme = localStorage.getItem('theme') || (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
$('theme').onclick = () => {
  const next = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
  document.documentElement.dataset.theme = next;
  localStorage.setItem('theme', next);
  applyTheme();
};
$('baseline').onclick = () => post('baseline');
$('element').onchange = e => choose(+e.target.value);
$('channel').onchange = () => { strips.accel.clear(); if (strips.gap) strips.gap.clear(); };
document.querySelectorAll('.why').forEach(b => {
  const show = () => { const r = b.getBoundingClientRect(); showTip(b.dataset.why, r.left, r.bottom); };
  b.onmouseenter = b.onfocus = b.onclick = show;
  b.onmouseleave = b.onblur = hideTip;
});
document.addEventListener('keydown', e => { if (e.key === 'Escape') hideTip(); });
$('building').addEventListener('pointerleave', hideTip);
document.querySelectorAll('#boxes-card canvas').forEach(c => c.addEventListener('pointerleave', hideTip));
fetch('building.json').then(r => r.ok ? r.json() : Promise.reject(r.statusText)).then(start).catch(e => say('cannot start: ' + e, 'dead'));
