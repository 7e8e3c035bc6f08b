// SPDX-License-Identifier: MIT
'use strict';
// Records a session and plays it on the page: slider, pause and speed must show what was recorded; signals and layout
// survive a reload; sessions that are empty, cut off or of another building are refused in words. The page is gray
// until it has a baseline, and cuts nothing off at 390, 1400 and 2560 px and on paper.
const {chromium} = require('playwright-core');
const {execFileSync} = require('child_process');
const fs = require('fs'), os = require('os'), path = require('path');
const {kPatience, expect, start, pause, until, addressOf, run} = require('./common.js');

const [program, browserPath, configs] = process.argv.slice(2);
// Limits.
const kRecorded_s = 30, kDrop_s = 14, kSpeedError = 0.25, kSeek_ms = 250, kPaper_px = 718, kVisible_px = 15, kStands_px = 2; // new values change a shape a little

const said = [];
const scrub = async (page, t_s) => {
  await page.evaluate(t => { const at = document.getElementById('p-at'); at.value = t; at.dispatchEvent(new Event('input')); }, t_s);
  await page.waitForFunction(t => playback.sought === null && Math.abs(playback.at - t) < 0.06, t_s, kPatience);
};

async function gray(page) {
  await until(page, 'gray: values come before a baseline', () => building.ratio.filter(r => r !== undefined).length > 8 && !baselineKnown());
  const [ratios, states, damping] = await page.evaluate(() => [building.ratio.filter(r => r !== undefined), [...document.querySelectorAll('#answers>li')].map(li => li.className),
    boxPlots[2].index.map(i => [boxPlots[2].shape(i, false).reference, reference(i)])]);
  expect(ratios.length > 8 && ratios.every(r => r === 1), 'gray: no element has a color before it has a baseline');
  expect(states[0] === 'wait' && states[3] === 'wait', `gray: what is not judged is gray: ${states}`);
  expect(damping.flat().every(r => r === null), 'damping is compared with no design');
  await page.screenshot({path: 'session-gray.png', fullPage: true});
}

// The shape of a mode moves on the picture as long as people let it.
async function shapes(page, where) {
  await until(page, `${where}: modes are listed`, () => framewatch.modes && framewatch.modes.modes.length === 8);
  const rows = await page.locator('#modes tbody tr').allInnerTexts();
  expect(rows.length === 8 && rows.every(r => /\d ± \d[\d.]* Hz/.test(r) && /\d ± \d[\d.]* %/.test(r)), `${where}: each with its errors: ${rows[0].replace(/\s+/g, ' ')}`);
  const button = page.getByRole('button', {name: 'Shape of mode 2'});
  // The way of the roof's corner on the screen, and the shape's largest entry.
  const moved = () => page.evaluate(async () => {
    const seen = [];
    for (let i = 0; i < 100; i++) { await new Promise(requestAnimationFrame); seen.push([...building.at(0, 0, plan.stories).slice(0, 2), Math.max(...building.shape.map(Math.abs))]); }
    const range = k => Math.max(...seen.map(s => s[k])) - Math.min(...seen.map(s => s[k]));
    return {way_px: Math.hypot(range(0), range(1)), largest: Math.max(...seen.map(s => s[2]))};
  });
  await button.click();
  const moving = await moved();
  expect(moving.way_px > kVisible_px && moving.largest > 0.9 && moving.largest < 1.01, `${where}: the shape moves ${moving.way_px.toFixed(0)} px`);
  expect(await button.getAttribute('aria-pressed') === 'true' && /mode 2, [\d.]+ Hz, slowed/.test(await page.textContent('#shape')), `${where}: the page says which`);
  await page.locator('#building-card').screenshot({path: `session-shape-${where}.png`});
  await page.click('#shape-moves');
  expect((await moved()).way_px < kStands_px && await page.textContent('#shape-moves') === 'Move', `${where}: a pause stands still`);
  await page.click('#shape-end');
  await until(page, `${where}: back to the measured motion`, () => building.shape === null && document.getElementById('shape').offsetParent === null);
  await page.emulateMedia({reducedMotion: 'reduce'});
  await button.click();
  const still = await moved();
  expect(still.way_px < kStands_px && still.largest > 0.99, `${where}: with reduced motion it stands deformed`);
  await page.click('#shape-moves');
  expect((await moved()).way_px > kVisible_px, `${where}: and moves if asked`);
  await button.click();
  await page.emulateMedia({reducedMotion: 'no-preference'});
}

