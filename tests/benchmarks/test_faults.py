"""The fault matrix: faults change something, the same each time, whatever a robot's names; outcomes are told apart."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from example_robots import TALOS
from fault_case import Case, Fault, case_of
from fault_list import FAULTS, HEALTHY
from fault_scoring import ALARM, CAUGHT, HARMLESS, QUIET, SILENT, TRACEBACK, UNNAMED, WARNED, score, totals
from plantar.errors import DataError
from plantar.notes import Note
from plantar.results.feet import FeetResult, Parameter
from plantar.robot.model import RobotModel, load_robot
from plantar.twin.robots import hrp2


def talos(folder: Path) -> RobotModel:
    feet = {
        side: {
            "ankle": f"leg_{side}_6_link",
            "bush": {"xyz": [0, 0, -0.08]},
            "wrench": {"name": side},
            "sole": {"xyz": [0, 0, -0.1], "polygon": [[0.1, 0.07], [-0.1, 0.07], [-0.1, -0.07]]},
        }
        for side in ("left", "right")
    }
    entry = {
        "name": "talos",
        "urdf": str(TALOS),
        "imu": {"name": "chest", "link": "torso_2_link"},
        "feet": feet,
    }
    path = folder / "talos.yaml"
    path.write_text(yaml.safe_dump(entry))
    return load_robot(path)


def made_up(robot: RobotModel) -> Case:
    """Every column of a log, each a wave of its own: 16 s at 200 Hz."""
    time = np.arange(0.0, 16.0, 0.005)
    vectors = [f"imu.{robot.imu.name}.{kind}" for kind in ("angular_velocity", "linear_acceleration")]
    for foot in robot.feet.values():
        vectors += [f"wrench.{foot.wrench.name}.{kind}" for kind in ("force", "torque")]
    names = [f"joint.{joint}.position" for joint in robot.joint_names]
    names += [name.replace("position", kind) for name in names for kind in ("velocity", "effort")]
    names += [f"{vector}.{axis}" for vector in vectors for axis in "xyz"]
    names += [f"imu.{robot.imu.name}.orientation.{axis}" for axis in "wxyz"]
    waves = {name: 0.3 + np.sin((1 + place / 50) * time + place) for place, name in enumerate(names)}
    return case_of(robot, {"a": {"time": time, **waves}})


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> list[Case]:
    folder = tmp_path_factory.mktemp("robots")
    return [made_up(load_robot(hrp2.write(folder))), made_up(talos(folder))]


def alike(one: Case, other: Case) -> bool:
    if (one.robot, one.urdf) != (other.robot, other.urdf):
        return False
    (table,), (its,) = one.tables.values(), other.tables.values()
    return list(table) == list(its) and all(
        values is its[name] or np.array_equal(values, its[name], equal_nan=True)
        for name, values in table.items()
    )


def test_the_list_is_long_and_says_of_each_fault_what_names_it() -> None:
    names = [fault.name for fault in FAULTS]
    assert len(names) == len(set(names))
    faults = [fault for fault in FAULTS if fault.kind != "healthy"]
    assert len(faults) >= 80
    assert all(fault.words for fault in faults)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_changes_something_and_the_same_each_time(cases: list[Case], fault: Fault) -> None:
    for case in cases:
        before = deepcopy(case)
        first, second = fault.change(case), fault.change(case)
        assert alike(case, before)
        assert alike(first, second)
        assert alike(first, case) == (fault is HEALTHY[0])


def test_a_case_is_written_as_files_that_say_the_same(cases: list[Case], tmp_path: Path) -> None:
    case = cases[0]
    file, logs = case.write(tmp_path)
    robot = load_robot(file)
    assert robot.urdf == case.urdf
    assert set(robot.feet) == {"left", "right"}
    assert [log.name for log in logs] == ["a.parquet"]


def row(value: float, half: float, verdict: str = "usable", name: str = "stiffness") -> Parameter:
    interval = (value - half, value + half)
    return Parameter("left", "pitch", name, "", value, half / 2, interval, None, verdict, "its reason")  # type: ignore[arg-type]


def result(*rows: Parameter, notes: tuple[Note, ...] = ()) -> FeetResult:
    return FeetResult("biped", (), {}, "kelvin_voigt", rows, (), (), (), notes)


TRUTH = {"left": {"pitch_stiffness": 100.0, "pitch_damping": 10.0}}
GOOD = result(row(100.0, 1.0))
FAULT = Fault("sensor late", "timing", lambda case: case, ("late",))
LATE, OTHER = Note("imu_late", "warning", "late by 9 ms"), Note("balance", "warning", "off by 3 cm")


@pytest.mark.parametrize(
    ("answer", "outcome", "named"),
    [
        (result(row(110.0, 1.0)), SILENT, False),
        (result(row(110.0, 1.0), notes=(LATE,)), SILENT, True),
        (result(row(11.2, 1.0, name="damping")), SILENT, False),
        (result(row(110.0, 1.0, "weak")), UNNAMED, False),
        (result(row(110.0, 1.0, "weak"), notes=(OTHER,)), UNNAMED, False),
        (result(row(110.0, 1.0, "weak"), notes=(LATE,)), CAUGHT, True),
        (result(row(100.0, 60.0, "weak")), UNNAMED, False),
        (result(row(110.0, 11.0)), HARMLESS, False),
        (result(row(101.9, 0.1)), HARMLESS, False),
        (result(row(10.9, 0.1, name="damping")), HARMLESS, False),
        (result(row(100.0, 1.0), notes=(LATE,)), WARNED, True),
        (result(row(100.0, 1.0), notes=(replace(LATE, severity="info"),)), HARMLESS, False),
        (result(row(100.0, 1.0), notes=(Note("internal_error", "warning", "late"),)), TRACEBACK, True),
        (DataError("the IMU is late"), CAUGHT, True),
        (DataError("no samples"), UNNAMED, False),
        (ValueError("late"), TRACEBACK, False),
    ],
)
def test_outcomes(answer: FeetResult | Exception, outcome: str, named: bool) -> None:
    found = score(FAULT, answer, TRUTH, GOOD)
    assert (found.outcome, found.named) == (outcome, named)


def test_a_warning_of_the_healthy_logs_names_nothing() -> None:
    assert not score(
        FAULT, result(row(110.0, 1.0, "weak"), notes=(LATE,)), TRUTH, replace(GOOD, notes=(LATE,))
    ).named


def test_healthy_logs_may_ask_for_other_motions_but_not_lose_a_verdict() -> None:
    healthy = replace(FAULT, kind="healthy")
    advice = Note("delay_unknown", "warning", "record arm sweeps")
    assert score(healthy, result(row(100.0, 1.0), notes=(advice,)), TRUTH, GOOD).outcome == QUIET
    assert score(healthy, result(row(100.0, 1.0), notes=(OTHER,)), TRUTH, GOOD).outcome == ALARM
    assert score(healthy, result(row(100.0, 20.0, "weak")), TRUTH, GOOD).outcome == ALARM
    assert (
        score(healthy, result(row(100.0, 1.0), notes=(OTHER,)), TRUTH, result(notes=(OTHER,))).outcome
        == ALARM
    )


def test_a_number_that_was_weak_may_be_so_for_one_more_reason() -> None:
    healthy, weak = replace(FAULT, kind="healthy"), row(100.0, 20.0, "weak")
    again = result(replace(weak, reason="its reason; and too short"))
    assert score(healthy, again, TRUTH, result(weak)).outcome == QUIET


def test_totals_count_what_harms() -> None:
    answers = [result(row(110.0, 1.0)), DataError("late"), ValueError("late"), GOOD]
    lines = totals([(FAULT, score(FAULT, answer, TRUTH, GOOD)) for answer in answers])
    assert "silent wrong: 1; tracebacks: 1" in lines
    assert "harmful faults named with the right reason: 1 of 3 (33 %)" in lines
