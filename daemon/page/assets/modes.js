// SPDX-License-Identifier: MIT
'use strict';
// The natural modes of the identified building: their list, and the shape of the chosen one on the picture.
const kShape_hz = 0.7; // of the moving shape, whatever the mode's frequency
let modes = {modes: []};
const shape = {mode: -1, phase: 0, moves: true, drawn: 0};
function onModes(m) {
  modes = window.framewatch.modes = m;
  if (!m.modes[shape.mode]) shape.mode = -1;
  showModes();
}
function showModes() {
  const table = $('modes'), body = table.tBodies[0], chosen = modes.modes[shape.mode];
  table.hidden = !modes.modes.length;
  while (body.rows.length > modes.modes.length) body.lastChild.remove();
  modes.modes.forEach((m, i) => {
    const row = body.rows[i] || body.insertRow();
    if (!row.cells.length) {
      for (let k = 0; k < 4; k++) cell(row, '');
      const b = document.createElement('button');
      b.textContent = 'Shape'; b.setAttribute('aria-label', `Shape of mode ${i + 1}`);
      b.onclick = () => showShape(shape.mode === i ? -1 : i);
      row.insertCell().append(b);
    }
    const texts = [i + 1, withError(m.hz, m.hz_error, 'Hz'), m.ratio === null ? '-' : withError(100 * m.ratio, 100 * m.ratio_error, '%'), m.motion];
    texts.forEach((t, k) => say2(row.cells[k], String(t)));
    row.querySelector('button').setAttribute('aria-pressed', shape.mode === i);
  });
  const old = modes.modes.length && newestUs() - modes.oldest_us > 2e6 ? `Of last values, the oldest of ${when(modes.oldest_us)}.` : '';
  say2($('modes-note'), [modes.why && `None: ${modes.why}.`, modes.modes.length && modes.why_no_damping && `No damping: ${modes.why_no_damping}.`, old].filter(Boolean).join(' '));
  $('shape').hidden = !chosen;
  if (chosen) say2($('shape-name'), `The picture shows mode ${shape.mode + 1}, ${digits(chosen.hz, 4)} Hz, ${shape.moves ? `slowed to ${kShape_hz} Hz` : 'standing'}.`);
  say2($('shape-moves'), shape.moves ? 'Pause' : 'Move');
}
function showShape(mode) {
  Object.assign(shape, {mode, phase: 0, moves: !matchMedia('(prefers-reduced-motion: reduce)').matches});
  showModes();
}
// Returns the displacements of the shape by degree of freedom, at most 1; null: the measured motion is shown.
function shapeAt(now) {
  const m = modes.modes[shape.mode];
  if (shape.moves) shape.phase += 2 * Math.PI * kShape_hz * Math.min(0.1, (now - shape.drawn) / 1e3);
  shape.drawn = now;
  return m ? m.re.map((v, i) => v * Math.cos(shape.phase) - m.im[i] * Math.sin(shape.phase)) : null;
}
function startModes() {
  $('shape-moves').onclick = () => { shape.moves = !shape.moves; showModes(); };
  $('shape-end').onclick = () => showShape(-1);
}
