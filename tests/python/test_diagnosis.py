"""Diagnosing from Python."""
import json
import os
import tempfile
import unittest

import numpy as np

import musclesim

lag = [{"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.1, "vent_time_constant_s": 0.15}}]


def measured(seed):
    """A recording of a rig with a lag that its sidecar does not know of."""
    run = musclesim.run("rig", "random", 6, seed=seed, decision_interval_s=0.5, record_interval_s=0.02, effects=lag,
                        parameters={"sensor.length_noise_mm": 0.05, "muscle.model": "line"})
    return musclesim.Recording.from_dict({name: run[name] for name in ("time_s", "command_0", "pressure_0", "length_0_mm")}, robot="rig",
                                         robot_parameters={"muscle.model": "line"}, noise_std={"length_0_mm": 0.05})


class Diagnoses(unittest.TestCase):
    def test_finds_the_lag(self):
        phases = []
        answer = musclesim.diagnose([measured(1), measured(2)], candidates=["valve_lag", "sensor_gain"], threads=1,
                                    progress=lambda phase, done, expected: phases.append((phase, done, expected)))
        self.assertEqual(answer.verdict, "effects_found")
        self.assertEqual([cause.split("@")[0] for cause in answer.causes], ["valve_lag"])
        self.assertAlmostEqual(answer.effects[0]["parameters"]["fill_time_constant_s"], 0.1, delta=0.01)
        self.assertEqual(answer.data["recordings"], ["recording 1", "recording 2"])
        self.assertGreater(max(answer.probabilities.values()), 0.5)
        self.assertTrue(phases)
        self.assertTrue(all(isinstance(phase, str) and isinstance(done, int) for phase, done, _ in phases))
        self.assertIn("valve_lag", str(answer))
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "attempt.json"), "w", encoding="utf-8") as of_an_earlier_diagnosis:
                of_an_earlier_diagnosis.write("{}")
            answer.save(folder)
            proposal = ["next.csv", "next.json"] if answer.data.get("next_experiment") else []
            self.assertEqual(sorted(os.listdir(folder)), sorted(["diagnosis.json", "effects.json", "nominal.toml", *proposal, "report.html"]))
            with open(os.path.join(folder, "nominal.toml"), encoding="utf-8") as file:
                self.assertIn("rig.load_kg = ", file.read())
            with open(os.path.join(folder, "diagnosis.json"), encoding="utf-8") as file:
                self.assertEqual(json.load(file)["format"], "musclesim-diagnosis-1")
            gone = musclesim.replay(measured(3), effects=os.path.join(folder, "effects.json")).errors["length_0_mm"]["rmse"]
            both = musclesim.replay(measured(3), effects=answer.effects, parameters=answer.parameters).errors["length_0_mm"]["rmse"]
        before = musclesim.replay(measured(3)).errors["length_0_mm"]["rmse"]
        self.assertLess(gone, before / 5)
        self.assertIn("rig.load_kg", answer.parameters)
        self.assertLess(both, before / 5)

    def test_saves_the_proposed_commands(self):
        def plant(number):
            """A payload at almost a single pressure, where a stronger muscle would do the same."""
            step = lambda state: [0.29 + 0.01 * number + (0.02 if state.time_s >= 0.5 else 0)]
            run = musclesim.run("rig", step, 1, seed=number, effects=[{"id": "payload", "component": "hand", "parameters": {"mass_kg": 0.2}}],
                                parameters={"sensor.length_noise_mm": 0.3, "rig.load_kg": 1.5})
            return musclesim.Recording.from_dict({name: run[name] for name in ("time_s", "command_0", "length_0_mm")}, robot="rig",
                                                 robot_parameters={"load_kg": 1.5})

        answer = musclesim.diagnose([plant(1), plant(2)], candidates=["payload", "force_gain"], threads=1)
        self.assertTrue(answer.data.get("next_experiment"), "something is left to tell apart")
        with tempfile.TemporaryDirectory() as folder:
            answer.save(folder)
            proposal = musclesim.Recording.read(os.path.join(folder, "next.csv"))
            self.assertEqual((proposal.robot, proposal.keys()), ("rig", ["time_s", "command_0"]))
            musclesim.replay(proposal)

    def test_without_the_effects_that_the_sidecar_says_are_active(self):
        known = [musclesim.Recording.from_dict(one.to_dict(), **one.info, active_effects=lag) for one in (measured(1), measured(2))]
        self.assertEqual(musclesim.diagnose(known, candidates=["valve_lag"], threads=1).verdict, "no_gap")
        answer = musclesim.diagnose(known, candidates=["valve_lag"], threads=1, without_active_effects=True)
        self.assertEqual([cause.split("@")[0] for cause in answer.causes], ["valve_lag"])

    def test_exception_of_the_progress_ends_it(self):
        def refuse(phase, done, expected):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            musclesim.diagnose([measured(1), measured(2)], progress=refuse)

    def test_refusals(self):
        with self.assertRaisesRegex(musclesim.BadParameter, "valve_lg"):
            musclesim.diagnose(measured(1), candidates=["valve_lg"])
        with self.assertRaises(musclesim.BadParameter):
            musclesim.diagnose([])
        with self.assertRaisesRegex(musclesim.BadFile, "recording 1: it has no signal"):
            musclesim.diagnose(musclesim.Recording.from_dict({"time_s": np.arange(3.0), "command_0": np.zeros(3)}, robot="rig"))
        with self.assertRaises(TypeError):
            musclesim.diagnose([7])


if __name__ == "__main__":
    unittest.main()
