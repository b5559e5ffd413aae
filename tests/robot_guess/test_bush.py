"""How high a bush sits: the moment arm of the horizontal force about a point beside its centre."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.recording import Recording
from plantar.robot.model import RobotModel
from plantar.robot_guess import bush
from plantar.robot_guess.bush import _height, bush_shift

COUNT = 3000


def about(height: float, noise: float = 0.0, stiffness: float = 400.0) -> Recording:
    """Torques about a point that lies `height` [m] above the centre: by height·F_x in pitch, -height·F_y in roll."""
    angle = swayed(COUNT)
    rate = np.gradient(angle, PERIOD)
    made = made_recording("sway", angle, stiffness * angle + 20.0 * rate, rate=rate)
    state = made.bushes[FOOT]
    wrench = state.wrench.copy()
    wrench[:, 0], wrench[:, 1] = 3000.0 * swayed(COUNT, seed=1), 2000.0 * swayed(COUNT, seed=2)
    wrench[:, 2] += 900.0 * swayed(COUNT, seed=3)
    moments = height * np.column_stack([wrench[:, 0], -wrench[:, 1]])
    rubbing = noise * np.random.default_rng(0).normal(size=(COUNT, 2))
    moved = replace(state, wrench=wrench, torque=state.torque + moments + rubbing + 0.02 * wrench[:, 2:3])
    return replace(made, bushes={FOOT: moved}, raw={FOOT: moved})


@pytest.mark.parametrize("height", [0.03, -0.02])
@pytest.mark.parametrize("axis", [0, 1])
def test_the_horizontal_force_shows_the_height(height: float, axis: int) -> None:
    assert _height([about(height)], FOOT, axis) == pytest.approx(height, abs=1e-3)


def test_a_recording_in_pieces_shows_the_same_height_with_an_offset_of_its_own_in_each() -> None:
    """Each too short for a fit by itself."""
    whole = about(0.03)
    pieces = []
    for number, start in enumerate(range(0, COUNT, 150)):
        rows = slice(start, start + 150)
        piece = made_recording("piece", whole.bushes[FOOT].deflection[rows, 0], np.zeros(150))
        state = whole.bushes[FOOT]
        cut = {key: getattr(state, key)[rows] for key in ("deflection", "rate", "wrench", "torque")}
        cut["torque"] = cut["torque"] + 3.0 * number
        moved = replace(piece.bushes[FOOT], **cut)
        pieces.append(replace(piece, bushes={FOOT: moved}, raw={FOOT: moved}))
    assert _height(pieces, FOOT, 0) == pytest.approx(0.03, abs=3e-3)
    assert _height(pieces[:1], FOOT, 0) is None


def test_a_torque_that_no_bush_explains_shows_none() -> None:
    assert _height([about(0.03, noise=8.0)], FOOT, 0) is None
    assert _height([], FOOT, 0) is None


def test_a_torque_that_pushes_along_shows_none() -> None:
    assert _height([about(0.03, stiffness=5.0)], FOOT, 0) == pytest.approx(0.03, abs=1e-3)
    assert _height([about(0.03, stiffness=-5.0)], FOOT, 0) is None


@pytest.mark.parametrize(
    ("heights", "found"),
    [
        ((0.01, 0.03, 0.02, 0.03), (0.025, 2 * np.sqrt(0.6875e-4))),
        ((0.02, 0.02, None, 0.02), (0.02, 0.01)),  # no nearer than a loaded bush sinks
        ((0.01, 0.05, 0.01, 0.05), None),  # feet and axes do not agree
        ((0.02, None, None, 0.02), None),
    ],
)
def test_all_feet_and_axes_have_to_agree(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch, heights: tuple[float | None, ...], found: object
) -> None:
    said = iter(heights)
    monkeypatch.setattr(bush, "_height", lambda *_: next(said))
    shift = bush_shift(robot, [])
    assert shift == (None if found is None else pytest.approx(found))
