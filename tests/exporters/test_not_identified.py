"""Numbers that no log shows do not reach a file, and what cannot be written is one clear line."""

from __future__ import annotations

import copy
import json
import math
from pathlib import Path
from typing import Any

import pytest

from export_robots import TRUTH
from plantar.errors import ExportError
from plantar.exporters import export


def spoiled(feet: dict[str, Any], value: float, low: float, high: float) -> dict[str, Any]:
    """The feet, with a damping of left pitch that no log shows."""
    made = copy.deepcopy(feet)
    row = made["parameters"][3]
    assert (row["foot"], row["axis"], row["name"]) == ("left", "pitch", "damping")
    row.update(value=value, interval95=[low, high], std=(high - low) / 4, verdict="unidentifiable")
    return made


@pytest.mark.parametrize(
    ("interval", "written"),
    [((-12.0, 31.0), 0.96), ((22.6, 95.8), 22.6), ((0.1, 0.8), 0.8), ((-9.0, -1.0), 0.96)],
)
def test_a_damping_that_no_log_shows_is_not_exported(
    interval: tuple[float, float], written: float, feet: dict[str, Any], tmp_path: Path
) -> None:
    given = spoiled(feet, sum(interval) / 2, *interval)
    out = tmp_path / "a.json"
    notes = export(given, "mc_rtc", out)
    entries = {e["jointName"]: e for e in json.loads(out.read_text())["flexibilities"]}
    assert entries["LLEG_BUSH_PITCH"]["C"] == pytest.approx(written)
    assert entries["LLEG_BUSH_ROLL"]["C"] == TRUTH["left"]["roll"][1]
    (said,) = [note.text for note in notes if note.code == "export_damping"]
    assert f"95 % from {interval[0]:.4g} to {interval[1]:.4g}" in said
    assert f"= {written:.4g}" in said
    assert any(said in line for line in json.loads(out.read_text())["plantar"]), "the file says so too"


@pytest.mark.parametrize("target", ["mjcf", "sdf", "urdf", "drake", "usd", "openhrp"])
def test_no_target_holds_an_unidentifiable_damping(target: str, feet: dict[str, Any], tmp_path: Path) -> None:
    if target == "mjcf":
        pytest.importorskip("mujoco")
    out = tmp_path / "a"
    export(spoiled(feet, 9.87654, -12.0, 31.0), target, out)
    text = out.read_text()
    scale = math.pi / 180 if target == "usd" else 1
    assert "0.96" in text if scale == 1 else f"{0.96 * scale:.9g}" in text
    held = [line for line in text.splitlines() if "unidentifiable" not in line]
    assert not any(f"{9.87654 * scale:.6g}" in line for line in held)


