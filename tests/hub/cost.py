# SPDX-License-Identifier: MIT
"""Measures a hub of a thousand buildings, its speed after an hour's outage, and the cost of an uplink."""
import base64
import json
import os
import shutil
import signal
import sqlite3
import subprocess
import time

from building import Building
from hub import Process
from nats_client import Client

PARAMETERS, CHANNELS, EVENTS = 120, 20, 5
PERIODS_S = (60, 600, 3600)
# Requirements (docs/fleet.md).
CATCH_UP_S, SERVER_CORES, SERVER_BYTES = 60, 0.3, 300e6
UPLINK_CORE, UPLINK_BYTES, UPLINK_DAY_BYTES = 0.01, 30e6, 5e6
SUMMARIES_CORE_S = 1000


def fill_history(path, hours):
    """Writes summaries of the last hours of a building with 120 parameters, and some events, into the tables of `run`."""
    database = sqlite3.connect(path, isolation_level=None)
    database.execute("BEGIN")
    now_us = int(time.time()) // 3600 * 3600 * 10**6
    for p in range(PARAMETERS):
        database.execute("INSERT INTO parameter VALUES (?,?,?,?,?)", (1000 + p, f"kx_{p // 4 + 1}_x{p % 4}", "N/m", 0, 1))
    for c in range(CHANNELS):
        database.execute("INSERT INTO channel VALUES (?,?)", (1000 + c, f"floor_{c // 4 + 1}_x{c % 4}"))
    database.execute("INSERT INTO config VALUES (?,?,?,?)", ("a" * 64, "tower", "0.1.0", now_us - hours * 3600 * 10**6))
    for period_s in PERIODS_S:
        for start_us in range(now_us - hours * 3600 * 10**6, now_us, period_s * 10**6):
            add_period(database, period_s, start_us)
    add_period(database, PERIODS_S[0], now_us)  # periods before this time are closed
    for i in range(EVENTS):
        database.execute("INSERT INTO event VALUES (?,?,?,?,?,?,?,?,?,?,?,?)",
                         ("gap", i, now_us - i * 10**6, 1, 0, 0, "", 1.0, 0.1, "", "message " * 20, ""))
    database.execute("COMMIT")
    database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    database.close()


def add_period(database, period_s, start_us):
    database.execute("INSERT OR REPLACE INTO period VALUES (?,?,?,?,?)",
                     (period_s, start_us, 100 * period_s, start_us + period_s * 10**6, 0))
    seed = start_us // 10**6
    rows = []
    for p in range(PARAMETERS):
        # All values differ, like measured ones, because compression by zstd counts.
        value = 1e8 * (1 + p) * (1 + 1e-3 * ((seed * 7919 + p * 104729) % 1_000_003) / 1_000_003)
        step = 1e-4 * value * (1 + ((seed + p * 31) % 97) / 97)
        rows.append((1000 + p, period_s, start_us, 90 * period_s + p, value, step / 3, value - 4 * step, value - 3 * step,
                     value - step, value + step / 7, value + step * 1.1, value + 3.1 * step, value + 4.2 * step, p % 5,
                     90 * period_s))
    database.executemany("INSERT OR REPLACE INTO summary VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)", rows)
    database.executemany("INSERT OR REPLACE INTO channel_summary VALUES (?,?,?,?,?,?,?,?,?,?,?)",
                         [(1000 + c, period_s, start_us, 100 * period_s, c % 3, 0, 0, 0, 0, 0, 1e-6 + 1e-9 * (seed % 1009))
                          for c in range(CHANNELS)])


