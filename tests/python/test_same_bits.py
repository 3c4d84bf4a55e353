"""The program and the module write the same bytes for the same input and seed."""
import json
import os
import subprocess
import tempfile
import unittest

import musclesim

program = os.environ["MUSCLESIM_PROGRAM"]
robots = os.environ["MUSCLESIM_ROBOTS"]
line = {"muscle.model": "line"}
noise = {"sensor.length_noise_mm": 0.05, "sensor.angle_noise_deg": 0.1}
lag = [{"id": "valve_lag", "component": "all", "parameters": {"fill_time_constant_s": 0.08}},
       {"id": "sensor_bias", "component": "signal_length_0", "parameters": {"offset": 1.5}}]


class SameBits(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.mkdir(self.path("python"))

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def call(self, *arguments):
        result = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def compare(self, arguments, robot, controller, duration_s, **options):
        self.call("run", "--simple", "--quiet", "--robot", robot, "--controller", controller, "--duration", str(duration_s),
                  "--out", self.path("program"), *arguments)
        recording = musclesim.run(robot, controller, duration_s, record=self.path("python/run.csv"), **options)
        with open(self.path("program/run.csv"), "rb") as theirs, open(self.path("python/run.csv"), "rb") as ours:
            self.assertEqual(theirs.read(), ours.read())
        with open(self.path("program/run.json"), encoding="utf-8") as theirs, open(self.path("python/run.json"), encoding="utf-8") as ours:
            theirs, ours = json.load(theirs), json.load(ours)
        self.assertEqual(theirs.pop("verdict")["status"], ours.pop("verdict")["status"])
        theirs.pop("run")  # arguments and files of the command line, which the module does not have
        self.assertEqual(theirs, ours)
        recording.write(self.path("memory.csv"))
        with open(self.path("program/run.csv"), "rb") as theirs, open(self.path("memory.csv"), "rb") as ours:
            self.assertEqual(theirs.read(), ours.read())

    def test_elbow_with_effects_and_noise(self):
        with open(self.path("effects.json"), "w", encoding="utf-8") as file:
            json.dump({"format": "musclesim-effects-1", "effects": lag}, file)
        settings = [f"{name}={value}" for name, value in noise.items()]
        arguments = ["--seed", "7", "--effects", self.path("effects.json")]
        for setting in settings:
            arguments += ["--set", setting]
        self.compare(arguments, "elbow", "random", 4, seed=7, parameters=noise, effects=lag)
        from_file = musclesim.run("elbow", "random", 4, seed=7, parameters=noise, effects=self.path("effects.json"))
        from_file.write(self.path("file.csv"))
        with open(self.path("python/run.csv"), "rb") as ours, open(self.path("file.csv"), "rb") as theirs:
            self.assertEqual(ours.read(), theirs.read())

    def test_line_muscles_and_a_record_interval(self):
        self.compare(["--muscle", "line", "--record-interval", "0.05", "--step", "0.005"], "elbow", "random", 10, parameters=line,
                     record_interval_s=0.05, step_s=0.005)

    def test_arm_under_asm_with_target_and_activity(self):
        self.compare(["--seed", "3", "--task", "reach", "--target", "-300,0,150", "--decision-interval", "0.1"], "arm", "asm", 0.3, seed=3,
                     task="reach", target_mm=[-300, 0, 150], decision_interval_s=0.1)

    def test_rig_in_original_physics(self):
        self.compare(["--physics", "original", "--set", "hold.pressure=0.3"], "rig", "hold", 1, physics="original",
                     parameters={"hold.pressure": 0.3})

    def test_robot_file(self):
        self.compare(["--muscle", "line"], os.path.join(robots, "wrist.toml"), "random", 2, parameters=line)

    def test_position_control_with_its_own_targets(self):
        """Its further columns, and the end of its targets as the duration."""
        with open(self.path("targets.csv"), "w", encoding="utf-8") as file:
            file.write("time_s,target_elbow_deg\n0,0\n0.5,10\n1,0\n")
        self.compare(["--muscle", "line", "--targets", self.path("targets.csv")], "elbow", "position", 1, parameters=line,
                     targets=self.path("targets.csv"))
        recording = musclesim.run("elbow", "position", parameters=line, targets=self.path("targets.csv"))
        self.assertEqual(recording["time_s"][-1], 1)
        self.assertIn("target_elbow_deg", recording)

    def test_schedule(self):
        musclesim.run("elbow", "triangle", 2, parameters=line, record=self.path("played.csv"), record_interval_s=0.1)
        self.compare(["--muscle", "line", "--commands", self.path("played.csv"), "--interpolate", "linear"], "elbow", "schedule", 2,
                     parameters=line, commands=self.path("played.csv"), interpolate="linear")

    def test_default_controllers(self):
        self.assertEqual(musclesim.run("rig", duration_s=0.1).info["controller"], "triangle")
        self.assertEqual(musclesim.run("arm", duration_s=0.02).info["controller"], "asm")
        self.assertEqual(musclesim.run("elbow", duration_s=0.1, task="height").info["controller"], "asm")

    def test_replay(self):
        musclesim.run("rig", "random", 5, record=self.path("run.csv"), decision_interval_s=1)
        verdict = json.loads(self.call("replay", self.path("run.csv"), "--set", "rig.load_kg=2.2", "--json", "--quiet",
                                       "--out", self.path("program.csv")).splitlines()[-1])
        replay = musclesim.replay(self.path("run.csv"), parameters={"rig.load_kg": 2.2})
        self.assertEqual(verdict["signals"], replay.errors)
        self.assertGreater(replay.errors["length_0_mm"]["rmse"], 0.1)
        replay.simulated.write(self.path("python/run.csv"))
        with open(self.path("program.csv"), "rb") as theirs, open(self.path("python/run.csv"), "rb") as ours:
            self.assertEqual(theirs.read(), ours.read())

    def test_steps_one_by_one(self):
        """A loop in Python: the same as a run under the same commands."""
        recording = musclesim.run("elbow", lambda state: [0.5 + state.time_s, 0.2], 0.3, parameters=line)
        with musclesim.Simulation("elbow", parameters=line) as simulation:
            simulation.start([0.5, 0.2])
            for row in range(len(recording)):
                readings = simulation.command([0.5 + simulation.time_s, 0.2])
                for place, name in enumerate(simulation.signals):
                    self.assertEqual(readings[place], recording[name][row], name)
                simulation.step()


if __name__ == "__main__":
    unittest.main()
