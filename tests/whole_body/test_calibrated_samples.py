"""Rows of eq. 2 and 3: the root's motion as a turned IMU has seen it, wrenches as their sensors read them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sway
from plantar.robot.model import RobotModel
from plantar.whole_body.dataset import Body, Whole, prepare_whole
from plantar.whole_body.equations import Calibration, carried, inertial_samples, joint_samples
from plantar.whole_body.settings import DynamicsSettings

TURN = Rotation.from_rotvec([0.1, -0.2, 0.3]).as_matrix()
TERMS = {"neck": ("viscous", "offset"), "left_ankle_pitch": ("stiffness",)}


@pytest.fixture(scope="module")
def body(robot: RobotModel) -> Body:
    return Body.of(robot, floating=True)


@pytest.fixture(scope="module")
def whole(body: Body) -> Whole:
    log = record(sway(duration=6.0))
    return prepare_whole(body, log.with_columns({"joint.neck.effort": np.cos(log.time)}), DynamicsSettings())


@pytest.mark.parametrize("joints", [False, True])
def test_the_roots_motion_is_turned_and_nothing_else(body: Body, whole: Whole, joints: bool) -> None:
    """Acceleration, rate and its derivative, each by the calibration's rotation."""

    def samples(rotation: np.ndarray) -> object:
        calibration = Calibration(rotation)
        return (
            joint_samples(body, whole, calibration, TERMS)
            if joints
            else inertial_samples(body, whole, calibration)
        )

    plain, turned = samples(np.eye(3)), samples(TURN)
    for part in (0, 3, 6):
        expected = plain.motion.base[:, part : part + 3] @ TURN.T
        np.testing.assert_allclose(turned.motion.base[:, part : part + 3], expected, atol=1e-12)
    np.testing.assert_array_equal(turned.motion.positions, plain.motion.positions)
    assert turned.measured.keys() == plain.measured.keys()
    for row, values in plain.measured.items():
        np.testing.assert_array_equal(turned.measured[row], values)


def test_a_joints_row_is_its_effort_and_what_the_contacts_carry(body: Body, whole: Whole) -> None:
    """A joint without effort is passive: its torque is zero, and the ground's alone stands in its row."""
    calibration = Calibration(np.eye(3), {"left": 2.0 * np.eye(6)})
    samples = joint_samples(body, whole, calibration, TERMS)
    rows = carried(body, whole, calibration)[:, whole.valid]
    place = {name: 6 + body.equation.tree.names.index(name) for name in TERMS}
    effort = whole.efforts["neck"][whole.valid]
    np.testing.assert_allclose(samples.measured[place["neck"]], rows[place["neck"]] + effort)
    np.testing.assert_allclose(samples.measured[place["left_ankle_pitch"]], rows[place["left_ankle_pitch"]])
    assert np.abs(effort).max() > 0.9
    assert len(samples.extras[place["neck"]]) == 2
    angle = whole.motion.positions[whole.valid, place["left_ankle_pitch"] - 6]
    np.testing.assert_array_equal(samples.extras[place["left_ankle_pitch"]][0], angle)
    assert samples.positive[place["neck"]] == (True, False)
    plain = carried(body, whole, Calibration(np.eye(3)))
    other = carried(body, whole, Calibration(np.eye(3), {"left": np.zeros((6, 6))}))
    np.testing.assert_allclose(rows, (2 * plain - other)[:, whole.valid], atol=1e-9)
