"""Motions of the campaign as they are kept: every joint's way, the base's, where the soles stand, and the hand's."""

from __future__ import annotations

from pathlib import Path

import pytest

from kept_texts import assert_as_kept, described
from plantar.motions import planned_balance
from plantar.twin.robots import hrp2
from twin_samples import plan

KEPT = Path(__file__).parent / "kept"


@pytest.mark.parametrize(
    "motion",
    ["Tilt4", "Manual_right_roll", "Manual_left_pitch", "Manual_both_pitch", "Myrand4", "Myrand5", "Squat"],
)
def test_a_motion_is_as_it_is_kept(motion: str) -> None:
    found = plan(motion)
    ways = {name: found.positions[:, place] for place, name in enumerate(found.joints)}
    told = {"plan": found, "ways": ways, "balance": planned_balance(hrp2.robot(), found)}
    assert_as_kept(described(told), KEPT / f"{motion}.txt", share=1e-4, least=1e-5)
