"""The reports of inertia and joints: every number of the result, escaped, on one page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from plantar.errors import PlantarError
from plantar.report import write_dynamics_report

SHARED: dict[str, Any] = {
    "robot": "icub <script>",
    "plantar": "0.1.0",
    "created": "2026-01-01T00:00:00Z",
    "inputs": [{"path": "/logs/walk.csv", "sha256": "cd" * 32, "role": "fit"}],
    "settings": {"rows": "base"},
    "notes": [{"code": "inertia.unexcited", "severity": "warning", "text": "<img src=x> the head is still"}],
}
INERTIA: dict[str, Any] = SHARED | {
    "schema": "plantar.inertia/1",
    "rank": 234,
    "condition_number": 4.1e5,
    "base_parameters": [
        {"expression": "m(torso) + 0.3·mx(head)", "value": 12.34, "std": 0.02,
         "interval95": [12.30, 12.38], "relative_std_percent": 0.16},
        {"expression": "Izz(l_foot)", "value": None, "std": None, "interval95": [None, None],
         "relative_std_percent": None},
    ],
    "inertial_parameters": [
        {"link": f"link_{i}", "name": "m", "unit": "kg", "value": 1.5 + i, "cad": 1.4 + i} for i in range(50)
    ],
    "validation": [
        {"kind": "cross", "motion": "walk", "axis": "torque.x", "unit": "N.m", "max_abs": 40.0, "samples": 500,
         "mean_abs_error": 1.5, "rms_error": 2.2,
         "zero_mean_abs": 12.0, "cad_rms_error": 20.5},
        {"kind": "cross", "motion": "walk", "axis": "force.z", "unit": "N", "max_abs": 700.0, "samples": 500,
         "mean_abs_error": 9.0, "rms_error": 7.9,
         "zero_mean_abs": 5.0, "cad_rms_error": 13.3},
    ],
}  # fmt: skip
JOINTS: dict[str, Any] = INERTIA | {
    "schema": "plantar.joints/1",
    "parameters": [
        {"joint": "a1", "name": "viscous", "unit": "N.m.s/rad", "value": 3.2, "std": 0.1,
         "interval95": [3.0, 3.4], "verdict": "usable", "reason": ""},
        {"joint": "a2", "name": "coulomb", "unit": "N.m", "value": 0.2, "std": 0.4,
         "interval95": [-0.6, 1.0], "verdict": "weak", "reason": "the joint hardly turns"},
    ],
    "validation": [
        {"kind": "cross", "motion": "second", "joint": "all", "unit": "N.m", "mean_abs_error": 0.4, "rms_error": 0.5,
         "max_abs": 30.0, "zero_mean_abs": 6.0, "cad_rms_error": 2.5, "samples": 500, "relative_error_percent": 2.31}
    ],
}  # fmt: skip


def written(tmp_path: Path, content: dict[str, Any]) -> str:
    (tmp_path / "result.json").write_text(json.dumps(content), encoding="utf-8")
    path = write_dynamics_report(tmp_path)
    assert path == tmp_path / "report.html"
    text = path.read_text(encoding="utf-8")
    assert "<script" not in text
    assert "<img" not in text
    assert "icub &lt;script&gt;" in text
    assert "http://" not in text
    assert "https://" not in text
    return text


def test_inertia_says_rank_condition_and_cad(tmp_path: Path) -> None:
    text = written(tmp_path, INERTIA)
    assert "The logs determine 234 base parameters, with a condition number of 4.1e5." in text
    assert "12.34 ± 0.04" in text
    assert "m(torso) + 0.3·mx(head)" in text
    assert text.count(">link_") == 50
    assert "rms error by the URDF" in text
    assert "20.5" in text
    assert "better than the mean alone in 1 of 2 rows" in text
    assert text.count(">none<") == 1


def test_joints_say_what_to_trust(tmp_path: Path) -> None:
    text = written(tmp_path, JOINTS)
    assert "Trust: a1 viscous." in text
    assert "Use with care: a2 coulomb." in text
    assert "the joint hardly turns" in text
    assert "relative error [%]" in text
    assert "2.31" in text


@pytest.mark.parametrize(
    "change", [{"schema": "plantar.feet/1"}, {"schema": 3}, {"parameters": [{"joint": "a"}]}]
)
def test_a_wrong_result_is_one_line(tmp_path: Path, change: dict[str, Any]) -> None:
    (tmp_path / "result.json").write_text(json.dumps(JOINTS | change), encoding="utf-8")
    with pytest.raises(PlantarError) as error:
        write_dynamics_report(tmp_path)
    assert "\n" not in str(error.value)
    assert not (tmp_path / "report.html").exists()
