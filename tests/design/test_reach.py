"""How far a motion may go: soles, joints, load and bend over each bush."""

from __future__ import annotations

from copy import copy

import numpy as np
import pytest

import design_samples
from plantar.design.family import CHANNELS, Lines
from plantar.design.reach import (
    KINDS,
    Reach,
)
from plantar.design.rubber import (
    SHARE,
    remembered,
)
from plantar.design.soft_feet import Softness
from plantar.design.soles import outward
from plantar.twin.presets import SLIP_TORQUE
from plantar.twin.robots import hrp2

BEND = 0.1
LIFT = 0.35
SLIP_ANGLE = 0.01
SIDES = 8


def test_the_element_is_at_least_the_rubber_of_the_rehearsals() -> None:
    """Of a robot of this weight, however soft its springs were told: limits would be passed in rehearsals."""
    lines = Lines.drawn(20.0, np.random.default_rng(1))
    soft = Softness.told(hrp2.robot(), 300.0, None)
    found = Reach(design_samples.legs(), design_samples.linear(), lines, soft, [soft], element=None).element
    assert found == pytest.approx(np.array(SLIP_TORQUE) / SLIP_ANGLE)
    stiff = Softness.told(hrp2.robot(), 800.0, None)
    more = Reach(design_samples.legs(), design_samples.linear(), lines, stiff, [stiff], element=None).element
    assert more == pytest.approx(800.0 * np.array(SHARE))
    measured = np.array([2.0, 0.5]) * np.array(SLIP_TORQUE) / SLIP_ANGLE
    known = Reach(design_samples.legs(), design_samples.linear(), lines, stiff, [stiff], measured).element
    assert known == pytest.approx([measured[0], SLIP_TORQUE[1] / SLIP_ANGLE])


def test_limits_are_held_to_shares_of_each_kind_over_each_bush() -> None:
    """Where motions may use half of one kind over one bush, they seem to use twice as much of it there."""
    reach, coefficients = design_samples.reach(), design_samples.coefficients()
    whole, shares = reach.used_by_kind(coefficients), np.ones((3, len(KINDS)))
    load, bent = reach.of(reach.load, coefficients), reach.of(reach.deflection, coefficients)
    assert whole[:, KINDS.index("load")] == pytest.approx(
        -load.min(axis=(1, 2)) / ((1 - LIFT) * reach.weight)
    )
    assert whole[:, KINDS.index("bend")] == pytest.approx(np.abs(bent).max(axis=(1, 2, 3)) / BEND)
    for place in np.ndindex(shares.shape):
        less, expected = shares.copy(), whole.copy()
        less[place], expected[place] = 0.5, 2 * whole[place]
        assert reach.held(less).used_by_kind(coefficients) == pytest.approx(expected)
    assert reach.held(0.5 * shares, 0.5).used(coefficients) == pytest.approx(2 * reach.used(coefficients))
    still = reach.held(shares, still=("arms",))
    assert still.used(coefficients) > 1e6
    without = reach.lines.without(coefficients, "arms")
    assert still.used(without) == pytest.approx(reach.used(without))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_feet_are_beyond_their_limits_where_a_centre_of_pressure_is(sign: float) -> None:
    """Whichever way the motion goes: soles are longer in front than behind."""
    reach, inside = design_samples.reach(), []
    of_feet, feet = copy(reach), reach.deflection[0, ..., 0].size + reach.load[0, ..., 0].size
    floor = len(reach.feet) * len(reach.bushes) * SIDES  # friction has a test of its own
    feet += floor + len(reach.bushes) * sum(len(room) for _, room in reach._edges)
    of_feet._low, of_feet._high = reach._low.copy(), reach._high.copy()
    of_feet._high[-floor:] = np.inf
    of_feet._low[:-feet], of_feet._high[:-feet] = np.inf, np.inf
    shape = sign * design_samples.coefficients()
    for size in np.linspace(0.3, 2.0, 36):  # not 1: a designed motion stands at a limit there
        bent, load = reach.of(reach.deflection, size * shape), reach.of(reach.load, size * shape)
        rate = reach.of(reach.rate, size * shape)
        slips = remembered(bent.reshape(-1, bent.shape[-1]), [SLIP_ANGLE]).reshape(bent.shape)
        torque = reach.stiffness[:, None, None, None] * bent + reach.damping[:, None, None, None] * rate
        torque += reach.element[:, None] * slips
        free = np.abs(bent).max() < BEND
        for place, (normals, room) in enumerate(reach._edges):
            carried = reach.weight + load[:, place]
            pressure = np.stack([-torque[:, place, 0], torque[:, place, 1]]) / carried
            free &= bool((np.einsum("ek,ksn->esn", normals, pressure) + room[:, None, None] > 0).all())
        free &= bool((-load.min() / reach.weight) < 1 - LIFT)
        inside.append(free)
        assert (of_feet.used(size * shape) <= 1.0) == free, size
    assert any(inside)
    assert not all(inside)


def test_an_edge_is_reached_where_the_torque_over_the_whole_load_is_its_room() -> None:
    """That of a centre of pressure at the edge, under what stands there and what the motion adds to it."""
    whole = design_samples.reach()
    reach, random = copy(whole), np.random.default_rng(3)
    reach.load = 0.1 * reach.weight * random.standard_normal(whole.load.shape)
    for place, (normals, room) in enumerate(reach._edges):
        series, _, high = reach._sole(place)
        carried = reach.weight + reach.load[:, :, place, None]
        at_edge = room[:, None] * carried  # [N·m]
        out = outward(normals, reach._torque()[:, :, place])
        left = (high[:, None] - series).reshape(out.shape)
        np.testing.assert_allclose(left, at_edge - out, atol=1e-9)


def test_joints_have_their_own_room_to_each_side() -> None:
    reach, shape = copy(design_samples.reach()), design_samples.coefficients()
    gain = design_samples.linear().joints[:, 6:]
    moved = gain[:, np.abs(gain).max(axis=0) > 1e-9].T @ reach.lines.displacements(shape, reach.time)
    rows = slice(len(CHANNELS), len(CHANNELS) + len(moved))
    for side, most in (("_low", -moved.min(axis=1)), ("_high", moved.max(axis=1))):
        reach._low, reach._high = (np.full_like(reach._low, np.inf) for _ in range(2))
        getattr(reach, side)[rows] = 1e-3
        assert reach.used(shape) == pytest.approx(most.max() / 1e-3)


def test_near_its_limits_a_motion_has_room_as_told() -> None:
    """Of springs alone all is linear: what is left of each limit after a small step is what the rows say."""
    reach, shape = copy(design_samples.reach()), design_samples.coefficients()
    reach.element = 0 * reach.element
    rows, left = reach.near(shape)
    assert left.min() == pytest.approx(1 - reach.used(shape))
    assert left.max() < 0.2, "only what is near"
    passed, over = reach.near(1.5 * shape, 1.0)
    assert len(passed) > 0
    assert over.max() < 0.0, "only what is passed"
    assert rows @ shape == pytest.approx(1 - left)
