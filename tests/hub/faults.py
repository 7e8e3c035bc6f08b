# SPDX-License-Identifier: MIT
"""Faults of hub, line, center and building, one after the other, while three real buildings run. At the end the database
must hold every message exactly once."""
import json
import os
import signal
import sys
import time

from arrivals import Arrivals, percentile
from building import Building
from hub import Process, free_ports
from nats_client import Client, stream_keys

BEFORE_S, EVERY_S, EACH = 2, 0.25, 4
BUILDINGS = 3
CONSUMERS = (("FW_EVENT", "store"), ("FW_SUMMARY", "store"))
P99_S, SERVER_DIES_S = 2, 20  # from an event to the database
MOST_LOAD = 3  # processes per processor; with more, times say nothing about the programs


class Faults:
    def __init__(self, hub, postgres, workers, chance):
        self.hub, self.postgres, self.workers, self.chance = hub, postgres, workers, chance
        self.rows, self.sent, self.busy = [], {}, False
        listen = free_ports(3)
        pairs = [f"{a}:{b}" for a, b in zip(listen, hub.client)]
        # Building 3 has a line that can fail silently.
        self.proxy = Process([sys.executable, f"{os.path.dirname(__file__)}/proxy.py", *pairs], f"{hub.folder}/proxy.log")
        time.sleep(0.5)
        self.buildings = [self.building(f"b{11 + i}", listen if i == 2 else None) for i in range(BUILDINGS)]
        self.arrivals = Arrivals(postgres)

    def building(self, name, ports):
        self.hub.enroll(name)
        one = Building(self.hub, name, ports)
        one.start_run()
        one.start_samples()
        one.start()
        return one

    def some_building(self):
        return self.chance.choice(self.buildings)

    def feed(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for one in self.buildings:
                begin = time.monotonic()
                for number in one.add_events(EACH):
                    self.sent[one.name, number] = begin
            time.sleep(EVERY_S)

    def fault(self, what, act, times=1):
        """act() causes the fault and repairs it. Then everything must be acknowledged."""
        first = {one.name: one.events for one in self.buildings}
        self.feed(BEFORE_S)
        for i in range(times):
            if times > 1:
                if sys.stdout.isatty():
                    print(f"\r  {what}: {i + 1} of {times}", end="", flush=True)
                self.feed(self.chance.uniform(0.2, 1.5))
            act()
        self.feed(BEFORE_S)
        seconds = max(one.until_acknowledged(300) for one in self.buildings)
        last = {one.name: one.events for one in self.buildings}
        self.rows.append((what, first, last, seconds))
        print(f"{chr(13) if sys.stdout.isatty() else ''}  {what}: all acknowledged {seconds:.1f} s after the last fault", flush=True)

    def info(self, what):
        for _ in range(120):
            try:
                client = Client(self.chance.choice(self.hub.client), self.hub.certificates, "operator", 3)
                answer = json.loads(client.request(f"$JS.API.{what}", timeout_s=10) or b"{}")
                if "cluster" in answer and "leader" in answer["cluster"]:
                    return answer
            except Exception:  # noqa: BLE001: the server has just ended
                pass
            time.sleep(0.5)
        raise RuntimeError(f"{what}: no leader")

    def leader(self):
        return int(self.info("STREAM.INFO.FW_EVENT")["cluster"]["leader"][-1]) - 1

    def nothing(self):
        self.feed(20)
        self.busy = os.getloadavg()[0] > MOST_LOAD * os.cpu_count()

    def kill_server(self, server, seconds):
        self.hub.kill(server)
        self.feed(seconds)
        self.hub.start(server)
        self.hub.wait()

    def leader_killed(self):
        self.kill_server(self.leader(), 8)

    def leader_frozen(self):
        server = self.hub.servers[self.leader()]
        server.tell(signal.SIGSTOP)
        self.feed(15)
        server.tell(signal.SIGCONT)
        self.hub.wait()

    def line_dead(self):
        self.proxy.tell(signal.SIGSTOP)
        self.feed(30)
        self.proxy.tell(signal.SIGCONT)

    def uplink_killed(self):
        one = self.some_building()
        one.stop(signal.SIGKILL)
        one.start()

    def run_killed(self):
        one = self.some_building()
        one.stop_run(signal.SIGKILL)
        one.start_run()

    def worker_killed(self):
        self.workers.kill(self.chance.randrange(len(self.workers.all)))
        self.workers.start()

    def database_killed(self):
        self.postgres.kill()
        self.feed(self.chance.uniform(1, 5))
        self.postgres.start()

    def all_killed(self):
        self.hub.kill()
        self.feed(3)
        self.hub.start()
        self.hub.wait()

    def hub_power(self):
        self.hub.copy_stores()
        self.feed(3)
        self.hub.kill()
        self.hub.put_back_stores()
        self.hub.start()
        self.hub.wait()

    def building_power(self):
        one = self.some_building()
        one.keep_stores()
        self.feed(3)
        one.put_back_stores()

    def any_kill(self):
        self.chance.choice([self.uplink_killed, self.run_killed, self.worker_killed, self.database_killed,
                            lambda: self.kill_server(self.chance.randrange(3), self.chance.uniform(0.2, 1.5))])()

    def any_power_cut(self):
        self.chance.choice([self.hub_power, self.building_power])()

    def every_one(self, kills, power_cuts):
        self.fault("none", self.nothing)
        self.fault("leader killed (-9), back after 8 s", self.leader_killed)
        self.fault("leader frozen 15 s", self.leader_frozen)
        self.fault("line dead 30 s, silently", self.line_dead)
        self.fault("uplink killed (-9) 5 times", self.uplink_killed, 5)
        self.fault("worker killed (-9)", self.worker_killed)
        self.fault("database killed", self.database_killed)
        self.fault("all servers killed (-9)", self.all_killed)
        self.fault("power cut of the hub, 3 s lost", self.hub_power)
        self.fault("power cut of a building, 3 s lost", self.building_power)
        self.fault(f"{kills} random kills", self.any_kill, kills)
        self.fault(f"{power_cuts} random power cuts", self.any_power_cut, power_cuts)

    def until_quiet(self, timeout_s=180):
        """Waits until no building has waiting messages and workers have stored everything."""
        for one in self.buildings:
            one.samples.end()
            one.stop_run()
            one.until_acknowledged(timeout_s)
        end = time.monotonic() + timeout_s
        while time.monotonic() < end:
            infos = [self.info(f"CONSUMER.INFO.{stream}.{name}") for stream, name in CONSUMERS]
            if all(info["num_pending"] == 0 and info["num_ack_pending"] == 0 for info in infos):
                return []
            time.sleep(1)
        return [f"the workers' consumers stay busy: {infos}"]

    def stored(self):
        """Number of occurrences of each key in the database."""
        events = self.postgres.ask("SELECT name || '/event/' || kind || '/' || event.id || '/' || time_us || '/' || state "
                                   "FROM event JOIN building ON building.id = event.building").split("\n")
        periods = self.postgres.ask("SELECT name || '/summary/' || period_s || '/' || start_us "
                                    "FROM summary JOIN building ON building.id = summary.building").split("\n")
        return events, periods

    def judge(self):
        """Prints the table and describes problems."""
        problems = self.until_quiet()
        self.arrivals.end()
        client = Client(self.hub.client[0], self.hub.certificates, "operator", 30)
        held = stream_keys(client, "FW_EVENT")
        events, periods = self.stored()
        acknowledged = set().union(*(one.acknowledged_keys() | one.before_cut for one in self.buildings))
        lost = acknowledged - set(events) - set(periods)
        twice = len(events) - len(set(events)) + len(periods) - len(set(periods))
        print(f"\n{'fault':<36} {'events':>7} {'lost':>5} {'stored twice':>13} {'sent again':>11} {'all, s':>7} "
              f"{'p50, s':>7} {'p99, s':>7} {'most, s':>8}")
        for what, first, last, seconds in self.rows:
            keys, again, sent = set(), 0, {}
            for one in self.buildings:
                numbers = range(first[one.name], last[one.name])
                mine = {one.event_key("gap", i, 1_700_000_000_000_000 + i, 1) for i in numbers}
                keys |= mine
                sent.update({(one.name, i): self.sent[one.name, i] for i in numbers})
            again = sum(1 for key in held if key in keys) - len(keys & set(held))
            took = self.arrivals.seconds(sent)
            p99_s, most_s = percentile(took, 0.99), took[-1]
            mine_lost, mine_twice = len(lost & keys), len([key for key in events if key in keys]) - len(keys & set(events))
            print(f"{what:<36} {len(keys):>7} {mine_lost:>5} {mine_twice:>13} {again:>11} {seconds:>7.1f} "
                  f"{percentile(took, 0.5):>7.2f} {p99_s:>7.2f} {most_s:>8.2f}")
            if what == "none" and p99_s > P99_S:
                problems.append(f"from an event to the database {p99_s:.2f} s in 99 % of cases, not {P99_S}")
            if what.startswith("leader killed") and most_s > SERVER_DIES_S:
                problems.append(f"{most_s:.1f} s to the database when a server dies, not {SERVER_DIES_S}")
        print(f"{len(acknowledged)} keys acknowledged in all, {len(acknowledged & set(periods))} of them summaries: "
              f"{len(lost)} lost, {twice} stored twice")
        for key in sorted(lost)[:10]:
            print(f"  lost: {key}{'' if key in held else ', not in the stream either'}")
        if lost or twice:
            problems.append(f"{len(lost)} acknowledged messages are lost, {twice} stored twice")
        if self.busy:
            print(f"the machine was busy beyond a load of {MOST_LOAD} a processor: times are not judged")
            problems = [one for one in problems if " to the database " not in one]
        for table in ("refused", "unknown", "flooding"):
            if count := self.postgres.number(f"SELECT count(*) FROM {table}"):
                problems.append(f"{count} rows in {table}: {self.postgres.ask(f'SELECT * FROM {table} LIMIT 1')[:300]}")
        return problems
