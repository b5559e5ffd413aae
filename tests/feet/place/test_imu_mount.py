"""What late encoders add passes for no turn of the IMU."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.place.imu_mount import turn_told, with_turns
from plantar.feet.regression.tangent import Tangent

STIFFNESS, MOUNT, LATE = 400.0, 0.01, 3e-4


def test_late_encoders_are_no_turn_of_the_imu() -> None:
    """A turn about y adds what late encoders do, and something of its own; only late encoders are there."""
    angle, other = swayed(4000), swayed(4000, seed=1)
    rates, turns = np.gradient(other, PERIOD), np.zeros((4000, 2, 3))
    turns[:, 0, 1] = 0.01 * rates + 0.002 * swayed(4000, seed=2) / 0.03
    torque = STIFFNESS * (angle + LATE * rates)
    recording = replace(
        made_recording("walk", angle, torque),
        imu_turns={FOOT: turns},
        encoder_rates={FOOT: np.column_stack([rates, rates])},
    )
    fit = fit_axis([recording], FOOT, "pitch", LINEAR)
    assert fit is not None
    tangent, shown = with_turns(Tangent.of(fit, [recording], False), MOUNT)
    assert shown.tolist() == [False, True, False]
    (told,) = turn_told(tangent.least_squares, shown)
    assert told.angles[1] == pytest.approx(0.0, abs=1e-3)
