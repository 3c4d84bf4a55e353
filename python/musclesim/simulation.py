"""Simulations and runs."""

from __future__ import annotations

import os
from typing import Any, Callable, Sequence, Union

from . import _musclesim
from ._musclesim import Controller, Recording, State

ControllerLike = Union[str, Controller, Callable[[State], Any]]


class Simulation(_musclesim._Simulation):
    __doc__ = _musclesim._Simulation.__doc__

    def __enter__(self) -> Simulation:
        return self

    def run(self, controller: ControllerLike = "asm", duration_s: float = 300.0, *, record: str | os.PathLike[str] | None = None,
            overwrite: bool = False, record_interval_s: float | None = None, task: str = "height",
            target_mm: Sequence[float] | None = None, decision_interval_s: float | None = None) -> Recording:
        """Begins anew, runs under a controller and returns the recording.

        controller: a name (musclesim.controllers()), a Controller, or a function of the State that returns pressures of shape (muscles,).
        duration_s: simulated time in s.  record: file NAME.csv; it and NAME.json are written while the run goes on, and after an exception
        or Ctrl-C they hold everything up to then, with "complete": false.  overwrite: replace existing files.  record_interval_s: time
        between rows in s (default: every step).  task, target_mm (x, y, z in mm), decision_interval_s (s): for controllers with a name.
        Raises BadParameter, Diverged, FileExistsError, IoError, KeyboardInterrupt and what the controller raises.
        """
        file = None if record is None else os.fspath(record)
        if file is not None and not overwrite:
            for existing in (file, os.path.splitext(file)[0] + ".json"):
                if os.path.exists(existing):
                    raise FileExistsError(f"{existing} exists; overwrite=True replaces it")
        return self._run(controller, duration_s, file, record_interval_s, task, target_mm, decision_interval_s)


def run(robot: str = "arm", controller: ControllerLike = "asm", duration_s: float = 300.0, *,
        record: str | os.PathLike[str] | None = None, overwrite: bool = False, record_interval_s: float | None = None,
        task: str = "height", target_mm: Sequence[float] | None = None, decision_interval_s: float | None = None,
        **model: Any) -> Recording:
    """Runs a robot under a controller and returns the recording: Simulation(robot, **model).run(controller, ...)."""
    with Simulation(robot, **model) as simulation:
        return simulation.run(controller, duration_s, record=record, overwrite=overwrite, record_interval_s=record_interval_s, task=task,
                              target_mm=target_mm, decision_interval_s=decision_interval_s)
