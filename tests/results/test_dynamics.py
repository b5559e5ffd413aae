"""A result of eq. 2 or 3 as an object: its text and table, and that it comes back from its file unchanged."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pyarrow as pa
import pytest

from plantar.errors import PlantarError
from plantar.notes import Note
from plantar.results.dynamics import INERTIA_SCHEMA, JOINTS_SCHEMA, DynamicsResult
from plantar.results.dynamics_rows import BaseParameter, DynamicsScore, InertialParameter, JointParameter
from plantar.results.dynamics_text import joint_cells, link_cells, score_cells
from plantar.results.feet_rows import Input

LINK = [
    InertialParameter("arm", name, unit, value, cad)
    for name, unit, value, cad in (("m", "kg", 2.5, 2.0), ("mx", "kg.m", 0.1, 0.0), ("my", "kg.m", 0.0, 0.0),
                                   ("mz", "kg.m", -0.25, -0.3))
]  # fmt: skip
JOINT = JointParameter(
    "knee", "viscous", "N.m.s/rad", 3.0, 0.1, (2.8, 3.2), "usable", "the interval is narrow"
)
BASE = BaseParameter("m_arm", 2.5, 0.1, (-math.inf, math.inf), None)
SCORES = [
    DynamicsScore("cross", name, "N.m", 0.1, rms, 5.0, 2.0, 6.0, samples, 3.0, joint="knee")
    for name, rms, samples in (("a", 3.0, 100), ("b", 4.0, 100))
]


def made(schema: str) -> DynamicsResult:
    joints = (JOINT,) if schema == JOINTS_SCHEMA else ()
    return DynamicsResult(
        schema, "robot", (Input("a.csv", None, "fit"),), {"cutoff": 3.0}, 4, math.inf, (BASE,), tuple(LINK), joints,
        tuple(SCORES), (Note("regularisation", "warning", "pulled hard"),), "<robot/>", pa.table({"time": [0.0, 0.1]}),
    )  # fmt: skip


@pytest.mark.parametrize("schema", [INERTIA_SCHEMA, JOINTS_SCHEMA])
def test_a_result_comes_back_from_its_file_to_the_byte(schema: str, tmp_path: Path) -> None:
    one = made(schema)
    path = one.save(str(tmp_path / "one"))
    again = DynamicsResult.load(tmp_path / "one")
    assert again.save(tmp_path / "two").read_bytes() == path.read_bytes()
    assert again.parameters == one.parameters
    assert again.base_parameters == one.base_parameters
    assert (again.urdf, again.residuals.num_rows) == ("<robot/>", 2)


def test_other_results_and_broken_rows_are_one_line(tmp_path: Path) -> None:
    content = made(INERTIA_SCHEMA).to_dict()
    for change, expected in (
        (
            {"schema": "plantar.feet/1"},
            r"result\.json, value 'plantar\.feet/1': is another kind of result \(valid: "
            r"plantar\.inertia/1, plantar\.joints/1\)$",
        ),
        (
            {"rank": "many"},
            r"result\.json, column 'rank': Input should be a valid integer, unable to parse string as "
            r"an integer$",
        ),
        (
            {"base_parameters": [{"expression": "m"}]},
            r"result\.json, column 'base_parameters\.0\.value': Field required$",
        ),
    ):
        (tmp_path / "result.json").write_text(json.dumps(content | change))
        with pytest.raises(PlantarError, match=expected) as caught:
            DynamicsResult.load(tmp_path)
        assert "\n" not in str(caught.value)
    (tmp_path / "result.json").write_text(json.dumps(content))
    with pytest.raises(PlantarError, match=r"identified\.urdf: cannot be read: No such file or directory$"):
        DynamicsResult.load(tmp_path)


def test_cells_by_hand() -> None:
    assert link_cells(LINK) == [("arm", "2.500", "2.000", "0.100 0 −0.250", "0 0 −0.300")]
    assert joint_cells([JOINT]) == [("knee", "viscous", "3.00 ± 0.20", "N·m·s/rad", "6.7 %", "usable")]
    rms = math.sqrt((9 + 16) / 2)
    assert score_cells(SCORES) == [("2 unseen", "knee", "N·m", f"{rms:.2f}", "6.00")]


def test_text_page_and_table() -> None:
    joints, inertia = made(JOINTS_SCHEMA), made(INERTIA_SCHEMA)
    assert str(joints).splitlines()[2] == "  knee   viscous    3.00 ± 0.20  N·m·s/rad  6.7 %  usable"
    assert "  warning: pulled hard" in str(joints).splitlines()
    assert str(inertia).startswith("Inertias of robot: 2.5 kg, rank 4")
    assert "<td" in inertia._repr_html_()
    assert repr(inertia) == "<DynamicsResult of robot: plantar.inertia/1, 2.5 kg, rank 4>"
    assert inertia.to_table().to_pylist()[0]["cad"] == 2.0
    row = joints.to_table().to_pylist()[0]
    assert (row["joint"], row["low"], row["high"], row["verdict"]) == ("knee", 2.8, 3.2, "usable")


def test_a_score_of_nothing_is_written_and_one_that_is_not_known_left_out() -> None:
    perfect = DynamicsScore(
        "direct", "a", "N", 0.0, 0.0, 5.0, 6.0, 0.0, 100, percent_of_max=0.0, axis="force.x"
    )
    written = perfect.to_dict()
    assert [written[name] for name in ("mean_abs_error", "percent_of_max", "cad_rms_error")] == [
        0.0,
        0.0,
        0.0,
    ]
    assert not {"joint", "relative_error_percent"} & set(written)
