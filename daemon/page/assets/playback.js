// SPDX-License-Identifier: MIT
'use strict';
// Plays a recorded session (#session=NAME): the server sends the events that the live page got, and the same functions
// draw them. Leaving and entering load the page anew, so nothing of one time is left in the other.
const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const kSettle_s = 1.3; // times the period of the high-pass: until drifts are right
let playback = null;
class Playback {
  constructor(name) {
    Object.assign(this, {name, events: [], next: 0, at: 0, ms: 0, loaded: 0, length: 0, done: false, playing: true, sought: null, drawn: performance.now()});
    $('playback').hidden = false;
    document.body.classList.add('playing');
    for (const s of kSpeeds) $('p-speed').add(new Option(`× ${s}`, s, s === 1, s === 1));
    $('p-name').textContent = name;
    $('p-play').onclick = () => { if (!this.playing && this.done && this.at >= this.loaded) this.sought = 0; this.playing = !this.playing; };
    $('p-at').oninput = e => { this.sought = +e.target.value; };
    $('p-live').onclick = () => { location.hash = ''; };
  }
  say(text) { say2($('p-news'), text); }
  async load() {
    const answer = await fetch(`session/${encodeURIComponent(this.name)}/playback`).catch(() => null);
    if (!answer || !answer.ok) return this.say('Cannot be shown: ' + (answer ? (await answer.text()).trim() : 'the server does not answer') + '.');
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = '';
    try {
      for (let part; !(part = await reader.read()).done;) {
        const texts = (rest + part.value).split('\n\n');
        rest = texts.pop();
        for (const text of texts) this.take(text);
      }
    } catch { /* said below */ }
    if (!this.done) this.say('The server ended the session early; the rest is not shown.');
    this.done = true;
    this.length = this.loaded;
  }
  take(text) {
    const [, name, json] = /^event: (\w+)\ndata: (.*)$/.exec(text) || [];
    if (!name) return;
    const data = JSON.parse(json);
    if (name === 'time') this.loaded = data;
    else if (name === 'begin') {
      this.length = data.seconds;
      if (data.test) $('p-name').textContent = data.test;
      this.news = data.same_config ? '' : 'Recorded with another configuration of this building: masses and places may differ. ';
      this.say(this.news);
    } else if (name === 'end') {
      this.done = true;
      this.say(this.news + (data.notes.length ? `Damaged: ${data.notes.join('; ')}.` : ''));
    } else if (handlers[name] && !ofNow[name] && name !== 'late') this.events.push([this.loaded, name, data]);
  }
  run(i) { const [t, name, data] = this.events[i]; this.ms = 1e3 * t; handlers[name](data); }
  seek(t) {
    this.at = Math.max(0, Math.min(t, this.loaded));
    forget();
    const fast = this.at - Math.max(10, signals.span) - kSettle_s / plan.high_pass_hz, slow = this.at - 300, last = {};
    const inOrder = {alarm: -1, baseline: -1, last: -1, estimate: slow, gap: slow, motion: fast};
    for (this.next = 0; this.next < this.events.length && this.events[this.next][0] <= this.at; ++this.next) {
      const [when, name] = this.events[this.next];
      if (!(name in inOrder)) last[name] = this.next;
      else if (when >= inOrder[name]) this.run(this.next);
    }
    for (const i of Object.values(last)) this.run(i);
    this.ms = 1e3 * this.at;
    showAnswers(); showAlarms(); colour();
  }
  // Called for every frame.
  step(now) {
    const passed = Math.min(0.5, (now - this.drawn) / 1e3) * +$('p-speed').value;
    this.drawn = now;
    if (this.sought !== null) { this.seek(this.sought); this.sought = null; }
    else if (this.playing && this.loaded > 0) {
      this.at = Math.min(this.at + passed, this.loaded);
      while (this.next < this.events.length && this.events[this.next][0] <= this.at) this.run(this.next++);
      this.ms = 1e3 * this.at;
      if (this.done && this.at >= this.loaded) this.playing = false;
    }
    const range = $('p-at'), max = Math.max(this.loaded, 0.1);
    if (+range.max !== max) range.max = max;
    if (document.activeElement !== range || this.playing) range.value = this.at;
    const time = s => `${Math.floor(s / 60)}:${(s % 60).toFixed(1).padStart(4, '0')}`;
    say2($('p-time'), `${time(this.at)} of ${time(Math.max(this.length, this.loaded))}` + (lastRow ? `, ${when(lastRow)}` : '') + (this.done ? '' : `; ${time(this.loaded)} loaded`));
    say2($('p-play'), this.playing ? 'Pause' : 'Play');
    range.setAttribute('aria-valuetext', $('p-time').textContent);
  }
}
// Shows the open findings of the live building while a session plays.
function showNow(a) {
  const open = a.findings.filter(f => !f.acknowledged).length;
  say2($('p-now'), open ? `Now: ${open} open finding${open > 1 ? 's' : ''}!` : '');
}
function startPlayback() {
  addEventListener('hashchange', () => location.reload());
  const name = new URLSearchParams(location.hash.slice(1)).get('session');
  if (!name) return false;
  playback = window.framewatch.playback = new Playback(name);
  playback.load();
  return true;
}
