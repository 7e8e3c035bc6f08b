// SPDX-License-Identifier: MIT
'use strict';
// All buildings: counts, map, list by severity. Redrawn when something changes.
const overview = {version: '', data: null, behind_us: 0, urgencies: new Set(), words: '', view: null};

function openOverview(main) {
  overview.rows = new Map();
  overview.counts = el('ul', {className: 'counts'});
  overview.heard = el('p', {className: 'soft note'});
  overview.body = el('tbody');
  overview.empty = el('p', {className: 'soft empty', hidden: true});
  const find = el('input', {type: 'search', placeholder: 'name, title, place', 'aria-label': 'Show buildings whose name, title or place contains this text', value: overview.words, oninput: e => { overview.words = e.target.value; filterOverview(); }});
  overview.map = svg('svg', {id: 'map', role: 'group', 'aria-label': 'Map of buildings, north at the top'});
  overview.mapNote = el('p', {className: 'soft note'});
  const zoom = factor => () => { zoomMap(factor); };
  main.replaceChildren(
    wide(null, overview.counts, overview.heard),
    card(['Map', el('span', {className: 'grow'}), el('span', {className: 'tools'}, el('button', {onclick: zoom(1.6), 'aria-label': 'Nearer'}, '+'), el('button', {onclick: zoom(1 / 1.6), 'aria-label': 'Farther'}, '−'), el('button', {onclick: () => { overview.view = null; drawMap(); }}, 'All'))], overview.map, overview.mapNote),
    card(['Buildings', el('span', {className: 'grow'}), el('span', {className: 'tools'}, find)], el('div', {className: 'list cards'}, el('table', {}, el('thead', {}, el('tr', {}, ['needs', 'building', 'since', 'what'].map(t => el('th', {scope: 'col'}, t)))), overview.body)), overview.empty));
  overview.version = '';
  moveMap(overview.map);
  if (overview.data) drawOverview();
  return pollOverview;
}

async function pollOverview() {
  const data = await ask('overview.json', {version: overview.version});
  if (data === null) return;
  overview.data = data;
  overview.version = data.version;
  drawOverview();
}

function drawOverview() {
  const d = overview.data, all = d.buildings.length;
  overview.counts.replaceChildren(...kUrgencies.map(u => el('li', {}, el('button', {title: kMeaning[u], 'aria-pressed': String(overview.urgencies.has(u)), onclick: () => { if (!overview.urgencies.delete(u)) overview.urgencies.add(u); drawOverview(); }}, sign(u), el('b', {}, String(d.counts[u])), u))));
  const nothing = d.now_us - d.heard_us > 180e6;
  overview.heard.textContent = all === 0 ? 'No building has sent anything yet, or no worker stores it.'
    : `${all} buildings. ` + (nothing ? `Nothing has come since ${when(d.heard_us)}: check the hub and the workers first.` : '');
  $('alert').textContent = kUrgencies.filter(u => d.counts[u]).map(u => `${d.counts[u]} ${u}`).join(', ');
  document.title = (d.counts.alarm ? `(${d.counts.alarm}) ` : '') + 'framewatch: buildings';
  const rows = new Map();
  for (const b of d.buildings) {
    const key = JSON.stringify([b, zone]), old = overview.rows.get(b.name);
    rows.set(b.name, old && old.key === key ? old : {key, building: b, row: overviewRow(b)});
  }
  overview.rows = rows;
  overview.body.replaceChildren(...[...rows.values()].map(r => r.row));
  filterOverview();
  drawMap();
}
const titleOf = b => b.title || b.name;
function overviewRow(b) {
  return el('tr', {}, cell(null, urgencyWord(b.urgency)),
    el('td', {className: 'name'}, el('a', {href: `#/building/${b.name}`}, titleOf(b)), el('div', {className: 'soft'}, [b.title ? b.name : '', b.place].filter(Boolean).join(', '))),
    cell(null, b.since_us ? when(b.since_us) : ''),
    cell(null, b.message, b.raised > 1 ? el('div', {className: 'soft'}, `${b.raised} findings`) : null));
}
function shown(b) {
  const words = overview.words.trim().toLowerCase();
  return (!overview.urgencies.size || overview.urgencies.has(b.urgency)) && (!words || `${b.name} ${b.title} ${b.place}`.toLowerCase().includes(words));
}
function filterOverview() {
  let count = 0;
  for (const {building, row} of overview.rows.values()) { row.hidden = !shown(building); count += row.hidden ? 0 : 1; }
  overview.empty.hidden = count > 0;
  overview.empty.textContent = 'No building matches.';
}

