// SPDX-License-Identifier: MIT
'use strict';
// Parts of the page. Text of buildings and people becomes text nodes, never markup.
const $ = id => document.getElementById(id);
function put(e, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) e.addEventListener(name.slice(2), value);
    else e.setAttribute(name === 'className' ? 'class' : name, value === true ? '' : value);
  }
  e.append(...children.flat().filter(c => c !== null && c !== undefined && c !== false));
  return e;
}
const el = (tag, properties = {}, ...children) => put(document.createElement(tag), properties, children);
const svg = (tag, properties = {}, ...children) => put(document.createElementNS('http://www.w3.org/2000/svg', tag), properties, children);
const card = (title, ...children) => el('section', {className: 'card'}, title ? el('h2', {}, ...[title].flat()) : null, ...children);
const wide = (title, ...children) => { const c = card(title, ...children); c.classList.add('wide'); return c; };
const cell = (title, ...children) => el('td', {'data-title': title}, ...children);
const numbers = (title, ...children) => el('td', {'data-title': title, className: 'n'}, ...children);
function table(titles, rows, className = '') {
  return el('table', {className}, el('thead', {}, el('tr', {}, titles.map(t => t.startsWith('#') ? el('th', {className: 'n', scope: 'col'}, t.slice(1)) : el('th', {scope: 'col'}, t)))), el('tbody', {}, rows));
}

// Shows the urgency of a building by a shape too, for color-blind viewers.
const kUrgencies = ['alarm', 'warning', 'silent', 'changed', 'known', 'well'];
const kMeaning = {
  alarm: 'an alarm is raised and not acknowledged', warning: 'a warning is raised and not acknowledged', silent: 'no heartbeat for three minutes',
  changed: 'only information is raised', known: 'all raised events are acknowledged', well: 'no event is raised, and heartbeats come',
};
function shape(urgency) {
  switch (urgency) {
    case 'alarm': return svg('path', {d: 'M0,-8 L8,7 L-8,7 Z'});
    case 'warning': return svg('rect', {x: -6, y: -6, width: 12, height: 12, transform: 'rotate(45)'});
    case 'silent': return svg('circle', {r: 6, className: 'hollow'});
    case 'changed': return svg('rect', {x: -6, y: -6, width: 12, height: 12});
    default: return svg('circle', {r: urgency === 'known' ? 6 : 5});
  }
}
const sign = urgency => svg('svg', {className: `sign u-${urgency}`, viewBox: '-9 -9 18 18', 'aria-hidden': 'true'}, shape(urgency));
const urgencyWord = urgency => el('span', {className: `word u-${urgency}`, title: kMeaning[urgency]}, sign(urgency), ' ', urgency);

class Problem extends Error {}
async function ask(path, parameters = {}, options = {}) {
  const words = new URLSearchParams(Object.entries(parameters).filter(([, v]) => v !== undefined && v !== null && v !== ''));
  let answer;
  try { answer = await fetch(`${path}?${words}`, options); } catch { throw new Problem('the server of this page does not answer'); }
  if (answer.status === 204) return null;
  const type = answer.headers.get('Content-Type') || '';
  const content = type.startsWith('application/json') ? await answer.json() : {problem: (await answer.text()).trim()};
  if (!answer.ok) throw new Problem(content.problem || `the server says ${answer.status}`);
  return content;
}
const percentOf = (ratio, error) => percent(ratio, error) + (error > 0 ? ` ± ${(100 * error).toFixed(error > 0.01 ? 1 : 2)} %` : '');
const bytes = n => n < 0 ? 'not known' : n < 1e6 ? `${(n / 1e3).toFixed(0)} kB` : n < 1e9 ? `${(n / 1e6).toFixed(1)} MB` : `${(n / 1e9).toFixed(1)} GB`;
// Returns the place of "kx_1_y2" in words.
function placeOf(name) {
  const [kind, where, frame] = name.split('_');
  if (!where) return name;
  const stories = where.includes('to') ? `stories ${where.replace('to', ' to ')}` : (kind.startsWith('G') ? 'floor ' : 'story ') + where;
  return frame ? `${stories}, ${kind.startsWith('G') ? 'panel' : 'frame'} ${frame}` : stories;
}
// Times in a form, in UTC or in the zone of the device.
const formTime = us => dateText(us).slice(0, 19);
const timeOfForm = text => text ? Math.round((zone === 'UTC' ? Date.parse(text + 'Z') : Date.parse(text)) * 1e3) : NaN;
const timeInput = (id, us) => el('input', {id, type: 'datetime-local', step: 1, value: formTime(us)});
