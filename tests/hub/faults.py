"""Faults of hub, line and building, one after the other; afterwards everything must be at the hub, once."""
import json
import os
import random
import shutil
import signal
import sys
import time

from hub import Building, Process, free_ports
from nats_client import Client, stream_keys

BEFORE_S, EVERY_S, EACH = 2, 0.25, 20


class Faults:
    def __init__(self, hub, operator):
        self.hub, self.operator, self.rows = hub, operator, []

    def building(self, name, ports=None):
        self.hub.enroll(name)
        one = Building(self.hub, name, ports)
        one.start()
        return one

    def feed(self, one, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            one.add_events(EACH)
            time.sleep(EVERY_S)

    def fault(self, number, what, act):
        """act(building) does the harm and mends it; then all must be acknowledged."""
        one = self.building(f"b{number}")
        self.feed(one, BEFORE_S)
        act(one)
        self.feed(one, BEFORE_S)
        seconds = one.until_acknowledged()
        one.stop()
        self.rows.append((what, one, seconds))
        print(f"  {what}: all acknowledged {seconds:.1f} s after the last", flush=True)

    def leader(self):
        return int(self.info("FW_EVENT")["cluster"]["leader"][-1]) - 1

    def info(self, stream):
        for _ in range(60):
            try:
                client = Client(self.hub.client[random.randrange(3)], self.hub.certificates, "operator", 3)
                answer = json.loads(client.request(f"$JS.API.STREAM.INFO.{stream}") or b"{}")
                if "cluster" in answer and "leader" in answer["cluster"]:
                    return answer
            except (OSError, RuntimeError, Exception):  # noqa: BLE001: a server that is just gone
                pass
            time.sleep(0.5)
        raise RuntimeError(f"{stream} has no leader")

    def leader_killed(self, one):
        server = self.leader()
        self.hub.kill(server)
        self.feed(one, 8)
        self.hub.start(server)
        self.hub.wait()

    def leader_frozen(self, one):
        server = self.hub.servers[self.leader()]
        server.tell(signal.SIGSTOP)
        self.feed(one, 10)
        server.tell(signal.SIGCONT)
        self.hub.wait()

    def uplink_killed(self, one):
        for _ in range(5):
            self.feed(one, random.uniform(0.2, 1))
            one.stop(signal.SIGKILL)
            one.start()

    def all_killed(self, one):
        self.hub.kill()
        self.feed(one, 3)
        self.hub.start()
        self.hub.wait()

    def hub_power(self, one):
        self.hub.copy_stores()
        self.feed(one, 3)
        self.hub.kill()
        self.hub.put_back_stores()
        self.hub.start()
        self.hub.wait()

    def building_power(self, one):
        """The outbox is as it was some seconds before."""
        old = f"{one.folder}/old"
        files = ("uplink.sqlite", "uplink.sqlite-wal")
        os.makedirs(old, exist_ok=True)
        one.stop(signal.SIGKILL)
        for name in files:
            if os.path.exists(f"{one.folder}/history/{name}"):
                shutil.copy(f"{one.folder}/history/{name}", old)
        one.start()
        self.feed(one, 3)
        one.stop(signal.SIGKILL)
        for name in (*files, "uplink.sqlite-shm"):
            if os.path.exists(f"{one.folder}/history/{name}"):
                os.remove(f"{one.folder}/history/{name}")
            if os.path.exists(f"{old}/{name}"):
                shutil.copy(f"{old}/{name}", f"{one.folder}/history")
        one.start()

    def dead_line(self, number, seconds):
        listen = free_ports(3)
        pairs = [f"{a}:{b}" for a, b in zip(listen, self.hub.client)]
        proxy = Process([sys.executable, f"{os.path.dirname(__file__)}/proxy.py", *pairs], f"{self.hub.folder}/proxy.log")
        time.sleep(0.5)
        one = self.building(f"b{number}", listen)
        self.feed(one, BEFORE_S)
        proxy.tell(signal.SIGSTOP)
        self.feed(one, seconds)
        proxy.tell(signal.SIGCONT)
        took = one.until_acknowledged()
        one.stop()
        proxy.end()
        self.rows.append((f"line dead {seconds} s, silently", one, took))

    def random_kills(self, number, kills, chance):
        one = self.building(f"b{number}")
        for _ in range(kills):
            self.feed(one, chance.uniform(0.2, 1.5))
            if chance.random() < 0.6:
                one.stop(signal.SIGKILL)
                one.start()
            else:
                server = chance.randrange(3)
                self.hub.kill(server)
                self.feed(one, chance.uniform(0.2, 1.5))
                self.hub.start(server)
                self.hub.wait()
        took = one.until_acknowledged(300)
        one.stop()
        self.rows.append((f"{kills} random kills", one, took))

    def random_power_cuts(self, number, cuts, chance):
        one = self.building(f"b{number}")
        for _ in range(cuts):
            self.feed(one, chance.uniform(0.5, 2))
            (self.hub_power if chance.random() < 0.5 else self.building_power)(one)
        took = one.until_acknowledged(300)
        one.stop()
        self.rows.append((f"{cuts} random power cuts", one, took))

    def judge(self):
        """Prints the table; how many messages are lost."""
        client = Client(self.hub.client[0], self.hub.certificates, "operator", 30)
        held = stream_keys(client, "FW_EVENT")
        there = set(held)
        print(f"\n{'fault':<32} {'events':>7} {'lost':>5} {'in the stream twice':>20} {'seconds':>8}")
        lost_in_all = 0
        for what, one, seconds in self.rows:
            keys = one.keys()
            lost = len(keys - there)
            again = sum(1 for key in held if key in keys) - len(keys & there)
            lost_in_all += lost
            print(f"{what:<32} {len(keys):>7} {lost:>5} {again:>20} {seconds:>8.1f}")
        print("what is in the stream twice has one key, and the database takes a key once")
        return lost_in_all
