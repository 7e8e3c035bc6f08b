// SPDX-License-Identifier: MIT
'use strict';
// Connects the event stream to the drawings. All numbers come from the events.
const $ = id => document.getElementById(id);
const reasons = ['', 'first window not complete', 'moves too little', 'floor too stiff', 'plan symmetric', 'sensor lost', 'moves, but too uncertain'];
const fitWords = ['', 'it fits', 'only changes are reliable', 'the model does not fit'];
const kSilence_ms = 1500;
let plan, building, boxPlots = [], strips = {}, boxes, estimate, fit, baseline = [], status, chosen = 0;
let lastMotion = 0, lastAlive = 0, lastRow = null, frames = [], known = [];
// Width of the drawings on paper, CSS pixels; 0: on the screen.
const kPaper_px = 680;
let printWidth = 0;
let boxMode = localStorage.getItem('boxes') || 'percent';
const alarms = new Map();
// State that the browser tests read.
window.framewatch = {rows: 0, lost: 0, leftOut: 0, dropped: 0, latency: [], estimate: null, boxes: null, motion: null, alarms, fps: () => frames.length};

const themes = {};
function theme() {
  const name = document.documentElement.dataset.theme;
  if (!themes[name]) {
    const s = getComputedStyle(document.documentElement);
    themes[name] = Object.fromEntries(['ink', 'soft', 'rule', 'card', 'blue', 'orange', 'green', 'purple', 'grey', 'red', 'amber'].map(k => [k, s.getPropertyValue('--' + k).trim()]));
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
function showTip(text, x, y) {
  const tip = $('tip');
  tip.textContent = text; tip.hidden = false;
  tip.style.left = Math.max(4, Math.min(innerWidth - tip.offsetWidth - 8, x + 14)) + 'px';
  tip.style.top = Math.max(4, Math.min(innerHeight - tip.offsetHeight - 8, y + 14)) + 'px';
}
function hideTip() { $('tip').hidden = true; }
const groupMeaning = {0: 'Stories between two measured floors, together: the stiffness of their springs in series, the only stiffness that these channels determine.', 2: 'Viscous damping of these stories together; an equivalent value, whose changes are more reliable than its size.'};
const meaning = ['Story shear of the frame over its story drift.', 'In-plane shear force of the floor panel per unit length and radian.', 'Viscous damping of the frame.', 'Viscous damping of the floor panel.', 'Rotational stiffness of the frames against bending at their base; above the base it is fixed to the design.'];
// Damping is compared with a baseline or with nothing: its design is a guess.
const isDamping = i => plan.parameters[i].kind === 2 || plan.parameters[i].kind === 3;
function reference(i) { return baseline[i] || (!isDamping(i) && plan.parameters[i].design) || null; }
const baselineKnown = () => baseline.some(b => b);
const now_ms = () => playback ? playback.ms : performance.now();
const flows = () => lastMotion > 0 && now_ms() - lastMotion <= kSilence_ms;
const isNow = i => flows() && estimate !== undefined && estimate.reason[i] === 0;
const newestUs = () => Math.max(lastRow || 0, estimate ? estimate.end_us : 0);
// Estimates the sensor time now, so that old values age while no data comes.
const nowUs = () => newestUs() + (flows() || !lastMotion ? 0 : 1e3 * (now_ms() - lastMotion));
const whyNot = i => estimate ? reasons[estimate.reason[i]] || 'no value' : 'no value yet';
function fitOf(i) {
  if (!fit || !fit.word[i]) return '';
  return fit.word[i] === 3 ? fitWords[3] : `absolute value good to ${percent(fit.error[i], fit.error[i]).slice(1)} by the model: ${fitWords[fit.word[i]]}`;
}
function elementText(i) {
  const q = plan.parameters[i], out = [`${q.name}: ${place(q)}`, q.last_story > q.story && groupMeaning[q.kind] || meaning[q.kind]], v = known[i], f = findingOf(q.name);
  if (f) out.push(`${f.ratio < 0 ? 'lost' : 'gained'} ${percent(f.ratio, f.error).slice(1)} of its stiffness, give or take ${percent(f.error, f.error).slice(1)}, since ${when(f.since_us)}`);
  if (v) out.push(`${isNow(i) ? 'newest window' : 'last value'} ${withError(v.value, v.error, q.unit)} (one standard error)` + (isNow(i) ? '' : `, ${span((nowUs() - v.us) / 1e6)} old, of ${when(v.us)}`));
  if (v && fitOf(i)) out.push(fitOf(i));
  if (!isNow(i) && flows()) out.push(`now no value: ${whyNot(i)}`);
  if (reference(i)) out.push(`${baseline[i] ? 'baseline' : 'design'} ${plain(reference(i), q.unit)}`);
  if (boxes && boxes.count[i] > 0) out.push(`median ${plain(boxes.median[i], q.unit)}, quartiles ${plainRange(boxes.q1[i], boxes.q3[i], q.unit)}, ${boxes.outliers[i]} outliers in ${boxes.count[i]} windows`);
  return out.join('\n');
}
const seconds = us => us / 1e6;
let strip = null; // factor and unit of the chosen element

function choose(i) {
  chosen = i;
  saveLayout({element: plan.parameters[i].name});
  $('element').value = i;
  building.chosen = Math.max(0, building.faces.findIndex(f => f.i === i));
  strips.k.clear(); strips.drift.clear();
  const q = plan.parameters[i], size = reference(i) || (known[i] ? known[i].value : 1);
  strip = engineering(size, q.unit);
  past.forEach(pushStiffness);
  strips.k.name(`${called(q)}, ${strip.unit}: value and one standard error`);
  if (years) years.element();
  strips.drift.name(q.frames.length ? `${q.last_story > q.story ? 'drift over' : 'story drift in'} ${place(q)}, mm` : 'story drift: choose a frame');
}
function start(json) {
  plan = json;
  for (const q of plan.parameters) q.last_story ??= q.story;
  document.title = `${plan.name || 'building'} - framewatch`;
  $('name').textContent = plan.name || 'framewatch';
  $('version').textContent = `framewatch ${plan.version}, configuration ${plan.config_sha256.slice(0, 12)}`;
  $('window').textContent = `windows of ${plan.window_s} s`;
  $('baseline').hidden = plan.watch; // then it is framewatch run's, of its configuration
  plan.parameters.forEach((q, i) => $('element').add(new Option(`${q.name}  (${place(q)})`, i)));
  plan.axes.forEach((a, i) => $('channel').add(new Option(a.name, i)));
  building = new Building($('building'), plan, choose);
  boxPlots = [['box-k', 0], ['box-g', 1], ['box-c', 2], ['box-d', 3]].map(([id, kind]) => new Boxes($(id), plan, kind, choose));
  const top = plan.axes.findIndex(a => a.story === plan.stories), rate = plan.rate_hz, parent = $('strips');
  const kept = plan.axes.findIndex(a => a.name === layout.channel);
  $('channel').value = kept < 0 ? top : kept;
  strips.accel = new Strip(parent, 'acceleration, m/s²', 'Absolute acceleration of the chosen channel and of the base, calibrated.', [{name: 'channel', color: 'blue'}, {name: 'base', color: 'orange', width: 1}], 10, rate);
  strips.drift = new Strip(parent, 'story drift, mm', 'Displacement of the floor above less that below in the frame, by two leaky integrations for the eye; the estimator integrates nothing.', [{name: 'drift', color: 'purple'}], 10, rate);
  strips.k = new Strip(parent, 'stiffness', 'The newest window\'s value with one standard error to either side; baseline dashed.', [{name: 'value', color: 'blue', width: 2}, {name: '+ error', color: 'blue', width: 0.5}, {name: '- error', color: 'blue', width: 0.5, band: true}, {name: 'baseline', color: 'soft', dash: [5, 4]}], 300, 4);
  strips.excitation = new Strip(parent, 'excitation: rms of the base over a second, m/s²', 'Without excitation nothing can be identified.', [{name: 'base rms', color: 'green'}], 300, 4);
  strips.residual = new Strip(parent, 'residual over response', 'Part of the measured response that the identified model does not explain in the newest window, rms over rms. 0: it explains everything.', [{name: 'residual', color: 'orange'}], 300, 4);
  signals = new Signals();
  if (plan.history) years = window.framewatch.yearsView = new Years();
  startSession();
  startModes();
  choose(Math.max(0, plan.parameters.findIndex(q => q.name === layout.element)));
  const bar = document.createElement('canvas');
  bar.id = 'bar'; bar.width = 160; bar.height = 14; bar.style.width = '160px'; bar.setAttribute('aria-hidden', 'true');
  const text = t => { const s = document.createElement('span'); s.textContent = t; return s; };
  const ends = text('−15 % softer');
  ends.append(bar, '+15 % stiffer');
  $('scale').replaceChildren(ends, text(' than the baseline; gray: as the baseline, or it has none yet; paler: the last value; hatched: never had one'));
  applyTheme();
  boxButton();
  if (startPlayback()) listen();
  else fetch('history.json').then(r => r.ok ? r.json() : null).catch(() => null).then(before).finally(listen);
  requestAnimationFrame(draw);
}
function applyTheme() {
  const g = $('bar') && $('bar').getContext('2d');
  if (g) for (let x = 0; x < 160; x++) { g.fillStyle = ratioColor(1 + kFullColor * (x / 80 - 1), theme()); g.fillRect(x, 0, 1, 14); }
  for (const s of Object.values(strips)) { s.make(); s.fresh = true; }
  if (signals) signals.make();
  if (years) years.redraw();
}
// Forgets all that was shown, for another time of a recorded session.
function forget() {
  known = []; rms = []; past.length = 0; alarms.clear();
  estimate = boxes = fit = undefined; baseline = []; modes = {modes: []};
  told = {answers: [], findings: [], drift: []};
  lastRow = null; lastMotion = 0;
  building.begin(); building.largest = 1e-6; building.ratio = []; building.known = [];
  for (const s of Object.values(strips)) s.clear();
  signals.clear();
}
// Loads the history before the page was opened.
function before(history) {
  if (!history) return;
  for (const m of history.motion) takeMotion(m);
  lastRow = history.motion.length ? lastRow : null;
  if (history.motion.length) lastMotion = performance.now() - 1e3 * history.silent_s;
  Object.assign(window.framewatch, {rows: 0, lost: 0, motion: null, opened: history.rows.length});
  pending = null;
  resumed = true;
  for (const [end_us, , , x, y] of history.rows) strips.excitation.push([seconds(end_us), plan.axes[+$('channel').value].direction === 'x' ? x : y]);
  estimatesOf(history);
}
function estimatesOf(history) {
  for (const [end_us, status, residual, , , value, error] of history.rows) {
    remember({end_us, status, residual, value, error, reason: value.map(v => v === null ? 2 : 0)});
    pushResidual({end_us, status, residual});
  }
}
// Reloads the history, because windows before the tuning of filters have values now.
function onLate() {
  fetch('history.json').then(r => r.ok ? r.json() : null).then(history => {
    if (!history) return;
    past.length = 0;
    strips.k.clear(); strips.residual.clear();
    estimatesOf(history);
  }).catch(() => {});
}
let rms = [], resumed = false;
function onMotion(m) {
  if (resumed) { lastRow = null; resumed = false; } // the moment between history and stream is no loss
  takeMotion(m);
  lastMotion = now_ms();
  pending = lastRow;
}
function takeMotion(m) {
  const step = 1e6 / plan.rate_hz;
  const axis = +$('channel').value, base = building.baseOf(plan.axes[axis].direction);
  for (const [offset, accel] of m.rows) {
    const us = m.first_us + offset;
    if (lastRow !== null && us > lastRow) window.framewatch.lost += Math.max(0, Math.round((us - lastRow) / step) - 1);
    if (lastRow !== null && Math.abs(us - lastRow) > 1e6) building.begin();
    lastRow = us;
    window.framewatch.rows++;
    building.push(accel);
    const t = seconds(us);
    strips.accel.push([t, accel[axis], accel[base]]);
    const d = building.drift(chosen);
    strips.drift.push([t, d === null ? null : d * 1e3]);
    signals.row(t, accel);
    const b = accel[base];
    if (b !== null && b !== undefined) { rms.push(b); if (rms.length > plan.rate_hz) rms.shift(); }
  }
  window.framewatch.leftOut = m.left_out;
  window.framewatch.motion = m;
  const mean = rms.reduce((a, b) => a + b, 0) / (rms.length || 1);
  const excitation = Math.sqrt(rms.reduce((a, b) => a + (b - mean) ** 2, 0) / (rms.length || 1));
  strips.excitation.push([seconds(lastRow), excitation]);
  signals.value('rms', seconds(lastRow), excitation);
}
// Creates the strip of the gap when the first gap arrives.
function onGap(g) {
  window.framewatch.gap = g;
  if (!strips.gap) strips.gap = new Strip($('strips'), 'gap', 'Part of the measurement that a simulation with the identified values does not explain, rms over rms: of all channels, of the chosen one, and the least that sensor noise allows.', [{name: 'all channels', color: 'orange', width: 2}, {name: 'chosen channel', color: 'blue'}, {name: 'noise floor', color: 'soft', dash: [5, 4]}], 300, 4);
  const i = g.name.indexOf(plan.axes[+$('channel').value].name);
  strips.gap.name('gap between simulation and measurement' + (i < 0 ? '' : `, ${g.name[i]}`));
  signals.value('gap', seconds(g.end_us), g.overall);
  strips.gap.push([seconds(g.end_us), g.overall, i < 0 ? null : g.nrmse[i], g.noise_floor]);
}
let pending = null;
const past = []; // estimates of the last minutes: another element's history is there at once
function pushStiffness(e) {
  const f = strip.factor, ok = e.reason[chosen] === 0;
  const v = ok ? e.value[chosen] * f : null, s = ok ? e.error[chosen] * f : 0;
  strips.k.push([seconds(e.end_us), v, ok ? v + s : null, ok ? v - s : null, baseline[chosen] ? baseline[chosen] * f : null]);
}
// Keeps the newest value of each element with its time.
function remember(e) {
  e.value.forEach((v, i) => { if (e.reason[i] === 0) known[i] = {value: v, error: e.error[i], us: e.end_us}; });
  if (past.length && e.end_us < past.at(-1).end_us) past.length = 0; // another clock
  if (past.length && e.end_us - past.at(-1).end_us < 2.5e5) return;
  past.push(e);
  if (past.length > 1200) past.shift();
  pushStiffness(e);
  signals.estimate(e);
}
function onLast(l) {
  l.index.forEach((i, k) => { if (!known[i] || known[i].us < l.end_us[k]) known[i] = {value: l.value[k], error: l.error[k], us: l.end_us[k]}; });
}
function onEstimate(e) {
  estimate = window.framewatch.estimate = e;
  remember(e);
  pushResidual(e);
}
function pushResidual(e) { strips.residual.push([seconds(e.end_us), e.status === 0 ? null : e.residual]); }
function colour() {
  plan.parameters.forEach((q, i) => {
    if (q.kind > 1 && q.kind !== 4) return;
    const f = findingOf(q.name);
    building.known[i] = known[i] !== undefined;
    building.old[i] = !isNow(i);
    if (known[i]) building.ratio[i] = f ? 1 + f.ratio : baseline[i] ? known[i].value / baseline[i] : 1;
  });
}
// Narrow screens show the column's title in each cell.
function cell(row, text, name) {
  const td = row.insertCell(), head = row.closest('table').tHead;
  td.textContent = text; if (name) td.className = name;
  if (head && head.rows[0].cells[td.cellIndex].textContent) td.dataset.label = head.rows[0].cells[td.cellIndex].textContent;
  return td;
}
function heads(table, names) { const row = table.createTHead().insertRow(); for (const n of names) { const th = document.createElement('th'); th.textContent = n; row.append(th); } }
function onAlarm(a) {
  const at = plan.parameters.findIndex(q => q.name === a.place);
  if (a.state !== 0 && !a.acknowledged && !alarms.has(a.id) && at >= 0 && !playback) choose(at);
  if (a.unit === '%' && a.value !== null) Object.assign(a, {value: a.value / 100, error: a.error === null ? null : a.error / 100, unit: 'ratio'});
  a.told = a.unit !== 'ratio' || a.value === null || a.error === null;  // by its message alone
  alarms.set(a.id, a);
  showAlarms();
}
const placeName = name => { const q = plan.parameters.find(p => p.name === name); return q ? called(q) : name; };
function showAlarms() {
  const list = [...alarms.values()].sort((x, y) => y.time_us - x.time_us);
  $('no-alarms').hidden = list.length > 0;
  const table = $('alarms');
  table.replaceChildren();
  if (list.length) heads(table, ['since', 'place', 'change', 'standard error', 'state', '']);
  const body = table.createTBody();
  for (const x of list.slice(0, 100)) {
    const row = body.insertRow();
    cell(row, when(x.since_us)); cell(row, placeName(x.place)).title = x.message;
    cell(row, x.told ? x.message : percent(x.value, x.error), x.told ? 'text' : ''); cell(row, x.told ? '' : percent(x.error, x.error).slice(1));
    cell(row, x.state === 0 ? `over, ${when(x.time_us)}` : !x.acknowledged ? 'open' : x.who ? `acknowledged by ${x.who}` : 'acknowledged').title = x.comment || '';
    const last = row.insertCell();
    if (!x.acknowledged && x.state !== 0) last.append(acknowledgeButton([x.id], x.message));
  }
}
async function post(path) {
  const answer = await fetch(path, {method: 'POST'}).catch(() => null);
  const text = answer ? (await answer.text()).trim() : 'the server does not answer';
  if (!answer || !answer.ok) warn(text);
  else if (answer.status === 202) given(text);
}
function warn(text) { showTip(text, innerWidth / 2, 60); setTimeout(hideTip, 8000); }
// Commands of this page by id, and refusals, which may come before the id.
const ours = new Set(), refusals = new Map();
function given(id) { ours.add(id); showRefusal(id); }
function onRefused(r) {
  if (refusals.size > 100) refusals.clear();
  refusals.set(r.answered, r.refused);
  showRefusal(r.answered);
}
function showRefusal(id) { if (ours.has(id) && refusals.has(id)) warn('Refused: ' + refusals.get(id)); }
const handlers = {
  motion: onMotion, estimate: onEstimate, late: onLate, status: onStatus, alarm: onAlarm, session: onSession, gap: onGap, can: onCan, refused: onRefused,
  boxes: b => { boxes = window.framewatch.boxes = b; }, fit: f => { fit = f; }, answers: onAnswers, last: onLast, modes: onModes, baseline: b => { baseline = b.value; },
  dropped: d => { window.framewatch.dropped = d.events; }, alive: () => {},
};
// Events that do not belong to the time of a recorded session.
const ofNow = {session: true, refused: true, dropped: true, alive: true};
function listen() {
  const source = new EventSource('events');
  for (const name of Object.keys(handlers))
    source.addEventListener(name, e => {
      lastAlive = performance.now();
      const handle = !playback || ofNow[name] ? handlers[name] : name === 'answers' ? showNow : null;
      if (handle) handle(JSON.parse(e.data));
    });
  source.onopen = () => { lastAlive = performance.now(); };
  // A refusal (too many viewers) ends an EventSource for good.
  source.onerror = () => { if (source.readyState === EventSource.CLOSED) setTimeout(listen, 5000); };
}
function say(text, kind) { const s = $('state'); if (s.textContent !== text) s.textContent = text; s.className = 'pill ' + kind; }
function draw() {
  const now = performance.now();
  frames.push(now);
  while (frames[0] < now - 1000) frames.shift();
  if (playback) playback.step(now);
  building.shape = shapeAt(now);
  building.draw();
  for (const s of Object.values(strips)) s.draw();
  signals.draw(now);
  if (years) years.draw();
  if (now - (draw.slow || 0) > 200) { draw.slow = now; slow(now); }
  if (pending !== null) {
    const ms = Date.now() - pending / 1e3;
    if (Math.abs(ms) < 1e4 && !playback) { window.framewatch.latency.push(ms); if (window.framewatch.latency.length > 600) window.framewatch.latency.shift(); }
    pending = null;
  }
  requestAnimationFrame(draw);
}
function slow(now) {
  sessionAge(now);
  colour();
  building.still = !flows();
  for (const b of boxPlots) b.draw();
  const [name, , ...rest] = elementText(chosen).split('\n');
  say2($('chosen'), [name, ...rest].join('; '));
  if (now - (slow.table || 0) > 1000) { slow.table = now; valueTable(); }
  if (now - lastAlive > 3000) say('no connection to the server', 'dead');
  else if (playback) say('a recorded session', 'record');
  else if (lastMotion === 0) say('waiting for samples', 'wait');
  else if (now - lastMotion > kSilence_ms) say(`no samples for ${span((now - lastMotion) / 1e3)}`, 'dead');
  else if (deadChannels().size) say(`live, but ${deadChannels().size} of ${plan.axes.length} sensors not good`, 'amber');
  else if (!estimate || estimate.status === 0) say('first window not complete', 'wait');
  else if (told.findings.some(f => f.kind === 'belief')) say('live, but the model does not fit', 'amber');
  else say('live', 'live');
  const l = [...window.framewatch.latency].sort((a, b) => a - b), median = l.length ? l[l.length >> 1] : null;
  $('rates').textContent = `${frames.length} frames/s` + (median !== null ? `, sample to screen ${median.toFixed(0)} ms` : '') + (window.framewatch.dropped ? `, ${window.framewatch.dropped} events dropped` : '');
}
const root = document.documentElement;
function useTheme(name) { root.dataset.theme = name; applyTheme(); }
root.dataset.theme = localStorage.getItem('theme') || (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
$('theme').onclick = () => { useTheme(root.dataset.theme === 'dark' ? 'light' : 'dark'); localStorage.setItem('theme', root.dataset.theme); };
// Redraws the canvases in light colors for printing.
let screenTheme = null;
function redraw() { building.draw(); for (const b of boxPlots) b.draw(); for (const s of Object.values(strips)) s.draw(); signals.drawn = 0; signals.draw(performance.now()); if (years) years.redraw(); }
addEventListener('beforeprint', () => { screenTheme = root.dataset.theme; printWidth = kPaper_px; useTheme('light'); redraw(); });
addEventListener('afterprint', () => { printWidth = 0; if (screenTheme) useTheme(screenTheme); redraw(); });
function zoneButton() { $('zone').textContent = zone === 'UTC' ? 'Times: UTC' : 'Times: local'; }
$('zone').onclick = () => {
  zone = zone === 'UTC' ? 'local' : 'UTC';
  localStorage.setItem('zone', zone);
  zoneButton(); showAnswers(); showAlarms(); loadEventReports();
  if (years && years.data) years.show(years.data);
  for (const s of Object.values(strips)) { s.make(); s.fresh = true; }
};
zoneButton();
function boxButton() { $('box-mode').textContent = boxMode === 'percent' ? 'Show true values' : 'Show percent'; }
$('box-mode').onclick = () => { boxMode = boxMode === 'percent' ? 'true' : 'percent'; localStorage.setItem('boxes', boxMode); boxButton(); };
$('values').addEventListener('toggle', () => plan && valueTable());
$('baseline').onclick = () => $('ask-baseline').showModal();
$('ask-baseline').addEventListener('close', () => { if ($('ask-baseline').returnValue === 'yes') post('baseline'); $('ask-baseline').returnValue = ''; });
$('element').onchange = e => choose(+e.target.value);
$('channel').onchange = () => { saveLayout({channel: plan.axes[+$('channel').value].name}); strips.accel.clear(); if (strips.gap) strips.gap.clear(); };
document.querySelectorAll('.why').forEach(b => {
  b.setAttribute('aria-label', 'What is this? ' + b.dataset.why);
  const show = () => { const r = b.getBoundingClientRect(); showTip(b.dataset.why, r.left, r.bottom); };
  b.onmouseenter = b.onfocus = b.onclick = show;
  b.onmouseleave = b.onblur = hideTip;
});
document.addEventListener('keydown', e => { if (e.key === 'Escape') hideTip(); });
$('building').addEventListener('pointerleave', hideTip);
document.querySelectorAll('#boxes-card canvas').forEach(c => c.addEventListener('pointerleave', hideTip));
startLayout();
fetch('building.json').then(r => r.ok ? r.json() : Promise.reject(r.statusText)).then(start).catch(e => say('cannot start: ' + e, 'dead'));
