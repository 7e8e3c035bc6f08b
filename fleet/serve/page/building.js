// SPDX-License-Identifier: MIT
'use strict';
// One building: findings, a parameter over time, newest values, sensors, commands.
const kRanges = [['a day', 86400], ['a week', 7 * 86400], ['a month', 31 * 86400], ['a year', 366 * 86400], ['all', 40 * 366 * 86400]];
const seen = {name: '', data: null, parameter: '', range: 86400, plot: null, series: null};

function openBuilding(main, name) {
  if (seen.name !== name) Object.assign(seen, {name, data: null, parameter: '', series: null});
  seen.head = wide(null);
  seen.findings = wide('Findings', el('p', {className: 'soft'}, 'asking'));
  seen.select = el('select', {'aria-label': 'Parameter', onchange: e => { seen.parameter = e.target.value; loadSeries(); }});
  seen.ranges = el('select', {'aria-label': 'Time shown', onchange: e => { seen.range = +e.target.value; loadSeries(); }}, kRanges.map(([word, s]) => el('option', {value: s, selected: s === seen.range}, word)));
  seen.box = el('div', {className: 'plot', role: 'img'});
  seen.note = el('p', {className: 'soft note'});
  seen.values = el('div', {className: 'list plain'});
  seen.channels = el('div', {className: 'list plain'});
  seen.events = el('div', {className: 'list plain cards'});
  seen.commands = el('div');
  seen.stretches = el('div', {className: 'list plain cards'});
  seen.journal = el('div', {className: 'list plain cards'});
  main.replaceChildren(seen.head, seen.findings,
    wide(['Over time', el('span', {className: 'tools'}, seen.select, seen.ranges)], seen.box, seen.note),
    card('Newest values', seen.values), card('Sensors and process', seen.channels),
    wide('Commands', seen.commands), wide('Raw samples', seen.stretches), wide('Journal', seen.journal), wide('Events', seen.events));
  drawCommands();
  let rounds = 0;
  return async () => {
    const data = await ask('building.json', {name});
    if (seen.name !== name) return;
    seen.data = data;
    drawBuilding();
    if (rounds++ % 10 === 0) await loadSeries();
    seen.journal.replaceChildren(journalTable(await ask('journal.json', {name}), false));
  };
}

function drawBuilding() {
  const d = seen.data, facts = [];
  const fact = (word, ...value) => facts.push(el('div', {}, el('dt', {}, word), el('dd', {}, ...value)));
  fact('needs', urgencyWord(d.urgency), d.since_us ? ` since ${when(d.since_us)}` : '');
  fact('heard', d.heard_us === null ? 'never' : `${when(d.heard_us)} (${span((d.now_us - d.heard_us) / 1e6)} ago)`);
  if (d.place) fact('place', d.place);
  if (d.structure) fact('structure', d.structure);
  seen.head.replaceChildren(el('h2', {}, sign(d.urgency), d.title || d.name, d.title ? el('span', {className: 'soft'}, d.name) : null), el('dl', {className: 'facts'}, facts));
  document.title = `${d.title || d.name}: framewatch`;
  drawFindings(d);
  const names = d.parameters.map(p => p.name).join();
  if (seen.select.dataset.names !== names) {
    seen.select.dataset.names = names;
    const changed = d.raised.find(r => d.parameters.some(p => p.name === r.place));
    seen.parameter = seen.parameter || (changed ? changed.place : d.parameters.length ? d.parameters[0].name : '');
    seen.select.replaceChildren(...d.parameters.map(p => el('option', {value: p.name, selected: p.name === seen.parameter}, `${p.name}: ${p.kind === 2 || p.kind === 3 ? 'damping' : 'stiffness'}, ${placeOf(p.name)}`)));
  }
  drawValues(d);
  drawChannels(d);
  drawStretches(d);
  drawEvents(d);
}

