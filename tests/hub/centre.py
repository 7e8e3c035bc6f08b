"""What workers make of a hub: every event once in PostgreSQL, whichever worker or database is killed."""
import glob
import os
import signal
import struct
import subprocess
import time

from hub import Process
from nats_client import Client

EVENTS, BURST = 3000, 20


class Postgres:
    """A PostgreSQL of this test's own, on a Unix socket; as another user where this one is root."""

    def __init__(self, folder):
        self.bin = sorted(glob.glob("/usr/lib/postgresql/*/bin"))[-1]
        self.folder = f"/tmp/framewatch-pg-{os.getpid()}"  # a socket's name is short
        self.as_user = []
        os.makedirs(self.folder)
        if os.getuid() == 0:
            self.as_user = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups"]
            subprocess.run(["chown", "postgres", self.folder], check=True)
        self.call("initdb", "-D", f"{self.folder}/data", "-A", "trust", "-U", "fleet", "--no-sync")
        self.start()
        self.call("createdb", "-h", self.folder, "-U", "fleet", "fleet")
        self.where = f"host={self.folder} user=fleet dbname=fleet"

    def call(self, program, *arguments):
        subprocess.run([*self.as_user, f"{self.bin}/{program}", *arguments], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, cwd="/")

    def start(self):
        self.call("pg_ctl", "-D", f"{self.folder}/data", "-o", f"-k {self.folder} -c listen_addresses=''", "-l",
                  f"{self.folder}/log", "-w", "start")

    def kill(self):
        """Without a word: what is committed is on the disk."""
        self.call("pg_ctl", "-D", f"{self.folder}/data", "-m", "immediate", "stop")

    def ask(self, sql):
        done = subprocess.run([f"{self.bin}/psql", "-h", self.folder, "-U", "fleet", "-At", "-c", sql, "fleet"],
                              capture_output=True, text=True, check=False)
        return done.stdout.strip()

    def remove(self):
        self.kill()
        subprocess.run(["rm", "-rf", self.folder], check=True)


def event_fingerprint(root):
    """Of event_t: the first bytes of one in the log of every type."""
    with open(f"{root}/tests/golden/every_type.lcmlog", "rb") as file:
        log = file.read()
    at = log.index(b"FRAMEWATCH_EVENT") + len(b"FRAMEWATCH_EVENT")
    return log[at:at + 8]


def text(value):
    return struct.pack(">i", len(value) + 1) + value.encode() + b"\0"


def event(fingerprint, number):
    """An event_t, as LCM encodes it."""
    return (fingerprint + struct.pack(">qqqii", 1_700_000_000_000_000 + number, 0, number, 1, 1) + text("gap") +
            text("") + struct.pack(">dd", 1.0, 0.1) + text("") + text("it moves") + text(""))


class Workers:
    def __init__(self, hub, postgres):
        self.hub, self.postgres, self.all = hub, postgres, []

    def start(self):
        urls = [argument for url in self.hub.urls() for argument in ("--hub", url)]
        self.all.append(Process([self.hub.program, "fleet", "worker", *urls, "--dir", self.hub.certificates,
                                 "--database", self.postgres.where], f"{self.hub.folder}/worker{len(self.all)}.log"))

    def kill(self, at):
        self.all.pop(at).end(signal.SIGKILL)


def check(hub):
    """Problems, and a line on what was seen."""
    problems = []
    fingerprint = event_fingerprint(hub.root)
    postgres = Postgres(hub.folder)
    workers = Workers(hub, postgres)
    try:
        hub.enroll("c1")
        workers.start()
        workers.start()
        building = Client(hub.client[0], hub.certificates, "c1")
        begin = time.monotonic()
        for number in range(EVENTS):
            key = {"Nats-Msg-Id": f"c1/event/gap/{number}/{1_700_000_000_000_000 + number}/1", "Fw-Type": "event_t"}
            building.publish("fw.up.c1.event", event(fingerprint, number), key)
            if number == EVENTS // 3:
                workers.kill(0)
                workers.start()
            if number == 2 * EVENTS // 3:
                postgres.kill()
                time.sleep(3)
                postgres.start()
            if number % BURST == 0:
                time.sleep(0.05)
        building.publish("fw.up.c1.event", b"nonsense of a newer one", {"Nats-Msg-Id": "c1/event/x/1/1/1", "Fw-Type": "event_t"})
        building.publish("fw.up.c1.event", event(fingerprint, 1), {"Nats-Msg-Id": "c2/event/x/1/1/1", "Fw-Type": "event_t"})
        building.round_trip()
        sent_s = time.monotonic() - begin
        while time.monotonic() - begin < 180:
            if postgres.ask("SELECT count(*) FROM event") == str(EVENTS) and \
                    int(postgres.ask("SELECT count(*) FROM refused") or 0) >= 1 and \
                    int(postgres.ask("SELECT count(*) FROM unknown") or 0) >= 1:
                break
            time.sleep(0.3)
        stored = postgres.ask("SELECT count(*), count(DISTINCT id) FROM event")
        print(f"  {EVENTS} events in {sent_s:.0f} s, a worker and the database killed: {stored} stored, all after "
              f"{time.monotonic() - begin - sent_s:.1f} s more")
        if stored != f"{EVENTS}|{EVENTS}":
            problems.append(f"{stored} of {EVENTS} events are in the database")
        if int(postgres.ask("SELECT count(*) FROM flooding") or 0) != 0:
            problems.append("what came again is taken for a flood")
        reasons = postgres.ask("SELECT DISTINCT reason FROM refused ORDER BY 1")
        if "its key names c2" not in reasons:
            problems.append(f"a forged key was not refused: {reasons}")
        late = []
        for number in range(20):
            start = time.monotonic()
            key = {"Nats-Msg-Id": f"c1/event/gap/{EVENTS + number}/{1_700_000_000_000_000 + EVENTS + number}/1",
                   "Fw-Type": "event_t"}
            building.publish("fw.up.c1.event", event(fingerprint, EVENTS + number), key)
            building.round_trip()
            while postgres.ask(f"SELECT 1 FROM event WHERE id = {EVENTS + number}") != "1":
                if time.monotonic() - start > 30:
                    problems.append("an event is not in the database after 30 s")
                    break
                time.sleep(0.02)
            late.append(time.monotonic() - start)
        late.sort()
        print(f"  from an event to the database: {late[len(late) // 2]:.2f} s in the median, {late[-1]:.2f} s at most")
    finally:
        postgres.remove()
    return problems
