# SPDX-License-Identifier: MIT
"""Headless Chromium of a test's own, driven over its pipe (Chrome DevTools Protocol): Debian's package alone, no npm."""
import json
import os
import shutil
import subprocess
import tempfile
import time


def program():
    """Returns the path of the browser; empty if there is none."""
    return os.environ.get("FRAMEWATCH_CHROMIUM") or shutil.which("chromium") or ""


class Chromium:
    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="framewatch-chromium-")
        hears, self.out = os.pipe()
        self.into, says = os.pipe()
        # Its profile and its crash reports stay in the folder; a test's namespace has no other user for a sandbox.
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{hears} 4>&{says}', "chromium", program(), "--headless=new", "--no-sandbox",
             "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", f"--user-data-dir={self.folder}",
             "--remote-debugging-pipe", "about:blank"],
            pass_fds=(hears, says), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": self.folder})
        os.close(hears)
        os.close(says)
        self.number, self.rest, self.errors = 0, b"", []

    def ask(self, method, session=None, **parameters):
        """Returns the result. Raises RuntimeError with Chromium's error, or if Chromium has ended."""
        self.number += 1
        order = {"id": self.number, "method": method, "params": parameters}
        os.write(self.out, json.dumps(order | ({"sessionId": session} if session else {})).encode() + b"\0")
        while True:
            message = self.next()
            if message.get("method") == "Runtime.exceptionThrown":
                details = message["params"]["exceptionDetails"]
                self.errors.append(details.get("exception", {}).get("description") or details["text"])
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']['message']}")
                return message["result"]

    def next(self):
        while b"\0" not in self.rest:
            more = os.read(self.into, 1 << 16)
            if not more:
                raise RuntimeError("chromium has ended")
            self.rest += more
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def open(self, url):
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.ask("Runtime.enable", session)
        self.ask("Page.enable", session)
        self.ask("Page.navigate", session, url=url)
        return Tab(self, session)

    def end(self):
        self.process.kill()
        self.process.wait()
        os.close(self.out)
        os.close(self.into)
        shutil.rmtree(self.folder, ignore_errors=True)


class Tab:
    def __init__(self, browser, session):
        self.browser, self.session = browser, session

    def value(self, expression):
        """Evaluates JavaScript; null if it throws."""
        answer = self.browser.ask("Runtime.evaluate", self.session, expression=expression, returnByValue=True)
        return answer["result"].get("value")

    def until(self, expression, seconds=60):
        """Returns true if the expression becomes true in time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.value(expression):
                return True
            time.sleep(0.2)
        return False
