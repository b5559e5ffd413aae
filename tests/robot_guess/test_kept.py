"""Robot files as they are guessed from logs of a robot whose sensors sit in many ways, each line as it is kept."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import URDF, Frame, Mounting
from feet_trials import noisy, without
from kept_texts import assert_as_kept
from plantar.errors import PlantarError
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log
from plantar.robot_guess import guess_robot_file

KEPT = Path(__file__).parent / "kept"
MOUNTINGS = {
    "usual": Mounting(),
    "turned imu": Mounting(imu=Frame((-0.05, 0.02, 0.3), (0.0, 0.0, np.pi / 2))),
    "imu upside down": Mounting(imu=Frame((0.1, 0.0, 0.2), (np.pi, 0.0, 0.3))),
    "wrench upside down": Mounting(wrench=Frame((0.01, 0.0, -0.04), (np.pi, 0.0, 0.0))),
    "wrench turned": Mounting(wrench=Frame((0.01, 0.0, -0.04), (0.0, 0.0, -np.pi / 2))),
    "wrench on the robot": Mounting(sign=-1),
    "bush aside": Mounting(bush=Frame((0.01, 0.005, -0.03))),
}
CHANGES: dict[str, Callable[[MotionLog], MotionLog]] = {
    "no attitude": lambda log: without(log, "orientation"),
    "no right foot": lambda log: without(log, "wrench.right"),
    "no torques": lambda log: without(log, ".torque"),
    "no imu": lambda log: without(log, "imu."),
    "other names": lambda log: MotionLog(
        log.name, log.time, {name.replace("wrench.left", "wrench.lf_sensor"): v for name, v in log.columns.items()}
    ),
    "feet exchanged": lambda log: MotionLog(
        log.name, log.time, {_other(name): values for name, values in log.columns.items()}
    ),
    "two imus": lambda log: log.with_columns(
        {name.replace("chest", "spare"): np.roll(v, 3) for name, v in log.columns.items() if name.startswith("imu.")}
    ),
    "lifting": lambda log: log.with_columns(
        {name: np.where((log.time > 4) & (log.time < 6), 0.0, v) for name, v in log.columns.items()
         if name.startswith("wrench.left")}
    ),
    "heavier": lambda log: log.with_columns(
        {name: 1.3 * v for name, v in log.columns.items() if name.startswith("wrench.")}
    ),
    "zeroed under load": lambda log: log.with_columns(
        {name: log.column(name) - log.column(name)[0] for name in log.columns if name.startswith("wrench.")}
    ),
}  # fmt: skip


# On the left a frame that is called a force sensor, on the right one of the sensor's own name.
FRAMES = """
<link name="left_ft_sensor"/><joint name="left_seat" type="fixed"><parent link="left_foot"/>
  <child link="left_ft_sensor"/><origin xyz="0.01 0.02 -0.03" rpy="0 0 0.2"/></joint>
<link name="right"/><joint name="right_seat" type="fixed"><parent link="right_foot"/>
  <child link="right"/><origin xyz="-0.01 0 -0.02"/></joint>
</robot>"""


# Boxes under the feet: one stands aside, the other is thicker.
SHAPES = """
<link name="left_pad"><collision><origin xyz="0.02 0.01 0"/><geometry><box size="0.22 0.13 0.02"/></geometry>
  </collision></link>
<joint name="left_under" type="fixed"><parent link="left_foot"/><child link="left_pad"/>
  <origin xyz="0 0 -0.08"/></joint>
<link name="right_pad"><collision><geometry><box size="0.24 0.12 0.04"/></geometry></collision></link>
<joint name="right_under" type="fixed"><parent link="right_foot"/><child link="right_pad"/>
  <origin xyz="0 0 -0.07"/></joint>
</robot>"""


URDFS = {"frames of sensors": FRAMES, "boxes": SHAPES}


def _other(name: str) -> str:
    if not name.startswith("wrench."):
        return name
    return name.replace("left", "right") if "left" in name else name.replace("right", "left")


def guessed(folder: Path, logs: list[MotionLog], urdf: str) -> str:
    (folder / "biped.urdf").write_text(urdf)
    files = [folder / f"{log.name}.csv" for log in logs]
    for file, log in zip(files, logs, strict=True):
        save_log(log, file)
    try:
        return guess_robot_file(folder / "biped.urdf", files, folder / "robot.yaml").replace(
            str(folder), "FOLDER"
        )
    except PlantarError as error:
        return f"{error}\n".replace(str(folder), "FOLDER")


@pytest.mark.parametrize("name", [*MOUNTINGS, *CHANGES, *URDFS])
def test_a_guess_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    mounting = MOUNTINGS.get(name, Mounting())
    logs = [noisy(record(sway(f"log_{seed}", seed, 12.0, shift=0.3), mounting), seed) for seed in (1, 2)]
    logs = [CHANGES[name](log) if name in CHANGES else log for log in logs]
    urdf = URDF.replace("</robot>", URDFS.get(name, "</robot>"))
    assert_as_kept(guessed(tmp_path, logs, urdf), KEPT / f"{name.replace(' ', '_')}.txt", share=1e-3)
