"""Logs without all readings of the feet: the file is written, it says what is missing, and whole logs are looked at."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from biped import record, sway
from biped_robot import make_robot
from plantar.errors import LogError
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.logs.save import save_log
from plantar.robot.schema import read_robot_file
from plantar.robot_guess import guess_robot_file
from plantar.robot_guess.sensors import Sensors, sensor_of

LEFT, RIGHT = wrench_columns("left"), wrench_columns("right")
EVERY_LEFT, EVERY_RIGHT = "columns 'wrench.left.*'", "columns 'wrench.right.*'"


@pytest.fixture(scope="module")
def whole() -> MotionLog:
    return record(sway("whole", 1, duration=5.0))


def guessed(folder: Path, *logs: MotionLog) -> list[str]:
    make_robot(folder)
    paths = [folder / f"{log.name}.csv" for log in logs]
    for log, path in zip(logs, paths, strict=True):
        save_log(log, path)
    out = folder / "guessed.yaml"
    out.write_text(guess_robot_file(folder / "biped.urdf", paths, out))
    read_robot_file(out)
    return out.read_text().splitlines()


def without(log: MotionLog, *columns: str) -> MotionLog:
    left = {name: values for name, values in log.columns.items() if name not in columns}
    return replace(log, name="thin", columns=left)


@pytest.mark.parametrize(
    ("columns", "named"),
    [
        (LEFT, EVERY_LEFT),
        (LEFT[1:2], "column 'wrench.left.force.y'"),
        ((*LEFT, *RIGHT), f"{EVERY_LEFT} and {EVERY_RIGHT}"),
    ],
)
def test_a_file_is_written_that_says_what_is_missing(
    whole: MotionLog, tmp_path: Path, columns: tuple[str, ...], named: str
) -> None:
    lines = guessed(tmp_path, without(whole, *columns))
    said = [line for line in lines if line.startswith(("# Seen", "# DOUBT"))]
    assert len(said) == 1
    assert said[0].startswith(
        f"# DOUBT: thin: {named} missing: nothing of the feet could be checked (valid: "
    )
    assert sum("wrench: {name: left," in line for line in lines) == 1


def test_a_log_without_a_leg_is_refused_whether_or_not_it_has_its_wrenches(
    whole: MotionLog, tmp_path: Path
) -> None:
    leg = [name for name in whole.columns if name.startswith("joint.left_")]
    for columns in (leg, [*LEFT, *leg]):
        with pytest.raises(
            LogError,
            match=r"thin\.csv: columns 'joint\.\*\.position': do not hold any joint between IMU and left "
            r"foot of the URDF \(left_ankle_pitch, left_ankle_roll, left_leg_x and 2 more\) \(valid: "
            r"columns joint\.<joint>\.position; for other names a map, `columns` in the robot file\)$",
        ):
            guessed(tmp_path, without(whole, *columns))


def test_the_logs_that_are_whole_are_looked_at_all_the_same(whole: MotionLog, tmp_path: Path) -> None:
    thin = without(whole, *LEFT)
    (tmp_path / "alone").mkdir()
    alone = guessed(tmp_path / "alone", whole)
    both = guessed(tmp_path, thin, whole)
    beside = [line for line in both if "DOUBT: thin: " not in line]
    assert len(beside) == len(both) - 1
    assert beside[1:] == alone[1:]  # but for the number of logs


def test_joints_that_mimic_others_need_not_be_recorded(whole: MotionLog, tmp_path: Path) -> None:
    """An ankle that a linkage turns like another joint, of which the log knows nothing."""
    make_robot(tmp_path)
    urdf = tmp_path / "biped.urdf"
    mimic = '<mimic joint="right_ankle_roll" multiplier="0.5"/>'
    ankle = '<joint name="left_ankle_roll" type="revolute">'
    urdf.write_text(urdf.read_text().replace(ankle, ankle + mimic))
    followed = 0.5 * whole.column("joint.right_ankle_roll.position")
    linked = whole.with_columns({"joint.left_ankle_roll.position": followed})
    texts = []
    for log in (linked, without(linked, "joint.left_ankle_roll.position", "joint.left_ankle_roll.velocity")):
        path = tmp_path / "linked.csv"
        save_log(log, path)
        texts.append(guess_robot_file(urdf, [path], tmp_path / "guessed.yaml"))
    assert texts[0] == texts[1]


@pytest.mark.parametrize(
    ("left", "right"), [("ftL", "ftR"), ("f_l", "f_r"), ("LFsensor", "RFsensor"), ("Ati-L-6", "Ati-R-6")]
)
def test_a_letter_in_a_sensors_name_says_which_foot_it_is_of(left: str, right: str) -> None:
    sensors = Sensors(wrenches={right: "", left: ""})
    assert [sensor_of(side, sensors, []) for side in ("left", "right")] == [left, right]
