#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""demo.py PROGRAM [--seconds S] [--speed N] [--port N] [--keep DIR]: runs a hub of three servers, PostgreSQL
and six virtual buildings with a real `run` and `uplink` each. In one earthquake, one building loses 15 % of a frame. The
overview is in the browser. Ends by itself with a table of results. Exit status: 0 the hub finds the loss and no other,
1 it does not, 2 something is not installed."""
import argparse
import asyncio
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(f"{HERE}/../..")
sys.path.insert(0, HERE)
import database_server  # noqa: E402
from building import at_hub  # noqa: E402
from hub import Hub, Process, free_ports  # noqa: E402
from page import Page  # noqa: E402
from proxy import join  # noqa: E402

BUILDINGS = [("kobe-01", "Harbor tower", "Kobe", 34.682, 135.187), ("kobe-02", "City hall", "Kobe", 34.690, 135.195),
             ("kobe-03", "Hospital", "Kobe", 34.701, 135.212), ("osaka-01", "Station block", "Osaka", 34.702, 135.495),
             ("osaka-02", "School", "Osaka", 34.674, 135.501), ("kyoto-01", "Library", "Kyoto", 35.003, 135.768)]
DAMAGED, PARAMETER, FACTOR = "kobe-03", "kx_1_y2", 0.85
QUAKE_S, LOSS_S = 150, 153  # sensor time since the beginning
RATE = 100
WAIT_S = 150  # at most, for the last minutes


def missing():
    for command, package in (("nats-server", "nats-server"), ("openssl", "openssl")):
        if not shutil.which(command):
            return f"no {command} (Debian package {package})"
    if not database_server.is_there():
        return "no PostgreSQL (Debian package postgresql)"
    return ""


def ground(path, seconds, seed):
    """Weak motion all the time, strong for some seconds: noise through the soil's resonance at 4 Hz."""
    chance = random.Random(seed)
    w, zeta, dt = 2 * math.pi * 4, 0.6, 1 / RATE
    speed = shift = 0.0
    with open(path, "w") as file:
        file.write("time_s,ground\n")
        for i in range(int(seconds * RATE)):
            t = i * dt
            size = 0.2 + 0.6 * math.exp(-((t - QUAKE_S - 6) / 4) ** 2)
            force = chance.gauss(0, 1) * size * w
            speed += dt * (force - 2 * zeta * w * speed - w * w * shift)
            shift += dt * speed
            file.write(f"{t:.2f},{w * shift + 2 * zeta * speed:.5f}\n")


class Building:
    def __init__(self, hub, name, number, seconds, speed):
        self.hub, self.name = hub, name
        self.folder = f"{hub.folder}/{name}"
        os.makedirs(f"{self.folder}/history")
        hub.enroll(name)
        (port,) = free_ports(1)
        with open(f"{ROOT}/configs/table_two_story.toml") as file:
            text = file.read().replace("hop_s = 0.01", "hop_s = 0.1")
        with open(f"{self.folder}/building.toml", "w") as file:
            file.write(f'{text}\n[lcm]\nurl = "udpm://239.255.76.67:{port}?ttl=0"\n[commands]\ndirectory = "."\n[history]\n'
                       f'directory = "history"\n[watch]\nlearn_s = 30\n[event_report]\ndirectory = "reports"\n'
                       f'trigger_mps2 = 0.7\nquiet_s = 10\nyellow_drift_ratio = 0.02\nred_drift_ratio = 0.03\n{at_hub(hub, name)}')
        with open(f"{ROOT}/configs/scenario_table_two_story.toml") as file:
            text = file.read()
        begin, end = text.index("[motion]"), text.index("[sensors]")
        change = f'\n[[change]]\nat_s = {LOSS_S}\nparameter = "{PARAMETER}"\nfactor = {FACTOR}\n' if name == DAMAGED else ""
        with open(f"{self.folder}/scenario.toml", "w") as file:
            file.write(text[:begin].replace("table_two_story.toml", "building.toml").replace("2019", str(2019 + number)) +
                       '[motion]\nfile = "ground.csv"\nangle_deg = 30.0\n' + text[end:] + change)
        ground(f"{self.folder}/ground.csv", seconds, number)
        self.seconds, self.speed = seconds, speed

    def start(self):
        log = f"{self.folder}/log"
        Process([self.hub.program, "run", f"{self.folder}/building.toml", "--quiet"], log)
        Process([self.hub.program, "uplink", f"{self.folder}/building.toml", "--quiet"], log)

    def shake(self):
        self.simulation = Process([self.hub.program, "simulate", f"{self.folder}/scenario.toml", "--lcm", "--speed",
                                   str(self.speed), "--seconds", str(self.seconds), "--quiet"], f"{self.folder}/log")


