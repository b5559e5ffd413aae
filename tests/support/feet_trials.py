"""What tests of identified feet have in common: settings, the truth as an expectation, logs with noise or less."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, BushModel, drawn_up, record, sway
from biped_robot import FEET
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult

# The biped's forces are drawn, not moved by Newton: its logs cannot show a delay, and are known to have none.
PUNCTUAL = FeetSettings(wrench_delay=0.0)
# Where a test does not ask which model is chosen: none is, which halves what a fit costs.
LINEAR = FeetSettings(wrench_delay=0.0, model="kelvin_voigt")

ZERO = 20.0  # N, of the left force sensor along z where that foot steps
STEP, STANDS = 1.5, 1.0  # s, of a step and of its stance
EXACT = 1e-4  # what differences of the joints' positions cost
Truth = Mapping[tuple[str, str], BushModel]
AXES = ("pitch", "roll")


def assert_truth(result: FeetResult, rel: float, feet: tuple[str, ...] = FEET, truth: Truth = TRUTH) -> None:
    """Stiffness, damping and every motion's offset agree with the law that made the logs."""
    for foot in feet:
        for axis in AXES:
            law = truth[foot, axis]
            assert result.parameter(foot, axis, "stiffness").value == pytest.approx(law.stiffness, rel=rel)
            assert result.parameter(foot, axis, "damping").value == pytest.approx(law.damping, rel=4 * rel)
    for row in result.offsets:
        law = truth[row.foot, row.axis]
        assert row.foot not in feet or row.value == pytest.approx(law.offset, abs=0.2 * rel * law.stiffness)


def biased(name: str, seed: int, shift: float) -> MotionLog:
    """Exact, about offsets that are moved by `shift` [N·m]."""
    truth = {key: replace(law, offset=law.offset + shift) for key, law in TRUTH.items()}
    return record(sway(name, seed=seed, truth=truth))


def rotational(result: FeetResult) -> np.ndarray:
    """Stiffness and damping in a fixed order."""
    names = ("stiffness", "damping")
    return np.array(
        [result.parameter(foot, axis, name).value for foot in FEET for axis in AXES for name in names]
    )


def codes(result: FeetResult) -> set[str]:
    return {note.code for note in result.notes}


def without(log: MotionLog, *parts: str) -> MotionLog:
    """The log without the columns whose name holds one of `parts`."""
    kept = {name: values for name, values in log.columns.items() if not any(part in name for part in parts)}
    return MotionLog(log.name, log.time, kept)


def noisy(log: MotionLog, seed: int) -> MotionLog:
    """White noise of usual sizes on every channel."""
    random = np.random.default_rng(seed)
    size = {"orientation": 1e-4, "angular_velocity": 2e-3, "linear": 0.02, "position": 1e-5, "velocity": 1e-3}
    size |= {"force": 1.0, "torque": 0.1}

    def spoiled(name: str, values: np.ndarray) -> np.ndarray:
        return values + random.normal(0, next(s for part, s in size.items() if part in name), len(values))

    return log.with_columns({name: spoiled(name, values) for name, values in log.columns.items()})


def stepping(log: MotionLog) -> MotionLog:
    """The left foot is lifted for a third of each step; the right one carries all, and its torque is not looked at."""
    loaded = np.mod(log.time, STEP) < STANDS
    changed = {}
    for part in ("force", "torque"):
        for axis in "xyz":
            left, right = (log.columns[f"wrench.{foot}.{part}.{axis}"] for foot in ("left", "right"))
            changed[f"wrench.left.{part}.{axis}"] = np.where(loaded, left, 0.0)
            if part == "force":
                changed[f"wrench.right.{part}.{axis}"] = right + np.where(loaded, 0.0, left)
    changed["wrench.left.force.z"] = changed["wrench.left.force.z"] + ZERO
    return drawn_up(log.with_columns(changed), "left", ~loaded)


def shifted(log: MotionLog, arm: np.ndarray) -> MotionLog:
    """The log of force sensors that sit `arm` (3,) [m] away from where the robot file has them."""
    moved = {}
    for foot in FEET:
        names = [f"wrench.{foot}.{part}.{axis}" for part in ("force", "torque") for axis in "xyz"]
        force, torque = np.hsplit(log.stack(names), 2)
        moved |= dict(zip(names[3:], (torque - np.cross(arm, force)).T, strict=True))
    return log.with_columns(moved)
