# SPDX-License-Identifier: MIT
"""`framewatch fleet serve` for a test, and its answers to a person."""
import json
import subprocess
import urllib.error
import urllib.request

from hub import Process, free_ports


class Page:
    def __init__(self, hub, postgres):
        self.hub, self.people = hub, f"{hub.folder}/people"
        (self.port,) = free_ports(1)
        self.arguments = [hub.program, "fleet", "serve", *(a for url in hub.urls() for a in ("--hub", url)), "--dir",
                          hub.certificates, "--database", postgres.where, "--people", self.people, "--port", str(self.port),
                          "--quiet"]
        self.process = None

    def person(self, name, role):
        """The person's token."""
        return subprocess.run([self.hub.program, "fleet", "person", name, "--role", role, "--people", self.people],
                              capture_output=True, text=True, check=True).stdout.strip()

    def start(self):
        self.process = Process(self.arguments, f"{self.hub.folder}/serve.log")

    def stop(self):
        self.process.end()

    def answer(self, token, path, method="GET"):
        """Status and JSON; 0 and None without an answer."""
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}/{path}", method=method,
                                         headers={"Authorization": f"Bearer {token}"})
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, json.load(answer)
        except urllib.error.HTTPError as refusal:
            return refusal.code, None
        except (OSError, ValueError):
            return 0, None

    def ask(self, token, path, method="GET"):
        return self.answer(token, path, method)[1]