function drawFindings(d) {
  const items = d.raised.map(r => el('li', {className: r.severity >= 2 && !r.known ? 'bad' : ''}, el('span', {}, `${r.message || r.kind}`), el('span', {className: 'soft'}, `${r.kind}, since ${when(r.since_us)}${r.known ? ', acknowledged by ' + r.known_to : ''}`),
    me.commands && !r.known ? el('button', {onclick: () => command(d.name, {verb: 'acknowledge', id: r.id})}, 'Acknowledge') : null));
  seen.findings.replaceChildren(el('h2', {}, 'Findings'), items.length ? el('ul', {id: 'findings'}, items) : el('p', {className: 'soft'}, 'No findings.'));
}

function drawValues(d) {
  const rows = d.parameters.map(p => {
    const known = p.observed_us !== undefined && p.median !== null;
    const base = p.baseline !== null && p.baseline !== undefined && Number.isFinite(p.baseline) ? p.baseline : null;
    const record = d.raised.find(r => r.kind === 'stiffness_change' && r.place === p.name && r.std_error > 0); // a change has one size
    const ratio = record ? record.value / 100 : known && base ? p.median / base - 1 : null, error = record ? record.std_error / 100 : known && base ? Math.hypot(p.std_error, (p.median / base) * (p.baseline_std_error || 0)) / base : 0;
    const far = ratio !== null && ratio < 0 && -ratio > 3 * error;
    return el('tr', {}, el('td', {}, el('a', {href: `#/building/${d.name}`, onclick: e => { e.preventDefault(); seen.parameter = seen.select.value = p.name; loadSeries(); seen.box.scrollIntoView({block: 'center'}); }}, p.name), el('div', {className: 'soft'}, placeOf(p.name))),
      numbers('', known ? withError(p.median, p.std_error, p.unit) : el('span', {className: 'soft'}, 'not observable')), numbers('', ratio === null ? '' : el('span', {className: far ? 'loss' : ''}, percent(ratio, error))), numbers('', known ? when(p.observed_us) : ''));
  });
  seen.values.replaceChildren(rows.length ? table(['parameter', '#median', '#from baseline', '#period from'], rows) : el('p', {className: 'soft'}, 'The building has not sent its parameters yet.'));
}

function drawChannels(d) {
  const p = d.process, facts = [];
  const fact = (word, value) => { if (value) facts.push(el('div', {}, el('dt', {}, word), el('dd', {}, value))); };
  if (p) {
    fact('version', p.version);
    fact('running since', when(p.started_us) + (p.unclean_starts ? `, ${p.unclean_starts} unclean starts` : ''));
    fact('memory', bytes(p.resident_bytes));
    fact('disk free', bytes(p.disk_free_bytes));
    fact('newest sample', p.received_us ? when(p.received_us) : 'none yet');
    fact('reload', p.reload_problem);
    fact('state', p.state_problem);
  }
  const count = (title, n) => numbers(title, n === undefined ? '' : n.toLocaleString('en'));
  seen.channels.replaceChildren(el('dl', {className: 'facts'}, facts), d.channels.length ? table(['channel', '#newest', '#lost', '#rejected', '#stuck', '#clipped'], d.channels.map(c => el('tr', {}, el('td', {}, c.name), numbers('', c.newest_us ? when(c.newest_us) : 'none'), count('', c.lost), count('', c.rejected), count('', c.stuck), count('', c.clipped)))) : el('p', {className: 'soft'}, 'No heartbeat has come.'));
}

function drawStretches(d) {
  const state = s => s.problem ? cell(null, `no samples: ${s.problem}`) : s.came < s.pieces ? cell(null, `${s.came} of ${s.pieces} pieces have come`)
    : cell(null, el('a', {href: `raw.mseed?${new URLSearchParams({name: d.name, request: s.request})}`, download: `${d.name}-${s.file}`}, `${d.name}-${s.file}`), `, ${bytes(s.bytes)}`);
  seen.stretches.replaceChildren(d.stretches.length ? table(['newest piece', 'request', 'miniSEED'], d.stretches.map(s => el('tr', {}, cell(null, when(s.newest_us)), cell(null, s.request), state(s)))) : el('p', {className: 'soft'}, 'None was fetched.'));
}

