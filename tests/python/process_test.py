# SPDX-License-Identifier: MIT
"""Threads, Ctrl-C, callbacks, fork, pickle, and a second interpreter."""
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import framewatch
import numpy as np
from fixture import Shaken, run_python


class Told(Exception):
    pass


def tell(*_):
    raise Told("enough")


class Process(Shaken):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        record = framewatch.read_record(cls.record)
        step = record.time_s[-1] + 0.01
        cls.long = framewatch.Record(  # an hour: the replay takes many seconds
            record.names,
            np.concatenate([record.time_s + k * step for k in range(180)]),
            np.concatenate([record.accel] * 180),
        )

    def interrupted(self, call, delay_s=0):
        """Sends Ctrl-C `delay_s` after the call's first report. Returns the seconds until it ended."""
        sent = []

        def send():
            time.sleep(delay_s)
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        sender = threading.Thread(target=send)

        def begin(*_):
            if not sender.ident:
                sender.start()

        try:
            with self.assertRaises(KeyboardInterrupt):
                call(begin)
        finally:
            sender.join()
        return time.monotonic() - sent[0]

    def without_noise(self):
        """The text of a scenario. The level of noise would take a run in advance."""
        text = (self.dir / "shaken.toml").read_text()
        text = text.replace("noise_ratio = 0.01", "noise_ratio = 0")
        return text.replace('"building.toml"', f'"{self.building}"')

    def test_ctrl_c_ends_replay(self):
        took = self.interrupted(
            lambda begin: framewatch.replay(self.building, self.long, progress=begin)
        )
        self.assertLess(took, 5)
        self.assertGreater(len(framewatch.replay(self.building, self.record)), 1000)

    def test_ctrl_c_ends_simulate(self):
        took = self.interrupted(
            lambda begin: framewatch.simulate(
                self.without_noise(), duration_s=400_000, progress=begin
            )
        )
        self.assertLess(took, 5)

    def test_ctrl_c_during_push_tells_what_was_taken(self):
        estimator = framewatch.Estimator(self.building)

        def push(begin):
            begin()
            estimator.push(self.long.time_s, self.long.accel)

        self.interrupted(push, delay_s=0.1)
        taken = int(np.searchsorted(np.round(self.long.time_s * 1e6), estimator.newest_us)) + 1
        self.assertTrue(0 < taken < len(self.long))
        rest = slice(taken, taken + 300)
        more = estimator.push(self.long.time_s[rest], self.long.accel[rest])
        self.assertGreater(len(more), 300)  # with the windows that ended before

    def test_progress_of_replay(self):
        told = []
        framewatch.replay(
            self.building, self.long,
            progress=lambda what, share: told.append((what, share, threading.get_ident())),
        )
        self.assertGreater(len(told), 2)
        self.assertLessEqual({what for what, _, _ in told}, {"tuning", "replay"})
        shares = [share for what, share, _ in told if what == "replay"]
        self.assertEqual(shares, sorted(shares))
        self.assertTrue(all(0 <= share <= 1 for share in shares))
        self.assertEqual({thread for _, _, thread in told}, {threading.get_ident()})

    def test_callback_that_throws_ends_replay(self):
        with self.assertRaisesRegex(Told, "enough"):
            framewatch.replay(self.building, self.long, progress=tell)
        with self.assertRaisesRegex(Told, "enough"):
            framewatch.simulate(self.without_noise(), duration_s=400_000, progress=tell)

    def test_other_threads_run_during_a_replay(self):
        counted = 0
        result = []
        worker = threading.Thread(
            target=lambda: result.append(framewatch.replay(self.building, self.record))
        )
        worker.start()
        while worker.is_alive():
            counted += 1
            time.sleep(0.001)
        self.assertGreater(counted, 10)
        self.assertGreater(len(result[0]), 1000)

    def test_threads_share_an_estimator(self):
        estimator = framewatch.Estimator(self.building)
        record = framewatch.read_record(self.record)
        turn, windows, errors = [0], [], []
        changed = threading.Condition()

        def push(own):
            try:
                for i in range(own, 20, 2):
                    with changed:
                        changed.wait_for(lambda: turn[0] == i)
                    part = slice(100 * i, 100 * i + 100)
                    windows.append(len(estimator.push(record.time_s[part], record.accel[part])))
                    estimator.newest_us
                    with changed:
                        turn[0] += 1
                        changed.notify_all()
            except Exception as error:  # pylint: disable=broad-except
                errors.append(error)

        threads = [threading.Thread(target=push, args=(own,)) for own in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
        self.assertEqual(errors, [])
        whole = framewatch.Estimator(self.building).push(record.time_s[:2000], record.accel[:2000])
        self.assertEqual(sum(windows), len(whole))

    def test_fork(self):
        building = framewatch.Building.from_toml(self.building)
        record = framewatch.read_record(self.record)
        estimator = framewatch.Estimator(building)
        estimator.push(record.time_s[:1000], record.accel[:1000])
        expected = framewatch.replay(building, record).value.tobytes()
        read_end, write_end = os.pipe()
        child = os.fork()
        if child == 0:
            good = framewatch.replay(building, record).value.tobytes() == expected
            more = estimator.push(record.time_s[1000:], record.accel[1000:]).value
            os.write(write_end, b"same" if good else b"differs")
            os.write(write_end, str(len(more)).encode())
            os._exit(0)
        os.close(write_end)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        more = estimator.push(record.time_s[1000:], record.accel[1000:])
        self.assertEqual(os.read(read_end, 100), b"same" + str(len(more)).encode())
        os.close(read_end)

    def test_pickle(self):
        building = framewatch.Building.from_toml(self.building)
        copy = pickle.loads(pickle.dumps(building))
        self.assertIsInstance(copy, framewatch.Building)
        self.assertEqual(copy.sha256, building.sha256)
        estimates = framewatch.replay(copy, pickle.loads(pickle.dumps(
            framewatch.read_record(self.record))))
        np.testing.assert_array_equal(
            pickle.loads(pickle.dumps(estimates)).value, estimates.value
        )

    def test_a_second_interpreter_is_refused(self):
        inner = (
            f"import sys\nsys.path[:0] = {sys.path!r}\n"
            "try:\n"
            "    import framewatch\n"
            "    print('imported')\n"
            "except ImportError as error:\n"
            "    print('refused:', error)\n"
            "sys.stdout.flush()\n"
        )
        done = run_python(
            "import framewatch\n"
            "try:\n"
            "    import _xxsubinterpreters as interpreters\n"
            "except ImportError:\n"
            "    import _interpreters as interpreters\n"
            "second = interpreters.create()\n"
            f"interpreters.run_string(second, {inner!r})\n"
            "interpreters.destroy(second)\n"
            f"print(len(framewatch.replay({str(self.building)!r}, {str(self.record)!r})) > 1000)\n"
        )
        self.assertRegex(done.stdout, "refused: .*interpreter", done.stderr)
        self.assertNotIn("imported", done.stdout)
        self.assertTrue(done.stdout.rstrip().endswith("True"), done.stdout + done.stderr)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_nothing_is_left_of_an_interrupted_process(self):
        program = (
            "import framewatch, sys\n"
            "print('ready', flush=True)\n"
            f"framewatch.simulate({self.without_noise()!r}, duration_s=400_000)\n"
        )
        process = subprocess.Popen(
            [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True, cwd=self.dir,
        )
        self.assertEqual(process.stdout.readline(), "ready\n")
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)
        self.assertEqual(process.returncode, -signal.SIGINT)


if __name__ == "__main__":
    unittest.main()
