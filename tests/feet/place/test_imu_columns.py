"""The torque for each radian that the IMU is turned by, against a hand-solved case; and which columns show at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import Array
from plantar.estimation import Block
from plantar.feet.place.imu_mount import imu_columns, that_show
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.model_columns import model_columns
from plantar.models import MODELS, KelvinVoigt

STIFFNESS, DAMPING = 400.0, 10.0
FIT = AxisFit(
    foot=FOOT, axis="pitch", model=KelvinVoigt(), values=np.array([STIFFNESS, DAMPING]), shape=np.zeros(0),
    covariance=np.eye(2), freedom=np.full(2, 10.0), white_std=np.ones(2), offset_std={},
    equivalent=(STIFFNESS, DAMPING), choice=None, reason="asked for",
)  # fmt: skip


def test_a_turn_bends_the_bush_by_what_the_joints_make_of_it() -> None:
    """Joints that swing by 0.2 rad turn a third of the IMU's x turn, and minus all of its z turn, into pitch."""
    deflection = swayed()
    time = PERIOD * np.arange(len(deflection))
    swing, rate = 0.2 * np.sin(2.0 * time), 0.4 * np.cos(2.0 * time)
    turns = np.zeros((len(time), 2, 3))
    turns[:, 0] = np.outer(swing, [1 / 3, 0.0, -1.0])
    recording = replace(made_recording("sway", deflection, STIFFNESS * deflection), imu_turns={FOOT: turns})
    inner = slice(20, -20)  # rates at the ends are differences to one side
    wanted = np.outer(STIFFNESS * swing + DAMPING * rate, [1 / 3, 0.0, -1.0])
    assert imu_columns(recording, FIT)[inner] == pytest.approx(wanted[inner], abs=2e-3)
    turned = replace(FIT, imu_turned=(0.02, 0.0, 0.01))
    assert imu_columns(recording, turned)[inner] == pytest.approx(wanted[inner], abs=2e-3), (
        "the law is linear"
    )


def test_a_turn_moves_the_path_of_a_memory() -> None:
    """Against the columns of the model about an IMU that is turned a little more and a little less."""
    deflection, step = swayed(amplitude=0.02), 1e-3
    turns = np.zeros((len(deflection), 2, 3))
    turns[:, 0] = np.outer(0.2 * np.sin(0.02 * np.arange(len(deflection))), [1 / 3, 0.5, -1.0])
    recording = replace(made_recording("sway", deflection, STIFFNESS * deflection), imu_turns={FOOT: turns})
    values, shape = np.array([STIFFNESS, DAMPING, 5.0]), np.array([0.01])
    fit = replace(
        FIT, model=MODELS["elastoplastic"], values=values, shape=shape, imu_turned=(0.02, 0.0, 0.01)
    )

    def torque(sign: float, axis: Array) -> Array:
        x, y, z = np.array(fit.imu_turned) + sign * step * axis
        return model_columns(recording, FOOT, "pitch", replace(fit, imu_turned=(x, y, z))) @ values

    wanted = [(torque(1, axis) - torque(-1, axis)) / (2 * step) for axis in np.eye(3)]
    found = imu_columns(recording, fit)
    np.testing.assert_allclose(found, np.column_stack(wanted), atol=1e-7)
    assert np.abs(found - imu_columns(recording, replace(FIT, values=values[:2]))).max() > 1.0, "it slips"


def test_a_column_shows_by_what_no_offset_takes_up() -> None:
    """Two logs: a constant column shows in neither of them, a swing of a thousandth of the torque does where one
    deviation of it is 1 and not where that is 0.01."""
    swing = np.sin(np.linspace(0.0, 60.0, 500))
    blocks = [
        Block(name, np.ones((500, 1)), level + swing, 0.01) for name, level in (("one", 0.0), ("two", 50.0))
    ]
    columns = [np.column_stack([np.full(500, 7.0), 1e-3 * swing, 1e-3 * swing])] * 2
    found = that_show(blocks, columns, np.array([1.0, 1.0, 0.01]))
    assert found.tolist() == [False, True, False]
