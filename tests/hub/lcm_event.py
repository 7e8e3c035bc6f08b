# SPDX-License-Identifier: MIT
"""An event_t encoded for LCM, and its datagram."""
import socket
import struct

MAGIC, GROUP = 0x4C433032, "239.255.76.67"
FIRST_US = 1_700_000_000_000_000  # default time of events


def fingerprint(root, channel="FRAMEWATCH_EVENT"):
    """Fingerprint of the type of a channel: the first bytes of its message in the log of every type."""
    with open(f"{root}/tests/golden/every_type.lcmlog", "rb") as file:
        log = file.read()
    at = log.index(channel.encode()) + len(channel)
    return log[at:at + 8]


def text(value):
    return struct.pack(">i", len(value) + 1) + value.encode() + b"\0"


def encoded(print_, row):
    """row: kind, id, time_us, state, since_us, severity, place, value, std_error, unit, message, segment, as in the
    history's table."""
    kind, number, time_us, state, since_us, severity, place, value, error, unit, message, segment = row
    return (print_ + struct.pack(">qqqii", time_us, since_us, number, state, severity) + text(kind) + text(place) +
            struct.pack(">dd", value, error) + text(unit) + text(message) + text(segment))


def event(number, time_us=None, kind="gap", message="it moves"):
    return (kind, number, FIRST_US + number if time_us is None else time_us, 1, 0, 0, "", 1.0, 0.1, "",
            message, "")


class Lcm:
    def __init__(self, port):
        self.port, self.number = port, 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)

    def publish(self, channel, data):
        self.number += 1
        self.socket.sendto(struct.pack(">II", MAGIC, self.number) + channel.encode() + b"\0" + data, (GROUP, self.port))
