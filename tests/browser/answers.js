// SPDX-License-Identifier: MIT
'use strict';
// Checks the four answers of the page in every situation: quiet, shaking, damaged, acknowledged,
// with a dead sensor, and opened afterwards. Takes a screenshot of each and checks the words on
// it.
const {chromium} = require('playwright-core');
const fs = require('fs'), os = require('os'), path = require('path');
const {kPatience, expect, start, pause, until, addressOf, run} = require('./common.js');

const [program, browserPath, configs] = process.argv.slice(2);
// Limits.
const kDrop_s = 60, kPlayed_s = 900, // ended after the check
   kDrop_ratio = -0.15, kMaxOff = 0.02, kSharp = 0.6, kLate_s = 20;
const kDamaged = 'kx_1_y2', kDead = 'F1-X2';

const work = fs.mkdtempSync(path.join(os.tmpdir(), 'framewatch-answers-'));
process.env.XDG_RUNTIME_DIR = work; // where commands go
const url = `udpm://239.255.76.67:${6800 + process.pid % 1000}?ttl=0`;
const config = path.join(configs, 'table_two_story.toml');
function scenario(name, {change = '', motion = t => t, building = t => t}) {
  const own = path.join(work, name + '-building.toml'), out = path.join(work, name + '.toml');
  fs.writeFileSync(own, building(fs.readFileSync(config, 'utf8')));
  fs.writeFileSync(out, motion(fs.readFileSync(path.join(configs, 'scenario_table_two_story.toml'), 'utf8')).replace('"table_two_story.toml"', JSON.stringify(own)) + change);
  return out;
}
const shake = file => start(program, 'simulate', file, '--lcm', url, '--seconds', String(kPlayed_s), '--quiet');
async function stop(child) { child.kill('SIGINT'); await child.ended; await pause(5000); }
const drop = at_s => `\n[[change]]\nat_s = ${at_s}.0\nparameter = "${kDamaged}"\nfactor = ${1 + kDrop_ratio}\n`;

