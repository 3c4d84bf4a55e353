"""Simulates robots driven by pneumatic artificial muscles and finds out why a real machine moves differently.

    import musclesim

    recording = musclesim.run("elbow", lambda state: [0.6, 0.2], duration_s=2)
    recording["angle_elbow_deg"]        # a NumPy array

Pressures are fractions of full scale 0..1, lengths mm, angles degrees, forces N, times s.
"""

from ._errors import BadFile, BadParameter, Diverged, Error, IoError
from ._musclesim import BraunForceLaw, Controller, ForceLaw, Recording, Replay, State, __version__, controllers, effects, robots
from .diagnosis import Diagnosis, diagnose
from .ensemble import ensemble
from .environment import Box, Environment
from .recording import replay
from .simulation import Simulation, run

__all__ = [
    "BadFile", "BadParameter", "Box", "BraunForceLaw", "Controller", "Diagnosis", "Diverged", "Environment", "Error", "ForceLaw", "IoError",
    "Recording", "Replay", "Simulation", "State", "__version__", "controllers", "diagnose", "effects", "ensemble", "replay", "robots", "run",
]
