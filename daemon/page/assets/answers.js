// SPDX-License-Identifier: MIT
'use strict';
// Shows the four answers and the open findings as the server sends them, without judging.
let told = {answers: [], findings: [], drift: []};
const openFindings = () => told.findings.filter(f => !f.acknowledged);
const findingOf = name => told.findings.find(f => f.kind === 'change' && f.place === name && f.ratio !== null);
const deadChannels = () => new Set(told.findings.filter(f => f.of_channel).map(f => f.place));

function say2(node, text) { if (node.textContent !== text) node.textContent = text; }
function times(line) {
  if (!line.since_us) return '';
  return line.until_us ? ` From ${when(line.since_us)} to ${when(line.until_us)}.` : ` Since ${when(line.since_us)}.`;
}
const full = line => line.text + times(line);
function reportLink(name, text) {
  const link = document.createElement('a');
  link.href = `event-report/${encodeURIComponent(name)}.html`; link.textContent = text; link.target = '_blank'; link.rel = 'noopener';
  return link;
}
function sayLine(node, line) {
  const text = full(line), link = node.querySelector('a');
  if (line.report && link && link.dataset.name === line.report && link.dataset.text === text) return;
  if (!line.report) return say2(node, text);
  const made = reportLink(line.report, 'Read the report');
  Object.assign(made.dataset, {name: line.report, text});
  node.replaceChildren(text + ' ', made);
}
function onAnswers(a) {
  told = window.framewatch.told = a;
  showAnswers();
}
function showAnswers() {
  const list = $('answers');
  if (!told.answers.length) list.replaceChildren();
  while (list.children.length < told.answers.length) {
    const item = document.createElement('li');
    item.append(document.createElement('h2'), document.createElement('p'), document.createElement('ul'));
    list.append(item);
  }
  told.answers.forEach((a, i) => {
    const item = list.children[i], [question, line, more] = item.children;
    item.className = a.state;
    say2(question, a.question);
    sayLine(line, a.line);
    while (more.children.length > a.more.length) more.lastChild.remove();
    while (more.children.length < a.more.length) more.append(document.createElement('li'));
    a.more.forEach((m, k) => sayLine(more.children[k], m));
  });
  showFindings();
  const newest = told.answers.flatMap(a => [a.line, ...a.more]).map(line => line.report).find(Boolean) || '';
  if (newest !== showAnswers.report) { showAnswers.report = newest; loadEventReports(); }
}
// Lists the reports after strong motion; the third answer links the newest.
async function loadEventReports() {
  const answer = await fetch('event-reports.json').catch(() => null);
  const list = answer && answer.ok ? await answer.json() : null, table = $('event-reports');
  $('event-reports-card').hidden = list === null; // none are written
  table.replaceChildren();
  $('no-event-reports').hidden = list === null || list.length > 0;
  if (!list || !list.length) return;
  heads(table, ['strong motion from', 'to', 'judged', 'placard', 'because', '']);
  const body = table.createTBody();
  for (const r of list) {
    const row = body.insertRow();
    cell(row, when(r.start_us)); cell(row, when(r.end_us)); cell(row, r.verdict, 'verdict ' + r.verdict);
    cell(row, r.placard || '-', 'text'); cell(row, r.reason, 'text');
    row.insertCell().append(reportLink(r.name, 'report'));
  }
}
function acknowledgeButton(ids, what) {
  const b = document.createElement('button');
  b.textContent = ids.length > 1 ? `Acknowledge all ${ids.length}` : 'Acknowledge';
  b.setAttribute('aria-label', `${b.textContent}: ${what}`);
  b.onclick = async () => { for (const id of ids) await post('acknowledge?id=' + id); };
  return b;
}
// Groups findings of one cause in one line, as when a switch that loses power stops many sensors.
function grouped(findings) {
  const groups = new Map();
  for (const f of findings) {
    const key = f.kind === 'service' ? f.advice : 'finding ' + f.id;
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(f);
  }
  return [...groups.values()];
}
let announced = new Set(), listed = '';
function showFindings() {
  const open = openFindings(), text = JSON.stringify([open, zone]);
  if (text === listed) return;
  listed = text;
  $('no-findings').hidden = open.length > 0;
  const fresh = open.filter(f => !announced.has(f.id));
  announced = new Set(open.map(f => f.id));
  if (fresh.length) say2($('alert'), fresh.map(f => f.text).join(' '));
  const focused = document.activeElement && document.activeElement.dataset ? document.activeElement.dataset.id : undefined;
  $('findings').replaceChildren(...grouped(open).map(group => {
    const f = group[0];
    const item = document.createElement('li'), what = document.createElement('span'), since = document.createElement('span');
    item.className = f.severity > 1 ? 'bad' : 'look';
    what.textContent = f.text[0].toUpperCase() + f.text.slice(1) + (group.length > 1 ? ` (and ${group.length - 1} more like it)` : '');
    since.className = 'soft';
    since.textContent = 'since ' + when(f.since_us);
    item.append(what, since);
    if (f.id) { const b = acknowledgeButton(group.map(g => g.id), f.text); b.dataset.id = f.id; item.append(b); }
    return item;
  }));
  const again = focused && document.querySelector(`#findings button[data-id="${focused}"]`);
  if (again) again.focus();
}
