"""The path that a bush's memory follows: also where the sole leans and its angle is not the bush's."""

from __future__ import annotations

import numpy as np

from biped import TRUTH, record, sway
from feet_trials import PUNCTUAL
from plantar.identify.axis_blocks import motion_of
from plantar.identify.recording import checked, prepare
from plantar.robot import RobotModel


def test_a_bush_follows_its_torque_while_the_sole_leans(robot: RobotModel) -> None:
    recording = prepare(robot, checked(robot, record(sway())), "fit", PUNCTUAL)
    contact, bush = recording.contacts["right"], recording.bushes["right"]
    true, rate = bush.deflection[:, 0].copy(), bush.rate[:, 0].copy()
    lean = np.zeros(len(true), dtype=bool)
    lean[600:640] = lean[900:905] = True
    contact.leave_out(lean, "tipping: put in")
    bush.deflection[lean, 0] += 0.02
    bush.rate[lean, 0] += 0.3
    as_seen = motion_of(recording, "right", "pitch")
    assert np.ptp(as_seen.deflection[595:645] - true[595:645]) > 0.015
    law = TRUTH["right", "pitch"]
    followed = motion_of(recording, "right", "pitch", law.stiffness)
    # The damper's share of the torque is what a spring alone gets wrong.
    damped = law.damping * np.abs(rate).max() / law.stiffness
    assert np.abs(followed.deflection - true)[lean].max() < damped < 0.01
    assert np.abs(followed.rate - rate)[605:635].max() < 0.15
    np.testing.assert_array_equal(followed.deflection[~lean], true[~lean])
