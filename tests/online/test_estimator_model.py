"""The file that an estimator is constructed from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from biped_robot import write_robot
from estimator_text import untold
from plantar import _core
from plantar.errors import DataError
from plantar.online.estimator import OF_JOINTS, FootEstimator, _cutoff, _elements, _linear, _row, _unsure
from plantar.online.estimator_model import Element, estimator_model
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import DelayEstimate, Parameter
from plantar.robot.model import load_robot


def model_of(folder: Path, **changes: object) -> str:
    robot = load_robot(write_robot(folder, **changes))
    elements = {("left", "roll"): Element(0.01, 2.0, 0.1)}
    return estimator_model(
        robot,
        cutoff=5.0,
        wrench_delay=(0.004, 0.001),
        elements=elements,
        compliance={},
        linear=(),
        misplaced={},
        bends={},
        unsure={},
    )


def test_it_says_what_the_robot_file_says(tmp_path: Path) -> None:
    lines = model_of(tmp_path).splitlines()
    robot = load_robot(tmp_path / "robot.yaml")
    assert lines[0] == "plantar.foot_estimator/1"
    assert [line.split()[1] for line in lines if line.startswith("joint ")] == list(robot.joint_names)
    assert "wrench_delay 0.004 0.001" in lines
    assert sum(line.startswith("corner") for line in lines) == 8
    assert [line for line in lines if line.startswith("element")] == ["element 1 0.01 2.0 0.1"]
    weight = next(float(line.split()[1]) for line in lines if line.startswith("weight"))
    assert weight == robot.mass * 9.80665


def test_a_foot_zeroed_under_load_has_no_torque_that_grows_with_it(tmp_path: Path) -> None:
    robot = load_robot(write_robot(tmp_path, uncertainty={"bush_position": 0.003}))
    always = replace(robot, feet={**robot.feet, "left": replace(robot.feet["left"], contact="always")})
    for model, aside in ((robot, 0.005), (always, 0.0)):
        left, right = (
            line.split()[1:] for line in untold(model).splitlines() if line.startswith("place_std")
        )
        assert [float(value) for value in left] == pytest.approx([aside, 0.005]), "aside, and above"
        assert [float(value) for value in right] == pytest.approx([0.005, 0.005])


def test_a_batch_result_is_handed_on(tmp_path: Path) -> None:
    """Cutoff, delay and its deviation, compliance, elements, and where no memory was found."""
    rows = [
        Parameter("left", "pitch", "slip_angle", "rad", 0.01, 0.001, None, None, "usable", ""),
        Parameter("left", "pitch", "slip_torque", "N.m", -2.0, None, None, None, "weak", ""),
        Parameter("right", "pitch", "slip_angle", "rad", 0.02, 0.001, None, None, "usable", ""),
        Parameter("right", "pitch", "slip_torque", "N.m", 3.0, 0.25, None, None, "usable", ""),
        Parameter("left", "roll", "stiffness", "N.m/rad", 400.0, 1.0, None, None, "usable", ""),
        Parameter("right", "roll", "stiffness", "N.m/rad", 400.0, 1.0, None, None, "weak", ""),
    ]
    result = FeetResult(
        "biped", (), {"cutoff": 3.0}, "elastoplastic", tuple(rows), (), (), (), (),
        sensor_delay=DelayEstimate(0.004, 0.001, True), compliance={"left": 4e-6, "right": 0.0},
    )  # fmt: skip
    path = FootEstimator(write_robot(tmp_path), result).write_model(tmp_path / "robot.estimator")
    lines = path.read_text().splitlines()
    assert {"cutoff 3.0", "wrench_delay 0.004 0.001"} <= set(lines)
    # All is unsure of a torque whose deviation nobody knows.
    told = sorted(line for line in lines if line.startswith(("element", "linear")))
    assert told == ["element 0 0.01 -2.0 2.0", "element 0 0.02 3.0 0.25", "linear 1"], (
        "of a weak stiffness nobody knows"
    )
    known, unknown = (line.split()[1:] for line in lines if line.startswith("compliance"))
    assert [float(value) for value in known] == [4e-6, 0.0]
    assert float(unknown[0]) == 0.0
    weight = next(float(line.split()[1]) for line in lines if line.startswith("weight"))
    assert float(unknown[1]) * weight == pytest.approx(0.003), (
        "the robot's weight compresses it by millimetres"
    )


def test_the_written_file_makes_the_same_estimator(tmp_path: Path) -> None:
    estimator = FootEstimator(tmp_path / "robot.yaml") if write_robot(tmp_path) else None
    assert estimator is not None
    path = estimator.write_model(tmp_path / "robot.estimator")
    assert _core.FootEstimator(path.read_text())


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (("weight ", "weigh "), "line 3"),
        (("plantar.foot_estimator/1", "plantar.foot_estimator/9"), "not a model of this version"),
        (("cutoff 5.0", "cutoff five"), "missing or no number"),
        (("cutoff 5.0", "cutoff 5.0 6.0"), "more values"),
        (("element 1", "element 2"), "no axis"),
    ],
)
def test_a_broken_file_is_refused_with_its_line(
    tmp_path: Path, change: tuple[str, str], complaint: str
) -> None:
    with pytest.raises(RuntimeError, match=complaint):
        _core.FootEstimator(model_of(tmp_path).replace(*change))


def row(foot: str, axis: str, name: str, value: float | None, std: float | None) -> Parameter:
    return Parameter(foot, axis, name, "", value, std, None, None, "usable", "")  # type: ignore[arg-type]


def test_how_far_joints_bend_leaves_a_share_of_each_deviation() -> None:
    """A quarter of the variance of the stiffness, all of the damping's; none of what nobody knows."""
    left = [row("left", "pitch", "stiffness", -400.0, 20.0), row("left", "pitch", "damping", 10.0, 1.0)]
    right = [row("right", "roll", "stiffness", None, None), row("right", "roll", "damping", 20.0, None)]
    known = {(one.foot, one.axis, one.name): one for one in (*left, *right)}
    diagnosis = [
        SimpleNamespace(
            foot="left", axis="pitch", name=name, variance_shares={OF_JOINTS: share, "noise": 0.5}
        )
        for name, share in (("stiffness", 0.25), ("damping", 1.0))
    ]
    models = [SimpleNamespace(foot=foot, axis=axis) for foot, axis in (("left", "pitch"), ("right", "roll"))]
    result: Any = SimpleNamespace(
        joint_compliance={"leg": 1e-5}, models=models, diagnosis=diagnosis, parameter=lambda *key: known[key]
    )
    assert _unsure(result) == {
        ("left", "pitch"): (pytest.approx(0.025), pytest.approx(0.1)),
        ("right", "roll"): (0.0, 0.0),
    }
    result.joint_compliance = {}
    assert _unsure(result) == {}
    assert _unsure(None) == {}