async function complete(page) {
  await page.click('#values summary');
  const cut = () => page.evaluate(() => [...document.querySelectorAll('.card,.across,.scroll,.strip,#g-plot,h2,p,li')].filter(e => e.offsetParent && e.scrollWidth > e.clientWidth + 1).map(e => e.id || e.firstElementChild && e.firstElementChild.id || e.className));
  for (const width of [390, 900, 1400, 2560]) {
    await page.setViewportSize({width, height: 1000});
    await pause(1200);
    for (const scheme of ['light', 'dark']) {
      await page.evaluate(name => useTheme(name), scheme);
      await pause(300);
      await page.screenshot({path: `session-${width}-${scheme}.png`, fullPage: true});
    }
    const found = await cut();
    expect(found.length === 0 && await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `complete at ${width} px ${found}`);
    if (width > 390) continue;
    expect(await page.evaluate(() => getComputedStyle(document.querySelector('#value-table td:nth-child(2)'), '::before').content.includes('value')), 'narrow tables name each value');
  }
  await page.setViewportSize({width: kPaper_px, height: 1000});
  await page.emulateMedia({media: 'print'});
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  await pause(300);
  const found = await cut();
  expect(found.length === 0 && await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth && Math.abs(document.getElementById('box-k').clientWidth * devicePixelRatio - document.getElementById('box-k').width) < 2), `complete on paper, not squeezed ${found}`);
  await page.pdf({path: 'session.pdf', format: 'A4', margin: {top: '10mm', bottom: '10mm', left: '10mm', right: '10mm'}});
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  await page.emulateMedia({media: 'screen'});
  await page.setViewportSize({width: 1400, height: 1350});
  await page.click('#values summary');
}

async function plays(page, folder) {
  await page.click('#sessions button');
  await until(page, 'the session is loaded', () => window.framewatch.playback && framewatch.playback.done);
  expect(await page.textContent('#state') === 'a recorded session' && await page.textContent('#p-name') === 'scrubbed', 'the page says that it is a recording');
  const length_s = await page.evaluate(() => playback.loaded);
  expect(Math.abs(length_s - kRecorded_s) < 3, `${length_s} s of ${kRecorded_s} s can be played`);
  expect(await page.isHidden('#baseline'), 'a recording takes no commands');
  await page.click('#p-play');
  const at = await page.evaluate(() => playback.at);
  await pause(500);
  expect(at > 0 && await page.evaluate(() => playback.at) === at && await page.textContent('#p-play') === 'Play', 'a pause stands still');
  // Scrubbing shows what was estimated at that time.
  const csv = path.join(folder, 'estimates.csv');
  execFileSync(program, ['convert', path.join(folder, 'estimates.lcmlog'), '--channel', 'FRAMEWATCH_ESTIMATE', csv]);
  const lines = fs.readFileSync(csv, 'utf8').trim().split('\n').map(l => l.split(',')), column = lines[0].indexOf('kx_1_y2');
  const logged = new Map(lines.slice(1).map(l => [Math.round(1e6 * l[0]), Number(l[column])]));
  const seen = [];
  for (const t of [12, 25, 12]) {
    await scrub(page, t);
    seen.push(await page.evaluate(() => ({us: estimate.end_us, value: estimate.value[1], row: lastRow, accel: Array.from(strips.accel.ring.view()[1]), ring: strips.k.ring.n,
      open: told.findings.length, alarms: document.getElementById('alarms').innerText, answer: document.getElementById('answers').innerText, ratio: building.ratio[1]})));
  }
  expect(seen.every(s => logged.get(s.us) === s.value), `the value at each time is the one of the log: ${seen.map(s => s.value)}`);
  expect(Math.abs(seen[1].row - seen[0].row - 13e6) < 2e5, '13 s of the slider are 13 s of the sensors');
  const differ = Object.keys(seen[0]).filter(k => JSON.stringify(seen[0][k]) !== JSON.stringify(seen[2][k]));
  expect(differ.length === 0, `there and back shows the same ${differ}`);
  expect(seen[0].accel.length > 900 && seen[0].accel.every(v => v !== null), 'the strips have the 10 s before');
  expect(seen[0].open === 0 && /No\. None of/.test(seen[0].answer) && seen[1].open === 1 && /Yes\. Story 1, north wall \(kx_1_y2\) has lost/.test(seen[1].answer) && Math.abs(seen[1].ratio - 0.85) < 0.02, 'answers and colors are those of the time');
  await shapes(page, 'recorded');
  expect(seen[1].alarms.includes('story 1, north wall') && await page.evaluate(() => called(plan.parameters[1]) === 'story 1, north wall' && called(plan.parameters[4]) === 'ky_1_x1'), 'frames have the labels that people gave');
  const ms = await page.evaluate(() => { const from = performance.now(); playback.seek(25); return performance.now() - from; });
  expect(ms < kSeek_ms, `a jump takes ${ms.toFixed(0)} ms`);
  await scrub(page, 2);
  await page.selectOption('#p-speed', '5');
  await page.click('#p-play');
  await pause(500);
  const [from, then] = await page.evaluate(() => [playback.at, performance.now()]);
  await pause(3000);
  const [to, now] = await page.evaluate(() => [playback.at, performance.now()]);
  const speed = 1e3 * (to - from) / (now - then);
  expect(Math.abs(speed / 5 - 1) < kSpeedError, `speed 5 is ${speed.toFixed(2)}`);
  await page.focus('#p-at');
  await page.click('#p-play');
  await page.focus('#p-at');
  const before = await page.evaluate(() => playback.at);
  await page.keyboard.press('ArrowLeft');
  await pause(300);
  expect(await page.evaluate(() => playback.at) < before, 'arrow keys move the slider');
}

