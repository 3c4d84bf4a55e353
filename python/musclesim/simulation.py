"""Simulations and runs."""

from __future__ import annotations

import os
from typing import Any, Callable, Sequence, Union

from . import _musclesim
from ._errors import BadParameter
from ._musclesim import Controller, Recording, State

ControllerLike = Union[str, Controller, Callable[[State], Any], None]
File = Union[str, "os.PathLike[str]", None]


class Simulation(_musclesim._Simulation):
    __doc__ = _musclesim._Simulation.__doc__

    def __enter__(self) -> Simulation:
        return self

    def run(self, controller: ControllerLike = None, duration_s: float | None = None, *, record: File = None, overwrite: bool = False,
            record_interval_s: float | None = None, task: str | None = None, target_mm: Sequence[float] | None = None,
            decision_interval_s: float | None = None, commands: File = None, interpolate: str = "hold", targets: File = None,
            channels: str = "") -> Recording:
        """Begins anew, runs under a controller and returns the recording.

        controller: a name (musclesim.controllers()), a Controller, or a function of the State that returns pressures of shape (muscles,);
        None: as in the program ("asm" for the arm or with a task, "schedule" with commands, else "triangle").  duration_s: simulated time
        in s; None: to the end of the controller's commands, else 300 s.  record: file NAME.csv; it and NAME.json are written while the run
        goes on, and after an exception or Ctrl-C they hold everything up to then, with "complete": false.  overwrite: replace existing
        files.  record_interval_s: time between rows in s (default: every step).

        For controllers with a name, as the program's options: task, target_mm (x, y, z in mm) and decision_interval_s (s); commands (file)
        and interpolate ("hold" or "linear") for "schedule"; targets (file) for "position"; channels for test signals and "position".

        Raises BadParameter, BadFile, Diverged, FileExistsError, IoError, KeyboardInterrupt and what the controller raises.
        """
        if commands is not None and controller not in (None, "schedule"):
            raise BadParameter(f"commands are for the controller schedule; {controller} does not heed them")
        if targets is not None and controller != "position":
            raise BadParameter(f"targets are for the controller position; {controller} does not heed them")
        if controller is not None and not isinstance(controller, str):
            given = {"task": task, "target_mm": target_mm, "channels": channels or None}
            unheeded = [name for name, value in given.items() if value is not None]
            if unheeded:
                raise BadParameter(f"{', '.join(unheeded)}: for controllers with a name; a function or an object decides for itself")
        if interpolate != "hold" and controller not in (None, "schedule"):
            raise BadParameter(f"interpolate = {interpolate} is for the controller schedule; {controller} does not heed it")
        if interpolate not in ("hold", "linear"):
            raise BadParameter(f"interpolate = {interpolate}: must be one of hold, linear")
        file = None if record is None else os.fspath(record)
        if file is not None and not overwrite:
            for existing in (file, os.path.splitext(file)[0] + ".json"):
                if os.path.exists(existing):
                    raise FileExistsError(f"{existing} exists; overwrite=True replaces it")
        return self._run(controller, duration_s, file, record_interval_s, task, target_mm, decision_interval_s, os.fspath(commands or ""),
                         os.fspath(targets or ""), channels, interpolate == "linear")


def run(robot: str = "arm", controller: ControllerLike = None, duration_s: float | None = None, *, record: File = None,
        overwrite: bool = False, record_interval_s: float | None = None, task: str | None = None, target_mm: Sequence[float] | None = None,
        decision_interval_s: float | None = None, commands: File = None, interpolate: str = "hold", targets: File = None,
        channels: str = "", **model: Any) -> Recording:
    """Runs a robot under a controller and returns the recording: Simulation(robot, **model).run(controller, ...)."""
    with Simulation(robot, **model) as simulation:
        return simulation.run(controller, duration_s, record=record, overwrite=overwrite, record_interval_s=record_interval_s, task=task,
                              target_mm=target_mm, decision_interval_s=decision_interval_s, commands=commands, interpolate=interpolate,
                              targets=targets, channels=channels)
