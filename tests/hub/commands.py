# SPDX-License-Identifier: MIT
"""Commands that people give on the page to a moving building: rights, effects and journal entries."""
import json
import os
import subprocess
import sys
import time

sys.path.insert(0, f"{os.path.dirname(os.path.abspath(__file__))}/../browser")
import bad_input
import chromium
import lcm_event
from building import Building
from page import Page

SILENT, SILENT_FROM_S, FETCHED_S = ("F1-Y1", "F2-X2"), 40, 10  # silent sensors and times; the fetched stretch
WAIT_S = 90
SECOND_US = 1_000_000
VIEWS = {"#/": "document.querySelector('main tbody tr td.name a').textContent === 'd1'",
         "#/building/d1": "document.querySelector('main').innerText.includes('acknowledged by alice')",
         "#/journal": "document.querySelector('main').innerText.includes('resend')",
         "#/earthquake": "document.querySelector('main h2') !== null"}


def until(done):
    return bad_input.until(done, WAIT_S)


class Commands:
    def __init__(self, hub, postgres):
        self.hub, self.postgres, self.problems = hub, postgres, []
        self.page = Page(hub, postgres)
        self.operator, self.viewer = self.page.person("alice", "operator"), self.page.person("bob", "viewer")

    def must(self, good, what):
        print(f"  {'yes' if good else 'NO '}  {what}", flush=True)
        if not good:
            self.problems.append(what)

    def command(self, words, token=None):
        status, answer = self.page.answer(token or self.operator, f"command?building=d1&{words}", "POST")
        return answer["request"] if status == 202 else status

    def outcome(self, request):
        """The building's answer in the journal; None if there is none yet."""
        for row in self.page.ask(self.operator, "journal.json") or []:
            if row["request"] == request and row["done"] + row["refused"] > 0:
                return row["done"] == 1
        return None

    def obeyed(self, words):
        request = self.command(words)
        return isinstance(request, str) and until(lambda: self.outcome(request) is not None) and self.outcome(request)

    def known(self):
        view = self.page.ask(self.operator, "building.json?name=d1") or {}
        return {one["id"]: one["known_to"] for one in view.get("raised", []) if one["known"]}

    def resend(self, building):
        """A database that lost its contents."""
        building.until_acknowledged()
        self.must(until(lambda: self.postgres.number("SELECT count(*) FROM event") >= 3), "events are in the database")
        self.postgres.ask("DELETE FROM event")
        self.must(self.obeyed(f"verb=resend&from_us={lcm_event.FIRST_US}&to_us={lcm_event.FIRST_US + SECOND_US}"), "resend is obeyed")
        self.must(until(lambda: self.postgres.number("SELECT count(*) FROM event") >= 3), "and what was lost comes again")

    def raw(self, building, to_us):
        from_us = to_us - FETCHED_S * SECOND_US
        refused = self.command(f"verb=raw&from_us={from_us}&to_us={to_us}", self.viewer)
        self.must(refused == 403, "a viewer may not fetch raw samples")
        self.must(self.obeyed(f"verb=raw&from_us={from_us}&to_us={to_us}"), "raw is obeyed")
        self.must(until(lambda: [one["came"] == one["pieces"] > 0 for one in self.stretches()] == [True]), "all pieces arrive")
        self.must(self.obeyed(f"verb=raw&from_us={lcm_event.FIRST_US}&to_us={lcm_event.FIRST_US + SECOND_US}"),
                  "raw of a time without samples is obeyed")
        self.must(until(lambda: sum("found none" in one["problem"] for one in self.stretches()) == 1),
                  "the page says that there are no samples")
        archive, own = f"{self.hub.folder}/sds", f"{self.hub.folder}/own.mseed"
        self.hub_command("fleet", "export", "--sds", archive, "--database", self.postgres.where)
        files = sorted(f"{folder}/{name}" for folder, _, names in os.walk(archive) for name in names)
        self.hub_command("history", building.config, "--from", str(from_us / 1e6), "--to", str(to_us / 1e6), "--raw", own)
        fetched, stored = (self.samples(paths) for paths in (files, [own]))
        self.must(fetched == stored and len(stored) == len(files) > 0 and min(map(len, stored)) >= (FETCHED_S - 1) * 100,
                  f"the archive has the building's own samples ({len(files)} files)")

    def stretches(self):
        return (self.page.ask(self.operator, "building.json?name=d1") or {}).get("stretches", [])

    def samples(self, files):
        """The values of each channel."""
        out = f"{self.hub.folder}/samples.csv"
        self.hub_command("convert", *files, "--unit", "1e-6", out)
        with open(out) as file:
            rows = [line.split(",")[1:] for line in file.read().splitlines()[1:]]
        return sorted(zip(*rows))

    def acknowledge(self, building):
        """Silent sensors raise events. One is acknowledged here, one in the building."""
        def silent():
            view = self.page.ask(self.operator, "building.json?name=d1") or {}
            return [one["id"] for one in view.get("raised", []) if one["kind"] == "channel_silent"]

        self.must(until(lambda: len(silent()) >= 2), "the hub raises silent sensors")
        if len(silent()) < 2:
            return
        first, second = silent()[:2]
        self.must(self.obeyed(f"verb=acknowledge&id={first}&comment=tomorrow"), "acknowledge is obeyed")
        self.must(until(lambda: self.known().get(first) == "alice"), "the page names who acknowledged")
        self.hub_command("acknowledge", str(second), building.config)
        self.must(until(lambda: second in self.known()), "the page shows the acknowledgement given in the building")

    def look(self):
        """Opens every view in a browser."""
        if not chromium.program():
            print("  views skipped: no chromium (deploy/install-deps --with page)")
            return
        browser = chromium.Chromium()
        try:
            tab = browser.open(f"http://127.0.0.1:{self.page.port}/?token={self.operator}")
            for view, sign in VIEWS.items():
                tab.value(f"location.hash = '{view}'")
                seen = tab.until(f"document.getElementById('trouble').hidden && {sign}", WAIT_S)
                self.must(seen, f"the page shows its view {view}")
            self.must(not browser.errors, f"no script fails {' '.join(browser.errors)}")
        finally:
            browser.end()

    def hub_command(self, *arguments):
        done = subprocess.run([self.hub.program, *arguments], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            self.problems.append(f"{' '.join(arguments[:2])}: {done.stdout}{done.stderr}")

    def check(self):
        self.hub.enroll("d1")
        building = Building(self.hub, "d1")
        self.page.start()
        building.start_run()
        building.start()
        building.start_samples(silent=SILENT, silent_from_s=SILENT_FROM_S)
        moves_us = int(time.time() * SECOND_US)
        building.add_events(3)
        self.must(until(lambda: self.command("verb=ping", self.viewer) == 403), "a viewer may not give a command")
        self.must(until(lambda: self.obeyed("verb=ping")), "an operator may, and the building answers")
        self.resend(building)
        time.sleep(max(0, 25 - (time.time() - moves_us / SECOND_US)))
        self.raw(building, moves_us + 20 * SECOND_US)
        self.acknowledge(building)
        journal = json.dumps(self.page.ask(self.operator, "journal.json"))
        self.must(all(f'"{verb}"' in journal for verb in ("ping", "resend", "raw", "acknowledge")), "the journal has all commands")
        self.look()
        self.page.stop()
        building.samples.end()
        building.stop()
        building.stop_run()
        return self.problems
