# SPDX-License-Identifier: MIT
"""A PostgreSQL for this test, on a Unix socket."""
import glob
import os
import pwd
import shutil
import subprocess

END = "end-of-the-answer"


def is_there():
    return bool(glob.glob("/usr/lib/postgresql/*/bin/postgres")) and bool(shutil.which("psql"))


class Postgres:
    def __init__(self):
        self.bin = sorted(glob.glob("/usr/lib/postgresql/*/bin"))[-1]
        self.folder = f"/tmp/framewatch-pg-{os.getpid()}"  # names of sockets must be short
        os.makedirs(self.folder)
        # PostgreSQL refuses to run as root. In a private network only root exists, but it may take another user
        # number.
        self.as_user = []
        if os.getuid() == 0:
            user = pwd.getpwnam("postgres")
            self.as_user = ["unshare", "--user", f"--map-user={user.pw_uid}", f"--map-group={user.pw_gid}"]
        self.call("initdb", "-D", f"{self.folder}/data", "-A", "trust", "-U", "fleet", "--no-sync")
        self.start()
        self.call("createdb", "-h", self.folder, "-U", "fleet", "fleet")
        self.where = f"host={self.folder} user=fleet dbname=fleet"

    def call(self, program, *arguments):
        done = subprocess.run([*self.as_user, f"{self.bin}/{program}", *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, cwd="/", check=False, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{program}: {done.stdout[-500:]}")

    def start(self):
        # pg_ctl's child inherits a pipe, so the log is a separate file.
        subprocess.run([*self.as_user, f"{self.bin}/pg_ctl", "-D", f"{self.folder}/data", "-o",
                        f"-k {self.folder} -c listen_addresses=''", "-l", f"{self.folder}/log", "-w", "start"],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd="/", check=True)

    def kill(self):
        """Kills the server without warning: committed data are on the disk."""
        subprocess.run([*self.as_user, f"{self.bin}/pg_ctl", "-D", f"{self.folder}/data", "-m", "immediate", "stop"],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd="/", check=False)

    def processor_s(self):
        """The memory of all its processes, including ended ones."""
        with open(f"{self.folder}/data/postmaster.pid") as file:
            first = int(file.readline())
        ticks = 0
        for name in os.listdir("/proc"):
            if not name.isdigit():
                continue
            try:
                with open(f"/proc/{name}/stat") as file:
                    words = file.read().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if int(name) == first:
                ticks += sum(int(word) for word in words[11:15])
            elif int(words[1]) == first:
                ticks += int(words[11]) + int(words[12])
        return ticks / os.sysconf("SC_CLK_TCK")

    def ask(self, sql):
        """Rows as psql prints them; empty while the database is away."""
        done = subprocess.run([f"{self.bin}/psql", "-h", self.folder, "-U", "fleet", "-At", "-c", sql, "fleet"],
                              capture_output=True, text=True, check=False)
        return done.stdout.strip()

    def number(self, sql):
        return int(self.ask(sql) or 0)

    def session(self):
        return Session(self)

    def remove(self):
        self.kill()
        subprocess.run(["rm", "-rf", self.folder], check=True)


class Session:
    """One connection for frequent queries. It reconnects by itself."""

    def __init__(self, postgres):
        self.postgres, self.psql = postgres, None

    def ask(self, sql):
        """Rows; None while the database is away."""
        if self.psql is None:
            self.psql = subprocess.Popen([f"{self.postgres.bin}/psql", "-h", self.postgres.folder, "-U", "fleet", "-Atq",
                                          "fleet"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                         stderr=subprocess.DEVNULL, text=True)
        rows = []
        try:
            self.psql.stdin.write(f"{sql};\n\\echo {END}\n")
            self.psql.stdin.flush()
            for line in self.psql.stdout:
                if line.strip() == END:
                    return rows
                rows.append(line.rstrip("\n"))
        except OSError:
            pass
        self.close()
        return None

    def close(self):
        if self.psql is not None:
            self.psql.kill()
            self.psql.communicate()
            self.psql = None
