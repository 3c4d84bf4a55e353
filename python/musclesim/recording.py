"""Recordings: what was commanded and measured in one run."""

from __future__ import annotations

import os
from typing import Any

from . import _musclesim
from ._musclesim import Recording, Replay


def replay(recording: Recording | str | os.PathLike[str], **model: Any) -> Replay:
    """Plays a recording's commands through the model and compares what the model measures with what was recorded.

    recording: a Recording or its file. **model replaces what the sidecar says: robot, physics, step_s, seed, parameters, effects (added to
    the recording's own), initial_state, stepper, substeps, plane. Raises BadFile, BadParameter, KeyboardInterrupt.
    """
    return _musclesim._replay(_as_recording(recording), _checked(model))


def _rebuilt(columns: dict[str, Any], info: dict[str, Any]) -> Recording:
    """Of a copy or a pickle."""
    return Recording.from_dict(columns, **info)


def _as_recording(recording: Recording | str | os.PathLike[str]) -> Recording:
    return recording if isinstance(recording, Recording) else Recording.read(recording)


def _checked(model: dict[str, Any]) -> dict[str, Any]:
    known = ("robot", "physics", "step_s", "seed", "parameters", "effects", "initial_state", "stepper", "substeps", "plane")
    for name in model:
        if name not in known:
            raise TypeError(f"unexpected argument {name!r}; the model has {', '.join(known)}")
    return model
