# SPDX-License-Identifier: MIT
"""Bad input is a framewatch.Error with the program's text, and leaves objects usable."""
import subprocess
import unittest

import framewatch
import numpy as np
from fixture import PROGRAM, Shaken


class Errors(Shaken):
    def setUp(self):
        self.estimator = framewatch.Estimator(self.building)
        self.time = np.arange(10) / 100
        self.accel = np.zeros((10, 4))

    def refused(self, call, *words):
        """Checks that a call raises an Error that has these words; returns its text."""
        with self.assertRaises(framewatch.Error) as caught:
            call()
        for word in words:
            self.assertIn(word, str(caught.exception))
        return str(caught.exception)

    def push_refused(self, time, accel, *words):
        self.refused(lambda: self.estimator.push(time, accel), *words)
        self.assertIsNone(self.estimator.newest_us)  # nothing of it was taken

    def test_error_is_a_value_error(self):
        self.assertTrue(issubclass(framewatch.Error, ValueError))
        self.assertEqual(framewatch.Error.__module__, "framewatch")

    def test_wrong_shape(self):
        self.push_refused(self.time, self.accel[:, :3], "accel", "(10, 3)", "(10, 4)")
        self.push_refused(self.time, self.accel[:9], "accel", "(9, 4)", "(10, 4)")
        self.push_refused(self.time, self.accel[:, 0], "accel", "(10,)")
        self.push_refused(self.time[:, None], self.accel, "time", "(10, 1)", "(n,)")
        self.push_refused(0.0, self.accel, "time", "()")

    def test_wrong_dtype(self):
        for dtype in ("int64", "complex128", "float16", "bool", ">f8"):
            self.push_refused(self.time, self.accel.astype(dtype), "accel", "dtype")
        self.push_refused(self.time, self.accel.astype(object), "accel", "object")
        for dtype in ("float32", "int32", "uint64"):
            self.push_refused(self.time.astype(dtype), self.accel, "time", dtype)
        self.push_refused(self.time.astype("datetime64[us]"), self.accel, "time", "datetime64")

    def test_times(self):
        for wrong in (np.nan, np.inf, -np.inf, 1e300):
            time = self.time.copy()
            time[4] = wrong
            self.push_refused(time, self.accel, "time: entry 4", "not a time")
        time = self.time.copy()
        time[6] = time[5]
        self.push_refused(time, self.accel, "time: entry 6", "not after")
        self.push_refused(self.time[::-1], self.accel, "time: entry 1", "not after")
        extreme = np.array([np.iinfo(np.int64).min], dtype=np.int64)
        self.push_refused(extreme, self.accel[:1], "time: entry 0", "not a time")

    def test_times_must_follow_the_last_push(self):
        self.estimator.push(self.time, self.accel)
        self.refused(lambda: self.estimator.push(self.time, self.accel), "entry 0", "not after 90000")
        self.estimator.push(self.time + 0.1, self.accel)
        self.assertEqual(self.estimator.newest_us, 190_000)

    def test_nan_is_a_lost_sample_and_infinity_is_refused(self):
        self.accel[3, 1] = np.inf
        self.push_refused(self.time, self.accel, "accel: entry (3, 1)", "infinite")
        record = framewatch.read_record(self.record)
        accel = record.accel.copy()
        accel[500, 2] = np.nan  # one lost sample is repaired
        accel[1200:1300, 2] = np.nan  # a longer loss interrupts
        estimates = self.estimator.push(record.time_s, accel)
        self.assertGreater(np.isfinite(estimates.value[:, 0]).sum(), 300)
        lost = framewatch.Record(record.names, record.time_s, accel)
        replayed = framewatch.replay(self.building, lost, one_pass=True)
        np.testing.assert_array_equal(estimates.value, replayed.value[: len(estimates)])
        whole = framewatch.Estimator(self.building).push(record.time_s, record.accel)
        self.assertFalse(np.array_equal(estimates.value, whole.value, equal_nan=True))

    def test_push_after_finish(self):
        self.estimator.finish()
        self.refused(lambda: self.estimator.push(self.time, self.accel), "finish()")
        self.assertEqual(len(self.estimator.finish()), 0)

    def test_empty_push(self):
        self.assertEqual(len(self.estimator.push(self.time[:0], self.accel[:0])), 0)

    def test_no_arrays(self):
        for wrong in (None, "text", {}, [[1.0], [1.0, 2.0]]):
            with self.assertRaises((framewatch.Error, ValueError)):
                self.estimator.push(self.time, wrong)

    def test_unknown_file(self):
        none = self.dir / "none.toml"
        for call in (
            lambda: framewatch.Building.from_toml(none),
            lambda: framewatch.Estimator(str(none)),
            lambda: framewatch.replay(none, self.record),
            lambda: framewatch.simulate(none),
            lambda: framewatch.diagnose(none, train=self.record, held_out=self.record),
        ):
            self.refused(call, "none.toml", "No such file")
        none = self.dir / "none.csv"
        for call in (
            lambda: framewatch.read_record(none),
            lambda: framewatch.replay(self.building, none),
            lambda: framewatch.diagnose(self.building, train=none, held_out=self.record),
        ):
            self.refused(call, "none.csv")

    def test_malformed_toml_tells_all_problems_as_the_program_does(self):
        broken = self.dir / "broken.toml"
        text = self.building.read_text()
        text = text.replace("node_mass_kg = 5.0", "node_mass_kg = -5.0")
        text = text.replace("rate_hz = 100", "rate_hz = 0\nwindows_s = 3")
        text = text.replace("story = 2", "story = 9")
        broken.write_text(text)
        told = self.refused(lambda: framewatch.Building.from_toml(broken)).splitlines()
        self.assertGreaterEqual(len(told), 4)
        for line in told:
            self.assertRegex(line, r"broken\.toml:\d+:\d+: ")
        checked = subprocess.run(
            [PROGRAM, "replay", broken, self.record], capture_output=True, text=True, check=False
        )
        self.assertEqual(checked.returncode, 2)
        self.assertEqual(checked.stderr.splitlines(), told)
        self.refused(lambda: framewatch.Building.from_toml("a = ["), "<text>:1:")
        self.refused(lambda: framewatch.simulate(self.building), "building.toml")

    def test_bad_records(self):
        bad = self.dir / "bad.csv"
        bad.write_text("time_s,base,floor1,floor2,floor3\n0,1,2,3,4\n0.01,x,2,3,4\n0.005,1,2,3\n")
        told = self.refused(lambda: framewatch.replay(self.building, bad), "bad.csv:3", "bad.csv:4")
        self.assertEqual(told, self.refused(lambda: framewatch.read_record(bad)))
        other = self.dir / "other.csv"
        other.write_text("time_s,p,q\n" + "".join(f"{i / 100},1,2\n" for i in range(100)))
        self.refused(lambda: framewatch.replay(self.building, other), "no column is named")
        self.refused(lambda: framewatch.replay(self.building, []), "needs one or more")
        self.refused(lambda: framewatch.replay(self.building, self.record, to_s=-1), "to_s")
        self.refused(lambda: framewatch.read_record(self.record, unit="furlong"), "furlong")
        (self.dir / "empty.lcmlog").write_bytes(b"")
        self.refused(lambda: framewatch.read_record(self.dir / "empty.lcmlog"), "empty.lcmlog")

    def test_bad_records_in_memory(self):
        names = ["base", "floor1", "floor2", "floor3"]

        def replay(time, accel, names=names, **more):
            record = framewatch.Record(names, time, accel, **more)
            return lambda: framewatch.replay(self.building, record)

        self.refused(replay(self.time, self.accel[:, :2]), "Record.accel", "(10, 2)")
        self.refused(replay(self.time[::-1], self.accel), "Record.time_s: entry 1")
        self.refused(replay(self.time * np.nan, self.accel), "Record.time_s: entry 0")
        self.refused(replay(self.time, self.accel + np.inf), "Record.accel", "infinite")
        self.refused(replay(self.time.astype(int), self.accel), "Record.time_s", "int64")
        self.refused(replay(self.time, self.accel, names=["a"]), "Record.accel")
        self.refused(replay(self.time, self.accel, units=["N"]), "4 names and 1 units")
        self.refused(replay(self.time[:1], self.accel[:1]), "2 or more")
        self.refused(replay(self.time * 3, self.accel), "rate_hz")

    def test_diagnose_arguments(self):
        for train, held_out in (([], self.record), (self.record, [])):
            self.refused(
                lambda: framewatch.diagnose(self.building, train=train, held_out=held_out),
                "needs one or more",
            )
        self.refused(
            lambda: framewatch.diagnose(
                self.building, train=self.record, held_out=self.record, without=["ghost"]
            ),
            "ghost", "no effect has this name",
        )
        for limit_s in (-1, float("nan")):
            self.refused(
                lambda: framewatch.diagnose(  # pylint: disable=cell-var-from-loop
                    self.building, train=self.record, held_out=self.record, limit_s=limit_s
                ),
                "limit of the search", "0 or more",
            )

    def test_wrong_arguments_are_type_errors(self):
        for call in (
            lambda: framewatch.Building.from_toml(3),
            lambda: framewatch.replay(self.building, 3),
            lambda: framewatch.replay(self.building, self.record, progress=3),
            lambda: framewatch.simulate(self.dir / "shaken.toml", building=3),
        ):
            with self.assertRaises(TypeError):
                call()


if __name__ == "__main__":
    unittest.main()
