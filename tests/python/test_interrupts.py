"""Ctrl-C ends whatever goes on, soon, in KeyboardInterrupt; files are complete up to then."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import musclesim

begin = "import musclesim, numpy as np\nprint('begun', flush=True)\n"


class Interrupts(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = os.path.join(self.folder.name, "run.csv")

    def interrupt(self, script, after_s=0.7):
        """Runs a script, sends it SIGINT and returns its errors."""
        child = subprocess.Popen([sys.executable, "-c", begin + script, self.file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "begun\n")
        latest = time.monotonic() + 60
        while "sys.argv[1]" in script and not os.path.exists(self.file) and time.monotonic() < latest:
            time.sleep(0.05)  # a busy machine may take long to begin the recording
        time.sleep(after_s)
        self.assertIsNone(child.poll(), "ended before it was interrupted")
        sent = time.monotonic()
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=60)
        self.assertLess(time.monotonic() - sent, 30)
        self.assertIn("KeyboardInterrupt", errors)
        self.assertEqual(child.returncode, -signal.SIGINT, errors)

    def expect_partial_recording(self):
        with open(self.file.replace(".csv", ".json"), encoding="utf-8") as file:
            sidecar = json.load(file)
        self.assertEqual((sidecar["complete"], sidecar["verdict"]["status"]), (False, "interrupted"))
        recording = musclesim.Recording.read(self.file)
        self.assertGreater(len(recording), 1)
        self.assertLess(recording["time_s"][-1], 1e6)

    def test_run(self):
        self.interrupt("import sys; musclesim.run('elbow', 'random', 1e6, record=sys.argv[1], record_interval_s=0.1)")
        self.expect_partial_recording()

    def test_run_under_a_controller_in_python(self):
        self.interrupt("import sys; musclesim.run('elbow', lambda s: [.5, .5], 1e6, record=sys.argv[1], record_interval_s=0.1)")
        self.expect_partial_recording()

    def test_controller_that_never_returns(self):
        self.interrupt("""
import sys
def output(state):
    while state.time_s > 0.5: pass
    return [.5, .5]
musclesim.run('elbow', output, 1e6, record=sys.argv[1], parameters={'muscle.model': 'line'})""")
        self.expect_partial_recording()

    def test_steps(self):
        self.interrupt("musclesim.Simulation('elbow').step([.5, .5], 10**9)")
        self.interrupt("s = musclesim.Simulation('elbow')\nwhile True: s.step([.5, .5])")

    def test_a_simulation_goes_on_after_interrupted_steps(self):
        simulation = musclesim.Simulation("elbow", parameters={"muscle.model": "line"})
        simulation.start([0.5, 0.4])
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        before = signal.signal(signal.SIGALRM, signal.default_int_handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                simulation.step(count=10**9)
        finally:
            signal.signal(signal.SIGALRM, before)
        time_s = simulation.time_s
        self.assertGreater(time_s, 0)
        simulation.step()
        self.assertAlmostEqual(simulation.time_s, time_s + 0.01)

    def test_replay(self):
        self.interrupt("""
t = np.arange(10**6) * 0.01
r = musclesim.Recording.from_dict({'time_s': t, 'command_0': 0.5 + 0.4 * np.sin(t), 'length_0_mm': t * 0 + 250}, robot='rig')
musclesim.replay(r)""", after_s=5)

    def test_ensemble(self):
        self.interrupt("musclesim.ensemble(lambda seed: musclesim.run('elbow', 'random', 1e6, seed=seed, record_interval_s=1), range(4), 2)")

    def test_ensemble_of_loops_in_python(self):
        self.interrupt("""
def work(seed):
    simulation = musclesim.Simulation('elbow', seed=seed, parameters={'muscle.model': 'line'})
    while True: simulation.step([.5, .5])
musclesim.ensemble(work, range(4), 2)""")

    def test_diagnose(self):
        self.interrupt("""
runs = [musclesim.run('elbow', 'random', 10, seed=s, decision_interval_s=0.5, effects=[{'id': 'valve_lag', 'component': 'all',
        'parameters': {'fill_time_constant_s': 0.1, 'vent_time_constant_s': 0.2}}],
        parameters={'sensor.angle_noise_deg': 0.05}) for s in (1, 2)]
bare = [musclesim.Recording.from_dict({k: r[k] for k in r.keys()}, robot='elbow') for r in runs]
musclesim.diagnose(bare)""", after_s=6)


if __name__ == "__main__":
    unittest.main()