def say(text=""):
    print(text, flush=True)


def inside(a, postgres):
    """Runs everything except the browser in a network namespace."""
    folder, program = a.inside, os.path.abspath(a.program)
    say("a hub of three servers, PostgreSQL, a worker, the page ...")
    hub = Hub(ROOT, program, folder)
    hub.start()
    hub.wait()
    urls = [argument for url in hub.urls() for argument in ("--hub", url)]
    for left in (4, 3, 2, 1, 0):  # servers of a busy machine may need longer than the time limit
        if hub.fleet("setup", *urls, "--buildings", "10", good=(0, 2) if left else (0,)).returncode == 0:
            break
    more = [*urls, "--dir", hub.certificates, "--database", postgres.where]
    for name, title, place, north, east in BUILDINGS:
        subprocess.run([program, "fleet", "describe", name, "--database", postgres.where, "--title", title, "--place", place,
                        "--latitude", str(north), "--longitude", str(east)], stdout=subprocess.DEVNULL, check=True)
    page = Page(hub, postgres)
    token = page.person("you", "operator")
    Process([program, "fleet", "worker", *more, "--quiet"], f"{folder}/worker.log")
    page.start()

    async def forward():
        server = await asyncio.start_unix_server(
            lambda r, w: join(r, w, asyncio.open_connection("127.0.0.1", page.port)), f"{folder}/page")
        await server.serve_forever()

    threading.Thread(target=lambda: asyncio.run(forward()), daemon=True).start()
    say("six buildings: framewatch run and framewatch uplink in each ...")
    buildings = [Building(hub, name, i, a.seconds, a.speed) for i, (name, *_) in enumerate(BUILDINGS)]
    for one in buildings:
        one.start()
    time.sleep(2)
    for one in buildings:
        one.shake()
    begin, host_us = time.monotonic(), time.time() * 1e6
    say(f"\n  Open http://127.0.0.1:{a.port}/?token={token}\n")
    say(f"The ground moves weakly. After {QUAKE_S / a.speed:.0f} s there is an earthquake, and the hospital in Kobe loses 15 % of "
        f"one frame\n({PARAMETER}); the hub is not told. Time runs {a.speed:g} times as fast as a clock.")
    return watch(a, lambda *words: page.ask(token, *words), begin, host_us)


def watch(a, ask, begin, host_us):
    seen, told, asked = {}, False, False
    quake_us = None
    while (now := (time.monotonic() - begin) * a.speed) < a.seconds + 12 * a.speed:
        time.sleep(0.5)
        if not told and now > QUAKE_S:
            told = True
            say(f"{now / a.speed:4.0f} s  earthquake")
        for one in (ask("overview.json") or {}).get("buildings", []):
            word = one["urgency"]
            if seen.get(one["name"], (0, "well"))[1] != word:
                seen[one["name"]] = (now, word)
                say(f"{now / a.speed:4.0f} s  {one['name']}: {word}{': ' + one['message'] if one['message'] else ''}")
        if told and quake_us is None and now > QUAKE_S + 30:
            quakes = ask("earthquakes.json?days=2") or []
            if quakes:
                quake_us = quakes[0]["time_us"]
                say(f"{now / a.speed:4.0f} s  {quakes[0]['buildings']} buildings shook together; the hub requests minutes from all")
                ask(f"command?building=all&verb=minutes&from_us={quake_us - 600_000_000}&to_us="
                         f"{quake_us + 3_600_000_000}", "POST")
                asked = True
    if not asked:
        say("the hub found no earthquake; using the time of the scenario")
        quake_us = int(host_us + QUAKE_S * 1e6)
    return table(ask, quake_us, seen)


