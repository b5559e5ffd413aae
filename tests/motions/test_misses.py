"""What is said of feet and chests that miss their places, by how much and with which joints at their limits."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from plantar.errors import MotionError
from plantar.motions.body import CHEST, Body
from plantar.motions.stance import Stance, check_reached, stand, with_arms
from plantar.motions.track import _check_body
from plantar.twin.robots import hrp2

SMALLER = "valid: a smaller motion"


@pytest.fixture(scope="module")
def body() -> Body:
    return Body(hrp2.robot())


@pytest.fixture(scope="module")
def start(body: Body) -> Stance:
    return stand(body, hrp2.postures().standing, {})


def test_a_foot_that_misses_is_told_with_what_was_asked_and_when(body: Body, start: Stance) -> None:
    """The right one by 30 and 40 mm; two tenths of a millimetre are no miss."""
    for miss, said in ((0.05, True), (2e-4, False)):
        places = dict(start.soles)
        places["right"] = places["right"] * pin.SE3(np.eye(3), miss * np.array([0.6, 0.8, 0.0]))
        if not said:
            check_reached(body, start.configuration, places, "standing on the left foot")
            continue
        with pytest.raises(MotionError) as refused:
            check_reached(body, start.configuration, places, "standing on the left foot", 2.5)
        assert str(refused.value) == (
            "hrp2_like, t = 2.5 s: standing on the left foot: the right foot cannot reach its place, it misses by "
            f"50.0 mm ({SMALLER})"
        )


@pytest.mark.parametrize(("upright_only", "said"), [(False, "50.0"), (True, None)])
def test_a_chest_falls_short_of_what_it_was_asked_for(
    upright_only: bool, said: str | None, body: Body, start: Stance
) -> None:
    here = body.pose(start.configuration, CHEST)
    asked = pin.SE3(here.rotation, here.translation + [0.03, 0.0, -0.04])
    task = body.chest_task(asked, position=not upright_only)
    tasks = [body.centre_task(here.translation), task]
    if said is None:
        _check_body(body, start.configuration, tasks, "Tilt4", 1.0)
        return
    with pytest.raises(MotionError) as refused:
        _check_body(body, start.configuration, tasks, "Tilt4", 1.25)
    assert str(refused.value) == (
        f"hrp2_like, t = 1.25 s: Tilt4: the chest cannot reach its place, it falls short by {said} mm "
        f"({SMALLER}, or one that moves the arms only, such as Myrand5)"
    )


def test_arms_that_move_leave_the_centre_of_mass_where_it_was(body: Body, start: Stance) -> None:
    moved = with_arms(body, start, {"RARM_JOINT0": -1.0, "LARM_JOINT0": -1.0})
    before, after = (body.centre_of_mass(one.configuration) for one in (start, moved))
    np.testing.assert_allclose(after[:2], before[:2], atol=2e-3)
    place = body.model.joints[body.model.getJointId("RARM_JOINT0")].idx_q
    assert moved.configuration[place] == pytest.approx(-1.0, abs=0.2)
    assert start.configuration[place] > -0.9
    assert (moved.soles, moved.standing) == (start.soles, start.standing)
