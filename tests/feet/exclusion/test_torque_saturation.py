"""Where the torque stops growing with the angle, of a foot whose centre of pressure means nothing; and the window."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_recording import FOOT, made_recording
from plantar.contact.reasons import Reason
from plantar.feet.exclusion.torque_saturation import without_torque_saturation
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.robot.model import RobotModel

TIME = np.arange(6000) * 0.01
# Mostly at rest, out to 2.5 degrees on both sides.
ANGLE = np.radians(2.5) * np.sin(2 * np.pi * 0.2 * TIME) ** 5
STIFFNESS = 400.0
BEND = np.radians(1.2)


def zeroed_under_load(robot: RobotModel) -> RobotModel:
    return replace(robot, feet={FOOT: replace(robot.feet[FOOT], contact="always")})


def left_out(robot: RobotModel, recording: Recording, **settings: float) -> Recording:
    return without_torque_saturation(robot, recording, FeetSettings(**settings))  # type: ignore[arg-type]


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("rest", [0.0, 0.02])
def test_what_lies_beyond_the_bend_is_left_out_on_that_side(
    robot: RobotModel, side: float, rest: float
) -> None:
    torque = STIFFNESS * np.where(side * ANGLE > BEND, side * BEND, ANGLE)
    found = left_out(zeroed_under_load(robot), made_recording("tips", ANGLE + rest, torque))
    used = side * ANGLE[found.used(FOOT)]
    assert BEND * 0.9 < used.max() < 1.15 * BEND
    assert used.min() == pytest.approx(-np.radians(2.5), rel=0.01), "the other side is used"
    reasons = [why.text for why in found.contacts[FOOT].reasons if why.reason is Reason.TORQUE_SATURATION]
    assert reasons
    assert all(("positive" if side > 0 else "negative") in text for text in reasons)
    told = float(reasons[0].split("more than ")[1].split(" deg")[0])
    assert told == pytest.approx(1.2, abs=0.15), "in degrees"


def test_a_spring_that_never_bends_and_a_foot_with_a_centre_of_pressure_are_used_whole(
    robot: RobotModel,
) -> None:
    straight = made_recording("flat", ANGLE, STIFFNESS * ANGLE)
    assert left_out(zeroed_under_load(robot), straight).used(FOOT).all()
    bent = made_recording("tips", ANGLE, STIFFNESS * np.minimum(ANGLE, BEND))
    assert left_out(robot, bent).used(FOOT).all()


def test_the_window_is_about_the_resting_pose(robot: RobotModel) -> None:
    recording = made_recording("sway", ANGLE + 0.3, STIFFNESS * ANGLE)
    used = ANGLE[left_out(robot, recording, window=float(np.radians(1.0))).used(FOOT)]
    assert np.degrees([used.min(), used.max()]) == pytest.approx([-1.0, 1.0], abs=0.2)


@pytest.mark.parametrize(("samples", "whole"), [(98, True), (102, False)])
def test_a_bend_is_looked_for_in_a_hundred_samples_or_more(
    robot: RobotModel, samples: int, whole: bool
) -> None:
    angle = np.interp(np.linspace(0, 500, samples), np.arange(6000), ANGLE)  # one sway
    few = made_recording("few", angle, STIFFNESS * np.minimum(angle, BEND))
    assert left_out(zeroed_under_load(robot), few).used(FOOT).all() == whole


@pytest.mark.parametrize(("share", "bent"), [(0.3, True), (0.7, False)])
def test_a_torque_that_grows_at_less_than_half_of_its_slope_has_stopped(
    robot: RobotModel, share: float, bent: bool
) -> None:
    torque = STIFFNESS * np.where(ANGLE > BEND, BEND + share * (ANGLE - BEND), ANGLE)
    found = left_out(zeroed_under_load(robot), made_recording("tips", ANGLE, torque))
    assert (not found.used(FOOT).all()) == bent


@pytest.mark.parametrize(("share", "bent"), [(0.35, True), (0.45, False)])
def test_the_first_slope_is_that_of_the_first_half_of_the_rise(
    robot: RobotModel, share: float, bent: bool
) -> None:
    """Rubber that grows softer after 40 % of the rise does not tip: its first half is soft already by a part."""
    rise = np.maximum(ANGLE, 0.0)
    reach = np.radians(2.5)
    soft = 0.4 * reach * share / (0.6 + 0.4 * share)  # where 40 % of the rise is reached
    torque = STIFFNESS * np.where(rise > soft, soft + share * (rise - soft), ANGLE)
    found = left_out(zeroed_under_load(robot), made_recording("soft", ANGLE, torque))
    assert (not found.used(FOOT).all()) == bent
