"""What a replay says of the vertical stiffness, and of motions that were too small."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.online.estimates import FIELDS, Flag
from plantar.online.replay import Replay
from plantar.results.feet_rows import Parameter


def ended(**values: float) -> Replay:
    row = np.array([values.get(name.replace(".", "_"), 0.0) for name in FIELDS])
    return Replay(np.zeros(1), ("left",), row[None, None], np.zeros(1))


def z_row(value: float, half: float) -> Parameter:
    replay = ended(compliance=value, compliance_std=half / 2, compliance_half_width=half)
    return next(row for row in replay.parameters if row.axis == "z")


def test_the_vertical_stiffness_is_one_over_the_compliance() -> None:
    row = z_row(4e-6, 1e-6)
    assert row.value == pytest.approx(250e3)
    assert row.interval95 == pytest.approx((200e3, 1 / 3e-6))
    assert row.std == pytest.approx(250e3 * 0.5e-6 / 4e-6), "the same share of the value"
    assert (row.unit, row.verdict) == ("N/m", "weak")
    assert z_row(4e-6, 2e-7).verdict == "usable"


def test_a_compliance_that_nothing_has_shown_is_no_stiffness() -> None:
    for value in (3e-6, 0.0, -1e-6):
        row = z_row(value, 5e-6)
        assert (row.value, row.verdict) == (None, "unidentifiable")
        assert "walk" in row.advice


def test_a_compliance_that_was_told_is_not_called_learnt() -> None:
    row = z_row(4e-6, 4e-12)
    assert row.value == pytest.approx(250e3)
    assert row.interval95 is None
    assert "batch result" in row.reason


@pytest.mark.parametrize(
    ("flag", "word"), [(Flag.PITCH_UNTESTED, "too small"), (Flag.PITCH_MEMORY, "memory")]
)
def test_numbers_that_other_motions_change_are_weak(flag: Flag, word: str) -> None:
    replay = ended(flags=float(flag), pitch_stiffness=400.0, pitch_stiffness_half_width=1.0)
    row = next(row for row in replay.parameters if (row.axis, row.name) == ("pitch", "stiffness"))
    assert row.verdict == "weak"
    assert word in row.reason
