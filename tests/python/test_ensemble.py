"""Many simulations at once."""
import os
import threading
import time
import unittest

import numpy as np

import musclesim

line = {"muscle.model": "line"}


class Ensembles(unittest.TestCase):
    def test_results_do_not_depend_on_the_number_of_threads(self):
        def work(seed):
            return musclesim.run("elbow", "random", 5, seed=seed, parameters=line)["angle_elbow_deg"]

        def work_in_python(seed):
            return musclesim.run("elbow", lambda state: [0.5, seed / 10], 1, parameters=line)["angle_elbow_deg"]

        for function in (work, work_in_python):
            one, three = (musclesim.ensemble(function, range(6), threads=threads) for threads in (1, 3))
            for alone, together in zip(one, three):
                np.testing.assert_array_equal(alone, together)
            self.assertFalse(np.array_equal(one[0], one[1]))

    def test_the_first_exception_is_raised(self):
        def work(item):
            if item in (2, 4):
                raise KeyError(item)
            return item

        with self.assertRaisesRegex(KeyError, "2"):
            musclesim.ensemble(work, range(6), threads=3)
        self.assertEqual(musclesim.ensemble(work, [], threads=3), [])

    def test_python_goes_on_while_a_run_does(self):
        """The lock is given away: the main thread counts on while another thread simulates."""
        done, counts = threading.Event(), []

        def work():
            musclesim.run("arm", "hold", 0.5)
            done.set()

        thread = threading.Thread(target=work)
        thread.start()
        while not done.is_set():
            counts.append(time.perf_counter())
            time.sleep(0.001)
        thread.join()
        self.assertGreater(len(counts), 20)

    @unittest.skipIf(len(os.sched_getaffinity(0)) < 2, "one processor")
    def test_two_threads_simulate_at_the_same_time(self):
        """Processor time of the process passes faster than its clock. Other work on the machine slows both; so one of ten tries must do."""
        def work(seed):
            return len(musclesim.run("arm", "hold", 0.3, seed=seed))

        best = 0.0
        for _ in range(10):
            clock, processor = time.perf_counter(), time.process_time()
            musclesim.ensemble(work, range(4), threads=2)
            best = max(best, (time.process_time() - processor) / (time.perf_counter() - clock))
            if best > 1.2:
                break
        if best <= 1.05:
            self.skipTest(f"the machine gives this process {best:.2f} processors")
        self.assertGreater(best, 1.05)


if __name__ == "__main__":
    unittest.main()
