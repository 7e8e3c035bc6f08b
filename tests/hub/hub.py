# SPDX-License-Identifier: MIT
"""Three nats-servers for this test, configured as in deploy/fleet/, and workers."""
import os
import re
import shutil
import signal
import socket
import subprocess
import time
import urllib.request


def free_ports(count):
    held = [socket.socket() for _ in range(count)]
    for one in held:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in held]
    for one in held:
        one.close()
    return ports


class Process:
    """A process that this test starts and ends."""

    every = []

    def __init__(self, arguments, log, **more):
        self.log = open(log, "ab")
        self.child = subprocess.Popen(arguments, stdout=self.log, stderr=self.log, stdin=subprocess.DEVNULL, **more)
        Process.every.append(self)

    def tell(self, number):
        if self.child.poll() is None:
            self.child.send_signal(number)

    def end(self, number=signal.SIGTERM):
        self.tell(signal.SIGCONT)
        self.tell(number)
        try:
            self.child.wait(30)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()
        self.log.close()
        Process.every.remove(self)
        return self.child.returncode

    def usage(self):
        """Seconds of processor so far, and resident bytes."""
        with open(f"/proc/{self.child.pid}/stat") as file:
            words = file.read().rsplit(")", 1)[1].split()
        ticks, pages = int(words[11]) + int(words[12]), int(words[21])
        return ticks / os.sysconf("SC_CLK_TCK"), pages * os.sysconf("SC_PAGE_SIZE")

    @classmethod
    def end_all(cls):
        for one in list(cls.every):
            one.end(signal.SIGKILL)


class Hub:
    def __init__(self, root, program, folder):
        self.root, self.program, self.folder = root, program, folder
        self.certificates = f"{folder}/hub"
        os.makedirs(self.certificates)
        ports = free_ports(9)
        self.client, self.cluster, self.http = ports[0:3], ports[3:6], ports[6:9]
        servers = [f"--server=hub{i}=localhost,127.0.0.1" for i in (1, 2, 3)]
        self.fleet("authority", *servers)
        routes = ", ".join(f'"nats://127.0.0.1:{port}"' for port in self.cluster)
        for i in range(3):
            with open(f"{root}/deploy/fleet/hub{i + 1}.conf") as file:
                text = file.read()
            for old, new in ((r'"0\.0\.0\.0:4222"', f'"127.0.0.1:{self.client[i]}"'),
                             (r'"127\.0\.0\.1:8222"', f'"127.0.0.1:{self.http[i]}"'),
                             (r'"10\.0\.0\.\d:6222"', f'"127.0.0.1:{self.cluster[i]}"'),
                             (r'routes: \[.*\]', f"routes: [ {routes} ]"),
                             (r'"/var/lib/nats"', f'"{folder}/store{i + 1}"'),
                             (r'"/run/nats-server/hub', f'"{self.certificates}/hub'),
                             (r'"/etc/framewatch-hub/', f'"{self.certificates}/')):
                text, count = re.subn(old, new, text)
                assert count in (1, 6), (old, count)
            with open(f"{self.certificates}/hub{i + 1}.conf", "w") as file:
                file.write(text)
        for name in ("accounts.conf", "mqtt-users.conf"):
            shutil.copy(f"{root}/deploy/fleet/{name}", self.certificates)
        self.servers = [None, None, None]

    def fleet(self, command, *arguments, good=(0,)):
        done = subprocess.run([self.program, "fleet", command, "--dir", self.certificates, *arguments],
                              capture_output=True, text=True, timeout=120)
        if done.returncode not in good:
            raise RuntimeError(f"fleet {command}: {done.stdout}{done.stderr}")
        return done

    def urls(self):
        return [f"tls://localhost:{port}" for port in self.client]

    def start(self, *numbers):
        for i in numbers or (0, 1, 2):
            self.servers[i] = Process(["nats-server", "-c", f"{self.certificates}/hub{i + 1}.conf"],
                                      f"{self.folder}/hub{i + 1}.log")

    def kill(self, *numbers):
        for i in numbers or (0, 1, 2):
            self.servers[i].end(signal.SIGKILL)

    def wait(self, timeout_s=90, patience_s=15):
        """Waits until every server is healthy. Debian's 2.9.10 sometimes reports an unused consumer as not current forever, so
        after some seconds a running JetStream suffices."""
        begin = time.monotonic()
        for i in range(3):
            while True:
                waited_s = time.monotonic() - begin
                only = "?js-server-only=true" if waited_s > patience_s else ""
                try:
                    with urllib.request.urlopen(f"http://127.0.0.1:{self.http[i]}/healthz{only}", timeout=5):
                        break
                except OSError:
                    if waited_s > timeout_s:
                        raise RuntimeError(f"hub{i + 1} is not well") from None
                    time.sleep(0.2)

    def pid_files(self):
        return [argument for i in (1, 2, 3) for argument in ("--reload", f"{self.certificates}/hub{i}.pid")]

    def enroll(self, name):
        key, request = f"{self.certificates}/{name}.key", f"{self.certificates}/{name}.csr"
        subprocess.run([self.program, "fleet", "request", name, "--key", key, "--out", request], check=True,
                       stdout=subprocess.DEVNULL)
        running = [] if self.servers[0] is None else self.pid_files()
        self.fleet("enroll", name, request, "--out", f"{self.certificates}/{name}.pem", *running)

    def copy_stores(self):
        """Restores the disk of some seconds before, as after a power failure."""
        for i in (1, 2, 3):
            shutil.rmtree(f"{self.folder}/old{i}", ignore_errors=True)
            subprocess.run(["cp", "-r", f"{self.folder}/store{i}", f"{self.folder}/old{i}"], check=False,
                           stderr=subprocess.DEVNULL)

    def put_back_stores(self):
        for i in (1, 2, 3):
            shutil.rmtree(f"{self.folder}/store{i}")
            os.rename(f"{self.folder}/old{i}", f"{self.folder}/store{i}")


class Workers:
    def __init__(self, hub, postgres):
        self.hub, self.postgres, self.all, self.begun = hub, postgres, [], 0

    def start(self, count=1):
        for _ in range(count):
            urls = [argument for url in self.hub.urls() for argument in ("--hub", url)]
            self.begun += 1
            self.all.append(Process([self.hub.program, "fleet", "worker", *urls, "--dir", self.hub.certificates,
                                     "--database", self.postgres.where], f"{self.hub.folder}/worker{self.begun}.log"))

    def kill(self, at=0):
        self.all.pop(at).end(signal.SIGKILL)

    def stop(self):
        while self.all:
            self.all.pop().end()
