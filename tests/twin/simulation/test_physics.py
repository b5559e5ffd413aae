"""Worlds that differ in their rubber alone."""

from __future__ import annotations

from dataclasses import replace

import pytest

from plantar.twin import PAPER
from plantar.twin.simulation.physics import Physics


def test_stiffer_rubber_is_stiffer_and_damped_more_about_both_axes() -> None:
    world = Physics(friction=0.5)
    found = world.stiffened(0.1)
    assert found.bushes is not None
    for foot, bush in PAPER.items():
        stiff = found.bushes[foot]
        for name in ("pitch_stiffness", "pitch_damping", "roll_stiffness", "roll_damping"):
            assert getattr(stiff, name) == pytest.approx(1.1 * getattr(bush, name))
        same = {
            name: getattr(bush, name)
            for name in ("pitch_stiffness", "pitch_damping", "roll_stiffness", "roll_damping")
        }
        assert replace(stiff, **same) == bush
    assert replace(found, bushes=world.bushes) == world
    assert Physics(bushes=None).stiffened(0.1) == Physics(bushes=None)
