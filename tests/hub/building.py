# SPDX-License-Identifier: MIT
"""A building at the hub: real `framewatch uplink`, on request real `framewatch run`, and events that this test
adds to its history like `run`."""
import os
import shutil
import signal
import sqlite3
import subprocess
import time

import lcm_event
from hub import Process, free_ports

HISTORY = ("history.sqlite", "uplink.sqlite")
PERIODS_S = (2, 4, 8)  # periods of summaries: tests cannot wait minutes


def at_hub(hub, name, ports=None):
    """The table [fleet] of a building's configuration."""
    hubs = ", ".join(f'"tls://localhost:{port}"' for port in (ports or hub.client))
    return (f'[fleet]\nbuilding = "{name}"\nhubs = [{hubs}]\ncertificate = "{hub.certificates}/{name}.pem"\n'
            f'key = "{hub.certificates}/{name}.key"\nca = "{hub.certificates}/ca.pem"\n'
            'accept = ["acknowledge", "raw", "resend", "minutes"]\n')


class Building:
    def __init__(self, hub, name, ports=None, history=True):
        self.hub, self.name = hub, name
        self.folder = f"{hub.folder}/{name}"
        os.makedirs(f"{self.folder}/history", exist_ok=True)
        self.config = f"{self.folder}/building.toml"
        (lcm,) = free_ports(1)
        self.url = f"udpm://{lcm_event.GROUP}:{lcm}?ttl=0"
        self.lcm = lcm_event.Lcm(lcm)
        self.fingerprint = lcm_event.fingerprint(hub.root)
        with open(f"{hub.root}/configs/table_two_story.toml") as file:
            text = file.read()
        assert "\n[lcm]" not in text
        with open(self.config, "w") as file:
            file.write(f'{text}\n[lcm]\nurl = "{self.url}"\n[commands]\ndirectory = "."\n[history]\n'
                       f'directory = "history"\nsummary_s = {list(PERIODS_S)}\n[watch]\nlearn_s = 5\n'
                       f'{at_hub(hub, name, ports)}')
        self.uplink = self.run = self.samples = self.database = None
        self.events = 0
        self.before_cut = set()  # keys acknowledged before the building lost its power
        if history:
            self.start_run()
            if not self.wait_for_history():
                raise RuntimeError(f"{name}: run creates no history")
            self.stop_run()

    def start_run(self):
        self.run = Process([self.hub.program, "run", self.config, "--quiet"], f"{self.folder}/run.log")

    def stop_run(self, number=signal.SIGTERM):
        self.run.end(number)
        self.run = None

    def start_samples(self, seconds=36_000, silent=(), silent_from_s=0):
        """A moving virtual building for run, with channels that fall silent."""
        with open(f"{self.hub.root}/configs/scenario_table_two_story.toml") as file:
            scenario = file.read().replace("table_two_story.toml", "building.toml")
        with open(f"{self.folder}/scenario.toml", "w") as file:
            file.write(scenario)
            for channel in silent:
                file.write(f'[[sensor]]\nchannel = "{channel}"\nnoise_mps2_per_rthz = 1e-4\ndead_from_s = {silent_from_s}\n')
        self.samples = Process([self.hub.program, "simulate", f"{self.folder}/scenario.toml", "--lcm", "--seconds",
                                str(seconds), "--quiet"], f"{self.folder}/simulate.log")

    def wait_for_history(self, seconds=30):
        """`framewatch run` creates the tables."""
        path = f"{self.folder}/history/history.sqlite"
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if os.path.exists(path):
                database = sqlite3.connect(path, isolation_level=None, timeout=30)
                try:
                    if database.execute("PRAGMA user_version").fetchone()[0] > 0:
                        self.database = database
                        return True
                except sqlite3.Error:
                    pass
                database.close()
            time.sleep(0.1)
        return False

    def add_events(self, count):
        """Adds events like `run`: to the history and over LCM. Returns their numbers."""
        numbers = range(self.events, self.events + count)
        rows = [lcm_event.event(i, message="message " * 20) for i in numbers]
        self.store(rows)
        for row in rows:
            self.lcm.publish("FRAMEWATCH_EVENT", lcm_event.encoded(self.fingerprint, row))
        self.events += count
        return numbers

    def store(self, rows):
        self.database.execute("BEGIN IMMEDIATE")
        self.database.executemany("INSERT INTO event VALUES (?,?,?,?,?,?,?,?,?,?,?,?)", rows)
        self.database.execute("COMMIT")

    def start(self):
        self.uplink = Process([self.hub.program, "uplink", self.config, "--quiet"], f"{self.folder}/uplink.log")

    def stop(self, number=signal.SIGTERM):
        self.uplink.end(number)
        self.uplink = None

    def keep_stores(self):
        """Copies the stores as they are on the disk, for put_back_stores()."""
        old = f"{self.folder}/old"
        shutil.rmtree(old, ignore_errors=True)
        os.makedirs(old)
        for name in HISTORY:
            path = f"{self.folder}/history/{name}"
            if os.path.exists(path):
                source = sqlite3.connect(path, timeout=30)
                with sqlite3.connect(f"{old}/{name}") as target:
                    source.backup(target)
                source.close()
                target.close()

    def put_back_stores(self):
        """A power cut of the building: kills everything and restores its disk of some seconds before."""
        runs = self.run is not None
        self.stop(signal.SIGKILL)
        if runs:
            self.stop_run(signal.SIGKILL)
        self.database.close()
        self.before_cut |= self.acknowledged_keys()
        for name in HISTORY:
            for tail in ("", "-wal", "-shm"):
                if os.path.exists(f"{self.folder}/history/{name}{tail}"):
                    os.remove(f"{self.folder}/history/{name}{tail}")
            if os.path.exists(f"{self.folder}/old/{name}"):
                shutil.copy(f"{self.folder}/old/{name}", f"{self.folder}/history/{name}")
        if runs:
            self.start_run()
        self.wait_for_history()
        self.start()

    def event_keys(self):
        """The key of every event in the history."""
        rows = self.read("history.sqlite", "SELECT kind, id, time_us, state FROM event")
        return {self.event_key(*row) for row in rows}

    def event_key(self, kind, number, time_us, state):
        return f"{self.name}/event/{kind}/{number}/{time_us}/{state}"

    def acknowledged_keys(self):
        try:
            events = self.read("uplink.sqlite", "SELECT kind, id, time_us, state FROM sent_event WHERE acknowledged_us >= 0")
            periods = self.read("uplink.sqlite", "SELECT period_s, start_us FROM sent_period WHERE acknowledged_us >= 0")
        except sqlite3.Error:
            return set()
        return {self.event_key(*row) for row in events} | {f"{self.name}/summary/{p}/{s}" for p, s in periods}

    def read(self, file, query):
        database = sqlite3.connect(f"file:{self.folder}/history/{file}?mode=ro", uri=True, timeout=30)
        try:
            return database.execute(query).fetchall()
        finally:
            database.close()

    def until_acknowledged(self, timeout_s=120):
        """Seconds until every event is acknowledged. Raises an error after the time limit."""
        begin = time.monotonic()
        while lacking := len(self.event_keys() - self.acknowledged_keys()):
            if time.monotonic() - begin > timeout_s:
                raise RuntimeError(f"{self.name}: {lacking} events are not acknowledged after {timeout_s} s")
            time.sleep(0.1)
        return time.monotonic() - begin


def simulated_samples(hub, seconds, path):
    subprocess.run([hub.program, "simulate", f"{hub.root}/configs/scenario_table_two_story.toml", "--seconds",
                    str(seconds), "--out", path, "--quiet"], check=True)
