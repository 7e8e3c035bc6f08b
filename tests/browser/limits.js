// SPDX-License-Identifier: MIT
'use strict';
// Measures whether the page bears the paper's building of 3x3 bays at 100 Hz: every row, 50
// frames/s, 200 viewers, 2000 slow connections, and an estimator that none of them disturbs.
const {chromium} = require('playwright-core');
const {spawnSync} = require('child_process');
const fs = require('fs'), http = require('http'), net = require('net'), os = require('os'), path = require('path');
const {expect, start, pause, addressOf, run} = require('./common.js');

const [program, browserPath, configs] = process.argv.slice(2);
// Limits.
const kViewers = 200, kSlow = 2000, kMaxCpu = 0.10, kMinFrames = 20, kQuietFrames = 50, kPlayed_s = 12;
const kPageBytes = 185000;

async function stop(child) { child.kill('SIGINT'); await child.ended; }
const config = path.join(configs, 'paper_table2.toml'), scenario = path.join(configs, 'scenario_paper_table2.toml');
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'framewatch-limits-'));
process.env.XDG_RUNTIME_DIR = work; // where commands go
const url = `udpm://239.255.76.67:${8800 + process.pid % 1000}?ttl=0`;

function cpuSeconds(pid) {
  const f = fs.readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(f[11]) + Number(f[12])) / 100;
}

class Viewer {
  constructor(address) {
    this.bytes = this.dropped = this.rows = 0;
    this.request = http.get(new URL('events', address), answer => answer.on('data', part => {
      this.bytes += part.length;
      if (part.includes('event: dropped')) ++this.dropped;
    }));
    this.request.on('error', () => {});
  }
  close() { this.request.destroy(); }
}

// Sends half a request, then a byte now and then. Reconnects when it is closed.
class Dawdler {
  constructor(address) {
    const {hostname, port} = new URL(address);
    const begin = () => {
      if (this.over) return;
      this.socket = net.connect(port, hostname, () => this.socket.write('GET / HTTP/1.1\r\nX: '));
      this.socket.on('error', () => {});
      this.socket.on('close', () => setTimeout(begin, 1000));
    };
    begin();
    this.timer = setInterval(() => { if (!this.socket.destroyed) this.socket.write('b'); }, 2000);
  }
  close() { this.over = true; clearInterval(this.timer); this.socket.destroy(); }
}

// Plays the same samples to an estimator beside this many viewers and slow connections. Returns
// its estimates as a log.
async function played(raw, count, slow = 0) {
  const sessions = path.join(work, `viewers-${count}-${slow}`);
  const recorder = start(program, 'record', config, '--url', url, '--no-check', '--no-report', '--quiet', '--out', sessions);
  const estimator = start(program, 'run', config, '--url', url, '--quiet');
  const serve = start(program, 'serve', config, '--url', url, '--port', '0', '--quiet');
  const address = await addressOf(serve);
  const viewers = Array.from({length: count}, () => new Viewer(address));
  await pause(500);
  const dawdlers = Array.from({length: slow}, () => new Dawdler(address));
  await pause(1500);
  const player = start('lcm-logplayer', '--lcm-url', url, raw);
  await pause(2000);
  const cpu = cpuSeconds(serve.pid), since = Date.now(), bytes = viewers.reduce((a, v) => a + v.bytes, 0);
  await pause(1000 * (kPlayed_s - 4));
  const seconds = (Date.now() - since) / 1000, share = (cpuSeconds(serve.pid) - cpu) / seconds;
  const rate = (viewers.reduce((a, v) => a + v.bytes, 0) - bytes) / seconds / (count || 1);
  await player.ended;
  await pause(1500);
  const dropped = viewers.reduce((a, v) => a + v.dropped, 0);
  for (const v of [...viewers, ...dawdlers]) v.close();
  for (const child of [recorder, estimator, serve]) await stop(child);
  const session = path.join(sessions, fs.readdirSync(sessions).find(name => name[0] === '2'));
  const told = JSON.parse(fs.readFileSync(path.join(session, 'session.json')));
  return {log: path.join(session, 'estimates.lcmlog'), share, rate, dropped, lost: told.lost + told.dropped};
}

