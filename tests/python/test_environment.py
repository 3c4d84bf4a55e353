"""The signature of Gymnasium's environments."""
import os
import unittest

import numpy as np

import musclesim

line = {"muscle.model": "line"}
robots = os.environ["MUSCLESIM_ROBOTS"]


class Environments(unittest.TestCase):
    def test_signature_for_every_robot(self):
        for robot, muscles in (("rig", 1), ("elbow", 2), ("arm", 10), (os.path.join(robots, "wrist.toml"), 2)):
            with self.subTest(robot), musclesim.Environment(robot, duration_s=0.03, parameters=line) as environment:
                observation, info = environment.reset(seed=1)
                self.assertEqual((environment.action_space.shape, info["time_s"], info["seed"]), ((muscles,), 0, 1))
                self.assertIn(observation, environment.observation_space)
                ends = []
                for _ in range(3):
                    action = environment.action_space.sample()
                    self.assertIn(action, environment.action_space)
                    observation, reward, terminated, truncated, info = environment.step(action)
                    self.assertIn(observation, environment.observation_space)
                    self.assertIsInstance(reward, float)
                    ends.append((terminated, truncated))
                self.assertEqual(ends, [(False, False), (False, False), (False, True)])
                self.assertAlmostEqual(info["time_s"], 0.03)
                with self.assertRaisesRegex(musclesim.BadParameter, "reset"):
                    environment.step(action)

    def test_observations_are_copies_and_episodes_repeat(self):
        environment = musclesim.Environment("elbow", parameters=dict(line, **{"sensor.angle_noise_deg": 0.1}), observe=["angle_elbow_deg"],
                                            duration_s=0.5)

        def episode(**named):
            rows = [environment.reset(**named)[0]]
            for _ in range(10):
                rows.append(environment.step([0.6, 0.2])[0])
            return np.array(rows)

        first, second = episode(seed=5), episode()
        self.assertGreater(np.ptp(first), 0)
        self.assertFalse(np.array_equal(first, second))
        np.testing.assert_array_equal(first, episode(seed=5))
        np.testing.assert_array_equal(second, episode())

    def test_reward_and_target(self):
        environment = musclesim.Environment("elbow", parameters=line, target={"angle_elbow_deg": 20}, action_steps=5)
        environment.reset(options={"command": [0.3, 0.3]})
        _, reward, *_ = environment.step([0.6, 0.2])
        self.assertAlmostEqual(reward, -abs(environment.value("angle_elbow_deg") - 20))
        self.assertAlmostEqual(environment.simulation.time_s, 0.05)
        own = musclesim.Environment("elbow", parameters=line, reward=lambda environment, action: action[0])
        own.reset()
        self.assertEqual(own.step([0.75, 0])[1], 0.75)

    def test_divergence_ends_the_episode(self):
        environment = musclesim.Environment("elbow", substeps=1, step_s=0.5, duration_s=1e5, initial_state="built")
        environment.reset()
        terminated = False
        for _ in range(200):
            *_, terminated, truncated, info = environment.step([1, 0])
            if terminated:
                break
        self.assertTrue(terminated and not truncated)
        self.assertIn("at ", info["diverged"])
        environment.reset()

    def test_refusals(self):
        with self.assertRaisesRegex(musclesim.BadParameter, "angle_elbow_deg"):
            musclesim.Environment("elbow", observe=["angle"])
        environment = musclesim.Environment("elbow", parameters=line)
        with self.assertRaisesRegex(musclesim.BadParameter, "reset"):
            environment.step([0, 0])
        environment.reset()
        with self.assertRaises(musclesim.BadParameter):
            environment.step([0, 0, 0])
        environment.close()
        with self.assertRaisesRegex(musclesim.BadParameter, "closed"):
            environment.reset()


if __name__ == "__main__":
    unittest.main()
