"""Torques in another unit are refused, of a standing and a walking robot; gains, hands and odd samples are no unit."""

from __future__ import annotations

import re

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.faults.stance import StanceSides, stance_of
from plantar.faults.torque_unit import torque_unit
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.twin import PAPER, PRESETS
from plantar.twin.recording import record
from plantar.twin.robots import hrp2
from twin_samples import swayed, tilted, walked

SENSORS = PRESETS["sensors"]


@pytest.fixture(scope="module", params=[swayed, tilted, walked])
def log(request: pytest.FixtureRequest) -> MotionLog:
    if request.param is walked:
        return walked()
    return record(request.param(), hrp2.robot(), SENSORS.physics(PAPER), SENSORS, 0).log


def found(log: MotionLog, scale: float, sensor: str = "") -> list[Finding]:
    names = [name for name in log.columns if f"wrench.{sensor}" in name and ".torque." in name]
    spoiled = log.with_columns({name: scale * log.column(name) for name in names})
    stance = stance_of(hrp2.robot(), spoiled)
    assert stance is not None
    return list(torque_unit(hrp2.robot(), log, stance.sides()))


def told_of(log: MotionLog, moment_arms: Array, push: Array | None = None) -> list[Finding]:
    """Of a robot that does not accelerate, or whose ground's force is `push` (n, 3)."""
    up = np.tile([0.0, 0.0, 1.0], (len(moment_arms), 1))
    return list(torque_unit(hrp2.robot(), log, StanceSides(moment_arms, up, up if push is None else push)))


@pytest.mark.parametrize(
    ("unit", "scale"),
    [("N·mm", 1000.0), ("N·cm", 100.0), ("kgf·m", 1 / 9.80665), ("kgf·cm", 10.1972), ("kN·m", 0.001)],
)
def test_the_unit_is_named(log: MotionLog, unit: str, scale: float) -> None:
    (finding,) = found(log, scale)
    assert (finding.code, finding.fatal) == ("torque_unit", True)
    assert finding.text.startswith("columns 'wrench.*.torque.*': ")
    assert f"these look like {unit})" in finding.text
    times = float(re.findall(r"torques (\S+) times", finding.text)[0])
    assert times == pytest.approx(1 / scale, rel=0.3)


@pytest.mark.parametrize("scale", [0.5, 0.9, 1.0, 1.1, 2.0])
def test_a_gain_is_no_unit(log: MotionLog, scale: float) -> None:
    assert found(log, scale) == []


def test_of_one_sensor_alone(log: MotionLog) -> None:
    (finding,) = found(log, 1000.0, "right_foot")
    which = "*" if log.name == "Manual_right_roll" else "right_foot"  # it stands on that foot alone
    assert finding.text.startswith(f"columns 'wrench.{which}.torque.*': ")
    assert "these look like N·mm" in finding.text


def test_a_scale_that_is_no_units_is_refused_without_a_name(log: MotionLog) -> None:
    (finding,) = found(log, 30.0)
    assert finding.text.endswith("(valid: torques in N·m)")


def test_moments_that_hardly_go_together_tell_no_unit(log: MotionLog) -> None:
    """As of real robots whose masses or legs are not those of the URDF."""
    forces, others = np.random.default_rng(0).normal(0, 0.01, (2, 51, 2, 3, 3))
    moments = np.concatenate([forces, 100 * (others - 0.75 * forces)], axis=2)
    assert told_of(log, moments) == []


def test_beside_one_foots_reversed_torques_the_others_are_in_no_unit(log: MotionLog) -> None:
    """Both feet share a sway alike: with the left's turned round the right's look 3.2 times too small."""
    left, own = np.random.default_rng(0).normal(0, 0.01, (2, 51, 3, 3))
    right = 0.9 * left + 0.2 * own
    forces = np.stack([-left, -right], axis=1)
    moments = np.concatenate([forces, np.stack([-left, right], axis=1)], axis=2)
    assert told_of(log, moments) == []
    small = np.concatenate([forces, np.stack([left, right / 3.2], axis=1)], axis=2)
    assert len(told_of(log, small)) == 1


@pytest.mark.parametrize(("scale", "told"), [(1.0, 0), (1000.0, 1)])
def test_a_sways_angular_momentum_makes_no_unit(log: MotionLog, scale: float, told: int) -> None:
    """It takes most of what the left foot's torques do: these look nearly four times too large."""
    pulled, own, others, error = np.random.default_rng(0).normal(
        0, np.reshape([0.02, 5e-4, 3e-3, 2e-4], (4, 1, 1)), (4, 51, 3)
    )
    pulled[:, 2] = 0.0
    left, right = 0.15 * pulled + own, 0.05 * pulled + others
    moments = np.zeros((51, 2, 6, 3))
    moments[:, 0, 0] = 0.11 * pulled - left - right
    moments[:, 0, 3], moments[:, 1, 3] = scale * (left + error), scale * right
    push = np.cross(pulled, [0.0, 0.0, 1.0]) + [0.0, 0.0, 1.0]
    assert len(told_of(log, moments, push)) == told
    assert len(told_of(log, moments)) == 1  # as if nothing had pulled


def test_moments_that_go_together_in_part_of_a_log_tell_no_unit(log: MotionLog) -> None:
    forces, others = np.random.default_rng(0).normal(0, 0.01, (2, 51, 2, 3, 3))
    forces[:40] *= 0.2
    torques = -forces
    torques[:40] = 0.2 * others[:40]
    assert told_of(log, np.concatenate([forces, 100 * torques], axis=2)) == []


def test_part_of_a_motion_tells_no_unit(log: MotionLog) -> None:
    short = log.time < log.time[0] + 2.9
    part = MotionLog("part", log.time[short], {name: log.column(name)[short] for name in log.columns})
    assert found(part, 1000.0) == []


@pytest.mark.parametrize(("moved", "told"), [(1e-12, 0), (1e-6, 1)])
def test_moments_that_move_by_rounding_alone_tell_no_unit(log: MotionLog, moved: float, told: int) -> None:
    """Of columns that never change, means of them do by their last digit."""
    forces = moved * np.random.default_rng(0).standard_normal((51, 2, 3, 3))
    moments = np.concatenate([forces, -4 * forces], axis=2)
    assert len(told_of(log, 0.01 + moments)) == told
