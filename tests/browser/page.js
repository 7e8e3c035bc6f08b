// SPDX-License-Identifier: MIT
'use strict';
// Runs `framewatch serve` beside `framewatch run`, `framewatch record` and a virtual test over
// LCM. The page must show the messages of LCM, name a drop of stiffness in time, record a session,
// open its report, and report silence.
const {chromium} = require('playwright-core');
const {execFileSync} = require('child_process');
const fs = require('fs'), os = require('os'), path = require('path');
const {kPatience, expect, start, pause, addressOf, run} = require('./common.js');

const [program, browserPath, configs] = process.argv.slice(2);
// Limits.
const kDrop_s = 20, kTold_s = 5, kDrop_ratio = -0.15, kDropError = 0.02;
const kMinFrames = 20, kMaxLatency_ms = 150; // frames/s on a busy machine; 50 on a quiet one
const kCompared = 200, kRecorded_s = 6, kReported_s = 15;


// A session from the page: the channels are checked, it starts, ends after its length, has a report.
async function record(page) {
  await page.waitForFunction(() => framewatch.session && framewatch.session.channels.length === 10);
  await page.fill('#s-test', 'browser <test>');
  await page.fill('#s-operator', '<img src=x onerror="window.owned = 1">');
  await page.fill('#s-length_s', String(kRecorded_s));
  await page.click('[data-verb=start]');
  await page.waitForFunction(() => framewatch.session.state === 3, null, kPatience);
  await pause(3000);
  await page.locator('#session-card').screenshot({path: 'session-recording.png'});
  const told = await page.evaluate(async () => (await fetch('session?verb=start', {method: 'POST'})).text());
  await page.waitForFunction(id => framewatch.session.answered === id.trim() && framewatch.session.refused !== '', told, kPatience);
  expect(true, 'a second start is refused while it records');
  await page.waitForSelector('#sessions a', {timeout: 1000 * (30 + kRecorded_s + kReported_s)});
  const session = await page.evaluate(() => framewatch.session);
  expect(await page.evaluate(() => window.owned === undefined) && (await page.textContent('#sessions')).includes('onerror'), 'what an operator writes is text');
  expect(session.state === 0 && session.messages >= 1000 * kRecorded_s && session.estimates >= 90 * kRecorded_s && session.lost === 0 && session.dropped === 0,
    `a session of ${kRecorded_s} s: ${session.messages} messages, ${session.estimates} estimates, none lost`);
  const [report] = await Promise.all([page.context().waitForEvent('page'), page.click('#sessions a')]);
  await report.waitForLoadState();
  expect((await report.textContent('h1')) === 'browser <test>' && await report.locator('svg').count() > 10, 'its report opens');
  await report.setViewportSize({width: 1100, height: 1400});
  await report.screenshot({path: 'report.png'});
  await report.close();
  await page.locator('#session-card').screenshot({path: 'session-done.png'});
  const socket = path.join(process.env.XDG_RUNTIME_DIR, 'framewatch', 'FRAMEWATCH_record');
  fs.renameSync(socket, socket + '.away');
  await page.click('[data-verb=tap]');
  const refused = await page.waitForFunction(() => /^Refused: no framewatch record takes commands here/.test(document.getElementById('tip').textContent), null, kPatience).catch(() => null);
  expect(refused !== null && await page.evaluate(() => framewatch.session.state) === 0, 'a command that reaches no recorder is said to be refused');
  fs.renameSync(socket + '.away', socket);
  const status = async (at, method) => (await fetch(new URL(at, page.url()), {method})).status;
  expect(await status('session?verb=stop', 'GET') === 404 && await status('session?verb=stop', 'POST') === 403, 'session verbs need POST and the token');
  expect(await status('session/%2e%2e/%2e%2e/report.html', 'GET') === 404 && await status('session/x/raw.lcmlog', 'GET') === 404, 'nothing but reports is served from the folder');
}

