"""Many poses at once: the numbers of one at a time, arrays as they are, no memory left behind, Ctrl-C."""

import os
import pickle
import resource
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
import unittest

import numpy as np

import deflect


def poses_of(n, seed=1):
    random = np.random.default_rng(seed)
    poses = np.zeros((n, 6))
    poses[:, :3] = [0, 0, 173.9] + random.uniform(-25, 25, (n, 3))
    poses[:, 3:] = random.uniform(-5, 5, (n, 3))
    return poses


class ManyPoses(unittest.TestCase):
    def setUp(self):
        self.m = deflect.load("haptic-6psu")

    def test_as_one_at_a_time(self):
        poses = poses_of(30)
        loads = np.random.default_rng(2).uniform(-50, 50, (30, 6))
        by_theory = self.m.solve_many(poses, loads, theory="all")
        self.assertEqual(list(by_theory), list(deflect.theories))
        for name, (d, K) in by_theory.items():
            self.assertEqual((d.shape, K.shape), ((30, 6), (30, 6, 6)))
            for i, (pose, load) in enumerate(zip(poses, loads)):
                one = self.m.solve(pose, load).by_theory[name]
                # The sweep condenses the device: another order of sums, contacts solved to 1e-12 of their force.
                np.testing.assert_allclose(d[i], one.displacement, rtol=0, atol=1e-9 * np.abs(one.displacement).max())
                np.testing.assert_allclose(K[i], one.stiffness, rtol=0, atol=1e-9 * np.abs(one.stiffness).max())

    def test_shapes_and_theories(self):
        poses, load = poses_of(5), [50, 0, 0]
        K = self.m.stiffness(poses, load)
        self.assertEqual(K.shape, (5, 6, 6))
        both = self.m.stiffness(poses, load, theory="all")
        np.testing.assert_array_equal(K, both["msa"])
        np.testing.assert_array_equal(self.m.stiffness(poses, load, theory="analytic"), both["analytic"])
        self.assertEqual(list(self.m.stiffness(poses, load, theory=["analytic"])), ["analytic"])
        self.assertEqual(self.m.displacement(poses[0], load).shape, (6,))
        self.assertEqual(self.m.stiffness(poses[0], load).shape, (6, 6))
        self.assertEqual(self.m.displacement(poses[:, :3], load).shape, (5, 6))
        self.assertEqual(self.m.displacement(np.zeros((0, 6)), load).shape, (0, 6))

    def test_threads_change_no_bit(self):
        poses, load = poses_of(700), [0, 0, 50]
        one = self.m.stiffness(poses, load, threads=1)
        for threads in (2, 3):
            np.testing.assert_array_equal(self.m.stiffness(poses, load, threads=threads), one)

    def test_layout_of_the_array_changes_nothing(self):
        poses, load = poses_of(50), [50, 0, 0]
        d = self.m.displacement(poses, load)
        np.testing.assert_array_equal(self.m.displacement(np.asfortranarray(poses), load), d)
        np.testing.assert_array_equal(self.m.displacement(poses.tolist(), load), d)
        backwards = poses[::-1]
        np.testing.assert_array_equal(self.m.displacement(backwards, load),
                                      self.m.displacement(np.ascontiguousarray(backwards), load))

    def test_arrays_are_not_copied(self):
        """Peak memory of NumPy: beside the result nothing of the size of C-contiguous poses, loads or the result."""
        poses = poses_of(20_000)
        loads = np.tile([50.0, 0, 0, 0, 0, 0], (len(poses), 1))

        def peak(poses, loads):
            tracemalloc.start()
            d = self.m.displacement(poses, loads, theory="analytic")
            most = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            return most / d.nbytes

        self.assertLess(peak(poses, loads), 1.1)
        self.assertGreater(peak(np.asfortranarray(poses), loads), 1.9)  # such a copy would be seen
        self.assertGreater(peak(poses, loads.astype(np.float32)), 1.9)

    def test_SI(self):
        poses = poses_of(10)
        si = poses.copy()
        si[:, :3] /= 1e3
        si[:, 3:] = np.deg2rad(si[:, 3:])
        d, K = self.m.solve_many(poses, [50, 0, 0, 100, 0, 0])
        dd, KK = self.m.solve_many(si, [50, 0, 0, 0.1, 0, 0], units="SI")
        np.testing.assert_allclose(dd, d * ([1e-3] * 3 + [1] * 3), rtol=1e-8, atol=1e-13)
        factors = np.block([[np.full((3, 3), 1e3), np.ones((3, 3))], [np.ones((3, 3)), np.full((3, 3), 1e-3)]])
        np.testing.assert_allclose(KK, K * factors, rtol=1e-7, atol=1e-6 * np.abs(KK).max())

    def test_out_of_reach(self):
        poses = poses_of(3)
        poses[1, 0] = 1000
        with self.assertRaisesRegex(deflect.MechanismError, "^pose 1: "):
            self.m.displacement(poses, [50, 0, 0])
        d = self.m.displacement(poses, [50, 0, 0], out_of_reach="nan")
        self.assertEqual(np.isnan(d).any(axis=1).tolist(), [False, True, False])

    def test_refused(self):
        with self.assertRaisesRegex(deflect.InputError, "loads: 2 rows for 3 poses"):
            self.m.displacement(poses_of(3), np.zeros((2, 6)))
        with self.assertRaises(deflect.InputError):
            self.m.displacement(np.full((2, 6), np.nan))
        with self.assertRaises(deflect.InputError):
            self.m.displacement(np.zeros((2, 5)))
        with self.assertRaisesRegex(deflect.InputError, "msa"):
            self.m.stiffness(poses_of(2), theory="mas")

    def test_nothing_is_left_behind(self):
        """Peak memory after many calls, errors too, is that after some."""
        m, poses, load = self.m, poses_of(50), [50.0, 0, 0]

        def calls(n):
            for _ in range(n):
                m.stiffness(poses, load)
                m.solve(poses[0], load).displacement
                try:
                    m.displacement([1000, 0, 0])
                except deflect.MechanismError:
                    pass

        calls(30)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        calls(300)
        # One leaked result of a call (50 × 36 numbers) each time would be 4 MB.
        self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 2048)

    def test_resident_memory_stays_flat(self):
        """Calls for one pose, and now and then results, members of them, copies and errors. DEFLECT_CALLS=1000000 for a
        long run; what a leak of one array of six numbers would be then is 100 MB."""
        m, pose, load = self.m, np.array([25, 25, 198.9, 0, 0, 0.0]), np.array([50.0, 0, 0, 0, 0, 0])

        def calls(n):
            for i in range(n):
                m.displacement(pose, load, theory=None if i % 10 == 0 else "analytic")
                if i % 300 == 0:
                    s = pickle.loads(pickle.dumps(m.solve(pose, load)))
                    s.by_theory["msa"].stiffness  # noqa: B018
                    m.edited("materials.*.E", 1.01, "multiply")
                    with self.assertRaises(deflect.MechanismError):
                        m.displacement([1000, 0, 0])

        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * resource.getpagesize()

        n = int(os.environ.get("DEFLECT_CALLS", 3000))
        calls(max(1000, n // 100))
        before = resident()
        calls(n)
        grown = resident() - before
        if n > 3000:
            print(f"{n} calls: {before / 1e6:.1f} MB before, {grown / 1e6:+.2f} MB after")
        self.assertLess(grown, 1e6)

    def test_progress_is_told_and_may_end_the_work(self):
        told = []
        self.m.stiffness(poses_of(300), [50, 0, 0], progress=told.append)
        self.assertEqual(told[-1], 1)
        self.assertEqual(told, sorted(told))

        def enough(share):
            raise StopIteration("enough")

        with self.assertRaises(StopIteration):
            self.m.stiffness(poses_of(200_000), [50, 0, 0], progress=enough)

    def test_ctrl_c(self):
        """A million poses take seconds; interrupted after half a second they end well before."""
        code = ("import deflect, numpy as np\n"
                "poses = np.zeros((1000000, 6)); poses[:, 2] = 180\n"
                "m = deflect.load('haptic-6psu'); m.solve(); print('ready', flush=True)\n"
                "try:\n    m.stiffness(poses, [50, 0, 0], theory='all')\n"
                "except KeyboardInterrupt:\n    print('interrupted', flush=True)\n")
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as child:
            self.assertEqual(child.stdout.readline(), "ready\n")
            time.sleep(0.5)
            sent = time.monotonic()
            child.send_signal(signal.SIGINT)
            self.assertEqual(child.stdout.readline(), "interrupted\n")
            self.assertLess(time.monotonic() - sent, 2)
        self.assertEqual(child.returncode, 0)

    def test_the_interpreter_is_free_meanwhile(self):
        counted, stop = [0], threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
                time.sleep(0.001)

        beside = threading.Thread(target=count)
        beside.start()
        self.m.stiffness(poses_of(20_000), [50, 0, 0], threads=1)
        stop.set()
        beside.join()
        self.assertGreater(counted[0], 5)


if __name__ == "__main__":
    unittest.main()
