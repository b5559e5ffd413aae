"""A foot on points, without any engine: what its springs and dampers add up to, and what its notes say of them."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from plantar.conventions import Axis
from plantar.exporters.bush import FootBush
from plantar.exporters.contact import fit
from plantar.exporters.contact.alone import INERTIA_TIME, Measured, contact_attributes
from plantar.exporters.contact.fit import LOADS
from plantar.exporters.contact.points import Point, PointFoot, points_for, sides_of
from plantar.exporters.contact.springs import (
    RADIUS,
    placed,
    pushes,
    said,
    share_of_friction,
    sliding_note,
    spring_foot,
    stiffness_under,
    vertical_note,
)
from plantar.exporters.spring import Spring

MARKED = 0.25

WEIGHT = 600.0
SOLE = np.array([[0.13, 0.06, -0.1], [-0.09, 0.06, -0.1], [-0.09, -0.05, -0.1], [0.13, -0.05, -0.1]])
SPRINGS = (
    Spring("z", 2.5e5, 5000.0, 0.0),
    Spring("pitch", 434.0, 15.5, 0.0),
    Spring("roll", 323.0, 17.5, 0.0),
)
FOOT = FootBush("left", "ankle", SPRINGS, np.zeros(3), np.eye(3), SOLE)
STIFFNESS: dict[Axis, float] = {"z": 2.5e5, "pitch": 434.0, "roll": 323.0}
DAMPING: dict[Axis, float] = {"z": 5000.0, "pitch": 15.5, "roll": 17.5}


@pytest.fixture(scope="module")
def foot() -> PointFoot:
    return points_for(STIFFNESS, DAMPING, sides_of(FOOT), 0.1, WEIGHT, 0.2)


def test_points_add_up_to_the_springs_and_dampers_asked_for(foot: PointFoot) -> None:
    assert foot.vertical == pytest.approx((2.5e5, 5000.0))
    for axis in ("pitch", "roll"):
        assert foot.turning(axis) == pytest.approx((STIFFNESS[axis], DAMPING[axis]))
    edges = [p for p in foot.points if p.lower > 0]
    for sides in ([p.x for p in edges], [p.y for p in edges]):
        assert sum(p.stiffness * side for p, side in zip(edges, sides, strict=True)) == pytest.approx(
            0.0, abs=1e-9
        )
        assert min(sides) < 0 < max(sides)


@pytest.mark.parametrize(
    ("pitch", "roll", "length", "width"),
    [(1.0, 1.0, 1.0, 1.0), (1.0, 2.0, 1.0, np.sqrt(2)), (2.0, 1.0, np.sqrt(2), 1.0), (1.0, 3.0, 1.0, 1.5)],
)
def test_points_stand_outside_the_sole_only_as_far_as_its_shape_asks_for(
    pitch: float, roll: float, length: float, width: float
) -> None:
    """Springs at the corners hold K of pitch and roll as the squares of the sole's sides: 0.13·0.09 and 0.06·0.05."""
    stiffness: dict[Axis, float] = {"pitch": 40e3 * 0.13 * 0.09 * pitch, "roll": 40e3 * 0.06 * 0.05 * roll}
    found = points_for(stiffness, {"pitch": 15.0, "roll": 15.0}, sides_of(FOOT), 0.1, WEIGHT, 0.2)
    assert max(p.x for p in found.points) == pytest.approx(0.13 * length)
    assert max(p.y for p in found.points) == pytest.approx(0.06 * width)


@pytest.mark.parametrize("load", [0.1 * WEIGHT, 0.5 * WEIGHT, WEIGHT])
def test_a_load_is_carried_by_what_touches(foot: PointFoot, load: float) -> None:
    """Below the share that edges carry alone the middle point does not touch."""
    sink = foot.sink(load)
    carried = [p.stiffness * max(sink + p.lower, 0.0) for p in foot.points]
    assert sum(carried) == pytest.approx(load)
    assert pushes(foot, load) == pytest.approx(carried)
    assert (carried[-1] > 0) == (load > 0.2 * WEIGHT), "the middle one"