@pytest.mark.parametrize("target", ["mjcf", "yaml", "randomization", "openhrp"])
def test_an_interval_without_an_end_is_told_as_it_is(
    target: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    """JSON holds an end that is nowhere as null: z of sensors that may read half of the load."""
    made = copy.deepcopy(feet)
    for row in made["parameters"]:
        if row["name"] == "stiffness":
            row.update(interval95=[row["value"] / 3, None], verdict="unidentifiable")
    file = tmp_path / "result.json"
    file.write_text(json.dumps(made))
    said = [note.text for note in export(file, target, tmp_path / "a") if note.code == "export_verdict"]
    assert any(text.startswith("left pitch") and "to inf N" in text for text in said)
    assert not any(text.startswith("left z: the stiffness") for text in said), "it stays rigid"


@pytest.mark.parametrize(("place", "unit"), [(0, "N.m/deg"), (3, "N.m/rad")])
def test_a_number_in_another_unit_is_refused(
    place: int, unit: str, feet: dict[str, Any], tmp_path: Path
) -> None:
    made = copy.deepcopy(feet)
    usual = made["parameters"][place]["unit"]
    made["parameters"][place]["unit"] = unit
    with pytest.raises(ExportError, match=rf"value '{unit}': left .*: the unit of .* \(valid: {usual}\)"):
        export(made, "openhrp", tmp_path / "a")


def _broken(feet: dict[str, Any], **changes: Any) -> dict[str, Any]:
    made = copy.deepcopy(feet)
    for row in made["parameters"]:
        if row["foot"] == "left" and row["axis"] == "pitch" and row["name"] in changes:
            row["value"] = changes[row["name"]]
    return made


def test_what_cannot_be_written_is_one_clear_line(feet: dict[str, Any], urdf: Path, tmp_path: Path) -> None:
    out = tmp_path / "x"
    (tmp_path / "bomb.urdf").write_text('<!DOCTYPE r [<!ENTITY a "b">]><robot name="r"/>')
    wide = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE r [<!ENTITY a "b">]><robot name="r"/>'
    (tmp_path / "wide.urdf").write_text(wide, "utf-16")
    (tmp_path / "deep.urdf").write_text("<robot>" + "<a>" * 5000 + "</a>" * 5000 + "</robot>")
    (tmp_path / "cut.urdf").write_text(urdf.read_text()[:300])
    (tmp_path / "other.urdf").write_text('<robot name="o"><link name="lef_ankle"/></robot>')
    no_model = {key: value for key, value in feet.items() if key != "robot_model"}
    cases: list[tuple[dict[str, Any], str, Path | None, str]] = [
        (
            feet,
            "matlab",
            None,
            r"^'matlab' is not a target \(valid: mjcf, mujoco-contact, drake-contact, bullet-contact, "
            r"physx-contact, sdf, urdf, drake, usd, mc_rtc, openhrp, choreonoid, kinetics_observer, "
            r"randomization, yaml\)$",
        ),
        (no_model, "urdf", None, "robot_model"),
        (
            _broken(feet, stiffness=-3.0),
            "mc_rtc",
            None,
            r"^value -3\.0: left pitch: the stiffness is not positive; no simulator can stand on it "
            r"\(valid: a result whose stiffness is usable\)$",
        ),
        (_broken(feet, stiffness="stiff"), "mc_rtc", None, "not a number"),
        (_broken(feet, damping=float("nan")), "yaml", None, "not a number"),
        (feet, "urdf", tmp_path / "bomb.urdf", "DOCTYPE"),
        (feet, "urdf", tmp_path / "wide.urdf", "DOCTYPE"),
        (feet, "urdf", tmp_path / "deep.urdf", r"deep\.urdf: is nested too deeply \(valid: 200 levels\)$"),
        (
            feet,
            "urdf",
            tmp_path / "cut.urdf",
            r"cut\.urdf: is not readable XML: unclosed token: line 3, column 225$",
        ),
        (
            feet,
            "urdf",
            tmp_path / "other.urdf",
            r"other\.urdf: has no link 'left_ankle' \(valid: lef_ankle\)$",
        ),
        (
            feet,
            "urdf",
            tmp_path / "missing.urdf",
            r"missing\.urdf: cannot be read: No such file or directory$",
        ),
        (feet, "yaml", urdf, r"^value 'yaml': this target takes no model \(valid: no --model\)$"),
        (
            {"schema": "plantar.inertia/1"},
            "urdf",
            None,
            r"^the result names no URDF \(valid: --model with the robot's URDF\)$",
        ),
        ({"schema": "plantar.inertia/1"}, "sdf", None, "plantar.inertia/1"),
        ({**feet, "schema": "plantar.joints/1"}, "yaml", None, "schema"),
    ]
    for data, target, model, expected in cases:
        with pytest.raises(ExportError, match=expected) as caught:
            export(data, target, out, model=model)
        assert "\n" not in str(caught.value)
    assert not out.exists()


def test_an_axis_without_a_value_is_rigid_and_a_negative_damper_becomes_a_small_one(
    feet: dict[str, Any], tmp_path: Path
) -> None:
    notes = export(_broken(feet, stiffness=None), "mc_rtc", tmp_path / "a.json")
    assert "LLEG_BUSH_PITCH" not in (tmp_path / "a.json").read_text()
    assert any("left pitch" in note.text for note in notes)
    notes = export(_broken(feet, damping=-1.0), "mc_rtc", tmp_path / "b.json")
    assert "export_damping" in {note.code for note in notes}
    entries = json.loads((tmp_path / "b.json").read_text())["flexibilities"]
    assert next(e for e in entries if e["jointName"] == "LLEG_BUSH_PITCH")["C"] == pytest.approx(480 * 0.002)


@pytest.mark.parametrize(
    ("verdict", "interval", "rigid"),
    [("usable", None, False), ("unidentifiable", None, True), ("unidentifiable", [1.6e5, 7.1e5], False)],
)
def test_a_vertical_stiffness_is_rigid_where_no_log_shows_that_it_gives(
    verdict: str, interval: list[float] | None, rigid: bool, feet: dict[str, Any], tmp_path: Path
) -> None:
    """A twin whose z was known to a factor of four moved 1.9 mrad off on rigid z and 0.3 on the value."""
    for row in feet["parameters"]:
        if row["axis"] == "z":
            row |= {"verdict": verdict, "interval95": interval}
    notes = export(feet, "mc_rtc", tmp_path / "out.json")
    assert ("BUSH_Z" not in (tmp_path / "out.json").read_text()) is rigid
    assert any(note.text.startswith("left z: not identified") for note in notes) is rigid
    doubted = any(note.text.startswith("left z: the stiffness is unidentifiable") for note in notes)
    assert doubted is (interval is not None), "and its interval is said"
