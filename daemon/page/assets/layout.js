// SPDX-License-Identifier: MIT
'use strict';
// The browser's storage keeps the layout that people chose: which cards, their order and width, and the choices on them.
const layout = readLayout();
function readLayout() {
  try {
    const l = JSON.parse(localStorage.getItem('layout'));
    return l !== null && typeof l === 'object' ? l : {};
  } catch { return {}; }
}
function saveLayout(change) {
  Object.assign(layout, change);
  try { localStorage.setItem('layout', JSON.stringify(layout)); } catch { /* the browser keeps nothing */ }
}
const idsOf = key => Array.isArray(layout[key]) ? layout[key] : [];
const cards = () => [...document.querySelectorAll('main>section')];
const cardName = card => card.getAttribute('aria-label') || card.querySelector('h2').firstChild.textContent.trim();
const byDefault = cards().map(card => card.id), wideByDefault = cards().filter(card => card.classList.contains('wide')).map(card => card.id);
function applyLayout() {
  const order = [...new Set([...idsOf('order'), ...byDefault])].filter(id => byDefault.includes(id));
  if (order.join() !== cards().map(card => card.id).join()) document.querySelector('main').append(...order.map($));
  const wide = Array.isArray(layout.wide) ? layout.wide : wideByDefault;
  for (const card of cards()) {
    card.classList.toggle('away', idsOf('away').includes(card.id));
    card.classList.toggle('wide', wide.includes(card.id));
  }
}
function changeLayout() {
  const ids = of => cards().filter(of).map(card => card.id);
  saveLayout({order: ids(() => true), away: ids(c => c.classList.contains('away')), wide: ids(c => c.classList.contains('wide'))});
  listCards();
}
function listCards() {
  const focus = document.activeElement && document.activeElement.dataset.does, all = cards();
  $('layout-cards').replaceChildren(...all.map((card, i) => {
    const item = document.createElement('li'), name = cardName(card);
    const tick = (text, is, set) => {
      const label = document.createElement('label'), box = document.createElement('input');
      box.type = 'checkbox'; box.checked = is; box.dataset.does = `${text} ${card.id}`;
      box.onchange = () => { set(box.checked); changeLayout(); };
      label.append(box, ' ' + text);
      return label;
    };
    const move = (text, to) => {
      const b = document.createElement('button');
      b.type = 'button'; b.textContent = text; b.disabled = !all[to]; b.dataset.does = `${text} ${card.id}`;
      b.setAttribute('aria-label', `${name}: ${text}`);
      b.onclick = () => { if (to < i) all[to].before(card); else all[to].after(card); changeLayout(); };
      return b;
    };
    item.append(tick(name, !card.classList.contains('away'), on => card.classList.toggle('away', !on)),
      tick('wide', card.classList.contains('wide'), on => card.classList.toggle('wide', on)), move('Up', i - 1), move('Down', i + 1));
    return item;
  }));
  const again = focus && [...$('layout-cards').querySelectorAll('[data-does]')].find(e => e.dataset.does === focus);
  if (again) again.focus();
}
function startLayout() {
  applyLayout();
  $('layout').onclick = () => { listCards(); $('ask-layout').showModal(); };
  $('layout-reset').onclick = () => {
    for (const key of Object.keys(layout)) delete layout[key];
    saveLayout({});
    location.reload();
  };
}