@pytest.mark.parametrize("axis", ["pitch", "roll"])
def test_up_to_the_touching_angle_every_edge_is_pressed(foot: PointFoot, axis: Axis) -> None:
    load = 0.5 * WEIGHT
    angle = foot.touching_angle(axis, load)
    for share, pressed in ((0.99, True), (1.01, False)):
        depths = [
            foot.sink(load) + p.lower - share * angle * abs(p.x if axis == "pitch" else p.y)
            for p in foot.points
            if p.lower > 0
        ]
        assert (min(depths) > 0) == pressed


@pytest.mark.parametrize("axis", ["pitch", "roll"])
def test_under_half_of_the_weight_the_foot_turns_as_the_bush(axis: Axis) -> None:
    """The push under each point turns with the sole: load times its depth below the bush centre comes off."""
    made = spring_foot(FOOT, WEIGHT)
    assert stiffness_under(made, axis, 0.5 * WEIGHT) == pytest.approx(STIFFNESS[axis], rel=1e-3)


def test_notes_say_the_errors_angles_and_millimetres_that_the_points_have() -> None:
    made = spring_foot(FOOT, WEIGHT)
    notes = {note.text.split(":")[0].split()[-1]: note.text for note in said(FOOT, made, WEIGHT)}
    for axis in ("pitch", "roll"):
        errors = [stiffness_under(made, axis, share * WEIGHT) / STIFFNESS[axis] - 1 for share in LOADS]
        worst = max(errors, key=abs)
        assert abs(worst) > 0.01
        assert f"off by {100 * worst:+.1f} % at most" in notes[axis]
        angle = made.touching_angle(axis, LOADS[0] * WEIGHT)
        assert f"up to {angle:.3f} rad ({STIFFNESS[axis] * angle:.0f} N·m)" in notes[axis]
    lower = max(p.lower for p in made.points)
    stiffness, damping = made.vertical
    assert f"{stiffness:.4g} N/m and {damping:.4g} N·s/m" in notes["z"]
    assert f"{1e3 * lower:.1f} mm lower" in notes["z"]
    edges = sum(p.stiffness for p in made.points if p.lower > 0)
    assert f"more than {edges * lower:.3g} N; below that {edges:.4g} N/m" in notes["z"]
    wrong = replace(FOOT, springs=(replace(SPRINGS[0], stiffness=3.5e5), *SPRINGS[1:]))
    assert (vertical_note(wrong, made).severity, vertical_note(FOOT, made).severity) == ("warning", "info")


def test_points_stand_below_the_bush_each_by_its_own_depth() -> None:
    """Sunk as the load asks for, each is pressed by what its tip is below the floor."""
    made = spring_foot(FOOT, WEIGHT)
    points = placed(replace(FOOT, centre=np.array([0.01, -0.02, 0.03])), made, WEIGHT)
    floor = 0.03 - made.depth + made.sink(LOADS[0] * WEIGHT)  # in the ankle's frame
    for one in points:
        pressed = max(floor - (one.centre[2] - RADIUS), 0.0)
        assert one.push == pytest.approx(one.point.stiffness * pressed)
        assert one.centre[:2] == pytest.approx([one.point.x + 0.01, one.point.y - 0.02])
    assert sum(one.push for one in points) == pytest.approx(LOADS[0] * WEIGHT)


def test_outer_points_rub_for_the_one_that_slides() -> None:
    """At eight tenths of the weight the foot slips at the force that it would with all points alike."""
    made = spring_foot(FOOT, WEIGHT)
    points = placed(FOOT, made, WEIGHT)
    share = share_of_friction(points)
    outer = sum(push for push, p in zip(pushes(made, 0.5 * WEIGHT), made.points, strict=True) if p.lower > 0)
    assert share == pytest.approx(0.8 * WEIGHT / outer)
    (note,) = sliding_note(FOOT, points)
    told = [
        float(number)
        for number in re.findall(r"at ([\d.]+) times|to ([\d.]+) times", note.text)
        for number in number
        if number
    ]
    assert told == pytest.approx([0.8 / 0.5, 0.8 / 1.1], rel=0.02)
    assert sliding_note(FOOT, [point for point in points if not point.middle]) == []