def table(ask, quake_us, seen):
    for _ in range(WAIT_S):  # a busy machine is behind its clock
        result = ask(f"earthquake.json?time_us={quake_us}")
        if result and all(one.get("compared") for one in result.get("buildings", [{}])):
            break
        time.sleep(1)
    journal = ask("journal.json") or []
    if not result or "buildings" not in result:
        say("the page does not answer")
        return 1
    say(f"\n{'building':10} {'true loss':18} {'largest loss found':34} {'compared':>8}  overview")
    for one in result["buildings"]:
        worst = one.get("worst")
        loss = "no estimates from that time"
        if one["result"] == "loss":
            loss = f"{worst['parameter']} {100 * worst['ratio']:+.1f} % +- {100 * worst['std_error']:.2f} %"
        elif one["result"] == "none":
            loss = "no significant loss"
        elif one["result"] == "not_observable":
            loss = "not observable"
        truth = f"{PARAMETER} {100 * (FACTOR - 1):+.0f} %" if one["name"] == DAMAGED else "none"
        say(f"{one['name']:10} {truth:18} {loss:34} {one['compared']:8}  {seen.get(one['name'], (0, 'well'))[1]}")
    if journal:
        say(f"command minutes to {journal[-1]['buildings']} buildings: {journal[-1]['done']} carried out")
    first = result["buildings"][0]
    good = (first["name"] == DAMAGED and first["result"] == "loss" and first["worst"]["parameter"] == PARAMETER and
            all(one["result"] == "none" for one in result["buildings"][1:]))
    say("Result: the damaged building is first, and no other shows damage." if good else
        "WRONG RESULT: the damaged building should be first, and no other should show damage.")
    return 0 if good else 1


def keep(folder, target):
    """Configurations, histories and logs."""
    for name in ["worker.log", "serve.log", "hub1.log", *(f"{one[0]}/{file}" for one in BUILDINGS for file in (
            "log", "building.toml", "scenario.toml", "ground.csv", "history/history.sqlite", "history/history.sqlite-wal",
            "history/uplink.sqlite", "history/uplink.sqlite-wal"))]:
        if os.path.exists(f"{folder}/{name}"):
            os.makedirs(os.path.dirname(f"{target}/{name}"), exist_ok=True)
            shutil.copy(f"{folder}/{name}", f"{target}/{name}")


def outside(a):
    """Forwards the page's port to a browser outside of the buildings' network."""
    folder = tempfile.mkdtemp(prefix="fw-demo-")
    child = subprocess.Popen([f"{HERE}/../support/private-network", sys.executable, os.path.abspath(__file__), a.program,
                              "--inside", folder, "--port", str(a.port), "--seconds", str(a.seconds), "--speed",
                              str(a.speed)])

    async def serve():
        server = await asyncio.start_server(
            lambda r, w: join(r, w, asyncio.open_unix_connection(f"{folder}/page")), "127.0.0.1", a.port)
        async with server:
            while child.poll() is None:
                await asyncio.sleep(0.2)

    try:
        asyncio.run(serve())
    except OSError as error:
        print(f"demo --fleet: port {a.port}: {error.strerror} (--port)", file=sys.stderr)
        child.terminate()
        child.wait()
        return 2
    except KeyboardInterrupt:
        child.wait()
    finally:
        if child.poll() is None:
            child.terminate()
            child.wait()
        if a.keep:
            keep(folder, a.keep)
        shutil.rmtree(folder, ignore_errors=True)
    return child.returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=int, default=520, help="duration in sensor time")
    parser.add_argument("--speed", type=float, default=3, help="sensor time over clock time")
    parser.add_argument("--port", type=int, default=8090, help="port of the page")
    parser.add_argument("--keep", help="folder for logs and configurations")
    parser.add_argument("--inside", help=argparse.SUPPRESS)
    a = parser.parse_args()
    if why := missing():
        print(f"demo --fleet: {why}: install it with deploy/install-deps --with fleet", file=sys.stderr)
        return 2
    if not os.path.exists(f"{os.path.dirname(os.path.abspath(a.program))}/framewatch-fleet"):
        print("demo --fleet: framewatch-fleet is not built: run deploy/install-deps --with fleet and build again", file=sys.stderr)
        return 2
    if not a.inside:
        return outside(a)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(2))
    postgres = database_server.Postgres()
    try:
        return inside(a, postgres)
    except KeyboardInterrupt:
        return 2
    finally:
        Process.end_all()
        postgres.remove()


sys.exit(main())
