"""A designed motion over time: how much of the joints' limits it takes up."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from plantar.design.trajectory import Trajectory


def bent(angles: np.ndarray, turns: int = 1) -> Trajectory:
    """One joint, from -0.2 to 1.0 rad and up to 2 rad/s, through these angles in 10 s."""
    model = pin.Model()
    limits = (np.array([1.0]), np.array([2.0]), np.array([-0.2]), np.array([1.0]))
    model.addJoint(0, pin.JointModelRX(), pin.SE3.Identity(), "knee", *limits)
    body = SimpleNamespace(joints=("knee",), positions=lambda q: q)
    knots = np.linspace(0.0, 10.0 / turns, len(angles))
    return Trajectory("bend", SimpleNamespace(model=model, body=body), knots, angles[:, None])  # type: ignore[arg-type]


@pytest.mark.parametrize(("low", "high", "way"), [(-0.15, 0.5, 0.75), (-0.05, 0.5, 0.5), (0.0, 0.9, 0.9)])
def test_the_way_to_a_limit_is_counted_from_where_the_robot_stands(
    low: float, high: float, way: float
) -> None:
    share = np.sin(np.linspace(0.0, 2 * np.pi, 401))
    used, _ = bent(np.where(share > 0, high * share, -low * share)).limits_used()
    assert used == pytest.approx(way, rel=1e-3)


def test_the_same_way_in_half_the_time_takes_twice_the_speed() -> None:
    angles = 0.5 * np.sin(np.linspace(0.0, 2 * np.pi, 401)) ** 2
    (way, slow), (again, fast) = (bent(angles, turns).limits_used() for turns in (1, 2))
    assert way == pytest.approx(again)
    assert slow == pytest.approx(0.5 * 2 * np.pi / 10.0 / 2.0, rel=1e-3)  # of 2 rad/s
    assert fast == pytest.approx(2 * slow)