def test_what_a_foot_alone_shows_is_checked_over_loads_steps_and_angles(
    foot: PointFoot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """K is 4 % off, and C 10 %, where they are most; C 20 % at steps of 2 ms; far out K is 30 % off."""

    def stands(_: PointFoot, axis: Axis, load: float, step: float, share: float) -> float:
        return (0.7 if share > 0.6 else 0.96 if load < 1.1 * WEIGHT else 1.03) * STIFFNESS[axis]

    def shown(foot: PointFoot, axis: Axis, load: float, step: float) -> Measured:
        held = stands(foot, axis, load, step, MARKED)
        most = 0.1 if step < 0.002 else -0.2
        return Measured(held, (1 + most * min(1.0, load / WEIGHT)) * DAMPING[axis])

    monkeypatch.setattr(fit, "standing_stiffness", stands)
    monkeypatch.setattr(fit, "measured", shown)
    found = fit._check(foot, "pitch", STIFFNESS["pitch"], DAMPING["pitch"], WEIGHT)
    assert (found.stiffness_error, found.damping_error) == pytest.approx((0.04, 0.1))
    assert found.steps == (0.0005, 0.001)
    assert found.angle == pytest.approx(0.5 * foot.touching_angle("pitch", 0.5 * WEIGHT))
    assert found.torque == pytest.approx(STIFFNESS["pitch"] * found.angle)


@pytest.mark.parametrize(("stiffness", "severity"), [(434.0, "warning"), (700.0, "info"), (1200.0, "info")])
def test_what_the_grounds_push_takes_off_k_is_a_warning_beyond_a_twentieth(
    stiffness: float, severity: str
) -> None:
    """From half of the weight, where K is right, to 1.1 of it: 0.6 of 600 N, 90 mm below the bush, over K."""
    springs = (SPRINGS[0], replace(SPRINGS[1], stiffness=stiffness), replace(SPRINGS[2], stiffness=9000.0))
    bush = replace(FOOT, springs=springs)
    note = next(note for note in said(bush, spring_foot(bush, WEIGHT), WEIGHT) if "pitch: K" in note.text)
    off = float(re.search(r"off by ([-+][\d.]+) %", note.text)[1])  # type: ignore[index]
    assert off == pytest.approx(-100 * 0.6 * 600 * 0.09 / stiffness, abs=0.15)
    assert note.severity == severity


@pytest.mark.parametrize("mass", [0.2, 1.0, 8.0])
def test_a_point_pushes_with_its_own_spring_and_damper_by_mujocos_contact_law(mass: float) -> None:
    """MuJoCo: b = 2/(d·t), k = d/(d²t²ζ²); the contact pushes d(k·r + b·v)/((1 - d)Â) and adds d/((1 - d)Â) of mass."""
    point, inverse = Point(0.1, 0.05, 4e4, 300.0), 1 / mass
    told = contact_attributes(point, inverse)
    time, ratio = (float(number) for number in told["solref"].split())
    impedance = float(told["solimp"].split()[0])
    assert told["solimp"].split()[1] == told["solimp"].split()[0], "constant"
    per = (1 - impedance) * inverse
    assert impedance * 2 / (impedance * time) / per == pytest.approx(point.damping, rel=1e-6)
    stiffness = impedance * impedance / (impedance * time * ratio) ** 2
    assert stiffness / per == pytest.approx(point.stiffness, rel=1e-6)
    assert impedance / per == pytest.approx(INERTIA_TIME * point.damping, rel=1e-6)


def test_a_point_without_damper_is_a_bare_spring() -> None:
    """Its inertia gives a foot on it the natural frequency √2/time constant of a spring alone; negative: direct."""
    told = contact_attributes(Point(0.1, 0.05, 4e4, 0.0), 0.5)
    stiffness, damping = (float(number) for number in told["solref"].split())
    impedance = float(told["solimp"].split()[0])
    per = (1 - impedance) * 0.5
    assert -stiffness / per == pytest.approx(4e4, rel=1e-6)
    assert damping < 0 < 1e-6 + damping
    assert impedance / per == pytest.approx(0.5 * INERTIA_TIME**2 * 4e4, rel=1e-6)
