"""Controllers and force laws in Python."""
import gc
import json
import os
import tempfile
import unittest
import weakref

import numpy as np

import musclesim

line = {"muscle.model": "line"}


class Swing(musclesim.Controller):
    """Bends and stretches; reports a target and an activity."""

    def __init__(self):
        super().__init__()
        self.states = []

    def output(self, state):
        self.states.append(state)
        return np.array([0.5 + 0.3 * np.sin(6 * state.time_s), 0.5])

    def activity(self):
        return 0.25

    def target_mm(self):
        return [1, 2, 3]


class Failing(musclesim.Controller):
    def __init__(self, after_s, result):
        super().__init__()
        self.after_s, self.result = after_s, result

    def output(self, state):
        if state.time_s > self.after_s:
            return self.result()
        return [0.5, 0.5]


def fail():
    raise RuntimeError("the valve is stuck")


class Controllers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = os.path.join(self.folder.name, "run.csv")

    def sidecar(self):
        with open(self.file.replace(".csv", ".json"), encoding="utf-8") as file:
            return json.load(file)

    def test_subclass(self):
        swing = Swing()
        recording = musclesim.run("elbow", swing, 1, parameters=line)
        self.assertEqual(len(recording), 101)
        np.testing.assert_array_equal(recording["command_0"], 0.5 + 0.3 * np.sin(6 * recording["time_s"]))
        self.assertEqual(set(recording["activity"]), {0.25})
        self.assertEqual([recording[f"target_{axis}_mm"][0] for axis in "xyz"], [1, 2, 3])
        self.assertEqual(recording.info["controller"], "Swing")
        self.assertGreater(np.ptp(recording["angle_elbow_deg"]), 5)
        state = swing.states[50]  # a state may be kept: it is its own
        self.assertEqual(state.time_s, 0.5)
        self.assertEqual((state.length_mm.shape, state.angle_deg.shape, state.hand_mm.shape), ((2,), (1,), (3,)))
        self.assertEqual(state.angle_deg[0], recording["angle_elbow_deg"][50])
        self.assertFalse(state.length_mm.flags.writeable)

    def test_arrays_of_a_state_outlive_it(self):
        kept = []
        musclesim.run("elbow", lambda state: kept.append(state.length_mm) or [0.5, 0.5], 0.1, parameters=line)
        gc.collect()
        self.assertTrue(all(240 < length < 270 for lengths in kept for length in lengths), kept)

    def test_controllers_are_freed(self):
        swing = Swing()
        gone = weakref.ref(swing)
        musclesim.run("elbow", swing, 0.1, parameters=line)
        del swing
        gc.collect()
        self.assertIsNone(gone())

    def test_a_controller_that_knows_its_simulation_is_freed(self):
        simulation = musclesim.Simulation("elbow", parameters=line)
        swing = Swing()
        swing.simulation = simulation
        simulation.run(swing, 0.1)
        gone = weakref.ref(swing)
        del swing, simulation
        gc.collect()
        self.assertIsNone(gone())

    def expect(self, error, pattern, controller, complete_rows):
        with self.assertRaisesRegex(error, pattern):
            musclesim.run("elbow", controller, 2, parameters=line, record=self.file)
        self.assertEqual(self.sidecar()["complete"], False)
        self.assertEqual(self.sidecar()["verdict"]["status"], "failed")
        recording = musclesim.Recording.read(self.file)
        self.assertEqual(len(recording), complete_rows)

    def test_exception_leaves_the_files_complete_up_to_then(self):
        self.expect(RuntimeError, "the valve is stuck", Failing(0.5, fail), 51)
        self.assertIn("the valve is stuck", self.sidecar()["verdict"]["message"])

    def test_divergence_leaves_the_files_complete_up_to_then(self):
        with self.assertRaises(musclesim.Diverged):
            musclesim.run("elbow", lambda state: [state.time_s % 1, 0], 1000, record=self.file, substeps=1, step_s=0.5, initial_state="built")
        self.assertEqual((self.sidecar()["complete"], self.sidecar()["verdict"]["status"]), (False, "diverged"))
        self.assertGreater(len(musclesim.Recording.read(self.file)), 0)

    def test_wrong_outputs(self):
        for number, (result, pattern) in enumerate((([0.5], r"output = shape \(1,\): must be \(2,\)"),
                                                    ([0.5, float("nan")], r"output\[1\] = nan: must lie in 0 \.\. 1"),
                                                    (None, r"returned None: return an array of 2 pressures"), ("fast", "an array of numbers, not str"), ([2, 0], r"output\[0\] = 2"))):
            self.file = os.path.join(self.folder.name, f"run{number}.csv")
            self.expect(musclesim.BadParameter, pattern, Failing(0.5, lambda result=result: result), 51)

    def test_further_signals(self):
        class Following(Swing):
            def signals(self):
                return {"target_elbow_deg": 7.0, "controller_integral_kPa": 0.5}

        run = musclesim.run("elbow", Following(), 0.1, parameters=line, record=self.file)
        self.assertEqual((set(run["target_elbow_deg"]), set(run["controller_integral_kPa"])), ({7.0}, {0.5}))
        self.assertEqual(set(musclesim.Recording.read(self.file)["controller_integral_kPa"]), {0.5})
        self.assertNotIn("controller_integral_kPa", musclesim.replay(self.file).errors, "no robot has it")

        class Wrong(Swing):
            def signals(self):
                return [7]

        with self.assertRaisesRegex(musclesim.BadParameter, "dict of numbers"):
            musclesim.run("elbow", Wrong(), 0.1, parameters=line)

    def test_names_of_further_signals(self):
        class Names(Swing):
            def __init__(self, *dicts):
                super().__init__()
                self.dicts = list(dicts)

            def signals(self):
                return self.dicts.pop(0) if len(self.dicts) > 1 else self.dicts[0]

        for dicts, pattern in (([{"speed": 1.0}], 'column "speed": unknown quantity'), ([{"length_0_mm": 1.0}], "length_0_mm is given twice"),
                               ([{"target_elbow_rad": 1.0}], "canonical unit: target_elbow_deg"),
                               ([{"target_a_deg": 1.0}] * 4 + [{"target_b_deg": 1.0}], "the same names in the same order"),
                               ([{"target_a_deg": 1.0}] * 4 + [{}], "the same names in the same order")):
            with self.assertRaisesRegex(musclesim.BadParameter, pattern):
                musclesim.run("elbow", Names(*dicts), 0.1, parameters=line)

    def test_columns_that_come_and_go(self):
        class Lively(Swing):
            def activity(self):
                return None if len(self.states) < 3 else 0.5

        with self.assertRaisesRegex(musclesim.BadParameter, "at all times"):
            musclesim.run("elbow", Lively(), 0.1, parameters=line)

    def test_options_that_a_controller_does_not_heed(self):
        for controller, named in (("hold", {"commands": "a.csv"}), ("hold", {"targets": "a.csv"}), ("schedule", {"interpolate": "cubic"})):
            with self.assertRaises(musclesim.BadParameter):
                musclesim.run("elbow", controller, 1, **named)

    def test_what_is_no_controller(self):
        class Empty(musclesim.Controller):
            pass

        class Forgetful(musclesim.Controller):
            def __init__(self):
                pass

            def output(self, state):
                return [0.5, 0.5]

        for controller, error, pattern in ((Empty(), musclesim.BadParameter, "must define output"), (7, musclesim.BadParameter, "controller = 7"),
                                           (Swing, musclesim.BadParameter, "an object of a subclass"),
                                           ("assm", musclesim.BadParameter, 'did you mean "a?asm"')):
            with self.assertRaisesRegex(error, pattern):
                musclesim.run("elbow", controller, 1, parameters=line)
        with self.assertRaisesRegex(TypeError, "__init__"):
            Forgetful()

    def test_a_controller_cannot_step_the_simulation_that_asks_it(self):
        simulation = musclesim.Simulation("elbow", parameters=line)
        for call in (simulation.step, simulation.close, simulation.start, lambda: simulation.run("hold", 1)):
            with self.assertRaisesRegex(musclesim.BadParameter, "none from its own controller"):
                simulation.run(lambda state, call=call: call() and [0, 0], 1)
        self.assertEqual(len(simulation.run("hold", 1)), 101)

    def test_files_are_not_overwritten_unasked(self):
        musclesim.run("elbow", "hold", 0.1, parameters=line, record=self.file)
        with self.assertRaises(FileExistsError):
            musclesim.run("elbow", "hold", 0.1, parameters=line, record=self.file)
        musclesim.run("elbow", "hold", 0.2, parameters=line, record=self.file, overwrite=True)
        self.assertEqual(len(musclesim.Recording.read(self.file)), 21)
        with self.assertRaises(musclesim.IoError):
            musclesim.run("elbow", "hold", 0.1, parameters=line, record=os.path.join(self.folder.name, "no/such/run.csv"))

    def test_measured_recordings_are_never_overwritten(self):
        musclesim.Recording.from_dict({"time_s": [0, 0.01], "command_0": [0.1, 0.1], "command_1": [0, 0]}, robot="elbow").write(self.file)
        with self.assertRaisesRegex(musclesim.BadParameter, "did not simulate"):
            musclesim.run("elbow", "hold", 0.1, parameters=line, record=self.file, overwrite=True)

    def test_options_that_a_function_does_not_heed_are_refused(self):
        for option in ({"channels": "0"}, {"task": "reach"}, {"target_mm": [0, 0, 0]}, {"interpolate": "linear"}):
            with self.assertRaises(musclesim.BadParameter, msg=option):
                musclesim.run("elbow", lambda state: [0, 0], 0.1, parameters=line, **option)

    def test_wrong_times(self):
        for named in ({"duration_s": 0}, {"duration_s": float("nan")}, {"duration_s": 1, "record_interval_s": -1}):
            with self.assertRaises(musclesim.BadParameter):
                musclesim.run("elbow", "hold", parameters=line, **named)