async function arranged(page) {
  for (const id of ['a:F2-Y1', 'd:kx_1_y2', 'p:kx_1_y2', 'residual']) await page.selectOption('#g-add', id);
  await scrub(page, 25);
  await pause(500);
  const drawn = () => page.evaluate(() => signals.plot.data.slice(1).map(d => (signals.over ? d[1] : d).filter(v => v !== null && v !== undefined).length));
  expect((await drawn()).every((n, i) => n > (i < 2 ? 900 : 30)), `four signals over time: ${await drawn()} values`);
  await page.locator('#signals-card').screenshot({path: 'session-signals.png'});
  await page.selectOption('#g-over', 'd:kx_1_y1');
  await pause(500);
  const paired = await page.evaluate(() => { const [xs, ys] = signals.plot.data[1]; return xs.filter((x, i) => x !== null && ys[i] !== null).length; });
  expect(paired > 900, `an acceleration over a drift: ${paired} pairs`);
  await page.locator('#signals-card').screenshot({path: 'session-over.png'});
  await page.click('#layout');
  await page.locator('#layout-cards li').filter({hasText: 'Health'}).getByRole('checkbox').first().uncheck();
  await page.locator('#layout-cards li').filter({hasText: 'Signals'}).getByRole('button', {name: 'Up'}).click();
  await page.screenshot({path: 'session-layout.png'});
  await page.keyboard.press('Escape');
  await page.reload();
  await until(page, 'reloaded: the session is loaded again', () => window.framewatch.playback && framewatch.playback.done);
  const kept = await page.evaluate(() => [signals.chosen.map(s => s.id).join(), signals.over.id, document.getElementById('health-card').offsetParent === null, cards().findIndex(c => c.id === 'signals-card') < cards().findIndex(c => c.id === 'strips-card')]);
  expect(kept[0] === 'a:F2-Y1,d:kx_1_y2,p:kx_1_y2,residual' && kept[1] === 'd:kx_1_y1' && kept[2] && kept[3], `reloaded: signals and layout are kept ${kept}`);
  for (const bad of ['{', 'null', '[]', '{"order":7,"away":"x","wide":[1],"signals":["a:gone",3],"over":{},"span":"never","element":5}']) {
    await page.evaluate(text => localStorage.setItem('layout', text), bad);
    await page.reload();
    await until(page, `a stored layout ${bad} does not harm`, () => window.framewatch.playback && framewatch.playback.done && cards().length === 10 && cards().every(c => c.hidden || c.offsetParent));
  }
  await page.click('#p-live');
  await until(page, 'back to live', () => !location.hash && document.getElementById('state').textContent.startsWith('live') && document.getElementById('playback').hidden);
}

