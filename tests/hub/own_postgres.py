"""A PostgreSQL of a test's own, on a Unix socket, in whatever namespace it runs."""
import glob
import os
import subprocess
import time

from hub import Process


def newest_bin():
    """Empty where Debian's package is missing."""
    found = sorted(glob.glob("/usr/lib/postgresql/*/bin/postgres"))
    return os.path.dirname(found[-1]) if found else ""


class OwnPostgres:
    """As another user of a namespace where this one is root, which the server refuses."""

    def __init__(self, folder):
        self.bin, self.folder = newest_bin(), folder
        as_user = ["unshare", "-U", "--map-user=1000", "--map-group=1000"] if os.geteuid() == 0 else []
        self.where = f"host={folder} user=fleet dbname=postgres"
        log = f"{folder}/postgres.log"
        with open(log, "ab") as file:
            subprocess.run([*as_user, f"{self.bin}/initdb", "-D", f"{folder}/data", "-A", "trust", "-U", "fleet",
                            "--no-sync"], check=True, stdout=file, stderr=file)
        Process([*as_user, f"{self.bin}/postgres", "-D", f"{folder}/data", "-k", folder, "-c", "listen_addresses=",
                 "-c", "fsync=off"], log)
        for _ in range(600):
            if self.ask("SELECT 1") == "1":
                return
            time.sleep(0.1)
        raise RuntimeError(f"PostgreSQL does not begin: {log}")

    def ask(self, sql):
        done = subprocess.run([f"{self.bin}/psql", self.where, "-At", "-c", sql], capture_output=True, text=True,
                              check=False)
        return done.stdout.strip()
