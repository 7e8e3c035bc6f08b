# SPDX-License-Identifier: MIT
"""The module's numbers are the program's, to the bit; layouts of arrays do not change them."""
import csv
import struct
import unittest

import framewatch
import numpy as np
from fixture import Shaken, run


def bits(value: float) -> bytes:
    return struct.pack("<d", value)


class Estimates(Shaken):
    def rows_of_program(self, *options):
        run("replay", self.building, self.record, "--out", self.dir / "x.csv", "--quiet", *options)
        with open(self.dir / "x.csv", newline="") as file:
            return list(csv.DictReader(file))

    def assert_same(self, estimates, rows):
        """Compares every double of a CSV of the program with the module's."""
        self.assertGreater(len(rows), 1000)
        self.assertEqual(len(estimates), len(rows))
        compared = 0
        for w, row in enumerate(rows):
            self.assertEqual(bits(estimates.window_end_s[w]), bits(float(row["window_end_s"])))
            self.assertEqual(framewatch.STATUS[estimates.status[w]], row["status"])
            for p, name in enumerate(estimates.parameters):
                self.assertEqual(estimates.observable[w, p], row[name + ".observable"] == "1")
                for column, array in ((name, "value"), (name + ".std_error", "std_error")):
                    found = getattr(estimates, array)[w, p]
                    if row[column] == "":
                        self.assertTrue(np.isnan(found))
                    else:
                        self.assertEqual(bits(found), bits(float(row[column])))
                        compared += 1
        self.assertGreater(compared, 6000)

    def test_replay_equals_the_program(self):
        estimates = framewatch.replay(self.building, self.record)
        self.assert_same(estimates, self.rows_of_program())
        self.assertTrue(any("tuned on the record first" in note for note in estimates.notes))
        median = np.nanmedian(estimates["kx_1_y1"].value)
        self.assertAlmostEqual(median, 9000, delta=30)

    def test_part_of_a_record_equals_the_program(self):
        estimates = framewatch.replay(self.building, self.record, from_s=1, to_s=18)
        self.assert_same(estimates, self.rows_of_program("--from", "1", "--to", "18"))

    def test_estimator_equals_one_pass(self):
        rows = self.rows_of_program("--one-pass")
        self.assert_same(framewatch.replay(self.building, self.record, one_pass=True), rows)
        record = framewatch.read_record(self.record)
        estimator = framewatch.Estimator(self.building)
        parts = [
            estimator.push(record.time_s[i : i + 333], record.accel[i : i + 333])
            for i in range(0, len(record), 333)
        ]
        parts.append(estimator.finish())
        whole = framewatch.Estimates(
            parts[0].parameters, parts[0].units,
            *(np.concatenate([getattr(part, name) for part in parts]) for name in (
                "window_start_us", "window_end_us", "sequence", "status", "rows",
                "residual_ratio", "value", "std_error", "reason")),
        )
        self.assert_same(whole, rows)
        self.assertEqual(estimator.newest_us, 20_000_000)

    def test_every_layout_gives_the_same(self):
        record = framewatch.read_record(self.record)

        def one_pass(time, accel):
            estimator = framewatch.Estimator(self.building)
            first = estimator.push(time, accel)
            return np.concatenate([first.value, estimator.finish().value])

        expected = one_pass(record.time_s, record.accel)
        self.assertGreater(np.isfinite(expected).sum(), 3000)
        wide = np.full((len(record), 8), np.inf)
        wide[:, ::2] = record.accel
        backwards = np.ascontiguousarray(record.accel[::-1, ::-1])[::-1, ::-1]
        read_only = record.accel.copy()
        read_only.flags.writeable = False
        micro = np.round(record.time_s * 1e6).astype(np.int64)
        for time, accel in (
            (micro, record.accel),
            (np.repeat(record.time_s, 2)[::2], np.asfortranarray(record.accel)),
            (record.time_s, wide[:, ::2]),
            (record.time_s, backwards),
            (record.time_s, read_only),
            (list(record.time_s), record.accel.tolist()),
        ):
            np.testing.assert_array_equal(one_pass(time, accel), expected)
        single = record.accel.astype(np.float32)
        np.testing.assert_array_equal(
            one_pass(micro, single), one_pass(micro, single.astype(np.float64))
        )

    def test_results_own_their_memory(self):
        estimates = framewatch.replay(self.building, self.record)
        value = estimates["kx_2_y1"].value
        before = value.copy()
        del estimates
        np.testing.assert_array_equal(value, before)
        value[:] = 0

    def test_to_pandas(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed")
        estimates = framewatch.replay(self.building, self.record)
        self.rows_of_program()
        frame, of_program = estimates.to_pandas(), pandas.read_csv(self.dir / "x.csv")
        self.assertEqual([frame.index.name, *frame.columns], list(of_program.columns))
        np.testing.assert_array_equal(frame["cx_3_y1"], estimates["cx_3_y1"].value)
        self.assertEqual(list(frame["status"]), list(of_program["status"]))
        record = framewatch.read_record(self.record)
        self.assertEqual(list(record.to_pandas().columns), record.names)


class Records(Shaken):
    def test_simulate_equals_the_program(self):
        simulated = framewatch.simulate(self.dir / "shaken.toml")
        stored = framewatch.read_record(self.record)
        self.assertEqual(simulated.names, ["base", "floor1", "floor2", "floor3"])
        np.testing.assert_array_equal(simulated.time_s, stored.time_s)
        np.testing.assert_array_equal(simulated.accel, stored.accel)
        shorter = framewatch.simulate(self.dir / "shaken.toml", duration_s=2)
        self.assertEqual(shorter.accel.shape, (201, 4))

    def test_simulate_text_with_a_building(self):
        building = framewatch.Building.from_toml(self.building)
        text = (self.dir / "shaken.toml").read_text().replace("building.toml", "none.toml")
        record = framewatch.simulate(text, building=building, duration_s=1)
        self.assertEqual(record.accel.shape, (101, 4))

    def test_record_in_memory_is_replayed_like_its_file(self):
        of_file = framewatch.replay(self.building, self.record)
        record = framewatch.read_record(self.record)
        of_memory = framewatch.replay(self.building, record)
        np.testing.assert_array_equal(of_memory.value, of_file.value)
        own = framewatch.Record(record.names, record.time_s, record.accel)
        np.testing.assert_array_equal(framewatch.replay(self.building, own).value, of_file.value)
        halves = [
            framewatch.Record(record.names, record.time_s[part], record.accel[part])
            for part in (slice(0, 900), slice(900, None))
        ]
        np.testing.assert_array_equal(framewatch.replay(self.building, halves).value, of_file.value)

    def test_reads_what_convert_reads(self):
        expected = framewatch.read_record(self.record)
        self.assertEqual(expected.units, ["m/s^2"] * 4)
        self.assertEqual(expected.start_s, 0)
        self.assertAlmostEqual(expected.rate_hz, 100)
        np.testing.assert_array_equal(expected["floor2"], expected.accel[:, 2])
        run("convert", self.record, self.dir / "r.csv.gz")
        run("convert", "--config", self.building, self.record, self.dir / "r.lcmlog")
        for name in ("r.csv.gz", "r.lcmlog"):
            found = framewatch.read_record(self.dir / name)
            self.assertEqual(found.names, expected.names)
            np.testing.assert_array_equal(found.accel, expected.accel)
            np.testing.assert_array_equal(found.time_s, expected.time_s)

    def test_options_of_formats(self):
        path = self.dir / "logger.csv"
        path.write_text("t;a\n0;1,5\n10;-2\n20;0,25\n")
        record = framewatch.read_record(
            path, time="t", time_unit="ms", decimal="comma", unit="g", names=["floor"]
        )
        np.testing.assert_allclose(record.accel[:, 0], np.array([1.5, -2, 0.25]) * 9.80665)
        np.testing.assert_allclose(record.time_s, [0, 0.01, 0.02])
        self.assertEqual(record.names, ["floor"])

    def test_several_files_of_one_motion(self):
        for name in ("a", "b"):
            (self.dir / f"{name}.csv").write_text(f"time_s,{name}\n0,1\n0.01,2\n0.02,3\n")
        record = framewatch.read_record([self.dir / "a.csv", str(self.dir / "b.csv")])
        self.assertEqual(record.names, ["a", "b"])
        self.assertEqual(record.accel.shape, (3, 2))

    def test_force_has_its_unit(self):
        text = self.building.read_text().replace(
            "[estimator]",
            '[[channel]]\nname = "shaker"\nstory = 3\nframe = "y1"\nquantity = "force"\n'
            'source = { lcm = "ACCEL", node = 9, axis = "x" }\n[estimator]',
        )
        building = framewatch.Building.from_toml(text)
        record = framewatch.simulate(
            (self.dir / "shaken.toml").read_text(), building=building, duration_s=1
        )
        self.assertEqual(record.units, ["m/s^2"] * 4 + ["N"])


class Building(Shaken):
    def test_properties(self):
        building = framewatch.Building.from_toml(self.building)
        self.assertEqual(building.name, "three-story model")
        self.assertEqual(building.stories, 3)
        self.assertEqual(building.channels, ["base", "floor1", "floor2", "floor3"])
        self.assertEqual(building.parameters[0], "kx_1_y1")
        self.assertEqual(building.units[0], "N/m")
        self.assertEqual(len(building.units), len(building.parameters))
        self.assertEqual((building.rate_hz, building.window_s), (100, 5))
        self.assertIsNone(building.design)
        self.assertIn("three-story model", repr(building))

    def test_text_and_path_are_the_same_building(self):
        of_text = framewatch.Building.from_toml(self.building.read_text())
        self.assertEqual(of_text.sha256, framewatch.Building.from_toml(str(self.building)).sha256)


if __name__ == "__main__":
    unittest.main()