def test_elements_and_linear_axes_of_a_result() -> None:
    rows = [
        row("left", "pitch", "stiffness", 400.0, 20.0), row("left", "pitch", "slip_angle", 0.02, 0.001),
        row("left", "pitch", "slip_torque", -3.0, None), row("right", "pitch", "slip_angle", 0.01, 0.001),
        row("right", "roll", "slip_torque", 4.0, 0.5), row("right", "roll", "slip_angle", 0.03, 0.001),
        replace(row("right", "roll", "stiffness", 300.0, 20.0), verdict="weak"),
        row("left", "z", "stiffness", 4e4, 1.0),
    ]  # fmt: skip
    result: Any = SimpleNamespace(parameters=rows)
    assert _elements(result) == {
        ("left", "pitch"): Element(0.02, -3.0, 3.0),
        ("right", "roll"): Element(0.03, 4.0, 0.5),
    }
    assert _linear(result) == [("left", "pitch")]
    assert (_elements(None), _linear(None)) == ({}, [])


@pytest.mark.parametrize(
    ("used", "taken"), [(2.5, 2.5), (3, 3.0), (0.1, 0.1), (0.05, 5.0), (None, 5.0), ("wide", 5.0)]
)
def test_the_cutoff_is_the_results_where_it_names_one_that_filters(used: Any, taken: float) -> None:
    result: Any = SimpleNamespace(settings={"cutoff": used})
    assert _cutoff(result) == taken
    assert _cutoff(SimpleNamespace(settings={})) == _cutoff(None) == 5.0  # type: ignore[arg-type]


def test_arrays_of_another_size_are_refused_with_their_names() -> None:
    with pytest.raises(DataError, match=r"^attitude: an array of shape \(3,\) \(valid: \(4,\)\)$"):
        _row("attitude", [0.0, 0.0, 1.0], 4)
    assert _row("attitude", None, 4) is None
    found = _row("velocity", [1, 2], 2)
    assert found is not None
    assert (found.dtype, found.tolist()) == (float, [1.0, 2.0])
