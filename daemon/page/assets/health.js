// SPDX-License-Identifier: MIT
'use strict';
// The tables of channels and buses with their counters.
let counted = null;
function onStatus(s) {
  status = s;
  const dt = counted ? (s.time_us - counted.time_us) / 1e6 : 0;
  $('health').textContent = `${s.windows} windows, ${s.gaps} interruptions, ${s.refused} messages refused, estimator's delay ${(1e3 * s.latency_s).toFixed(1)} ms, queue at most ${s.queue_high} (${s.queue_dropped} dropped)` + (s.same_config ? '' : '. The estimator runs with another configuration than this page!');
  const table = $('channels');
  table.replaceChildren();
  heads(table, ['channel', 'rate, Hz', 'lost', 'late', 'repaired', 'rejected', 'stuck', 'clipped', 'noise, µm/s²/√Hz']);
  const body = table.createTBody();
  s.channels.forEach((c, i) => {
    const row = body.insertRow(), old = counted && counted.channels[i], dead = deadChannels().has(c.name);
    cell(row, c.name + (dead ? ' (not good)' : ''), dead ? 'bad' : '');
    cell(row, dt > 0 && old ? ((c.received - old.received) / dt).toFixed(1) : '');
    for (const k of ['lost', 'late', 'repaired', 'rejected', 'stuck', 'clipped']) cell(row, c[k], old && c[k] > old[k] ? 'bad' : '');
    cell(row, c.noise === null ? '?' : (c.noise * 1e6).toPrecision(3));
  });
  counted = s;
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
