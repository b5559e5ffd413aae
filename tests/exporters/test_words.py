"""What exports say: why a result, an option, a model or a file cannot be used, and what is noted; as it is kept."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from export_robots import write_mjcf, write_sdf, write_urdf
from kept_texts import assert_as_kept
from plantar.errors import ExportError
from plantar.exporters import TARGETS, export
from plantar.exporters.kinetics_observer import read_contacts
from plantar.exporters.mc_rtc import read_flexibilities
from plantar.exporters.openhrp import read_customizer

KEPT = Path(__file__).parent / "kept"
NEVER = "plantar.feet/9"


def said(act: Callable[..., Any], *given: Any, **named: Any) -> str:
    """The error, or the notes where there is none."""
    try:
        notes = act(*given, **named)
    except ExportError as error:
        return f"{error}\n"
    return "".join(f"{note.severity} {note.code}: {note.text}\n" for note in notes) or "nothing\n"


def test_targets_are_told_as_they_are_kept() -> None:
    assert_as_kept(
        "".join(f"{name}: {' | '.join(told)}\n" for name, told in TARGETS.items()), KEPT / "targets.txt"
    )


def row_of(feet: dict[str, Any], axis: str = "pitch", name: str = "damping") -> dict[str, Any]:
    keys = {"foot": "left", "axis": axis, "name": name}
    found: dict[str, Any] = next(row for row in feet["parameters"] if keys.items() <= row.items())
    return found


def test_results_are_refused_or_noted_as_it_is_kept(feet: dict[str, Any], tmp_path: Path) -> None:
    """The left foot's damping is 24.27, its K·2 ms is 0.96."""
    unknown = {"verdict": "unidentifiable", "interval95": [-30.0, 80.0]}
    changes: list[Callable[[dict[str, Any]], object]] = [
        lambda feet: row_of(feet).update(unknown),
        lambda feet: row_of(feet).update(unknown | {"interval95": [2.5, 80.0]}),
        lambda feet: row_of(feet).update(unknown | {"interval95": [-30.0, 0.5]}),
        lambda feet: row_of(feet).update(unknown | {"interval95": [-30.0, -2.0]}),
        lambda feet: row_of(feet).update(unknown | {"interval95": None}),
        lambda feet: row_of(feet).update(value=None, interval95=None),
        lambda feet: row_of(feet).update(value=-3.0, verdict="weak", interval95=[-8.0, 2.0]),
        lambda feet: row_of(feet).update(std=None, interval95=None),
        lambda feet: row_of(feet, name="stiffness").update(verdict="weak", interval95=[None, 700.0]),
        lambda feet: row_of(feet, name="stiffness").update(value=-5.0),
        lambda feet: row_of(feet, name="stiffness").update(value="high"),
        lambda feet: row_of(feet, name="stiffness").update(unit="N.m/deg"),
        lambda feet: feet["robot_model"]["feet"]["left"]["bush"].update(xyz=["a", 0, 0]),
        lambda feet: feet["robot_model"]["feet"]["left"].pop("sole"),
        lambda feet: feet["robot_model"]["feet"].pop("right"),
        lambda feet: feet["robot_model"].update(urdf="nowhere.urdf"),
        lambda feet: feet["robot_model"].update(urdf=None),
        lambda feet: feet.pop("robot_model"),
        lambda feet: feet["parameters"].clear(),
        lambda feet: feet.update(parameters=[row for row in feet["parameters"] if row["axis"] == "z"]),
        lambda feet: feet.update(schema=NEVER),
        lambda feet: feet.update(schema="plantar.inertia/1"),
        lambda feet: feet["notes"].append({"code": "guessed_geometry", "text": "the bush is guessed"}),
    ]  # fmt: skip
    lines = []
    for change in changes:
        made = copy.deepcopy(feet)
        change(made)
        lines.append(said(export, made, "randomization", tmp_path / "out"))
    assert_as_kept("\n".join(lines).replace(str(tmp_path), "FOLDER"), KEPT / "words_of_results.txt")