const kStates = ['cleared', 'raised', 'changed'];
function drawEvents(d) {
  seen.events.replaceChildren(d.events.length ? table(['time', 'severity', 'what'], d.events.map(e => el('tr', {}, cell(null, when(e.time_us)), cell(null, urgencyWord(['changed', 'warning', 'alarm'][Math.min(2, Math.max(0, e.severity))]).lastChild.textContent.replace('changed', 'information'), ', ', kStates[e.state] || '?'), cell(null, e.message, el('span', {className: 'soft'}, ` (${e.kind}${e.place ? ', ' + e.place : ''})`))))) : el('p', {className: 'soft'}, 'none'));
}

// The plot: the selected range up to the newest time of the building.
async function loadSeries() {
  const d = seen.data;
  if (!d || !seen.parameter) { seen.note.textContent = 'No values yet.'; return; }
  const last = Math.max(d.now_us, ...d.events.slice(0, 1).map(e => e.time_us)), parameter = seen.parameter;
  const s = await ask('series.json', {name: seen.name, parameter, from_us: Math.max(0, last - seen.range * 1e6), to_us: last + 86400e6}).catch(e => ({problem: e.message}));
  if (parameter !== seen.parameter) return;
  if (s.problem) { seen.note.textContent = s.problem; return; }
  seen.series = s;
  drawSeries();
}
function drawSeries() {
  if (seen.plot) { seen.plot.destroy(); seen.plot = null; }
  const s = seen.series, d = seen.data;
  if (!s || !d) return;
  const p = d.parameters.find(q => q.name === seen.parameter) || {}, unit = s.unit || p.unit || '';
  const values = s.median.filter(v => v !== null), e = engineering(values.length ? Math.max(...values) : 1, unit), scaled = list => list.map(v => v === null ? null : v * e.factor);
  const base = p.baseline !== null && Number.isFinite(p.baseline) ? p.baseline * e.factor : null;
  // A missing period breaks the line.
  const step = s.period_s * s.of, t = [], columns = [[], [], []], from = [s.median, s.q1, s.q3].map(scaled);
  s.t_us.forEach((us, i) => {
    if (i > 0 && (us - s.t_us[i - 1]) / 1e6 > 2.5 * step) { t.push(s.t_us[i - 1] / 1e6 + step); columns.forEach(c => c.push(null)); }
    t.push(us / 1e6 + step / 2);
    columns.forEach((c, k) => c.push(from[k][i]));
  });
  const observed = s.median.filter(v => v !== null).length;
  seen.note.textContent = s.t_us.length === 0 ? 'The database has no values for this time.'
    : `${seen.parameter}: ${placeOf(seen.parameter)}. Line: median of ${span(step)}; band: quartiles${s.of > 1 ? ', the widest of ' + s.of + ' periods' : ''}; ${base === null ? 'the baseline is not known' : 'dashed: the baseline now'}. Vertical: events of severity warning (amber) and alarm (red). ` + (observed < s.t_us.length ? `Not observable in ${s.t_us.length - observed} of ${s.t_us.length} points.` : '');
  if (!s.t_us.length) return;
  const style = theme(), axis = {stroke: style.soft, grid: {stroke: style.rule, width: 1}, ticks: {stroke: style.rule}, font: '12px system-ui'};
  const marks = d.events.filter(v => v.severity > 0 && v.state === 1);
  seen.plot = new uPlot({
    width: Math.max(240, seen.box.clientWidth), height: 300, legend: {live: false}, tzDate: ts => zone === 'UTC' ? uPlot.tzDate(new Date(ts * 1e3), 'Etc/UTC') : new Date(ts * 1e3),
    scales: {y: {range: (u, low, high) => low === null ? [0, 1] : uPlot.rangeNum(Math.min(low, base ?? low), Math.max(high, base ?? high), 0.12, true)}},
    axes: [{...axis, space: 90, values: (u, ts) => ts.map((x, i) => i && dateText(x * 1e6).slice(0, 10) === dateText(ts[i - 1] * 1e6).slice(0, 10) ? clock(x * 1e6) : `${clock(x * 1e6)}\n${dateText(x * 1e6).slice(0, 10)}`)}, {...axis, size: 64, label: `${seen.parameter}, ${e.unit}`, labelSize: 22, labelFont: '12px system-ui'}],
    series: [{}, {label: 'median', stroke: style.blue, width: 1.8, points: {size: 5, filter: alone}}, {label: 'lower quartile', stroke: style.blue + '66', width: 0.7, points: {show: false}}, {label: 'upper quartile', stroke: style.blue + '66', width: 0.7, points: {show: false}}, {label: 'baseline', stroke: style.soft, dash: [5, 4], points: {show: false}}],
    bands: [{series: [3, 2], fill: style.blue + '33'}],
    hooks: {draw: [u => {
      const {left, top, width, height} = u.bbox, g = u.ctx;
      for (const m of marks) {
        const x = u.valToPos(m.since_us / 1e6, 'x', true);
        if (x < left || x > left + width) continue;
        g.strokeStyle = m.severity > 1 ? style.red : style.amber;
        g.lineWidth = 2;
        g.beginPath(); g.moveTo(x, top); g.lineTo(x, top + height); g.stroke();
      }
    }]},
  }, [t, ...columns, t.map(() => base)], seen.box);
  seen.box.replaceChildren(seen.plot.root);
  seen.box.setAttribute('aria-label', `${seen.parameter} over time. ${seen.note.textContent}`);
}
// Marks a value between two missing ones, which has no line.
function alone(plot, series) {
  const v = plot.data[series], out = [];
  for (let i = 0; i < v.length; ++i) if (v[i] !== null && (i === 0 || v[i - 1] === null) && (i + 1 === v.length || v[i + 1] === null)) out.push(i);
  return out.length ? out : null;
}

