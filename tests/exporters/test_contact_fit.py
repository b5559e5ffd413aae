"""Feet on points: what is asked of the points, how they are written, and what they turn with alone in MuJoCo."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import GRAVITY, Axis
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.alone import (
    INERTIA_TIME,
    Measured,
    _Alone,
    contact_attributes,
    measured,
    standing_stiffness,
)
from plantar.exporters.contact.fit import LOADS, STEPS, fitted
from plantar.exporters.contact.points import Point, Sides, points_for, sides_of
from plantar.exporters.job import LEAST_LOAD as EDGES
from plantar.exporters.spring import Spring

mujoco = pytest.importorskip("mujoco")
ROTATIONS: tuple[Axis, ...] = ("pitch", "roll")
FEET: dict[str, tuple[dict[Axis, tuple[float, float]], Sides, float, float]] = {
    # K and C by axis, the sole, its depth below the bush, the robot's mass
    "on rubber": ({"pitch": (480, 24), "roll": (352, 28)}, Sides(0.11, 0.11, 0.07, 0.07), 0.02, 57),
    "large, ankle far back": ({"pitch": (2600, 40), "roll": (1500, 50)}, Sides(0.15, 0.07, 0.06, 0.06), 0.1, 95),
    "stiff in roll": ({"pitch": (300, 12), "roll": (900, 9), "z": (2e5, 300)}, Sides(0.1, 0.08, 0.05, 0.06), 0.03, 40),
}  # fmt: skip


def bush(axes: dict[Axis, tuple[float, float]], sole: Sides, depth: float) -> FootBush:
    springs = tuple(Spring(axis, *axes[axis], 0.0) for axis in ("z", "pitch", "roll") if axis in axes)  # type: ignore[index]
    outline = [(x, y, -depth) for x, y in ((sole.front, sole.left), (sole.front, -sole.right),
                                           (-sole.back, -sole.right), (-sole.back, sole.left))]  # fmt: skip
    return FootBush("left", "ankle", springs, np.zeros(3), np.eye(3), np.array(outline))


@pytest.mark.parametrize("name", FEET)
def test_points_have_the_sums_that_they_were_asked_for_and_balance_about_the_bush(name: str) -> None:
    axes, sole, depth, mass = FEET[name]
    stiffness, damping = ({axis: pair[place] for axis, pair in axes.items()} for place in (0, 1))
    foot = points_for(stiffness, damping, sole, depth, mass * GRAVITY, EDGES)
    assert 4 <= len(foot.points) <= 9
    assert all(point.stiffness > 0 and point.damping > 0 for point in foot.points)
    for axis in ROTATIONS:
        assert foot.turning(axis) == pytest.approx(axes[axis])
    for moment in (lambda p: p.x, lambda p: p.y, lambda p: p.x * p.y):
        assert sum(moment(p) * p.stiffness for p in foot.points) == pytest.approx(0, abs=1e-6)
        assert sum(moment(p) * p.damping for p in foot.points) == pytest.approx(0, abs=1e-6)
    if "z" in axes:
        assert foot.vertical[0] == pytest.approx(axes["z"][0])
    # The edges carry their part before the middle touches, and the sinking goes on without a step.
    carried = EDGES * mass * GRAVITY
    assert foot.sink(carried) == pytest.approx(0, abs=1e-9)
    assert foot.sink(0.5 * carried) == pytest.approx(-0.5 * max(point.lower for point in foot.points))


def test_one_axis_alone_stands_on_corners() -> None:
    foot = points_for({"pitch": 400}, {"pitch": 20}, Sides(0.1, 0.1, 0.05, 0.05), 0.02, 500, EDGES)
    assert foot.turning("pitch") == pytest.approx((400, 20))
    assert sum(point.lower > 0 for point in foot.points) == 4


def test_a_sole_is_taken_as_a_rectangle_of_its_area() -> None:
    sole = bush(FEET["large, ankle far back"][0], FEET["large, ankle far back"][1], 0.1)
    assert vars(sides_of(sole)) == pytest.approx(vars(FEET["large, ankle far back"][1]))
    outline = 0.1 * np.array([(np.cos(a), np.sin(a), -1) for a in np.linspace(0, 2 * np.pi, 200)])
    round_sole = FootBush("left", "ankle", (), np.zeros(3), np.eye(3), outline)
    sides = sides_of(round_sole)
    assert (sides.front + sides.back) * (sides.left + sides.right) == pytest.approx(np.pi * 0.01, rel=2e-3)


@pytest.mark.parametrize("axis", ROTATIONS)
def test_the_load_takes_its_height_off_the_stiffness(axis: Axis) -> None:
    """About the bush centre the ground's push leans with the sole: K = Σ k x² - load x depth, by statics."""
    axes, sole, depth, mass = FEET["on rubber"]
    stiffness, damping = ({axis: pair[place] for axis, pair in axes.items()} for place in (0, 1))
    foot = points_for(stiffness, damping, sole, depth, mass * GRAVITY, EDGES)
    for load in (250.0, 600.0):
        seen = measured(foot, axis, load, 0.001)
        assert seen.stiffness == pytest.approx(axes[axis][0] - load * depth, rel=5e-3)
        assert seen.damping == pytest.approx(axes[axis][1], rel=0.03)  # soles creep a little, which damps too


