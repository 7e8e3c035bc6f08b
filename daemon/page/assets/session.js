// SPDX-License-Identifier: MIT
'use strict';
// Acquisition sessions: the state of `framewatch record` and its commands.
const sessionStates = ['ready', 'tap test', 'armed', 'recording'];
let session = null, sessionHeard = 0, asked = null, sessionList = '';

function startSession() {
  for (const b of document.querySelectorAll('[data-verb]')) b.onclick = () => askRecorder(b.dataset.verb);
  sessionButtons();
  loadSessions();
}
async function askRecorder(verb) {
  const query = new URLSearchParams({verb});
  if (verb === 'start' || verb === 'arm') {
    for (const k of ['test', 'operator', 'notes', 'length_s']) query.set(k, $('s-' + k).value);
    if (verb === 'arm') for (const k of ['trigger_mps2', 'pre_trigger_s']) query.set(k, $('s-' + k).value);
  }
  const answer = await fetch('session?' + query, {method: 'POST'}).catch(() => null);
  const text = answer ? (await answer.text()).trim() : 'the server does not answer';
  asked = answer && answer.ok ? text : null;
  if (asked) given(asked); else sessionNews(text);
}
function sessionNews(text) { if ($('session-news').textContent !== text) $('session-news').textContent = text; }
function sessionButtons() {
  const alive = session !== null, state = alive ? session.state : -1;
  for (const b of document.querySelectorAll('[data-verb]'))
    b.disabled = !alive || (b.dataset.verb === 'stop' ? state === 0 : b.dataset.verb === 'tap' ? state !== 0 : state === 3);
}
function onSession(s) {
  const before = session;
  session = window.framewatch.session = s;
  sessionHeard = performance.now();
  const pill = $('session-state'), length = s.length_s > 0 ? ` of ${s.length_s} s` : '';
  pill.textContent = sessionStates[s.state] + (s.state === 3 ? ` ${s.elapsed_s.toFixed(0)} s${length}` : s.state === 2 ? ` at ${s.trigger_mps2} m/s²` : '');
  pill.className = 'pill ' + ['wait', 'live', 'live', 'record'][s.state];
  const bad = s.lost + s.dropped, disk = s.disk_free_bytes < 0 ? '' : `${(s.disk_free_bytes / 1e9).toFixed(1)} GB free`;
  $('session-numbers').textContent = (s.session ? `${s.session}: ${s.messages} messages, ${s.estimates} estimates` + (bad ? `, ${s.lost} lost, ${s.dropped} dropped` : ', none lost') + '; ' : '') + disk;
  sessionNews(asked === s.answered && s.refused ? 'Refused: ' + s.refused : s.message || (s.state === 0 && !s.channels.length ? 'waiting for samples to check the channels' : ''));
  checkTable(s.channels);
  sessionButtons();
  if (!before || before.state !== s.state || before.report !== s.report || before.message !== s.message) loadSessions();
}
function checkTable(channels) {
  const table = $('check');
  table.replaceChildren();
  if (!channels.length) return;
  heads(table, ['channel', 'noise, µm/s²/√Hz', 'rms, m/s²', 'rests at, m/s²', 'peak, m/s²', 'share of range', 'saturated', 'polarity', '']);
  const body = table.createTBody(), n = (v, d) => v === null ? '?' : v >= 1000 ? v.toFixed(0) : v.toPrecision(d);
  for (const c of channels) {
    const row = body.insertRow();
    cell(row, c.name);
    cell(row, c.noise === null ? '?' : n(c.noise * 1e6, 3)); cell(row, n(c.rms, 2)); cell(row, c.offset === null ? '?' : c.offset.toFixed(4)); cell(row, n(c.peak, 3));
    cell(row, c.range > 0 ? (100 * c.peak / c.range).toFixed(0) + ' %' : '');
    cell(row, c.saturated, c.saturated > 0 ? 'bad' : '');
    cell(row, ['reversed', '', 'right'][c.polarity + 1], c.polarity < 0 ? 'bad' : '');
    cell(row, c.problem, 'text' + (c.problem ? ' bad' : ''));
  }
}
async function loadSessions() {
  const answer = await fetch('sessions.json').catch(() => null);
  const text = answer && answer.ok ? await answer.text() : sessionList;
  if (text === sessionList) return;
  sessionList = text;
  const list = JSON.parse(text), table = $('sessions');
  $('session-card').hidden = list === null; // nobody records here
  if (list === null) return;
  table.replaceChildren();
  if (!list.length) return;
  heads(table, ['session', 'test', 'operator', 'length, s', 'state', '']);
  const body = table.createTBody();
  for (const s of list) {
    const row = body.insertRow();
    cell(row, s.session);
    cell(row, s.test); cell(row, s.operator); cell(row, s.seconds.toFixed(1));
    cell(row, s.problems.length ? `${s.state}, ${s.problems.length} to know` : s.state).title = s.problems.join('\n');
    const last = row.insertCell(), play = document.createElement('button');
    play.textContent = 'Play'; play.setAttribute('aria-label', `Play ${s.session}`); play.disabled = s.state === 'recording';
    play.onclick = () => { location.hash = 'session=' + encodeURIComponent(s.session); };
    last.append(play, ' ');
    if (!s.report) continue;
    const link = document.createElement('a');
    link.href = `session/${encodeURIComponent(s.session)}/report.html`; link.textContent = 'report'; link.target = '_blank'; link.rel = 'noopener';
    last.append(link);
  }
}
// Three seconds without a word: the recorder is gone, which says nothing of its files.
function sessionAge(now) {
  if (session === null || now - sessionHeard < 3500) return;
  session = null;
  $('session-state').textContent = 'no recorder';
  $('session-state').className = 'pill wait';
  sessionNews('No recorder answers: framewatch record CONFIG --standby waits for this page.');
  sessionButtons();
}
