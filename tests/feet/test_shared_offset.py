"""An offset for each recording, or one for all: then all that is fitted to them has one, and no drift of each."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from biped import TRUTH
from biped_robot import FEET
from feet_trials import AXES, EXACT, LINEAR, biased, rotational
from plantar.estimation import linear
from plantar.estimation.blocks import Block
from plantar.feet.assess import play
from plantar.feet.identify import identify_feet
from plantar.robot.model import RobotModel

Fits = list[tuple[str, bool, bool]]  # by whom, with one offset, with what drifts in each recording


@pytest.fixture
def fits(monkeypatch: pytest.MonkeyPatch) -> Fits:
    """All linear fits of several recordings, from when they are asked for."""
    seen: Fits = []

    def told(name: str) -> Any:
        real = getattr(linear, name)

        def spy(blocks: Sequence[Block], *flag: bool, **flags: bool) -> Any:
            caller = sys._getframe(1)
            while caller.f_globals["__name__"] == linear.__name__:
                assert caller.f_back is not None
                caller = caller.f_back
            shared = any([*flag, *flags.values()])
            drifts = any(block.nuisance is not None for block in blocks)
            seen.append((caller.f_globals["__name__"].removeprefix("plantar."), shared, drifts))
            return real(blocks, *flag, **flags)

        return spy

    monkeypatch.setattr(play, "factor_of", told("factor_of"))
    for name in ("fit_linear", "influences", "factor_of"):
        monkeypatch.setattr(linear, name, told(name))
    return seen


def test_each_motion_has_its_own_offset_unless_shared(robot: RobotModel, fits: Fits) -> None:
    recordings = [biased("low", 1, -2.0), biased("high", 2, 3.0)]
    own, low = (identify_feet(robot, each, settings=LINEAR) for each in (recordings, recordings[:1]))
    np.testing.assert_allclose(rotational(own), rotational(low), rtol=EXACT)
    values = {(row.foot, row.axis, row.motion): row.value for row in own.offsets}
    for (foot, axis), law in TRUTH.items():
        assert values[foot, axis, "low"] == pytest.approx(law.offset - 2.0, abs=1e-3)
        assert values[foot, axis, "high"] == pytest.approx(law.offset + 3.0, abs=1e-3)
    fits.clear()
    shared = identify_feet(robot, recordings, settings=replace(LINEAR, offset="shared"))
    assert {caller for caller, one, _ in fits if not one} == {"feet.fit.vertical_stiffness"}
    assert {caller for caller, _, drifts in fits if drifts} == {"feet.interval_width.systematic"}, (
        "a suspicion"
    )
    assert len({caller for caller, *_ in fits}) > 5
    assert np.abs(rotational(shared) / rotational(own) - 1).max() > 0.003, "one offset for two biases costs"
    for foot in FEET:
        for axis in AXES:
            assert len({row.value for row in shared.offsets if (row.foot, row.axis) == (foot, axis)}) == 1
    errors = [
        sum(row.mean_abs_error for row in found.validation if row.kind == "direct") for found in (own, shared)
    ]
    assert errors[1] > errors[0] + 1.0