function drawCommands() {
  if (!me.commands) { seen.commands.replaceChildren(el('p', {className: 'soft'}, me.hub ? 'Only operators may give commands.' : 'This page runs without a hub and cannot give commands.')); return; }
  const now = Date.now() * 1e3, from = timeInput('c-from', now - 3600e6), to = timeInput('c-to', now), channels = el('input', {id: 'c-channels', placeholder: 'all', size: 16});
  const give = (verb, more = () => ({})) => () => command(seen.name, {verb, ...more()});
  const range = () => ({from_us: timeOfForm(from.value), to_us: timeOfForm(to.value)});
  seen.commands.replaceChildren(el('div', {className: 'form'}, el('button', {onclick: give('ping'), title: 'Check that the building answers'}, 'Ping'),
    el('label', {}, `from${zoneText()}, sensor time`, from), el('label', {}, 'to', to), el('label', {}, 'channels, separated by commas', channels),
    el('button', {onclick: give('minutes', range), title: 'Send the summaries of each minute of this time'}, 'Minutes'), el('button', {onclick: give('resend', range), title: 'Send the events and periods of this time again'}, 'Resend'),
    el('button', {onclick: give('raw', () => ({...range(), channels: channels.value.trim()})), title: 'Send the raw samples of this time as miniSEED'}, 'Raw samples')),
  el('p', {className: 'soft note'}, 'A building executes the commands that [fleet] accept in its configuration allows. Commands are recorded in the journal here and in the building.'));
}
async function command(building, words) {
  try {
    const words_ = new URLSearchParams({building, ...words});
    const answer = await fetch(`command?${words_}`, {method: 'POST'}), content = await answer.json();
    if (!answer.ok) throw new Problem(content.problem);
    say(`${words.verb}: sent to ${content.buildings === 1 ? building : content.buildings + ' buildings'}; see the journal for the answer`);
  } catch (e) { say(`${words.verb}: ${e.message}`); }
  soon();
}