async function main() {
  const work = fs.mkdtempSync(path.join(os.tmpdir(), 'framewatch-browser-'));
  process.env.XDG_RUNTIME_DIR = work; // where commands go
  const url = `udpm://239.255.76.67:${7800 + process.pid % 1000}?ttl=0`;
  const config = path.join(configs, 'table_two_story.toml'), scenario = path.join(work, 'scenario.toml');
  fs.writeFileSync(scenario, fs.readFileSync(path.join(configs, 'scenario_table_two_story.toml'), 'utf8')
    .replace('"table_two_story.toml"', JSON.stringify(fs.realpathSync(config))) +
    `\n[[change]]\nat_s = ${kDrop_s}.0\nparameter = "kx_1_y2"\nfactor = ${1 + kDrop_ratio}\n`);
  const log = path.join(work, 'estimates.lcmlog');
  const logger = start('lcm-logger', '--lcm-url', url, '--channel', 'FRAMEWATCH_(ESTIMATE|PARAMETERS)', '--quiet', log);
  start(program, 'run', config, '--url', url, '--quiet');
  const sessions = path.join(work, 'sessions');
  const recorder = start(program, 'record', config, '--url', url, '--standby', '--quiet', '--out', sessions);
  const serve = start(program, 'serve', config, '--url', url, '--port', '0', '--sessions', sessions, '--quiet');
  const address = await addressOf(serve);

  const browser = await chromium.launch({executablePath: browserPath, args: ['--no-sandbox']});
  const page = await browser.newPage({viewport: {width: 1400, height: 1350}});
  const said = [];
  page.on('console', m => said.push(m.text()));
  page.on('pageerror', e => said.push(e.message));
  await page.addInitScript(() => { window.seen = []; });
  await page.goto(address);
  expect(!page.url().includes('token'), 'the token leaves the address');
  await page.waitForFunction(() => document.getElementById('state').textContent === 'waiting for samples');
  await page.evaluate(() => setInterval(() => {
    const e = window.framewatch.estimate;
    if (e && (!window.seen.length || window.seen.at(-1).end_us !== e.end_us)) window.seen.push(e);
  }, 20));
  const simulation = start(program, 'simulate', scenario, '--lcm', url, '--seconds', '50', '--quiet');

  await page.waitForFunction(() => window.framewatch.motion);
  const first_us = await page.evaluate(() => window.framewatch.motion.first_us);
  await pause(15000);
  await page.screenshot({path: 'page-light.png'});
  const live = await page.evaluate(() => ({state: document.getElementById('state').textContent, rows: framewatch.rows, lost: framewatch.lost, fps: framewatch.fps(), dropped: framewatch.dropped,
    latency: [...framewatch.latency].sort((a, b) => a - b)[framewatch.latency.length >> 1]}));
  console.log(JSON.stringify(live));
  expect(live.state === 'live', 'says that it is live');
  expect(live.rows > 1400 && live.lost === 0 && live.dropped === 0, '100 rows a second, none lost');
  expect(live.fps >= kMinFrames, `at least ${kMinFrames} frames/s`);
  expect(live.latency < kMaxLatency_ms, `sample to screen under ${kMaxLatency_ms} ms in the median`);

  await page.waitForFunction(() => framewatch.alarms.size > 0, null, {timeout: 60000}).catch(() => {});
  const alarm = await page.evaluate(() => [...framewatch.alarms.values()][0]);
  console.log(JSON.stringify(alarm));
  // The size comes with the windows that lie behind the change.
  const sized = await page.waitForFunction(() => { const a = [...window.framewatch.alarms.values()][0]; return a && a.value !== null && a; }, null, kPatience).then(h => h.jsonValue()).catch(() => null);
  expect(alarm && alarm.place === 'kx_1_y2' && sized && Math.abs(sized.value - kDrop_ratio) < kDropError, 'the frame that dropped is named, and by how much');
  expect(alarm && alarm.time_us - first_us < 1e6 * (kDrop_s + kTold_s), `within ${kTold_s} s`);
  await pause(5000);
  expect(await page.evaluate(() => framewatch.alarms.size) === 1, 'no other alarm');
  await record(page);
  await page.click('#theme');
  await pause(500);
  await page.screenshot({path: 'page-dark.png'});
  await page.setViewportSize({width: 390, height: 844});
  await pause(800);
  await page.screenshot({path: 'page-phone.png', fullPage: true});
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'a phone need not scroll sideways');
  await page.focus('#building');
  const before = await page.inputValue('#element');
  await page.keyboard.press('ArrowRight');
  expect(await page.inputValue('#element') !== before, 'arrow keys choose an element');
  await page.click('#findings button');
  await page.waitForFunction(() => document.querySelectorAll('#findings button').length === 0, null, kPatience);
  expect((await page.textContent('#alarms')).includes('acknowledged'), 'an alarm is acknowledged');

  await simulation.ended;
  await page.waitForFunction(() => document.getElementById('state').textContent.startsWith('no samples for'), null, kPatience);
  expect(true, 'silence is said');
  const seen = await page.evaluate(() => window.seen);
  logger.kill('SIGINT');
  await logger.ended;
  const csv = path.join(work, 'estimates.csv');
  execFileSync(program, ['convert', log, '--channel', 'FRAMEWATCH_ESTIMATE', csv]);
  const lines = fs.readFileSync(csv, 'utf8').trim().split('\n').map(l => l.split(','));
  const column = lines[0].indexOf('kx_1_y2'), logged = new Map(lines.slice(1).map(l => [Math.round(1e6 * l[0]), l[column]]));
  const shown = seen.filter(e => e.reason[1] === 0), same = shown.filter(e => Number(logged.get(e.end_us)) === e.value[1]);
  expect(shown.length > kCompared && same.length === shown.length, `${same.length} of ${shown.length} values are exactly those on LCM`);
  serve.kill();
  await page.waitForFunction(() => document.getElementById('state').textContent.startsWith('no connection'), null, kPatience);
  expect(true, 'a lost server is said');
  const errors = said.filter(t => !/ERR_CONNECTION_REFUSED|ERR_INCOMPLETE_CHUNKED/.test(t));
  expect(errors.length === 0, 'nothing on the console ' + errors.join('; '));
  await browser.close();
  fs.rmSync(work, {recursive: true});
}

run('page', main);
