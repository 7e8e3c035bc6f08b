// SPDX-License-Identifier: MIT
'use strict';
// Selects the view and polls the server.
const kEvery_ms = {overview: 1000, building: 3000, earthquake: 3000, journal: 2000};
const me = {who: '', role: 'viewer', hub: false, get commands() { return this.hub && this.role === 'operator'; }};
let poll = null, timer = null, kind = '', turn = 0;

function route() {
  const [view, argument] = location.hash.replace(/^#\//, '').split('/');
  const routes = {building: openBuilding, earthquake: openEarthquake, journal: openJournal};
  kind = routes[view] ? view : 'overview';
  for (const a of document.querySelectorAll('nav a')) {
    const of = a.getAttribute('href').replace('#/', '') || 'overview';
    if (of === kind || (of === 'overview' && kind === 'building')) a.setAttribute('aria-current', 'page'); else a.removeAttribute('aria-current');
  }
  document.title = 'framewatch: buildings';
  quake.same = '';
  poll = (routes[view] || openOverview)($('view'), argument ? decodeURIComponent(argument) : '');
  ++turn;
  next(0);
}
function next(ms) {
  clearTimeout(timer);
  timer = setTimeout(round, ms);
}
function soon() { next(300); }
async function round() {
  const mine = turn;
  if (document.hidden) { next(1000); return; }
  try {
    await poll();
    trouble('');
  } catch (e) {
    if (!(e instanceof Problem)) console.error(e);
    if (mine === turn) trouble(e.message);
  }
  if (mine === turn) next(kEvery_ms[kind]);
}
let troubleSince = 0;
function trouble(text) {
  const box = $('trouble');
  troubleSince = text ? troubleSince || Date.now() * 1e3 : 0;
  box.hidden = !text;
  if (text) box.textContent = `${text}; the values shown are from before ${when(troubleSince)}`;
}
let saying = null;
function say(text) {
  $('alert').textContent = text;
  clearTimeout(saying);
  $('who').textContent = text;
  saying = setTimeout(showMe, 8000);
}
function showMe() { $('who').textContent = `${me.who}${me.role === 'operator' ? ', operator' : ''}`; }

const themes = {};
function theme() {
  const name = document.documentElement.dataset.theme;
  if (!themes[name]) {
    const s = getComputedStyle(document.documentElement);
    themes[name] = Object.fromEntries(['ink', 'soft', 'rule', 'card', 'blue', 'red', 'amber'].map(k => [k, s.getPropertyValue('--' + k).trim()]));
  }
  return themes[name];
}
const root = document.documentElement;
root.dataset.theme = localStorage.getItem('theme') || (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
$('theme').onclick = () => { root.dataset.theme = root.dataset.theme === 'dark' ? 'light' : 'dark'; localStorage.setItem('theme', root.dataset.theme); if (kind === 'building') drawSeries(); };
$('zone').textContent = zone === 'UTC' ? 'UTC' : 'Local time';
$('zone').onclick = () => { zone = zone === 'UTC' ? 'local' : 'UTC'; localStorage.setItem('zone', zone); $('zone').textContent = zone === 'UTC' ? 'UTC' : 'Local time'; route(); };
addEventListener('hashchange', route);
addEventListener('visibilitychange', () => { if (!document.hidden) soon(); });
addEventListener('resize', () => { if (kind === 'overview') drawMap(); if (kind === 'building' && seen.plot) seen.plot.setSize({width: Math.max(240, seen.box.clientWidth), height: 300}); });
ask('me.json').then(m => { me.who = m.who; me.role = m.role; me.hub = m.hub; showMe(); }).catch(e => trouble(e.message)).finally(route);
