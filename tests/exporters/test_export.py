"""Exports as text: what every target holds and says, numbers and signs, and the command line.

Reference for USD, which not every machine can load: openusd.org UsdPhysicsDriveAPI (degrees).
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from export_robots import CENTRE, bush_rotation
from plantar.cli import main
from plantar.exporters import TARGETS, export
from plantar.exporters.bush import feet_of_result
from usd_stage import write_usd


def stage_for(target: str, folder: Path) -> Path | None:
    """The model that a target cannot do without."""
    if target != "physx-contact":
        return None
    pytest.importorskip("pxr")
    return write_usd(folder / "stage.usda")


@pytest.mark.parametrize("target", TARGETS)
def test_every_target_writes_a_file_and_says_what_it_left_out(
    target: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    if target in ("mjcf", "mujoco-contact"):
        pytest.importorskip("mujoco")
    out = tmp_path / "deep" / f"feet.{target}"
    notes = export(feet, target, out, model=stage_for(target, tmp_path))
    assert out.stat().st_size > 100
    assert any("right z" in note.text for note in notes), (
        "the axis that was not identified is said to be rigid"
    )


@pytest.mark.parametrize("target", TARGETS)
def test_what_was_guessed_goes_along(target: str, feet: dict[str, Any], tmp_path: Path) -> None:
    if "mujoco" in target or target == "mjcf":
        pytest.importorskip("mujoco")
    said = "robot.yaml: marked GUESS and not measured: the left foot's numbers depend on bush"
    feet["notes"] = [{"code": "guessed_geometry", "severity": "warning", "text": said}]
    notes = export(feet, target, tmp_path / "a", model=stage_for(target, tmp_path))
    assert said in [note.text for note in notes if note.severity == "warning"]
    assert "marked GUESS" in (tmp_path / "a").read_text()


# Of MuJoCo's contact each foot is tried anew, in seconds: what it says of offsets is the other contacts' code.
@pytest.mark.parametrize("target", [target for target in TARGETS if target != "mujoco-contact"])
def test_an_offset_that_is_asked_for_is_written_or_said_to_be_left_out(
    target: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    """And where none is asked for, nothing is said of it."""
    if target == "mjcf":
        pytest.importorskip("mujoco")
    model = stage_for(target, tmp_path)
    said = {
        asked: [
            note.code
            for note in export(feet, target, tmp_path / str(asked), model=model, with_offset=asked)
            if note.code == "export_offset"
        ]
        for asked in (False, True)
    }
    assert said[False] == []
    other = [line for line in (tmp_path / "True").read_text().splitlines() if not line.startswith("#")]
    same = [line for line in (tmp_path / "False").read_text().splitlines() if not line.startswith("#")]
    assert said[True] or other != same


def test_yaml_keeps_every_number(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "yaml", tmp_path / "f.yaml")
    data = yaml.safe_load((tmp_path / "f.yaml").read_text())
    left = data["feet"]["left"]
    assert left["axes"]["pitch"]["stiffness"] == {
        "value": 480.0, "unit": "N.m/rad", "std": 4.8, "interval95": [470.4, 489.6], "verdict": "usable"
    }  # fmt: skip
    assert left["axes"]["roll"]["offset_by_motion"]["sway"]["value"] == pytest.approx(-4.62)
    assert left["bush_centre"] == CENTRE.tolist()
    np.testing.assert_allclose(left["bush_rotation"], bush_rotation("left"), atol=1e-12)


def test_yaml_says_how_its_terms_add_up(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "yaml", tmp_path / "plain.yaml")
    assert (
        "# torque = stiffness x deflection + damping x rate + offset;"
        in (tmp_path / "plain.yaml").read_text()
    )
    for name, value in (("slip_torque", 5.0), ("slip_angle", 0.01)):
        row = {"foot": "left", "axis": "pitch", "name": name, "value": value, "std": 0.01, "unit": ""}
        feet["parameters"].append(row | {"interval95": None, "verdict": "usable"})
    export(feet, "yaml", tmp_path / "slips.yaml")
    text = (tmp_path / "slips.yaml").read_text()
    assert "+ what the bush model makes of slip_angle, slip_torque + offset;" in text
    assert "slip_torque x e / slip_angle, e follows the deflection" in text
    assert "left out" not in text, "a slip is a number like others"


def test_usd_counts_angles_in_degrees(feet: dict[str, Any], tmp_path: Path) -> None:
    export(feet, "usd", tmp_path / "f.usda", with_offset=True)
    text = (tmp_path / "f.usda").read_text()
    assert text.startswith("#usda 1.0\n")
    joint = text[text.index('"LLEG_BUSH_PITCH"') :]
    values = {key: float(re.search(rf"angular:physics:{key} = (\S+)", joint)[1])  # type: ignore[index]
              for key in ("stiffness", "damping", "targetPosition")}  # fmt: skip
    assert values["stiffness"] == pytest.approx(480 * math.pi / 180)
    assert values["damping"] == pytest.approx(24.27 * math.pi / 180)
    assert values["targetPosition"] == pytest.approx(math.degrees(-5.66 / 480))
    slide = text[text.index('"LLEG_BUSH_Z"') :]
    assert float(re.search(r"linear:physics:stiffness = (\S+)", slide)[1]) == 40000  # type: ignore[index]
    assert text.count("{") == text.count("}")


def test_the_command_line(feet: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "result.json").write_text(json.dumps(feet))
    with pytest.raises(SystemExit) as done:
        main(["export", str(tmp_path / "result.json"), "--to", "mc_rtc", "--out", str(tmp_path / "f.json")])
    assert done.value.code == 0
    assert (tmp_path / "f.json").exists()
    with pytest.raises(SystemExit) as failed:
        main(["export", str(tmp_path / "result.json"), "--to", "lego", "--out", str(tmp_path / "g.json")])
    assert failed.value.code == 1
    assert "kinetics_observer" in capsys.readouterr().err


@pytest.mark.parametrize("target", ["urdf", "mjcf", "sdf", "usd", "drake"])
def test_the_joints_that_are_bushes_are_named(target: str, feet: dict[str, Any], tmp_path: Path) -> None:
    if target == "mjcf":
        pytest.importorskip("mujoco")
    notes = export(feet, target, tmp_path / "feet")
    (said,) = [note.text for note in notes if note.code == "export_joints"]
    named = re.findall(r"\w+_BUSH_\w+", said)
    written = (tmp_path / "feet").read_text()
    assert sorted(named) == sorted(set(re.findall(r"(?<![\w/])[LR]LEG_BUSH_(?:Z|PITCH|ROLL)\b", written)))
    assert "left foot LLEG_BUSH_Z, LLEG_BUSH_PITCH, LLEG_BUSH_ROLL;" in said
    assert "pitch about y, toes down > 0" in said
    assert "LLEG_BUSH_PITCH (left foot, pitch about y, toes down > 0): K" in written


def test_positive_is_toes_down_and_left_edge_up(feet: dict[str, Any]) -> None:
    found, _ = feet_of_result(feet, Path(), with_offset=False, hysteresis=False, swing=None)
    for foot in found:
        axes = np.column_stack([foot.direction("roll"), foot.direction("pitch"), foot.direction("z")])
        forward, left, up = axes.T
        small = 0.1
        toes = forward + small * np.cross(foot.direction("pitch"), forward)
        edge = left + small * np.cross(foot.direction("roll"), left)
        assert toes @ up < 0
        assert edge @ up > 0