// Projects latitude and longitude on a plane. Angles are true in the middle; long distances are not.
function mapPlane(buildings) {
  const middle = (low, high) => 0.5 * (low + high);
  const lat = buildings.map(b => b.latitude), lon = buildings.map(b => b.longitude);
  const c = {lat: middle(Math.min(...lat), Math.max(...lat)), lon: middle(Math.min(...lon), Math.max(...lon))};
  c.cos = Math.max(0.05, Math.cos(c.lat * Math.PI / 180));
  c.x = longitude => (longitude - c.lon) * c.cos;
  c.y = latitude => c.lat - latitude;
  const reach = Math.max(0.01, ...lat.map(v => Math.abs(c.y(v))), ...lon.map(v => Math.abs(c.x(v))));
  c.reach = 1.15 * reach;
  return c;
}
function drawMap() {
  if (!overview.data || !overview.map.isConnected) return;
  const placed = overview.data.buildings.filter(b => b.latitude !== undefined), lacking = overview.data.buildings.length - placed.length;
  overview.mapNote.textContent = placed.length === 0 ? 'No building has a position: framewatch fleet describe NAME --latitude --longitude.' : (lacking ? `${lacking} others have no position. ` : '') + 'Lines: degrees. Wheel or buttons: nearer; drag: move.';
  const box = overview.map.getBoundingClientRect(), width = Math.max(200, box.width), height = Math.max(200, box.height);
  overview.map.setAttribute('viewBox', `${-width / 2} ${-height / 2} ${width} ${height}`);
  if (!placed.length) { overview.map.replaceChildren(); return; }
  const plane = mapPlane(placed), scale = Math.min(width, height) / 2 / plane.reach;
  const v = overview.view || (overview.view = {x: 0, y: 0, zoom: 1}), s = scale * v.zoom;
  const X = longitude => (plane.x(longitude) - v.x) * s, Y = latitude => (plane.y(latitude) - v.y) * s;
  const grid = [], half = {x: width / 2 / s, y: height / 2 / s};
  const ticks = (low, high) => niceTicks(low, high, 4), mark = t => `${+t.toFixed(6)}°`;
  for (const t of ticks(plane.lon + (v.x - half.x) / plane.cos, plane.lon + (v.x + half.x) / plane.cos))
    grid.push(svg('line', {className: 'grid', x1: X(t), x2: X(t), y1: -height / 2, y2: height / 2}), svg('text', {x: X(t) + 3, y: height / 2 - 5}, mark(t)));
  for (const t of ticks(plane.lat - v.y - half.y, plane.lat - v.y + half.y))
    grid.push(svg('line', {className: 'grid', y1: Y(t), y2: Y(t), x1: -width / 2, x2: width / 2}), svg('text', {x: -width / 2 + 4, y: Y(t) - 4}, mark(t)));
  const marks = placed.filter(shown).reverse().map(b => { // the most urgent on top
    const label = `${titleOf(b)}${b.place ? ', ' + b.place : ''}: ${b.urgency}${b.message ? ', ' + b.message : ''}`;
    return svg('a', {href: `#/building/${b.name}`, 'aria-label': label}, svg('g', {className: `sign u-${b.urgency}`, transform: `translate(${X(b.longitude)},${Y(b.latitude)})`}, svg('title', {}, label), shape(b.urgency)));
  });
  const names = placed.length <= 40 ? placed.filter(shown).map(b => svg('text', {x: X(b.longitude) + 11, y: Y(b.latitude) + 4}, titleOf(b))) : [];
  overview.map.replaceChildren(...grid, ...names, ...marks);
  overview.scale = s;
}
function zoomMap(factor) {
  if (!overview.view) return;
  overview.view.zoom = Math.min(2000, Math.max(0.5, overview.view.zoom * factor));
  drawMap();
}
function moveMap(map) {
  let from = null;
  map.addEventListener('wheel', e => { e.preventDefault(); zoomMap(e.deltaY < 0 ? 1.2 : 1 / 1.2); }, {passive: false});
  map.addEventListener('pointerdown', e => { if (!e.target.closest('a')) { from = [e.clientX, e.clientY]; map.setPointerCapture(e.pointerId); } });
  map.addEventListener('pointermove', e => {
    if (!from || !overview.view) return;
    overview.view.x -= (e.clientX - from[0]) / overview.scale;
    overview.view.y -= (e.clientY - from[1]) / overview.scale;
    from = [e.clientX, e.clientY];
    drawMap();
  });
  for (const name of ['pointerup', 'pointercancel']) map.addEventListener(name, () => { from = null; });
}
