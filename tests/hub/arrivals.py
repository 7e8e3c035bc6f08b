# SPDX-License-Identifier: MIT
"""Times at which events are in the database, as `fleet serve` reads it."""
import threading
import time

LOOK_S = 0.05


class Arrivals:
    """Queries the database again and again in a thread."""

    def __init__(self, postgres):
        self.session, self.at, self.lock, self.ends = postgres.session(), {}, threading.Lock(), False
        self.thread = threading.Thread(target=self.look, daemon=True)
        self.thread.start()

    def look(self):
        while not self.ends:
            # The newest suffice: older events were seen before, or arrive late and are found at the end.
            rows = self.session.ask("SELECT name, event.id FROM event JOIN building ON building.id = event.building "
                                    "WHERE kind = 'gap' ORDER BY event.id DESC LIMIT 2000") or []
            now = time.monotonic()
            with self.lock:
                for row in rows:
                    self.at.setdefault(tuple(row.split("|")), now)
            time.sleep(LOOK_S)

    def seconds(self, sent):
        """For every event in `sent` ((building, number): time it was added), the seconds until it is in the database."""
        with self.lock:
            return sorted(self.at[name, str(number)] - begin for (name, number), begin in sent.items()
                          if (name, str(number)) in self.at)

    def end(self):
        self.ends = True
        self.thread.join()
        self.session.close()


def percentile(ascending, share):
    return ascending[min(len(ascending) - 1, int(share * len(ascending)))] if ascending else float("nan")
