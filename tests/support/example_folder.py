"""The folder in which the examples of docstrings and documents are run: robots, logs and results of theirs."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pinocchio as pin

import example_robots
import small_biped
from biped import record, sway
from biped_robot import make_robot
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.dynamics import DynamicsResult
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel, load_robot
from plantar.whole_body.dataset import COULOMB_SPEED
from plantar.whole_body.inertia import identify_inertia

LOGS = {"sway_1": (1, 12.0), "sway_2": (2, 12.0), "squat": (3, 8.0)}  # seed, seconds


def make_folder(folder: Path) -> Path:
    """`robot.yaml` with sways and a squat, `walker.yaml` and `arm.yaml` with a log each, results under `out`."""
    robot = make_robot(folder)
    logs = {name: record(sway(name, seed, duration=length)) for name, (seed, length) in LOGS.items()}
    for log in logs.values():
        write_csv(log, folder)
    settings = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
    feet: FeetResult = identify_feet(robot, [logs["sway_1"], logs["sway_2"]], [logs["squat"]], settings)
    feet.save(folder / "out" / "feet")
    write_slipping(folder)
    walker = walking_robot(folder)
    real = small_biped.truth(walker.floating_model, 1)
    walk = small_biped.record(walker, real, "walk", 1, 12.0, 0.5)
    write_csv(walk, folder)
    inertia: DynamicsResult = identify_inertia(walker, walk)
    inertia.save(folder / "out" / "inertia")
    write_csv(arm_log(folder), folder)
    return folder


def write_slipping(folder: Path) -> None:
    """The result of the feet as `out/slipping`, on rubber that slips."""
    made = json.loads((folder / "out" / "feet" / "result.json").read_text())
    made["parameters"] += [
        row | {"name": name, "value": value}
        for row in made["parameters"]
        if row["name"] == "stiffness" and row["axis"] in ("pitch", "roll")
        for name, value in (("slip_torque", 3.0), ("slip_angle", 0.01))
    ]
    (folder / "out" / "slipping").mkdir()
    (folder / "out" / "slipping" / "result.json").write_text(json.dumps(made))


def walking_robot(folder: Path) -> RobotModel:
    """The small biped of the whole-body tests as `walker.yaml`."""
    apart = folder / "walker"
    apart.mkdir()
    made = small_biped.robot(apart)
    (folder / "walker.urdf").write_text(made.urdf)
    (folder / "walker.yaml").write_text(made.path.read_text().replace("biped", "walker"))
    return load_robot(folder / "walker.yaml")


def arm_log(folder: Path) -> MotionLog:
    """Twelve seconds of a bolted-down arm whose joints have friction 3 N·m·s/rad, 2 N·m; writes its robot file too."""
    (folder / "arm.urdf").write_text(example_robots.UR5.read_text())
    (folder / "arm.yaml").write_text("name: arm\nurdf: arm.urdf\nbase: fixed\n")
    arm = load_robot(folder / "arm.yaml")
    random, time = np.random.default_rng(0), np.arange(0, 12, 0.01)
    q, v, a = np.moveaxis([small_biped.smooth(random, time, 1.2) for _ in arm.joint_names], 1, 0).swapaxes(
        1, 2
    )
    data = arm.model.createData()
    effort = np.array([pin.rnea(arm.model, data, *sample) for sample in zip(q, v, a, strict=True)])
    effort += 3.0 * v + 2.0 * np.tanh(v / COULOMB_SPEED) + random.normal(0, 0.3, effort.shape)
    columns = {}
    for place, joint in enumerate(arm.joint_names):
        for quantity, values in (("position", q), ("velocity", v), ("acceleration", a), ("effort", effort)):
            columns[f"joint.{joint}.{quantity}"] = values[:, place]
    return MotionLog("arm", time, columns)


def write_csv(log: MotionLog, folder: Path) -> Path:
    """The log as `<name>.csv`."""
    path, header = folder / f"{log.name}.csv", ",".join(["time", *log.columns])
    rows = np.column_stack([log.time, *log.columns.values()])
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.10g")
    return path
