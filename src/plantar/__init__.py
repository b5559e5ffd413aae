"""plantar: what does your legged robot stand on?

The names here are imported when they are first used, so that `import plantar` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "PlantarError": "errors",
    "MotionLog": "log",
    "RobotModel": "robot",
    "load_robot": "robot",
    "open_log": "readers",
    "dynamics": "dynamics",
    "identify_feet": "identify.feet",
    "identify_inertia": "identify.inertia",
    "identify_joints": "identify.joints",
}

__all__ = ["__version__", *_HOMES]

if TYPE_CHECKING:
    from plantar import dynamics as dynamics
    from plantar.errors import PlantarError as PlantarError
    from plantar.identify.feet import identify_feet as identify_feet
    from plantar.identify.inertia import identify_inertia as identify_inertia
    from plantar.identify.joints import identify_joints as identify_joints
    from plantar.log import MotionLog as MotionLog
    from plantar.readers import open_log as open_log
    from plantar.robot import RobotModel as RobotModel
    from plantar.robot import load_robot as load_robot


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'plantar' has no attribute '{name}'")
    module = import_module(f"plantar.{_HOMES[name]}")
    return module if name == "dynamics" else getattr(module, name)