class Same(musclesim.ForceLaw):
    """Eq. 1 by way of Python."""

    def __init__(self, minimum_length_mm, maximum_length_mm):
        super().__init__()
        self.law = musclesim.BraunForceLaw(minimum_length_mm, maximum_length_mm)

    def tension_N(self, pressure, length_mm):
        return self.law.tension_N(pressure, length_mm)

    def stiffness_N_per_mm(self, pressure, length_mm):
        return self.law.stiffness_N_per_mm(pressure, length_mm)


class Spring(musclesim.ForceLaw):
    """10 N at 200 mm, 0.5 N/mm, in proportion to the pressure."""

    def tension_N(self, pressure, length_mm):
        return pressure * (10 + 0.5 * (length_mm - 200))


class ForceLaws(unittest.TestCase):
    def test_eq_1_in_python_gives_the_bits_of_eq_1(self):
        for model, duration_s in ((line, 1), ({}, 0.2)):
            plain = musclesim.run("elbow", "random", duration_s, parameters=model)
            python = musclesim.run("elbow", "random", duration_s, parameters=model,
                                   force_law=lambda muscle, shortest, longest: Same(shortest, longest))
            for name in plain.keys():
                np.testing.assert_array_equal(plain[name], python[name], name)
            self.assertEqual(python.info["force_law"], "Same")

    def test_one_law_for_all_muscles(self):
        recording = musclesim.run("elbow", lambda state: [0.5, 0.25], 1, force_law=Spring(), parameters=line)
        for muscle, pressure in ((0, 0.5), (1, 0.25)):
            expected = pressure * (10 + 0.5 * (recording[f"length_{muscle}_mm"] - 200))
            np.testing.assert_allclose(recording[f"force_{muscle}_N"], expected, rtol=1e-12)
        self.assertAlmostEqual(Spring().stiffness_N_per_mm(0.5, 220), 0.25)

    def test_exceptions_and_wrong_results(self):
        class Bad(Spring):
            result = staticmethod(fail)
            calls = 0

            def tension_N(self, pressure, length_mm):
                self.calls += 1
                return self.result() if self.calls > 300 else super().tension_N(pressure, length_mm)

        for result, error, pattern in ((fail, RuntimeError, "stuck"), (lambda: "much", musclesim.BadParameter, "Bad.tension_N = 'much'"),
                                       (lambda: float("nan"), musclesim.Diverged, "tension is nan")):
            law = Bad()
            law.result = result
            simulation = musclesim.Simulation("elbow", force_law=law, parameters=line)
            with self.assertRaisesRegex(error, pattern):
                simulation.step([0.5, 0.5], 1000)
            with self.assertRaisesRegex((musclesim.BadParameter, musclesim.Diverged), "start|tension is nan"):
                simulation.step([0.5, 0.5])
            law.calls = -10**9
            simulation.start([0.5, 0.5])
            simulation.step([0.5, 0.5])

    def test_what_is_no_law(self):
        class Empty(musclesim.ForceLaw):
            pass

        with self.assertRaisesRegex(musclesim.BadParameter, "must define tension_N"):
            musclesim.Simulation("elbow", force_law=Empty(), parameters=line).start([0.5, 0.5])
        for law in (3, lambda muscle, shortest, longest: None):
            with self.assertRaisesRegex(musclesim.BadParameter, "force_law"):
                musclesim.Simulation("elbow", force_law=law)


if __name__ == "__main__":
    unittest.main()
