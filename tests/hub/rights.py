# SPDX-License-Identifier: MIT
"""Rights of a building's certificate at a real server."""
import base64
import json
import subprocess
import time

import lcm_event
from nats_client import Client, Denied

SOON_S = 15  # a request without an answer takes 30 s
DENIED = "Permissions Violation"


def denied(client, act):
    client.errors.clear()
    act(client)
    client.round_trip()
    return any(DENIED in error for error in client.errors)


def check(hub, one):
    """Returns a list of problems. `one` is a building with a running uplink; b1 and b2 are enrolled."""
    problems = []

    def must(good, what):
        print(f"  {'yes' if good else 'NO '}  {what}")
        if not good:
            problems.append(what)

    thief = Client(hub.client[0], hub.certificates, "b1")
    must(not denied(thief, lambda c: c.publish("fw.up.b1.event", b"x", {"Nats-Msg-Id": "b1/event/x/1/1/1"})),
         "a building writes its own")
    for what, act in (
            ("writing another's event", lambda c: c.publish("fw.up.b2.event", b"x")),
            ("writing as the page", lambda c: c.publish("framewatch.b1", b"x")),
            ("commanding another", lambda c: c.publish("fw.down.b2.acknowledge", b"x")),
            ("commanding all", lambda c: c.publish("fw.down.all.minutes", b"x")),
            ("asking for a stream's content", lambda c: c.publish("$JS.API.STREAM.MSG.GET.FW_EVENT", b'{"seq":1}')),
            ("deleting a stream", lambda c: c.publish("$JS.API.STREAM.DELETE.FW_EVENT", b"")),
            ("reading another's events", lambda c: c.subscribe("fw.up.b2.>")),
            ("reading everything", lambda c: c.subscribe(">")),
            ("reading another's answers", lambda c: c.subscribe("_INBOX_b2.>")),
            ("hearing another's commands", lambda c: c.subscribe("fw.down.b2.>")),
            ("reading every building's events", lambda c: c.subscribe("fw.up.*.event")),
            ("hearing everybody's commands", lambda c: c.subscribe("fw.down.*.raw")),
            ("answering for another", lambda c: c.publish("_INBOX_b2.x.1", b'{"stream":"FW_EVENT","seq":1}')),
            ("answering the page", lambda c: c.publish("_INBOX_page.x.1", b'{"ok":true}')),
            ("reading another's newest", lambda c: c.publish("$JS.API.DIRECT.GET.FW_LAST.fw.up.b2.service", b"")),
            ("making a consumer", lambda c: c.publish("$JS.API.CONSUMER.CREATE.FW_EVENT", b"{}")),
            ("taking what workers are to take", lambda c: c.publish("$JS.API.CONSUMER.MSG.NEXT.FW_EVENT.store", b"")),
            ("acknowledging for a worker", lambda c: c.publish("$JS.ACK.FW_EVENT.store.1.1.1.1.1", b"")),
            ("purging a stream", lambda c: c.publish("$JS.API.STREAM.PURGE.FW_EVENT", b"")),
            ("the server's own subjects", lambda c: c.publish("$SYS.REQ.SERVER.PING", b""))):
        must(denied(thief, act), f"{what} is refused")
    must(not steals_keys(hub, thief, one), "a stolen key does not suppress the other building's message")
    worker = Client(hub.client[0], hub.certificates, "worker")
    must(denied(worker, lambda c: c.publish("fw.down.b1.raw", b"x")), "the worker may command only resend")

    page = Client(hub.client[1], hub.certificates, "page")

    def command(building, verb, text, request, until_s=60):
        return page.request(f"fw.down.{building}.{verb}", text,
                            {"Fw-Who": "Ada", "Fw-Request": request, "Fw-Until": int(time.time()) + until_s})

    must(command(one.name, "ping", b"", "p1") == b'{"ok":true}', "the page's ping is answered")
    begin = time.monotonic()
    gone = command("b99", "ping", b"", "p2")
    must(not gone and time.monotonic() - begin < SOON_S, "the page learns at once that a building is away")
    stretch = json.dumps({"from_us": 0, "to_us": 1}).encode()
    must(command(one.name, "resend", stretch, "r1") == b'{"ok":true}', "the page's resend is obeyed")
    must(b'"ok":false' in (command(one.name, "resend", stretch, "r2", -5) or b""), "a late command is refused")
    must(b'"ok":false' in (command(one.name, "raw", stretch, "../x") or b""), "a malformed request name is refused")
    must(b'"ok":false' in (command(one.name, "reboot", b"", "r4") or b""), "an unknown command is refused")
    return problems


def steals_keys(hub, thief, one):
    """The hub takes a second message with the same Nats-Msg-Id for a repetition, whoever sent the first. A thief that sends
    the key of a future event could thus have that event acknowledged and dropped."""
    kind, number, time_us, state = lcm_event.event(one.events)[:4]
    key = one.event_key(kind, number, time_us, state)
    thief.publish(f"fw.up.{thief.name}.event", b"x", {"Nats-Msg-Id": key})
    thief.round_trip()
    one.add_events(1)
    one.until_acknowledged()
    operator = Client(hub.client[0], hub.certificates, "operator", 30)
    answer = json.loads(operator.request("$JS.API.STREAM.MSG.GET.FW_EVENT",
                                         json.dumps({"last_by_subj": f"fw.up.{one.name}.event"}).encode(), timeout_s=30))
    return key not in base64.b64decode(answer["message"]["hdrs"]).decode()


def revoke(hub, one):
    """Seconds until a revoked building is disconnected, and problems."""
    held = Client(hub.client[0], hub.certificates, one.name)
    begin = time.monotonic()
    hub.fleet("revoke", one.name, *hub.pid_files())
    try:
        held.until(lambda: False, 30)
        return 30, ["a revoked building stays connected"]
    except Denied:
        seconds = time.monotonic() - begin
    try:
        Client(hub.client[0], hub.certificates, one.name)
        return seconds, ["a revoked building is accepted"]
    except (Denied, OSError):
        return seconds, []


def strangers(hub):
    """Tries a certificate of another authority, and a client without one."""
    other = f"{hub.folder}/other"
    subprocess.run(["mkdir", "-p", other], check=True)
    subprocess.run([hub.program, "fleet", "authority", "--dir", other], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cp", f"{hub.certificates}/ca.pem", other], check=True)
    try:
        Client(hub.client[0], other, "operator")
        return ["a certificate of another authority is accepted"]
    except (Denied, OSError):
        return []
