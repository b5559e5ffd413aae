"""Joints that bend beyond their encoders make a bush look softer, and a robot file that says so widens by as much."""

from __future__ import annotations

from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest

from before_gears import before_gears
from biped import TRUTH, record, sway
from biped_robot import FEET, make_robot
from plantar.feet.identify import identify_feet
from plantar.feet.interval_width.joint_compliance import NAME, joint_compliance_causes
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.sensors.moments.bent_joints import JointBending

COMPLIANCE = 1e-4  # rad/(N.m)
KNOWN = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
JOINTS = [f"{foot}_{ankle}" for foot in FEET for ankle in ("ankle_pitch", "ankle_roll")]


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> tuple[FeetResult, FeetResult]:
    """From the same logs of ankles that bend, by robot files that know nothing of it, and that do."""
    folder: Path = tmp_path_factory.mktemp("robot")
    logs: list[MotionLog] = []
    found = []
    for name, compliance in (("stiff", 0.0), ("bending", COMPLIANCE)):
        robot = make_robot(folder / name, uncertainty={"joint_compliance": compliance, "wrench_gain": 0.0})
        logs = logs or [
            before_gears(robot, record(sway(f"sway_{seed}", seed=seed, duration=20.0)), COMPLIANCE, JOINTS)
            for seed in (1, 2)
        ]
        found.append(identify_feet(robot, logs, settings=KNOWN))
    return found[0], found[1]


@pytest.mark.parametrize("term", ["stiffness", "damping"])
def test_what_bends_counts_as_the_bush_and_is_told_by_as_much_as_it_moves(
    results: tuple[FeetResult, FeetResult], term: str
) -> None:
    plain, told = results
    for (foot, axis), law in TRUTH.items():
        before, after = (each.parameter(foot, axis, term) for each in (plain, told))
        truth = law.stiffness if term == "stiffness" else law.damping
        assert before.value is not None
        assert before.std is not None
        assert after.std is not None
        softer = truth - before.value
        assert softer > 0.8 * COMPLIANCE * law.stiffness * truth * (1 if term == "stiffness" else 2)
        assert np.sqrt(after.std**2 - before.std**2) == pytest.approx(softer, rel=0.25)
        assert after.interval95 is not None
        assert after.interval95[0] < truth < after.interval95[1]


def test_it_stands_among_the_causes_with_its_share(results: tuple[FeetResult, FeetResult]) -> None:
    shares = [[row.variance_shares.get(NAME, 0.0) for row in each.diagnosis] for each in results]
    assert max(shares[0]) == 0.0
    assert min(shares[1]) > 0.5
    assert any("joint_compliance" in row.text for row in results[1].diagnosis)


@pytest.mark.parametrize("joints", [0, 3], ids=["a foot alone", "joints that do not bend"])
def test_nothing_bends(joints: int) -> None:
    stiff = JointBending(np.zeros(joints), np.zeros((joints, joints)))
    assert joint_compliance_causes(Mock(), Mock(), stiff) == []
