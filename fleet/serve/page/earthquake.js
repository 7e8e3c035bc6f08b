// SPDX-License-Identifier: MIT
'use strict';
// Before and after an earthquake: every building, the largest significant loss first.
const quake = {time_us: null, data: null};
const kResults = {loss: 'loss', none: 'no significant loss', not_observable: 'not observable', nothing: 'no data'};

function openEarthquake(main, time) {
  quake.list = el('div', {id: 'quakes', className: 'list plain'});
  quake.time = el('input', {type: 'datetime-local', step: 1, id: 'q-time', value: formTime(time ? +time : Date.now() * 1e3)});
  quake.result = wide('Before and after');
  const go = () => { const us = timeOfForm(quake.time.value); if (Number.isFinite(us)) location.hash = `#/earthquake/${us}`; };
  const minutes = () => { const us = timeOfForm(quake.time.value); if (Number.isFinite(us)) command('all', {verb: 'minutes', from_us: us - 600e6, to_us: us + 3600e6}); };
  main.replaceChildren(
    wide('Earthquakes', quake.list, el('p', {className: 'soft note'}, 'Times at which shaking or softening began in at least three buildings within a minute.'),
      el('div', {className: 'form'}, el('label', {}, `another time${zoneText()}`, quake.time), el('button', {onclick: go}, 'Compare'),
        me.commands ? el('button', {onclick: minutes, title: 'Request minute summaries from every building, from 10 min before to 60 min after'}, 'Request minutes from every building') : null)),
    quake.result);
  quake.time_us = time ? +time : null;
  quake.data = null;
  if (!time) quake.result.replaceChildren(el('h2', {}, 'Before and after'), el('p', {className: 'soft'}, 'Choose an earthquake or a time.'));
  else quake.result.replaceChildren(el('h2', {}, 'Before and after'), el('p', {className: 'soft'}, 'comparing'));
  let rounds = 0;
  return async () => {
    if (rounds++ % 10) return;
    const list = await ask('earthquakes.json', {days: 366});
    quake.list.replaceChildren(list.length ? table(['time', '#buildings', ''], list.map(q => el('tr', {}, el('td', {}, el('a', {href: `#/earthquake/${q.time_us}`}, when(q.time_us))), numbers('', String(q.buildings)), cell(null, q.time_us === quake.time_us ? 'shown below' : '')))) : el('p', {className: 'soft'}, 'None within a year.'));
    if (quake.time_us === null) return;
    const data = await ask('earthquake.json', {time_us: quake.time_us}), same = JSON.stringify(data);
    if (same === quake.same) return;
    quake.same = same;
    quake.data = data;
    drawEarthquake();
  };
}

function drawEarthquake() {
  const d = quake.data, counts = Object.fromEntries(Object.keys(kResults).map(k => [k, d.buildings.filter(b => b.result === k).length]));
  const most = Math.max(0.01, ...d.buildings.map(b => b.worst ? -b.worst.ratio : 0));
  quake.result.replaceChildren(
    el('h2', {}, `Before and after ${when(d.time_us)}`),
    el('p', {}, el('span', {className: counts.loss ? 'loss' : ''}, `${counts.loss} of ${d.buildings.length} buildings have lost stiffness`), `, ${counts.none} show no significant loss, of ${counts.not_observable} nothing could be compared, of ${counts.nothing} nothing of the time is known.`),
    el('p', {className: 'soft'}, `${d.compared} stiffnesses are compared: the median of whole periods before, and of those from 2 min after. A loss counts when it is above ${d.times_error.toFixed(1)} standard errors: among so many, chance alone gives one in twenty such tables.`),
    el('div', {className: 'list plain cards'}, table(['building', 'result', 'largest loss', '#before', '#after', '#compared', 'not observable'], d.buildings.map(b => earthquakeRow(b, most)))));
}
function bar(ratio, most, is) {
  const b = el('span', {className: is ? 'bar' : 'bar minor', 'aria-hidden': 'true'});
  b.style.width = `${Math.max(1, 90 * Math.max(0, -ratio) / most)}px`;
  return b;
}
function earthquakeRow(b, most) {
  const w = b.worst, loss = b.result === 'loss';
  const row = el('tr', {className: loss ? 'loss-row' : ''},
    el('td', {className: 'name'}, el('a', {href: `#/building/${b.name}`}, b.title || b.name), el('div', {className: 'soft'}, [b.title ? b.name : '', b.place].filter(Boolean).join(', '))),
    cell(null, loss ? el('span', {className: 'loss'}, `${b.losses} ${b.losses === 1 ? 'loss' : 'losses'}`) : kResults[b.result], b.period_s ? el('div', {className: 'soft'}, `${b.before} + ${b.after} periods of ${span(b.period_s)}`) : null),
    w ? cell(null, bar(w.ratio, most, loss), ' ', el('span', {className: loss ? 'loss' : ''}, percentOf(w.ratio, w.std_error)), el('div', {className: 'soft'}, `${w.parameter}, ${placeOf(w.parameter)}`)) : cell(null),
    numbers('before', w ? plain(w.before, w.unit) : ''), numbers('after', w ? plain(w.after, w.unit) : ''), numbers('compared', String(b.compared)),
    cell('not observable', b.not_observable.length ? el('details', {}, el('summary', {}, String(b.not_observable.length)), el('p', {className: 'soft'}, b.not_observable.join(', '))) : b.period_s ? 'none' : 'everything'));
  return row;
}
