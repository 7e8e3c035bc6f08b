# SPDX-License-Identifier: MIT
"""What the tests of the Python module share: README's building and record, and the program."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ["FRAMEWATCH_PROGRAM"]


def building_text() -> str:
    """README's three stories, equal masses, one frame."""
    channels = ['[[channel]]\nname = "base"\nstory = 0\ndirection = "x"\n']
    for story in (1, 2, 3):
        channels.append(
            f'[[channel]]\nname = "floor{story}"\nstory = {story}\nframe = "y1"\n'
            f'source = {{ lcm = "ACCEL", node = {story}, axis = "x" }}\n'
        )
    channels[0] += 'source = { lcm = "ACCEL", node = 0, axis = "x" }\n'
    return (
        '[structure]\nname = "three-story model"\nstories = 3\nframes_x = ["y1"]\n'
        "story_height_m = [0.3, 0.3, 0.3]\nnode_mass_kg = 5.0\n"
        + "".join(channels)
        + "[estimator]\nrate_hz = 100\n"
    )


SCENARIO = """config = "building.toml"
duration_s = 20
[truth]
kx_npm = [[9000], [8000], [7000]]
damping_ratio = 0.02
[motion]
peak_mps2 = 2.0
[sensors]
noise_ratio = 0.01
"""


def run(*arguments, **options) -> subprocess.CompletedProcess:
    """Runs the program; fails with what it printed."""
    done = subprocess.run(
        [PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, **options
    )
    if done.returncode != 0:
        raise AssertionError(f"framewatch {arguments}: {done.returncode}\n{done.stderr}")
    return done


def run_python(program: str, **options) -> subprocess.CompletedProcess:
    """Runs Python text in another process, in which `folder` holds the files of the tests."""
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=240, **options
    )


class Shaken(unittest.TestCase):
    """Tests with building.toml, shaken.toml and record.csv in the folder cls.dir."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.dir = Path(folder.name)
        (cls.dir / "building.toml").write_text(building_text())
        (cls.dir / "shaken.toml").write_text(SCENARIO)
        run("simulate", "shaken.toml", "--out", "record.csv", "--quiet", cwd=cls.dir)
        cls.building = cls.dir / "building.toml"
        cls.record = cls.dir / "record.csv"
