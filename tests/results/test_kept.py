"""What is made of result files in which one thing is wrong, as it is kept: each refusal, or what is read otherwise."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from damaged import damaged, told
from kept_texts import assert_as_kept, lines_of
from plantar.contact.phases import Phase
from plantar.notes import Note
from plantar.results.dynamics import INERTIA_SCHEMA, JOINTS_SCHEMA, DynamicsResult
from plantar.results.dynamics_rows import BaseParameter, DynamicsScore, InertialParameter, JointParameter
from plantar.results.feet import FeetResult, Input
from plantar.results.feet_rows import (
    Assumption,
    AxisModel,
    Candidate,
    DelayEstimate,
    Diagnosis,
    LinearEquivalent,
    Offset,
    Parameter,
    ValidationRow,
)
from plantar.results.walk_rows import StanceStiffness, SwingZero, WalkStiffness

KEPT = Path(__file__).parent / "kept"
FEET = FeetResult(
    "biped", (Input("a.csv", "ab12", "fit"),), {"offset": "per-motion", "cutoff": 5.0}, "kelvin_voigt",
    (Parameter("left", "pitch", "stiffness", "N.m/rad", 434.0, 1.5, (431.0, 437.0), 0.2, "usable", "narrow", "sway"),),
    (Offset("left", "pitch", "a", "N.m", -0.4, 0.02),),
    (Phase("a", "left", 1.2, 9.8, "double", False, "slips"),),
    (ValidationRow("direct", "a", "left", "pitch", 0.2, 0.3, 16.0, 1.4, 5.1, 900),),
    (Note("z_unknown", "info", "no log shows z"),),
    robot_model={"urdf": "biped.urdf", "feet": {"left": {"ankle": "left_foot"}}},
    models=(
        AxisModel("left", "pitch", "hardening", "why", LinearEquivalent(430.0, 20.0), ranking=(
            Candidate("hardening", 0.2, 3, None, True),
        )),
    ),
    stances=(StanceStiffness("a", "fit", "left", "roll", 1.0, 2.0, 340.0, 0.5),),
    walks=(WalkStiffness("a", "fit", "left", "roll", 5, 341.0, (330.0, 352.0)),),
    swing_zeros=(SwingZero("a", "left", 3.0, *((0.1, 0.2, 0.3),) * 4),),
    sensor_delay=DelayEstimate(0.004, 3e-4, True, feet={"left": 0.001}),
    compliance={"left": 2e-5}, joint_compliance={"knee": 1e-5},
    diagnosis=(Diagnosis("left", "pitch", "stiffness", "noise", {"noise": 1.0}, 0.5, "noise limits it", "sway"),),
    assumptions=(Assumption("wrench_gain", "force", 0.01, 0.02, 0.001, 2.0, 2.5),),
    campaign={"preset": "ideal"}, version="0.1.0", created="2026-01-02T03:04:05Z",
)  # fmt: skip
LINK = InertialParameter("arm", "m", "kg", 2.5, 2.0)
JOINT = JointParameter("knee", "viscous", "N.m.s/rad", 3.0, 0.1, (2.8, 3.2), "usable", "narrow")
BASE = BaseParameter("m_arm", 2.5, 0.1, (2.3, 2.7), 4.0)
SCORE = DynamicsScore("cross", "a", "N.m", 0.1, 0.2, 5.0, 2.0, 6.0, 100, 3.0, joint="knee")


def dynamics(schema: str) -> DynamicsResult:
    return DynamicsResult(
        schema, "robot", (Input("a.csv", None, "fit"),), {"cutoff": 3.0}, 4, 12.5, (BASE,), (LINK,),
        (JOINT,) if schema == JOINTS_SCHEMA else (), (SCORE,), (Note("regularisation", "warning", "hard"),),
        "<robot/>", None,
    )  # fmt: skip


RESULTS: dict[str, tuple[dict[str, Any], Callable[[Path], Any]]] = {
    "feet": (FEET.to_dict(), FeetResult.load),
    "inertia": (dynamics(INERTIA_SCHEMA).to_dict(), DynamicsResult.load),
    "joints": (dynamics(JOINTS_SCHEMA).to_dict(), DynamicsResult.load),
}


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_file_with_one_thing_wrong_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    content, load = RESULTS[name]
    file = tmp_path / "result.json"
    (tmp_path / "identified.urdf").write_text("<robot/>")

    def differs(other: Mapping[str, Any]) -> str:
        file.write_text(json.dumps(other))
        found, given = (
            lines_of(each, "plantar", "created").splitlines() for each in (load(file).to_dict(), other)
        )
        return ", ".join(line for line in found if line not in given) or "as it says"

    lines = [f"{where}: {told(differs, other)}\n" for where, other in damaged(content)]
    text = lines_of(content, "plantar", "created") + "".join(lines).replace(str(tmp_path), "FOLDER")
    assert_as_kept(re.sub(r"Input should be .*|Field required", "", text), KEPT / f"{name}.txt")
