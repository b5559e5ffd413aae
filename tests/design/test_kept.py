"""Parts of a design as they are kept: legs, the robot about its stance, and the limits of a motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import design_samples
from kept_texts import assert_as_kept, described
from plantar.design.reach import Reach

KEPT = Path(__file__).parent / "kept"


def of_reach(reach: Reach) -> dict[str, object]:
    """All numbers of it, and what they say of a motion."""
    motion = 0.02 * np.random.default_rng(2).standard_normal(reach.lines.size)
    numbers = {
        name: value
        for name, value in vars(reach).items()
        if isinstance(value, np.ndarray | list | float | int)
    }
    return numbers | {
        "alone": reach.alone(), "used": reach.used(motion), "by kind": reach.used_by_kind(motion),
        "over none": reach.used_over_none(motion), "near": reach.near(motion), "close": vars(reach.close(motion, 0.1)),
        "held": vars(reach.held(0.5 + 0 * reach.used_by_kind(motion), 0.9)), "torque": reach.of(reach.rate, motion),
    }  # fmt: skip


def without_objects(text: str) -> str:
    return "".join(f"{line}\n" for line in text.splitlines() if "object at" not in line)


def test_legs_and_limits_are_as_they_are_kept() -> None:
    legs, lines = design_samples.legs(), design_samples.reach().lines
    motion = 0.02 * np.random.default_rng(2).standard_normal(lines.size)
    displacements = lines.displacements(motion, lines.time(5.0))
    told = {
        "soft": design_samples.told(), "linear": design_samples.linear(), "lines": lines,
        "columns": legs.columns, "directions": legs.directions, "ahead": legs.ahead, "rest": legs.rest[:2],
        "followed": legs.follow(displacements), "displacements": displacements,
        "reach": of_reach(design_samples.reach()),
    }  # fmt: skip
    assert_as_kept(without_objects(described(told)), KEPT / "parts.txt", share=1e-4, least=1e-6)