async function refuses(page, sessions, name) {
  const copy = (to, change) => {
    const folder = path.join(sessions, to);
    fs.cpSync(path.join(sessions, name), folder, {recursive: true});
    change(folder);
  };
  const edit = (folder, change) => { const file = path.join(folder, 'session.json'), json = JSON.parse(fs.readFileSync(file)); change(json); fs.writeFileSync(file, JSON.stringify(json).replaceAll('F2-Y1', 'roof')); };
  copy('empty', f => fs.truncateSync(path.join(f, 'raw.lcmlog'), 0));
  copy('cut', f => fs.truncateSync(path.join(f, 'raw.lcmlog'), Math.floor(fs.statSync(path.join(f, 'raw.lcmlog')).size / 2) + 5));
  copy('other', f => edit(f, json => { json.configuration.sha256 = 'x'; }));
  const address = new URL('/', page.url()).href;
  const news = async session => {
    await page.goto('about:blank');
    await page.goto(address + '#session=' + session);
    await page.waitForFunction(() => document.getElementById('p-news').textContent !== '', null, kPatience).catch(() => {});
    return page.textContent('#p-news');
  };
  for (const [session, words] of [['empty', /holds no samples/], ['cut', /Damaged: raw\.lcmlog: byte \d+: the recording is cut off/], ['other', /another building: of its channels, this page lacks roof; .* lacks F2-Y1\. Open it with/], ['missing', /no such session/]]) {
    const text = await news(session);
    expect(words.test(text), `${session}: ${text}`);
  }
  expect(await page.evaluate(() => fetch('session/cut/playback').then(r => r.headers.get('content-security-policy'))).then(p => p.includes("script-src 'self'")), 'the policy is the page\'s');
}

async function main() {
  const work = fs.mkdtempSync(path.join(os.tmpdir(), 'framewatch-session-'));
  process.env.XDG_RUNTIME_DIR = work; // where commands go
  const url = `udpm://239.255.76.67:${8800 + process.pid % 1000}?ttl=0`;
  const config = path.join(work, 'building.toml'), scenario = path.join(work, 'scenario.toml'), sessions = path.join(work, 'sessions');
  fs.writeFileSync(config, fs.readFileSync(path.join(configs, 'table_two_story.toml'), 'utf8').replace('frames_y', 'labels_x = ["south wall", "north wall"]\nframes_y'));
  fs.writeFileSync(scenario, fs.readFileSync(path.join(configs, 'scenario_table_two_story.toml'), 'utf8')
    .replace('"table_two_story.toml"', JSON.stringify(config)) + `\n[[change]]\nat_s = ${kDrop_s}.0\nparameter = "kx_1_y2"\nfactor = 0.85\n`);
  start(program, 'run', config, '--url', url, '--quiet');
  const recorder = start(program, 'record', config, '--url', url, '--quiet', '--out', sessions, '--seconds', String(kRecorded_s), '--test', 'scrubbed', '--no-check');
  const serve = start(program, 'serve', config, '--url', url, '--port', '0', '--sessions', sessions, '--quiet');
  const address = await addressOf(serve);
  const browser = await chromium.launch({executablePath: browserPath, args: ['--no-sandbox']});
  const page = await browser.newPage({viewport: {width: 1400, height: 1350}});
  page.on('console', m => { if (!/409 \(Conflict\)/.test(m.text())) said.push(m.text()); });
  page.on('pageerror', e => said.push(e.stack));
  await page.goto(address);
  start(program, 'simulate', scenario, '--lcm', url, '--seconds', '900', '--quiet');
  await gray(page);
  await shapes(page, 'live');
  await recorder.ended;
  await complete(page);
  await page.reload();
  await page.waitForSelector('#sessions button', kPatience);
  const name = fs.readdirSync(sessions).find(n => fs.existsSync(path.join(sessions, n, 'session.json')));
  await plays(page, path.join(sessions, name));
  await arranged(page);
  await refuses(page, sessions, name);
  expect(said.length === 0, 'nothing on the console ' + said.join('; '));
  await browser.close();
  fs.rmSync(work, {recursive: true, force: true});
}

run('session', main);
