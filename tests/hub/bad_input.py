# SPDX-License-Identifier: MIT
"""Bad input to a hub and its workers: malformed messages, floods, clocks that jump, a full hub, expired certificates."""
import json
import os
import shutil
import subprocess
import time

import lcm_event
from building import Building
from nats_client import Client

FLOOD, BEYOND = 20_000, 300  # limit of messages an hour from a building (docs/fleet.md), and the number sent beyond it
PATIENCE_S = 120


def until(done, seconds=PATIENCE_S):
    end = time.monotonic() + seconds
    while not done():
        if time.monotonic() > end:
            return False
        time.sleep(0.2)
    return True


class BadInput:
    def __init__(self, hub, postgres, workers):
        self.hub, self.postgres, self.workers, self.problems = hub, postgres, workers, []
        self.fingerprint = lcm_event.fingerprint(hub.root)

    def must(self, good, what):
        print(f"  {'yes' if good else 'NO '}  {what}", flush=True)
        if not good:
            self.problems.append(what)

    def publish(self, client, name, row, key=None, content=None):
        kind, number, time_us, state = row[:4]
        client.publish(f"fw.up.{name}.event", content or lcm_event.encoded(self.fingerprint, row),
                       {"Nats-Msg-Id": key or f"{name}/event/{kind}/{number}/{time_us}/{state}", "Fw-Type": "event_t"})

    def events_of(self, name):
        return self.postgres.number(f"SELECT count(*) FROM event JOIN building ON building.id = building "
                                    f"WHERE name = '{name}'")

    def reasons(self):
        return self.postgres.ask("SELECT DISTINCT reason FROM refused")

    def messages(self):
        self.hub.enroll("c1")
        client = Client(self.hub.client[0], self.hub.certificates, "c1")
        row = lcm_event.event
        foreign = bytes([self.fingerprint[0] ^ 0x55]) + lcm_event.encoded(self.fingerprint, row(1))[1:]
        self.publish(client, "c1", row(1), content=foreign)
        self.publish(client, "c1", row(2), key="c2/event/gap/2/1/1")
        self.publish(client, "c1", row(3), key="c1/event/gap/4/4/1")
        self.publish(client, "c1", row(5), content=lcm_event.encoded(self.fingerprint, row(5))[:40])
        self.publish(client, "c1", row(6), key="no key")
        self.publish(client, "c1", row(7, message="a\0b"))
        client.publish("fw.up.c1.event", b"\xff" * 60_000, {"Nats-Msg-Id": "c1/event/x/8/1/1", "Fw-Type": "event_t",
                                                          "Fw-Encoding": "zstd"})
        self.publish(client, "c1", row(9))
        client.round_trip()
        self.must(until(lambda: self.events_of("c1") >= 1 and "zstd" in self.reasons()), "a good event arrives after six bad ones")
        unknown = self.postgres.ask("SELECT count(*), min(type) FROM unknown")
        self.must(unknown == "1|event_t", f"a message with an unknown fingerprint is kept for later and stops no other ({unknown})")
        said = self.reasons()
        for reason in ("its key names c2", "its key does not match its content", "its key (Nats-Msg-Id) is missing"):
            self.must(reason in said, f"refused: {reason}")

    def clocks(self):
        """Events and clocks that jump over years: no event of the history is lost."""
        self.hub.enroll("c3")
        one = Building(self.hub, "c3")
        one.start()
        now_us = int(time.time() * 1e6)
        year_us = 365 * 86_400 * 10**6
        for i, time_us in enumerate((now_us, now_us - 20 * year_us, now_us + 30 * year_us, 0, -5 * year_us, now_us + 1)):
            one.store([lcm_event.event(i, time_us)])
            time.sleep(1.2)
        one.until_acknowledged()
        self.must(until(lambda: self.events_of("c3") == 6), "events of a clock that jumps by 20 years and back are all stored")
        one.stop()
        client = Client(self.hub.client[0], self.hub.certificates, "c3")
        self.publish(client, "c3", lcm_event.event(99, 2**62))
        self.publish(client, "c3", lcm_event.event(100, -(2**62)))
        client.round_trip()
        self.must(until(lambda: self.events_of("c3") == 8), "events of the year 148 000 are stored too")

    def flood(self):
        """With one worker, whose count is exact."""
        self.hub.enroll("c4")
        self.hub.enroll("c5")
        self.workers.stop()
        client = Client(self.hub.client[0], self.hub.certificates, "c4")
        client.subscribe("_INBOX_c4.>")
        for number in range(FLOOD + BEYOND):
            self.publish(client, "c4", lcm_event.event(number))
            if number % 1000 == 0:
                client.round_trip(30)
        client.round_trip(30)
        self.publish(Client(self.hub.client[1], self.hub.certificates, "c5"), "c5", lcm_event.event(1))
        self.workers.start()
        self.must(until(lambda: self.postgres.number("SELECT sum(messages) FROM flooding") >= BEYOND and
                        self.events_of("c5") == 1, 300), "another building's event passes a flood")
        told = self.postgres.ask("SELECT name, sum(messages) FROM flooding JOIN building ON building.id = building GROUP BY 1")
        hours = self.postgres.number("SELECT count(DISTINCT hour) FROM flooding")
        # If the hour ends during the flood, the count starts again.
        self.must(told == f"c4|{BEYOND}" or hours > 1, f"messages beyond {FLOOD} an hour are counted but not stored ({told})")
        self.must(self.events_of("c4") == FLOOD or hours > 1, f"{self.events_of('c4')} events of the flooding building are stored")

    def operator(self, subject, request=b""):
        client = Client(self.hub.client[0], self.hub.certificates, "operator", 20)
        return json.loads(client.request(subject, request, timeout_s=20) or b"{}")

    def full_hub(self):
        """FW_RAW is full: it refuses pieces, which wait in the building, while events pass."""
        self.hub.enroll("c6")
        one = Building(self.hub, "c6")
        one.start_run()
        one.start_samples()
        one.start()
        time.sleep(15)
        info = self.operator("$JS.API.STREAM.INFO.FW_RAW")["config"]
        self.workers.stop()
        filler = Client(self.hub.client[0], self.hub.certificates, "operator", 30)
        for number in range(info["max_bytes"] // 250_000 + 400):  # small ones last, so that no piece fits
            size = 249_500 if number < info["max_bytes"] // 250_000 + 1 else 1000
            filler.publish("fw.up.c6.raw.filler", b"\0" * size, {"Nats-Msg-Id": f"c6/raw/filler/{number}"})
            filler.round_trip(30)
        page = Client(self.hub.client[1], self.hub.certificates, "page")
        now_us = int(time.time() * 1e6)
        answer = page.request("fw.down.c6.raw", json.dumps({"from_us": now_us - 10_000_000, "to_us": now_us}).encode(),
                              {"Fw-Who": "Ada", "Fw-Request": "raw-1", "Fw-Until": int(time.time()) + 60})
        self.must(answer == b'{"ok":true}', f"the request for raw samples is accepted ({answer})")
        time.sleep(10)
        number = one.add_events(1)[0]
        one.until_acknowledged()
        self.must(not one.read("uplink.sqlite", "SELECT * FROM sent_piece") and
                  one.read("uplink.sqlite", "SELECT * FROM raw"), "a full stream takes no piece, and the building keeps it")
        self.operator("$JS.API.STREAM.PURGE.FW_RAW")
        self.workers.start(2)
        whole = "SELECT count(*) FROM raw_piece WHERE request = 'raw-1' HAVING count(*) = max(pieces)"
        self.must(until(lambda: self.postgres.number(whole) > 0, 180), "all pieces arrive when there is room")
        self.must(until(lambda: self.events_of("c6") > number), "events arrived before them")
        one.samples.end()
        one.stop_run()
        one.stop()

    def expired(self):
        """An uplink with an expired certificate reports it and continues with the new file by itself."""
        self.hub.enroll("c7")
        at, folder = f"{self.hub.certificates}/c7.pem", self.hub.certificates
        shutil.copy(at, f"{at}.good")
        subprocess.run(["openssl", "x509", "-req", "-in", f"{folder}/c7.csr", "-CA", f"{folder}/ca.pem", "-CAkey",
                        f"{folder}/ca.key", "-CAserial", f"{folder}/ca.srl", "-days", "-1", "-out", f"{at}.over"],
                       check=True, capture_output=True)
        os.replace(f"{at}.over", at)
        one = Building(self.hub, "c7")
        one.start()
        one.add_events(3)
        log = f"{one.folder}/uplink.log"

        def says():
            with open(log) as file:
                return "expired" in file.read()

        self.must(until(says, 30), "an expired certificate is refused, and the uplink says why")
        if not says():
            with open(log) as file:
                print(file.read()[-1000:])
        time.sleep(3)
        self.must(not one.acknowledged_keys(), "no message passes with it")
        os.replace(f"{at}.good", at)
        begin = time.monotonic()
        one.until_acknowledged(180)
        print(f"       renewed: all acknowledged {time.monotonic() - begin:.0f} s after the new file was there")
        one.stop()

    def check(self):
        self.workers.start(2)
        self.messages()
        self.clocks()
        self.expired()
        self.full_hub()
        self.flood()
        return self.problems
