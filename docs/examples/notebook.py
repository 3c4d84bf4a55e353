"""A notebook as a script: cells begin with # %%. Jupyter and editors run them one by one; python3 notebook.py runs all and writes a figure.

What it shows: a controller of one's own, a force law of one's own, many runs at once, and an environment for learning.
"""
# %% A controller: it keeps the elbow at an angle by co-contraction and difference.
import matplotlib.pyplot as plt
import numpy as np

import musclesim

LINE = {"muscle.model": "line"}  # massless muscles without friction: fast


class Position(musclesim.Controller):
    """From the angle's error in degrees, its integral and its rate to the difference of the two pressures."""

    def __init__(self, target_deg, step_s=0.01):
        super().__init__()
        self.target_deg, self.step_s, self.integral, self.last_deg = target_deg, step_s, 0.0, 0.0

    def output(self, state):
        angle_deg = state.angle_deg[0]
        error, rate = self.target_deg(state.time_s) - angle_deg, (angle_deg - self.last_deg) / self.step_s
        difference = 0.002 * error + self.integral - 0.0008 * rate
        if abs(difference) < 0.4:  # no wind-up
            self.integral += 0.01 * error * self.step_s
        self.last_deg = angle_deg
        return 0.5 + np.clip(difference, -0.4, 0.4) * np.array([1, -1])


def target(time_s):
    return 15.0 * (1 if time_s % 4 < 2 else -1)


run = musclesim.run("elbow", Position(target), 12)

# %% A force law: a muscle that has lost a fifth of its force.
class Tired(musclesim.ForceLaw):
    def __init__(self, muscle, minimum_length_mm, maximum_length_mm):
        super().__init__()
        self.law, self.share = musclesim.BraunForceLaw(minimum_length_mm, maximum_length_mm), 0.8 if muscle == 0 else 1.0

    def tension_N(self, pressure, length_mm):
        return self.share * self.law.tension_N(pressure, length_mm)


tired = musclesim.run("elbow", Position(target), 12, force_law=Tired)

# %% Many runs at once, on all processors: how far random pressures move the elbow.
angles = musclesim.ensemble(lambda seed: musclesim.run("elbow", "random", 20, seed=seed, parameters=LINE)["angle_elbow_deg"], range(20))

# %% An environment, as Gymnasium has them: a policy that tries ten random actions and keeps the best.
environment = musclesim.Environment("elbow", target={"angle_elbow_deg": 20}, action_steps=50, duration_s=5, parameters=LINE)
environment.reset(seed=1)
trials = [(environment.step(action)[1], action) for action in (environment.action_space.sample() for _ in range(10))]
reward, action = max(trials, key=lambda trial: trial[0])
print(f"best of ten: {-reward:.1f} degrees off, with pressures {np.round(action, 2)}")

# %% The figure.
figure, (above, below) = plt.subplots(2, 1, figsize=(8, 6), constrained_layout=True)
above.plot(run["time_s"], [target(t) for t in run["time_s"]], color="grey", linestyle=":", label="target")
above.plot(run["time_s"], run["angle_elbow_deg"], label="position loop")
above.plot(tired["time_s"], tired["angle_elbow_deg"], label="the same with a tired flexor")
above.set(xlabel="time in s", ylabel="angle of the elbow in degrees")
above.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=3, frameon=False)
below.hist(np.concatenate(angles), bins=60)
below.set(xlabel="angle of the elbow in degrees", ylabel="rows of 20 random runs")
figure.savefig("notebook.svg", metadata={"Date": None})
