# SPDX-License-Identifier: MIT
"""`framewatch run` gives the same bytes with a hub, without one, and beside an uplink that is repeatedly killed."""
import os
import shutil
import signal
import struct
import time

from building import Building, simulated_samples
from hub import Process

SECONDS, SPEED = 20, 1
LEAST, TRIES = 500, 3  # estimates that two runs must share; a busy machine loses datagrams


def estimates(path):
    """The payload of every estimate in an LCM event log, by the end of its window."""
    found = {}
    with open(path, "rb") as file:
        while len(head := file.read(28)) == 28:
            _, _, _, name_size, size = struct.unpack(">IqqII", head)
            name, data = file.read(name_size).decode(), file.read(size)
            if name == "FRAMEWATCH_ESTIMATE":
                found[struct.unpack(">q", data[16:24])[0]] = data
    return found


def one_run(hub, name, uplink, kills):
    shutil.rmtree(f"{hub.folder}/{name}", ignore_errors=True)
    building = Building(hub, name, history=False)
    building_log = f"{building.folder}/out.lcmlog"
    logger = Process(["lcm-logger", "--quiet", f"--lcm-url={building.url}", "--channel=FRAMEWATCH_ESTIMATE",
                      building_log], f"{building.folder}/logger.log")
    run = Process([hub.program, "run", building.config, "--quiet"], f"{building.folder}/run.log")
    if uplink:
        building.start()
    time.sleep(2)
    player = Process(["lcm-logplayer", f"--speed={SPEED}", f"--lcm-url={building.url}", f"{hub.folder}/samples.lcmlog"],
                     f"{building.folder}/player.log")
    for _ in range(kills):
        time.sleep(SECONDS / SPEED / (kills + 1))
        building.stop(signal.SIGKILL)
        building.start()
    player.child.wait(120)
    time.sleep(2)
    run.end(signal.SIGINT)
    logger.end(signal.SIGINT)
    if uplink:
        building.stop()
    return estimates(building_log)


def check(hub):
    samples = f"{hub.folder}/samples.lcmlog"
    simulated_samples(hub, SECONDS, samples)
    assert os.path.getsize(samples) > 0
    for name in ("b52", "b53"):
        hub.enroll(name)
    for _ in range(TRIES):
        without = one_run(hub, "b51", False, 0)
        problems = []
        for what, name, kills in (("with hub and uplink", "b52", 0), ("with an uplink that is killed 5 times", "b53", 5)):
            found = one_run(hub, name, True, kills)
            both = without.keys() & found.keys()
            same = sum(without[end] == found[end] for end in both)
            print(f"  {what}: {same} of {len(both)} estimates have the same bytes")
            if len(both) < LEAST or same < len(both):
                problems.append(f"{what}: {len(both) - same} of {len(both)} estimates differ")
        if not problems:
            break
    return problems
