# SPDX-License-Identifier: MIT
"""A minimal NATS client for tests: TLS, publish, subscribe, request, and denials by the server."""
import json
import re
import socket
import ssl
import time


class Denied(Exception):
    pass


class Client:
    def __init__(self, port, folder, name, timeout_s=30):
        self.name = name
        self.number = 0
        self.errors = []
        self.messages = []
        self.buffer = b""
        plain = socket.create_connection(("127.0.0.1", port), timeout_s)
        plain.settimeout(timeout_s)
        while b"\r\n" not in self.buffer:
            got = plain.recv(1)  # bytes of TLS must not be read here
            if not got:
                raise Denied("closed")
            self.buffer += got
        self.buffer = b""
        context = ssl.create_default_context(cafile=f"{folder}/ca.pem")
        context.load_cert_chain(f"{folder}/{name}.pem", f"{folder}/{name}.key")
        self.socket = context.wrap_socket(plain, server_hostname="localhost")
        options = {"verbose": False, "pedantic": False, "headers": True, "no_responders": True, "tls_required": True,
                   "name": name, "lang": "python", "version": "1", "protocol": 1}
        self.send(f"CONNECT {json.dumps(options)}\r\nPING\r\n".encode())
        self.until(lambda: self.ponged, timeout_s)

    ponged = False

    def send(self, data):
        self.socket.sendall(data)

    def until(self, done, timeout_s):
        """Reads until `done()`; returns False after the time limit. Raises Denied if the server closes the connection."""
        end = time.monotonic() + timeout_s
        while not done():
            left = end - time.monotonic()
            if left <= 0:
                return False
            self.socket.settimeout(left)
            try:
                got = self.socket.recv(65536)
            except (TimeoutError, socket.timeout):
                return False
            except (OSError, ssl.SSLError) as error:
                raise Denied(str(error)) from error
            if not got:
                raise Denied("; ".join(self.errors) or "closed")
            self.buffer += got
            while self.parse():
                pass
        return True

    def parse(self):
        line, found, rest = self.buffer.partition(b"\r\n")
        if not found:
            return False
        words = line.decode().split(" ")
        if words[0] in ("MSG", "HMSG"):
            size = int(words[-1])
            if len(rest) < size + 2:
                return False
            head = int(words[-2]) if words[0] == "HMSG" else 0
            self.messages.append((words[1], rest[:head], rest[head:size]))
            self.buffer = rest[size + 2:]
            return True
        self.buffer = rest
        if words[0] == "PING":
            self.send(b"PONG\r\n")
        elif words[0] == "PONG":
            self.ponged = True
        elif words[0] == "-ERR":
            self.errors.append(line.decode()[5:])
        return True

    def round_trip(self, timeout_s=30):
        self.ponged = False
        self.send(b"PING\r\n")
        return self.until(lambda: self.ponged, timeout_s)

    def subscribe(self, subject):
        self.number += 1
        self.send(f"SUB {subject} {self.number}\r\n".encode())

    def publish(self, subject, data=b"", headers=None, reply=""):
        if headers:
            head = b"NATS/1.0\r\n" + b"".join(f"{k}: {v}\r\n".encode() for k, v in headers.items()) + b"\r\n"
            self.send(f"HPUB {subject} {reply} {len(head)} {len(head) + len(data)}\r\n".encode() + head + data + b"\r\n")
        else:
            self.send(f"PUB {subject} {reply} {len(data)}\r\n".encode() + data + b"\r\n")

    def request(self, subject, data=b"", headers=None, timeout_s=30):
        """The answer's bytes; None if there is none."""
        self.number += 1
        inbox = f"_INBOX_{self.name}.{self.number}"
        self.send(f"SUB {inbox} {self.number}\r\n".encode())
        self.publish(subject, data, headers, inbox)
        mine = lambda: [m for m in self.messages if m[0] == inbox]
        self.until(lambda: mine() or self.errors, timeout_s)
        self.send(f"UNSUB {self.number}\r\n".encode())
        return mine()[0][2] if mine() else None


def stream_keys(client, stream):
    """Keys of all messages in a stream, in order, without their seals."""
    info = json.loads(client.request(f"$JS.API.STREAM.INFO.{stream}", timeout_s=30) or b"{}")
    state = info.get("state")
    if state is None:
        raise RuntimeError(f"{stream}: {info.get('error')}")
    inbox = f"_INBOX_{client.name}.keys"
    client.subscribe(inbox)
    consumer = {"stream_name": stream, "config": {"deliver_subject": inbox, "deliver_policy": "all", "ack_policy": "none",
                                                  "replay_policy": "instant", "headers_only": True}}
    made = json.loads(client.request(f"$JS.API.CONSUMER.CREATE.{stream}", json.dumps(consumer).encode(), timeout_s=30))
    if "error" in made:
        raise RuntimeError(f"{stream}: {made['error']}")
    mine = lambda: [m for m in client.messages if m[0].startswith("fw.up.")]
    client.until(lambda: len(client.messages) > state["messages"] and len(mine()) >= state["messages"], 60)
    found = [re.search(rb"Nats-Msg-Id: *([^\s~]+)", head) for _, head, _ in mine()]
    if len(found) < state["messages"]:
        raise RuntimeError(f"{stream}: {len(found)} of {state['messages']} messages came")
    return [one.group(1).decode() if one else "?" for one in found]
