"""What is said of places, mounts and joints that are not as the robot file says: whole lines, every number by value."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.feet.place import misread_joints
from plantar.feet.place.misread_joints import Misread, misread_joint_notes
from plantar.feet.place.place_notes import far_arms, place_notes, turned_bush
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.place.told_exact import _text
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt
from plantar.notes import Note

PRIOR, STD = np.array([0.005, 0.003, 0.01, 0.01, 0.01, 0.01]), np.array([1, 2, 3, 4, 5, 6]) * 1e-3


def fit_of(foot: str, axis: Any, arms: tuple[float, float] = (0.0, 0.0)) -> AxisFit:
    return AxisFit(
        foot=foot, axis=axis, model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0),
        covariance=np.eye(2), freedom=np.full(2, 30.0), white_std=np.ones(2), offset_std={}, equivalent=(400.0, 20.0),
        choice=None, reason="", moment_arms=arms,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (Misread("knee", "late", 0.0123, 1.0, True), "'knee' 12.3 ms late"),
        (Misread("knee", "late", -0.0123, 1.0, True), "'knee' 12.3 ms early"),
        (Misread("all joints", "together", 0.0123, 1.0, True), "all joints 12.3 ms late (or the IMU early)"),
        (Misread("all joints", "together", -0.0123, 1.0, True), "all joints 12.3 ms early (or the IMU late)"),
        (Misread("the IMU", "soft", -0.0023, 1.0, True),
         "the IMU tilts by 2.3 mrad for each m/s², as on a soft mount"),
        (Misread("knee", "play", 0.0012, 1.0, True), "'knee' 2.4 mrad behind wherever it turns round"),
        (Misread("knee", "gain", 0.25, 1.0, True), "'knee' 0.8 times"),
    ],
)  # fmt: skip
def test_an_error_of_a_joint_in_words(error: Misread, said: str) -> None:
    assert str(error) == said


def misread_notes(
    monkeypatch: pytest.MonkeyPatch, errors: dict[tuple[str, str], tuple[float, bool]], squares: float
) -> list[Note]:
    """Of errors by joint and kind: the squares that they leave beside the `squares` of the bush alone, and whether a
    number follows."""
    which = [*errors]
    left = np.array([errors[one][0] for one in which])

    def misread(joint: str, kind: str, wider: Any, wide: Any, usual: Any) -> Misread | None:
        assert wider == which.index((joint, kind))
        assert usual == "usual"
        return Misread(joint, kind, 0.05, *errors[joint, kind]) if errors[joint, kind][0] > 0.1 else None

    monkeypatch.setattr(misread_joints, "_columns", lambda *_: (which, np.arange(len(which))[None]))
    monkeypatch.setattr(misread_joints, "least_left", lambda *_: left)
    monkeypatch.setattr(misread_joints, "_misread", misread)
    tangent: Any = SimpleNamespace(
        least_squares=SimpleNamespace(squares=squares, values="usual"),
        recordings=["one"],
        blocks=["block"],
        beside=lambda columns: columns[0].item(),
    )
    robot: Any = None
    return misread_joint_notes(robot, tangent, fit_of("left", "roll"))


HEAD = "left roll: the torque follows the angle far better if one error of measurement is taken off: "
TAIL = (
    ". Stiffness and damping follow it (valid: encoders without play, whose angles are the links' and have the URDF's "
    "signs, all read at one moment; a stiff mount of the IMU)"
)
KNEE, HIP, LEG, IMU = ("knee", "gain"), ("hip", "late"), ("all joints", "together"), ("the IMU", "soft")


@pytest.mark.parametrize(
    ("errors", "squares", "code", "said"),
    [
        ({KNEE: (1.0, True)}, 1.6, "joint_misread", "'knee' 0.952 times"),
        ({KNEE: (1.0, True)}, 1.4, None, ""),  # not better by half
        ({KNEE: (1.0, False)}, 1.6, None, ""),  # no number follows
        ({HIP: (1.2, False), KNEE: (1.0, True)}, 1.8, "joint_misread", "'knee' 0.952 times, or 'hip' 50 ms late"),
        ({HIP: (1.3, True), KNEE: (1.0, True)}, 1.8, "joint_misread", "'knee' 0.952 times"),
        ({HIP: (1.2, True), KNEE: (1.0, False)}, 1.8, None, ""),  # the best of them decides
        ({LEG: (1.0, True)}, 1.6, "imu_out_of_time", "all joints 50 ms late (or the IMU early)"),
        ({LEG: (1.0, True), HIP: (1.1, True)}, 1.7, "joint_misread",
         "all joints 50 ms late (or the IMU early), or 'hip' 50 ms late"),
        ({IMU: (1.0, True)}, 1.4, "imu_soft", "the IMU tilts by 50 mrad for each m/s², as on a soft mount"),
        ({IMU: (1.0, True)}, 1.2, None, ""),
        ({HIP: (2.4, True), KNEE: (2.0, True)}, 3.6, "joint_misread", "'knee' 0.952 times, or 'hip' 50 ms late"),
        ({IMU: (0.05, True), KNEE: (1.2, True)}, 1.6, None, ""),  # the sure one is not better by half
        ({IMU: (0.05, True), KNEE: (1.0, True)}, 1.6, "joint_misread", "'knee' 0.952 times"),  # one is not sure
    ],
)  # fmt: skip
def test_which_errors_of_measurement_are_told(
    monkeypatch: pytest.MonkeyPatch,
    errors: dict[tuple[str, str], tuple[float, bool]],
    squares: float,
    code: str | None,
    said: str,
) -> None:
    found = misread_notes(monkeypatch, errors, squares)
    assert found == ([Note(code, "warning", HEAD + said + TAIL)] if code else [])


@pytest.mark.parametrize(
    ("axis", "place", "said"),
    [
        ("pitch", (0.0213, 0, 0, 0, 0, 0),
         "about a point 21.3 ± 2.0 mm forward or backward of feet.left.bush and feet.left.wrench"),
        ("roll", (-0.0213, 0, 0, 0, 0, 0),
         "about a point 21.3 ± 2.0 mm to the side of feet.left.bush and feet.left.wrench"),
        ("roll", (0, 0.0213, 0, 0, 0, 0),
         "about a point 21.3 ± 3.9 mm above feet.left.bush and feet.left.wrench"),
        ("roll", (0, -0.0213, 0, 0, 0, 0),
         "about a point 21.3 ± 3.9 mm below feet.left.bush and feet.left.wrench"),
        ("roll", (0, 0, -0.05, 0, 0, 0),
         "about an axis 2.9 ± 0.3 deg beside feet.left.wrench.rpy or imu.rpy"),
        ("roll", (0, 0, 0, 0.05, 0, -0.06),
         "as if the IMU were turned by 2.9 ± 0.4 deg about its x axis, beside imu.rpy; "
         "as if the IMU were turned by 3.4 ± 0.7 deg about its z axis, beside imu.rpy"),
    ],
)  # fmt: skip
def test_a_place_in_words(axis: str, place: tuple[float, ...], said: str) -> None:
    text = f"left {axis}: the torques turn {said} (95 %): corrected"
    (note,) = place_notes(fit_of("left", axis), np.array(place), STD, PRIOR)
    assert note == Note("bush_place", "warning", f"{text}; check the robot file")


@pytest.mark.parametrize("row", range(6))
def test_what_is_far_is_no_oversight(row: int) -> None:
    """From 4 cm of a centre, and 0.12 rad of a turn on."""
    for share, code in ((0.99, "bush_place"), (1.01, "bush_place_far")):
        place = np.zeros(6)
        place[row] = -share * (0.04 if row < 2 else 0.12)
        (note,) = place_notes(fit_of("left", "pitch"), place, STD, PRIOR)
        assert note.code == code
        far = note.text.endswith(": corrected, but that is far for an oversight; check the robot file")
        assert far == (code == "bush_place_far")


def test_each_place_is_doubted_by_its_own_prior_and_deviation() -> None:
    """Three deviations of both together, and never less than 5 mm or 0.02 rad."""
    prior, std = np.array([4, 8, 12, 16, 20, 24]) * 1e-3, np.array([3, 6, 5, 12, 15, 7]) * 1e-3
    sizes = 3 * np.hypot(prior, std)
    for row, size in enumerate(sizes):
        for share, said in ((0.98, 0), (1.02, 1)):
            place = np.zeros(6)
            place[row] = share * size
            assert len(place_notes(fit_of("left", "pitch"), place, std, prior)) == said, row


def test_a_turned_bush_in_words() -> None:
    text = (
        "left: pitch's torque shows in roll and roll's in pitch as if the bush were turned about the vertical: check "
        "feet.left.bush.rpy"
    )
    assert turned_bush("left", -0.05, -0.03, 0.04) == Note("bush_turned", "warning", text)
    assert turned_bush("left", -0.05, -0.028, 0.04) is None, "less than the least, on average"
    assert turned_bush("left", 0.05, -0.001, 0.01) is None, "more like a turned sensor"


def test_arms_that_are_too_long_are_told_together() -> None:
    """Of each axis its own; a foot's keys stand once."""
    fits = [
        fit_of("left", "pitch", (0.0512, -0.0623)), fit_of("left", "roll", (-0.0734, 0.0)),
        fit_of("right", "pitch", (0.039, 0.039)), fit_of("other", "roll", (0.0, 0.0845)),
    ]  # fmt: skip
    text = (
        "the torque turns about a point far from the bush's place in the robot file: left pitch 51 mm forward or "
        "backward and 62 mm above or below, left roll 73 mm to the side, other roll 84 mm above or below. Corrected, "
        "but no bush is so far off: measure feet.left.wrench and feet.left.bush, feet.other.wrench and feet.other.bush "
        "first, the numbers depend on them"
    )
    assert far_arms(fits) == [Note("bush_arm_far", "warning", text)]
    assert far_arms(fits[2:3]) == []


def test_a_place_told_as_exact_in_words() -> None:
    told, usual = (PlaceSpread(aside, 9.0, 9.0) for aside in (0.00021, 0.0052))
    assert _text(fit_of("right", "roll"), told, usual) == (
        "right roll: the torques turn about another point than feet.right.bush and feet.right.wrench, which "
        "`uncertainty` says are known to 0.21 mm: taken as known to 5.2 mm; check the robot file"
    )