async function main() {
  const raw = path.join(work, 'raw.lcmlog');
  if (spawnSync(program, ['simulate', scenario, '--out', raw, '--seconds', String(kPlayed_s), '--quiet']).status !== 0) throw new Error('no simulation');
  const alone = await played(raw, 0), watched = await played(raw, kViewers);
  console.log(`${kViewers} viewers: ${(100 * watched.share).toFixed(1)} % of a core, ${(watched.rate / 1e3).toFixed(1)} kB/s each, ${watched.dropped} told of lost events; none: ${(100 * alone.share).toFixed(1)} %`);
  expect(watched.share < kMaxCpu, `${kViewers} viewers cost less than ${100 * kMaxCpu} % of a core`);
  expect(watched.dropped === 0, 'none of them lost an event');
  // The scenario itself loses a few samples.
  expect(alone.lost === watched.lost && alone.lost < 10, 'no sample was lost on the way');
  const size = fs.statSync(alone.log).size;
  expect(spawnSync(program, ['diff', alone.log, watched.log], {stdio: 'inherit'}).status === 0 && size > 1e5, `the estimates are the same bytes with 0 and ${kViewers} viewers (${size} bytes of log)`);

  const dawdled = await played(raw, kViewers, kSlow);
  console.log(`${kSlow} slow connections beside them: ${(100 * dawdled.share).toFixed(1)} % of a core, ${(dawdled.rate / 1e3).toFixed(1)} kB/s each, ${dawdled.dropped} told of lost events`);
  expect(dawdled.rate > watched.rate / 2, 'slow connections end no viewer');
  expect(alone.lost === dawdled.lost && spawnSync(program, ['diff', alone.log, dawdled.log], {stdio: 'inherit'}).status === 0, `the estimates are the same bytes with ${kSlow} slow connections`);

  start(program, 'run', config, '--url', url, '--quiet');
  const serve = start(program, 'serve', config, '--url', url, '--port', '0', '--quiet');
  const address = await addressOf(serve);
  const browser = await chromium.launch({executablePath: browserPath, args: ['--no-sandbox']});
  const page = await browser.newPage({viewport: {width: 1400, height: 1350}});
  await page.goto(address);
  await page.waitForFunction(() => document.getElementById('state').textContent === 'waiting for samples');
  const simulation = start(program, 'simulate', scenario, '--lcm', url, '--seconds', '20', '--quiet');
  await page.waitForFunction(() => window.framewatch.motion);
  await pause(5000);
  const fps = [], before = await page.evaluate(() => ({rows: framewatch.rows, us: framewatch.motion.first_us + framewatch.motion.rows.at(-1)[0]}));
  for (let i = 0; i < 10; ++i) { await pause(1000); fps.push(await page.evaluate(() => framewatch.fps())); }
  const now = await page.evaluate(() => ({rows: framewatch.rows, us: framewatch.motion.first_us + framewatch.motion.rows.at(-1)[0], lost: framewatch.lost, leftOut: framewatch.leftOut, dropped: framewatch.dropped, latency: [...framewatch.latency].sort((a, b) => a - b)[framewatch.latency.length >> 1]}));
  await page.screenshot({path: 'page-3x3.png'});
  const weight = await page.evaluate(() => [...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')]
    .filter(e => !/\/events$|\.json$/.test(e.name)) // files of the page, without the building's data
    .reduce((sum, e) => sum + e.decodedBodySize, 0));
  fps.sort((a, b) => a - b);
  const rate = 1e6 * (now.rows - before.rows) / (now.us - before.us);
  console.log(`3x3 bays: ${rate.toFixed(1)} rows/s, ${now.lost} lost, ${now.dropped} events dropped, ${fps[0]} to ${fps.at(-1)} frames/s (median ${fps[5]}), sample to screen ${now.latency.toFixed(0)} ms in the median, ${weight} bytes`);
  expect(Math.abs(rate - 100) < 0.5 && now.lost === 0 && now.leftOut === 0 && now.dropped === 0, '100 rows a second, none lost');
  expect(fps[5] >= kMinFrames, `at least ${kMinFrames} frames/s` + (fps[5] >= kQuietFrames ? ` (and ${kQuietFrames})` : ''));
  expect(weight > 5e4 && weight < kPageBytes, `the page weighs less than ${kPageBytes / 1000} kB`);
  await simulation.ended;
  await browser.close();
}

process.on('exit', () => fs.rmSync(work, {recursive: true, force: true}));
run('limits', main);
