"""Every target's file as it is kept: each attribute, name and number, alone and on a robot's own model."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from export_robots import result, write_mjcf, write_sdf, write_urdf
from kept_texts import assert_as_kept
from plantar.exporters import export
from usd_stage import write_usd

KEPT = Path(__file__).parent / "kept"
MODELS: dict[str, Callable[[Path], Path]] = {
    "mjcf": lambda folder: write_mjcf(folder / "robot.xml"),
    "sdf": lambda folder: write_sdf(folder / "robot.sdf", "1.9"),
    "old sdf": lambda folder: write_sdf(folder / "robot.sdf", "1.6"),
    "usd": lambda folder: write_usd(folder / "stage.usda"),
}
TARGETS = [
    ("urdf", None), ("sdf", None), ("sdf", "sdf"), ("sdf", "old sdf"), ("drake", None), ("drake", "sdf"),
    ("mjcf", "mjcf"), ("usd", None), ("usd", "usd"), ("mc_rtc", None), ("openhrp", None), ("choreonoid", None),
    ("kinetics_observer", None), ("randomization", None), ("yaml", None),
]  # fmt: skip
CONTACTS = [
    ("bullet-contact", None), ("drake-contact", None), ("drake-contact", "sdf"), ("physx-contact", "usd")
]  # fmt: skip
CASES = [(*case, "springs") for case in TARGETS] + [(*case, "rubber") for case in (*TARGETS, *CONTACTS)]


def rubber(urdf: Path) -> dict[str, Any]:
    """The result's left pitch slips; its right damping is hardly known; every deviation is another."""
    made = result(urdf)
    for place, row in enumerate(made["parameters"]):
        row["std"] *= 1 + 0.1 * place
        row["interval95"] = [row["value"] - 2 * row["std"], row["value"] + 2.1 * row["std"]]
    made["parameters"][7] |= {"verdict": "weak", "interval95": [2.0, 31.0]}
    for name, value in (("slip_torque", 5.0), ("slip_angle", 0.01)):
        row = {"foot": "left", "axis": "pitch", "name": name, "value": value, "std": 0.03 * value}
        made["parameters"].append(row | {"unit": "", "interval95": None, "verdict": "usable"})
    made["robot_model"]["uncertainty"] = {"imu_mount": 0.003, "encoder_zero": 0.0005}
    return made


@pytest.mark.parametrize(("target", "model", "kind"), CASES)
def test_a_file_is_as_it_is_kept(target: str, model: str | None, kind: str, tmp_path: Path) -> None:
    """Springs that rest at zero, and rubber of which a part slips that rests at its offsets."""
    if "usd" in (target, model):
        pytest.importorskip("pxr")
    urdf = write_urdf(tmp_path / "biped.urdf", rigid_legs="contact" in target)
    made = result(urdf) if kind == "springs" else rubber(urdf)
    given, out = MODELS[model](tmp_path) if model else None, tmp_path / "out.xml"
    notes = export(made, target, out, given, with_offset=kind == "rubber")
    said = "".join(f"{note.severity} {note.code}: {note.text}\n" for note in notes)
    text = f"{out.read_text()}\n{said}".replace(str(tmp_path), "FOLDER")
    name = "_".join([target, *([model.replace(" ", "_")] if model else []), kind])
    assert_as_kept(text, KEPT / f"{name}.txt", share=1e-4 if "contact" in target else 1e-6)


@pytest.mark.usefixtures("contact_at_one_step")
@pytest.mark.parametrize(("model", "hysteresis", "pivot"), [(None, False, "bush"), ("mjcf", True, "ground")])
def test_a_foot_on_points_is_as_it_is_kept(
    model: str | None, hysteresis: bool, pivot: str, tmp_path: Path
) -> None:
    """As far as an engine of another version finds the same points."""
    urdf = write_urdf(tmp_path / "biped.urdf", rigid_legs=model is None)
    given, out = MODELS[model](tmp_path) if model else None, tmp_path / "out.xml"
    options = {"hysteresis": hysteresis, "pivot": pivot, "swing": None if hysteresis else 0.02}
    notes = export(rubber(urdf), "mujoco-contact", out, given, with_offset=True, **options)
    said = "".join(f"{note.severity} {note.code}: {note.text}\n" for note in notes)
    text = re.sub(
        r"[\d.]+ %(?=, C|, at)", "0 %", f"{out.read_text()}\n{said}".replace(str(tmp_path), "FOLDER")
    )
    assert_as_kept(text, KEPT / f"points_{model or 'alone'}.txt", share=1e-2, least=2e-5)
