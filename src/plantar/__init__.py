"""plantar: what does your legged robot stand on?

The names here are imported when they are first used, so that `import plantar` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "PlantarError": "errors",
    "MotionLog": "logs.motion_log",
    "RobotModel": "robot.model",
    "load_robot": "robot.model",
    "open_log": "logs.readers",
    "dynamics": "dynamics",
    "identify_feet": "feet.identify",
    "identify_inertia": "whole_body.inertia",
    "identify_joints": "whole_body.joints",
}

__all__ = ["__version__", *_HOMES]

if TYPE_CHECKING:
    from plantar import dynamics as dynamics
    from plantar.errors import PlantarError as PlantarError
    from plantar.feet.identify import identify_feet as identify_feet
    from plantar.logs.motion_log import MotionLog as MotionLog
    from plantar.logs.readers import open_log as open_log
    from plantar.robot.model import RobotModel as RobotModel
    from plantar.robot.model import load_robot as load_robot
    from plantar.whole_body.inertia import identify_inertia as identify_inertia
    from plantar.whole_body.joints import identify_joints as identify_joints


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'plantar' has no attribute '{name}'")
    module = import_module(f"plantar.{_HOMES[name]}")
    return module if name == "dynamics" else getattr(module, name)