const said = [];
async function open(browser, address, options) {
  const page = await browser.newPage({viewport: {width: 1400, height: 1350}, ...options});
  page.on('console', m => said.push(m.text()));
  page.on('pageerror', e => said.push(e.message));
  await page.goto(address);
  return page;
}
const answer = (page, i) => page.locator('#answers > li').nth(i).innerText();
const state = page => page.textContent('#state');
async function shot(page, name) {
  await page.evaluate(() => scrollTo(0, 0));
  await pause(700);
  await page.screenshot({path: name + '.png', fullPage: true});
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name}: the page fits the width`);
  const names = await page.evaluate(() => [...document.querySelectorAll('button,select,input,canvas')].filter(e => e.offsetParent && !(e.textContent.trim() || e.ariaLabel || e.getAttribute('aria-label') || e.labels && e.labels.length || e.closest('[role=img],[aria-hidden]'))).map(e => e.id || e.outerHTML));
  expect(names.length === 0, `${name}: every control has a name ${names}`);
}

async function quiet(page) {
  const motion = shake(scenario('quiet', {motion: t => t.replace('peak_mps2 = 2.0', 'peak_mps2 = 0.0005')}));
  await until(page, 'quiet: samples arrive', () => framewatch.rows > 900);
  await until(page, 'quiet: answers appear', () => framewatch.told && framewatch.told.answers[2].state === 'good');
  expect(/Not known yet/.test(await answer(page, 0)), 'quiet: there is no baseline yet');
  expect(/Nothing: no acceleration over 0.05 m\/s²\. Since .* UTC\./.test(await answer(page, 2)), 'quiet: no shaking is reported');
  expect((await page.textContent('#no-findings')) === 'none' && await page.isVisible('#no-findings'), 'quiet: no open findings');
  await shot(page, 'quiet');
  await stop(motion);
}

async function shaking(page) {
  await until(page, 'shaking: findings of the nodes\' restart are closed', () => framewatch.told.findings.length === 0);
  await until(page, 'shaking: no change is reported', () => /No\. None of \d+ elements/.test(document.getElementById('answers').innerText));
  await until(page, 'shaking: peaks of each story', () => /It is shaking: a story swayed by up to [\d.]+ % of its height.* N along x.*Story 2: [\d.]+ % .*Story 1: [\d.]+ % /s.test(document.getElementById('answers').innerText));
  await until(page, 'shaking: no finding is open', () => framewatch.told.findings.length === 0);
  expect(/All 10 sensors send, and the model leaves (under )?[\d.]+ % of the motion unexplained/.test(await answer(page, 1)), 'shaking: estimates can be trusted');
  expect(/Nothing\./.test(await answer(page, 3)), 'shaking: nothing to do');
  expect((await state(page)) === 'live', 'shaking: live');
  expect(/\d kN\/m/.test(await page.textContent('#chosen')) && !/\de[+-]/.test(await page.textContent('main')), 'shaking: numbers are in kN/m, none with an exponent');
  await shot(page, 'shaking');
}

async function damaged(page) {
  await until(page, 'damaged: the change is reported', name => framewatch.told.findings.some(f => f.place === name), kDamaged);
  const first = await page.evaluate(() => framewatch.told.findings[0]);
  expect(/Yes\. Story 1, frame y2 \(kx_1_y2\) has lost .* % of its stiffness, give or take [\d.]+ %: .* times its uncertainty\. Since .* UTC\./.test(await answer(page, 0)), 'damaged: the first answer names element, size, error and time');
  await until(page, 'damaged: the number becomes more exact', ([e, share]) => framewatch.told.findings[0] && framewatch.told.findings[0].error < share * e, [first.error, kSharp]);
  await pause(1500);
  const [now, event] = await page.evaluate(() => [framewatch.told.findings[0], [...framewatch.alarms.values()].find(a => a.id === framewatch.told.findings[0].id)]);
  console.log(`first ${first.ratio} +- ${first.error}, now ${now.ratio} +- ${now.error}`);
  expect(Math.abs(now.ratio - kDrop_ratio) < kMaxOff, 'damaged: the size is right');
  expect(now.ratio === event.value && now.error === event.error, 'damaged: finding and event have one number');
  const size = (await answer(page, 0)).match(/has lost ([\d.]+ %)/)[1];
  const texts = await Promise.all(['#findings', '#alarms', '#chosen'].map(id => page.textContent(id)));
  expect(texts.every(t => t.includes(size)), `damaged: ${size} in answer, findings, events and element: ${texts[2]}`);
  expect(/structural engineer inspect story 1, frame y2/.test(await answer(page, 3)), 'damaged: advice is given');
  expect((await page.getAttribute('#alert', 'role')) === 'alert' && /has lost/.test(await page.textContent('#alert')), 'damaged: a screen reader reads it');
  await shot(page, 'damaged');
  await page.click('#box-mode');
  await page.click('#values summary');
  await pause(1500);
  expect(/kx_1_y2/.test(await page.textContent('#value-table')) && /kN\/m/.test(await page.textContent('#value-table')), 'damaged: true values on demand');
  await page.locator('#boxes-card').screenshot({path: 'true-values.png'});
  await page.click('#box-mode');
  await page.click('#values summary');
  await page.emulateMedia({media: 'print'});
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  await page.screenshot({path: 'print.png', fullPage: true});
  await page.pdf({path: 'print.pdf', format: 'A4'});
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  await page.emulateMedia({media: 'screen'});
}

async function acknowledged(page) {
  await page.focus('#findings button');
  await page.keyboard.press('Enter');
  await until(page, 'acknowledged: by keyboard, and no longer open', () => document.querySelectorAll('#findings button').length === 0);
  await until(page, 'acknowledged: the change stays', () => /Yes\. .*Story 1, frame y2 \(kx_1_y2\) is acknowledged/s.test(document.querySelector('#answers > li').innerText));
  await until(page, 'acknowledged: nothing to do', () => /Nothing\./.test(document.querySelectorAll('#answers > li')[3].innerText));
  expect(/acknowledged/.test(await page.textContent('#alarms')), 'acknowledged: the list of events shows it');
  await shot(page, 'acknowledged');
  await page.click('#baseline');
  expect(await page.isVisible('#ask-baseline') && /cannot be undone/.test(await page.textContent('#ask-baseline')), 'a new baseline is asked about');
  await page.keyboard.press('Escape');
  await page.click('#baseline');
  await page.click('#ask-baseline button[value=no]');
  expect(/Yes\./.test(await answer(page, 0)), 'whoever keeps the present baseline keeps it');
}

async function deadChannel(page) {
  await until(page, 'dead channel: other nodes continue', () => framewatch.told.findings.every(f => f.kind !== 'service'));
  await until(page, 'dead channel: a finding', name => framewatch.told.findings.some(f => f.place === name && f.of_channel), kDead);
  await until(page, 'dead channel: the pill is amber', () => /^live, but 1 of 10 sensors not good$/.test(document.getElementById('state').textContent) && document.getElementById('state').className.includes('amber'));
  await until(page, 'dead channel: a red dot on the building', name => building.dots.includes(name), kDead);
  expect(new RegExp(`Only in part\\. ${kDead} is silent: its samples have stopped\\. .* Since .* UTC.*9 of 10 sensors are good`, 's').test(await answer(page, 1)), 'dead channel: the second answer says so');
  expect(new RegExp(`Check the power, cable and mounting of sensor ${kDead}`).test(await answer(page, 3)), 'dead channel: advice is given');
  expect((await page.textContent('#findings')).includes(kDead), 'dead channel: in the open findings');
  await shot(page, 'dead-channel');
}

async function openedLate(browser, address) {
  await pause(1000 * kLate_s);
  const page = await open(browser, address);
  await until(page, 'opened late: the silence is shown', () => /^no samples for \d+ s$/.test(document.getElementById('state').textContent));
  await until(page, 'opened late: the answers are there', () => framewatch.told && framewatch.told.answers.length === 4);
  expect(/Yes\. Story 1, frame y2/.test(await answer(page, 0)), 'opened late: the change is shown');
  expect(/No: no samples for .*The values shown are old/.test(await answer(page, 1)), 'opened late: old values are marked');
  expect(/A shake: a story swayed by up to/.test(await answer(page, 2)), 'opened late: the shaking is shown');
  expect(await page.evaluate(() => framewatch.opened) > 60, 'opened late: the last minutes are there');
  await until(page, 'opened late: last values with their age', () => /last value .* kN\/m .* old, of .* UTC/.test(document.getElementById('chosen').textContent));
  expect(await page.evaluate(() => plan.parameters.every((q, i) => q.kind !== 0 || building.known[i])), 'opened late: no frame is hatched');
  expect(await page.evaluate(() => strips.k.ring.n > 30 && strips.accel.ring.n > 100 && boxes.count.some(c => c > 0)), 'opened late: strips and boxes are not empty');
  await shot(page, 'opened-late');
  return page;
}

async function strongMotionIsOver(page) {
  const motion = shake(scenario('calm', {motion: t => t.replace('peak_mps2 = 2.0', 'peak_mps2 = 0.0005')}));
  await until(page, 'strong motion: its report is named', () => framewatch.told.answers[2].more.some(m => m.report));
  await until(page, 'strong motion: judged, with a link', () => /Judged (yellow|red): .*Read the report/s.test(document.querySelectorAll('#answers > li')[2].innerText));
  await until(page, 'strong motion: the report is in the list', () => /(yellow|red)/.test(document.getElementById('event-reports').innerText));
  const [report] = await Promise.all([page.context().waitForEvent('page'), page.click('#answers a')]);
  await report.waitForLoadState();
  // The simulation paused between its parts.
  expect(/^(No samples came .*\s+)*(Yellow|Red): /.test(await report.innerText('body')), 'strong motion: the report begins with the verdict');
  await report.screenshot({path: 'event-report.png', fullPage: true});
  await report.pdf({path: 'event-report.pdf', format: 'A4'});
  await report.close();
  expect((await page.textContent('#findings')).includes('After strong motion'), 'strong motion: a finding');
  await shot(page, 'strong-motion');
  await stop(motion);
}

async function startedAnew(browser, serve, options) {
  await stop(serve);
  const page = await open(browser, await addressOf(start(program, ...options)));
  await until(page, 'restarted: answers appear', () => framewatch.told && framewatch.told.answers.length === 4);
  await until(page, 'restarted: ages are shown', () => /^no samples for \d+ s$/.test(document.getElementById('state').textContent));
  // Without [watch] the page's own server finds the change, and nobody stores it.
  expect(/Not known yet/.test(await answer(page, 0)), 'restarted: unstored findings are gone');
  expect(/A shake: a story swayed by up to/.test(await answer(page, 2)), 'restarted: the shaking is shown');
  expect(/Read the report/.test(await answer(page, 2)), 'restarted: the report is named');
  expect(await page.evaluate(() => framewatch.opened) > 0, 'restarted: the last minutes are there');
  await until(page, 'restarted: last values with their age', () => /last value .* kN\/m .* old, of .* UTC/.test(document.getElementById('chosen').textContent));
  expect(await page.evaluate(() => plan.parameters.every((q, i) => q.kind !== 0 || building.known[i])), 'restarted: no frame is hatched');
  await shot(page, 'started-anew');
}

async function main() {
  const own = path.join(work, 'building.toml');
  fs.writeFileSync(own, fs.readFileSync(config, 'utf8') + '\n[history]\ndirectory = "history"\n\n[event_report]\ndirectory = "events"\n');
  start(program, 'run', own, '--url', url, '--quiet');
  const served = ['serve', own, '--url', url, '--port', '0', '--sessions', path.join(work, 'none'), '--quiet'];
  const serve = start(program, ...served);
  const address = await addressOf(serve);
  const browser = await chromium.launch({executablePath: browserPath, args: ['--no-sandbox']});
  const page = await open(browser, address);
  await until(page, 'waits for samples', () => document.getElementById('state').textContent === 'waiting for samples');
  await quiet(page);
  const damage = shake(scenario('damage', {change: drop(kDrop_s)}));
  await shaking(page);
  await damaged(page);
  await acknowledged(page);
  await stop(damage);
  const dead = shake(scenario('dead', {change: drop(0), building: t => t.replace('node = 5', 'node = 55').replace(`"${kDead}"`, '"spare"')}));
  await deadChannel(page);
  await stop(dead);
  const late = await openedLate(browser, address);
  await late.setViewportSize({width: 390, height: 844});
  await shot(late, 'phone');
  await late.setViewportSize({width: 1400, height: 1350});
  await late.focus('#theme');
  await late.keyboard.press('Enter');
  await shot(late, 'dark');
  await late.focus('#box-k');
  const before = await late.inputValue('#element');
  await late.keyboard.press('ArrowRight');
  expect(await late.inputValue('#element') !== before, 'arrow keys choose a box');
  await late.click('#zone');
  expect((await late.textContent('#zone')) === 'Times: local' && !/UTC/.test(await late.textContent('#answers')), 'times as this device has them');
  await late.click('#zone');
  await strongMotionIsOver(page);
  expect(said.length === 0, 'nothing on the console ' + said.join('; '));
  await page.close();
  await late.close();
  await startedAnew(browser, serve, served);
  await browser.close();
}

process.on('exit', () => fs.rmSync(work, {recursive: true, force: true}));
run('answers', main);
