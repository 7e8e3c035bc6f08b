# SPDX-License-Identifier: MIT
"""diagnose() gives what the program gives, and can be interrupted."""
import json
import math
import os
import random
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import framewatch
from fixture import PROGRAM

SPRING = """[structure]
name = "a spring"
stories = 1
frames_x = ["y1"]
story_height_m = [1.0]
node_mass_kg = 2.0
[structure.design]
kx_npm = [[8.0]]
damping_ratio = 0.02
[estimator]
rate_hz = 50
[[channel]]
name = "base"
story = 0
direction = "x"
[[channel]]
name = "y"
story = 1
frame = "y1"
"""


def write_push(path: Path, seed: int) -> None:
    """A mass of 2 kg on a spring of 8 N/m + 60 N/m^3, pushed by a sum of sines; 50 Hz, 120 s."""
    chance = random.Random(seed)
    sines = [(0.3 + 0.15 * i, 2 * math.pi * chance.random()) for i in range(40)]
    y = v = u = 0.0
    with open(path, "w", encoding="utf-8") as file:
        file.write("time_s,y,u\n")
        for step in range(120 * 1000):
            if step % 2 == 0:
                u = sum(0.05 * math.sin(w * step / 1000 + phase) for w, phase in sines)
            if step % 20 == 0:
                noise = 3e-3 * (chance.random() - 0.5)
                file.write(f"{step / 1000:.2f},{y + noise:.9f},{u:.9f}\n")
            v += (u - 0.3 * v - 8 * y - 60 * y * y * y) / 2 / 1000
            y += v / 1000


class Diagnose(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.dir = Path(folder.name)
        (cls.dir / "spring.toml").write_text(SPRING)
        write_push(cls.dir / "a.csv", 1)
        write_push(cls.dir / "b.csv", 2)

    def diagnose(self, **options):
        return framewatch.diagnose(
            self.dir / "spring.toml", train=[self.dir / "a.csv"], held_out=self.dir / "b.csv",
            force="u", displacement=True, **options,
        )

    def test_equals_the_program(self):
        told = []
        found = self.diagnose(progress=lambda *what: told.append((*what, threading.get_ident())))
        done = subprocess.run(
            [PROGRAM, "diagnose", "spring.toml", "--force", "u", "--displacement", "--train",
             "a.csv", "--holdout", "b.csv", "--out", "d"],
            cwd=self.dir, capture_output=True, text=True, check=False,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        expected = json.loads((self.dir / "d" / "diagnosis.json").read_text())
        own = dict(found.json)
        for one in (expected, own):  # paths differ
            del one["provenance"]
            for where in one["where"]:
                del where["record"]
        self.assertEqual(own, expected)
        self.assertEqual(found.verdict, expected["verdict"])
        self.assertEqual(found.verdict, "explained")
        self.assertEqual(found.names[0], "cubic_stiffness")
        first = found.effects[0]
        self.assertEqual(first.place, {"kind": "frame", "direction": "x", "story": 1, "frame": "y1"}
                         | first.place)
        self.assertAlmostEqual(first.parameters["k3_npm3"].value, 60, delta=6)
        self.assertEqual(first.parameters["k3_npm3"].unit, "N/m^3")
        self.assertTrue(0 < first.confidence <= 1)
        self.assertGreater(first.gap_before, first.gap_after)
        self.assertEqual(found.gap_before.held_out, expected["gap"]["before"]["holdout"]["overall"])
        self.assertGreater(found.gap_before.held_out, 2 * found.gap_after.held_out)
        self.assertGreater(len(found.places), 0)
        self.assertIn("cubic stiffness", found.text)
        self.assertIn("<html", found.report_html)
        self.assertGreater(len(told), 0)
        self.assertEqual({thread for _, _, thread in told}, {threading.get_ident()})
        self.assertTrue(all(0 <= share <= 1 for _, share, _ in told))

    def test_limit(self):
        found = self.diagnose(limit_s=1e-6)
        self.assertEqual(found.verdict, "unexplained")
        self.assertEqual(found.effects, [])
        self.assertEqual(len(found.not_done), 10)
        self.assertIn("--limit", found.text)
        self.assertEqual(self.diagnose(limit_s=1e6).not_done, [])

    def test_callback_that_throws(self):
        def tell(*_):
            raise KeyError("enough")

        began = time.monotonic()
        with self.assertRaisesRegex(KeyError, "enough"):
            self.diagnose(progress=tell)
        self.assertLess(time.monotonic() - began, 15)

    def test_ctrl_c(self):
        began = []

        def once(*_):
            if not began:
                began.append(time.monotonic())
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            self.diagnose(progress=once)
        self.assertLess(time.monotonic() - began[0], 15)


if __name__ == "__main__":
    unittest.main()
