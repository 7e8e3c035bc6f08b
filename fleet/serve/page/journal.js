// SPDX-License-Identifier: MIT
'use strict';
// The journal: commands to buildings and their answers.
function openJournal(main) {
  const box = el('div', {className: 'list plain cards'});
  main.replaceChildren(wide('Journal', el('p', {className: 'soft'}, 'The newest 200 commands given from this page. Each building has a journal too.'), box));
  return async () => { box.replaceChildren(journalTable(await ask('journal.json'), true)); };
}
function contentText(verb, c) {
  if (verb === 'acknowledge') return `event ${c.id}${c.comment ? ': ' + c.comment : ''}`;
  return c.from_us === undefined ? '' : `${when(c.from_us)} to ${when(c.to_us)}${c.channels ? ', ' + c.channels.join(', ') : ''}`;
}
function answerText(a, came_us) {
  if (a.done === true) return 'done';
  if (a.done === false) return a.answer;
  return Date.now() * 1e3 - came_us < 30e6 ? 'waiting for an answer' : 'unknown: the page stopped before the answer came';
}
function journalTable(list, withBuilding) {
  if (!list.length) return el('p', {className: 'soft'}, 'No commands yet.');
  return table(['time', 'who', 'command', withBuilding ? 'buildings' : '', 'answer'], list.map(j => {
    const few = j.answers.slice(0, 3).map(a => el('div', {}, (j.buildings > 1 && withBuilding ? a.building + ': ' : '') + answerText(a, j.came_us)));
    const rest = j.answers.slice(3).map(a => el('div', {}, `${a.building}: ${answerText(a, j.came_us)}`));
    return el('tr', {}, cell(null, when(j.came_us)), cell('who', j.who), cell(null, el('b', {}, j.verb), el('div', {className: 'soft'}, contentText(j.verb, j.content))),
      cell(null, withBuilding ? (j.buildings === 1 && j.answers[0] ? el('a', {href: `#/building/${j.answers[0].building}`}, j.answers[0].building) : `${j.buildings}`) : ''),
      cell('answer', j.buildings > 1 && withBuilding ? el('div', {className: 'soft'}, `${j.done} done, ${j.refused} not, ${j.waiting} waiting`) : null, few, rest.length ? el('details', {}, el('summary', {}, `${rest.length} more`), rest) : null));
  }));
}
