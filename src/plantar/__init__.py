"""plantar: what does your legged robot stand on?

Stiffness, damping and offset of a robot's feet from the logs that it already records:

    import plantar

    result = plantar.identify_feet("robot.yaml", ["sway_1.csv", "sway_2.csv"], validate=["squat.csv"])
    print(result)                                       # the table, ± for 95 %
    result.plot("left", "pitch")                        # torque over angle, measured and model
    result.save("out/feet")                             # result.json and residuals.parquet
    plantar.export(result, "mjcf", "robot_on_bushes.xml")

Units are SI, angles in rad. What is wrong with the input is a `PlantarError` of one line; what was assumed is a note in
the result. The names here are imported when they are first used, so that `import plantar` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

# Public name -> the module that holds it.
_HOMES = {
    "load_robot": "robot.model",
    "open_log": "logs.readers",
    "identify_feet": "feet.identify",
    "validate_feet": "feet.validate",
    "select_motions": "motions.select_motions",
    "identify_inertia": "whole_body.inertia",
    "identify_joints": "whole_body.joints",
    "export": "exporters",
    "FootHysteresis": "exporters.contact.hysteresis",
    "plot_torque": "report.figures.loop",
    "read_residuals": "results.residuals",
    "FeetSettings": "feet.settings",
    "DynamicsSettings": "whole_body.settings",
    "FootEstimator": "online.estimator",
    "FeetResult": "results.feet",
    "DynamicsResult": "results.dynamics",
    "RobotModel": "robot.model",
    "MotionLog": "logs.motion_log",
    "PlantarError": "errors",
    "RobotError": "errors",
    "LogError": "errors",
    "DataError": "errors",
    "SettingsError": "errors",
    "MotionError": "errors",
    "ExportError": "errors",
    "MissingExtra": "errors",
}

__all__ = ["__version__", "dynamics", *_HOMES]

if TYPE_CHECKING:
    from plantar import dynamics as dynamics
    from plantar.errors import DataError as DataError
    from plantar.errors import ExportError as ExportError
    from plantar.errors import LogError as LogError
    from plantar.errors import MissingExtra as MissingExtra
    from plantar.errors import MotionError as MotionError
    from plantar.errors import PlantarError as PlantarError
    from plantar.errors import RobotError as RobotError
    from plantar.errors import SettingsError as SettingsError
    from plantar.exporters import export as export
    from plantar.exporters.contact.hysteresis import FootHysteresis as FootHysteresis
    from plantar.feet.identify import identify_feet as identify_feet
    from plantar.feet.settings import FeetSettings as FeetSettings
    from plantar.feet.validate import validate_feet as validate_feet
    from plantar.logs.motion_log import MotionLog as MotionLog
    from plantar.logs.readers import open_log as open_log
    from plantar.motions.select_motions import select_motions as select_motions
    from plantar.online.estimator import FootEstimator as FootEstimator
    from plantar.report.figures.loop import plot_torque as plot_torque
    from plantar.results.dynamics import DynamicsResult as DynamicsResult
    from plantar.results.feet import FeetResult as FeetResult
    from plantar.results.residuals import read_residuals as read_residuals
    from plantar.robot.model import RobotModel as RobotModel
    from plantar.robot.model import load_robot as load_robot
    from plantar.whole_body.inertia import identify_inertia as identify_inertia
    from plantar.whole_body.joints import identify_joints as identify_joints
    from plantar.whole_body.settings import DynamicsSettings as DynamicsSettings


def __getattr__(name: str) -> Any:
    if name == "dynamics":
        return import_module("plantar.dynamics")
    if name not in _HOMES:
        raise AttributeError(f"module 'plantar' has no attribute '{name}'")
    return getattr(import_module(f"plantar.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