@pytest.mark.slow
@pytest.mark.parametrize("name", FEET)
def test_a_fitted_foot_gives_k_and_c_back_at_every_load_and_step(name: str) -> None:
    axes, sole, depth, mass = FEET[name]
    found = fitted(bush(axes, sole, depth), mass * GRAVITY)
    for check in found.checks:
        k, c = axes[check.axis]
        assert check.steps == STEPS
        for load in LOADS:
            for step in STEPS:
                seen = measured(found.foot, check.axis, load * mass * GRAVITY, step)
                assert seen.stiffness == pytest.approx(k, rel=0.05)
                assert seen.damping == pytest.approx(c, rel=0.15)
        # As far as it is said to hold, it holds.
        least = LOADS[0] * mass * GRAVITY
        share = check.angle / found.foot.touching_angle(check.axis, least)
        assert standing_stiffness(found.foot, check.axis, least, 0.001, share) == pytest.approx(k, rel=0.05)


@pytest.mark.parametrize(
    ("sides", "depth"), [(Sides(0.11, 0.11, 0.07, 0.07), 0.02), (Sides(0.14, 0.09, 0.06, 0.05), 0.0)]
)
@pytest.mark.parametrize("axis", ROTATIONS)
def test_second_points_take_over_where_an_edge_leaves_the_ground(
    sides: Sides, depth: float, axis: Axis
) -> None:
    """K goes on up to where the sole tips; without them the foot is much softer there."""
    stiffness: dict[Axis, float] = {"pitch": 480, "roll": 352}
    load = 280.0
    first = points_for(stiffness, {"pitch": 24, "roll": 28}, sides, depth, 2 * load, 0.2)
    foot, free = first.taking_over(load, 2.2 * load), load * depth
    assert (foot.sink(load), foot.vertical, foot.turning(axis)) == (
        first.sink(load), first.vertical, first.turning(axis))  # fmt: skip
    assert foot.touching_angle(axis, load) == first.touching_angle(axis, load)
    k = stiffness[axis] - free
    assert standing_stiffness(foot, axis, load, 0.001, 1.5) == pytest.approx(k, rel=0.06)
    assert standing_stiffness(first, axis, load, 0.001, 1.5) < 0.85 * k


def test_a_foot_without_a_middle_has_no_second_points() -> None:
    """There the edge that leaves the ground is the sole's own tipping."""
    foot = points_for({"pitch": 480, "roll": 352, "z": 2e4}, {"pitch": 24, "roll": 28}, Sides(0.1, 0.1, 0.07, 0.07),
                      0.02, 560, 0.4)  # fmt: skip
    assert foot.taking_over(280.0, 616.0) is foot


def test_a_step_that_does_not_hold_is_not_said_to() -> None:
    foot = fitted(bush(*FEET["on rubber"][:3]), 57 * GRAVITY).foot
    seen = measured(foot, "roll", 280, 0.02)
    assert seen == pytest.approx(Measured(np.nan, np.nan), nan_ok=True) or abs(seen.damping / 28 - 1) > 0.15


@pytest.mark.parametrize(
    ("last", "angle"),
    [
        (np.full(20, 0.1), 0.1),
        (0.1 + 0.0009 * np.linspace(-0.5, 0.5, 20), 0.1),  # within a hundredth
        (0.1 + 0.0020 * np.linspace(-0.5, 0.5, 20), np.nan),  # it still turns
        (np.full(20, 0.51), np.nan),  # it has fallen, and lies still
    ],
)
def test_a_foot_has_an_angle_where_it_stands_and_stands_still(
    last: np.ndarray, angle: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    track = np.concatenate([np.linspace(0.0, 1.0, 180), last])
    monkeypatch.setattr(_Alone, "_track", lambda *_: track)
    alone = _Alone.__new__(_Alone)
    alone.step = 0.01
    assert alone.turned("pitch", 300.0, 5.0, 2.0) == pytest.approx(angle, nan_ok=True)


# --- The exported file ------------------------------------------------------------------------------------


@pytest.mark.parametrize("damping", [0.0, 300.0, 3e5])
def test_a_point_pushes_with_its_spring_and_damper_either_way_it_is_written(damping: float) -> None:
    """With a damper it has a time constant, which engines beside MuJoCo read; without one stiffness and damping."""
    written = contact_attributes(Point(0.0, 0.0, 2e4, damping), 0.5)
    assert written["solref"].startswith("-") == (damping == 0)
    assert damping == 0 or float(written["solref"].split()[0]) >= 2 * max(STEPS)
    inertia = max(INERTIA_TIME * damping, 0.5 * INERTIA_TIME**2 * 2e4)
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option cone="elliptic" gravity="0 0 0"/><worldbody><geom type="plane" size="1 1 1"/><body>'
        '<joint type="slide" axis="0 0 1"/><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>'
        '<geom type="sphere" size="0.002" pos="0 0 0.001" mass="0" priority="1" '
        + " ".join(f'{key}="{value}"' for key, value in written.items())
        + "/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    data.qvel[0] = -0.002  # 1 mm in the ground, and sinking
    mujoco.mj_forward(model, data)
    # (m + inertia) a = k r - c v
    assert (2 + inertia) * data.qacc[0] == pytest.approx(2e4 * 0.001 + damping * 0.002, rel=1e-6)
