"""What a plan asks of the joints, beside the statics of the bodies that they hold up."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from plantar.contact.balance import Balance
from plantar.errors import MotionError
from plantar.motions import feasible
from plantar.motions.body import Body
from plantar.motions.feasible import check
from plantar.twin.robots import hrp2
from twin_samples import plan

GRAVITY = 9.81
KNEES = ("RLEG_JOINT3", "LLEG_JOINT3")


def held_up(row: int) -> float:
    """A knee's torque [N·m] in a squat on two feet: half the moment about the knees of all that is above."""
    squat, model = plan("Squat"), hrp2.robot().model
    data, q = model.createData(), pin.neutral(model)
    for name, value in zip(squat.joints, squat.positions[row], strict=True):
        q[model.joints[model.getJointId(name)].idx_q] = value
    pin.forwardKinematics(model, data, q)
    places = [data.oMi[joint].act(model.inertias[joint].lever) for joint in range(model.njoints)]
    below = {joint for name in KNEES for joint in model.subtrees[model.getJointId(name)]}
    knee = data.oMi[model.getJointId(KNEES[0])].translation
    turn = squat.base[row][:3, :3]
    return (
        0.5
        * GRAVITY
        * sum(
            model.inertias[joint].mass * float((turn @ (place - knee))[0])
            for joint, place in enumerate(places)
            if joint not in below
        )
    )


def test_a_knee_that_cannot_hold_the_squat_is_named_with_its_torque() -> None:
    squat, body = plan("Squat"), Body(hrp2.robot())
    moments = np.abs([held_up(row) for row in range(0, len(squat.time), 20)])
    assert moments.max() > 1.5 * moments[0]
    limits = np.zeros(body.model.nv)  # 0: no limit
    knees = [body.model.joints[body.model.getJointId(name)].idx_v for name in KNEES]
    limits[knees] = 1.1 * moments.max()
    body.model.upperEffortLimit = limits
    check(body, squat)
    limits[knees] = 0.9 * moments.max()
    body.model.upperEffortLimit = limits
    with pytest.raises(
        MotionError,
        match=r"^t = 3\.4 s: Squat: joint 'LLEG_JOINT3' needs 45\.98 N·m \(valid: at most 44\.73 N·m\)$",
    ) as refused:
        check(body, squat)
    time, needs = (
        float(re.search(pattern, str(refused.value))[1])  # type: ignore[index]
        for pattern in (r"t = ([\d.]+) s", r"needs ([\d.]+)")
    )
    assert re.fullmatch(
        rf"t = {time:g} s: Squat: joint '[LR]LEG_JOINT3' needs [\d.]+ N·m "
        rf"\(valid: at most {0.9 * moments.max():.4g} N·m\)",
        str(refused.value),
    )
    assert needs == pytest.approx(abs(held_up(int(np.searchsorted(squat.time, time - 1e-6)))), rel=0.03)


def test_legs_whose_joints_follow_others_are_refused() -> None:
    """The inverse kinematics would move them by themselves, as no such robot can."""
    robot = hrp2.robot()
    knee = '<joint name="LLEG_JOINT3" type="revolute">'
    assert knee in robot.urdf
    bound = replace(
        robot, urdf=robot.urdf.replace(knee, f'{knee}<mimic joint="LLEG_JOINT4" multiplier="-2"/>')
    )
    with pytest.raises(
        MotionError,
        match=r"hrp2\.urdf: motions are planned for joints that move by themselves, not for LLEG_JOINT3 "
        r"\(valid: legs without <mimic>\)$",
    ):
        Body(bound)


def test_the_support_that_is_nearest_to_falling_decides(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a walk: 60, 2 and 80 mm inside of the sole that stands."""
    square = {"left": np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])}
    supports = [
        Balance("walk", np.array([second]), np.array([[x, 0.0]]), square)
        for second, x in ((0.0, 0.04), (1.0, 0.098), (2.0, 0.02))
    ]
    for name, found in (("_check_limits", None), ("_check_torques", None), ("configurations", ())):
        monkeypatch.setattr(feasible, name, lambda *_, found=found: found)
    monkeypatch.setattr(feasible, "_supports", lambda *_: supports)
    with pytest.raises(
        MotionError,
        match=r"^t = 1 s: walk: the zero-moment point comes within 2\.0 mm of the support polygon's "
        r"border \(valid: at least 5 mm inside\)$",
    ):
        check(None, None)  # type: ignore[arg-type]
    del supports[1]
    assert check(None, None) is supports[0]  # type: ignore[arg-type]
