"""What logs say of a guess: what does not fit is a doubt."""

from __future__ import annotations

from pathlib import Path

import pytest
from scipy.spatial.transform import Rotation

from example_robots import TALOS
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.logs.save import save_log
from plantar.robot_guess import guess_robot_file
from standing_robot import talos_sways


def turned(log: MotionLog, degrees: float) -> MotionLog:
    """The log of a left force sensor that is mounted askew, which no right angle describes."""
    askew = Rotation.from_euler("y", degrees, degrees=True)
    columns = {}
    for place in (0, 3):
        names = wrench_columns("left")[place : place + 3]
        columns |= dict(zip(names, askew.apply(log.stack(names)).T, strict=True))
    return log.with_columns(columns)


@pytest.mark.parametrize(("degrees", "mark"), [(0.0, "# Seen"), (60.0, "# DOUBT")])
def test_wrenches_that_do_not_balance_gravity_are_a_doubt(tmp_path: Path, degrees: float, mark: str) -> None:
    save_log(turned(talos_sways(TALOS), degrees), tmp_path / "sway.csv")
    text = guess_robot_file(TALOS, [tmp_path / "sway.csv"], tmp_path / "robot.yaml")
    (line,) = (line for line in text.splitlines() if "balance gravity" in line)
    assert line.startswith(mark)
