"""Simulations step by step: arrays, refusals, the end."""
import threading
import unittest

import numpy as np

import musclesim

line = {"muscle.model": "line"}


class Arrays(unittest.TestCase):
    def test_readings_are_one_array_that_is_filled_anew(self):
        simulation = musclesim.Simulation("elbow", parameters=line)
        first = simulation.start([0.2, 0.2])
        before = first.copy()
        second = simulation.step([0.6, 0.2], count=20)
        self.assertTrue(np.shares_memory(first, second))
        self.assertTrue(np.shares_memory(simulation.length_mm, first))
        self.assertFalse(np.array_equal(before, second))
        self.assertEqual(first.shape, (len(simulation.signals),))
        self.assertEqual(first.dtype, np.float64)
        for part, begin in (("pressure", "pressure_0"), ("force_N", "force_0_N"), ("length_mm", "length_0_mm"),
                            ("angle_deg", "angle_elbow_deg"), ("hand_mm", "hand_x_mm")):
            self.assertEqual(getattr(simulation, part)[0], second[simulation.signals.index(begin)], part)
        self.assertEqual(simulation.hand_mm.shape, (3,))
        with self.assertRaises(ValueError):
            second[0] = 1

    def test_more_pressure_in_the_flexor_bends_the_elbow(self):
        simulation = musclesim.Simulation("elbow", parameters=line)
        simulation.start([0.3, 0.3])
        self.assertAlmostEqual(simulation.angle_deg[0], 0, places=6)
        simulation.step([0.6, 0.2], 200)
        self.assertGreater(simulation.angle_deg[0], 5)
        self.assertAlmostEqual(simulation.time_s, 2)

    def test_the_hand_of_a_robot_without_one(self):
        self.assertEqual(musclesim.Simulation("rig").hand_mm.shape, (0,))

    def test_start_again_gives_the_same_bits_and_a_seed_others(self):
        noisy = dict(line, **{"sensor.angle_noise_deg": 0.1})
        simulation = musclesim.Simulation("elbow", parameters=noisy, seed=3)

        def episode(**start):
            simulation.start([0.2, 0.2], **start)
            return simulation.step([0.6, 0.2], 30).copy()

        first, again, other = episode(), episode(), episode(seed=4)
        self.assertTrue(np.array_equal(first, again))
        self.assertFalse(np.array_equal(first, other))
        self.assertTrue(np.array_equal(episode(seed=3), first))

    def test_any_array_of_numbers_is_a_command(self):
        simulation = musclesim.Simulation("elbow", parameters=line)
        wide = np.array([0.6, 9, 0.2, 9])
        for command in ([0.6, 0.2], (0.6, 0.2), np.array([0.6, 0.2]), wide[::2]):
            simulation.command(command)
            self.assertEqual(list(simulation.observe()[:2]), [0.6, 0.2])
        simulation.command(np.array([1, 0]))
        self.assertEqual(list(simulation.observe()[:2]), [1, 0])


class Refusals(unittest.TestCase):
    def refused(self, pattern, function, *arguments, **named):
        with self.assertRaisesRegex(musclesim.BadParameter, pattern) as caught:
            function(*arguments, **named)
        self.assertIsInstance(caught.exception, ValueError)

    def test_wrong_commands(self):
        simulation = musclesim.Simulation("elbow", parameters=line)
        simulation.start([0.2, 0.2])
        for call in (simulation.command, simulation.step, simulation.start):
            self.refused(r"command = shape \(3,\): must be \(2,\)", call, [0.1, 0.2, 0.3])
            self.refused(r"command = shape \(1, 2\): must have one axis", call, [[0.1, 0.2]])
            self.refused(r"command = shape \(\): must have one axis", call, 0.5)
            self.refused(r"command\[1\] = nan: must lie in 0 \.\. 1", call, [0.1, float("nan")])
            self.refused(r"command\[0\] = inf", call, [float("inf"), 0.1])
            self.refused(r"command\[0\] = 1\.5", call, [1.5, 0.1])
            self.refused(r"must be an array of numbers, not str", call, "fast")
        self.assertEqual(list(simulation.observe()[:2]), [0.2, 0.2])
        self.refused("count = 0", simulation.step, [0.1, 0.1], 0)

    def test_wrong_models(self):
        self.refused('robot', musclesim.Simulation, "elbw")
        self.refused("physics", musclesim.Simulation, "elbow", physics="si2")
        self.refused("step", musclesim.Simulation, "elbow", step_s=0)
        self.refused("effect", musclesim.Simulation, "elbow", effects=[{"component": "all"}])
        self.refused("valve_lg", musclesim.Simulation, "elbow", effects=[{"id": "valve_lg"}])
        self.refused("elbow.forearm_kg", musclesim.Simulation, "elbow", parameters={"elbow.forearm_kg": -1})
        self.refused("elbow.forearm_kg.*not list", musclesim.Simulation, "elbow", parameters={"elbow.forearm_kg": [1]})
        self.refused("forearm_kgg", musclesim.Simulation("elbow", parameters={"elbow.forearm_kgg": 1}).start)
        self.refused("forearm_kgg", musclesim.Simulation("elbow", parameters={"elbow.forearm_kgg": 1}).step)
        with self.assertRaises(musclesim.IoError):
            musclesim.Simulation("there_is_no.toml")
        with self.assertRaises(TypeError):
            musclesim.Simulation("elbow", colour="red")

    def test_closed(self):
        with musclesim.Simulation("elbow", parameters=line) as simulation:
            readings = simulation.start([0.2, 0.2])
        self.assertTrue(simulation.closed)
        self.assertEqual(readings[0], 0.2)  # the array outlives the world
        for call in (simulation.start, simulation.step, simulation.observe, simulation.parameters, lambda: simulation.time_s,
                     lambda: simulation.length_mm, lambda: simulation.command([0, 0]), lambda: simulation.run("hold", 1)):
            self.refused("closed", call)
        self.assertIn("closed", repr(simulation))
        simulation.close()

    def test_two_threads_at_once(self):
        simulation = musclesim.Simulation("arm")
        simulation.start()
        refusals, begun = [], threading.Event()

        def steps():
            begun.set()
            simulation.step(count=200)

        thread = threading.Thread(target=steps)
        thread.start()
        begun.wait()
        while thread.is_alive():
            try:
                simulation.observe()
            except musclesim.BadParameter as error:
                refusals.append(str(error))
                break
        thread.join()
        self.assertEqual(len(refusals), 1)
        self.assertIn("at work", refusals[0])

    def test_diverged(self):
        simulation = musclesim.Simulation("elbow", physics="si", substeps=1, step_s=0.5)
        with self.assertRaises(musclesim.Diverged) as caught:
            simulation.step([1, 0], 1000)
        self.assertIsInstance(caught.exception, ArithmeticError)
        self.assertTrue(caught.exception.where)
        with self.assertRaises((musclesim.Diverged, musclesim.BadParameter)):
            simulation.step()


if __name__ == "__main__":
    unittest.main()
