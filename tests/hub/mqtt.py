# SPDX-License-Identifier: MIT
"""Building automation receives the state of the hub's buildings over MQTT from the real nats-server, and can send nothing."""
import json
import subprocess
import time

from hub import free_ports
from nats_client import Client

USER, PASSWORD = "bms", "a-password-of-this-test"


def newest_of(root, channel):
    """A message from the log of every type."""
    with open(f"{root}/tests/golden/every_type.lcmlog", "rb") as file:
        log = file.read()
    at = 0
    while at < len(log):
        name, size = (int.from_bytes(log[at + k:at + k + 4], "big") for k in (20, 24))
        if log[at + 28:at + 28 + name] == channel:
            return log[at + 28 + name:at + 28 + name + size]
        at += 28 + name + size
    raise RuntimeError(f"no {channel}")


def configure(hub):
    """Prepares the files of deploy/fleet for the first server, and one user. Returns the port."""
    (port,) = free_ports(1)
    with open(f"{hub.root}/deploy/fleet/mqtt.conf") as file:
        text = file.read().replace("0.0.0.0:8883", f"127.0.0.1:{port}").replace("/etc/framewatch-hub/", f"{hub.certificates}/")
    with open(f"{hub.certificates}/mqtt.conf", "w") as file:
        file.write(text)
    with open(f"{hub.certificates}/hub1.conf", "a") as file:
        file.write('include "mqtt.conf"\n')
    with open(f"{hub.root}/deploy/fleet/mqtt-users.conf") as file:
        text = file.read().replace("# { user", "{ user").replace("SECRET", PASSWORD)
    with open(f"{hub.certificates}/mqtt-users.conf", "w") as file:
        file.write(text)
    return port


def mosquitto(hub, port, program, topic, *more, password=PASSWORD):
    return subprocess.run([program, "-h", "localhost", "-p", str(port), "--cafile", f"{hub.certificates}/ca.pem", "-u", USER,
                           "-P", password, "-q", "1", "-t", topic, *more], capture_output=True, text=True, check=False,
                          timeout=120)


def check(hub, port, postgres):
    """Needs a running worker. Returns a list of problems."""
    problems = []
    hub.enroll("kobe")
    for _ in range(15):  # JetStream of an account may start after the server
        listener = subprocess.Popen(["mosquitto_sub", "-h", "localhost", "-p", str(port), "--cafile",
                                     f"{hub.certificates}/ca.pem", "-u", USER, "-P", PASSWORD, "-q", "1", "-v", "-t",
                                     "framewatch/#", "-W", "30"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(3)
        if listener.poll() is None:
            break
    building = Client(hub.client[0], hub.certificates, "kobe")
    event = newest_of(hub.root, b"FRAMEWATCH_EVENT")
    for kind, type_, content in (("service", "service_t", newest_of(hub.root, b"FRAMEWATCH_SERVICE")),
                                 ("event", "event_t", event)):
        key = f"kobe/{kind}/1" if kind == "service" else event_key(event)
        building.publish(f"fw.up.kobe.{kind}", content, {"Nats-Msg-Id": key, "Fw-Type": type_})
    building.round_trip()
    heard, trouble = listener.communicate(timeout=120)
    topics, times = {}, {}
    for line in heard.splitlines():
        topic, text = line.split(" ", 1)
        times[topic] = times.get(topic, 0) + 1
        topics[topic] = json.loads(text)
    print(f"  received over MQTT, number of messages: {times or 'nothing'} {trouble.strip()}")
    if topics.get("framewatch/kobe/state", {}).get("schema") != "framewatch.state/1":
        problems.append(f"no state of the building came over MQTT: {heard}{trouble}")
    if topics.get("framewatch/kobe/event", {}).get("schema") != "framewatch.event/1":
        problems.append("no event came over MQTT")
    if mosquitto(hub, port, "mosquitto_sub", "framewatch/#", "-C", "1", "-W", "3", password="wrong").returncode in (0, 27):
        problems.append("a wrong password is accepted")
    # A forbidden message is dropped or ends the connection: nobody may receive it.
    spy = subprocess.Popen(["mosquitto_sub", "-h", "localhost", "-p", str(port), "--cafile", f"{hub.certificates}/ca.pem", "-u",
                            USER, "-P", PASSWORD, "-t", "framewatch/kobe/forged", "-C", "1", "-W", "5"],
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(2)
    mosquitto(hub, port, "mosquitto_pub", "framewatch/kobe/forged", "-m", "it burns")
    mosquitto(hub, port, "mosquitto_pub", "fw/up/kobe/event", "-m", "it burns")
    forged, _ = spy.communicate(timeout=60)
    if "burns" in forged:
        problems.append("building automation can send to other clients")
    foreign = mosquitto(hub, port, "mosquitto_sub", "fw/#", "-C", "1", "-W", "4")
    if foreign.stdout:
        problems.append("building automation receives messages of buildings to the hub")
    refused = postgres.ask("SELECT count(*) FROM refused")
    print(f"  messages sent over MQTT reached nobody ({refused} messages refused by the worker)")
    if refused != "0":
        problems.append("a message sent over MQTT reached the worker")
    return problems


def event_key(event):
    """Fields of an event_t: time_us, since_us, id, state, severity, kind."""
    time_us, _, number = (int.from_bytes(event[8 + 8 * i:16 + 8 * i], "big", signed=True) for i in range(3))
    state = int.from_bytes(event[32:36], "big", signed=True)
    size = int.from_bytes(event[40:44], "big")
    return f"kobe/event/{event[44:44 + size - 1].decode()}/{number}/{time_us}/{state}"

