"""The spring and damper of an axis whose rubber slips: at a swing that is asked for, at the usual one, or the "
"nearest."""

from __future__ import annotations

import math
from typing import Any

import pytest

from plantar.exporters.spring import SLIP_TERMS, SWAY, Slip, spring_of
from plantar.notes import Notes

SLIP = Slip(*({"slip_torque": 5.0, "slip_angle": 0.02}[name] for name in SLIP_TERMS))


def rows(**values: Any) -> list[dict[str, Any]]:
    usual = {"stiffness": 400.0, "damping": 20.0, "slip_torque": 5.0, "slip_angle": 0.02}
    return [
        {
            "foot": foot,
            "axis": "pitch",
            "name": name,
            "value": value if foot == "left" else 9 * value,
            "verdict": "usable",
        }
        for foot in ("right", "left")
        for name, value in (usual | values).items()
    ]


def law(stiffness: float | None = 500.0, damping: float = 30.0) -> dict[str, Any]:
    nearest = {"stiffness": stiffness, "damping": damping}
    other = {"foot": "left", "axis": "roll", "linear_equivalent": {"stiffness": 1.0, "damping": 1.0}}
    return {"laws": [other, {"foot": "left", "axis": "pitch", "linear_equivalent": nearest}]}


def scores(*torques: float) -> dict[str, Any]:
    """Of the fitted motions; others do not count."""
    keys = {"kind": "direct", "foot": "left", "axis": "pitch"}
    others = [
        {**keys, "kind": "cross", "zero_mean_abs": 99.0},
        {**keys, "axis": "roll", "zero_mean_abs": 99.0},
    ]
    return {"validation": [*others, *({**keys, "zero_mean_abs": torque} for torque in torques)]}


def spring(result: dict[str, Any], **more: Any) -> tuple[Any, list[str]]:
    notes = Notes()
    with_offset = more.pop("with_offset", False)
    found = spring_of(result, rows(), "left", "pitch", with_offset, notes, **more)
    return found, [f"{note.severity} {note.code}: {note.text}" for note in notes]


def test_a_target_that_holds_the_slip_keeps_it() -> None:
    found, said = spring({}, hysteresis=True)
    assert (found.stiffness, found.damping, found.slip, said) == (400.0, 20.0, SLIP, [])


@pytest.mark.parametrize("usual", [False, True])
def test_at_a_swing_the_slip_adds_to_spring_and_damper(usual: bool) -> None:
    """The usual one bends the nearest spring by pi/2 times the middle of the torques that the offset alone "
    "misses by."""
    swing = math.pi / 2 * 4.0 / 500.0 if usual else 0.03
    found, said = spring(law() | scores(1.0, 4.0, 11.0), **({} if usual else {"swing": swing}))
    assert found.stiffness == pytest.approx(400.0 + SLIP.stiffness_at(swing))
    assert found.damping == pytest.approx(20.0 + SLIP.damping_at(swing))
    assert found.slip is None
    end = ", the middle of the identified motions; for others give --swing" if usual else ""
    assert said == [
        f"warning export_swing: left pitch: the slip is written as the spring and damper of swings of {swing:.3g} "
        f"rad at "
        f"{SWAY:g} rad/s{end}"
    ]


def test_without_scores_the_nearest_spring_and_damper_stand_in() -> None:
    left_out = "warning export_terms: left pitch: the target holds a linear spring and damper; left out: "
    left_out += "slip_torque, slip_angle"
    found, said = spring(law())
    assert (found.stiffness, found.damping, found.assumed) == (500.0, 30.0, False)
    assert said == [
        f"{left_out}; K and C are those of the spring and damper nearest to the identified motions"
    ]
    for result in (law(None), law(-5.0), law(500.0, 0.0), law(500.0, -3.0), {}):
        found, said = spring(result | scores(4.0))
        assert (found.stiffness, found.damping) == (400.0, 20.0)
        assert said == [left_out]


def test_offsets_are_averaged_over_motions_and_told() -> None:
    offsets = [{"foot": foot, "axis": axis, "value": value} for foot, axis, value in (
        ("left", "pitch", 2.0), ("left", "pitch", -5.0), ("left", "roll", 99.0), ("right", "pitch", 99.0)
    )]  # fmt: skip
    found, said = spring({"offsets": offsets}, hysteresis=True, with_offset=True)
    assert (found.offset, found.rest) == (-1.5, pytest.approx(1.5 / 400))
    assert said == ["info export_offset: left pitch: offset -1.5, the mean of 2 motions from -5 to 2"]
    assert spring({"offsets": offsets}, hysteresis=True)[0].offset == 0.0
    assert spring({}, hysteresis=True, with_offset=True)[0].offset == 0.0
    one, said = spring({"offsets": offsets[1:]}, hysteresis=True, with_offset=True)
    assert (one.offset, said) == (-5.0, [])