class Cost:
    def __init__(self, hub, postgres, workers, load, count):
        self.hub, self.postgres, self.workers, self.problems = hub, postgres, workers, []
        self.load, self.count, self.rows_to_come = load, count, 0
        # Each building has a disk; here all would share one.
        self.histories = f"/dev/shm/framewatch-load-{os.getpid()}"

    def bound(self, what, value, most, unit):
        good = value <= most
        print(f"  {'yes' if good else 'NO '}  {what}: {value:.3g} {unit} (at most {most:g})", flush=True)
        if not good:
            self.problems.append(f"{what}: {value:.3g} {unit}, not {most:g}")

    def enroll(self):
        """Does what `fleet request` and `fleet enroll` do with openssl, but writes users.conf once."""
        folder = self.hub.certificates
        begin = time.monotonic()
        self.hub.enroll("b0")
        print(f"  one building enrolled in {time.monotonic() - begin:.2f} s, servers reloaded")
        with open(f"{folder}/more.ext", "w") as file:
            file.write("basicConstraints=critical,CA:FALSE\nkeyUsage=critical,digitalSignature\n"
                       "extendedKeyUsage=clientAuth\n")
        script = (f"cd {folder}; for i in $(seq 1 {self.count - 1}); do "
                  "openssl req -newkey ed25519 -nodes -keyout b$i.key -out b$i.csr -subj /CN=b$i -batch; "
                  "openssl x509 -req -in b$i.csr -CA ca.pem -CAkey ca.key -set_serial $((100000 + i)) -days 825 "
                  "-extfile more.ext -out b$i.pem; done")
        subprocess.run(["bash", "-c", script], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(f"{folder}/buildings") as file:
            names = {line.strip() for line in file if line.strip()}
        names |= {f"b{i}" for i in range(self.count)}
        with open(f"{folder}/buildings", "w") as file:
            file.write("".join(f"{name}\n" for name in sorted(names)))
        begin = time.monotonic()
        self.hub.enroll("last")
        print(f"  the {self.count + 1}st in {time.monotonic() - begin:.2f} s")

    def make_histories(self):
        one = Building(self.hub, "template")
        one.database.close()
        path = f"{one.folder}/history/history.sqlite"
        database = sqlite3.connect(path, isolation_level=None)
        for table in ("summary", "channel_summary", "period", "parameter", "channel", "config", "event"):
            database.execute(f"DELETE FROM {table}")
        database.close()
        fill_history(path, 1)
        for i in range(self.count):
            os.makedirs(f"{self.histories}/b{i}")
            shutil.copy(path, f"{self.histories}/b{i}/history.sqlite")
        return path

    def start_load(self):
        self.reports = f"{self.hub.folder}/load.log"
        environment = {**os.environ, "NATS_DEFAULT_TO_LIB_MSG_DELIVERY": "1"}
        return Process([self.load, self.histories, self.hub.certificates, str(self.count), *self.hub.urls()], self.reports,
                       env=environment)

    def report(self):
        """The newest line: connected, waiting, under way, acknowledged, bytes, seconds of processor."""
        try:
            with open(self.reports) as file:
                lines = [line.split() for line in file if len(line.split()) == 6]
            return [float(word) for word in lines[-1]]
        except (OSError, IndexError, ValueError):
            return [0, 0, 0, 0, 0, 0]

    def catch_up(self):
        """All buildings wait for a hub that is away for an hour and returns."""
        wanted = self.count * (EVENTS + 7)
        self.hub.kill()
        load = self.start_load()
        while self.report()[1] < wanted:
            time.sleep(0.5)
        self.hub.start()
        begin = time.monotonic()
        connected_s = stored_s = None
        while time.monotonic() - begin < 300:
            connected, waits, under_way = self.report()[:3]
            took = time.monotonic() - begin
            if connected == self.count and connected_s is None:
                connected_s = took
            if waits == 0 and under_way == 0 and connected == self.count:
                break
            time.sleep(0.2)
        rows = 0
        while time.monotonic() - begin < 300 and rows < wanted:
            rows = self.postgres.number("SELECT (SELECT count(*) FROM event) + (SELECT count(*) FROM summary)")
            stored_s = time.monotonic() - begin
            time.sleep(0.2)
        self.hub.wait(240)
        servers_s = sum(server.usage()[0] for server in self.hub.servers)
        print(f"  {self.count} buildings, {wanted} events and summaries of an hour: all connected "
              f"{connected_s or -1:.0f} s after the hub's start, {rows} stored {stored_s:.0f} s; "
              f"processor until then: servers {servers_s:.1f} s, uplinks {self.report()[5]:.1f} s")
        self.bound("everything acknowledged after", took, CATCH_UP_S, "s")
        if rows != wanted:
            self.problems.append(f"{rows} of {wanted} rows are in the database")
        return load

    def steady(self, load, seconds):
        """Sends heartbeats, and each building's summary every ten minutes."""
        time.sleep(30)
        before = [server.usage()[0] for server in self.hub.servers]
        load_before, report_before = load.usage()[0], self.report()
        worker_before = [worker.usage()[0] for worker in self.workers.all]
        database_before = self.postgres.processor_s()
        begin, added = time.monotonic(), 0
        now_us = int(time.time()) // 3600 * 3600 * 10**6
        while time.monotonic() - begin < seconds:
            while added < (time.monotonic() - begin) * self.count / 600:
                database = sqlite3.connect(f"{self.histories}/b{added % self.count}/history.sqlite", isolation_level=None,
                                           timeout=30)
                database.execute("BEGIN")
                add_period(database, 600, now_us + added // self.count * 600 * 10**6)
                add_period(database, 60, now_us + (added // self.count + 1) * 600 * 10**6)
                database.execute("COMMIT")
                database.close()
                added += 1
            time.sleep(0.2)
        took = time.monotonic() - begin
        report = self.report()
        print(f"  {took:.0f} s of {self.count} buildings: {(report[3] - report_before[3]) / took:.1f} messages a second, "
              f"{(report[4] - report_before[4]) / took / self.count * 86400 / 1e6:.2f} MB a day each, "
              f"{report[0]:.0f} connected, {report[1]:.0f} wait")
        cores, sizes = [], []
        for server, cpu_s in zip(self.hub.servers, before):
            now_s, size = server.usage()
            cores.append((now_s - cpu_s) / took)
            sizes.append(size)
        self.bound("processor, all servers together", sum(cores), SERVER_CORES, "cores")
        self.bound("memory of a server, the largest", max(sizes) / 1e6, SERVER_BYTES / 1e6, "MB")
        worker = sum(w.usage()[0] - s for w, s in zip(self.workers.all, worker_before)) / took
        print(f"       workers {worker:.4f} cores, database {(self.postgres.processor_s() - database_before) / took:.4f}, "
              f"{self.count} uplinks in one process {(load.usage()[0] - load_before) / took:.3f}")

    def uplink(self, seconds):
        """A real uplink beside a real run, over an hour's history and then at rest."""
        self.hub.enroll("real")
        one = Building(self.hub, "real")
        one.start_run()
        one.start_samples()
        one.start()
        time.sleep(20)
        cpu_s, size = one.uplink.usage()
        time.sleep(seconds)
        then_s, size = one.uplink.usage()
        # Its summaries close every 4 s and 8 s instead of every 10 min and hour.
        self.bound("processor of an uplink, summaries every 4 s", (then_s - cpu_s) / seconds, UPLINK_CORE, "cores")
        self.bound("its memory", size / 1e6, UPLINK_BYTES / 1e6, "MB")
        one.samples.end()
        one.stop_run()
        one.stop()

    def day(self):
        """Bytes of a message of each kind in the streams, times their number per day."""
        operator = Client(self.hub.client[0], self.hub.certificates, "operator", 30)
        total = 0
        for stream, kind, times in (("FW_LAST", "service", 1440), ("FW_LAST", "status", 144), ("FW_LAST", "history", 144),
                                    ("FW_LAST", "watch", 144), ("FW_LAST", "parameters", 144), ("FW_LAST", "inventory", 1),
                                    ("FW_SUMMARY", "summary.600", 144), ("FW_SUMMARY", "summary.3600", 24)):
            subject = f"fw.up.b0.{kind}"
            answer = json.loads(operator.request(f"$JS.API.STREAM.MSG.GET.{stream}",
                                                 json.dumps({"last_by_subj": subject}).encode(), timeout_s=30))
            message = answer["message"]
            size = len(subject) + len(base64.b64decode(message.get("hdrs", ""))) + len(base64.b64decode(message["data"]))
            total += size * times
            print(f"       {kind:<13} {size:>6} bytes, {times:>5} a day: {size * times / 1e6:.2f} MB")
        self.bound("a day of an uplink, 120 parameters, 20 channels", total / 1e6, UPLINK_DAY_BYTES / 1e6, "MB")

    def worker_rate(self):
        """One worker reads everything in FW_SUMMARY again, into an empty table."""
        self.workers.stop()
        operator = Client(self.hub.client[0], self.hub.certificates, "operator", 30)
        held = json.loads(operator.request("$JS.API.STREAM.INFO.FW_SUMMARY", timeout_s=30))["state"]["messages"]
        self.postgres.ask("TRUNCATE summary")
        operator.request("$JS.API.CONSUMER.DELETE.FW_SUMMARY.store", timeout_s=30)
        self.hub.fleet("setup", *[a for url in self.hub.urls() for a in ("--hub", url)], "--buildings", str(self.count))
        database_s = self.postgres.processor_s()
        self.workers.start()
        wanted, begin, rows = self.rows_to_come, time.monotonic(), 0
        while rows < wanted and time.monotonic() - begin < 120:
            time.sleep(0.1)
            rows = self.postgres.number("SELECT count(*) FROM summary")
        took = time.monotonic() - begin
        worker_s = self.workers.all[0].usage()[0]
        print(f"  one worker took {held} summaries of {PARAMETERS} parameters in {took:.1f} s, {worker_s:.2f} s of its "
              f"processor, {self.postgres.processor_s() - database_s:.2f} s of the database's")
        if rows < wanted:
            self.problems.append(f"{rows} of {wanted} summaries are in the database")
        size = self.postgres.number("SELECT sum(pg_total_relation_size(inhrelid)) FROM pg_inherits "
                                    "WHERE inhparent = 'summary'::regclass")
        print(f"       {size / max(rows, 1):.0f} bytes of the database for a summary")
        self.bound("seconds of a worker's processor for 1000 summaries", 1000 * worker_s / held, 1000 / SUMMARIES_CORE_S, "s")

    def check(self, steady_s, uplink_s):
        self.workers.start(2)
        try:
            self.enroll()
            self.make_histories()
            load = self.catch_up()
            self.steady(load, steady_s)
            self.day()
            load.end(signal.SIGTERM)
            self.rows_to_come = self.postgres.number("SELECT count(*) FROM summary")
            self.worker_rate()
            self.uplink(uplink_s)
        finally:
            shutil.rmtree(self.histories, ignore_errors=True)
        return self.problems
