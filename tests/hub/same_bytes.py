"""`framewatch run` gives the same bytes with a hub, without one, and beside an uplink that is killed again and again."""
import hashlib
import os
import signal
import struct
import subprocess
import time

from hub import Building, Process

SECONDS, SPEED = 20, 2


def messages(path, wanted):
    """Digest and number of the payloads of a channel in an LCM event log."""
    digest, count = hashlib.sha256(), 0
    with open(path, "rb") as file:
        while len(head := file.read(28)) == 28:
            _, _, _, name_size, size = struct.unpack(">IqqII", head)
            name, data = file.read(name_size).decode(), file.read(size)
            if name == wanted:
                digest.update(data)
                count += 1
    return digest.hexdigest(), count


def one_run(hub, name, uplink, kills):
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
    return messages(building_log, "FRAMEWATCH_ESTIMATE")


def check(hub):
    scenario = f"{hub.root}/configs/scenario_table_two_story.toml"
    samples = f"{hub.folder}/samples.lcmlog"
    subprocess.run([hub.program, "simulate", scenario, "--seconds", str(SECONDS), "--out", samples, "--quiet"], check=True)
    assert os.path.getsize(samples) > 0
    hub.enroll("b52")
    hub.enroll("b53")
    without = one_run(hub, "b51", False, 0)
    print(f"  without an uplink: {without[1]} estimates, {without[0][:16]}")
    found = [one_run(hub, "b52", True, 0), one_run(hub, "b53", True, 5)]
    for what, (digest, count) in zip(("with hub and uplink", "with an uplink that is killed 5 times"), found):
        print(f"  {what}: {count} estimates, {digest[:16]}")
    if without[1] == 0:
        return ["there are no estimates"]
    return [] if all(one == without for one in found) else ["the estimates differ"]