def test_options_are_refused_as_it_is_kept(feet: dict[str, Any], tmp_path: Path) -> None:
    inertia = {"schema": "plantar.inertia/1"}
    asked: list[tuple[Any, str, dict[str, Any]]] = [
        (feet, "gazebo", {}), (feet, "urdf", {"swing": 0.0}), (feet, "urdf", {"swing": 1.0}),
        (feet, "mujoco-contact", {"pivot": "ankle"}), (feet, "mujoco-contact", {"least_load": 0.04}),
        (feet, "mujoco-contact", {"least_load": 0.6}), (feet, "urdf", {"pivot": "bush"}),
        (feet, "urdf", {"least_load": 0.3}), (feet, "sdf", {"hysteresis": True}),
        (feet, "mujoco-contact", {"hysteresis": True, "swing": 0.02}), (inertia, "sdf", {}), (inertia, "urdf", {}),
        ("none.json", "urdf", {}),
    ]  # fmt: skip
    lines = [said(export, one, target, tmp_path / "out", **options) for one, target, options in asked]
    assert_as_kept("".join(lines), KEPT / "words_of_options.txt")
    assert not (tmp_path / "out").exists()


def test_models_are_refused_as_it_is_kept(feet: dict[str, Any], tmp_path: Path) -> None:
    """Of another kind, of another robot, too deep, with entities, weightless."""
    urdf, sdf = write_urdf(tmp_path / "m.urdf"), write_sdf(tmp_path / "m.sdf", "1.9")
    mjcf = write_mjcf(tmp_path / "m.xml")
    contents = {
        "deep.urdf": f"<robot>{'<a>' * 300}{'</a>' * 300}</robot>", "cut.urdf": "<robot><link",
        "doctype.urdf": '<!DOCTYPE robot [<!ENTITY a "b">]><robot/>', "other.urdf": "<sdf/>",
        "renamed.urdf": urdf.read_text().replace("left_ankle", "left_anckle"),
        "renamed.sdf": sdf.read_text().replace("left_ankle", "left_anckle"),
        "renamed.xml": mjcf.read_text().replace('name="left_ankle"', 'name="left_anckle"'),
        "other.xml": "<robots/>", "broken.xml": '<mujoco><worldbody><body pos="a b"/></worldbody></mujoco>',
    }  # fmt: skip
    lines = []
    for name, content in contents.items():
        (tmp_path / name).write_text(content)
        target = {".urdf": "urdf", ".sdf": "sdf", ".xml": "mjcf"}[Path(name).suffix]
        lines.append(f"{name}: {said(export, feet, target, tmp_path / 'out', tmp_path / name)}")
    lines.append(said(export, feet, "mjcf", tmp_path / "out", tmp_path / "nowhere.xml"))
    text = re.sub(
        r"(MuJoCo refuses the model|is not readable XML): .*", r"\1: REASON", "".join(lines)
    )  # its own words
    assert_as_kept(text.replace(str(tmp_path), "FOLDER"), KEPT / "words_of_models.txt")


READ: dict[Callable[[Path], object], list[str]] = {
    read_customizer: [
        "robot_model_name: x\n", "bush_config: A,1\n", "bush_config: A,1,-2\n", "# a\nbush_config: A,1,2 A,1,2\n",
        "bush_config: A,inf,2\n",
    ],
    read_flexibilities: [
        "{", "{}", '{"flexibilities": [{}]}', '{"flexibilities": [{"jointName": "A", "K": 1, "C": -1, "O": 0}]}',
        '{"flexibilities": [{"jointName": "A", "K": 1, "C": 1, "O": 0}, {"jointName": "A", "K": 1, "C": 1, "O": 0}]}',
    ],
    read_contacts: ["a: [", "3", "linStiffness: [1, 2]\n", "linStiffness: [1, 2, -3]\n", "linStiffness: [1, 2, 3]\n"],
}  # fmt: skip


@pytest.mark.parametrize("read", READ)
def test_files_of_controllers_are_refused_as_it_is_kept(
    read: Callable[[Path], object], tmp_path: Path
) -> None:
    lines = []
    for text in READ[read]:
        (tmp_path / "file.txt").write_text(text)
        with pytest.raises(ExportError) as refused:
            read(tmp_path / "file.txt")
        lines.append(f"{text.strip()}\n{refused.value}\n".replace(str(tmp_path), "FOLDER"))
    assert_as_kept("".join(lines), KEPT / f"words_of_{read.__name__}.txt")
