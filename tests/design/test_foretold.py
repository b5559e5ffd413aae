"""What a motion will not show is said before it is played."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

import design_samples
from plantar.design.known import Known
from plantar.design.rehearsals.rehearsal import Rehearsal
from plantar.design.writing.foretold import foretold

UNPLAYED = design_samples.unplayed()


def rows(width: float, error: float, usable: bool) -> list[dict[str, Any]]:
    """Stiffness of one foot in roll, in a rehearsal at each of two factors: the stiff one is as told."""
    fine = {
        "factor": 0.5,
        "half_width_percent": 2.0,
        "error_percent": 0.3,
        "error95_percent": 0.4,
        "usable": True,
    }
    told = fine | {"factor": 2.0, "half_width_percent": width, "error_percent": error, "usable": usable}
    return [{"foot": "left", "axis": "roll", "name": "stiffness", "at": [fine, told]}]


def bent(roll: float) -> Any:
    """A motion with rehearsals at 0.5 and 2 that bend the left foot by so much to either side [rad]."""
    sway = np.column_stack([0.03 * np.ones(2), [-roll, roll]])
    rehearsals = (Rehearsal(0.5, bushes={"left": sway}), Rehearsal(2.0, bushes={"left": sway}))
    return replace(UNPLAYED, rehearsals=rehearsals)


def test_an_axis_that_is_bent_too_little_is_said_with_what_it_would_need() -> None:
    """Rubber that slips at 10 mrad is told from its spring beyond 10/0.8; told 500, held up to 1000 N·m/rad."""
    (note,) = foretold(bent(0.010), rows(40.0, 21.0, usable=False))
    assert note.startswith("left roll will be weak at 2 times the stiffness told: stiffness ± 40 %.")
    assert "bends it by 10 mrad to either side" in note
    assert "beyond 12.5" in note
    assert "no stiffer than 800 N·m/rad" in note
    assert "--after" in note


def test_a_second_motion_says_what_no_third_one_would_show_and_what_the_first_one_did() -> None:
    unsure, sure = np.full(2, np.inf), np.array([1.0, 0.1])
    second = replace(bent(0.010), known=Known(700.0, 28.0, 600.0, 800.0, {("left", "roll"): unsure}, None))
    (note,) = foretold(second, rows(40.0, 21.0, usable=False))
    assert "no stiffer than 800 N·m/rad: this robot's soles do not hold what it takes" in note
    assert "--after" not in note
    second = replace(second, known=Known(700.0, 28.0, 600.0, 800.0, {("left", "roll"): sure}, None))
    assert foretold(second, rows(40.0, 21.0, usable=False)) == [
        "left roll is known, and weak from this motion alone: identify both logs together"
    ]


def test_an_axis_that_is_weak_for_another_reason_gets_no_advice_to_bend_it() -> None:
    assert foretold(bent(0.013), rows(40.0, 21.0, usable=False)) == [
        "left roll will be weak at 2 times the stiffness told: stiffness ± 40 %"
    ]


def test_a_wrong_number_that_is_called_usable_is_said() -> None:
    (note,) = foretold(bent(0.010), rows(2.0, -3.5, usable=True))
    assert note.startswith("left roll stiffness came out wrong at 2 times the stiffness told, by up to 4 %")
    assert "do not use it" in note
    assert foretold(bent(0.010), rows(2.0, -2.9, usable=True)) == []


def test_a_foot_that_is_not_identified_is_weak() -> None:
    one = {
        "factor": 1.0,
        "half_width_percent": None,
        "error_percent": None,
        "error95_percent": None,
        "usable": False,
    }
    row = {"foot": "left", "axis": "pitch", "name": "damping", "at": [one]}
    assert foretold(UNPLAYED, [row]) == [
        "left pitch will be weak at 1 times the stiffness told: damping not identified"
    ]


def test_a_number_that_one_play_leaves_too_unsure_is_said_once_with_the_plays_it_takes() -> None:
    """Noise goes with the root of what is played: 1.1 % off where 0.5 are wanted takes 2.2² of it. What is weak in one
    foot is said elsewhere."""

    def of_both(*errors95: float, name: str = "stiffness", weak: bool = False) -> list[dict[str, Any]]:
        found = []
        for foot in ("left", "right"):
            (row,) = rows(2.0, 0.3, usable=True)
            at = [one | {"error95_percent": own} for one, own in zip(row["at"], errors95, strict=True)]
            at[1]["usable"] = not (weak and foot == "left")
            found.append(row | {"foot": foot, "name": name, "at": at})
        return found

    (note,) = foretold(UNPLAYED, of_both(0.6, 1.1))
    assert note.startswith("roll stiffness will be up to 1.1 % off, where 0.5 % are wanted")
    assert note.endswith(
        "5 plays of this motion that are identified together leave so little, or one with --duration 300"
    )
    (far,) = foretold(UNPLAYED, of_both(2.0, 0.3))
    assert far.endswith("16 plays of this motion that are identified together leave so little")
    assert foretold(UNPLAYED, of_both(0.5, 0.5)) == []
    assert foretold(UNPLAYED, of_both(0.5, 3.9, name="damping")) == []
    (weak,) = foretold(bent(0.013), of_both(0.5, 30.0, weak=True))
    assert weak.startswith("left roll will be weak at 2 times")
