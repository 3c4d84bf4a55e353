"""A robot as an environment for learning: the signature of Gymnasium's Env, without needing Gymnasium."""

from __future__ import annotations

from typing import Any, Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ._errors import BadParameter, Diverged
from .simulation import Simulation

Numbers = NDArray[np.float64]


class Box:
    """All arrays of shape (n,) between `low` and `high`."""

    def __init__(self, low: Numbers, high: Numbers, seed: int | None = None) -> None:
        self.low, self.high = np.asarray(low, float), np.asarray(high, float)
        self.shape, self.dtype = self.low.shape, self.low.dtype
        self.seed(seed)

    def seed(self, seed: int | None = None) -> None:
        """Makes the samples repeatable; None stands for 0."""
        self._random = np.random.default_rng(seed or 0)

    def sample(self) -> Numbers:
        """Uniform where both bounds are finite, normal elsewhere."""
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        low, high = np.where(bounded, self.low, 0.0), np.where(bounded, self.high, 1.0)
        return np.where(bounded, self._random.uniform(low, high), self._random.normal(size=self.shape))

    def contains(self, value: Any) -> bool:
        value = np.asarray(value)
        return value.shape == self.shape and bool(np.all((value >= self.low) & (value <= self.high)))

    def __contains__(self, value: Any) -> bool:
        return self.contains(value)

    def __repr__(self) -> str:
        return f"Box({self.low.min()}, {self.high.max()}, {self.shape})"


class Environment:
    """A robot with reset and step as in Gymnasium: rig, elbow, arm or a robot file.

        environment = musclesim.Environment("elbow", target={"angle_elbow_deg": 20}, parameters={"muscle.model": "line"})
        observation, info = environment.reset(seed=1)
        observation, reward, terminated, truncated, info = environment.step([0.6, 0.2])

    Action: pressures, shape (muscles,), 0..1; they are held for `action_steps` control steps. Observation: the signals `observe` (default:
    all), shape (len(observe),), in mm, deg, N and fractions; a copy. Reward: minus the sum over `target` of |signal - wanted value|, in the
    signal's unit, or what `reward(environment, action)` returns; a subclass may override reward(action). An episode is truncated after
    `duration_s` and terminated if the simulation diverges. **model: as for Simulation; `seed` is that of the first reset without one.
    """

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode = None
    spec = None
    reward_range = (-float("inf"), float("inf"))

    def __init__(self, robot: str = "elbow", *, duration_s: float = 10.0, action_steps: int = 1, observe: Sequence[str] | None = None,
                 target: Mapping[str, float] | None = None, reward: Callable[["Environment", Numbers], float] | None = None,
                 first_command: Sequence[float] | None = None, seed: int = 1, **model: Any) -> None:
        self.simulation = Simulation(robot, seed=seed, **model)
        self._place_of = {name: place for place, name in enumerate(self.simulation.signals)}
        self.signals = list(observe if observe is not None else self._place_of)
        self.target, self.duration_s, self.action_steps = dict(target or {}), duration_s, action_steps
        self._places = np.array([self._place(name) for name in self.signals], int)
        self._targets = [(self._place(name), value) for name, value in self.target.items()]
        self._reward, self._first_command = reward, first_command
        self._random = np.random.default_rng(seed)
        self._next_seed: int | None = seed
        self._steps_left = 0
        self.readings = self.simulation.observe()
        count = self.simulation.muscle_count
        self.action_space = Box(np.zeros(count), np.ones(count))
        self.observation_space = Box(np.full(len(self.signals), -np.inf), np.full(len(self.signals), np.inf))

    @property
    def unwrapped(self) -> "Environment":
        return self

    @property
    def np_random(self) -> np.random.Generator:
        """Where seeds of further episodes come from."""
        return self._random

    def value(self, signal: str) -> float:
        """A signal now, in its unit."""
        return float(self.readings[self._place(signal)])

    def reward(self, action: Numbers) -> float:
        """The reward after a step under `action`."""
        if self._reward is not None:
            return float(self._reward(self, action))
        return -float(sum(abs(self.readings[place] - wanted) for place, wanted in self._targets))

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Numbers, dict[str, Any]]:
        """Begins an episode: (observation, info). A seed makes it and those that follow repeatable. options["command"]: the first
        pressures, shape (muscles,)."""
        if seed is not None:
            self._random, self._next_seed = np.random.default_rng(seed), seed
        if self._next_seed is None:
            self._next_seed = int(self._random.integers(2**63))
        self.readings = self.simulation.start((options or {}).get("command", self._first_command), seed=self._next_seed)
        self._next_seed = None
        self._steps_left = max(1, round(self.duration_s / (self.simulation.step_s * self.action_steps)))
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[Numbers, float, bool, bool, dict[str, Any]]:
        """Holds the pressures of `action` for `action_steps` control steps: (observation, reward, terminated, truncated, info)."""
        if self._steps_left <= 0:
            raise BadParameter("the episode has ended, or none has begun: call reset()")
        self._steps_left -= 1
        terminated, info = False, {}
        try:
            self.readings = self.simulation.step(action, self.action_steps)
        except Diverged as error:
            terminated, self._steps_left, info = True, 0, {"diverged": str(error)}
        observation = self._observation()
        return observation, self.reward(action), terminated, self._steps_left == 0 and not terminated, {**self._info(), **info}

    def render(self) -> None:
        """Draws nothing."""

    def close(self) -> None:
        self.simulation.close()

    def __enter__(self) -> "Environment":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def _observation(self) -> Numbers:
        return np.array(self.readings[self._places])

    def _info(self) -> dict[str, Any]:
        return {"time_s": self.simulation.time_s, "seed": self.simulation.seed}

    def _place(self, signal: str) -> int:
        if signal not in self._place_of:
            raise BadParameter(f"signal = {signal}: must be one of {', '.join(self._place_of)}")
        return self._place_of[signal]
