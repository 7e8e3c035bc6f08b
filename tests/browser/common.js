// SPDX-License-Identifier: MIT
'use strict';
// The tests of the page share these functions. They check and say what failed, start programs that end with the test, and wait.
const {spawn} = require('child_process');

const kPatience = {timeout: 60000}; // for anything, on a busy machine
const children = [], failures = [];
const expect = (good, what) => { console.log((good ? 'ok    ' : 'FAILED') + ' ' + what); if (!good) failures.push(what); };
function start(command, ...args) {
  const child = spawn(command, args, {stdio: ['ignore', 'pipe', 'inherit']});
  children.push(child);
  child.ended = new Promise(done => child.on('exit', done));
  return child;
}
const pause = ms => new Promise(done => setTimeout(done, ms));
async function until(page, what, condition, argument) {
  const came = await page.waitForFunction(condition, argument, kPatience).catch(() => null);
  expect(came !== null, what);
}
// Returns the address that `framewatch serve` prints.
const addressOf = serve => new Promise(done => serve.stdout.once('data', d => done(String(d).trim())));
// Runs a test, ends its programs and exits with 1 if a check failed.
function run(name, main) {
  main().catch(e => { failures.push(e.message); console.log(e); }).finally(() => {
    for (const child of children) if (child.exitCode === null) child.kill();
    console.log(failures.length ? `${name}: ${failures.length} failed` : `${name}: all passed`);
    process.exit(failures.length ? 1 : 0);
  });
}
module.exports = {kPatience, expect, start, pause, until, addressOf, run};
